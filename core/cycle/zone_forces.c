/* zone_forces.c - zones act on gridpoints, and segments on these and on bodies: contributors of a step. */
#include "cycle/zone_forces.h"

#include "cycle/contact_beta.h"
#include "cycle/cycle_data.h"
#include "cycle/zone_limits.h"
#include "segment/act.h"
#include "segment/gather.h"
#include "zone/columns.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/pass.h"

/* ---------------------------------------------------------------- forces of zones -------- */

static tl_status apply(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (!tl_model_deforms(m))
        return TL_OK;
    tl_zones_pass(m, m->zones->moved_dt, &c->failure);
    const tl_status status = c->failure.error.status;
    return status == TL_OK ? TL_OK : tl_zones_failed(m, status);
}

static tl_energies energies(tl_model *m)
{
    tl_energies sum = {.stored = 0};
    const tl_parcels *p = m->zones ? &m->zones->parcels : NULL;
    for (size_t k = 0; p && k < p->table.rows; k++) {
        sum.stored += p->stored[k];
        sum.heat += p->heat[k];
    }
    return sum;
}

static size_t tables(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES])
{
    if (!tl_model_deforms(m))
        return 0;
    table[0] = &m->zones->zones.table;
    table[1] = &m->zones->parcels.table;
    table[2] = &m->zones->points.table;
    return 3;
}

static bool may_fail(const tl_model *m)
{
    const struct tl_zones *z = m->zones;
    bool sure = !tl_zones_are_fast(m);
    for (size_t k = 0; z && k < z->solid_count; k++)
        sure = sure && ((const tl_solid_ops *)z->solid[k].of.kind->ops)->never_fails;
    return !sure;
}

static tl_status prepare(tl_model *m)
{
    if (!tl_model_deforms(m))
        return TL_OK;
    struct tl_zones *z = m->zones;
    const bool before = m->damping && ((const tl_damping_ops *)m->damping->ops)->before;
    const bool enough = tl_fit(&z->scratch, &z->scratch_capacity, tl_pool_threads(m->pool), sizeof *z->scratch) &&
                        tl_fit(&z->motion, &z->motion_capacity, z->mesh_count, sizeof *z->motion) &&
                        (!tl_is_damped(m) || tl_gridpoints_hold_damping(&z->points, before));
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

/* ---------------------------------------------------------------- segments --------------- */

static tl_status prepare_segments(tl_model *m)
{
    return tl_segments_prepare(m, m->dt > 0 ? tl_contact_beta(m) / m->dt : 0);
}

static tl_status apply_segments(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const tl_status status = tl_segments_apply(m, &c->failure);
    c->failure.error.status = TL_OK;
    return status == TL_OK ? status
                           : tl_fail(&m->error, status, "cycle %lld, a law on a deformable block: %s",
                                     (long long)m->cycles + 1, c->failure.error.text);
}

static void gather_segments(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    for (uint32_t body = begin; m->segments && body < end; body++)
        tl_segments_gather_body(m, body, &on[body - begin]);
}

static void hold_segments(const tl_model *m, uint32_t body, bool points, tl_holding *sum)
{
    if (m->segments && points)
        tl_segments_hold(m, body, sum);
}

static double stiffness_of_segments(const tl_model *m, uint32_t body)
{
    tl_holding sum = {.law = 0};
    hold_segments(m, body, true, &sum);
    return sum.stiffness.sum;
}

static size_t tables_of_segments(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES])
{
    if (!m->segments)
        return 0;
    table[0] = &m->segments->table.table;
    table[1] = &m->segments->points.table;
    return 2;
}

const tl_contributor tl_segments_act = {.name = "segments",
                                        .prepare = prepare_segments,
                                        .apply = apply_segments,
                                        .gather = gather_segments,
                                        .stiffness = stiffness_of_segments,
                                        .hold = hold_segments,
                                        .energies = tl_segments_energies,
                                        .tables = tables_of_segments};

const tl_contributor tl_zones_act = {
    .name = "zones", .prepare = prepare, .apply = apply, .energies = energies, .tables = tables, .may_fail = may_fail};
