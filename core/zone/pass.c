/* pass.c - zones follow their gridpoints: strain, stress, forces.
 *
 * Let v be the velocity of the last motion and h its duration, x the present places and x' = x - v h / 2 those
 * half-way.
 * With the gradients g_a of the four shape functions and V the volume, in a zone
 *
 *     L = h sum_a v_a (x) g_a(x'),    strain = sym L,    w = the axial vector of skew L
 *     Q = I + 2 / (1 + k.k) (K + K K),    k = w / 2,    K = k x                  (Hughes and Winget 1980)
 *
 * and in a cluster, with t = tr(strain) and T the mean of t by volume,
 *
 *     strain' = strain + (T - t) I / 3
 *     stress* = Q stress Q^T,    stress' = solid(stress*, strain'),    dp = tr(stress' - stress*) / 3
 *     stress = stress' + (P - dp) I,    P the mean of dp by volume
 *
 * so zones that keep their volume, or flow, do not lock (Marti and Cundall 1982; de Souza Neto et al. 2005). Increments
 * are averaged, so what differs from zone to zone before stays. A zone acts on corner a with
 *
 *     f_a = -V(x) stress g_a(x)
 *
 * the adjoint of its strain: work is V (stress* + stress) / 2 : strain'. The volume times a gradient is a vector area
 * over 3: no division. What the mean of dp changes is heat, V (P - dp)^2 / (2 K), beside what the solid tells.
 *
 * A zone whose volume is not positive, half-way or now, is turned inside out, and the step fails.
 *
 * A corner bears at the most sum |f| <= sqrt(n sum f^2) of n zones. That is what rest compares forces with: it needs no
 * root for each zone. */
#include "zone/pass.h"

#include "base/extremes.h"
#include "base/lanes.h"
#include "base/solid_columns.h"
#include "model/law_time.h"

#include <float.h>
#include <string.h>
#include <talus/number.h>

/* Rows of a SIMD group. */
#define ROWS (TL_CLUSTER_MOST * TL_LANES)
/* Zones of a row that a loop takes: half of them, so that what it needs stays in registers. */
#define FOUR ((size_t)4)

/* Constant: the least normal number, m3. A lane without a cluster has no volume: its sums, 0, are divided by this. */
#define LEAST_VOLUME DBL_MIN

/* What the rows of a group have. */
typedef struct group_rows {
    _Alignas(TL_ALIGN) double strain[6][ROWS]; /* increment */
    double trace[ROWS], met[ROWS];             /* of the turned stress: its trace, and its product with the strain */
    double area[3][3][ROWS];                   /* 6 V g_a at the present places, corners 1 to 3 */
    double spin[3][ROWS];                      /* half the turn of the step, rad */
    double middle[ROWS], volume[ROWS];         /* V half-way and now, m3; of an inert row 0 */
    double extent[ROWS], dissipated[ROWS];     /* m, and J/m3 */
} group_rows;

/* Sums over the zones of each cluster of a group, and what is the same for all its zones. */
typedef struct group_sums {
    _Alignas(TL_ALIGN) double change[TL_LANES]; /* of volume, m3; then its mean, 1 */
    double middle[TL_LANES];                    /* of volumes half-way, m3 */
    double strain2[TL_LANES];                   /* the square of the largest strain */
    double sound[TL_LANES];                     /* 1: no zone is turned inside out; else 0 */
    double zones[TL_LANES];                     /* how many */
} group_sums;

typedef struct pass_job {
    tl_model *m;
    struct tl_zones *zones;
    double dt;
    tl_failure *failure;
} pass_job;

/* ---------------------------------------------------------------- strain ----------------- */

/* Four zones of a row: places of corners 1 to 3, and half their ways in the last step, from corner 0. */
typedef struct row_edges {
    _Alignas(TL_ALIGN) double edge[3][3][FOUR];
    double half[3][3][FOUR];
} row_edges;

TL_INLINE void load_edges(const tl_gridpoint_now *p, uint16_t *const corner[4], size_t row, row_edges *restrict to)
{
    const uint16_t *from = corner[0] + row;
    for (size_t a = 1; a < 4; a++) {
        double(*edge)[FOUR] = to->edge[a - 1], (*half)[FOUR] = to->half[a - 1];
        tl_lanes_apart(p->place, corner[a] + row, from, edge[0], edge[1], edge[2]);
        tl_lanes_apart(p->way, corner[a] + row, from, half[0], half[1], half[2]);
    }
}

TL_INLINE tl_vec3 lane_of(double (*v)[FOUR], size_t l)
{
    return (tl_vec3){v[0][l], v[1][l], v[2][l]};
}

/* Q stress Q^T of one zone; k: half the turn. The trace stays, and without a turn every bit. */
TL_INLINE tl_sym3 turned(tl_sym3 s, tl_vec3 k)
{
    const double x = k.x, y = k.y, z = k.z, f = 2 / (1 + (x * x + y * y + z * z));
    const double fx = f * x, fy = f * y, fz = f * z, xx = fx * x, yy = fy * y, zz = fz * z;
    const double xy = fx * y, yz = fy * z, zx = fz * x;
    const tl_vec3 a = {1 - (yy + zz), xy - fz, zx + fy};
    const tl_vec3 b = {xy + fz, 1 - (xx + zz), yz - fx};
    const tl_vec3 c = {zx - fy, yz + fx, 1 - (xx + yy)};
    const tl_vec3 row_x = {s.xx, s.xy, s.zx}, row_y = {s.xy, s.yy, s.yz}, row_z = {s.zx, s.yz, s.zz};
    const tl_vec3 p = {tl_v3_dot(a, row_x), tl_v3_dot(a, row_y), tl_v3_dot(a, row_z)};
    const tl_vec3 q = {tl_v3_dot(b, row_x), tl_v3_dot(b, row_y), tl_v3_dot(b, row_z)};
    const double first = tl_v3_dot(p, a), second = tl_v3_dot(q, b);
    return (tl_sym3){.xx = first,
                     .yy = second,
                     .zz = s.zz + ((s.xx - first) + (s.yy - second)),
                     .xy = tl_v3_dot(p, b),
                     .yz = tl_v3_dot(q, c),
                     .zx = tl_v3_dot(p, c)};
}

/* Four zones of one row of a group, from lane `first` on: number k of their clusters. All of a zone in one go, so that
 * it stays in registers. */
TL_INLINE void strain_four(const struct tl_zones *z, const tl_gridpoint_now *p, const tl_zone_group *g, size_t k,
                           size_t first, group_rows *restrict r, group_sums *restrict all)
{
    const size_t at = TL_LANES * k + first;
    double *restrict change = all->change + first, *restrict middles = all->middle + first;
    double *restrict strain2 = all->strain2 + first, *restrict sound = all->sound + first;
    const double *restrict zones = all->zones + first, number = (double)k;
    row_edges c;
    load_edges(p, z->zones.corner, g->start + at, &c);
#pragma omp simd
    for (size_t l = 0; l < FOUR; l++) {
        const tl_vec3 e1 = lane_of(c.edge[0], l), e2 = lane_of(c.edge[1], l), e3 = lane_of(c.edge[2], l);
        const tl_vec3 h1 = lane_of(c.half[0], l), h2 = lane_of(c.half[1], l), h3 = lane_of(c.half[2], l);
        const tl_vec3 a1 = tl_v3_cross(e2, e3), a2 = tl_v3_cross(e3, e1), a3 = tl_v3_cross(e1, e2);
        r->area[0][0][at + l] = a1.x, r->area[0][1][at + l] = a1.y, r->area[0][2][at + l] = a1.z;
        r->area[1][0][at + l] = a2.x, r->area[1][1][at + l] = a2.y, r->area[1][2][at + l] = a2.z;
        r->area[2][0][at + l] = a3.x, r->area[2][1][at + l] = a3.y, r->area[2][2][at + l] = a3.z;
        const double six_now = tl_v3_dot(a1, e1);
        const double factor = number < zones[l] ? 1.0 / 6 : 0;
        r->volume[at + l] = factor * six_now;
        const tl_vec3 m1 = tl_v3_sub(e1, h1), m2 = tl_v3_sub(e2, h2), m3 = tl_v3_sub(e3, h3);
        const tl_vec3 b1 = tl_v3_cross(m2, m3), b2 = tl_v3_cross(m3, m1), b3 = tl_v3_cross(m1, m2);
        const double six = tl_v3_dot(b1, m1), per = 1 / six, twice = 2 * per, half = 0.5 * per, middle = factor * six;
        const double xx = twice * (h1.x * b1.x + h2.x * b2.x + h3.x * b3.x);
        const double yy = twice * (h1.y * b1.y + h2.y * b2.y + h3.y * b3.y);
        const double zz = twice * (h1.z * b1.z + h2.z * b2.z + h3.z * b3.z);
        const double dxy = h1.x * b1.y + h2.x * b2.y + h3.x * b3.y;
        const double dyx = h1.y * b1.x + h2.y * b2.x + h3.y * b3.x;
        const double dyz = h1.y * b1.z + h2.y * b2.z + h3.y * b3.z;
        const double dzy = h1.z * b1.y + h2.z * b2.y + h3.z * b3.y;
        const double dzx = h1.z * b1.x + h2.z * b2.x + h3.z * b3.x;
        const double dxz = h1.x * b1.z + h2.x * b2.z + h3.x * b3.z;
        const double xy = per * (dxy + dyx), yz = per * (dyz + dzy), zx = per * (dzx + dxz);
        const double square = xx * xx + yy * yy + zz * zz + 2 * (xy * xy + yz * yz + zx * zx);
        r->middle[at + l] = middle;
        r->strain[0][at + l] = xx, r->strain[1][at + l] = yy, r->strain[2][at + l] = zz;
        r->strain[3][at + l] = xy, r->strain[4][at + l] = yz, r->strain[5][at + l] = zx;
        change[l] += middle * (xx + yy + zz);
        middles[l] += middle;
        strain2[l] = square > strain2[l] ? square : strain2[l];
        sound[l] = ((six > 0) & (six_now > 0)) ? sound[l] : 0;
        const tl_vec3 spin = {half * (dzy - dyz), half * (dxz - dzx), half * (dyx - dxy)};
        r->spin[0][at + l] = spin.x, r->spin[1][at + l] = spin.y, r->spin[2][at + l] = spin.z;
    }
}

/* ---------------------------------------------------------------- clusters --------------- */

/* Whether no zone is turned inside out. Inert rows are copies of a zone of the group. */
TL_INLINE bool is_outside_out(const group_sums *sums)
{
    double all = 1;
    for (size_t l = 0; l < TL_LANES; l++)
        all *= sums->sound[l];
    return all > 0;
}

/* The mean change of volume of each cluster. */
TL_INLINE void mean_volume(group_sums *restrict sums)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++)
        sums->change[l] /= tl_larger(sums->middle[l], LEAST_VOLUME);
}

/* Zone k of each cluster gets the mean change of volume, and its stress turns. */
TL_INLINE void turn_row(const struct tl_zones *z, const tl_zone_group *g, size_t k, group_rows *restrict r,
                        const group_sums *restrict sums)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    double *const *s = z->zones.stress;
    double *restrict sxx = s[0] + row, *restrict syy = s[1] + row, *restrict szz = s[2] + row;
    double *restrict sxy = s[3] + row, *restrict syz = s[4] + row, *restrict szx = s[5] + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const size_t i = at + l;
        double xx = r->strain[0][i], yy = r->strain[1][i], zz = r->strain[2][i];
        const double more = (sums->change[l] - (xx + yy + zz)) * (1.0 / 3);
        const tl_sym3 was = {.xx = sxx[l], .yy = syy[l], .zz = szz[l], .xy = sxy[l], .yz = syz[l], .zx = szx[l]};
        const tl_sym3 now = turned(was, (tl_vec3){r->spin[0][i], r->spin[1][i], r->spin[2][i]});
        r->strain[0][i] = xx += more;
        r->strain[1][i] = yy += more;
        r->strain[2][i] = zz += more;
        r->trace[i] = now.xx + now.yy + now.zz;
        r->met[i] = now.xx * xx + now.yy * yy + now.zz * zz +
                    2 * (now.xy * r->strain[3][i] + now.yz * r->strain[4][i] + now.zx * r->strain[5][i]);
        sxx[l] = now.xx, syy[l] = now.yy, szz[l] = now.zz;
        sxy[l] = now.xy, syz[l] = now.yz, szx[l] = now.zx;
    }
}

/* What a group gives its parcel: the work of its stresses over the strain, J; heat that the solid made, J; and the sum
 * of V (P - dp)^2, twice the bulk modulus times what the mean of dp takes. */
typedef struct given {
    double work, heat, lost;
} given;

/* The mean change of mean stress of each cluster, times 3. */
TL_INLINE void mean_change(const group_rows *restrict r, double *const stress[6], size_t row, size_t depth,
                           double mean[TL_LANES])
{
    double sum[TL_LANES], all[TL_LANES];
    tl_lanes_clear(sum);
    tl_lanes_clear(all);
    const double *restrict xx = stress[0] + row, *restrict yy = stress[1] + row, *restrict zz = stress[2] + row;
    for (size_t i = 0; i < TL_LANES * depth; i += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const double change = (xx[i + l] + yy[i + l] + zz[i + l]) - r->trace[i + l];
            sum[l] += r->volume[i + l] * change;
            all[l] += r->volume[i + l];
        }
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++)
        mean[l] = sum[l] / tl_larger(all[l], LEAST_VOLUME);
}

/* ---------------------------------------------------------------- forces ----------------- */

/* What four zones do to a corner: three components and the square of the size. */
typedef struct push {
    _Alignas(TL_ALIGN) double of[4][FOUR];
} push;

/* A stress times a vector area: with the stress over -6 a force of a corner. */
TL_INLINE tl_vec3 force_of(tl_sym3 s, const double (*area)[ROWS], size_t i)
{
    const double x = area[0][i], y = area[1][i], z = area[2][i];
    return (tl_vec3){s.xx * x + s.xy * y + s.zx * z, s.xy * x + s.yy * y + s.yz * z, s.zx * x + s.yz * y + s.zz * z};
}

TL_INLINE void put_push(push *to, size_t l, tl_vec3 f)
{
    to->of[0][l] = f.x;
    to->of[1][l] = f.y;
    to->of[2][l] = f.z;
    to->of[3][l] = f.x * f.x + f.y * f.y + f.z * f.z;
}

/* Sums of each lane of what a group gives. */
typedef struct lane_sums {
    _Alignas(TL_ALIGN) double work[TL_LANES], heat[TL_LANES], lost[TL_LANES];
} lane_sums;

/* Adds the forces of four zones to the slots, corner by corner. */
TL_INLINE void add_pushes(uint16_t *const corner[4], size_t row, const push by[4], tl_slot *slots)
{
    for (size_t a = 0; a < 4; a++) {
        const uint16_t *at = corner[a] + row;
        double *const to[4] = {slots[at[0]].of, slots[at[1]].of, slots[at[2]].of, slots[at[3]].of};
        tl_lanes_add_rows(to, by[a].of[0], by[a].of[1], by[a].of[2], by[a].of[3]);
    }
}

/* Zone k of four clusters, from lane `first` on: its stress gets the mean change of the cluster. Its work, and its
 * forces on its corners. */
TL_INLINE void close_four(const struct tl_zones *z, const tl_zone_group *g, size_t k, size_t first,
                          const double *restrict mean, const group_rows *restrict r, lane_sums *restrict all,
                          tl_slot *slots)
{
    const size_t at = TL_LANES * k + first, row = g->start + at;
    double *const *s = z->zones.stress;
    double *restrict sxx = s[0] + row, *restrict syy = s[1] + row, *restrict szz = s[2] + row;
    const double *restrict sxy = s[3] + row, *restrict syz = s[4] + row, *restrict szx = s[5] + row;
    double *restrict work = all->work + first, *restrict heat = all->heat + first, *restrict lost = all->lost + first;
    push by[4];
#pragma omp simd
    for (size_t l = 0; l < FOUR; l++) {
        const size_t i = at + l;
        tl_sym3 t = {.xx = sxx[l], .yy = syy[l], .zz = szz[l], .xy = sxy[l], .yz = syz[l], .zx = szx[l]};
        const double more = (mean[first + l] - ((t.xx + t.yy + t.zz) - r->trace[i])) * (1.0 / 3);
        sxx[l] = t.xx += more;
        syy[l] = t.yy += more;
        szz[l] = t.zz += more;
        const double straight = t.xx * r->strain[0][i] + t.yy * r->strain[1][i] + t.zz * r->strain[2][i];
        const double shear = t.xy * r->strain[3][i] + t.yz * r->strain[4][i] + t.zx * r->strain[5][i];
        work[l] += r->middle[i] * (r->met[i] + (straight + 2 * shear));
        heat[l] += r->volume[i] * r->dissipated[i];
        lost[l] += r->volume[i] * (more * more);
        t = tl_s3_scale(r->volume[i] > 0 ? -1.0 / 6 : 0, t); /* inert rows push nothing */
        const tl_vec3 f1 = force_of(t, r->area[0], i), f2 = force_of(t, r->area[1], i);
        const tl_vec3 f3 = force_of(t, r->area[2], i);
        put_push(&by[0], l, tl_v3_neg(tl_v3_add(tl_v3_add(f1, f2), f3)));
        put_push(&by[1], l, f1);
        put_push(&by[2], l, f2);
        put_push(&by[3], l, f3);
    }
    add_pushes(z->zones.corner, row, by, slots);
}

/* ---------------------------------------------------------------- groups and parcels ----- */

/* false: a zone is turned inside out. `most`: the square of the largest strain. */
TL_VECTORIZED static bool strain_group(const struct tl_zones *z, const tl_gridpoint_now *p, const tl_zone_group *g,
                                       group_rows *r, double *most)
{
    group_sums sums;
    tl_lanes_clear(sums.change);
    tl_lanes_clear(sums.middle);
    tl_lanes_clear(sums.strain2);
    for (size_t l = 0; l < TL_LANES; l++) {
        sums.sound[l] = 1;
        sums.zones[l] = g->count[l];
    }
    for (size_t k = 0; k < g->depth; k++)
        for (size_t first = 0; first < TL_LANES; first += FOUR)
            strain_four(z, p, g, k, first, r, &sums);
    mean_volume(&sums);
    for (size_t k = 0; k < g->depth; k++)
        turn_row(z, g, k, r, &sums);
    for (size_t i = 0; i < TL_LANES * g->depth; i += TL_LANES)
        tl_lanes_load(r->extent + i, g->extent);
    for (size_t l = 0; l < TL_LANES; l++)
        *most = tl_larger(*most, sums.strain2[l]);
    return is_outside_out(&sums);
}

/* Ends a group whose solid has answered. */
TL_VECTORIZED static given close_group(const struct tl_zones *z, const tl_zone_group *g, const group_rows *r,
                                       tl_slot *slots)
{
    double mean[TL_LANES];
    lane_sums sums;
    given out = {0, 0, 0};
    tl_lanes_clear(sums.work);
    tl_lanes_clear(sums.heat);
    tl_lanes_clear(sums.lost);
    mean_change(r, z->zones.stress, g->start, g->depth, mean);
    for (size_t k = 0; k < g->depth; k++)
        for (size_t first = 0; first < TL_LANES; first += FOUR)
            close_four(z, g, k, first, mean, r, &sums, slots);
    for (size_t l = 0; l < TL_LANES; l++) {
        out.work += 0.5 * sums.work[l];
        out.heat += sums.heat[l];
        out.lost += sums.lost[l];
    }
    return out;
}

/* Q of half a turn k. */
static tl_mat3 turn_of(tl_vec3 k)
{
    const double x = k.x, y = k.y, z = k.z, s = 2 / (1 + (x * x + y * y + z * z));
    return (tl_mat3){{{1 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y)},
                      {s * (x * y + z), 1 - s * (x * x + z * z), s * (y * z - x)},
                      {s * (x * z - y), s * (y * z + x), 1 - s * (x * x + y * y)}}};
}

/* Turns column k and those after it, of a row: a vector's three, or a tensor's six. */
static void turn_state(const tl_mat3 *q, double *const *state, uint32_t kind, size_t row)
{
    if (kind == TL_STATE_AXIS) {
        const tl_vec3 v = tl_m3_mul(q, tl_v3(state[0][row], state[1][row], state[2][row]));
        state[0][row] = v.x;
        state[1][row] = v.y;
        state[2][row] = v.z;
        return;
    }
    const double a[3][3] = {{state[0][row], state[3][row], state[5][row]},
                            {state[3][row], state[1][row], state[4][row]},
                            {state[5][row], state[4][row], state[2][row]}};
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int c = 0; c < 6; c++) {
        double sum = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                sum += q->m[at[c][0]][i] * a[i][j] * q->m[at[c][1]][j];
        state[c][row] = sum;
    }
}

/* States that are directions or tensors turn with their zones. */
static void turn_states(const struct tl_zones *z, const tl_kind *kind, const tl_zone_group *g, const group_rows *r)
{
    for (size_t i = 0; i < (size_t)g->depth * TL_LANES; i++) {
        const tl_mat3 q = turn_of(tl_v3(r->spin[0][i], r->spin[1][i], r->spin[2][i]));
        double *const *state = z->zones.state;
        for (uint32_t k = 0; k < kind->state_count; k++) {
            const uint32_t form = tl_kind_state(kind, k)->kind;
            if (form != TL_STATE_SCALAR)
                turn_state(&q, state, form, g->start + i);
            state += tl_state_width(form);
        }
    }
}

/* Calls the solid for the rows of a group. */
static bool call_solid(const pass_job *job, const tl_solid *solid, const tl_zone_group *g, group_rows *r, size_t parcel)
{
    const struct tl_zones *z = job->zones;
    double *state[TL_SOLID_COLUMNS];
    for (uint32_t k = 0; k < solid->columns; k++)
        state[k] = z->zones.state[k] + g->start;
    tl_solid_batch batch = {.size = sizeof batch,
                            .count = (uint32_t)(g->depth * TL_LANES),
                            .dt = tl_law_time(job->m, job->dt),
                            .volume = r->volume,
                            .extent = r->extent,
                            .state = state,
                            .flags = z->zones.flags + g->start,
                            .dissipated = r->dissipated};
    for (int j = 0; j < 6; j++) {
        batch.strain[j] = r->strain[j];
        batch.stress[j] = z->zones.stress[j] + g->start;
    }
    tl_report report;
    const tl_status status = tl_solid_update(solid, &batch, &report);
    if (status != TL_OK)
        tl_failure_note(job->failure, parcel, status, g->start, tl_report_text(&report, status));
    return status == TL_OK;
}

/* The places of a parcel's gridpoints, and half their ways in the last step. */
static void list_points(const pass_job *job, const tl_parcel *of, tl_gridpoint_now *p)
{
    for (uint32_t k = of->point_begin; k < of->point_end; k++) {
        tl_gridpoint_put(&p[k - of->point_begin], &job->zones->points, job->zones->listed[k], 0.5 * job->dt);
        job->zones->slot[k] = (tl_slot){{0}};
    }
}

/* Says which zone of a group is turned inside out. */
static void note_inside_out(const pass_job *job, const tl_gridpoint_now *p, const tl_zone_group *g, const group_rows *r,
                            size_t parcel)
{
    const tl_zone_table *t = &job->zones->zones;
    for (size_t i = 0; i < (size_t)g->depth * TL_LANES; i++) {
        const size_t row = g->start + i;
        if (t->number[row] == TL_NO_ROW || (r->volume[i] > 0 && r->middle[i] > 0))
            continue;
        tl_vec3 at = job->m->origin;
        for (int a = 0; a < 4; a++) {
            const double *x = p[t->corner[a][row]].place;
            at = tl_v3_madd(at, 0.25, tl_v3(x[0], x[1], x[2]));
        }
        char text[TL_ERROR_TEXT / 2];
        tl_text_print(
            text, sizeof text,
            "zone %u at (%.4g, %.4g, %.4g) is turned inside out: give stiffer joints or solids, lower velocities or "
            "a shorter time step",
            t->number[row], at.x, at.y, at.z);
        tl_failure_note(job->failure, parcel, TL_E_NUMERIC, row, text);
        return;
    }
}

static void pass_parcel(const pass_job *job, size_t parcel, tl_gridpoint_now *p)
{
    struct tl_zones *z = job->zones;
    const tl_parcel *of = &z->parcels.of[parcel];
    const tl_named_solid *named = &z->solid[of->solid];
    const tl_solid *solid = &named->of;
    const double bulk = solid->constrained - 4.0 / 3 * solid->shear;
    double work = 0, heat = 0, most = 0;
    group_rows r;
    list_points(job, of, p);
    for (uint32_t k = of->group_begin; k < of->group_end; k++) {
        const tl_zone_group *g = &z->group[k];
        memset(r.dissipated, 0, TL_LANES * g->depth * sizeof *r.dissipated);
        if (!strain_group(z, p, g, &r, &most)) {
            note_inside_out(job, p, g, &r, parcel);
            return;
        }
        if (named->turns)
            turn_states(z, solid->kind, g, &r);
        if (!call_solid(job, solid, g, &r, parcel))
            return;
        const given by = close_group(z, g, &r, z->slot + of->point_begin);
        work += by.work;
        heat += by.heat + (bulk > 0 ? 0.5 * by.lost / bulk : 0);
    }
    z->parcels.heat[parcel] = heat;
    z->parcels.stored[parcel] += work - heat;
    z->parcels.most_strain[parcel] = most;
}

static void pass_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const pass_job *job = user;
    for (size_t parcel = begin; parcel < end; parcel++)
        pass_parcel(job, parcel, tl_gridpoints_aligned(job->zones->scratch[thread].of));
}

void tl_zones_pass(tl_model *m, double dt, tl_failure *failure)
{
    pass_job job = {m, m->zones, dt, failure};
    tl_parallel_for(m->pool, m->zones->parcels.table.rows, 1, pass_range, &job);
}
