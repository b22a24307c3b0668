/* notes.c - a list of notes. Objects and keys that repeat those of the note before share their text. */
#include "model/notes.h"

#include "model/model.h"

#include <stdlib.h>
#include <string.h>

struct tl_notes {
    tl_generate_note *note;
    size_t count, capacity;
    char **owned; /* texts */
    size_t owned_count, owned_capacity;
};

tl_notes *tl_notes_new(void)
{
    return calloc(1, sizeof(tl_notes));
}

void tl_notes_free(tl_notes *n)
{
    if (!n)
        return;
    for (size_t i = 0; i < n->owned_count; i++)
        free(n->owned[i]);
    free(n->owned);
    free(n->note);
    free(n);
}

/* Gives `text` as it is kept: `known`, if that says the same, or a copy. */
static bool keep(tl_notes *n, const char *text, const char *known, const char **kept)
{
    *kept = text && known && strcmp(text, known) == 0 ? known : NULL;
    if (*kept || !text)
        return true;
    if (n->owned_count == n->owned_capacity) {
        size_t capacity = n->owned_capacity ? 2 * n->owned_capacity : 64;
        char **owned = realloc(n->owned, capacity * sizeof *owned);
        if (!owned)
            return false;
        n->owned = owned;
        n->owned_capacity = capacity;
    }
    char *copy = strdup(text);
    *kept = copy;
    if (copy)
        n->owned[n->owned_count++] = copy;
    return copy != NULL;
}

bool tl_notes_add(tl_notes *n, const char *object, const char *key, double number, const char *text)
{
    if (n->count == n->capacity) {
        size_t capacity = n->capacity ? 2 * n->capacity : 64;
        tl_generate_note *list = realloc(n->note, capacity * sizeof *list);
        if (!list)
            return false;
        n->note = list;
        n->capacity = capacity;
    }
    const tl_generate_note *last = n->count ? &n->note[n->count - 1] : NULL;
    tl_generate_note *note = &n->note[n->count];
    note->number = number;
    if (!keep(n, object, last ? last->object : NULL, &note->object) ||
        !keep(n, key, last ? last->key : NULL, &note->key) || !keep(n, text, NULL, &note->text))
        return false;
    n->count++;
    return true;
}

const tl_generate_note *tl_generate_notes(const tl_model *m, size_t *count)
{
    *count = m->notes ? m->notes->count : 0;
    return m->notes ? m->notes->note : NULL;
}
