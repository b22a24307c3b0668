/* table.c - see table.h. */
#include "base/table.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Capacities are multiples of this, so that a vector loop may run past the last row. */
#define ROW_ROUND 16u

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

void *tl_aligned_alloc(size_t bytes)
{
    size_t rounded = (bytes + TL_ALIGN - 1) / TL_ALIGN * TL_ALIGN;
    void *data = aligned_alloc(TL_ALIGN, rounded ? rounded : TL_ALIGN);
    if (data)
        memset(data, 0, rounded ? rounded : TL_ALIGN);
    return data;
}

bool tl_grow(void *slot, size_t *room, size_t need, size_t size)
{
    if (need <= *room)
        return true;
    size_t fresh = need + need / 2 + 16;
    void *data;
    memcpy(&data, slot, sizeof data);
    data = realloc(data, fresh * size);
    if (!data)
        return false;
    memcpy(slot, &data, sizeof data);
    *room = fresh;
    return true;
}

bool tl_table_reserve(tl_table *table, size_t rows)
{
    if (rows <= table->capacity)
        return true;
    size_t grown = table->capacity + table->capacity / 2;
    size_t capacity = ((rows > grown ? rows : grown) + ROW_ROUND - 1) / ROW_ROUND * ROW_ROUND;
    void *fresh[TL_TABLE_COLUMNS];
    for (size_t i = 0; i < table->column_count; i++) {
        fresh[i] = tl_aligned_alloc(capacity * table->columns[i].size);
        if (!fresh[i]) {
            while (i-- > 0)
                free(fresh[i]);
            return false;
        }
    }
    for (size_t i = 0; i < table->column_count; i++) {
        void *old = get(table, &table->columns[i]);
        if (old)
            memcpy(fresh[i], old, table->rows * table->columns[i].size);
        free(old);
        put(table, &table->columns[i], fresh[i]);
    }
    table->capacity = capacity;
    return true;
}

bool tl_table_resize(tl_table *table, size_t rows)
{
    if (!tl_table_reserve(table, rows))
        return false;
    if (rows > table->rows)
        for (size_t i = 0; i < table->column_count; i++) {
            size_t size = table->columns[i].size;
            memset((char *)get(table, &table->columns[i]) + table->rows * size, 0,
                   (rows - table->rows) * size);
        }
    table->rows = rows;
    return true;
}

void tl_table_keep(tl_table *table, const unsigned char *keep)
{
    size_t kept = 0;
    for (size_t i = 0; i < table->column_count; i++) {
        size_t size = table->columns[i].size;
        char *data = get(table, &table->columns[i]);
        kept = 0;
        for (size_t row = 0; row < table->rows; row++) {
            if (!keep[row])
                continue;
            if (kept != row)
                memcpy(data + kept * size, data + row * size, size);
            kept++;
        }
    }
    if (table->column_count)
        table->rows = kept;
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

size_t tl_table_bytes(const tl_table *table)
{
    size_t row = 0;
    for (size_t i = 0; i < table->column_count; i++)
        row += table->columns[i].size;
    return row * table->capacity;
}

void tl_table_free(tl_table *table)
{
    for (size_t i = 0; i < table->column_count; i++) {
        free(get(table, &table->columns[i]));
        put(table, &table->columns[i], NULL);
    }
    table->rows = table->capacity = 0;
}
