/* copy.c - a model once more, in the same state: from the same next call on both go on alike, to the bit. */
#include "base/entries.h"
#include "contact/detection.h"
#include "contact/store.h"
#include "cycle/prepare.h"
#include "cycle/undo.h"
#include "element/life.h"
#include "element/walk.h"
#include "model/joints.h"
#include "model/rows.h"
#include "model/seats.h"
#include "model/walk.h"
#include "segment/lay.h"
#include "segment/walk.h"
#include "state/drives.h"
#include "state/parts.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/walk.h"

#include <stdlib.h>
#include <string.h>

/* The copies' own lists are made with the capacity that is in use only, and grow when they have to. */

/* Columns of blocks and bodies, lists and values. The polyhedra are still to be copied. */
static bool copy_rows(tl_model *to, tl_model *from)
{
    tl_entries entries = {.count = 0};
    tl_model_walk(from, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_model_walk(to, &(tl_walk){tl_entries_take, &copy});
    for (size_t row = 0; row < to->blocks.table.rows; row++)
        to->blocks.shape[row] = NULL; /* it is the original's */
    return !copy.failed;
}

static bool copy_names(tl_model *to, const tl_model *from)
{
    for (size_t i = 0; i < from->group_count; i++)
        if (tl_group_intern(to, from->groups[i]) == UINT32_MAX)
            return false;
    for (size_t i = 0; i < from->joint_count; i++) {
        if (tl_joint_intern(to, from->joints[i].name) == 0)
            return false;
        to->joints[i].planes = from->joints[i].planes;
    }
    return true;
}

static tl_status copy_detection(tl_model *to, const tl_model *from)
{
    const tl_detect *lasting = tl_detect_lasting(from);
    if (!lasting)
        return TL_OK;
    to->detect_destroy = from->detect_destroy;
    to->detect = tl_detect_copy(lasting);
    return to->detect ? TL_OK : tl_fail_memory(&to->error);
}

/* Meshes and segments; the solids have been copied. */
static tl_status copy_zones(tl_model *to, const tl_model *from)
{
    if (!from->zones)
        return TL_OK;
    tl_status status = tl_zones_begin(to);
    if (status != TL_OK)
        return status;
    tl_entries entries = {.count = 0};
    tl_zones_walk(from->zones, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_zones_walk(to->zones, &(tl_walk){tl_entries_take, &copy});
    if (from->segments && !copy.failed) {
        if (!tl_segments_begin(to))
            return tl_fail_memory(&to->error);
        entries.count = 0;
        tl_segments_walk(from->segments, &(tl_walk){tl_entries_note, &entries});
        copy = (tl_entries_copy){.from = &entries};
        tl_segments_walk(to->segments, &(tl_walk){tl_entries_take, &copy});
    }
    return copy.failed || !tl_grow(&to->zones->slot, &to->zones->slot_capacity, to->zones->listed_count,
                                   sizeof *to->zones->slot)
               ? tl_fail_memory(&to->error)
               : TL_OK;
}

/* The sets have been copied, and so the tables are there. */
static tl_status copy_elements(tl_model *to, const tl_model *from)
{
    if (!from->elements)
        return TL_OK;
    tl_entries entries = {.count = 0};
    tl_elements_walk(from->elements, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_elements_walk(to->elements, &(tl_walk){tl_entries_take, &copy});
    return copy.failed ? tl_fail_memory(&to->error) : TL_OK;
}

static tl_status copy_cycle(tl_model *to, const tl_model *from)
{
    if (!from->cycle)
        return TL_OK;
    tl_status status = tl_cycle_prepare(to);
    if (status != TL_OK)
        return status;
    tl_entries entries = {.count = 0};
    tl_cycle_walk(from->cycle, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_cycle_walk(to->cycle, &(tl_walk){tl_entries_take, &copy});
    return copy.failed ? tl_fail_memory(&to->error) : TL_OK;
}

static tl_status fill(tl_model *to, tl_model *from, const tl_drives_again *again)
{
    if (!copy_rows(to, from) || !copy_names(to, from))
        return tl_fail_memory(&to->error);
    tl_status status = TL_OK;
    for (const tl_state_part *const *part = tl_state_parts; *part && status == TL_OK; part++)
        if ((*part)->copy)
            status = (*part)->copy(to, from);
    if (status == TL_OK && !tl_seats_follow(to))
        status = tl_fail_memory(&to->error);
    if (status == TL_OK)
        status = copy_detection(to, from);
    if (status == TL_OK)
        status = copy_zones(to, from);
    if (status == TL_OK)
        status = copy_elements(to, from);
    if (status == TL_OK) /* gridpoints may follow them */
        status = tl_drives_copy(to, from, again);
    return status == TL_OK ? copy_cycle(to, from) : status;
}

tl_status tl_model_copy(tl_model *m, tl_drive_again_fn again, void *user, tl_model **copy)
{
    *copy = NULL;
    tl_status status = tl_model_may_set(m, "copy the model");
    if (status != TL_OK)
        return status;
    if (m->cycle && tl_undo_lost(m->cycle))
        return tl_fail(&m->error, TL_E_STATE,
                       "copy: cycle %lld failed and could not be taken back: make the model anew",
                       (long long)m->cycles + 1);
    tl_rows_tidy(m);
    tl_model *to;
    status = tl_model_create(&m->config, &to, &m->error);
    if (status != TL_OK)
        return status;
    tl_model_log(to, m->log, m->log_user);
    tl_model_speak_lua(to, m->speaks_lua);
    to->interrupt_asked = m->interrupt_asked;
    status = fill(to, m, &(tl_drives_again){again, user});
    if (status != TL_OK) {
        m->error = to->error;
        tl_model_destroy(to);
        return status;
    }
    *copy = to;
    return TL_OK;
}
