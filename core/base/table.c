/* table.c - see table.h. */
#define _GNU_SOURCE /* madvise, mremap */
#include "base/table.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Capacities are multiples of this, so that a vector loop may run past the last row. */
#define ROW_ROUND 16u
/* What grows row by row gets 1 / this more than it has. A row is then copied some ten times before it lies still, and
 * little is left over. */
#define GROWTH 8

/* Bytes of a large page of x86-64 and of most others. */
#define LARGE ((size_t)2 << 20)
/* Cost only: bytes from which a table has pages of its own, which are moved when it grows. */
#define LEAST_MAPPED ((size_t)1 << 20)
/* Cost only: cache lines between the beginnings of columns in their pages. Without, the same row of all columns would
 * lie in one set of the nearest cache. */
#define STAGGER 5

void tl_pages_large(void *memory, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t begin = ((uintptr_t)memory + LARGE - 1) / LARGE * LARGE;
    uintptr_t end = ((uintptr_t)memory + bytes) / LARGE * LARGE;
    if (begin < end)
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); /* if it fails, nothing changes */
#else
    (void)memory;
    (void)bytes;
#endif
}

void tl_table_init(tl_table *table, void *owner)
{
    memset(table, 0, sizeof *table);
    table->owner = owner;
}

void tl_table_column(tl_table *table, const char *name, size_t size, size_t offset, unsigned flags)
{
    assert(table->capacity == 0 && table->column_count < TL_TABLE_COLUMNS);
    table->columns[table->column_count++] = (tl_column){name, size, offset, flags};
}

static void *get(const tl_table *table, const tl_column *column)
{
    void *data;
    memcpy(&data, (const char *)table->owner + column->offset, sizeof data);
    return data;
}

static void put(const tl_table *table, const tl_column *column, void *data)
{
    memcpy((char *)table->owner + column->offset, &data, sizeof data);
}

bool tl_fit(void *slot, size_t *capacity, size_t need, size_t size)
{
    if (need <= *capacity)
        return true;
    void *data;
    memcpy(&data, slot, sizeof data);
    data = realloc(data, need * size);
    if (!data)
        return false;
    /* what a save or a digest takes of it, gaps in rows included, is the same in every run */
    memset((char *)data + *capacity * size, 0, (need - *capacity) * size);
    memcpy(slot, &data, sizeof data);
    *capacity = need;
    return true;
}

bool tl_grow(void *slot, size_t *capacity, size_t need, size_t size)
{
    return need <= *capacity || tl_fit(slot, capacity, need + need / 2 + 16, size);
}

void tl_trim(void *slot, size_t *capacity, size_t count, size_t size)
{
    void *data;
    memcpy(&data, slot, sizeof data);
    if (count == 0 || count >= *capacity)
        return;
    data = realloc(data, count * size);
    if (!data)
        return;
    memcpy(slot, &data, sizeof data);
    *capacity = count;
}

static size_t column_bytes(const tl_column *column, size_t capacity)
{
    return (capacity * column->size + TL_ALIGN - 1) / TL_ALIGN * TL_ALIGN;
}

/* ---------------------------------------------------------------- memory ------------------
 *
 * All columns lie in one allocation that comes zeroed: what is not written to yet costs little memory.
 *
 * A large table is mapped, and each column has pages of its own. When it grows, these are put elsewhere in the address
 * space as they are: nothing is copied, and no page is cleared but those of new rows. */

static size_t page_bytes(void)
{
    return (size_t)sysconf(_SC_PAGESIZE);
}

static size_t round_up(size_t bytes, size_t to)
{
    return (bytes + to - 1) / to * to;
}

/* Bytes before column i in its first page. */
static size_t stagger(size_t i)
{
    return i * STAGGER * TL_ALIGN % page_bytes();
}

static void release(void *memory, size_t mapped)
{
    if (mapped)
        (void)munmap(memory, mapped);
    else
        free(memory);
}

/* Puts the pages of a column elsewhere; false when that is not possible (nothing changed). */
static bool move_pages(char *to, char *from, size_t bytes)
{
#ifdef MREMAP_FIXED
    bytes = round_up(bytes, page_bytes());
    return mremap(from, bytes, bytes, MREMAP_MAYMOVE | MREMAP_FIXED, to) == to;
#else
    (void)to, (void)from, (void)bytes;
    return false;
#endif
}

/* Where column i begins in memory that is free from `at` on. Large pages can be moved as a whole to a place that lies
 * in such pages as the old one did. */
static char *place_column(const tl_table *table, size_t i, size_t capacity, char *at, bool mapped)
{
    at += (TL_ALIGN - (uintptr_t)at % TL_ALIGN) % TL_ALIGN;
    if (!mapped)
        return at;
    at += round_up((uintptr_t)at, page_bytes()) - (uintptr_t)at;
    const char *old = get(table, &table->columns[i]);
    if (table->mapped && old && column_bytes(&table->columns[i], capacity) >= LARGE)
        at += ((uintptr_t)(old - stagger(i)) - (uintptr_t)at) % LARGE;
    return at + stagger(i);
}

/* Takes the rows of a column over. */
static void take_rows(const tl_table *table, size_t i, char *to)
{
    char *old = get(table, &table->columns[i]);
    const size_t bytes = table->rows * table->columns[i].size, before = stagger(i);
    if (bytes == 0 || !old || (table->mapped && move_pages(to - before, old - before, before + bytes)))
        return;
    memcpy(to, old, bytes);
}

/* Gives the table memory for `capacity` rows and takes its rows over, but for columns without any data. */
static bool allocate(tl_table *table, size_t capacity)
{
    size_t bytes = TL_ALIGN;
    for (size_t i = 0; i < table->column_count; i++)
        bytes += column_bytes(&table->columns[i], capacity);
    const bool mapped = bytes >= LEAST_MAPPED;
    assert(mapped || !table->mapped); /* it only grows */
    if (mapped)
        bytes += table->column_count * (2 * page_bytes() + (table->mapped ? LARGE : 0));
    char *memory =
        mapped ? mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) : calloc(bytes, 1);
    if (!memory || (mapped && memory == MAP_FAILED))
        return false;
    tl_pages_large(memory, bytes);
    char *at = memory;
    for (size_t i = 0; i < table->column_count; i++) {
        at = place_column(table, i, capacity, at, mapped);
        take_rows(table, i, at);
        put(table, &table->columns[i], at);
        at += column_bytes(&table->columns[i], capacity);
    }
    release(table->memory, table->mapped);
    if (!table->mapped || table->rows == 0) /* pages that were moved may have more than the rows */
        table->used = table->rows;
    table->memory = memory;
    table->mapped = mapped ? bytes : 0;
    table->capacity = capacity;
    return true;
}

bool tl_table_reserve(tl_table *table, size_t rows)
{
    if (rows <= table->capacity)
        return true;
    size_t grown = table->capacity + table->capacity / GROWTH;
    return allocate(table, ((rows > grown ? rows : grown) + ROW_ROUND - 1) / ROW_ROUND * ROW_ROUND);
}

bool tl_table_widen(tl_table *table, const tl_column *columns, size_t count)
{
    assert(table->column_count + count <= TL_TABLE_COLUMNS);
    for (size_t i = 0; i < count; i++) {
        table->columns[table->column_count + i] = columns[i];
        put(table, &columns[i], NULL);
    }
    table->column_count += count;
    if (table->capacity == 0 || allocate(table, table->capacity))
        return true;
    table->column_count -= count;
    return false;
}

bool tl_table_need(tl_table *table, const char *name, size_t size, size_t offset, unsigned flags)
{
    for (size_t i = 0; i < table->column_count; i++)
        if (table->columns[i].offset == offset)
            return true;
    const tl_column column = {name, size, offset, flags};
    return tl_table_widen(table, &column, 1);
}

bool tl_table_resize(tl_table *table, size_t rows)
{
    if (!tl_table_reserve(table, rows))
        return false;
    /* A vector loop may have run past the last row, up to the next multiple. */
    size_t used = (table->used + ROW_ROUND - 1) / ROW_ROUND * ROW_ROUND;
    size_t end = rows < used ? rows : used;
    for (size_t i = 0; end > table->rows && i < table->column_count; i++) {
        size_t size = table->columns[i].size;
        memset((char *)get(table, &table->columns[i]) + table->rows * size, 0, (end - table->rows) * size);
    }
    table->rows = rows;
    table->used = rows > table->used ? rows : table->used;
    return true;
}

void tl_table_keep(tl_table *table, const unsigned char *keep)
{
    size_t kept = 0;
    for (size_t row = 0; row < table->rows;) {
        size_t end = row;
        while (end < table->rows && keep[end])
            end++;
        for (size_t i = 0; kept != row && i < table->column_count; i++) {
            size_t size = table->columns[i].size;
            char *data = get(table, &table->columns[i]);
            memmove(data + kept * size, data + row * size, (end - row) * size);
        }
        kept += end - row;
        for (row = end; row < table->rows && !keep[row];)
            row++;
    }
    table->rows = kept;
}

void tl_table_insert(tl_table *table, const uint32_t *at, size_t count)
{
    size_t rows = table->rows;
    assert(rows + count <= table->capacity);
    for (size_t i = 0; count && i < table->column_count; i++) {
        size_t size = table->columns[i].size, to = rows, from = rows - count;
        char *data = get(table, &table->columns[i]);
        memcpy(data + rows * size, data + from * size, count * size);
        for (size_t k = count; k-- > 0;) {
            size_t behind = to - at[k] - 1;
            from -= behind;
            memmove(data + (at[k] + 1) * size, data + from * size, behind * size);
            memcpy(data + at[k] * size, data + (rows + k) * size, size);
            to = at[k];
        }
    }
    table->used = rows + count > table->used ? rows + count : table->used;
}

void tl_table_move(tl_table *table, size_t to, size_t from)
{
    for (size_t i = 0; i < table->column_count; i++) {
        size_t size = table->columns[i].size;
        char *data = get(table, &table->columns[i]);
        memcpy(data + to * size, data + from * size, size);
    }
}

void *tl_table_data(const tl_table *table, size_t column)
{
    return get(table, &table->columns[column]);
}

bool tl_table_copy(tl_table *table, void *owner, const tl_table *from)
{
    *table = *from;
    table->owner = owner;
    table->memory = NULL;
    table->mapped = 0;
    for (size_t i = 0; i < table->column_count; i++)
        put(table, &table->columns[i], get(from, &table->columns[i])); /* allocate copies it */
    if (from->capacity == 0 || allocate(table, from->capacity))
        return true;
    tl_table_free(table);
    return false;
}

size_t tl_table_bytes(const tl_table *table)
{
    size_t row = 0;
    for (size_t i = 0; i < table->column_count; i++)
        row += table->columns[i].size;
    return row * (table->mapped ? table->used : table->capacity);
}

void tl_table_free(tl_table *table)
{
    for (size_t i = 0; i < table->column_count; i++)
        put(table, &table->columns[i], NULL);
    release(table->memory, table->mapped);
    table->memory = NULL;
    table->mapped = 0;
    table->rows = table->capacity = table->used = 0;
}
