/* walk.c - the entries of segments. */
#include "segment/walk.h"

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "segments.", s, member)
#define LIST(keep, member, count, capacity)                                                                            \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "segments.", s, member, &s->count, &s->capacity, offsetof(tl_memory, zones))

void tl_segments_walk(struct tl_segments *s, const tl_walk *walk)
{
    const size_t counts = offsetof(tl_memory, zones);
    tl_walk_table(walk, TL_KEEP_STATE, "segments.table", &s->table.table, counts);
    tl_walk_table(walk, TL_KEEP_STATE, "segments.points", &s->points.table, counts);
    tl_walk_table(walk, TL_KEEP_SCRATCH, "segments.spare", &s->spare.table, counts);
    tl_walk_table(walk, TL_KEEP_SCRATCH, "segments.spare_points", &s->spare_points.table, counts);
    LIST(SCRATCH, spare_outline, spare_outline_capacity, spare_outline_capacity);
    VALUE(STATE, points.state_columns);
    LIST(STATE, outline, outline_count, outline_capacity);
    LIST(STATE, meet, meet_count, meet_capacity);
    LIST(STATE, span, span_count, span_capacity);
    LIST(DERIVED, use, use_capacity, use_capacity);
    LIST(DERIVED, body_use, body_use_capacity, body_use_capacity);
    LIST(DERIVED, use_start, use_start_capacity, use_start_capacity);
    LIST(DERIVED, body_start, body_start_capacity, body_start_capacity);
    VALUE(DERIVED, bodies_listed);
    LIST(DERIVED, touched, touched_capacity, touched_capacity);
    VALUE(DERIVED, touched_count);
    LIST(SCRATCH, now, now_capacity, now_capacity);
    LIST(SCRATCH, damping, damping_capacity, damping_capacity);
    LIST(SCRATCH, corner, corner_capacity, corner_capacity);
    LIST(SCRATCH, box, box_capacity, box_capacity);
    LIST(SCRATCH, blend, blend_capacity, blend_capacity);
    VALUE(STATE, lost);
    VALUE(STATE, asked);
    VALUE(CACHE, structure);
    VALUE(CACHE, followed);
    VALUE(CACHE, laws);
    VALUE(CACHE, zones);
    VALUE(CACHE, lists);
    VALUE(CACHE, version);
}
