/* store.c - the detection as a whole: let go of, and given the columns that laws and initial forces need. */
#include "contact/store.h"

#include "base/entries.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/index.h"
#include "contact/walk.h"

#include <stdlib.h>

tl_detect *tl_detect_make(unsigned threads, const tl_contact_kind *const *kinds, uint32_t count)
{
    tl_detect *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    d->kinds = kinds;
    d->kind_count = count;
    d->threads = threads;
    d->narrow = calloc(threads, sizeof *d->narrow);
    d->lanes = calloc(threads, sizeof *d->lanes);
    tl_contacts_init(&d->contacts, &d->points);
    tl_contacts_init(&d->spare, &d->spare_points);
    if (!d->narrow || !d->lanes) {
        tl_detect_destroy(d);
        return NULL;
    }
    for (unsigned i = 0; i < threads; i++)
        tl_point_lanes_init(&d->lanes[i]);
    d->narrow[0].deep =
        true; /* contacts that are copied or read into it may be marked: overlap.c */
    tl_contacts_unlist(d);
    return d;
}

void tl_detect_destroy(tl_detect *d)
{
    tl_table_free(&d->contacts.table);
    tl_table_free(&d->spare.table);
    tl_table_free(&d->points.table);
    tl_table_free(&d->spare_points.table);
    for (unsigned i = 0; d->narrow && i < d->threads; i++)
        tl_narrow_scratch_free(&d->narrow[i]);
    for (unsigned i = 0; d->lanes && i < d->threads; i++)
        tl_table_free(&d->lanes[i].table);
    free(d->narrow);
    free(d->lanes);
    free(d->press);
    free(d->pairs);
    free(d->chunks);
    free(d->odometer_0);
    free(d->known_blocks);
    tl_layout_free(&d->layout);
    free(d->path);
    free(d->touched);
    free(d->idle);
    free(d->by_block);
    free(d->by_block_start);
    free(d->by_id);
    tl_cut_contacts_end(d);
    free(d);
}

/* The spare table, in which nothing is kept, gets the columns of the other: with no rows that cannot fail. */
bool tl_detect_hold_initial(tl_detect *d)
{
    if (!tl_points_hold_initial(&d->points))
        return false;
    tl_table_free(&d->spare_points.table);
    return tl_points_hold_initial(&d->spare_points);
}

bool tl_detect_hold_states(tl_detect *d, uint32_t columns)
{
    if (!tl_points_hold_states(&d->points, columns))
        return false;
    tl_table_free(&d->spare_points.table);
    return tl_points_hold_states(&d->spare_points, columns);
}

/* ---------------------------------------------------------------- copies ------------------
 *
 * A second detection in the same state as the first. Its own lists are made with the room that is in use only, and grow
 * when they have to. */

tl_detect *tl_detect_copy(const tl_detect *from)
{
    tl_detect *d = tl_detect_make(from->threads, from->kinds, from->kind_count);
    if (!d)
        return NULL;
    tl_entries entries = {.count = 0};
    tl_detect_walk((tl_detect *)(uintptr_t)from, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_detect_walk(d, &(tl_walk){tl_entries_take, &copy});
    d->spare_points.state_columns = d->points.state_columns; /* it has the same columns */
    d->spare_points.initial = d->points.initial;
    d->lane_capacity = from->lane_capacity;
    if (!copy.failed && tl_detect_hold_lanes(d, d->lane_capacity))
        return d;
    tl_detect_destroy(d);
    return NULL;
}
