/* element_forces.c - elements act on bodies: a contributor of a step. */
#include "cycle/element_forces.h"

#include "base/columns.h"
#include "cycle/cycle_data.h"
#include "cycle/undo.h"
#include "element/act.h"
#include "element/follow.h"
#include "element/together.h"

#include <string.h>

static tl_status apply(tl_model *m)
{
    return tl_elements_apply(m, &m->cycle->failure);
}

static void hold(const tl_model *m, uint32_t body, bool points, tl_holding *sum)
{
    if (points)
        tl_elements_hold(m, body, sum);
}

static size_t tables(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES])
{
    table[0] = &m->elements->table.table;
    table[1] = &m->elements->nodes.table;
    table[2] = &m->elements->steady.table;
    return 3;
}

static bool may_fail(const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    bool sure = tl_elements_are_listed(m) && e->most_k < TL_UNDO_TAME && e->most_c < TL_UNDO_TAME;
    for (size_t k = 0; sure && k < e->set_count; k++)
        sure = tl_element_ops_of(&e->set[k])->never_fails;
    return !sure || tl_elements_together_due(m);
}

void tl_elements_pull(const tl_model *m, tl_vec3 *force)
{
    const tl_node_table *n = m->elements ? &m->elements->nodes : NULL;
    memset(force, 0, m->bodies.table.rows * sizeof *force);
    for (uint32_t row = 0; n && tl_elements_are_listed(m) && row < n->table.rows; row++)
        if (n->body[row] != TL_NO_ROW)
            force[n->body[row]] = tl_v3_add(force[n->body[row]], tl_columns_get(n->force, row));
}

const tl_contributor tl_elements_act = {.name = "elements",
                                        .apply = apply,
                                        .gather = tl_elements_gather,
                                        .stiffness = tl_elements_stiffness,
                                        .hold = hold,
                                        .energies = tl_elements_energies,
                                        .tables = tables,
                                        .may_fail = may_fail};
