/* sound.c - whether elements that were read from a file fit together. */
#include "element/sound.h"

#include "base/columns.h"
#include "element/carry.h"
#include "zone/zones.h"

#include <math.h>

/* Changes that may have been counted: sums of such numbers do not overflow. */
#define MOST_CHANGES (UINT64_MAX / 8)
/* Limit: sum of the sizes of a node's shares; those of a point in a zone add up to 1. */
#define MOST_SHARES 100

static bool places_are_sound(const tl_node_table *n, size_t row)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += n->rest[k][row] + n->local[k][row] + tl_node_bases(n)[k][row] + n->u[k][row] +
               (n->from[k] ? n->from[k][row] : 0) + (n->outward[k] ? n->outward[k][row] : 0) +
               (n->normal[k] ? n->normal[k][row] : 0);
    return isfinite(sum) && n->weight[row] >= 0 && isfinite(n->weight[row]) && n->k[row] >= 0 &&
           tl_node_damping(n, row) >= 0;
}

static bool carrier_is_sound(const tl_model *m, size_t row)
{
    const tl_node_table *n = &m->elements->nodes;
    const uint32_t body = n->body[row];
    if (body != TL_NO_ROW && body >= m->bodies.table.rows)
        return m->elements->followed != m->structure; /* it is found again before it is used */
    const uint32_t mesh = body == TL_NO_ROW ? 0 : m->bodies.mesh[body];
    double sum = 0;
    if (!n->share)
        return !mesh;
    for (int a = 0; a < 4; a++)
        sum += fabs(n->share[row][a]);
    if (!(sum <= MOST_SHARES))
        return false;
    for (int a = 0; mesh && a < 4; a++)
        if (n->point[row][a] >= m->zones->mesh[mesh - 1].point_end - m->zones->mesh[mesh - 1].point_begin)
            return false;
    return true;
}

const char *tl_elements_unsound(const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    uint32_t next = 0;
    tl_id last = 0;
    if (e->version == 0 || e->version > MOST_CHANGES || e->rated > e->version || e->followed > MOST_CHANGES)
        return "elements have an impossible count of changes";
    for (size_t row = 0; row < t->table.rows; row++) {
        if (t->id[row] <= last || t->id[row] >= e->next_id || t->set[row] >= e->set_count ||
            t->node_begin[row] != next || t->node_count[row] == 0 || t->node_count[row] > TL_ELEMENT_MANY ||
            t->node_count[row] > e->nodes.table.rows - next)
            return "an element has an impossible value";
        last = t->id[row];
        next += t->node_count[row];
    }
    if (next != e->nodes.table.rows)
        return "nodes do not fit their elements";
    for (size_t row = 0; row < e->nodes.table.rows; row++)
        if (!places_are_sound(&e->nodes, row) || !carrier_is_sound(m, row))
            return "a node of an element has an impossible value";
    return NULL;
}
