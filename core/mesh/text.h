/* text.h - words, numbers and lines of a mesh's file. */
#ifndef TL_MESH_TEXT_H
#define TL_MESH_TEXT_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Bytes of a word, with the 0 at its end; of a longer one the rest is left out. */
#define TL_MESH_WORD 80

/* A place in the bytes of a file, which a zero byte ends. */
typedef struct tl_mesh_text {
    const char *file, *at, *end;
    size_t line; /* from 1 */
    tl_error *error;
} tl_mesh_text;

/* The next word, beyond ends of lines, or on the same line only. false: there is none. */
bool tl_mesh_word(tl_mesh_text *text, char word[TL_MESH_WORD]);
bool tl_mesh_word_here(tl_mesh_text *text, char word[TL_MESH_WORD]);
/* Goes to the beginning of the next line. */
void tl_mesh_next_line(tl_mesh_text *text);
/* Bytes that are left. */
static inline size_t tl_mesh_left(const tl_mesh_text *text)
{
    return (size_t)(text->end - text->at);
}

/* TL_E_GEOMETRY with a sentence after the file and the line. */
tl_status tl_mesh_fault(const tl_mesh_text *text, const char *format, ...) TL_PRINTF(2, 3);
/* The same for a file that ends where something is expected. */
tl_status tl_mesh_truncated(const tl_mesh_text *text, const char *wanted);

/* The next number; `what` it is. Whole ones lie between two. */
tl_status tl_mesh_number(tl_mesh_text *text, const char *what, double *number);
tl_status tl_mesh_whole_number(tl_mesh_text *text, const char *what, double least, double most, double *number);
/* Whether a file has room for `count` things of at least `bytes` each, which it says to have. */
tl_status tl_mesh_room(const tl_mesh_text *text, double count, double bytes, const char *things);
/* A coordinate that can be computed with. */
tl_status tl_mesh_check_place(const tl_mesh_text *text, tl_vec3 at, const char *node, size_t number);

/* Whether two words are alike but for capital letters of ASCII. */
bool tl_mesh_alike(const char *a, const char *b);

#endif
