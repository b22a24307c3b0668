/* table.h - columns: a table of named, aligned arrays that grow together (structure of arrays).
 *
 * A table lives inside a struct whose members are the typed column pointers:
 *
 *     struct points { tl_table table; double *area; ... };
 *     tl_table_init(&p->table, p);  TL_COLUMN(&p->table, p, area, TL_COLUMN_STATE);
 *
 * Every column has the table's capacity and is aligned to TL_ALIGN bytes; new rows are zero. */
#ifndef TL_BASE_TABLE_H
#define TL_BASE_TABLE_H

#include <talus/plugin.h>

#define TL_TABLE_COLUMNS 64
/* A row that there is not. */
#define TL_NO_ROW UINT32_MAX

enum {
    TL_COLUMN_STATE = 1, /* part of the mechanical state: hashed and saved */
    TL_COLUMN_STEP = 2,  /* overwritten by laws or gather: kept where a step may have to be undone */
    TL_COLUMN_OWNED = 4  /* pointers to what has an owner of its own: saved otherwise */
};

typedef struct tl_column {
    const char *name;
    size_t size;   /* bytes a row */
    size_t offset; /* of the pointer in the owner struct */
    unsigned flags;
} tl_column;

typedef struct tl_table {
    void *owner;
    size_t rows, capacity;
    size_t used;   /* rows from here on have been zero since the memory was had */
    void *memory;  /* of all columns */
    size_t mapped; /* bytes of it, where it was mapped; 0: it was allocated */
    size_t column_count;
    tl_column columns[TL_TABLE_COLUMNS];
} tl_table;

#define TL_COLUMN(table, owner, member, flags)                                                                         \
    tl_table_column((table), #member, sizeof *(owner)->member, TL_COLUMN_AT(owner, member), (flags))
/* The same, for tl_table_widen. */
#define TL_COLUMN_NEW(owner, member, flags)                                                                            \
    {                                                                                                                  \
#member, sizeof *(owner)->member, TL_COLUMN_AT(owner, member), (flags)                                         \
    }
/* Where the pointer of a column is in its owner. */
#define TL_COLUMN_AT(owner, member) (size_t)((char *)&(owner)->member - (char *)(owner))

void tl_table_init(tl_table *table, void *owner);
/* Adds a column while the table is empty. */
void tl_table_column(tl_table *table, const char *name, size_t size, size_t offset, unsigned flags);
/* Adds columns, of zeros, to a table that may have rows: all of them or, when out of memory, none (false). */
bool tl_table_widen(tl_table *table, const tl_column *columns, size_t count);
/* Adds one, unless it is there already: for what few models need. The pointer is NULL until then. */
bool tl_table_need(tl_table *table, const char *name, size_t size, size_t offset, unsigned flags);
#define TL_COLUMN_NEED(table, owner, member, flags)                                                                    \
    tl_table_need((table), #member, sizeof *(owner)->member, TL_COLUMN_AT(owner, member), (flags))
/* Makes room for `rows` rows; what is there stays. false when out of memory (nothing changed). */
bool tl_table_reserve(tl_table *table, size_t rows);
/* Sets the number of rows; new ones are zero. */
bool tl_table_resize(tl_table *table, size_t rows);
/* Keeps the rows for which keep[row] is not 0, in order. */
void tl_table_keep(tl_table *table, const unsigned char *keep);
/* Puts the last `count` rows in between the others: the k-th of them becomes row at[k]; they ascend. There is room
 * for as many rows more. */
void tl_table_insert(tl_table *table, const uint32_t *at, size_t count);
/* Copies a row over another. */
void tl_table_move(tl_table *table, size_t to, size_t from);
void *tl_table_data(const tl_table *table, size_t column);
void tl_table_free(tl_table *table);
/* Makes a table of the same columns, rows and capacity for another owner of the same type. It replaces one without
 * memory. false when out of memory (it is empty then). */
bool tl_table_copy(tl_table *table, void *owner, const tl_table *from);
/* Bytes its columns take, spare rows included, but for those of large tables that have not been written to: they take
 * none. */
size_t tl_table_bytes(const tl_table *table);

/* Makes room for `need` items of `size` bytes in the array whose pointer is at `slot`, with some to spare. What is
 * there stays. false when out of memory (nothing changed). */
bool tl_grow(void *slot, size_t *capacity, size_t need, size_t size);
/* The same without any to spare: for what has a place for each block or body. */
bool tl_fit(void *slot, size_t *capacity, size_t need, size_t size);
/* Gives back what an array of `count` items has to spare. */
void tl_trim(void *slot, size_t *capacity, size_t count, size_t size);

/* Asks the system to keep allocated memory in large pages, as far as it has not been written to yet. A loop over many
 * columns then has the address of each at hand. Nothing where there is no such thing, or for little memory. Not for
 * what realloc will be asked to move: it would copy. */
void tl_pages_large(void *memory, size_t bytes);

#endif
