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
 * and turn all of them, stage by stage. The energy ledger books what happened, and the lanes are copied back. Bodies
 * held in some components, and all with the paper's rotation, get their rotation one by one. Those held in every
 * component are in no group and cost nothing as long as they stand. */
#include "cycle/motion.h"

#include "base/columns.h"
#include "base/parallel.h"
#include "cycle/cycle_data.h"
#include "cycle/energy.h"
#include "cycle/kick.h"
#include "cycle/turn.h"

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
TL_INLINE void kick_lane(tl_body_group *g, size_t i, double kick)
{
    /* mass scaling: less motion for the same force */
    double per_mass = kick / (g->mass[i] * g->scale[i]);
    tl_vec3 force = tl_v3_add(tl_lanes3_get(&g->force, i), tl_lanes3_get(&g->damping_force, i));
    tl_vec3 v0 = tl_lanes3_get(&g->v0, i);
    tl_lanes3_put(&g->v1, i, tl_kick(v0, force, per_mass, g->alpha[i], kick));
}

TL_INLINE double speed_of(const tl_body_group *g, size_t i)
{
    return tl_v3_norm(tl_lanes3_get(&g->v1, i)) + tl_v3_norm(tl_lanes3_get(&g->w2, i)) * g->radius[i];
}

/* Exact rotation: the kick of the angular momentum, in principal axes. */
TL_INLINE void kick_spin(tl_body_group *g, size_t i, double kick)
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
TL_INLINE void turn_freely(tl_body_group *g, size_t i, double drift, bool series)
{
    tl_free_turn free = tl_turn_freely(tl_lanes3_get(&g->momentum1, i), tl_lanes3_get(&g->per, i), drift, series);
    tl_lanes4_put(&g->made, i, free.made);
    tl_lanes3_put(&g->momentum2, i, free.momentum);
    g->reach[i] = free.reach;
}

/* The same turn in the body's frame, exactly none when nothing turned, and what spins in the new attitude. */
TL_INLINE void put_attitude(tl_body_group *g, size_t i, double drift, bool series)
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
TL_VECTORIZED static void advance_lanes(tl_body_group *groups, size_t count, double kick, double drift)
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
static void put_spins(tl_body_group *g, size_t i, bool paper)
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
static void turn_about(tl_body_group *g, size_t i, const move_job *job, bool paper, bool held)
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
static void mend_lanes(tl_body_group *g, const move_job *job)
{
    const tl_model *m = job->m;
    const double limit = TL_SERIES_HALF_ANGLE * TL_SERIES_HALF_ANGLE;
    bool paper = m->config.rotation == TL_ROTATION_PAPER;
    for (size_t i = 0; i < g->count; i++) {
        unsigned fixed = m->bodies.fixed[g->body[i]];
        g->v1.x[i] = fixed & TL_FIX_X ? g->v0.x[i] : g->v1.x[i];
        g->v1.y[i] = fixed & TL_FIX_Y ? g->v0.y[i] : g->v1.y[i];
        g->v1.z[i] = fixed & TL_FIX_Z ? g->v0.z[i] : g->v1.z[i];
        if (fixed)
            g->speed[i] = speed_of(g, i);
        if (paper || fixed & TL_FIX_ROTATION)
            turn_about(g, i, job, paper, fixed & TL_FIX_ROTATION);
        else if (!(g->reach[i] < limit)) {
            turn_freely(g, i, job->drift, false);
            put_attitude(g, i, job->drift, false);
        }
    }
}

TL_INLINE void put_damping(tl_body_group *restrict g, size_t i, const struct tl_cycle *restrict c, bool damped,
                           size_t body)
{
    const tl_vec3 none = {0, 0, 0};
    tl_lanes3_put(&g->damping_force, i, damped ? tl_columns_get(c->damping_force, body) : none);
    tl_lanes3_put(&g->damping_moment, i, damped ? tl_columns_get(c->damping_moment, body) : none);
    g->alpha[i] = damped ? c->alpha[body] : 0;
}

static void load_lane(tl_body_group *g, size_t i, const tl_model *m)
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
    g->scale[i] = tl_inertia_scale(c, body);
    g->energy_scale[i] = tl_energy_scale(c, body);
    g->turn_scale[i] = tl_turn_scale(c, body);
    put_damping(g, i, c, m->damping, body);
}

/* The same of bodies that are side by side from `first` on, without mass scaling. */
TL_VECTORIZED static void load_row(tl_body_group *restrict g, const tl_model *m, size_t first)
{
    const tl_bodies *b = &m->bodies;
    bool damped = m->damping, paper = m->config.rotation == TL_ROTATION_PAPER;
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
    for (size_t i = 0; damped && i < TL_LANES; i++)
        put_damping(g, i, m->cycle, true, first + i);
    for (size_t i = 0; !damped && i < TL_LANES; i++)
        put_damping(g, i, m->cycle, false, first + i);
}

/* A lane without a body: one that rests, and to which nothing happens. */
static void rest_lane(tl_body_group *g, size_t i)
{
    const tl_vec3 none = {0, 0, 0};
    tl_lanes4_put(&g->q, i, tl_q_identity());
    tl_lanes4_put(&g->axes, i, tl_q_identity());
    tl_lanes3_put(&g->moments, i, tl_v3(1, 1, 1));
    tl_lanes3 *const still[] = {&g->force, &g->moment, &g->damping_force, &g->damping_moment, &g->moved,
                                &g->v0,    &g->w0};
    for (size_t k = 0; k < sizeof still / sizeof *still; k++)
        tl_lanes3_put(still[k], i, none);
    g->mass[i] = g->scale[i] = g->turn_scale[i] = g->energy_scale[i] = g->radius[i] = 1;
    g->alpha[i] = 0;
}

TL_INLINE void store_pose(const tl_body_group *restrict g, size_t i, const tl_mat3 *r, double dt,
                          tl_pose *restrict pose)
{
    pose->r = *r;
    pose->v_moved = tl_lanes3_get(&g->v1, i);
    pose->w_moved = tl_lanes3_get(&g->turned, i);
    pose->u = tl_v3_madd(pose->u, dt, pose->v_moved);
}

static void store_lane(const tl_body_group *g, size_t i, tl_bodies *b, double dt)
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
TL_VECTORIZED static void store_row(const tl_body_group *restrict g, const tl_bodies *b, size_t first, double dt)
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

static bool side_by_side(const tl_body_group *g)
{
    return g->count == TL_LANES && g->body[TL_LANES - 1] - g->body[0] == TL_LANES - 1;
}

static void load_group(tl_body_group *g, const tl_model *m)
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
static void take_lag(tl_body_group *g, const tl_model *m)
{
    for (size_t i = 0; i < g->count; i++) {
        tl_wrench lag = tl_load_lag(m, g->body[i]);
        tl_lanes3_put(&g->force, i, tl_v3_sub(tl_lanes3_get(&g->force, i), lag.force));
        tl_lanes3_put(&g->moment, i, tl_v3_sub(tl_lanes3_get(&g->moment, i), lag.moment));
    }
}

static void store_group(const tl_body_group *g, const move_job *job)
{
    if (side_by_side(g)) {
        store_row(g, &job->m->bodies, g->body[0], job->drift);
        return;
    }
    for (size_t i = 0; i < g->count; i++)
        store_lane(g, i, &job->m->bodies, job->drift);
}

/* A body held in every component goes on with the velocity it was given: none, or that of its drive. */
static void carry_body(const move_job *job, uint32_t body, tl_work *work)
{
    tl_bodies *b = &job->m->bodies;
    double dt = job->drift;
    if (b->drive[body]) {
        const tl_drive_record *drive = &job->m->drives[b->drive[body] - 1];
        b->v[body] = drive->velocity;
        b->w[body] = drive->angular_velocity;
    }
    tl_pose *pose = &b->pose[body];
    tl_vec3 moved = pose->v_moved, turned = pose->w_moved;
    if (tl_v3_is_zero(b->v[body]) && tl_v3_is_zero(b->w[body]) && tl_v3_is_zero(moved) && tl_v3_is_zero(turned))
        return;
    tl_energy_book_held(job->m, body, moved, turned, work);
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
    tl_work work;
    work.until = 0.5 * m->dt;
    work.after = 0.5 * job->drift;
    work.held_count = 0;
    work.external = false;
    tl_body_group groups[TL_BODY_CHUNK / TL_LANES];
    size_t free = 0;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL) {
            carry_body(job, body, &work);
            continue;
        }
        tl_body_group *g = &groups[free / TL_LANES];
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
        tl_energy_book(m, &groups[k], k * TL_LANES, &work);
        store_group(&groups[k], job);
    }
    tl_energy_chunk(m, thread, &work, count * TL_LANES);
}

void tl_move(tl_model *m, double dt)
{
    move_job job = {m, 0.5 * (m->dt + dt), dt};
    tl_energy_begin(m);
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, move_range, &job);
}
