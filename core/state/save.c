/* save.c - a model into a file, or into bytes: all entries of its modules by their names, and what has owners of its
 * own. Nothing in the model changes by it, so that it makes no difference to a run when it is saved. */
#include "state/save.h"

#include "base/entries.h"
#include "base/signals.h"
#include "contact/store.h"
#include "cycle/prepare.h"
#include "cycle/undo.h"
#include "element/follow.h"
#include "element/walk.h"
#include "model/rows.h"
#include "model/walk.h"
#include "segment/walk.h"
#include "state/drives.h"
#include "state/parts.h"
#include "zone/walk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void save_table(tl_archive_writer *w, const char *name, const tl_table *table)
{
    char full[TL_CHUNK_NAME];
    uint64_t rows = table->rows;
    snprintf(full, sizeof full, "%.80s.rows", name);
    tl_archive_put(w, full, &rows, sizeof rows, 1);
    for (size_t k = 0; k < table->column_count; k++) {
        const tl_column *column = &table->columns[k];
        tl_column_chunk(name, table, k, full);
        if (!(column->flags & TL_COLUMN_OWNED))
            tl_archive_put(w, full, tl_table_data(table, k), column->size, table->rows);
    }
}

static void save_entry(void *user, const tl_entry *entry)
{
    tl_archive_writer *w = user;
    if (entry->keep != TL_KEEP_STATE && entry->keep != TL_KEEP_CACHE)
        return;
    char name[TL_COLUMN_CHUNK];
    tl_entry_name(entry, name);
    if (entry->form == TL_ENTRY_TABLE) {
        save_table(w, name, entry->at);
    } else if (entry->form == TL_ENTRY_LIST) {
        const void *list;
        memcpy(&list, entry->at, sizeof list);
        tl_archive_put(w, name, list, entry->size, list ? entry->items : 0);
    } else {
        tl_archive_put(w, name, entry->at, entry->size, 1);
    }
}

/* Names, each with its terminating zero, one after the other. */
static bool save_names(tl_archive_writer *w, const char *chunk, size_t count,
                       const char *name(const tl_model *m, size_t i), const tl_model *m)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++)
        bytes += strlen(name(m, i)) + 1;
    char *all = malloc(bytes + 1), *at = all;
    for (size_t i = 0; all && i < count; i++) {
        size_t length = strlen(name(m, i)) + 1;
        memcpy(at, name(m, i), length);
        at += length;
    }
    if (all)
        tl_archive_put(w, chunk, all, 1, bytes);
    free(all);
    return all != NULL;
}

static const char *group_name(const tl_model *m, size_t i)
{
    return m->groups[i];
}

static const char *joint_name(const tl_model *m, size_t i)
{
    return m->joints[i].name;
}

static bool save_planes(tl_archive_writer *w, const tl_model *m)
{
    uint32_t *planes = malloc((m->joint_count + 1) * sizeof *planes);
    for (size_t i = 0; planes && i < m->joint_count; i++)
        planes[i] = m->joints[i].planes;
    if (planes)
        tl_archive_put(w, "joints.planes", planes, sizeof *planes, m->joint_count);
    free(planes);
    return planes != NULL;
}

static void save_all(tl_archive_writer *w, tl_model *m)
{
    const tl_walk walk = {save_entry, w};
    tl_archive_put_text(w, "program", TALUS_VERSION);
    tl_model_walk(m, &walk);
    bool saved = save_names(w, "groups", m->group_count, group_name, m) &&
                 save_names(w, "joints.names", m->joint_count, joint_name, m) && save_planes(w, m);
    w->lost = w->lost || !saved;
    for (const tl_state_part *const *part = tl_state_parts; *part; part++)
        (*part)->save(m, w);
    tl_drives_save(m, w);
    if (tl_detect_lasting(m))
        tl_detect_walk(tl_detect_lasting(m), &walk);
    if (m->zones)
        tl_zones_walk(m->zones, &walk);
    if (m->segments)
        tl_segments_walk(m->segments, &walk);
    if (m->elements)
        tl_elements_walk(m->elements, &walk);
    if (m->cycle)
        tl_cycle_walk(m->cycle, &walk);
}

static tl_status save_under(tl_model *m, const char *path)
{
    tl_archive_writer w;
    tl_status status = tl_archive_begin(&w, path, &m->error);
    if (status != TL_OK)
        return status;
    save_all(&w, m);
    return tl_archive_end(&w, &m->error);
}

static tl_status prepare(tl_model *m)
{
    tl_rows_tidy(m);
    tl_elements_follow(m);
    if (!m->cycle)
        return TL_OK;
    if (tl_undo_lost(m->cycle))
        return tl_fail(&m->error, TL_E_STATE,
                       "save: cycle %lld failed and could not be taken back: make the model anew",
                       (long long)m->cycles + 1);
    return tl_cycle_prepare(m); /* a row for each body */
}

tl_status tl_model_save(tl_model *m, const char *path)
{
    tl_status status = tl_model_may_set(m, "save the model");
    if (status == TL_OK)
        status = prepare(m);
    if (status != TL_OK)
        return status;
    sigset_t before;
    tl_signals_hold(&before, false);
    status = save_under(m, path);
    tl_signals_release(&before);
    return status;
}

tl_status tl_model_bytes(tl_model *m, unsigned char **bytes, size_t *length)
{
    tl_archive_writer w;
    char *made;
    *bytes = NULL;
    tl_status status = prepare(m);
    if (status == TL_OK)
        status = tl_archive_begin_in_memory(&w, &made, length, &m->error);
    if (status != TL_OK)
        return status;
    save_all(&w, m);
    status = tl_archive_end(&w, &m->error);
    if (status == TL_OK)
        *bytes = (unsigned char *)made;
    else
        free(made);
    return status;
}
