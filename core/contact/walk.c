/* walk.c - the entries of a detection. */
#include "contact/walk.h"

#include <talus/talus.h>

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "detect.", d, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "detect.", d, member)
#define LIST(keep, member, count, room, bytes)                                                     \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "detect.", d, member, &d->count, &d->room,                  \
                 offsetof(tl_memory, bytes))
#define TABLE(keep, member, bytes)                                                                 \
    tl_walk_table(walk, TL_KEEP_##keep, "detect." #member, &d->member.table,                       \
                  offsetof(tl_memory, bytes))

/* Pairs, and how far blocks have moved since they were listed. */
static void walk_pairs(tl_detect *d, const tl_walk *walk)
{
    LIST(CACHE, pairs, pair_count, pair_room, pairs);
    LIST(CACHE, chunks, chunk_room, chunk_room, pairs);
    FLAG(CACHE, listed);
    VALUE(CACHE, reach);
    LIST(CACHE, odometer_0, odometer_room, odometer_room, broad);
    LIST(CACHE, known_blocks, known_block_count, known_block_room, broad);
    LIST(CACHE, path, path_room, path_room, broad);
    VALUE(CACHE, longest_path);
    LIST(CACHE, touched, touched_room, touched_room, broad);
    FLAG(CACHE, any_touched);
    LIST(CACHE, idle, idle_room, idle_room, broad);
    FLAG(CACHE, any_idle);
}

static void walk_contacts(tl_detect *d, const tl_walk *walk)
{
    VALUE(STATE, next_contact);
    FLAG(CACHE, rows_changed);
    FLAG(CACHE, bare);
    TABLE(STATE, contacts, contacts);
    VALUE(STATE, points.state_columns);
    FLAG(STATE, points.initial);
    TABLE(STATE, points, points);
    LIST(STATE, press, press_count, press_room, facets);
    VALUE(CACHE, press_free);
    VALUE(STATE, parted);
    VALUE(CACHE, laid_at);
    VALUE(CACHE, spare_share);
    LIST(CACHE, layout.spans, layout.span_count, layout.span_room, other);
    LIST(CACHE, layout.groups, layout.group_room, layout.group_room, index);
    VALUE(CACHE, lane_room);
    TABLE(SCRATCH, spare, spare);
    TABLE(SCRATCH, spare_points, spare);
    LIST(DERIVED, by_block, by_block_room, by_block_room, index);
    LIST(DERIVED, by_block_start, by_start_room, by_start_room, index);
    VALUE(DERIVED, indexed);
    LIST(DERIVED, by_id, by_id_room, by_id_room, index);
    FLAG(DERIVED, by_id_fresh);
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
