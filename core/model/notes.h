/* notes.h - what a generator notes on the objects that it has read. */
#ifndef TL_MODEL_NOTES_H
#define TL_MODEL_NOTES_H

#include <stdbool.h>
#include <talus/talus.h>

typedef struct tl_notes tl_notes;

tl_notes *tl_notes_new(void);
void tl_notes_free(tl_notes *notes);
/* Adds a note, of copies of its texts; false without memory. */
bool tl_notes_add(tl_notes *notes, const char *object, const char *key, double number, const char *text);

#endif
