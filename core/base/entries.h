/* entries.h - all entries of one owner copied to another. */
#ifndef TL_BASE_ENTRIES_H
#define TL_BASE_ENTRIES_H

#include "base/walk.h"

/* Entries that one owner may have. */
#define TL_MOST_ENTRIES 96

/* The entries of an owner in the order of its walk. */
typedef struct tl_entries {
    tl_entry list[TL_MOST_ENTRIES];
    size_t count;
} tl_entries;

/* Lists entries: the function of a walk whose user is a tl_entries. */
void tl_entries_note(void *user, const tl_entry *entry);

/* Copies to the entry of another owner: a pair of walks, the first with tl_entries_note. */
typedef struct tl_entries_copy {
    const tl_entries *from;
    size_t next;
    bool failed; /* out of memory: what could not be copied is empty */
} tl_entries_copy;

/* The function of the second walk, whose user is a tl_entries_copy. */
void tl_entries_take(void *user, const tl_entry *entry);

/* Puts a list of so many items, from malloc, in the place of the one of an entry, which is freed. */
void tl_entry_put_list(const tl_entry *to, void *list, size_t items);

/* Room for the name under which a file keeps an entry or a column. */
#define TL_COLUMN_CHUNK 96

/* The whole name of an entry. */
void tl_entry_name(const tl_entry *entry, char name[TL_COLUMN_CHUNK]);
/* The name of column `k` of a table: "bodies.mass"; of several columns of one name each has its number,
 * "detect.points.p[k].2". */
void tl_column_chunk(const char *table_name, const tl_table *table, size_t k, char name[TL_COLUMN_CHUNK]);

#endif
