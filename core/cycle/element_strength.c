/* element_strength.c - elements in trials of strengths: with these divided, and how far they give. */
#include "cycle/element_strength.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/strength.h"
#include "contact/detection.h"
#include "contact/sides.h"
#include "cycle/cycle_data.h"
#include "cycle/meshes.h"
#include "cycle/undo.h"
#include "element/life.h"
#include "element/set.h"
#include "element/steady.h"

#include <math.h>
#include <stdlib.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- strengths -------------- */

bool tl_elements_have_strength(const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    bool some = false;
    for (size_t row = 0; e && row < e->table.table.rows; row++)
        some = some || tl_kind_has_strength(e->set[e->table.set[row]].kind);
    return some;
}

/* Lists for each set of a copy the set of `from` with the same elements, where these have strengths and are left. */
static const tl_element_set **find_origins(const tl_model *m, const tl_model *from)
{
    const struct tl_elements *e = m->elements;
    const tl_element_set **list = calloc(e->set_count + 1, sizeof *list);
    for (uint32_t row = 0; list && row < e->table.table.rows; row++) {
        const uint32_t set = e->table.set[row];
        const uint32_t at =
            list[set] || !tl_kind_has_strength(e->set[set].kind) ? TL_NO_ROW : tl_element_row(from, e->table.id[row]);
        if (at != TL_NO_ROW)
            list[set] = &from->elements->set[from->elements->table.set[at]];
    }
    return list;
}

/* Makes a set again with its strengths divided. */
static tl_status weaken_set(tl_model *m, tl_element_set *set, const tl_element_set *from, double factor)
{
    char context[80];
    tl_args args;
    void *held;
    tl_element_set made;
    tl_text_print(context, sizeof context, "element '%.40s'", from->kind->name);
    if (!tl_strengths_divide(from->kind, from->params, factor, &args, &held))
        return tl_fail_memory(&m->error);
    const tl_status status = tl_element_set_make(from->kind, &args, from, context, &m->error, &made);
    free(held);
    if (status != TL_OK)
        return status;
    made.group = set->group;
    made.structure = set->structure;
    tl_element_set_clear(set);
    *set = made;
    return TL_OK;
}

tl_status tl_elements_weaken(tl_model *m, const tl_model *from, double factor)
{
    struct tl_elements *e = m->elements;
    tl_status status = TL_OK;
    if (!e || !from->elements)
        return TL_OK;
    const tl_element_set **origin = find_origins(m, from);
    if (!origin)
        return tl_fail_memory(&m->error);
    tl_steady_let_go(m);
    for (size_t k = 0; k < e->set_count && status == TL_OK; k++)
        if (origin[k])
            status = weaken_set(m, &e->set[k], origin[k], factor);
    free(origin);
    e->version++;
    m->laws++;
    tl_undo_by_hand(m);
    if (m->cycle)
        m->cycle->dt = 0;
    return status;
}

/* ---------------------------------------------------------------- settlement ------------- */

/* What bears a body: forces of elements, N, and stiffnesses of these and of joints, N/m. */
typedef struct bearing {
    double force, stiffness;
} bearing;

/* Adds what an element does to bodies: with E the energy that it holds, and F half of the sum of its forces, it is as
 * stiff as F^2 / 2 E. */
static void add_element(const tl_model *m, size_t row, bearing *of)
{
    const struct tl_elements *e = m->elements;
    const uint32_t first = e->table.node_begin[row], end = first + e->table.node_count[row];
    double half = 0;
    for (uint32_t k = first; k < end; k++)
        half += 0.5 * tl_v3_norm(tl_columns_get(e->nodes.force, k));
    for (uint32_t k = first; k < end; k++) {
        const double force = tl_v3_norm(tl_columns_get(e->nodes.force, k));
        if (e->nodes.body[k] == TL_NO_ROW)
            continue;
        of[e->nodes.body[k]].force += force;
        of[e->nodes.body[k]].stiffness += 0.5 * force * half / e->table.stored[row];
    }
}

static void add_contact(const tl_model *m, uint32_t contact, bearing *of)
{
    const tl_contacts *c = &m->detect->contacts;
    if (c->law[contact] == TL_NO_ROW || !(tl_v3_norm(c->force[contact]) > 0))
        return;
    const tl_sides on = tl_contact_bodies(m, contact);
    const tl_law *law = &m->joint_laws[c->law[contact]];
    const double stiffness = fmin(law->kn, law->ks > 0 ? law->ks : law->kn) * c->area[contact];
    of[on.a].stiffness += stiffness;
    of[on.b].stiffness += stiffness;
}

bool tl_elements_settlement(const tl_model *m, double *settles)
{
    const struct tl_elements *e = m->elements;
    const size_t bodies = m->bodies.table.rows;
    tl_addends forces = {.count = 0}, gives = {.count = 0};
    bearing *of = e ? calloc(bodies + 1, sizeof *of) : NULL;
    *settles = 0;
    if (!of)
        return !e;
    for (size_t row = 0; row < e->table.table.rows; row++)
        if (e->table.stored[row] > 0)
            add_element(m, row, of);
    for (uint32_t i = 0; i < m->detect->contacts.table.rows; i++)
        add_contact(m, i, of);
    for (uint32_t body = 0; body < bodies; body++) {
        if (!tl_body_is_free(m, body) || !(of[body].force > 0))
            continue;
        tl_addends_put(&forces, of[body].force);
        tl_addends_put(&gives, of[body].force * of[body].force / of[body].stiffness);
    }
    free(of);
    const double force = tl_addends_sum(&forces);
    *settles = force > 0 ? tl_addends_sum(&gives) / force : 0;
    return true;
}
