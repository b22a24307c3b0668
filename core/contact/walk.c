/* walk.c - the entries of a detection. */
#include "contact/walk.h"

#include <talus/talus.h>

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "detect.", d, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "detect.", d, member)
#define LIST(keep, member, count, capacity, bytes)                                                                     \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "detect.", d, member, &d->count, &d->capacity, offsetof(tl_memory, bytes))
#define TABLE(keep, member, bytes)                                                                                     \
    tl_walk_table(walk, TL_KEEP_##keep, "detect." #member, &d->member.table, offsetof(tl_memory, bytes))

/* Pairs, and how far blocks have moved since they were listed. */
static void walk_pairs(tl_detect *d, const tl_walk *walk)
{
    LIST(CACHE, pairs, pair_count, pair_capacity, pairs);
    LIST(CACHE, chunks, chunk_capacity, chunk_capacity, pairs);
    FLAG(CACHE, listed);
    VALUE(CACHE, reach);
    LIST(CACHE, odometer_0, odometer_capacity, odometer_capacity, broad);
    LIST(CACHE, known_blocks, known_block_count, known_block_capacity, broad);
    LIST(CACHE, path, path_capacity, path_capacity, broad);
    VALUE(CACHE, longest_path);
    LIST(CACHE, touched, touched_capacity, touched_capacity, broad);
    FLAG(CACHE, any_touched);
    LIST(CACHE, idle, idle_capacity, idle_capacity, broad);
    FLAG(CACHE, any_idle);
}

static void walk_contacts(tl_detect *d, const tl_walk *walk)
{
    FLAG(STATE, stepped);
    FLAG(CACHE, rows_changed);
    FLAG(CACHE, any_without_rows);
    TABLE(STATE, contacts, contacts);
    VALUE(STATE, points.state_columns);
    FLAG(STATE, points.initial);
    TABLE(STATE, points, points);
    LIST(STATE, press, press_count, press_capacity, facets);
    VALUE(CACHE, press_free);
    LIST(STATE, cut_contacts, cut_count, cut_capacity, other);
    LIST(STATE, cut_points, cut_point_count, cut_point_capacity, other);
    VALUE(STATE, parted);
    VALUE(CACHE, laid_at);
    VALUE(CACHE, spare_share);
    LIST(CACHE, layout.spans, layout.span_count, layout.span_capacity, other);
    LIST(CACHE, layout.groups, layout.group_capacity, layout.group_capacity, index);
    TABLE(SCRATCH, spare, spare);
    TABLE(SCRATCH, spare_points, spare);
    LIST(DERIVED, by_block, by_block_capacity, by_block_capacity, index);
    LIST(DERIVED, by_block_start, by_start_capacity, by_start_capacity, index);
    VALUE(DERIVED, indexed);
}

void tl_detect_walk(tl_detect *d, const tl_walk *walk)
{
    VALUE(CACHE, structure);
    VALUE(CACHE, laws);
    VALUE(CACHE, rules);
    VALUE(CACHE, constraints);
    VALUE(CACHE, contact_points);
    walk_pairs(d, walk);
    walk_contacts(d, walk);
}
