/* copy.c - a second detection in the same state as the first. Its own lists are made with the room that is in use only, and grow
 * when they have to. */
#include "contact/copy.h"

#include "base/entries.h"
#include "contact/contacts.h"
#include "contact/store.h"
#include "contact/walk.h"

tl_detect *tl_detect_copy(const tl_detect *from)
{
    tl_detect *d = tl_detect_make(from->threads);
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
