/* energy.c - the energy ledger of the bodies that are free to move.
 *
 * In a central-difference march the sum that is conserved belongs to whole steps: with v- and v+ the
 * velocities before and after the kick at step n, the kinetic energy at n is m v-.v+ / 2, and the work
 * of a force over a step is the mean of its values at both ends times the motion. So each force's work is
 * booked in two halves: F_n.v- times half of the step before belongs to time n, F_n.v+ times half of the
 * step after belongs to what follows. Elastic energy and slip come from the laws with the same mean.
 * The error of the balance is of the second order in omega dt.
 *
 * Velocities may be set and bodies held, driven or freed between two steps: the kinetic energy this gives or
 * takes counts as external work, and the work until then goes by the motion that was made. */
#include "cycle/cycle_room.h"

#include <stdlib.h>

enum { WORK_GRAVITY, WORK_DAMPING, WORK_EXTERNAL, WORK_COUNT };

struct tl_ledger {
    double kinetic;
    double until[WORK_COUNT]; /* work of this step's forces until now */
    double after[WORK_COUNT]; /* and in the half step that follows */
    double stored, friction;
    double motion; /* kinetic energy between two kicks: before a step's, or after it */
    /* running sums, in the model's own ledger */
    double sum[WORK_COUNT];
    double start_kinetic, start_stored;
    double largest; /* change of a term so far */
    double by_hand; /* kinetic energy given between steps */
    double first;   /* kinetic energy by which the scheme's sum is less in the first step */
    bool started;
    tl_energy energy;
};

tl_status tl_energy_prepare(tl_model *m, size_t chunks)
{
    struct tl_cycle *c = m->cycle;
    struct tl_ledger *list = realloc(c->chunk_ledger, chunks * sizeof *list);
    if (list)
        c->chunk_ledger = list;
    if (!c->ledger)
        c->ledger = calloc(1, sizeof *c->ledger);
    return list && c->ledger ? TL_OK : tl_fail_memory(&m->error);
}

/* Angular velocity from angular momentum in the attitude at the forces' time. */
static tl_vec3 velocity_of(const tl_model *m, uint32_t body, tl_vec3 spin)
{
    if (m->config.rotation == TL_ROTATION_PAPER)
        return tl_v3_scale(1 / m->bodies.round[body], spin);
    tl_quat attitude = m->cycle->attitude[body];
    tl_vec3 l = tl_q_rotate(tl_q_conj(attitude), spin), i = m->bodies.moments[body];
    return tl_q_rotate(attitude, tl_v3(l.x / i.x, l.y / i.y, l.z / i.z));
}

tl_vec3 tl_body_spin(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    if (m->config.rotation == TL_ROTATION_PAPER)
        return tl_v3_scale(b->round[body], b->w[body]);
    tl_quat attitude = tl_q_mul(b->q[body], b->axes[body]);
    tl_vec3 w = tl_q_rotate(tl_q_conj(attitude), b->w[body]), i = b->moments[body];
    return tl_q_rotate(attitude, tl_v3(i.x * w.x, i.y * w.y, i.z * w.z));
}

/* Kinetic energy of a body by its velocities half-way between two steps; driven and held ones have none. */
static double motion_energy(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    if (b->drive[body] || b->fixed[body] == TL_FIX_ALL)
        return 0;
    return 0.5 *
           (b->mass[body] * tl_v3_norm2(b->v[body]) + tl_v3_dot(b->w[body], tl_body_spin(m, body)));
}

static void before_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    tl_model *m = user;
    struct tl_cycle *c = m->cycle;
    struct tl_ledger l = {0};
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        c->v_before[i] = m->bodies.v[i];
        c->moved_before[i] = m->bodies.v_moved[i];
        c->turned_before[i] = m->bodies.w_moved[i];
        c->spin_before[i] = tl_body_spin(m, i);
        c->attitude[i] = tl_q_mul(m->bodies.q[i], m->bodies.axes[i]);
        l.motion += motion_energy(m, i);
    }
    c->chunk_ledger[chunk] = l;
}

static double sum_motion(const tl_model *m)
{
    double sum = 0;
    for (size_t chunk = 0; chunk * TL_BODY_CHUNK < m->bodies.table.rows; chunk++)
        sum += m->cycle->chunk_ledger[chunk].motion;
    return sum;
}

void tl_energy_before(tl_model *m)
{
    struct tl_ledger *total = m->cycle->ledger;
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, before_range, m);
    /* the same sum as after the last step, so 0 when nobody touched it */
    if (total->started)
        total->by_hand += sum_motion(m) - total->motion;
}

/* Force and moment on a body, and its velocities on both sides of the kick. */
typedef struct kick {
    tl_vec3 v0, w0, v1, w1;
    tl_vec3 moved, turned; /* velocities of the motion before it: v0 and w0 unless set since */
    double until, after;   /* half of the step before and of the one after */
} kick;

static void book(struct tl_ledger *l, int work, const kick *k, tl_vec3 force, tl_vec3 moment)
{
    l->until[work] += k->until * (tl_v3_dot(force, k->moved) + tl_v3_dot(moment, k->turned));
    l->after[work] += k->after * (tl_v3_dot(force, k->v1) + tl_v3_dot(moment, k->w1));
}

static void book_driven(const tl_model *m, uint32_t i, const kick *k, struct tl_ledger *l)
{
    /* what moves the body works against the contacts' reaction */
    book(l, WORK_EXTERNAL, k, tl_v3_neg(m->cycle->reaction_force[i]),
         tl_v3_neg(m->cycle->reaction_moment[i]));
}

/* The work of what holds some components of a body's motion at a velocity. */
static void book_held(const tl_model *m, uint32_t i, const kick *k, struct tl_ledger *l)
{
    const tl_bodies *b = &m->bodies;
    unsigned fixed = b->fixed[i];
    tl_vec3 arm = tl_m3_mul(&b->r[i], b->load_arm[i]);
    tl_vec3 force = tl_v3_add(
        tl_v3_madd(m->cycle->reaction_force[i], b->mass[i], m->config.gravity), b->load_force[i]);
    tl_vec3 moment = tl_v3_add(tl_v3_add(m->cycle->reaction_moment[i], b->load_moment[i]),
                               tl_v3_cross(arm, b->load_force[i]));
    force = tl_v3(fixed & TL_FIX_X ? -force.x : 0, fixed & TL_FIX_Y ? -force.y : 0,
                  fixed & TL_FIX_Z ? -force.z : 0);
    book(l, WORK_EXTERNAL, k, force, fixed & TL_FIX_ROTATION ? tl_v3_neg(moment) : tl_v3(0, 0, 0));
}

static void book_free(const tl_model *m, uint32_t i, const kick *k, struct tl_ledger *l)
{
    const tl_bodies *b = &m->bodies;
    const struct tl_cycle *c = m->cycle;
    double mass = b->mass[i], share = k->until / (k->until + k->after);
    tl_vec3 spin0 = c->spin_before[i], spin1 = tl_body_spin(m, i);
    tl_vec3 dv = tl_v3_sub(k->v1, k->v0), dw = tl_v3_sub(k->w1, k->w0);
    tl_vec3 dspin = tl_v3_sub(spin1, spin0);
    tl_vec3 v = tl_v3_madd(k->v0, share, dv), w = tl_v3_madd(k->w0, share, dw);
    tl_vec3 spin = tl_v3_madd(spin0, share, dspin);
    double spread = share * (1 - share);
    /* The first kick from rest is half of one: what the whole one would have spread is missing from
     * the sum ever after. */
    if (k->until == 0)
        l->first += 0.5 * (mass * tl_v3_norm2(dv) + tl_v3_dot(dw, dspin));
    l->kinetic += 0.5 * mass * (tl_v3_norm2(v) - spread * tl_v3_norm2(dv)) +
                  0.5 * (tl_v3_dot(w, spin) - spread * tl_v3_dot(dw, dspin));
    /* a velocity set since the last step meets this kick, too */
    l->until[WORK_EXTERNAL] += share * mass * tl_v3_dot(tl_v3_sub(k->v0, k->moved), dv);
    l->motion += motion_energy(m, i);
    book(l, WORK_GRAVITY, k, tl_v3_scale(mass, m->config.gravity), tl_v3(0, 0, 0));
    tl_vec3 arm = tl_m3_mul(&b->r[i], b->load_arm[i]);
    book(l, WORK_EXTERNAL, k, b->load_force[i],
         tl_v3_add(b->load_moment[i], tl_v3_cross(arm, b->load_force[i])));
    if (b->fixed[i])
        book_held(m, i, k, l);
    if (!m->damping)
        return;
    tl_vec3 force = {c->damping_force[0][i], c->damping_force[1][i], c->damping_force[2][i]};
    tl_vec3 moment = {c->damping_moment[0][i], c->damping_moment[1][i], c->damping_moment[2][i]};
    /* (23) takes out alpha m (v- + v+) / 2 over the kick */
    double alpha = 0.5 * c->alpha[i];
    force = tl_v3_madd(force, -alpha * mass, tl_v3_add(k->v0, k->v1));
    moment = tl_v3_madd(moment, -alpha, tl_v3_add(spin0, spin1));
    book(l, WORK_DAMPING, k, force, moment);
}

typedef struct ledger_job {
    tl_model *m;
    double until, after;
} ledger_job;

static void after_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const ledger_job *job = user;
    const tl_model *m = job->m;
    const tl_bodies *b = &m->bodies;
    struct tl_ledger l = {0};
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        kick k = {.v0 = m->cycle->v_before[i],
                  .v1 = b->v[i],
                  .w0 = velocity_of(m, i, m->cycle->spin_before[i]),
                  .w1 = velocity_of(m, i, tl_body_spin(m, i)),
                  .moved = m->cycle->moved_before[i],
                  .turned = m->cycle->turned_before[i],
                  .until = 0.5 * job->until,
                  .after = 0.5 * job->after};
        if (!b->drive[i])
            k.turned = k.w0;
        if (b->fixed[i] == TL_FIX_ALL)
            book_driven(m, i, &k, &l);
        else
            book_free(m, i, &k, &l);
    }
    m->cycle->chunk_ledger[chunk] = l;
}

/* Elastic energy and slip of the contact points, in the order of their pages. */
static void sum_points(const tl_model *m, struct tl_ledger *l)
{
    const tl_detect *d = m->detect;
    for (size_t r = 0; r < d->run_count; r++) {
        const tl_run *run = &d->runs[r];
        for (size_t at = run->begin; at < run->end && run->material != TL_NO_ROW; at += TL_PAGE) {
            l->stored += m->cycle->page_energy[at / TL_PAGE].stored;
            l->friction += m->cycle->page_energy[at / TL_PAGE].dissipated;
        }
    }
}

/* The ledger at the forces' time, and its balance. */
static void close_ledger(struct tl_ledger *total, const struct tl_ledger *now)
{
    tl_energy *e = &total->energy;
    bool first = !total->started;
    if (!total->started) {
        total->started = true;
        total->start_kinetic = now->kinetic - now->first;
        total->start_stored = now->stored;
    }
    double at[WORK_COUNT];
    for (int w = 0; w < WORK_COUNT; w++) {
        at[w] = total->sum[w] + now->until[w];
        total->sum[w] = at[w] + now->after[w];
    }
    total->friction += now->friction;
    e->kinetic = now->kinetic;
    e->stored = now->stored;
    e->potential = -at[WORK_GRAVITY];
    e->damping = -at[WORK_DAMPING];
    e->external = at[WORK_EXTERNAL] + total->by_hand;
    e->friction = total->friction;
    double gain_kinetic = e->kinetic - total->start_kinetic;
    double gain_stored = e->stored - total->start_stored;
    double sum = gain_kinetic + e->potential + gain_stored + e->friction + e->damping - e->external;
    double largest = fmax(fmax(fabs(gain_kinetic), fabs(e->potential)),
                          fmax(fabs(gain_stored), fabs(e->friction)));
    largest = fmax(largest, fmax(fabs(e->damping), fabs(e->external)));
    largest = fmax(largest, fmax(e->kinetic, total->start_kinetic));
    /* Not of this moment's terms: where all pass through zero at once the ratio would mean nothing. */
    if (!first)
        total->largest = fmax(total->largest, largest);
    e->balance = total->largest > 0 ? sum / total->largest : 0;
}

void tl_energy_after(tl_model *m, double dt_before, double dt_after)
{
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows;
    ledger_job job = {m, dt_before, dt_after};
    tl_parallel_for(m->pool, bodies, TL_BODY_CHUNK, after_range, &job);
    struct tl_ledger now = {0};
    for (size_t chunk = 0; chunk * TL_BODY_CHUNK < bodies; chunk++) {
        const struct tl_ledger *l = &c->chunk_ledger[chunk];
        now.kinetic += l->kinetic;
        now.first += l->first;
        now.motion += l->motion;
        for (int w = 0; w < WORK_COUNT; w++) {
            now.until[w] += l->until[w];
            now.after[w] += l->after[w];
        }
    }
    c->ledger->motion = now.motion;
    sum_points(m, &now);
    close_ledger(c->ledger, &now);
}

tl_status tl_model_energy(tl_model *m, tl_energy *energy)
{
    *energy = m->cycle && m->cycle->ledger ? m->cycle->ledger->energy : (tl_energy){0};
    return TL_OK;
}
