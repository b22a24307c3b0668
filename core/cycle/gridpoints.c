/* gridpoints.c - gridpoints of zones in a step: their forces, motion and rest.
 *
 * A gridpoint is a point of mass m. Its zones, contacts, weight and load push it, and it moves by central differences
 * as bodies do: v <- (D1 v + F/m h) D2, x <- x + v dt. Components that are held keep the velocity they were given.
 *
 * Rest asks of a gridpoint what it asks of a body (rest.c), with B = sqrt(n sum f^2) for the n forces of its zones. A
 * mesh swings more softly than one of its gridpoints by far. So kinetic energy is compared over the whole of it:
 *
 *     sum m v.v / 2  <  the smaller of ratio and 1000 ratio^2, times sum B^2 / (2 k)
 *
 * Rows of a mesh are padded to whole lanes, so lanes add up in one order, whoever takes them. */
#include "cycle/gridpoints.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "cycle/turn.h"
#include "segment/act.h"
#include "segment/carriers.h"
#include "zone/stiffness.h"

#include <math.h>
#include <string.h>

/* Rows that a thread takes at a time: a multiple of TL_LANES. */
#define CHUNK 256

/* All components of a gridpoint. */
#define ALL (TL_FIX_X | TL_FIX_Y | TL_FIX_Z)

/* ---------------------------------------------------------------- step ------------------- */

/* What holds each gridpoint: zones and, no less than the floor, segments and carriers. */
static void find_holds(tl_model *m)
{
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        p->holds[row] = 0;
    tl_segments_stiffen(m);
    tl_carriers_stiffen(m);
    for (size_t row = 0; row < p->table.rows; row++)
        p->holds[row] = p->stiffness[row] + tl_larger(p->holds[row], p->floor[row]);
}

double tl_gridpoints_least(tl_model *m)
{
    if (!tl_model_deforms(m))
        return INFINITY;
    struct tl_zones *z = m->zones;
    const bool carried = m->detect && m->detect->contacts.carrier[0];
    if (tl_zones_stiffen(m) || carried || (m->segments && m->segments->version != z->segments_rated)) {
        find_holds(m);
        z->segments_rated = m->segments ? m->segments->version : 0;
        tl_zones_rate(m);
    }
    const double rate = tl_scales_all(m) ? z->lowest_rate : z->highest_rate;
    return rate > 0 ? 1 / rate : INFINITY;
}

/* What mass scaling makes of a gridpoint's mass. */
double tl_gridpoint_scale(const tl_model *m, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    const double scale = m->cycle->mass_scale * p->holds[row] / p->mass[row];
    return m->cycle->mass_scale > 0 && p->holds[row] > 0 ? scale : 1;
}

/* ---------------------------------------------------------------- gather ----------------- */

static tl_vec3 load_of(const tl_gridpoints *p, size_t row)
{
    return p->load[0] ? tl_columns_get(p->load, row) : tl_v3(0, 0, 0);
}

static void gather_point(const tl_model *m, size_t row, double share)
{
    struct tl_zones *z = m->zones;
    tl_gridpoints *p = &z->points;
    tl_vec3 force = {0, 0, 0};
    double square = 0;
    for (uint32_t k = z->use_start[row]; k < z->use_start[row + 1]; k++) {
        const tl_slot *slot = &z->slot[z->use[k]];
        force = tl_v3_add(force, tl_v3(slot->of[0], slot->of[1], slot->of[2]));
        square += slot->of[3];
    }
    double touched = 0;
    if (m->segments)
        tl_segments_gather(m, (uint32_t)row, &force, &touched);
    force = tl_v3_madd(force, share * p->mass[row], m->config.gravity);
    tl_columns_put(p->force, row, tl_v3_madd(force, share, load_of(p, row)));
    p->bears[row] = sqrt((double)p->zones[row] * square) + touched;
}

/* What is summed of a chunk: a number for each row of lanes. */
typedef struct addends {
    double number[TL_SUM_COUNT][CHUNK / TL_LANES];
} addends;

/* Unbalanced force of a gridpoint, by itself and over what it bears. */
static void note_ratio(const tl_model *m, size_t row, size_t at, double gravity, uint32_t body, addends *of,
                       tl_gathered *all)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 force = tl_free_part(tl_columns_get(p->force, row), p->fixed[row]), v = tl_columns_get(p->v, row);
    const double size = tl_v3_norm(force), weight = p->mass[row] * gravity + tl_v3_norm(load_of(p, row));
    const double bears = tl_larger(p->bears[row], weight), ratio = bears > 0 ? size / bears : size > 0;
    of->number[TL_SUM_UNBALANCED][at] += size;
    of->number[TL_SUM_CONTACT_FORCE][at] += bears;
    all->largest = tl_larger(all->largest, size);
    all->max_speed2 = tl_larger(all->max_speed2, tl_v3_norm2(v));
    all->local = tl_larger(all->local, ratio);
    all->bodies++;
    if (ratio > all->worst_ratio || (ratio == all->worst_ratio && body < all->worst)) {
        all->worst_ratio = ratio;
        all->worst = body;
    }
}

/* Kinetic energy and power, for what asks for totals. */
static void note_totals(const tl_model *m, size_t row, size_t at, addends *of)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 v = tl_columns_get(p->v, row), force = tl_columns_get(p->force, row);
    const double mass = p->mass[row];
    of->number[TL_SUM_KINETIC][at] += 0.5 * mass * tl_v3_norm2(v);
    of->number[TL_SUM_DAMPED][at] += 0.5 * mass * tl_v3_norm2(tl_free_part(v, p->fixed[row]));
    of->number[TL_SUM_POWER][at] += tl_v3_dot(tl_free_part(force, p->fixed[row]), v);
}

static void gather_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    const double share = tl_loads_share(m);
    for (size_t row = begin; row < end; row++)
        gather_point(m, row, share);
}

static void sum_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const tl_model *m = user;
    const struct tl_zones *z = m->zones;
    const bool totals = m->relaxing || (m->damping && ((const tl_damping_ops *)m->damping->ops)->begin);
    const double gravity = tl_v3_norm(m->config.gravity);
    tl_gathered *all = &m->cycle->gathered[thread];
    addends of;
    memset(&of, 0, sizeof of);
    for (size_t row = begin; row < end; row++) {
        const size_t at = (row - begin) / TL_LANES;
        if (z->points.fixed[row] == ALL)
            continue;
        note_ratio(m, row, at, gravity, z->mesh[z->points.mesh[row]].row, &of, all);
        if (totals)
            note_totals(m, row, at, &of);
    }
    tl_exact_add_each(all->sum, totals ? TL_SUM_COUNT : TL_SUM_KINETIC, of.number[0], CHUNK / TL_LANES,
                      (end - begin) / TL_LANES);
}

void tl_gridpoints_gather(tl_model *m)
{
    if (!tl_model_deforms(m))
        return;
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, gather_range, m);
    tl_carriers_push(m);
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, sum_range, m);
}

/* ---------------------------------------------------------------- motion ----------------- */

void tl_gridpoints_brake(tl_model *m, double alpha)
{
    tl_gridpoints *p = m->zones ? &m->zones->points : NULL;
    for (size_t row = 0; p && row < p->table.rows; row++) {
        p->alpha[row] = alpha;
        tl_columns_put(p->damping, row, tl_v3(0, 0, 0));
    }
}

typedef struct move_job {
    tl_model *m;
    double kick, drift;
} move_job;

/* What makes a gridpoint faster: its free forces, and what slows it. */
typedef struct push {
    tl_vec3 force, damping;
    double mass, alpha; /* mass as the step moves it */
} push;

static push push_of(const tl_model *m, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    const unsigned fixed = p->fixed[row];
    push out = {
        tl_free_part(tl_columns_get(p->force, row), fixed), {0, 0, 0}, p->mass[row] * tl_gridpoint_scale(m, row), 0};
    if (tl_is_damped(m) && p->alpha) {
        out.damping = tl_free_part(tl_columns_get(p->damping, row), fixed);
        out.alpha = p->alpha[row];
    }
    if (tl_loads_lag(m)) {
        const tl_vec3 lag = tl_v3_sub(tl_v3_scale(tl_loads_share(m), m->config.gravity), m->cycle->gravity);
        out.force = tl_v3_sub(out.force, tl_free_part(tl_v3_scale(p->mass[row], lag), fixed));
    }
    return out;
}

/* The velocity after the kick: that of held components stays. */
static tl_vec3 kicked(const tl_model *m, size_t row, const push *by, double kick)
{
    const tl_gridpoints *p = &m->zones->points;
    const unsigned fixed = p->fixed[row];
    const tl_vec3 v0 = tl_columns_get(p->v, row);
    const tl_vec3 v1 = tl_kick(v0, tl_v3_add(by->force, by->damping), kick / by->mass, by->alpha, kick);
    return tl_v3_add(tl_v3_sub(v0, tl_free_part(v0, fixed)), tl_free_part(v1, fixed));
}

tl_vec3 tl_gridpoint_to_come(const tl_model *m, size_t row, double dt)
{
    const push by = push_of(m, row);
    return kicked(m, row, &by, 0.5 * (m->dt + dt));
}

/* What is booked of a chunk (energy.c): a number for each row of lanes. */
typedef struct chunk_work {
    double book[TL_BOOK_COUNT][CHUNK / TL_LANES];
    double until, after; /* half of the step before and of the one after */
} chunk_work;

static void book_work(chunk_work *work, size_t at, tl_work_kind kind, tl_vec3 force, tl_vec3 moved, tl_vec3 v1)
{
    work->book[TL_BOOK_UNTIL(kind)][at] += work->until * tl_v3_dot(force, moved);
    work->book[TL_BOOK_AFTER(kind)][at] += work->after * tl_v3_dot(force, v1);
}

/* As motion.c books a body. */
static void book_point(const tl_model *m, size_t row, size_t at, const push *by, tl_vec3 v1, chunk_work *work)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 v0 = tl_columns_get(p->v, row), moved = tl_columns_get(p->moved, row), dv = tl_v3_sub(v1, v0);
    const double mass = p->mass[row], share = work->until / (work->until + work->after), dv2 = tl_v3_norm2(dv);
    const tl_vec3 v = tl_v3_madd(v0, share, dv), held = tl_columns_get(p->force, row);
    work->book[TL_BOOK_KINETIC][at] += 0.5 * mass * (tl_v3_norm2(v) - share * (1 - share) * dv2);
    work->book[TL_BOOK_FIRST][at] += 0.5 * mass * dv2;
    work->book[TL_BOOK_MOTION0][at] += 0.5 * mass * tl_v3_norm2(v0);
    work->book[TL_BOOK_MOTION2][at] += 0.5 * mass * tl_v3_norm2(v1);
    work->book[TL_BOOK_UNTIL(TL_WORK_EXTERNAL)][at] += share * mass * tl_v3_dot(tl_v3_sub(v0, moved), dv);
    book_work(work, at, TL_WORK_GRAVITY, tl_v3_scale(mass, m->cycle->gravity), moved, v1);
    book_work(work, at, TL_WORK_EXTERNAL, load_of(p, row), moved, v1);
    book_work(work, at, TL_WORK_EXTERNAL, tl_v3_sub(tl_free_part(held, p->fixed[row]), held), moved, v1);
    if (!tl_is_damped(m))
        return;
    const tl_vec3 slowed = tl_free_part(tl_v3_add(v0, v1), p->fixed[row]);
    book_work(work, at, TL_WORK_DAMPING, tl_v3_madd(by->damping, -0.5 * by->alpha * by->mass, slowed), moved, v1);
}

static void move_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const move_job *job = user;
    tl_model *m = job->m;
    tl_gridpoints *p = &m->zones->points;
    chunk_work work;
    memset(&work, 0, sizeof work);
    work.until = 0.5 * m->dt;
    work.after = 0.5 * job->drift;
    for (size_t row = begin; row < end; row++) {
        const push by = push_of(m, row);
        const tl_vec3 v1 = kicked(m, row, &by, job->kick);
        book_point(m, row, (row - begin) / TL_LANES, &by, v1, &work);
        tl_columns_put(p->v, row, v1);
        tl_columns_put(p->moved, row, v1);
        tl_columns_put(p->u, row, tl_v3_madd(tl_columns_get(p->u, row), job->drift, v1));
    }
    tl_exact_add_each(m->cycle->booked[thread].sum, TL_BOOK_COUNT, work.book[0], CHUNK / TL_LANES,
                      (end - begin) / TL_LANES);
}

void tl_gridpoints_move(tl_model *m, double dt)
{
    move_job job = {m, 0.5 * (m->dt + dt), dt};
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, move_range, &job);
    m->zones->steps_kept -= m->zones->steps_kept > 0;
}
