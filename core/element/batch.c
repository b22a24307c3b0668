/* batch.c - a share of the elements as their kind sees it. */
#include "element/batch.h"

#include <string.h>

tl_element_batch tl_element_batch_of(const tl_model *m, const tl_element_chunk *of, tl_element_lanes *lanes)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    const tl_node_table *n = &e->nodes;
    const size_t first = of->node_begin, count = of->node_end - first;
    const bool many = count > TL_ELEMENT_NODES;
    double *const room = many ? e->room + 9 * first : lanes->own[0];
    const size_t stride = many ? count : TL_LANES_ROOM;
    tl_element_batch batch = {.size = sizeof batch,
                              .count = of->end - of->begin,
                              .dt = tl_law_time(m, m->dt),
                              .time = m->time,
                              .origin = m->origin,
                              .start = lanes->start,
                              .weight = n->weight + first,
                              .state = lanes->state,
                              .element_state = lanes->element_state,
                              .flags = t->flags + of->begin,
                              .stored = t->stored + of->begin,
                              .lost = t->lost + of->begin,
                              .given = t->given + of->begin,
                              .memory = e->memory ? e->memory + of->begin : NULL};
    for (int k = 0; k < 3; k++) {
        lanes->du[k] = room + (size_t)k * stride;
        lanes->v[k] = room + (size_t)(3 + k) * stride;
        lanes->normal[k] = room + (size_t)(6 + k) * stride;
        batch.rest[k] = n->rest[k] + first;
        batch.u[k] = n->u[k] + first;
        batch.du[k] = lanes->du[k];
        batch.v[k] = lanes->v[k];
        batch.normal[k] = lanes->normal[k];
        batch.force[k] = n->force[k] + first;
    }
    for (uint32_t row = of->begin; row < of->end; row++)
        lanes->start[row - of->begin] = t->node_begin[row] - of->node_begin;
    lanes->start[batch.count] = of->node_end - of->node_begin;
    for (uint32_t k = 0; k < n->state_columns; k++)
        lanes->state[k] = n->state[k] + first;
    for (uint32_t k = 0; k < t->state_columns; k++)
        lanes->element_state[k] = t->state[k] + of->begin;
    return batch;
}

void tl_element_lanes_stop(tl_element_lanes *lanes, size_t nodes)
{
    for (int k = 0; k < 3; k++) {
        memset(lanes->du[k], 0, nodes * sizeof(double));
        memset(lanes->v[k], 0, nodes * sizeof(double));
        memset(lanes->normal[k], 0, nodes * sizeof(double));
    }
}
