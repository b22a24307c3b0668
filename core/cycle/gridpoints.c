/* gridpoints.c - gridpoints of zones in a step: their forces, motion and rest.
 *
 * A gridpoint is a point of mass m. Its zones, contacts, weight and load push it, and it moves by central differences
 * as bodies do: v <- (D1 v + F/m h) D2, x <- x + v dt. Components that are held keep the velocity they were given.
 *
 * Rest asks of a gridpoint what it asks of a body (rest.c), with B = sqrt(n sum f^2) for the n forces of its zones.
 *
 * Rows of a mesh are padded to whole lanes, so lanes add up in one order, whoever takes them. */
#include "cycle/gridpoints.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "base/lanes.h"
#include "cycle/contact_beta.h"
#include "cycle/gridpoint.h"
#include "cycle/held_gridpoints.h"
#include "cycle/meshes.h"
#include "element/act.h"
#include "segment/act.h"
#include "segment/carriers.h"
#include "segment/gather.h"
#include "zone/outer.h"
#include "zone/stiffness.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Rows that a thread takes at a time: a multiple of TL_LANES. */
#define CHUNK 256

/* ---------------------------------------------------------------- step ------------------- */

/* The stiffness that contacts alone would need to ask for as short a step as a stiffness k and a damping c together.
 * Their own beta is in c. Let w^2 = k/m and b = c/(2 m). The longest stable step is 2/w (sqrt(1 + l^2) - l) with
 * l = b/w. It is 2/s with s = b + sqrt(w^2 + b^2). With contacts alone it solves k (dt^2 + 2 beta dt) = 4 m. */
static double damped(double k, double c, double mass, double beta)
{
    if (!(c > 0) && !(beta > 0))
        return k;
    const double b = c / (2 * mass), s = b + sqrt(k / mass + b * b);
    return mass * s * s / (1 + beta * s);
}

/* What holds each gridpoint: zones and, no less than the floor, segments and carriers. With that, what rounding of its
 * place would bring; before, that column has what damps it. With mass scaling zones and elements count as damped, too:
 * how stiff that is does not depend on the step then. */
static void find_holds(tl_model *m)
{
    tl_gridpoints *p = &m->zones->points;
    const double beta = tl_mass_scaled(m) ? 0 : tl_contact_beta(m);
    for (size_t row = 0; row < p->table.rows; row++)
        p->holds[row] = p->rounded[row] = 0;
    tl_segments_stiffen(m);
    tl_carriers_stiffen(m);
    for (size_t row = 0; row < p->table.rows; row++)
        p->rounded[row] = beta * p->holds[row];
    tl_elements_stiffen(m, p->rounded);
    for (size_t row = 0; row < p->table.rows; row++) {
        const double held = tl_larger(p->holds[row], p->floor[row]), stiffness = p->stiffness[row] + held;
        const double damping = p->rounded[row] + beta * (held - p->holds[row]);
        p->rounded[row] = tl_least_borne(&m->bodies, m->zones->mesh[p->mesh[row]].row, stiffness);
        p->holds[row] = damped(stiffness, damping, p->mass[row], beta);
    }
}

double tl_gridpoints_least(tl_model *m)
{
    if (!tl_model_deforms(m))
        return INFINITY;
    struct tl_zones *z = m->zones;
    const bool carried = m->detect && m->detect->contacts.carrier[0];
    if (tl_zones_stiffen(m) || carried || (m->segments && m->segments->version != z->segments_rated) ||
        (m->elements && m->elements->version != z->elements_rated)) {
        find_holds(m);
        z->segments_rated = m->segments ? m->segments->version : 0;
        z->elements_rated = m->elements ? m->elements->version : 0;
        tl_zones_rate(m);
    }
    const double rate = tl_scales_all(m) ? z->lowest_rate : z->highest_rate;
    return rate > 0 ? 1 / rate : INFINITY;
}

/* ---------------------------------------------------------------- lanes ------------------ */

/* Columns of a chunk that are the same in most models. */
static const double none[CHUNK];

/* Of rows that nothing holds: 1 in each component. */
typedef struct free_parts {
    _Alignas(TL_ALIGN) double of[3][CHUNK];
} free_parts;

/* 1 for each component that a gridpoint may move along, else 0. Mostly nothing of a chunk is held. */
TL_VECTORIZED static void find_free(const uint8_t *fixed, size_t count, free_parts *out)
{
    unsigned held = 0;
    for (size_t i = 0; i < count; i++)
        held |= fixed[i];
    for (int c = 0; c < 3; c++) {
        const unsigned bit = (unsigned)TL_FIX_X << c;
        if ((held & bit) == 0)
            for (size_t i = 0; i < count; i++)
                out->of[c][i] = 1;
        else
            for (size_t i = 0; i < count; i++)
                out->of[c][i] = (fixed[i] & bit) != 0 ? 0 : 1;
    }
}

/* What a component is where it is free, else 0. */
TL_INLINE double if_free(double free, double x)
{
    return free > 0 ? x : 0;
}

/* ---------------------------------------------------------------- gather ----------------- */

/* What acts on the gridpoints of a chunk: sums over zones, of forces and of the squares of their sizes, and over
 * segments, of forces and of their sizes. */
typedef struct gathering {
    _Alignas(TL_ALIGN) double zones[4][CHUNK];
    double segments[4][CHUNK];
} gathering;

/* Adds up the slots of a row, in their order. */
TL_INLINE void sum_slots(const struct tl_zones *z, size_t row, double *restrict sum)
{
    tl_four all = {0, 0, 0, 0};
    for (uint32_t k = z->use_start[row]; k < z->use_start[row + 1]; k++)
        all += *(const tl_four *)z->slot[z->use[k]].of;
    *(tl_four *)sum = all;
}

/* Four rows of sums as columns. */
TL_INLINE void put_sums(double (*of)[4], double (*to)[CHUNK], size_t i)
{
    const double *const row[4] = {of[0], of[1], of[2], of[3]};
    tl_lanes_turn(row, to[0] + i, to[1] + i, to[2] + i, to[3] + i);
}

TL_VECTORIZED static void gather_sums(const struct tl_zones *z, const struct tl_segments *s, size_t begin, size_t count,
                                      gathering *to)
{
    for (size_t i = 0; i < count; i += 4) {
        _Alignas(TL_ALIGN) double zones[4][4];
        for (size_t l = 0; l < 4; l++)
            sum_slots(z, begin + i + l, zones[l]);
        put_sums(zones, to->zones, i);
    }
    for (size_t i = 0; i < count && s; i += 4) {
        _Alignas(TL_ALIGN) double segments[4][4];
        for (size_t l = 0; l < 4; l++)
            tl_segments_gather(s, begin + i + l, segments[l]);
        put_sums(segments, to->segments, i);
    }
    for (int c = 0; c < 4 && !s; c++)
        memset(to->segments[c], 0, count * sizeof to->segments[c][0]);
}

/* Forces and what they are compared with. `pull`: what gravity gives a mass, m/s2. `share`: of the loads. */
TL_VECTORIZED static void end_gather(const tl_gridpoints *p, size_t begin, size_t count, const gathering *of,
                                     tl_vec3 pull, double share)
{
    const double *restrict mass = p->mass + begin, by[3] = {pull.x, pull.y, pull.z};
    const uint32_t *restrict zones = p->zones + begin;
    double *restrict bears = p->bears + begin, *restrict touched = p->touched + begin;
    for (int c = 0; c < 3; c++) {
        const double *restrict load = p->load[0] ? p->load[c] + begin : none;
        double *restrict force = p->force[c] + begin;
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            force[i] = (of->zones[c][i] + of->segments[c][i]) + mass[i] * by[c] + share * load[i];
    }
#pragma omp simd
    for (size_t i = 0; i < count; i++) {
        touched[i] = of->segments[3][i];
        bears[i] = sqrt((double)(int32_t)zones[i] * of->zones[3][i]) + touched[i];
    }
}

static void gather_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    const double share = tl_loads_share(m);
    const tl_vec3 pull = tl_v3_scale(share, m->config.gravity);
    gathering of;
    gather_sums(m->zones, m->segments, begin, end - begin, &of);
    end_gather(&m->zones->points, begin, end - begin, &of, pull, share);
}

/* What is summed of a chunk: lane by lane. `ratio`: of each row that may move, else -1. */
typedef struct addends {
    _Alignas(TL_ALIGN) double number[TL_SUM_COUNT][TL_LANES];
    double largest[TL_LANES], speed2[TL_LANES], most[TL_LANES], movable[TL_LANES];
    double ratio[CHUNK];
} addends;

TL_INLINE double size2_of(double x, double y, double z)
{
    return x * x + y * y + z * z;
}

/* The larger of each. One choice a loop: of several, one after the other, compilers make branches. */
TL_INLINE void take_larger(double to[TL_LANES], const double *of)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++)
        to[l] = tl_larger(of[l], to[l]);
}

/* Unbalanced forces, by themselves and over what the gridpoints bear. What is largest is kept on the stack: compilers
 * store there unasked, so they choose without branches. */
TL_VECTORIZED static void note_ratios(const tl_gridpoints *p, const free_parts *free, size_t begin, size_t count,
                                      double gravity, addends *restrict of)
{
    const double *restrict force[3] = {p->force[0] + begin, p->force[1] + begin, p->force[2] + begin};
    const double *restrict v[3] = {p->v[0] + begin, p->v[1] + begin, p->v[2] + begin};
    const double *restrict mass = p->mass + begin, *restrict borne = p->bears + begin;
    const double *restrict rounded = p->rounded + begin, *load[3];
    for (int c = 0; c < 3; c++)
        load[c] = p->load[0] ? p->load[c] + begin : none;
    double largest[TL_LANES] = {0}, fastest2[TL_LANES] = {0}, most[TL_LANES];
    double size[TL_LANES], bears[TL_LANES], moves[TL_LANES], speed2[TL_LANES], over[TL_LANES];
    for (size_t l = 0; l < TL_LANES; l++)
        most[l] = -1;
    for (size_t first = 0; first < count; first += TL_LANES) {
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = first + l;
            const double x = free->of[0][i], y = free->of[1][i], z = free->of[2][i];
            const double fx = x * force[0][i], fy = y * force[1][i], fz = z * force[2][i];
            const double may = 1 - (1 - x) * (1 - y) * (1 - z);
            size[l] = sqrt(size2_of(fx, fy, fz));
            moves[l] = may;
            speed2[l] = may * size2_of(v[0][i], v[1][i], v[2][i]);
            bears[l] = mass[i] * gravity + sqrt(size2_of(load[0][i], load[1][i], load[2][i]));
        }
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++)
            over[l] = size[l] > 0 ? size[l] : 1; /* of what bears nothing */
        take_larger(bears, borne + first);
        take_larger(bears, rounded + first);
        take_larger(largest, size);
        take_larger(fastest2, speed2);
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            over[l] = bears[l] > 0 ? bears[l] : over[l];
            of->number[TL_SUM_UNBALANCED][l] += size[l];
            of->number[TL_SUM_CONTACT_FORCE][l] += moves[l] * bears[l];
            of->movable[l] += moves[l];
            of->ratio[first + l] = moves[l] * (size[l] / over[l]) + (moves[l] - 1);
        }
        take_larger(most, of->ratio + first);
    }
    tl_lanes_load(of->largest, largest);
    tl_lanes_load(of->speed2, fastest2);
    tl_lanes_load(of->most, most);
}

/* The mass of a chunk that energies count, kg: of its own or, with inertia added, what is in `scaled`. */
static const double *counted_mass(const tl_model *m, size_t begin, size_t count, double scaled[CHUNK])
{
    for (size_t i = 0; i < count && m->cycle->adds; i++)
        scaled[i] = m->zones->points.mass[begin + i] * tl_gridpoint_energy_scale(m, begin + i);
    return m->cycle->adds ? scaled : m->zones->points.mass + begin;
}

/* Kinetic energy and power, for what asks for totals. */
TL_VECTORIZED static void note_totals(const tl_gridpoints *p, const free_parts *free, size_t begin, size_t count,
                                      const double *mass, addends *of)
{
    for (size_t first = 0; first < count; first += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = first + l, row = begin + i;
            const double half = free->of[0][i] + free->of[1][i] + free->of[2][i] > 0 ? 0.5 * mass[i] : 0;
            const double x = p->v[0][row], y = p->v[1][row], z = p->v[2][row];
            const double vx = if_free(free->of[0][i], x), vy = if_free(free->of[1][i], y);
            const double vz = if_free(free->of[2][i], z);
            of->number[TL_SUM_KINETIC][l] += half * size2_of(x, y, z);
            of->number[TL_SUM_DAMPED][l] += half * size2_of(vx, vy, vz);
            of->number[TL_SUM_POWER][l] += p->force[0][row] * vx + p->force[1][row] * vy + p->force[2][row] * vz;
        }
}

/* The largest ratio of a chunk, and the first body that has it, where no other chunk has a larger one. */
static void note_worst(const struct tl_zones *z, size_t begin, size_t count, const addends *of, tl_gathered *all)
{
    double most = -1;
    for (size_t l = 0; l < TL_LANES; l++) {
        all->largest = tl_larger(all->largest, of->largest[l]);
        all->max_speed2 = tl_larger(all->max_speed2, of->speed2[l]);
        all->bodies += (size_t)of->movable[l];
        most = tl_larger(most, of->most[l]);
    }
    all->local = tl_larger(all->local, most);
    if (most < 0 || most < all->worst_ratio)
        return;
    uint32_t worst = TL_NO_ROW;
    for (size_t i = 0; i < count; i++) {
        const uint32_t body = z->mesh[z->points.mesh[begin + i]].row;
        worst = of->ratio[i] == most && body < worst ? body : worst;
    }
    if (most > all->worst_ratio || worst < all->worst) {
        all->worst_ratio = most;
        all->worst = worst;
    }
}

static void sum_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const tl_model *m = user;
    const struct tl_zones *z = m->zones;
    const bool totals = m->relaxing || (m->damping && ((const tl_damping_ops *)m->damping->ops)->begin);
    tl_gathered *all = &m->cycle->gathered[thread];
    free_parts free;
    addends of;
    memset(&of, 0, offsetof(addends, ratio));
    find_free(z->points.fixed + begin, end - begin, &free);
    note_ratios(&z->points, &free, begin, end - begin, tl_v3_norm(m->config.gravity), &of);
    if (totals) {
        double scaled[CHUNK];
        note_totals(&z->points, &free, begin, end - begin, counted_mass(m, begin, end - begin, scaled), &of);
    }
    if (m->relaxing) /* of meshes as a whole: tl_meshes_judge */
        memset(of.number[TL_SUM_POWER], 0, sizeof of.number[TL_SUM_POWER]);
    note_worst(z, begin, end - begin, &of, all);
    tl_exact_add_each(all->sum, totals ? TL_SUM_COUNT : TL_SUM_KINETIC, of.number[0], TL_LANES, TL_LANES);
}

void tl_gridpoints_gather(tl_model *m)
{
    if (!tl_model_deforms(m))
        return;
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, gather_range, m);
    tl_carriers_push(m);
    tl_elements_push(m);
    tl_outer_push(m, tl_loads_share(m));
    if (m->relaxing)
        tl_meshes_judge(m);
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, sum_range, m);
}

/* ---------------------------------------------------------------- motion ----------------- */

/* Takes the velocities of a mesh back; `whole`: down to those of its motion as a whole. */
static void brake_mesh(tl_model *m, const tl_body_mesh *mesh, const tl_mesh_motion *whole, double alpha, double kick)
{
    tl_gridpoints *p = &m->zones->points;
    const tl_vec3 centre = tl_body_place(&m->bodies, mesh->row);
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        tl_vec3 damping = {0, 0, 0};
        if (whole) {
            const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
            const tl_vec3 v = tl_v3_add(whole->velocity, tl_v3_cross(whole->turn, arm));
            damping = tl_v3_scale(2 * p->mass[row] * tl_gridpoint_scale(m, row) / kick, v);
        }
        p->alpha[row] = alpha;
        tl_columns_put(p->damping, row, damping);
    }
}

void tl_gridpoints_brake(tl_model *m, bool stop, double lost, double kick)
{
    struct tl_zones *z = m->zones;
    for (size_t k = 0; z && k < z->mesh_count; k++) {
        const tl_mesh_motion *of = &z->motion[k];
        const bool ends = of->loose ? of->power < 0 : stop && !of->goes_on, calms = stop || of->strain_power < 0;
        brake_mesh(m, &z->mesh[k], ends || !calms ? NULL : of, ends || calms ? lost : 0, kick);
    }
}

void tl_gridpoints_stop(tl_model *m)
{
    tl_gridpoints *p = m->zones ? &m->zones->points : NULL;
    for (size_t row = 0; p && row < p->table.rows; row++) {
        const tl_vec3 v = tl_columns_get(p->v, row);
        tl_columns_put(p->v, row, tl_v3_sub(v, tl_free_part(v, p->fixed[row])));
    }
}

typedef struct move_job {
    tl_model *m;
    double kick, drift;
    double until, after; /* half of the step before and of the one after */
} move_job;

/* What moves the gridpoints of a chunk beside their forces: columns. */
typedef struct movers {
    const double *mass, *counted;           /* as the step moves it, and as energies count it, kg */
    const double *damping[3], *alpha;       /* N, 1/s */
    const double *load[3];                  /* N */
    tl_vec3 gravity, lag;                   /* m/s2: what is booked, and by how much forces have more */
    _Alignas(TL_ALIGN) double v0[3][CHUNK]; /* velocity before */
    double scaled[CHUNK];
} movers;

/* What is booked of a chunk (energy.c): lane by lane. */
typedef struct chunk_work {
    _Alignas(TL_ALIGN) double book[TL_BOOK_COUNT][TL_LANES];
} chunk_work;

static void find_movers(const tl_model *m, size_t begin, size_t count, movers *out)
{
    const tl_gridpoints *p = &m->zones->points;
    const bool damped = tl_is_damped(m) && p->alpha, scales = tl_inertia_scaled(m->cycle);
    for (size_t i = 0; i < count && scales; i++)
        out->scaled[i] = p->mass[begin + i] * tl_gridpoint_scale(m, begin + i);
    out->mass = scales ? out->scaled : p->mass + begin;
    out->counted = m->cycle->adds ? out->scaled : p->mass + begin;
    out->alpha = damped ? p->alpha + begin : none;
    for (int c = 0; c < 3; c++) {
        out->damping[c] = damped ? p->damping[c] + begin : none;
        out->load[c] = p->load[0] ? p->load[c] + begin : none;
    }
    out->gravity = m->cycle->gravity;
    out->lag = tl_v3(0, 0, 0);
    if (tl_loads_lag(m))
        out->lag = tl_v3_sub(tl_v3_scale(tl_loads_share(m), m->config.gravity), m->cycle->gravity);
}

/* A component of the velocity after a kick; `more`: m/s2 by which the force has more than its share. */
TL_INLINE double kicked(double v, double force, double mass, double more, double damping, double moving, double alpha,
                        double kick)
{
    const double f = (force - mass * more) + damping, slow = 0.5 * alpha * kick;
    return ((1 - slow) * v + kick / moving * f) * (1 / (1 + slow));
}

/* Kicks velocities: those of held components stay. Then places follow. */
TL_VECTORIZED static void move_chunk(const tl_gridpoints *p, const free_parts *free, size_t begin, size_t count,
                                     const move_job *job, movers *by)
{
    const double lag[3] = {by->lag.x, by->lag.y, by->lag.z}, kick = job->kick, drift = job->drift;
    const double *restrict mass = p->mass + begin, *restrict moving = by->mass, *restrict alpha = by->alpha;
    for (int c = 0; c < 3; c++) {
        double *restrict v = p->v[c] + begin, *restrict u = p->u[c] + begin, *restrict v0 = by->v0[c];
        const double *restrict force = p->force[c] + begin, *restrict damping = by->damping[c];
        const double *restrict may = free->of[c];
        const double more = lag[c];
#pragma omp simd
        for (size_t i = 0; i < count; i++) {
            const double v1 = kicked(v[i], force[i], mass[i], more, damping[i], moving[i], alpha[i], kick);
            v0[i] = v[i];
            v[i] = may[i] > 0 ? v1 : v[i];
            u[i] += drift * v[i];
        }
    }
}

tl_vec3 tl_gridpoint_to_come(const tl_model *m, size_t row, double dt)
{
    const tl_gridpoints *p = &m->zones->points;
    const double kick = 0.5 * (m->dt + dt), moving = p->mass[row] * tl_gridpoint_scale(m, row);
    const bool damped = tl_is_damped(m) && p->alpha;
    tl_vec3 lag = {0, 0, 0};
    if (tl_loads_lag(m))
        lag = tl_v3_sub(tl_v3_scale(tl_loads_share(m), m->config.gravity), m->cycle->gravity);
    const double more[3] = {lag.x, lag.y, lag.z};
    double v[3];
    for (int c = 0; c < 3; c++) {
        const double damping = damped ? p->damping[c][row] : 0, alpha = damped ? p->alpha[row] : 0;
        v[c] = p->v[c][row];
        if (!(p->fixed[row] & TL_FIX_X << c))
            v[c] = kicked(v[c], p->force[c][row], p->mass[row], more[c], damping, moving, alpha, kick);
    }
    return (tl_vec3){v[0], v[1], v[2]};
}

TL_INLINE double dot_of(tl_vec3 a, tl_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* As motion.c books a body. Then the last motion is this one. */
TL_VECTORIZED static void book_chunk(const tl_gridpoints *p, const free_parts *free, size_t begin, size_t count,
                                     const move_job *job, const movers *by, chunk_work *work)
{
    const double until = job->until, after = job->after, share = until / (until + after);
    double(*restrict book)[TL_LANES] = work->book;
    double *restrict mx = p->moved[0] + begin, *restrict my = p->moved[1] + begin, *restrict mz = p->moved[2] + begin;
    const double *restrict x = p->v[0] + begin, *restrict y = p->v[1] + begin, *restrict z = p->v[2] + begin;
    const double *restrict fx = p->force[0] + begin, *restrict fy = p->force[1] + begin;
    const double *restrict fz = p->force[2] + begin, *restrict mass = p->mass + begin, *restrict counted = by->counted;
    const double *restrict load[3] = {by->load[0], by->load[1], by->load[2]};
    for (size_t first = 0; first < count; first += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = first + l;
            const tl_vec3 v0 = {by->v0[0][i], by->v0[1][i], by->v0[2][i]}, v1 = {x[i], y[i], z[i]};
            const tl_vec3 moved = {mx[i], my[i], mz[i]}, dv = tl_v3_sub(v1, v0), v = tl_v3_madd(v0, share, dv);
            const double own = counted[i], half = 0.5 * own, dv2 = dot_of(dv, dv);
            const tl_vec3 outside = {load[0][i] - (1 - free->of[0][i]) * fx[i],
                                     load[1][i] - (1 - free->of[1][i]) * fy[i],
                                     load[2][i] - (1 - free->of[2][i]) * fz[i]};
            const tl_vec3 weight = tl_v3_scale(mass[i], by->gravity);
            book[TL_BOOK_KINETIC][l] += half * (dot_of(v, v) - share * (1 - share) * dv2);
            book[TL_BOOK_FIRST][l] += half * dv2;
            book[TL_BOOK_MOTION0][l] += half * dot_of(v0, v0);
            book[TL_BOOK_MOTION2][l] += half * dot_of(v1, v1);
            book[TL_BOOK_UNTIL(TL_WORK_GRAVITY)][l] += until * dot_of(weight, moved);
            book[TL_BOOK_AFTER(TL_WORK_GRAVITY)][l] += after * dot_of(weight, v1);
            book[TL_BOOK_UNTIL(TL_WORK_EXTERNAL)][l] +=
                until * dot_of(outside, moved) + share * own * dot_of(tl_v3_sub(v0, moved), dv);
            book[TL_BOOK_AFTER(TL_WORK_EXTERNAL)][l] += after * dot_of(outside, v1);
            mx[i] = v1.x, my[i] = v1.y, mz[i] = v1.z;
        }
}

/* What damping has taken, before the last motion becomes this one. */
TL_VECTORIZED static void book_damping(const tl_gridpoints *p, const free_parts *free, size_t begin, size_t count,
                                       const move_job *job, const movers *by, chunk_work *work)
{
    for (int c = 0; c < 3; c++)
        for (size_t first = 0; first < count; first += TL_LANES)
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++) {
                const size_t i = first + l, row = begin + i;
                const double slowed = by->v0[c][i] + p->v[c][row];
                const double force =
                    if_free(free->of[c][i], by->damping[c][i] - 0.5 * by->alpha[i] * by->mass[i] * slowed);
                work->book[TL_BOOK_UNTIL(TL_WORK_DAMPING)][l] += job->until * force * p->moved[c][row];
                work->book[TL_BOOK_AFTER(TL_WORK_DAMPING)][l] += job->after * force * p->v[c][row];
            }
}

/* Mends gridpoints that more than axes hold, and books what pushes them at the surface. */
static void mend_chunk(const move_job *job, size_t begin, size_t count, const movers *by, chunk_work *work)
{
    for (size_t i = 0; i < count; i++) {
        const tl_point_moved moved = {.v0 = {by->v0[0][i], by->v0[1][i], by->v0[2][i]},
                                      .mass = by->mass[i],
                                      .alpha = by->alpha[i],
                                      .kick = job->kick,
                                      .drift = job->drift,
                                      .until = job->until,
                                      .after = job->after};
        tl_gridpoint_mend(job->m, begin + i, &moved, i % TL_LANES, work->book);
    }
}

static void move_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const move_job *job = user;
    const tl_gridpoints *p = &job->m->zones->points;
    const size_t count = end - begin;
    free_parts free;
    movers by;
    chunk_work work;
    memset(&work, 0, sizeof work);
    find_free(p->fixed + begin, count, &free);
    find_movers(job->m, begin, count, &by);
    move_chunk(p, &free, begin, count, job, &by);
    if (tl_gridpoints_mend(job->m))
        mend_chunk(job, begin, count, &by, &work);
    if (tl_is_damped(job->m))
        book_damping(p, &free, begin, count, job, &by, &work);
    book_chunk(p, &free, begin, count, job, &by, &work);
    tl_exact_add_each(job->m->cycle->booked[thread].sum, TL_BOOK_COUNT, work.book[0], TL_LANES, TL_LANES);
}

void tl_gridpoints_move(tl_model *m, double dt)
{
    move_job job = {m, 0.5 * (m->dt + dt), dt, 0.5 * m->dt, 0.5 * dt};
    tl_gridpoints_follow_drives(m, dt);
    tl_parallel_for(m->pool, m->zones->points.table.rows, CHUNK, move_range, &job);
    m->zones->moved_dt = dt;
    m->zones->steps_kept -= m->zones->steps_kept > 0;
}
