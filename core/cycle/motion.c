/* motion.c - the law of motion: velocities kicked by forces, places drifting with velocities.
 *
 * Velocities live half-way between the steps, so a kick spans half of the last step and half of this one;
 * the first from rest is half a step (free fall then follows g t^2 / 2 at whole steps). (23) of Hart,
 * Cundall and Lemos (1988): v <- (D1 v + F/m h) D2, D1 = 1 - alpha h/2, D2 = 1/(1 + alpha h/2).
 *
 * Rotation, exact: the kick acts on the angular momentum L; the drift is the free motion of a rigid body
 * with L constant in space, split into turns about the principal axes (Dullweber, Leimkuhler and
 * McLachlan 1997): time-reversible, keeps L to rounding and the energy without drift. The angular
 * velocity kept is that of L in the attitude at the end of the drift, so L is recovered from it.
 * Rotation, paper: one moment of inertia, w <- (D1 w + M/I h) D2 (20), (23); the attitude turns exactly
 * about w. */
#include "cycle/cycle_room.h"

typedef struct move_job {
    tl_model *m;
    double kick, drift;
} move_job;

/* Half angles below which sine and cosine are taken from their series, whose next term is then below
 * rounding: the same bits with any mathematics library, and faster. */
#define SERIES_HALF_ANGLE 0.05

/* The quaternion of a turn: along `rotation`, by its length. */
static tl_quat turn_by(tl_vec3 rotation)
{
    double h2 = 0.25 * tl_v3_norm2(rotation), c, s; /* s: sin(h) / h */
    if (h2 < SERIES_HALF_ANGLE * SERIES_HALF_ANGLE) {
        c = 1 - h2 / 2 * (1 - h2 / 12 * (1 - h2 / 30 * (1 - h2 / 56)));
        s = 1 - h2 / 6 * (1 - h2 / 20 * (1 - h2 / 42 * (1 - h2 / 72)));
    } else {
        double h = sqrt(h2);
        c = cos(h);
        s = sin(h) / h;
    }
    return (tl_quat){c, 0.5 * s * rotation.x, 0.5 * s * rotation.y, 0.5 * s * rotation.z};
}

/* One turn of the splitting: about principal axis `axis` for time `dt`. Adds to the turn made so far and
 * turns the angular momentum in principal axes. */
static void split_turn(int axis, double dt, const double moments[3], double l[3], tl_quat *made)
{
    double angle = dt * l[axis] / moments[axis];
    tl_vec3 rotation = {axis == 0 ? angle : 0, axis == 1 ? angle : 0, axis == 2 ? angle : 0};
    tl_quat turn = turn_by(rotation);
    *made = tl_q_mul(*made, turn);
    tl_vec3 turned = tl_q_rotate(tl_q_conj(turn), tl_v3(l[0], l[1], l[2]));
    l[0] = turned.x;
    l[1] = turned.y;
    l[2] = turned.z;
}

/* The one turn a quaternion makes: axis times angle, the inverse of turn_by. */
static tl_vec3 turn_of(tl_quat q)
{
    double s2 = q.x * q.x + q.y * q.y + q.z * q.z, k; /* k: angle / sine of its half */
    if (s2 < SERIES_HALF_ANGLE * SERIES_HALF_ANGLE) {
        k = 2 * (1 + s2 * (1. / 6 +
                           s2 * (3. / 40 + s2 * (5. / 112 + s2 * (35. / 1152 + s2 * 63. / 2816)))));
    } else {
        double s = sqrt(s2);
        k = 2 * atan2(s, q.w) / s;
    }
    return tl_v3(k * q.x, k * q.y, k * q.z);
}

static void rotate_exact(tl_bodies *b, uint32_t i, tl_vec3 moment, const move_job *job,
                         double alpha)
{
    const double moments[3] = {b->moments[i].x, b->moments[i].y, b->moments[i].z};
    double d1 = 1 - 0.5 * alpha * job->kick, d2 = 1 / (1 + 0.5 * alpha * job->kick);
    tl_quat back = tl_q_conj(tl_q_mul(b->q[i], b->axes[i])); /* to principal axes */
    tl_vec3 w = tl_q_rotate(back, b->w[i]);
    tl_vec3 kick = tl_q_rotate(back, tl_v3_scale(job->kick, moment));
    double l[3] = {(d1 * moments[0] * w.x + kick.x) * d2, (d1 * moments[1] * w.y + kick.y) * d2,
                   (d1 * moments[2] * w.z + kick.z) * d2};
    double half = 0.5 * job->drift;
    tl_quat made = tl_q_identity();
    split_turn(0, half, moments, l, &made);
    split_turn(1, half, moments, l, &made);
    split_turn(2, job->drift, moments, l, &made);
    split_turn(1, half, moments, l, &made);
    split_turn(0, half, moments, l, &made);
    /* the same turn in the body's frame: exactly none when nothing turned */
    tl_vec3 axis = tl_q_rotate(b->axes[i], tl_v3(made.x, made.y, made.z));
    b->q[i] = tl_q_unit(tl_q_mul(b->q[i], (tl_quat){made.w, axis.x, axis.y, axis.z}));
    tl_vec3 spin = {l[0] / moments[0], l[1] / moments[1], l[2] / moments[2]};
    tl_quat forth = tl_q_mul(b->q[i], b->axes[i]);
    b->w[i] = tl_q_rotate(forth, spin);
    b->w_moved[i] = tl_q_rotate(forth, tl_v3_scale(1 / job->drift, turn_of(made)));
}

static void rotate_paper(tl_bodies *b, uint32_t i, tl_vec3 moment, const move_job *job,
                         double alpha)
{
    double d1 = 1 - 0.5 * alpha * job->kick, d2 = 1 / (1 + 0.5 * alpha * job->kick);
    b->w[i] =
        tl_v3_scale(d2, tl_v3_madd(tl_v3_scale(d1, b->w[i]), job->kick / b->round[i], moment));
    b->q[i] = tl_q_unit(tl_q_mul(turn_by(tl_v3_scale(job->drift, b->w[i])), b->q[i]));
    b->w_moved[i] = b->w[i];
}

static void count_motion(tl_bodies *b, uint32_t i, double dt)
{
    b->v_moved[i] = b->v[i];
    b->odometer[i] += (tl_v3_norm(b->v[i]) + tl_v3_norm(b->w[i]) * b->radius[i]) * dt;
}

static void turn_body(tl_bodies *b, uint32_t i, double dt)
{
    b->w_moved[i] = b->w[i];
    if (tl_v3_norm2(b->w[i]) == 0)
        return;
    b->q[i] = tl_q_unit(tl_q_mul(turn_by(tl_v3_scale(dt, b->w[i])), b->q[i]));
    b->r[i] = tl_q_matrix(b->q[i]);
}

/* A body held in every component goes on with the velocity it was given: none, or that of its drive. */
static void carry_body(const move_job *job, uint32_t i)
{
    tl_bodies *b = &job->m->bodies;
    if (b->drive[i]) {
        const tl_drive_record *drive = &job->m->drives[b->drive[i] - 1];
        b->v[i] = drive->velocity;
        b->w[i] = drive->angular_velocity;
    }
    b->u[i] = tl_v3_madd(b->u[i], job->drift, b->v[i]);
    turn_body(b, i, job->drift);
    count_motion(b, i, job->drift);
}

static void move_body(const move_job *job, uint32_t i)
{
    tl_model *m = job->m;
    tl_bodies *b = &m->bodies;
    const struct tl_cycle *c = m->cycle;
    unsigned fixed = b->fixed[i];
    if (fixed == TL_FIX_ALL) {
        carry_body(job, i);
        return;
    }
    tl_vec3 force = b->force[i], moment = b->moment[i];
    double alpha = 0;
    if (m->damping) {
        force = tl_v3_add(
            force, tl_v3(c->damping_force[0][i], c->damping_force[1][i], c->damping_force[2][i]));
        moment = tl_v3_add(moment, tl_v3(c->damping_moment[0][i], c->damping_moment[1][i],
                                         c->damping_moment[2][i]));
        alpha = c->alpha[i];
    }
    /* mass scaling: less motion for the same force */
    force = tl_v3_scale(1 / c->scale[i], force);
    moment = tl_v3_scale(1 / c->scale[i], moment);
    double d1 = 1 - 0.5 * alpha * job->kick, d2 = 1 / (1 + 0.5 * alpha * job->kick);
    tl_vec3 v =
        tl_v3_scale(d2, tl_v3_madd(tl_v3_scale(d1, b->v[i]), job->kick / b->mass[i], force));
    b->v[i] = tl_v3(fixed & TL_FIX_X ? b->v[i].x : v.x, fixed & TL_FIX_Y ? b->v[i].y : v.y,
                    fixed & TL_FIX_Z ? b->v[i].z : v.z);
    b->u[i] = tl_v3_madd(b->u[i], job->drift, b->v[i]);
    if (fixed & TL_FIX_ROTATION) {
        turn_body(b, i, job->drift);
    } else {
        if (m->config.rotation == TL_ROTATION_PAPER)
            rotate_paper(b, i, moment, job, alpha);
        else
            rotate_exact(b, i, moment, job, alpha);
        b->r[i] = tl_q_matrix(b->q[i]);
    }
    count_motion(b, i, job->drift);
}

static void move_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        move_body(user, (uint32_t)i);
}

bool tl_move(tl_model *m, double dt)
{
    move_job job = {m, 0.5 * (m->dt + dt), dt};
    bool driven = tl_drives_evaluate(m, m->time + 0.5 * dt);
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, move_range, &job);
    return driven;
}
