/* added_mass.c - partial mass scaling: inertia added to the bodies that would make the step short.
 *
 * Let f be the fraction of the critical step that is asked for. A step dt is stable for a body when its rate
 * (timestep.c) is no higher than 2 f^2 / dt^2. A body in contact whose rate is higher gets mass and moments of inertia
 * multiplied by the same factor, rate over limit: its rate, a sum over 1/M and 1/I, is then the limit. Its weight, and
 * all that laws and loads do to it, stay those of its own mass. A body without contact points has no stiffness and gets
 * none: it falls as it would.
 *
 * The factor follows from the rates of each step. When it changes, the velocity stays, as with all mass scaling: what
 * is added comes with the velocity that the body has, and goes with it. Were the momentum kept, a contact that opens
 * and closes would drive and brake the body. Energies count the inertia that moves, and what comes and goes with a
 * change of it is external work (energy.c), as when velocities are set. */
#include "cycle/added_mass.h"

#include "cycle/contributors.h"
#include "model/options.h"

#include <float.h>

/* Tolerance: halvings in the search for the longest step that the mass allows. */
#define HALVINGS 40
/* Tolerance: share of the step that is told, with three digits, so that what is told is no longer than it. */
#define ROUNDED_DOWN 0.995
/* Tolerance: share of added mass over the one told of from which it is told of again. */
#define TELL_AGAIN 2

static double factor_of(const tl_model *m, uint32_t body, double limit)
{
    double rate = m->cycle->rate[body];
    /* something must hold it that a longer step would make unstable */
    bool more = rate > limit && m->bodies.fixed[body] != TL_FIX_ALL && tl_body_stiffness(m, body) > 0;
    return more ? rate / limit : 1;
}

/* What the bodies need to be stable up to a rate. */
static struct tl_added needed(const tl_model *m, double limit)
{
    const tl_bodies *b = &m->bodies;
    struct tl_added out = {.factor = 1, .worst = TL_NO_ROW};
    tl_addends all = {.count = 0}, more = {.count = 0};
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double factor = factor_of(m, body, limit);
        tl_addends_put(&all, b->mass[body]);
        tl_addends_put(&more, (factor - 1) * b->mass[body]);
        out.bodies += factor > 1;
        if (factor > out.factor) {
            out.factor = factor;
            out.worst = body;
        }
    }
    const double mass = tl_addends_sum(&all);
    out.share = mass > 0 ? tl_addends_sum(&more) / mass : 0;
    return out;
}

/* The longest step for which no more than the most is needed. */
static double longest(const tl_model *m, double limit, double dt)
{
    double high = 1; /* of dt, which may be too long by many powers of ten */
    while (high > DBL_MIN && needed(m, limit / (high * high / 256)).share > m->added_most)
        high /= 16;
    double low = high / 16;
    for (int i = 0; i < HALVINGS; i++) {
        double part = 0.5 * (low + high);
        if (needed(m, limit / (part * part)).share > m->added_most)
            high = part;
        else
            low = part;
    }
    return low * dt;
}

static tl_status refuse(tl_model *m, const struct tl_added *need, double limit)
{
    return tl_fail(
        &m->error, TL_E_STATE,
        "mass_scaling: dt = %g s would add %.3g of the mass of the bodies that can move, more than most = %g; block %u "
        "would get %.3g times its inertia; give dt = %.3g or less, a larger most, or join slivers with %s",
        m->added_dt, need->share, m->added_most, m->bodies.id[need->worst], need->factor,
        ROUNDED_DOWN * longest(m, limit, m->added_dt), tl_words(m, "model:filter", "tl_model_filter()"));
}

static void tell(tl_model *m, const struct tl_added *need)
{
    struct tl_cycle *c = m->cycle;
    if (need->bodies == 0 || !(need->share > TELL_AGAIN * c->told_share))
        return;
    c->told_share = need->share;
    tl_model_say(m,
                 "mass_scaling: dt = %g s adds %.3g of the mass of the bodies that can move, to %zu of them; block %u "
                 "has %.3g times its inertia",
                 m->added_dt, need->share, need->bodies, m->bodies.id[need->worst], need->factor);
}

tl_status tl_added_find(tl_model *m, double limit)
{
    struct tl_cycle *c = m->cycle;
    struct tl_added need = needed(m, limit);
    if (need.share > m->added_most)
        return refuse(m, &need, limit);
    c->added = need;
    c->adds = need.bodies > 0;
    for (uint32_t body = 0; c->adds && body < m->bodies.table.rows; body++)
        c->inertia[body] = factor_of(m, body, limit);
    c->added_block = need.worst == TL_NO_ROW ? TL_NO_ID : m->bodies.id[need.worst];
    tell(m, &need);
    return TL_OK;
}

tl_status tl_model_mass_scaling(tl_model *m, const tl_mass_scaling *given)
{
    tl_mass_scaling scaling;
    tl_status status = TL_OPTIONS_READ(tl_mass_scaling, given, &scaling, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set mass_scaling");
    if (status != TL_OK)
        return status;
    bool adds = !isnan(scaling.dt);
    double most = isnan(scaling.most) ? TL_MOST_ADDED : scaling.most;
    if (!adds && !isnan(scaling.most))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "mass_scaling: most = %g is the most that a given step may add: give dt, the step, s, with it",
                       scaling.most);
    if (adds && !scaling.on)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "mass_scaling: dt = %g s asks for scaling and on = false for none: leave one of them out",
                       scaling.dt);
    if (adds && !(scaling.dt >= TL_STEP_LEAST && scaling.dt <= 1 / TL_STEP_LEAST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "mass_scaling: dt = %g s is outside [%g, %g]", scaling.dt,
                       TL_STEP_LEAST, 1 / TL_STEP_LEAST);
    if (adds && !(most >= 0 && isfinite(most)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "mass_scaling: most = %g must be a finite number that is not negative",
                       most);
    m->mass_scaling = scaling.on && !adds;
    m->added_dt = adds ? scaling.dt : NAN;
    m->added_most = adds ? most : NAN;
    m->constraints++;
    if (m->cycle) {
        m->cycle->dt = 0;
        m->cycle->told_share = 0;
        m->cycle->added = (struct tl_added){.factor = 1, .worst = TL_NO_ROW};
        m->cycle->added_block = TL_NO_ID;
    }
    return TL_OK;
}

tl_mass_added tl_model_mass_added(const tl_model *m)
{
    tl_mass_added out = {
        .on = tl_mass_scaled(m), .dt = m->added_dt, .most = m->added_most, .worst = TL_NO_ID, .factor = 1};
    if (m->cycle && tl_adds_mass(m)) {
        out.share = m->cycle->added.share;
        out.bodies = m->cycle->added.bodies;
        out.factor = m->cycle->added.bodies > 0 ? m->cycle->added.factor : 1;
        out.worst = m->cycle->added_block;
    }
    return out;
}
