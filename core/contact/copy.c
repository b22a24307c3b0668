/* copy.c - a second detection in the same state as the first: on it can be tried what the next step would find. */
#include "contact/copy.h"

#include "contact/contacts.h"
#include "contact/store.h"

#include <stdlib.h>
#include <string.h>

/* Makes the copy of a table an empty one of the same columns; its pointers are still those of the original. */
static void empty_table(tl_table *table, void *owner)
{
    table->owner = owner;
    table->memory = NULL;
    tl_table_free(table);
}

/* Lets go of the list at `slot`, which is the original's, and makes the copy one of its own; false when out of memory. */
static bool copy_list(void *slot, size_t count, size_t size)
{
    void *from, *to = NULL;
    memcpy(&from, slot, sizeof from);
    bool wanted = from && count > 0;
    if (wanted && (to = malloc(count * size)))
        memcpy(to, from, count * size);
    memcpy(slot, &to, sizeof to);
    return !wanted || to;
}

/* All lists, whether or not there is memory for the ones before: none stays the original's. */
static bool copy_lists(tl_detect *d)
{
    const struct {
        void *slot;
        size_t count, size;
    } lists[] = {
        {&d->pairs, d->pair_room, sizeof *d->pairs},
        {&d->chunks, d->chunk_room, sizeof *d->chunks},
        {&d->odometer_0, d->odometer_room, sizeof *d->odometer_0},
        {&d->seen, d->seen_room, sizeof *d->seen},
        {&d->run, d->run_of_room, sizeof *d->run},
        {&d->touched, d->touched_room, sizeof *d->touched},
        {&d->idle, d->idle_room, sizeof *d->idle},
        {&d->press, d->press_room, sizeof *d->press},
        {&d->layout.runs, d->layout.run_room, sizeof *d->layout.runs},
        {&d->layout.ranks, d->layout.rank_room, sizeof *d->layout.ranks},
        {&d->by_block, d->by_block_room, sizeof *d->by_block},
        {&d->by_block_start, d->by_start_room, sizeof *d->by_block_start},
        {&d->by_id, d->by_id_room, sizeof *d->by_id},
    };
    bool all = true;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        all = copy_list(lists[i].slot, lists[i].count, lists[i].size) && all;
    return all;
}

/* Rooms of the threads, in which nothing is kept. */
static bool make_scratch(tl_detect *d)
{
    d->narrow = calloc(d->threads, sizeof *d->narrow);
    d->lanes = calloc(d->threads, sizeof *d->lanes);
    if (!d->narrow || !d->lanes)
        return false;
    bool all = true;
    for (unsigned i = 0; i < d->threads; i++) {
        tl_point_lanes_init(&d->lanes[i]);
        all = all && tl_table_resize(&d->lanes[i].table, d->lane_room);
    }
    return all;
}

tl_detect *tl_detect_copy(const tl_detect *from)
{
    tl_detect *d = malloc(sizeof *d);
    if (!d)
        return NULL;
    *d = *from;
    empty_table(&d->spare.table, &d->spare);
    empty_table(&d->spare_points.table, &d->spare_points);
    bool all = tl_table_copy(&d->contacts.table, &d->contacts, &from->contacts.table);
    all = tl_table_copy(&d->points.table, &d->points, &from->points.table) && all;
    all = copy_lists(d) && all;
    if (make_scratch(d) && all)
        return d;
    tl_detect_destroy(d);
    return NULL;
}
