/* contact_forces.c - contacts act on bodies by the laws of their joints: the first contributor of a step. */
#include "cycle/contact_forces.h"

#include "base/columns.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/kind.h"
#include "cycle/contact_beta.h"
#include "cycle/cycle_data.h"
#include "cycle/idle.h"
#include "cycle/undo.h"
#include "force/joint_laws.h"
#include "force/laws.h"
#include "segment/act.h"
#include "segment/carriers.h"
#include "segment/gather.h"
#include "zone/grid.h"

#include <string.h>

/* ---------------------------------------------------------------- forces ----------------- */

/* Of the points of some SIMD groups that follow each other, and of their contacts, rows that follow each other at once:
 * what a failure puts back. */
static void copy_groups(tl_model *m, const tl_simd_group *groups, size_t count, bool back)
{
    const tl_detect *d = m->detect;
    size_t points = 0;
    uint32_t first = 0, end = 0;
    for (size_t r = 0; r < count; r++) {
        points += (size_t)groups[r].slots * TL_LANES;
        for (size_t l = 0; l < TL_LANES; l++) {
            uint32_t c = groups[r].contact[l];
            if (c != TL_NO_ROW && c != end) {
                tl_undo_rows(m, &d->contacts.table, first, end - first, back);
                first = c;
            }
            end = c != TL_NO_ROW ? c + 1 : end;
        }
    }
    tl_undo_rows(m, &d->contacts.table, first, end - first, back);
    tl_undo_rows(m, &d->points.table, count ? groups->start : 0, points, back);
}

static void keep_groups(tl_model *m, const tl_simd_group *groups, size_t count)
{
    if (tl_undo_keeps(m))
        copy_groups(m, groups, count, false);
}

/* The laws have passed over spans that rest. */
static void put_back(tl_model *m)
{
    const tl_layout *layout = &m->detect->layout;
    for (size_t r = 0; r < layout->span_count; r++) {
        const tl_span *span = &layout->spans[r];
        bool applied = span->law != TL_NO_ROW && !tl_span_rests(m, span);
        for (size_t k = span->group_begin; applied && k < span->group_end; k++)
            copy_groups(m, &layout->groups[k], 1, true);
    }
}

static size_t tables(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES])
{
    table[0] = &m->detect->points.table;
    table[1] = &m->detect->contacts.table;
    return 2;
}

static bool may_fail(const tl_model *m)
{
    bool sure = true;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        sure = sure && ((const tl_law_ops *)law->kind->ops)->never_fails && law->kn < TL_UNDO_TAME &&
               law->ks < TL_UNDO_TAME;
    }
    return !sure;
}

/* Contacts without points, or between held bodies without a law, store nothing, whatever their row says. */
TL_VECTORIZED static void list_stored(const tl_contacts *c, size_t begin, size_t end, double *restrict stored)
{
    const double *restrict known = c->stored;
    const uint16_t *restrict points = c->point_capacity;
    const uint32_t *restrict law = c->law;
    for (size_t i = begin; i < end; i++) {
        const double all = known[i];
        stored[i - begin] = ((points[i] > 0) & (law[i] != TL_NO_ROW)) ? all : 0;
    }
}

static void sum_stored(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const tl_model *m = user;
    double stored[TL_CONTACT_CHUNK];
    list_stored(&m->detect->contacts, begin, end, stored);
    tl_exact_add(&m->cycle->stored[thread], stored, end - begin);
}

/* Makes room for what damps contacts. */
static tl_status prepare(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const size_t rows = m->detect->contacts.table.rows;
    const bool enough = !(tl_contact_beta(m) > 0) ||
                        tl_fit(&c->contact_damping, &c->contact_damping_capacity, rows, sizeof *c->contact_damping);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

/* What is damped, and how much. Contacts that are passed over are not. */
static void begin_damping(tl_model *m, tl_law_phase *phase)
{
    struct tl_cycle *c = m->cycle;
    const double beta = tl_contact_beta(m);
    const size_t rows = m->detect->contacts.table.rows;
    if (!(beta > 0) || rows == 0)
        return;
    memset(c->contact_damping, 0, rows * sizeof *c->contact_damping);
    phase->damping = c->contact_damping;
    phase->damping_rate = m->dt > 0 ? beta / m->dt : 0;
}

/* Energies are summed at once: a split gives contacts others later in the step. Contacts that rest store what they
 * did, and make no heat. */
static tl_status apply(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const unsigned threads = tl_pool_threads(m->pool);
    tl_law_phase phase = {.failure = &c->failure, .heat = c->heat, .keep = keep_groups};
    begin_damping(m, &phase);
    memset(c->heat, 0, threads * sizeof *c->heat);
    memset(c->stored, 0, threads * sizeof *c->stored);
    tl_status status = tl_laws_apply(m, &phase);
    tl_parallel_for(m->pool, m->detect->contacts.table.rows, TL_CONTACT_CHUNK, sum_stored, m);
    for (unsigned t = 1; t < threads; t++) {
        tl_exact_merge(&c->stored[0], &c->stored[t]);
        tl_exact_merge(&c->heat[0], &c->heat[t]);
    }
    return status;
}

/* Block by block, the contacts of each in the order of the partner. */
static void gather_body(const tl_model *m, uint32_t body, tl_acting *on)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_vec3 *force = c->force;
    tl_acting sum = *on;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        sum.force = tl_v3_madd(sum.force, tl_contact_sign(c, i, at.block), force[i]);
        sum.moment = tl_v3_add(sum.moment, tl_contact_moment(m, i, tl_contact_is_b(c, i, at.block)));
        sum.magnitude += tl_v3_norm(force[i]);
    }
    *on = sum;
}

/* What acts on idle bodies stands as it is. */
static void gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    const uint8_t *idle = tl_idle_bodies(m);
    for (uint32_t body = begin; body < end; body++)
        if (!tl_body_idles(m, idle, body))
            gather_body(m, body, &on[body - begin]);
}

static void damp_body(const tl_model *m, uint32_t body)
{
    const struct tl_cycle *c = m->cycle;
    tl_vec3 force = tl_columns_get(c->damping_force, body), moment = tl_columns_get(c->damping_moment, body);
    if (m->segments)
        tl_segments_damp_body(m, body, &force, &moment);
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        const uint32_t i = at.contact;
        const tl_wrench *by = &c->contact_damping[i];
        const bool on_b = tl_contact_is_b(&m->detect->contacts, i, at.block);
        force = tl_v3_madd(force, on_b ? 1 : -1, by->force);
        moment = tl_v3_add(moment, tl_contact_moment_of(m, i, on_b, by->force, by->moment));
    }
    tl_columns_put(c->damping_force, body, force);
    tl_columns_put(c->damping_moment, body, moment);
}

static void damp_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    for (size_t body = begin; body < end; body++)
        damp_body(user, (uint32_t)body);
}

void tl_contacts_damp(tl_model *m)
{
    if (!(tl_contact_beta(m) > 0))
        return;
    const double *share = m->detect->contacts.share;
    for (uint32_t i = 0; m->segments && share && i < m->detect->contacts.table.rows; i++) {
        tl_wrench *by = &m->cycle->contact_damping[i];
        *by = (tl_wrench){tl_v3_scale(share[i], by->force), tl_v3_scale(share[i], by->moment)};
    }
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, damp_range, m);
    if (tl_model_deforms(m)) {
        tl_carriers_damp(m, m->cycle->contact_damping);
        tl_segments_damp(m);
    }
}

/* Elastic energy and slip. */
static tl_energies energies(tl_model *m)
{
    const struct tl_cycle *c = m->cycle;
    tl_energies sum = {.stored = c->split_stored + tl_exact_value(&c->stored[0]),
                       .heat = m->detect->parted + tl_exact_value(&c->heat[0])};
    m->detect->parted = 0;
    return sum;
}

/* ---------------------------------------------------------------- stiffness -------------- */

/* Sum of k A over the contacts of a body. */
static double stiffness(const tl_model *m, uint32_t body)
{
    const tl_contacts *c = &m->detect->contacts;
    double sum = 0;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        if (c->law[i] == TL_NO_ROW || c->point_count[i] == 0)
            continue;
        sum += tl_law_stiffness(&m->joint_laws[c->law[i]]) * c->area[i];
    }
    return sum;
}

/* The area of a contact for the time step, about the centroid of the side that a block is on. */
static tl_spread bounds_of(const tl_model *m, uint32_t c, uint32_t block)
{
    return tl_contact_kind_of(m->detect, c)->place->bounds(m, c, tl_contact_is_b(&m->detect->contacts, c, block));
}

/* Contacts without area have a law, too. */
static void hold(const tl_model *m, uint32_t body, bool points, tl_holding *sum)
{
    const tl_contacts *c = &m->detect->contacts;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        if (c->law[i] == TL_NO_ROW)
            continue;
        double law = tl_law_stiffness(&m->joint_laws[c->law[i]]);
        sum->law = fmax(sum->law, law);
        if (points && c->point_count[i] > 0) {
            tl_spread next = bounds_of(m, i, at.block);
            sum->presses = true;
            sum->stiffness.sum += law * next.sum;
            sum->stiffness.r2 += law * next.r2;
        }
    }
}

/* Tolerance: a contact presses no farther away than the farthest corner of the body, over the radius of that: overlaps
 * come on top. */
#define BEYOND 1.05

/* From the areas of contacts alone. Of a field contact its press is known at once, and closer. */
static void hold_most(const tl_model *m, uint32_t body, tl_holding *sum)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    double radius = BEYOND * m->bodies.radius[body];
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        if (c->law[i] == TL_NO_ROW)
            continue;
        tl_spread on = {c->area[i], c->area[i] * radius * radius};
        if (tl_contact_kind_of(d, i)->place->quick)
            on = bounds_of(m, i, at.block);
        double k = tl_law_stiffness(&m->joint_laws[c->law[i]]);
        sum->law = fmax(sum->law, k);
        sum->stiffness.sum += k * on.sum;
        sum->stiffness.r2 += k * on.r2;
    }
}

/* Speed at which the sides of a contact come together there, over their overlap. */
static double approach_of(const tl_model *m, uint32_t c, double law)
{
    const tl_sides s = tl_contact_sides(m, c);
    tl_vec3 arm;
    double overlap = tl_contact_kind_of(m->detect, c)->place->pressed(m, c, law, &arm);
    tl_vec3 arm_b = tl_v3_sub(arm, tl_sides_apart(m, s));
    tl_vec3 away = tl_v3_sub(tl_side_velocity(m, s.a, arm), tl_side_velocity(m, s.b, arm_b));
    double closing = tl_v3_dot(away, m->detect->contacts.facet[c].last);
    return overlap > 0 ? fabs(closing) / overlap : INFINITY;
}

/* Highest speed at which a contact of a body goes on, over its overlap, 1/s. */
static double approach(const tl_model *m, uint32_t body)
{
    const tl_contacts *c = &m->detect->contacts;
    double out = 0;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        if (c->law[i] == TL_NO_ROW || c->point_count[i] == 0)
            continue;
        out = fmax(out, approach_of(m, i, tl_law_stiffness(&m->joint_laws[c->law[i]])));
    }
    return out;
}

const tl_contributor tl_contacts_act = {.name = "contacts",
                                        .prepare = prepare,
                                        .apply = apply,
                                        .gather = gather,
                                        .stiffness = stiffness,
                                        .hold = hold,
                                        .hold_most = hold_most,
                                        .approach = approach,
                                        .energies = energies,
                                        .tables = tables,
                                        .put_back = put_back,
                                        .may_fail = may_fail};
