/* gather.c - forces on bodies: each adds what its contributors do (13-17 of Hart, Cundall and Lemos 1988),
 * its weight and its load. Components that are held carry no unbalanced force.
 * What the measures of convergence ask (rest.c) is summed on the way. */
#include "cycle/gather.h"

#include "base/extremes.h"
#include "base/parallel.h"
#include "contact/detection.h"
#include "cycle/borne.h"
#include "cycle/contributors.h"
#include "cycle/energy.h"
#include "cycle/gridpoints.h"
#include "cycle/idle.h"
#include "cycle/loose.h"
#include "cycle/rest.h"
#include "model/loads.h"

/* Asks all contributors what acts on some bodies. */
static void gather_acting(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    for (uint32_t k = 0; k < end - begin; k++)
        on[k] = (tl_acting){.magnitude = 0};
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        if ((*with)->gather)
            (*with)->gather(m, begin, end, on);
}

/* Adds to what acts on a body its weight and load. */
static void gather_body(tl_model *m, uint32_t body, const tl_acting *on)
{
    tl_bodies *b = &m->bodies;
    tl_vec3 force = on->force, moment = on->moment;
    if (b->fixed[body])
        m->cycle->reaction[m->cycle->reaction_of[body]] = (tl_reaction){force, moment};
    const double share = tl_loads_share(m);
    force = tl_v3_madd(force, b->mass[body], tl_v3_scale(share, m->config.gravity));
    if (tl_body_loaded(b, body)) {
        tl_wrench load = tl_load_wrench(b, body);
        force = tl_v3_madd(force, share, load.force);
        moment = tl_v3_madd(moment, share, load.moment);
    }
    b->force[body] = tl_free_part(force, b->fixed[body]);
    b->moment[body] = b->fixed[body] & TL_FIX_ROTATION ? tl_v3(0, 0, 0) : moment;
    m->cycle->contact_force[body] = on->magnitude;
}

/* Numbers of the bodies of a chunk that are neither held nor idle. */
typedef struct addends {
    _Alignas(TL_ALIGN) double number[TL_SUM_COUNT][TL_BODY_CHUNK];
    size_t count;
} addends;

/* Tolerance: ratios that are rounded by less are compared whole. */
#define NEARLY (1 - 1e-12)

/* Unbalanced force and moment of a body, by themselves and over what it bears. What that is at the least is asked only
 * where the ratio may be the largest. Of equal ratios that of the lowest row counts. */
static void note_ratios(const tl_model *m, uint32_t body, double weight, addends *of, tl_gathered *all)
{
    const tl_bodies *b = &m->bodies;
    double unbalanced = tl_v3_norm(b->force[body]);
    double turning = tl_v3_norm(b->moment[body]) / b->radius[body];
    double contact = m->cycle->contact_force[body];
    double bears = tl_borne(m, body, weight), worse = tl_larger(unbalanced, turning);
    of->number[TL_SUM_UNBALANCED][of->count] = unbalanced;
    of->number[TL_SUM_TURNING][of->count] = turning;
    of->number[TL_SUM_CONTACT_FORCE][of->count] = contact;
    all->largest = tl_larger(all->largest, unbalanced);
    if (!(worse > NEARLY * all->local * bears))
        return;
    bears = tl_larger(bears, tl_least_borne(b, body, tl_body_stiffness(m, body)));
    double ratio = bears > 0 ? worse / bears : 1; /* nothing holds what turns it */
    all->local = tl_larger(all->local, bears > 0 ? unbalanced / bears : 0);
    if (ratio > all->worst_ratio || (ratio == all->worst_ratio && body < all->worst)) {
        all->worst_ratio = ratio;
        all->worst = body;
    }
}

/* Kinetic energy and power, for a damping that asks for totals. */
static void note_totals(const tl_model *m, uint32_t body, double weight, addends *of)
{
    const tl_bodies *b = &m->bodies;
    const double kinetic = tl_body_energy(m, body, 0);
    of->number[TL_SUM_KINETIC][of->count] = kinetic;
    of->number[TL_SUM_DAMPED][of->count] = b->fixed[body] ? tl_body_energy(m, body, b->fixed[body]) : kinetic;
    const bool alone = m->relaxing && m->cycle->settling.calm && tl_body_is_loose(m, body, weight);
    of->number[TL_SUM_POWER][of->count] = alone ? 0 : tl_body_power(m, body); /* settle.c */
}

static void gather_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    tl_bodies *b = &m->bodies;
    tl_gathered *all = &m->cycle->gathered[thread];
    bool totals = m->relaxing || (m->damping && ((const tl_damping_ops *)m->damping->ops)->begin);
    double gravity = tl_v3_norm(m->config.gravity);
    tl_acting on[TL_BODY_CHUNK];
    addends of;
    of.count = 0;
    const size_t sums = totals ? TL_SUM_COUNT : TL_SUM_KINETIC;
    const uint8_t *idle = tl_idle_bodies(m);
    gather_acting(m, (uint32_t)begin, (uint32_t)end, on);
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (tl_body_idles(m, idle, body))
            continue;
        gather_body(m, body, &on[body - begin]);
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double v2 = tl_v3_norm2(b->v[body]);
        const double weight = tl_weight_of(b, body, gravity);
        note_ratios(m, body, weight, &of, all);
        if (totals)
            note_totals(m, body, weight, &of);
        all->max_speed2 = tl_larger(all->max_speed2, v2);
        of.count++;
    }
    all->bodies += of.count;
    tl_exact_add_each(all->sum, sums, of.number[0], TL_BODY_CHUNK, of.count);
}

bool tl_gather_prepare(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    uint64_t version = 1 + m->structure + m->constraints;
    if (c->reactions_for == version)
        return true;
    uint32_t held = 0;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        c->reaction_of[body] = m->bodies.fixed[body] ? held++ : TL_NO_ROW;
    if (!tl_fit(&c->reaction, &c->reaction_capacity, held, sizeof *c->reaction))
        return false;
    c->reactions_for = version;
    return true;
}

/* Adds what one thread has gathered to what another has. */
static void merge(tl_gathered *to, const tl_gathered *from)
{
    for (size_t i = 0; i < TL_SUM_COUNT; i++)
        tl_exact_merge(&to->sum[i], &from->sum[i]);
    to->largest = tl_larger(to->largest, from->largest);
    to->local = tl_larger(to->local, from->local);
    to->max_speed2 = tl_larger(to->max_speed2, from->max_speed2);
    to->bodies += from->bodies;
    if (from->worst_ratio > to->worst_ratio || (from->worst_ratio == to->worst_ratio && from->worst < to->worst)) {
        to->worst_ratio = from->worst_ratio;
        to->worst = from->worst;
    }
}

void tl_gather(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const unsigned threads = tl_pool_threads(m->pool);
    tl_gathered *all = &c->gathered[0];
    for (unsigned t = 0; t < threads; t++)
        c->gathered[t] = (tl_gathered){.worst = TL_NO_ROW};
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, gather_range, m);
    tl_gridpoints_gather(m);
    for (unsigned t = 1; t < threads; t++)
        merge(all, &c->gathered[t]);
    c->sums = (tl_sums){.unbalanced = tl_exact_value(&all->sum[TL_SUM_UNBALANCED]),
                        .turning = tl_exact_value(&all->sum[TL_SUM_TURNING]),
                        .contact_force = tl_exact_value(&all->sum[TL_SUM_CONTACT_FORCE]),
                        .kinetic = tl_exact_value(&all->sum[TL_SUM_KINETIC]),
                        .damped = tl_exact_value(&all->sum[TL_SUM_DAMPED]),
                        .power = tl_exact_value(&all->sum[TL_SUM_POWER]),
                        .largest = all->largest,
                        .local = all->local,
                        .worst_ratio = all->worst_ratio,
                        .worst = all->worst,
                        .max_speed2 = all->max_speed2,
                        .bodies = all->bodies};
}
