/* gather.c - forces on bodies: each adds what its contributors do (13-17 of Hart, Cundall and Lemos 1988),
 * its weight and its load. Components that are held carry no unbalanced force.
 * What the measures of convergence ask (rest.c) is summed on the way. */
#include "cycle/gather.h"

#include "base/extremes.h"
#include "base/parallel.h"
#include "contact/detection.h"
#include "cycle/cycle_data.h"
#include "cycle/energy.h"
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
    force = tl_v3_madd(force, b->mass[body], m->config.gravity);
    if (tl_body_loaded(b, body)) {
        tl_wrench load = tl_load_wrench(b, body);
        force = tl_v3_add(force, load.force);
        moment = tl_v3_add(moment, load.moment);
    }
    b->force[body] = tl_free_part(force, b->fixed[body]);
    b->moment[body] = b->fixed[body] & TL_FIX_ROTATION ? tl_v3(0, 0, 0) : moment;
    m->cycle->contact_force[body] = on->magnitude;
}

/* Unbalanced force and moment of a body, by themselves and over what it bears. What that is at the least is asked only
 * where the ratio may be the largest. */
static void sum_ratios(const tl_model *m, uint32_t body, double weight, tl_sums *sums)
{
    const tl_bodies *b = &m->bodies;
    double unbalanced = tl_v3_norm(b->force[body]);
    double turning = tl_v3_norm(b->moment[body]) / b->radius[body];
    double contact = m->cycle->contact_force[body];
    double bears = tl_borne(m, body, weight), worse = tl_larger(unbalanced, turning);
    sums->unbalanced += unbalanced;
    sums->turning += turning;
    sums->contact_force += contact;
    sums->largest = tl_larger(sums->largest, unbalanced);
    if (!(worse > sums->local * bears))
        return;
    bears = tl_larger(bears, tl_least_borne(m, body));
    double ratio = bears > 0 ? worse / bears : 1; /* nothing holds what turns it */
    sums->local = tl_larger(sums->local, bears > 0 ? unbalanced / bears : 0);
    if (ratio > sums->worst_ratio) {
        sums->worst_ratio = ratio;
        sums->worst = body;
    }
}

static void gather_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    tl_model *m = user;
    tl_bodies *b = &m->bodies;
    bool totals = m->damping && ((const tl_damping_ops *)m->damping->ops)->begin;
    double gravity = tl_v3_norm(m->config.gravity);
    tl_sums sums = {.worst = TL_NO_ROW};
    tl_acting on[TL_BODY_CHUNK];
    const uint8_t *idle = tl_idle_bodies(m);
    gather_acting(m, (uint32_t)begin, (uint32_t)end, on);
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (idle && idle[body])
            continue;
        gather_body(m, body, &on[body - begin]);
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double v2 = tl_v3_norm2(b->v[body]);
        double weight = tl_weight_of(b, body, gravity);
        sums.weight += weight;
        sum_ratios(m, body, weight, &sums);
        sums.bodies++;
        if (totals) {
            sums.kinetic += 0.5 * tl_energy_scale(m->cycle, body) * (b->mass[body] * v2 + tl_spin_energy2(m, body));
            sums.power += tl_v3_dot(b->force[body], b->v[body]) + tl_v3_dot(b->moment[body], b->w[body]);
        }
        sums.max_speed2 = tl_larger(sums.max_speed2, v2);
    }
    m->cycle->chunk_sums[chunk] = sums;
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

void tl_gather(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows;
    tl_parallel_for(m->pool, bodies, TL_BODY_CHUNK, gather_range, m);
    c->sums = (tl_sums){.worst = TL_NO_ROW};
    for (size_t chunk = 0; chunk * TL_BODY_CHUNK < bodies; chunk++) {
        const tl_sums *s = &c->chunk_sums[chunk];
        c->sums.unbalanced += s->unbalanced;
        c->sums.turning += s->turning;
        c->sums.contact_force += s->contact_force;
        c->sums.weight += s->weight;
        c->sums.largest = tl_larger(c->sums.largest, s->largest);
        c->sums.local = tl_larger(c->sums.local, s->local);
        if (s->worst_ratio > c->sums.worst_ratio) {
            c->sums.worst_ratio = s->worst_ratio;
            c->sums.worst = s->worst;
        }
        c->sums.bodies += s->bodies;
        c->sums.kinetic += s->kinetic;
        c->sums.power += s->power;
        c->sums.max_speed2 = tl_larger(c->sums.max_speed2, s->max_speed2);
    }
}
