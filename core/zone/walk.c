/* walk.c - the entries of zones. */
#include "zone/walk.h"

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "zones.", z, member)
#define LIST(keep, member, count, capacity)                                                                            \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "zones.", z, member, &z->count, &z->capacity, offsetof(tl_memory, zones))

void tl_zones_walk(struct tl_zones *z, const tl_walk *walk)
{
    const size_t counts = offsetof(tl_memory, zones);
    tl_walk_table(walk, TL_KEEP_STATE, "zones.points", &z->points.table, counts);
    tl_walk_table(walk, TL_KEEP_STATE, "zones.zones", &z->zones.table, counts);
    tl_walk_table(walk, TL_KEEP_STATE, "zones.parcels", &z->parcels.table, counts);
    VALUE(STATE, zones.state_columns);
    LIST(STATE, group, group_count, group_capacity);
    LIST(STATE, listed, listed_count, listed_capacity);
    LIST(STATE, row_of, row_of_count, row_of_capacity);
    LIST(STATE, part, part_count, part_capacity);
    LIST(STATE, mesh, mesh_count, mesh_capacity);
    LIST(STATE, outer, outer_count, outer_capacity);
    LIST(STATE, meeting, meeting_count, meeting_capacity);
    LIST(DERIVED, use, use_capacity, use_capacity);
    LIST(DERIVED, use_start, use_start_capacity, use_start_capacity);
    LIST(SCRATCH, slot, slot_capacity, slot_capacity);
    LIST(SCRATCH, scratch, scratch_capacity, scratch_capacity);
    LIST(SCRATCH, motion, motion_capacity, motion_capacity);
    VALUE(STATE, moved_dt);
    VALUE(STATE, steps_kept);
    VALUE(CACHE, version);
    VALUE(CACHE, followed);
    VALUE(CACHE, highest_rate);
    VALUE(CACHE, lowest_rate);
    VALUE(CACHE, highest);
    VALUE(CACHE, lowest);
    VALUE(CACHE, rated_for);
    VALUE(CACHE, rated_at);
    VALUE(CACHE, segments_rated);
    VALUE(CACHE, elements_rated);
}
