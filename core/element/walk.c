/* walk.c - the entries of elements. */
#include "element/walk.h"

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "elements.", e, member)
#define LIST(keep, member, count, capacity)                                                                            \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "elements.", e, member, &e->count, &e->capacity, offsetof(tl_memory, elements))

void tl_elements_walk(struct tl_elements *e, const tl_walk *walk)
{
    const size_t counts = offsetof(tl_memory, elements);
    tl_walk_table(walk, TL_KEEP_STATE, "elements.table", &e->table.table, counts);
    tl_walk_table(walk, TL_KEEP_STATE, "elements.nodes", &e->nodes.table, counts);
    tl_walk_table(walk, TL_KEEP_STATE, "elements.steady", &e->steady.table, counts);
    VALUE(STATE, table.state_columns);
    VALUE(STATE, nodes.state_columns);
    LIST(DERIVED, chunk, chunk_count, chunk_capacity);
    LIST(DERIVED, use, use_capacity, use_capacity);
    LIST(DERIVED, use_start, use_start_capacity, use_start_capacity);
    LIST(DERIVED, steady_start, steady_start_capacity, steady_start_capacity);
    LIST(DERIVED, carried, carried_count, carried_capacity);
    VALUE(STATE, next_id);
    VALUE(CACHE, version);
    VALUE(DERIVED, listed);
    VALUE(DERIVED, any_steady);
    VALUE(DERIVED, all_steady);
    VALUE(DERIVED, most_k);
    VALUE(DERIVED, most_c);
    VALUE(CACHE, rated);
    VALUE(CACHE, followed);
    VALUE(CACHE, zones);
}
