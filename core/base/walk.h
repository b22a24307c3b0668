/* walk.h - the entries of a module, listed once: what counts bytes, copies, saves and restores a model walks these
 * lists.
 *
 * A module's walk (model/walk.c, contact/store.c, cycle/prepare.c) names each of its values, lists and tables and calls
 * a function with it, always in the same order. */
#ifndef TL_BASE_WALK_H
#define TL_BASE_WALK_H

#include "base/table.h"

#include <string.h>

/* What becomes of an entry. */
typedef enum tl_keep {
    TL_KEEP_STATE,   /* what the next steps depend on, and what is told of the model: copied, saved */
    TL_KEEP_CACHE,   /* saves work; without it the next steps would be the same but for rounding: copied, saved */
    TL_KEEP_DERIVED, /* follows from the rest to the bit: copied, not saved */
    TL_KEEP_SCRATCH  /* means nothing between two calls: neither */
} tl_keep;

typedef enum tl_entry_form {
    TL_ENTRY_VALUE, /* `at` points to `size` bytes */
    TL_ENTRY_FLAG,  /* a bool */
    TL_ENTRY_LIST,  /* `at` points to the pointer to `items` items of `size` bytes, from malloc */
    TL_ENTRY_TABLE  /* `at` points to a tl_table, which is the first member of its owner */
} tl_entry_form;

typedef struct tl_entry {
    const char *prefix, *name; /* "detect.pairs", or in two parts; the prefix of a whole name is NULL */
    tl_entry_form form;
    tl_keep keep;
    void *at;
    size_t size, items;
    size_t bytes;      /* of a table, and of the capacity of a list */
    size_t *count;     /* of a list: where its number of items is noted, */
    size_t *capacity;  /* and of those it has room for, or NULL */
    size_t counts_for; /* offset in tl_memory of what its bytes count for */
} tl_entry;

/* Whether the byte of a bool is one: of what was read from a file it may be anything. */
static inline bool tl_is_flag(const bool *flag)
{
    unsigned char byte;
    memcpy(&byte, flag, 1);
    return byte <= 1;
}

typedef struct tl_walk {
    void (*visit)(void *user, const tl_entry *entry);
    void *user;
} tl_walk;

/* A list; one whose capacity is noted nowhere, NULL, has room for its items. */
static inline void tl_walk_list(const tl_walk *w, tl_keep keep, const char *name, void *slot, size_t size,
                                size_t *count, size_t *capacity, size_t counts_for)
{
    const tl_entry e = {.name = name,
                        .form = TL_ENTRY_LIST,
                        .keep = keep,
                        .at = slot,
                        .size = size,
                        .items = *count,
                        .bytes = size * (capacity ? *capacity : *count),
                        .count = count,
                        .capacity = capacity,
                        .counts_for = counts_for};
    w->visit(w->user, &e);
}

static inline void tl_walk_table(const tl_walk *w, tl_keep keep, const char *name, tl_table *table, size_t counts_for)
{
    const tl_entry e = {.name = name,
                        .form = TL_ENTRY_TABLE,
                        .keep = keep,
                        .at = table,
                        .bytes = tl_table_bytes(table),
                        .counts_for = counts_for};
    w->visit(w->user, &e);
}

/* A member of a struct under its own name after a prefix: TL_WALK_VALUE(walk, TL_KEEP_STATE, "model.", m, time). */
#define TL_WALK_VALUE(walk, keep_, prefix_, owner, member)                                                             \
    (walk)->visit((walk)->user, &(const tl_entry){.name = prefix_ #member,                                             \
                                                  .form = TL_ENTRY_VALUE,                                              \
                                                  .keep = (keep_),                                                     \
                                                  .at = &(owner)->member,                                              \
                                                  .size = sizeof(owner)->member})
#define TL_WALK_FLAG(walk, keep_, prefix_, owner, member)                                                              \
    (walk)->visit((walk)->user, &(const tl_entry){.name = prefix_ #member,                                             \
                                                  .form = TL_ENTRY_FLAG,                                               \
                                                  .keep = (keep_),                                                     \
                                                  .at = &(owner)->member,                                              \
                                                  .size = sizeof(owner)->member})
#define TL_WALK_LIST(walk, keep, prefix, owner, member, count, capacity, counts_for)                                   \
    tl_walk_list((walk), (keep), prefix #member, &(owner)->member, sizeof *(owner)->member, (count), (capacity),       \
                 (counts_for))

#endif
