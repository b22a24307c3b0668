/* added_mass.c - partial mass scaling: inertia added to the bodies that would make the step short.
 *
 * Let f be the fraction of the critical step that is asked for. A step dt is stable for a body when its rate
 * (timestep.c) is no higher than 2 f^2 / dt^2. A body in contact whose rate is higher gets mass and moments of inertia
 * multiplied by the same factor, rate over limit: its rate, a sum over 1/M and 1/I, is then the limit. Its weight, and
 * all that laws and loads do to it, stay those of its own mass. A body without contact points has no stiffness and gets
 * none: it falls as it would. A gridpoint (gridpoints.c) is stable with a rate no higher than 4 f^2 / dt^2, f the
 * fraction for zones, and gets its mass multiplied likewise.
 *
 * The factor follows from the rates of each step. When it changes, the velocity stays, as with all mass scaling: what
 * is added comes with the velocity that the body has, and goes with it. Were the momentum kept, a contact that opens
 * and closes would drive and brake the body. Energies count the inertia that moves, and what comes and goes with a
 * change of it is external work (energy.c), as when velocities are set. */
#include "cycle/added_mass.h"

#include "cycle/contact_beta.h"
#include "cycle/contributors.h"
#include "cycle/gridpoint.h"
#include "model/options.h"

#include <float.h>
#include <stdio.h>
#include <talus/zones.h>

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

/* What a mesh has, and needs to be stable up to a rate of gridpoints, kg; adds to what is known of all. */
typedef struct mesh_need {
    double mass, more;
} mesh_need;

static mesh_need need_of_mesh(const tl_model *m, const tl_body_mesh *mesh, double limit, struct tl_added *all)
{
    const tl_gridpoints *p = &m->zones->points;
    const size_t before = all->points;
    mesh_need out = {0, 0};
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        if (tl_gridpoint_is_held(p, row))
            continue;
        const double rate = p->holds[row] / p->mass[row], factor = rate > limit ? rate / limit : 1;
        out.mass += p->mass[row];
        out.more += (factor - 1) * p->mass[row];
        all->points += factor > 1;
        if (factor > all->factor) {
            all->factor = factor;
            all->worst = mesh->row;
            all->worst_point = row - mesh->point_begin;
        }
    }
    all->bodies += all->points > before;
    return out;
}

/* What the bodies need to be stable up to rates. */
static struct tl_added needed(const tl_model *m, tl_rate_limits limit)
{
    const tl_bodies *b = &m->bodies;
    struct tl_added out = {.factor = 1, .worst = TL_NO_ROW, .worst_point = TL_NO_ROW, .point_limit = limit.point};
    tl_addends all = {.count = 0}, more = {.count = 0};
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double factor = factor_of(m, body, limit.body);
        tl_addends_put(&all, b->mass[body]);
        tl_addends_put(&more, (factor - 1) * b->mass[body]);
        out.bodies += factor > 1;
        if (factor > out.factor) {
            out.factor = factor;
            out.worst = body;
        }
    }
    for (size_t k = 0; m->zones && k < m->zones->mesh_count; k++) {
        const mesh_need of = need_of_mesh(m, &m->zones->mesh[k], limit.point, &out);
        tl_addends_put(&all, of.mass);
        tl_addends_put(&more, of.more);
    }
    const double mass = tl_addends_sum(&all);
    out.share = mass > 0 ? tl_addends_sum(&more) / mass : 0;
    return out;
}

/* The limits of a step that is `part` as long. */
static tl_rate_limits for_part(tl_rate_limits limit, double part)
{
    return (tl_rate_limits){limit.body / (part * part), limit.point / (part * part)};
}

/* The longest step for which no more than the most is needed. */
static double longest(const tl_model *m, tl_rate_limits limit, double dt)
{
    double high = 1; /* of dt, which may be too long by many powers of ten */
    while (high > DBL_MIN && needed(m, for_part(limit, high / 16)).share > m->added_most)
        high /= 16;
    double low = high / 16;
    for (int i = 0; i < HALVINGS; i++) {
        double part = 0.5 * (low + high);
        if (needed(m, for_part(limit, part)).share > m->added_most)
            high = part;
        else
            low = part;
    }
    return low * dt;
}

/* The block that gets the most, and of a deformable one the gridpoint. */
static const char *name_worst(const tl_model *m, const struct tl_added *need, char *text, size_t size)
{
    if (need->worst_point == TL_NO_ROW)
        snprintf(text, size, "block %u", m->bodies.id[need->worst]);
    else
        snprintf(text, size, "gridpoint %u of block %u", need->worst_point, m->bodies.id[need->worst]);
    return text;
}

static tl_status refuse(tl_model *m, const struct tl_added *need, tl_rate_limits limit)
{
    char name[64];
    const bool zones = need->worst_point != TL_NO_ROW;
    return tl_fail(
        &m->error, TL_E_STATE,
        "mass_scaling: dt = %g s would add %.3g of the mass of the bodies that can move, more than most = %g; %s would "
        "get %.3g times its inertia; give dt = %.3g or less, a larger most, or %s%s",
        m->added_dt, need->share, m->added_most, name_worst(m, need, name, sizeof name), need->factor,
        ROUNDED_DOWN * longest(m, limit, m->added_dt), zones ? "larger zones" : "join slivers with ",
        zones ? "" : tl_words(m, "model:filter", "tl_model_filter()"));
}

static void tell(tl_model *m, const struct tl_added *need)
{
    struct tl_cycle *c = m->cycle;
    char name[64];
    if (need->bodies == 0 || !(need->share > TELL_AGAIN * c->told_share))
        return;
    c->told_share = need->share;
    tl_model_say(m,
                 "mass_scaling: dt = %g s adds %.3g of the mass of the bodies that can move, to %zu of them; %s has "
                 "%.3g times its inertia",
                 m->added_dt, need->share, need->bodies, name_worst(m, need, name, sizeof name), need->factor);
}

tl_status tl_added_find(tl_model *m, tl_rate_limits limit)
{
    struct tl_cycle *c = m->cycle;
    struct tl_added need = needed(m, limit);
    if (need.share > m->added_most)
        return refuse(m, &need, limit);
    c->added = need;
    c->adds = need.bodies > 0;
    for (uint32_t body = 0; c->adds && body < m->bodies.table.rows; body++)
        c->inertia[body] = factor_of(m, body, limit.body);
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
    if (tl_contact_beta(m) > 0)
        tl_contact_beta_changes(m);
    if (m->cycle) {
        m->cycle->dt = 0;
        m->cycle->told_share = 0;
        m->cycle->added = (struct tl_added){.factor = 1, .worst = TL_NO_ROW, .worst_point = TL_NO_ROW};
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

tl_gridpoints_added tl_model_gridpoints_added(const tl_model *m)
{
    tl_gridpoints_added out = {0, {TL_NO_ID, 0}};
    if (!m->cycle || !tl_adds_mass(m))
        return out;
    const struct tl_added *added = &m->cycle->added;
    out.gridpoints = added->points;
    if (added->points > 0 && added->worst_point != TL_NO_ROW)
        out.worst = (tl_zone_name){m->cycle->added_block, added->worst_point};
    return out;
}
