/* element_forces.c - elements act on bodies: a contributor of a step. */
#include "cycle/element_forces.h"

#include "cycle/cycle_data.h"
#include "cycle/undo.h"
#include "element/act.h"
#include "element/follow.h"
#include "element/together.h"

static tl_status apply(tl_model *m)
{
    return tl_elements_apply(m, &m->cycle->failure);
}

static void hold(const tl_model *m, uint32_t body, bool points, tl_holding *sum)
{
    if (points)
        tl_elements_hold(m, body, sum);
}

static double stiffness(const tl_model *m, uint32_t body)
{
    tl_holding sum = {.law = 0};
    tl_elements_hold(m, body, &sum);
    return sum.stiffness.sum;
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
    bool sure = true;
    for (size_t k = 0; k < e->set_count; k++)
        sure = sure && tl_element_ops_of(&e->set[k])->never_fails;
    for (size_t row = 0; sure && row < e->nodes.table.rows; row++)
        sure = e->nodes.k[row] < TL_UNDO_TAME && e->nodes.c[row] < TL_UNDO_TAME;
    return !sure || tl_elements_together_due(m);
}

const tl_contributor tl_elements_act = {.name = "elements",
                                        .apply = apply,
                                        .gather = tl_elements_gather,
                                        .stiffness = stiffness,
                                        .hold = hold,
                                        .energies = tl_elements_energies,
                                        .tables = tables,
                                        .may_fail = may_fail};
