/* motion.c - the law of motion: velocities kicked by forces, places drifting with velocities.
 *
 * Velocities live half-way between the steps, so a kick spans half of the last step and half of this one. The first
 * from rest is half a step: free fall then follows g t^2 / 2 at whole steps. (23) of Hart, Cundall and Lemos (1988): v
 * <- (D1 v + F/m h) D2, D1 = 1 - alpha h/2, D2 = 1/(1 + alpha h/2).
 *
 * Rotation, exact: the kick acts on the angular momentum L. The drift is the free motion of a rigid body with L
 * constant in space, split into turns about the principal axes (turn.h). It is time-reversible, keeps L to rounding and
 * the energy without drift. The angular velocity kept is that of L in the attitude at the end of the drift, so L is
 * recovered from it. Rotation, paper: one moment of inertia, w <- (D1 w + M/I h) D2 (20), (23); the attitude turns
 * exactly about w.
 *
 * Free bodies go through a step in groups of TL_LANES, those of a chunk together. Their columns are copied into lanes,
 * by whole vectors where the bodies of a group are side by side, and their poses one by one. Loops over the lanes kick
 * and turn all of them, stage by stage. What happened is booked for the energy ledger, and the lanes are copied back.
 * Bodies held in some components, and all with the paper's rotation, get their rotation one by one. Those held in every
 * component are in no group and cost nothing as long as they stand. */
#include "cycle/motion.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "base/parallel.h"
#include "cycle/gridpoints.h"
#include "cycle/loose.h"
#include "cycle/turn.h"
#include "geometry/polar.h"
#include "segment/carriers.h"

#include <string.h>

/* Bodies that can move, on their way through a step: the kick, which changes velocities, and the drift,
 * which changes places. The lanes beyond `count` are inert. Spins and angular momenta are in principal axes
 * at the forces' time, or where there is one moment of inertia in the model's: only their products count. */
typedef struct body_group {
    _Alignas(TL_ALIGN) tl_lanes4 q, axes;
    tl_lanes3 moments, per; /* per: 1 / moments */
    double mass[TL_LANES], alpha[TL_LANES];
    /* by mass scaling: of mass and moments that forces meet, and of that which energies count */
    double scale[TL_LANES], turn_scale[TL_LANES], energy_scale[TL_LANES];
    tl_lanes3 force, moment, damping_force, damping_moment;
    /* 1 where the damping acts, 0 in held components and, of the rotation, where that is held */
    tl_lanes3 damped;
    double damped_turn[TL_LANES];
    tl_lanes3 moved;                               /* velocity of the last step's motion */
    tl_lanes3 v0, w0, spin0, momentum0;            /* before the kick */
    tl_lanes3 v1, w1, spin1, momentum1;            /* after it */
    tl_lanes4 made, q2;                            /* the drift's turn, and after it */
    tl_lanes3 momentum2, w2, turned;               /* angular velocity, and that of the motion */
    double turning0[TL_LANES], turning2[TL_LANES]; /* w.I w, before the kick and after the drift */
    double radius[TL_LANES], speed[TL_LANES];      /* |v| + |w| radius: no vertex moves faster */
    double reach[TL_LANES];                        /* of the turn: see turn.h */
    uint32_t body[TL_LANES];
    unsigned count;
} body_group;

typedef struct move_job {
    tl_model *m;
    double kick, drift;
} move_job;

TL_INLINE tl_vec3 times(tl_vec3 a, tl_vec3 b)
{
    return tl_v3(a.x * b.x, a.y * b.y, a.z * b.z);
}

/* From principal axes to the model's. Trimmed: the rounding of `axes` is the same in every step and would add up. */
TL_INLINE tl_mat3 attitude_of(tl_quat q, tl_quat axes)
{
    return tl_q_matrix(tl_q_trim(tl_q_mul(q, axes)));
}

/* The velocity by (23). */
TL_INLINE void kick_lane(body_group *g, size_t i, double kick)
{
    /* mass scaling: less motion for the same force */
    double per_mass = kick / (g->mass[i] * g->scale[i]);
    tl_vec3 force = tl_v3_add(tl_lanes3_get(&g->force, i), tl_lanes3_get(&g->damping_force, i));
    tl_vec3 v0 = tl_lanes3_get(&g->v0, i);
    tl_lanes3_put(&g->v1, i, tl_kick(v0, force, per_mass, g->alpha[i], kick));
}

TL_INLINE double speed_of(const body_group *g, size_t i)
{
    return tl_v3_norm(tl_lanes3_get(&g->v1, i)) + tl_v3_norm(tl_lanes3_get(&g->w2, i)) * g->radius[i];
}

/* Exact rotation: the kick of the angular momentum, in principal axes. */
TL_INLINE void kick_spin(body_group *g, size_t i, double kick)
{
    tl_vec3 moments = tl_lanes3_get(&g->moments, i);
    tl_vec3 moment = tl_v3_add(tl_lanes3_get(&g->moment, i), tl_lanes3_get(&g->damping_moment, i));
    tl_mat3 attitude = attitude_of(tl_lanes4_get(&g->q, i), tl_lanes4_get(&g->axes, i));
    tl_vec3 w = tl_m3_tmul(&attitude, tl_lanes3_get(&g->w0, i)), l0 = times(moments, w);
    tl_vec3 turn = tl_m3_tmul(&attitude, moment);
    tl_vec3 l1 = tl_kick(l0, turn, kick / g->turn_scale[i], g->alpha[i], kick);
    tl_vec3 per = {1 / moments.x, 1 / moments.y, 1 / moments.z};
    tl_vec3 spin1 = times(per, l1);
    tl_lanes3_put(&g->per, i, per);
    tl_lanes3_put(&g->spin0, i, w);
    tl_lanes3_put(&g->momentum0, i, l0);
    tl_lanes3_put(&g->spin1, i, spin1);
    tl_lanes3_put(&g->momentum1, i, l1);
    tl_lanes3_put(&g->w1, i, tl_m3_mul(&attitude, spin1));
    g->turning0[i] = tl_v3_dot(w, l0);
}

/* The drift. */
TL_INLINE void turn_freely(body_group *g, size_t i, double drift, bool series)
{
    tl_free_turn free = tl_turn_freely(tl_lanes3_get(&g->momentum1, i), tl_lanes3_get(&g->per, i), drift, series);
    tl_lanes4_put(&g->made, i, free.made);
    tl_lanes3_put(&g->momentum2, i, free.momentum);
    g->reach[i] = free.reach;
}

/* The same turn in the body's frame, exactly none when nothing turned, and what spins in the new attitude. */
TL_INLINE void put_attitude(body_group *g, size_t i, double drift, bool series)
{
    tl_quat axes = tl_lanes4_get(&g->axes, i), made = tl_lanes4_get(&g->made, i);
    tl_vec3 moments = tl_lanes3_get(&g->moments, i), l2 = tl_lanes3_get(&g->momentum2, i);
    tl_vec3 axis = tl_q_rotate(axes, tl_v3(made.x, made.y, made.z));
    tl_quat q = tl_q_trim(tl_q_mul(tl_lanes4_get(&g->q, i), (tl_quat){made.w, axis.x, axis.y, axis.z}));
    tl_lanes4_put(&g->q2, i, q);
    tl_mat3 attitude = attitude_of(q, axes);
    /* a division here, not `per`: its error would be the same in every step and add up */
    tl_vec3 w2 = tl_m3_mul(&attitude, tl_v3(l2.x / moments.x, l2.y / moments.y, l2.z / moments.z));
    tl_lanes3_put(&g->w2, i, w2);
    tl_lanes3_put(&g->turned, i, tl_m3_mul(&attitude, tl_v3_scale(1 / drift, tl_turn_of(made, series))));
    /* as the next step will find it, to the last bit */
    tl_vec3 w = tl_m3_tmul(&attitude, w2);
    g->turning2[i] = tl_v3_dot(w, times(moments, w));
    g->speed[i] = speed_of(g, i);
}

/* Kicks and turns groups of bodies by the exact rule. Stage by stage, so that groups overlap in the processor. */
TL_VECTORIZED static void advance_lanes(body_group *groups, size_t count, double kick, double drift)
{
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < TL_LANES; i++) {
            kick_lane(&groups[k], i, kick);
            kick_spin(&groups[k], i, kick);
        }
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < TL_LANES; i++)
            turn_freely(&groups[k], i, drift, true);
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < TL_LANES; i++)
            put_attitude(&groups[k], i, drift, true);
}

/* What the ledger needs of a body's spin before the kick and after it, in the attitude before, and after the drift. The
 * paper's rotation has one moment of inertia in all directions. */
static void put_spins(body_group *g, size_t i, bool paper)
{
    tl_vec3 moments = tl_lanes3_get(&g->moments, i),
            spin[3] = {tl_lanes3_get(&g->w0, i), tl_lanes3_get(&g->w1, i), tl_lanes3_get(&g->w2, i)};
    if (!paper) {
        tl_quat axes = tl_lanes4_get(&g->axes, i);
        tl_mat3 before = attitude_of(tl_lanes4_get(&g->q, i), axes);
        tl_mat3 after = attitude_of(tl_lanes4_get(&g->q2, i), axes);
        spin[0] = tl_m3_tmul(&before, spin[0]);
        spin[1] = tl_m3_tmul(&before, spin[1]);
        spin[2] = tl_m3_tmul(&after, spin[2]);
    }
    tl_lanes3_put(&g->spin0, i, spin[0]);
    tl_lanes3_put(&g->momentum0, i, times(moments, spin[0]));
    tl_lanes3_put(&g->spin1, i, spin[1]);
    tl_lanes3_put(&g->momentum1, i, times(moments, spin[1]));
    g->turning0[i] = tl_v3_dot(spin[0], times(moments, spin[0]));
    g->turning2[i] = tl_v3_dot(spin[2], times(moments, spin[2]));
}

/* A body that turns about its angular velocity: by the paper's rule or, when its rotation is held, as it did. */
static void turn_about(body_group *g, size_t i, const move_job *job, bool paper, bool held)
{
    tl_vec3 w = tl_lanes3_get(&g->w0, i);
    if (!held) {
        double per_moment = job->kick / (g->moments.x[i] * g->turn_scale[i]);
        tl_vec3 moment = tl_v3_add(tl_lanes3_get(&g->moment, i), tl_lanes3_get(&g->damping_moment, i));
        w = tl_kick(w, moment, per_moment, g->alpha[i], job->kick);
    }
    tl_quat turn = tl_turn_by(tl_v3_scale(job->drift, w));
    tl_lanes4_put(&g->q2, i, tl_q_trim(tl_q_mul(turn, tl_lanes4_get(&g->q, i))));
    tl_lanes3_put(&g->w1, i, w);
    tl_lanes3_put(&g->w2, i, w);
    tl_lanes3_put(&g->turned, i, w);
    g->speed[i] = speed_of(g, i);
    put_spins(g, i, paper);
}

/* The bodies of a group that the loop over its lanes does not do justice to. */
static void mend_lanes(body_group *g, const move_job *job)
{
    const tl_model *m = job->m;
    const double limit = TL_SERIES_HALF_ANGLE * TL_SERIES_HALF_ANGLE;
    bool paper = m->config.rotation == TL_ROTATION_PAPER;
    for (size_t i = 0; i < g->count; i++) {
        unsigned fixed = m->bodies.fixed[g->body[i]];
        if (fixed) {
            g->v1.x[i] = fixed & TL_FIX_X ? g->v0.x[i] : g->v1.x[i];
            g->v1.y[i] = fixed & TL_FIX_Y ? g->v0.y[i] : g->v1.y[i];
            g->v1.z[i] = fixed & TL_FIX_Z ? g->v0.z[i] : g->v1.z[i];
            g->speed[i] = speed_of(g, i);
        }
        if (paper || fixed & TL_FIX_ROTATION)
            turn_about(g, i, job, paper, fixed & TL_FIX_ROTATION);
        else if (!(g->reach[i] < limit)) {
            turn_freely(g, i, job->drift, false);
            put_attitude(g, i, job->drift, false);
        }
    }
}

/* Nothing damps a lane. */
TL_INLINE void put_undamped(body_group *g, size_t i)
{
    const tl_vec3 none = {0, 0, 0};
    tl_lanes3_put(&g->damping_force, i, none);
    tl_lanes3_put(&g->damping_moment, i, none);
    tl_lanes3_put(&g->damped, i, none);
    g->alpha[i] = g->damped_turn[i] = 0;
}

/* What the damping gives a body. It does nothing in components that are held: their velocity stays. */
TL_INLINE void put_damping(body_group *restrict g, size_t i, const tl_model *restrict m, size_t body)
{
    const struct tl_cycle *c = m->cycle;
    const unsigned fixed = m->bodies.fixed[body];
    const tl_vec3 none = {0, 0, 0};
    const bool turns = !(fixed & TL_FIX_ROTATION);
    tl_lanes3_put(&g->damping_force, i, tl_free_part(tl_columns_get(c->damping_force, body), fixed));
    tl_lanes3_put(&g->damping_moment, i, turns ? tl_columns_get(c->damping_moment, body) : none);
    tl_lanes3_put(&g->damped, i, tl_free_part(tl_v3(1, 1, 1), fixed));
    g->damped_turn[i] = turns;
    g->alpha[i] = c->alpha[body];
}

static void load_lane(body_group *g, size_t i, const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    const struct tl_cycle *c = m->cycle;
    uint32_t body = g->body[i];
    tl_lanes4_put(&g->q, i, b->q[body]);
    tl_lanes4_put(&g->axes, i, b->axes[body]);
    tl_lanes3_put(&g->moments, i, tl_moments_of(m, body));
    tl_lanes3_put(&g->force, i, b->force[body]);
    tl_lanes3_put(&g->moment, i, b->moment[body]);
    tl_lanes3_put(&g->moved, i, b->pose[body].v_moved);
    tl_lanes3_put(&g->v0, i, b->v[body]);
    tl_lanes3_put(&g->w0, i, b->w[body]);
    g->mass[i] = b->mass[body];
    g->radius[i] = b->radius[body];
    g->scale[i] = tl_step_scale(m, body);
    g->energy_scale[i] = tl_energy_scale(c, body);
    g->turn_scale[i] = tl_turn_scale(c, body);
    if (tl_is_damped(m))
        put_damping(g, i, m, body);
    else
        put_undamped(g, i);
}

/* The same of bodies that are side by side from `first` on, without mass scaling. */
TL_VECTORIZED static void load_row(body_group *restrict g, const tl_model *m, size_t first)
{
    const tl_bodies *b = &m->bodies;
    bool damped = tl_is_damped(m), paper = m->config.rotation == TL_ROTATION_PAPER;
    tl_lanes4_load(&g->q, b->q + first);
    tl_lanes4_load(&g->axes, b->axes + first);
    tl_lanes3_load(&g->moments, b->moments + first);
    for (size_t i = 0; paper && i < TL_LANES; i++)
        g->moments.x[i] = g->moments.y[i] = g->moments.z[i] = b->round[first + i];
    tl_lanes3_load(&g->force, b->force + first);
    tl_lanes3_load(&g->moment, b->moment + first);
    tl_lanes3_load(&g->v0, b->v + first);
    tl_lanes3_load(&g->w0, b->w + first);
    for (size_t i = 0; i < TL_LANES; i++) {
        tl_lanes3_put(&g->moved, i, b->pose[first + i].v_moved);
        g->mass[i] = b->mass[first + i];
        g->radius[i] = b->radius[first + i];
        g->scale[i] = g->turn_scale[i] = g->energy_scale[i] = 1;
    }
    if (damped) {
        tl_lanes3_load_columns(&g->damping_force, m->cycle->damping_force, first);
        tl_lanes3_load_columns(&g->damping_moment, m->cycle->damping_moment, first);
        tl_lanes_load(g->alpha, m->cycle->alpha + first);
        for (size_t i = 0; i < TL_LANES; i++)
            g->damped.x[i] = g->damped.y[i] = g->damped.z[i] = g->damped_turn[i] = 1;
    }
    for (size_t i = 0; damped && i < TL_LANES; i++)
        if (b->fixed[first + i])
            put_damping(g, i, m, first + i);
    for (size_t i = 0; !damped && i < TL_LANES; i++)
        put_undamped(g, i);
}

/* A lane without a body: one that rests, and to which nothing happens. */
static void rest_lane(body_group *g, size_t i)
{
    const tl_vec3 none = {0, 0, 0};
    tl_lanes4_put(&g->q, i, tl_q_identity());
    tl_lanes4_put(&g->axes, i, tl_q_identity());
    tl_lanes3_put(&g->moments, i, tl_v3(1, 1, 1));
    tl_lanes3 *const still[] = {&g->force, &g->moment, &g->moved, &g->v0, &g->w0};
    for (size_t k = 0; k < sizeof still / sizeof *still; k++)
        tl_lanes3_put(still[k], i, none);
    g->mass[i] = g->scale[i] = g->turn_scale[i] = g->energy_scale[i] = g->radius[i] = 1;
    put_undamped(g, i);
}

TL_INLINE void store_pose(const body_group *restrict g, size_t i, const tl_mat3 *r, double dt, tl_pose *restrict pose)
{
    pose->r = *r;
    pose->v_moved = tl_lanes3_get(&g->v1, i);
    pose->w_moved = tl_lanes3_get(&g->turned, i);
    pose->u = tl_v3_madd(pose->u, dt, pose->v_moved);
}

static void store_lane(const body_group *g, size_t i, tl_bodies *b, double dt)
{
    uint32_t body = g->body[i];
    b->v[body] = tl_lanes3_get(&g->v1, i);
    b->w[body] = tl_lanes3_get(&g->w2, i);
    b->q[body] = tl_lanes4_get(&g->q2, i);
    tl_mat3 r = tl_q_matrix(b->q[body]);
    store_pose(g, i, &r, dt, &b->pose[body]);
    b->odometer[body] += g->speed[i] * dt;
}

/* The same of bodies that are side by side. */
TL_VECTORIZED static void store_row(const body_group *restrict g, const tl_bodies *b, size_t first, double dt)
{
    double *restrict odometer = b->odometer + first;
    tl_lanes9 r;
    tl_lanes3_store(&g->v1, b->v + first);
    tl_lanes3_store(&g->w2, b->w + first);
    tl_lanes4_store(&g->q2, b->q + first);
    for (size_t i = 0; i < TL_LANES; i++) {
        tl_mat3 one = tl_q_matrix(tl_lanes4_get(&g->q2, i));
        tl_lanes9_put(&r, i, &one);
        odometer[i] += g->speed[i] * dt;
    }
    for (size_t i = 0; i < TL_LANES; i++) {
        tl_mat3 one = tl_lanes9_get(&r, i);
        store_pose(g, i, &one, dt, &b->pose[first + i]);
    }
}

static bool side_by_side(const body_group *g)
{
    return g->count == TL_LANES && g->body[TL_LANES - 1] - g->body[0] == TL_LANES - 1;
}

static void load_group(body_group *g, const tl_model *m)
{
    if (side_by_side(g) && !tl_inertia_scaled(m->cycle)) {
        load_row(g, m, g->body[0]);
        return;
    }
    for (size_t i = 0; i < g->count; i++)
        load_lane(g, i, m);
    for (size_t i = g->count; i < TL_LANES; i++)
        rest_lane(g, i);
}

/* What has been set since the last step does not act in its half. */
static void take_lag(body_group *g, const tl_model *m)
{
    for (size_t i = 0; i < g->count; i++) {
        tl_wrench lag = tl_load_lag(m, g->body[i]);
        tl_lanes3_put(&g->force, i, tl_v3_sub(tl_lanes3_get(&g->force, i), lag.force));
        tl_lanes3_put(&g->moment, i, tl_v3_sub(tl_lanes3_get(&g->moment, i), lag.moment));
    }
}

static void store_group(const body_group *g, const move_job *job)
{
    if (side_by_side(g)) {
        store_row(g, &job->m->bodies, g->body[0], job->drift);
        return;
    }
    for (size_t i = 0; i < g->count; i++)
        store_lane(g, i, &job->m->bodies, job->drift);
}

/* ---------------------------------------------------------------- work --------------------
 *
 * What the bodies have and what is done to them, for the energy ledger (energy.c). */

/* What is booked of a chunk of bodies, group by group. */
typedef struct chunk_work {
    _Alignas(TL_ALIGN) double book[TL_BOOK_COUNT][TL_BODY_CHUNK];
    double held[2][TL_BODY_CHUNK]; /* external work on those held in every component */
    size_t held_count;
    bool external;       /* there may be external work on others */
    double until, after; /* half of the step before and of the one after */
} chunk_work;

/* What a force and a moment on a body do, each in the half step before and the one after. Lane i of a group, and number
 * `at` of the chunk. */
TL_INLINE double work_until(const chunk_work *work, size_t i, const body_group *g, tl_vec3 force, tl_vec3 moment)
{
    return work->until * (tl_v3_dot(force, tl_lanes3_get(&g->moved, i)) + tl_v3_dot(moment, tl_lanes3_get(&g->w0, i)));
}

TL_INLINE double work_after(const chunk_work *work, size_t i, const body_group *g, tl_vec3 force, tl_vec3 moment)
{
    return work->after * (tl_v3_dot(force, tl_lanes3_get(&g->v1, i)) + tl_v3_dot(moment, tl_lanes3_get(&g->w1, i)));
}

/* Kinetic energies. With v- and v+ the mean at the forces' time is v- + s (v+ - v-). s is the share of the step before
 * in both half steps. What two unequal halves spread about it is taken out. */
TL_INLINE void book_kinetic(chunk_work *work, size_t at, size_t i, const body_group *g, double share)
{
    double scale = g->energy_scale[i], mass = scale * g->mass[i], spread = share * (1 - share);
    tl_vec3 v0 = tl_lanes3_get(&g->v0, i), v1 = tl_lanes3_get(&g->v1, i), dv = tl_v3_sub(v1, v0);
    tl_vec3 w0 = tl_lanes3_get(&g->spin0, i), dw = tl_v3_sub(tl_lanes3_get(&g->spin1, i), w0);
    tl_vec3 l0 = tl_lanes3_get(&g->momentum0, i);
    tl_vec3 dl = tl_v3_sub(tl_lanes3_get(&g->momentum1, i), l0);
    tl_vec3 v = tl_v3_madd(v0, share, dv), w = tl_v3_madd(w0, share, dw);
    tl_vec3 l = tl_v3_madd(l0, share, dl);
    double dv2 = mass * tl_v3_norm2(dv), dw2 = scale * tl_v3_dot(dw, dl);
    work->book[TL_BOOK_KINETIC][at] = 0.5 * (mass * tl_v3_norm2(v) + scale * tl_v3_dot(w, l) - spread * (dv2 + dw2));
    /* The first kick from rest is half of one: what the whole one would have spread is missing from
     * the sum ever after. */
    work->book[TL_BOOK_FIRST][at] = 0.5 * (dv2 + dw2);
    work->book[TL_BOOK_MOTION0][at] = 0.5 * (mass * tl_v3_norm2(v0) + scale * g->turning0[i]);
    work->book[TL_BOOK_MOTION2][at] = 0.5 * (mass * tl_v3_norm2(v1) + scale * g->turning2[i]);
    /* a velocity set since the last step meets this kick, too */
    tl_vec3 set = tl_v3_sub(v0, tl_lanes3_get(&g->moved, i));
    work->book[TL_BOOK_UNTIL(TL_WORK_EXTERNAL)][at] = share * mass * tl_v3_dot(set, dv);
    work->book[TL_BOOK_AFTER(TL_WORK_EXTERNAL)][at] = 0;
}

/* v- + v+, and L- + L+ in principal axes, of what the damping acts on. */
typedef struct slowing {
    tl_vec3 moved, turned;
} slowing;

TL_INLINE slowing slowing_of(const body_group *g, size_t i)
{
    tl_vec3 moved = tl_v3_add(tl_lanes3_get(&g->v0, i), tl_lanes3_get(&g->v1, i));
    tl_vec3 turned = tl_v3_add(tl_lanes3_get(&g->momentum0, i), tl_lanes3_get(&g->momentum1, i));
    return (slowing){times(tl_lanes3_get(&g->damped, i), moved), tl_v3_scale(g->damped_turn[i], turned)};
}

/* A kick may have two unequal halves, s and 1 - s of it. Then the works of all that changes a velocity by dv miss
 * m (2 s - 1) dv^2 / 2 of what the kinetic energy becomes. For forces, which hardly change in a step, that is next to
 * nothing. A damping that stops bodies takes what it makes more of it, dv^2 - dF^2 with dv = dF + dD. Of the first
 * kick, which is half of one, all of it is in TL_BOOK_FIRST. */
TL_INLINE void book_uneven(chunk_work *work, size_t at, size_t i, const body_group *g)
{
    slowing by_alpha = slowing_of(g, i);
    double span = work->until + work->after, share = work->until / span;
    double by = -0.5 * g->alpha[i] * span;
    tl_vec3 dv = tl_v3_sub(tl_lanes3_get(&g->v1, i), tl_lanes3_get(&g->v0, i));
    tl_vec3 dw = tl_v3_sub(tl_lanes3_get(&g->spin1, i), tl_lanes3_get(&g->spin0, i));
    tl_vec3 turned = tl_v3_add(tl_lanes3_get(&g->spin1, i), tl_lanes3_get(&g->spin0, i));
    double moved = by * (2 * tl_v3_dot(dv, by_alpha.moved) - by * tl_v3_norm2(by_alpha.moved));
    double spun = by * (2 * tl_v3_dot(dw, by_alpha.turned) - by * tl_v3_dot(turned, by_alpha.turned));
    double more = fmax(g->scale[i] * g->mass[i] * moved, 0) + fmax(g->turn_scale[i] * spun, 0);
    double missed = (share - 0.5) * more;
    work->book[TL_BOOK_UNTIL(TL_WORK_DAMPING)][at] += share * missed;
    work->book[TL_BOOK_AFTER(TL_WORK_DAMPING)][at] += (1 - share) * missed;
}

/* (23) takes out alpha m (v- + v+) / 2 over the kick, m as mass scaling makes it, besides what the damping's force
 * does. Neither does anything in components that are held. */
TL_INLINE void book_damping(chunk_work *work, size_t at, size_t i, const body_group *g)
{
    double alpha = 0.5 * g->alpha[i] * g->scale[i], turning = 0.5 * g->alpha[i] * g->turn_scale[i];
    slowing by_alpha = slowing_of(g, i);
    tl_vec3 force = tl_v3_madd(tl_lanes3_get(&g->damping_force, i), -alpha * g->mass[i], by_alpha.moved);
    tl_vec3 moment = tl_lanes3_get(&g->damping_moment, i);
    work->book[TL_BOOK_UNTIL(TL_WORK_DAMPING)][at] =
        work_until(work, i, g, force, moment) -
        work->until * turning * tl_v3_dot(by_alpha.turned, tl_lanes3_get(&g->spin0, i));
    work->book[TL_BOOK_AFTER(TL_WORK_DAMPING)][at] =
        work_after(work, i, g, force, moment) -
        work->after * turning * tl_v3_dot(by_alpha.turned, tl_lanes3_get(&g->spin1, i));
}

/* The work of loads, and of what holds some components of a body's motion at a velocity. */
static void book_load(chunk_work *work, size_t at, size_t i, const body_group *g, const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    uint32_t body = g->body[i];
    unsigned fixed = b->fixed[body];
    if (fixed == 0 && !m->loads_changed && !tl_body_loaded(b, body))
        return;
    work->external = true;
    tl_wrench load = tl_acting_load(m, body);
    tl_vec3 force = load.force, moment = load.moment;
    double *until = &work->book[TL_BOOK_UNTIL(TL_WORK_EXTERNAL)][at],
           *after = &work->book[TL_BOOK_AFTER(TL_WORK_EXTERNAL)][at];
    *until += work_until(work, i, g, force, moment);
    *after += work_after(work, i, g, force, moment);
    if (fixed == 0)
        return;
    tl_reaction by = tl_reaction_on(m->cycle, body);
    force = tl_v3_add(tl_v3_madd(by.force, b->mass[body], m->cycle->gravity), force);
    moment = tl_v3_add(by.moment, moment);
    force = tl_v3(fixed & TL_FIX_X ? -force.x : 0, fixed & TL_FIX_Y ? -force.y : 0, fixed & TL_FIX_Z ? -force.z : 0);
    moment = fixed & TL_FIX_ROTATION ? tl_v3_neg(moment) : tl_v3(0, 0, 0);
    *until += work_until(work, i, g, force, moment);
    *after += work_after(work, i, g, force, moment);
}

TL_VECTORIZED static void book_lanes(chunk_work *restrict work, size_t first, const body_group *restrict g,
                                     tl_vec3 gravity, bool damped)
{
    const tl_vec3 none = {0, 0, 0};
    double share = work->until / (work->until + work->after);
    for (size_t i = 0; i < TL_LANES; i++) {
        tl_vec3 weight = tl_v3_scale(g->mass[i], gravity);
        book_kinetic(work, first + i, i, g, share);
        work->book[TL_BOOK_UNTIL(TL_WORK_GRAVITY)][first + i] = work_until(work, i, g, weight, none);
        work->book[TL_BOOK_AFTER(TL_WORK_GRAVITY)][first + i] = work_after(work, i, g, weight, none);
    }
    for (size_t i = 0; damped && i < TL_LANES; i++)
        book_damping(work, first + i, i, g);
    for (size_t i = 0; damped && work->until > 0 && work->until != work->after && i < TL_LANES; i++)
        book_uneven(work, first + i, i, g);
}

/* Books a group, from number `first` of the chunk on. */
static void book_group(const tl_model *m, const body_group *g, size_t first, chunk_work *work)
{
    book_lanes(work, first, g, m->cycle->gravity, tl_is_damped(m));
    for (size_t i = 0; i < g->count; i++)
        book_load(work, first + i, i, g, m);
}

/* Books a body that is held in every component, by the motion it made in the last step. */
static void book_held(const tl_model *m, uint32_t body, tl_vec3 moved, tl_vec3 turned, chunk_work *work)
{
    const tl_bodies *b = &m->bodies;
    /* what moves the body works against the contacts' reaction */
    tl_reaction by = tl_reaction_on(m->cycle, body);
    const size_t k = work->held_count++;
    work->held[0][k] = -work->until * (tl_v3_dot(by.force, moved) + tl_v3_dot(by.moment, turned));
    work->held[1][k] = -work->after * (tl_v3_dot(by.force, b->v[body]) + tl_v3_dot(by.moment, b->w[body]));
}

TL_VECTORIZED static bool any_of(const double *number, size_t count)
{
    uint64_t some = 0; /* as wide as the numbers */
    for (size_t i = 0; i < count; i++)
        some |= number[i] != 0;
    return some;
}

/* Adds the first `count` numbers of a chunk to what the thread has booked. */
static void sum_chunk(tl_model *m, unsigned thread, const chunk_work *work, size_t count)
{
    tl_exact *sum = m->cycle->booked[thread].sum;
    if (work->held_count > 0)
        tl_exact_add_each(sum + TL_BOOK_EXTERNAL, 2, work->held[0], TL_BODY_CHUNK, work->held_count);
    if (count == 0)
        return;
    tl_exact_add_each(sum, TL_BOOK_EXTERNAL, work->book[0], TL_BODY_CHUNK, count);
    if (work->external || any_of(work->book[TL_BOOK_EXTERNAL], count))
        tl_exact_add_each(sum + TL_BOOK_EXTERNAL, 2, work->book[TL_BOOK_EXTERNAL], TL_BODY_CHUNK, count);
    if (tl_is_damped(m))
        tl_exact_add_each(sum + TL_BOOK_DAMPING, 2, work->book[TL_BOOK_DAMPING], TL_BODY_CHUNK, count);
    if (!(work->until > 0))
        tl_exact_add(&sum[TL_BOOK_FIRST], work->book[TL_BOOK_FIRST], count);
}

/* Nothing is booked yet. */
static void begin_books(tl_model *m)
{
    for (unsigned t = 0; t < tl_pool_threads(m->pool); t++)
        m->cycle->booked[t] = (tl_booked){{{.window = 0}}};
}

/* ---------------------------------------------------------------- the move --------------- */

/* A body held in every component goes on with the velocity it was given: none, or that of its drive. */
static void carry_body(const move_job *job, uint32_t body, chunk_work *work)
{
    tl_bodies *b = &job->m->bodies;
    double dt = job->drift;
    if (b->drive[body] && !b->mesh[body]) {
        const tl_drive_record *drive = &job->m->drives[b->drive[body] - 1];
        b->v[body] = drive->velocity;
        b->w[body] = drive->angular_velocity;
    }
    tl_pose *pose = &b->pose[body];
    tl_vec3 moved = pose->v_moved, turned = pose->w_moved;
    if (tl_v3_is_zero(b->v[body]) && tl_v3_is_zero(b->w[body]) && tl_v3_is_zero(moved) && tl_v3_is_zero(turned))
        return;
    book_held(job->m, body, moved, turned, work);
    pose->u = tl_v3_madd(pose->u, dt, b->v[body]);
    pose->v_moved = b->v[body];
    pose->w_moved = b->w[body];
    b->q[body] = tl_q_trim(tl_q_mul(tl_turn_by(tl_v3_scale(dt, b->w[body])), b->q[body]));
    pose->r = tl_q_matrix(b->q[body]);
    b->odometer[body] += dt * (tl_v3_norm(b->v[body]) + tl_v3_norm(b->w[body]) * b->radius[body]);
}

static void move_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const move_job *job = user;
    tl_model *m = job->m;
    chunk_work work;
    work.until = 0.5 * m->dt;
    work.after = 0.5 * job->drift;
    work.held_count = 0;
    work.external = false;
    body_group groups[TL_BODY_CHUNK / TL_LANES];
    size_t free = 0;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL) {
            carry_body(job, body, &work);
            continue;
        }
        body_group *g = &groups[free / TL_LANES];
        g->body[free % TL_LANES] = body;
        g->count = 1 + (unsigned)(free++ % TL_LANES);
    }
    size_t count = (free + TL_LANES - 1) / TL_LANES;
    for (size_t k = 0; k < count; k++)
        load_group(&groups[k], m);
    for (size_t k = 0; k < count && tl_loads_lag(m); k++)
        take_lag(&groups[k], m);
    advance_lanes(groups, count, job->kick, job->drift);
    for (size_t k = 0; k < count; k++) {
        mend_lanes(&groups[k], job);
        book_group(m, &groups[k], k * TL_LANES, &work);
        store_group(&groups[k], job);
    }
    sum_chunk(m, thread, &work, count * TL_LANES);
}

/* Sums over the gridpoints of a mesh, lane by lane. X: place as made, from `centre`; d: displacement, from that of the
 * first gridpoint. `turn`: sum m (X + d) (x) X. */
typedef struct mesh_sums {
    _Alignas(TL_ALIGN) double mass[TL_LANES], made[3][TL_LANES], moved[3][TL_LANES], turn[3][3][TL_LANES];
    double fastest2[TL_LANES];
} mesh_sums;

TL_VECTORIZED static void sum_mesh(const tl_gridpoints *p, size_t begin, size_t end, tl_vec3 centre,
                                   mesh_sums *restrict to)
{
    const double ux = p->u[0][begin], uy = p->u[1][begin], uz = p->u[2][begin];
    const double *restrict ref[3] = {p->ref[0], p->ref[1], p->ref[2]}, *restrict u[3] = {p->u[0], p->u[1], p->u[2]};
    const double *restrict v[3] = {p->v[0], p->v[1], p->v[2]}, *restrict own = p->mass;
    const uint32_t *restrict zones = p->zones;
    for (size_t first = begin; first < end; first += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t row = first + l;
            const double mass = own[row] * ((int32_t)zones[row] > 0 ? 1.0 : 0.0); /* rows beyond the last have none */
            const double X = ref[0][row] - centre.x, Y = ref[1][row] - centre.y, Z = ref[2][row] - centre.z;
            const double dx = u[0][row] - ux, dy = u[1][row] - uy, dz = u[2][row] - uz;
            const double mx = mass * X, my = mass * Y, mz = mass * Z, x = X + dx, y = Y + dy, z = Z + dz;
            const double vx = v[0][row], vy = v[1][row], vz = v[2][row], v2 = vx * vx + vy * vy + vz * vz;
            to->mass[l] += mass;
            to->made[0][l] += mx, to->made[1][l] += my, to->made[2][l] += mz;
            to->moved[0][l] += mass * dx, to->moved[1][l] += mass * dy, to->moved[2][l] += mass * dz;
            to->turn[0][0][l] += x * mx, to->turn[0][1][l] += x * my, to->turn[0][2][l] += x * mz;
            to->turn[1][0][l] += y * mx, to->turn[1][1][l] += y * my, to->turn[1][2][l] += y * mz;
            to->turn[2][0][l] += z * mx, to->turn[2][1][l] += z * my, to->turn[2][2][l] += z * mz;
            to->fastest2[l] = tl_larger(v2, to->fastest2[l]);
        }
}

static double sum_of(const double lane[TL_LANES])
{
    double sum = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        sum += lane[l];
    return sum;
}

static tl_vec3 sum3_of(double (*lane)[TL_LANES])
{
    return tl_v3(sum_of(lane[0]), sum_of(lane[1]), sum_of(lane[2]));
}

/* The mean motion of a mesh, by mass, is that of its body. Let X be the places as made, from the mean, and x those now.
 * It has turned by the rotation in sum m x (x) X since then. */
static void pose_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const move_job *job = user;
    const tl_model *m = job->m;
    const tl_gridpoints *p = &m->zones->points;
    for (size_t k = begin; k < end; k++) {
        const tl_body_mesh *mesh = &m->zones->mesh[k];
        tl_pose *pose = &m->bodies.pose[mesh->row];
        const tl_vec3 centre = tl_v3_add(pose->x_ref, mesh->made_u);
        mesh_sums sums;
        memset(&sums, 0, sizeof sums);
        sum_mesh(p, mesh->point_begin, mesh->point_end, centre, &sums);
        const tl_vec3 mean = tl_v3_scale(1 / sum_of(sums.mass), sum3_of(sums.moved)), made = sum3_of(sums.made);
        pose->u = tl_v3_add(mesh->made_u, tl_v3_add(tl_columns_get(p->u, mesh->point_begin), mean));
        const tl_vec3 less[3] = {tl_v3_scale(mean.x, made), tl_v3_scale(mean.y, made), tl_v3_scale(mean.z, made)};
        tl_mat3 turn;
        double fastest2 = 0;
        for (int i = 0; i < 3; i++) {
            const tl_vec3 row = tl_v3_sub(sum3_of(sums.turn[i]), less[i]);
            turn.m[i][0] = row.x, turn.m[i][1] = row.y, turn.m[i][2] = row.z;
        }
        for (size_t l = 0; l < TL_LANES; l++)
            fastest2 = tl_larger(fastest2, sums.fastest2[l]);
        const tl_mat3 r = tl_m3_polar(&turn);
        m->bodies.q[mesh->row] = tl_q_trim(tl_q_mul(tl_q_of_matrix(&r), mesh->made_q));
        pose->r = tl_q_matrix(m->bodies.q[mesh->row]);
        m->bodies.odometer[mesh->row] += job->drift * sqrt(fastest2);
    }
}

void tl_move(tl_model *m, double dt)
{
    move_job job = {m, 0.5 * (m->dt + dt), dt};
    begin_books(m);
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, move_range, &job);
    if (!tl_model_deforms(m))
        return;
    tl_gridpoints_move(m, dt);
    tl_parallel_for(m->pool, m->zones->mesh_count, 1, pose_range, &job);
    tl_carriers_follow(m, dt);
}
