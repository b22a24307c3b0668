/* entries.c - all entries of one owner copied to another. */
#include "base/entries.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tl_entries_note(void *user, const tl_entry *entry)
{
    tl_entries *entries = user;
    assert(entries->count < TL_MOST_ENTRIES);
    entries->list[entries->count++] = *entry;
}

void tl_entry_put_list(const tl_entry *to, void *list, size_t items)
{
    void *old;
    memcpy(&old, to->at, sizeof old);
    free(old);
    memcpy(to->at, &list, sizeof list);
    *to->count = items;
    if (to->capacity)
        *to->capacity = items;
}

static bool copy_list(const tl_entry *to, const tl_entry *from)
{
    const void *source;
    memcpy(&source, from->at, sizeof source);
    size_t items = source ? from->items : 0;
    void *list = items ? malloc(items * from->size) : NULL;
    bool copied = list || !items;
    if (list)
        memcpy(list, source, items * from->size);
    tl_entry_put_list(to, list, copied ? items : 0);
    return copied;
}

static bool copy_table(const tl_entry *to, const tl_entry *from)
{
    tl_table_free(to->at);
    return tl_table_copy(to->at, to->at, from->at);
}

/* Makes an empty table of the same columns in the place of one. */
static void take_columns(tl_table *to, const tl_table *from)
{
    tl_table_free(to);
    *to = *from;
    to->owner = to;
    to->memory = NULL;
    to->mapped = 0;
    tl_table_free(to);
}

void tl_entries_take(void *user, const tl_entry *to)
{
    tl_entries_copy *copy = user;
    assert(copy->next < copy->from->count);
    const tl_entry *from = &copy->from->list[copy->next++];
    assert(strcmp(from->name, to->name) == 0);
    bool copied = true;
    if (to->keep == TL_KEEP_SCRATCH) {
        if (to->form == TL_ENTRY_TABLE)
            take_columns(to->at, from->at);
        return;
    }
    if (to->form == TL_ENTRY_LIST)
        copied = copy_list(to, from);
    else if (to->form == TL_ENTRY_TABLE)
        copied = copy_table(to, from);
    else
        memcpy(to->at, from->at, to->size);
    copy->failed = copy->failed || !copied;
}

void tl_entry_name(const tl_entry *entry, char name[TL_COLUMN_CHUNK])
{
    snprintf(name, TL_COLUMN_CHUNK, "%s%s", entry->prefix ? entry->prefix : "", entry->name);
}

void tl_column_chunk(const char *table_name, const tl_table *table, size_t k, char name[TL_COLUMN_CHUNK])
{
    const char *own = table->columns[k].name;
    size_t before = 0;
    for (size_t i = 0; i < k; i++)
        before += strcmp(table->columns[i].name, own) == 0;
    if (before)
        snprintf(name, TL_COLUMN_CHUNK, "%s.%s.%zu", table_name, own, before);
    else
        snprintf(name, TL_COLUMN_CHUNK, "%s.%s", table_name, own);
}
