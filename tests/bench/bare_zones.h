/* bare_zones.h - the least that a step of zones can be: the loop that the kernel's is measured against.
 *
 * Strain by half-way places, the turn of the stress, means over clusters, Hooke's law or one with four sweeps of
 * Jacobi's method in it, forces, their sums, and the motion of gridpoints. It leaves out all that a program must keep
 * beside: the ledger of energy, the sizes of forces that rest asks for, flags, states, failures, plugins. Zones lie as
 * in the kernel, in the same order.
 *
 * A vector is four zones, and a row of a group two of them. */
#ifndef TALUS_BENCH_BARE_ZONES_H
#define TALUS_BENCH_BARE_ZONES_H

#include "base/parallel.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BARE_INLINE static inline __attribute__((always_inline))

typedef double bare4 __attribute__((vector_size(32)));
typedef int64_t bare_mask __attribute__((vector_size(32)));
typedef struct bare4x3 {
    bare4 x, y, z;
} bare4x3;

typedef struct bare {
    const struct tl_zones *z; /* corners, groups, parcels and lists are the model's */
    double *stress[6];
    double *x[3], *v[3], *mass;
    tl_slot *slot;
    double dt, lame, shear;
    bool yields;
} bare;

/* What a thread keeps of a parcel's gridpoints: place and way. */
typedef struct bare_point {
    _Alignas(64) double of[8];
} bare_point;

static double *bare_column(size_t rows)
{
    double *out = aligned_alloc(64, (rows * sizeof *out + 63) / 64 * 64);
    if (!out)
        exit(1);
    memset(out, 0, rows * sizeof *out);
    return out;
}

/* A copy of the model's zones as they are. */
static bare bare_of(const struct tl_zones *z, double dt, double young, double poisson, bool yields)
{
    const size_t zones = z->zones.table.rows, points = z->points.table.rows;
    bare b = {.z = z,
              .dt = dt,
              .lame = young * poisson / (1 + poisson) / (1 - 2 * poisson),
              .shear = young / 2 / (1 + poisson),
              .yields = yields,
              .mass = bare_column(points),
              .slot = (tl_slot *)bare_column(4 * z->listed_count)};
    for (int k = 0; k < 6; k++)
        b.stress[k] = bare_column(zones);
    for (int k = 0; k < 3; k++) {
        b.x[k] = bare_column(points);
        b.v[k] = bare_column(points);
        for (size_t row = 0; row < points; row++) {
            b.x[k][row] = z->points.ref[k][row] + z->points.u[k][row];
            b.v[k][row] = z->points.v[k][row];
        }
    }
    for (size_t row = 0; row < points; row++) /* padding has none */
        b.mass[row] = z->points.mass[row] > 0 ? z->points.mass[row] : 1;
    return b;
}

static void bare_free(bare *b)
{
    for (int k = 0; k < 6; k++)
        free(b->stress[k]);
    for (int k = 0; k < 3; k++) {
        free(b->x[k]);
        free(b->v[k]);
    }
    free(b->mass);
    free(b->slot);
}

/* ---------------------------------------------------------------- vectors ---------------- */

BARE_INLINE bare4x3 bare_less(bare4x3 a, bare4x3 b)
{
    return (bare4x3){a.x - b.x, a.y - b.y, a.z - b.z};
}

BARE_INLINE bare4x3 bare_half_way(bare4x3 e, bare4x3 way)
{
    return (bare4x3){e.x - 0.5 * way.x, e.y - 0.5 * way.y, e.z - 0.5 * way.z};
}

BARE_INLINE bare4x3 bare_cross(bare4x3 a, bare4x3 b)
{
    return (bare4x3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

BARE_INLINE bare4 bare_dot(bare4x3 a, bare4x3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Places, or with `from` 4 ways, of one corner of four zones. */
BARE_INLINE bare4x3 bare_corner(const bare_point *p, const uint16_t *corner, int from)
{
    const bare4 a = *(const bare4 *)(p[corner[0]].of + from), b = *(const bare4 *)(p[corner[1]].of + from);
    const bare4 c = *(const bare4 *)(p[corner[2]].of + from), d = *(const bare4 *)(p[corner[3]].of + from);
    const bare4 even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const bare4 odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7), odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return (bare4x3){__builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5),
                     __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5),
                     __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7)};
}

/* Adds the forces on one corner of four zones to the slots. */
BARE_INLINE void bare_add(tl_slot *slot, const uint16_t *corner, bare4x3 f)
{
    const bare4 zero = {0, 0, 0, 0};
    const bare4 even = __builtin_shufflevector(f.x, f.y, 0, 4, 2, 6),
                odd = __builtin_shufflevector(f.x, f.y, 1, 5, 3, 7);
    const bare4 even_z = __builtin_shufflevector(f.z, zero, 0, 4, 2, 6);
    const bare4 odd_z = __builtin_shufflevector(f.z, zero, 1, 5, 3, 7);
    *(bare4 *)slot[corner[0]].of += __builtin_shufflevector(even, even_z, 0, 1, 4, 5);
    *(bare4 *)slot[corner[1]].of += __builtin_shufflevector(odd, odd_z, 0, 1, 4, 5);
    *(bare4 *)slot[corner[2]].of += __builtin_shufflevector(even, even_z, 2, 3, 6, 7);
    *(bare4 *)slot[corner[3]].of += __builtin_shufflevector(odd, odd_z, 2, 3, 6, 7);
}

BARE_INLINE bare4 bare_choose(bare_mask which, bare4 a, bare4 b)
{
    return (bare4)((which & (bare_mask)a) | (~which & (bare_mask)b));
}

BARE_INLINE bare4 bare_root(bare4 a)
{
    double of[4];
    memcpy(of, &a, sizeof of);
#pragma omp simd
    for (int i = 0; i < 4; i++)
        of[i] = sqrt(of[i]);
    memcpy(&a, of, sizeof of);
    return a;
}

/* ---------------------------------------------------------------- a group ---------------- */

/* What four zones keep between the two sweeps over their cluster. */
typedef struct bare_zone {
    bare4 strain[6], stress[6], volume, change;
    bare4x3 area[3];
} bare_zone;

/* Q s Q^T. */
BARE_INLINE void bare_turn(bare4 s[6], bare4 x, bare4 y, bare4 z)
{
    const bare4 f = 2 / (1 + (x * x + y * y + z * z));
    const bare4x3 q[3] = {{1 - f * (y * y + z * z), f * (x * y - z), f * (x * z + y)},
                          {f * (x * y + z), 1 - f * (x * x + z * z), f * (y * z - x)},
                          {f * (x * z - y), f * (y * z + x), 1 - f * (x * x + y * y)}};
    const bare4x3 row[3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    bare4x3 p[3];
    for (int i = 0; i < 3; i++)
        p[i] = (bare4x3){bare_dot(q[i], row[0]), bare_dot(q[i], row[1]), bare_dot(q[i], row[2])};
    s[0] = bare_dot(p[0], q[0]);
    s[1] = bare_dot(p[1], q[1]);
    s[2] = bare_dot(p[2], q[2]);
    s[3] = bare_dot(p[0], q[1]);
    s[4] = bare_dot(p[1], q[2]);
    s[5] = bare_dot(p[2], q[0]);
}

BARE_INLINE void bare_jacobi(bare4 *pp, bare4 *qq, bare4 *pq, bare4 *rp, bare4 *rq, bare4x3 *vp, bare4x3 *vq)
{
    const bare4 apart = *qq - *pp, twice = 2 * *pq, root = bare_root(apart * apart + twice * twice);
    const bare4 size = bare_choose(apart < 0, -apart, apart) + root, sign = bare_choose(apart < 0, -twice, twice);
    const bare4 t = sign / bare_choose(size > 0, size, (bare4){1, 1, 1, 1}), c = 1 / bare_root(1 + t * t), s = t * c;
    const bare4 p = *rp, q = *rq;
    const bare4x3 v = *vp, w = *vq;
    *pp -= t * *pq;
    *qq += t * *pq;
    *pq = (bare4){0, 0, 0, 0};
    *rp = c * p - s * q;
    *rq = s * p + c * q;
    *vp = (bare4x3){c * v.x - s * w.x, c * v.y - s * w.y, c * v.z - s * w.z};
    *vq = (bare4x3){s * v.x + c * w.x, s * v.y + c * w.y, s * v.z + c * w.z};
}

/* Principal stresses by four sweeps, and the stress made of them again. */
BARE_INLINE void bare_principal(bare4 s[6])
{
    const bare4 one = {1, 1, 1, 1}, zero = {0, 0, 0, 0};
    bare4x3 v[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    for (int sweep = 0; sweep < 4; sweep++) {
        bare_jacobi(&s[0], &s[1], &s[3], &s[5], &s[4], &v[0], &v[1]);
        bare_jacobi(&s[1], &s[2], &s[4], &s[3], &s[5], &v[1], &v[2]);
        bare_jacobi(&s[0], &s[2], &s[5], &s[3], &s[4], &v[0], &v[2]);
    }
    const bare4 a = s[0], b = s[1], c = s[2];
    s[0] = a * v[0].x * v[0].x + b * v[1].x * v[1].x + c * v[2].x * v[2].x;
    s[1] = a * v[0].y * v[0].y + b * v[1].y * v[1].y + c * v[2].y * v[2].y;
    s[2] = a * v[0].z * v[0].z + b * v[1].z * v[1].z + c * v[2].z * v[2].z;
    s[3] = a * v[0].x * v[0].y + b * v[1].x * v[1].y + c * v[2].x * v[2].y;
    s[4] = a * v[0].y * v[0].z + b * v[1].y * v[1].z + c * v[2].y * v[2].z;
    s[5] = a * v[0].z * v[0].x + b * v[1].z * v[1].x + c * v[2].z * v[2].x;
}

/* Strain, turned stress and vector areas of four zones. */
BARE_INLINE void bare_strain(const bare *b, const bare_point *p, size_t row, bare4 factor, bare_zone *to)
{
    uint16_t *const *corner = b->z->zones.corner;
    const bare4x3 x0 = bare_corner(p, corner[0] + row, 0), w0 = bare_corner(p, corner[0] + row, 4);
    const bare4x3 e1 = bare_less(bare_corner(p, corner[1] + row, 0), x0);
    const bare4x3 e2 = bare_less(bare_corner(p, corner[2] + row, 0), x0);
    const bare4x3 e3 = bare_less(bare_corner(p, corner[3] + row, 0), x0);
    const bare4x3 w1 = bare_less(bare_corner(p, corner[1] + row, 4), w0);
    const bare4x3 w2 = bare_less(bare_corner(p, corner[2] + row, 4), w0);
    const bare4x3 w3 = bare_less(bare_corner(p, corner[3] + row, 4), w0);
    to->area[0] = bare_cross(e2, e3);
    to->area[1] = bare_cross(e3, e1);
    to->area[2] = bare_cross(e1, e2);
    const bare4x3 m1 = bare_half_way(e1, w1), m2 = bare_half_way(e2, w2), m3 = bare_half_way(e3, w3);
    const bare4x3 g1 = bare_cross(m2, m3), g2 = bare_cross(m3, m1), g3 = bare_cross(m1, m2);
    const bare4 six = bare_dot(g1, m1), per = 1 / six;
    const bare4 xy = per * (w1.x * g1.y + w2.x * g2.y + w3.x * g3.y);
    const bare4 yx = per * (w1.y * g1.x + w2.y * g2.x + w3.y * g3.x);
    const bare4 yz = per * (w1.y * g1.z + w2.y * g2.z + w3.y * g3.z);
    const bare4 zy = per * (w1.z * g1.y + w2.z * g2.y + w3.z * g3.y);
    const bare4 zx = per * (w1.z * g1.x + w2.z * g2.x + w3.z * g3.x);
    const bare4 xz = per * (w1.x * g1.z + w2.x * g2.z + w3.x * g3.z);
    to->volume = factor * six;
    to->strain[0] = per * (w1.x * g1.x + w2.x * g2.x + w3.x * g3.x);
    to->strain[1] = per * (w1.y * g1.y + w2.y * g2.y + w3.y * g3.y);
    to->strain[2] = per * (w1.z * g1.z + w2.z * g2.z + w3.z * g3.z);
    to->strain[3] = 0.5 * (xy + yx);
    to->strain[4] = 0.5 * (yz + zy);
    to->strain[5] = 0.5 * (zx + xz);
    for (int k = 0; k < 6; k++)
        to->stress[k] = *(const bare4 *)(b->stress[k] + row);
    bare_turn(to->stress, 0.25 * (zy - yz), 0.25 * (xz - zx), 0.25 * (yx - xy));
}

/* The law, with the mean change of volume of the cluster. */
BARE_INLINE void bare_law(const bare *b, bare4 mean, bare_zone *of)
{
    bare4 *s = of->stress;
    const bare4 *d = of->strain, more = (mean - (d[0] + d[1] + d[2])) / 3, before = s[0] + s[1] + s[2];
    for (int k = 0; k < 3; k++)
        s[k] += b->lame * mean + 2 * b->shear * (d[k] + more);
    for (int k = 3; k < 6; k++)
        s[k] += 2 * b->shear * d[k];
    if (b->yields)
        bare_principal(s);
    of->change = (s[0] + s[1] + s[2]) - before;
}

/* Stores the stress with the mean change of the cluster, and adds the forces to the slots. */
BARE_INLINE void bare_push(const bare *b, tl_slot *slot, size_t row, bare4 factor, bare4 mean, bare_zone *of)
{
    bare4 *s = of->stress;
    const bare4 more = (mean - of->change) / 3;
    for (int k = 0; k < 3; k++)
        s[k] += more;
    for (int k = 0; k < 6; k++)
        *(bare4 *)(b->stress[k] + row) = s[k];
    bare4x3 f[4];
    for (int a = 0; a < 3; a++) {
        const bare4x3 n = {-factor * of->area[a].x, -factor * of->area[a].y, -factor * of->area[a].z};
        f[a + 1] = (bare4x3){s[0] * n.x + s[3] * n.y + s[5] * n.z, s[3] * n.x + s[1] * n.y + s[4] * n.z,
                             s[5] * n.x + s[4] * n.y + s[2] * n.z};
    }
    f[0] = (bare4x3){-(f[1].x + f[2].x + f[3].x), -(f[1].y + f[2].y + f[3].y), -(f[1].z + f[2].z + f[3].z)};
    for (int a = 0; a < 4; a++)
        bare_add(slot, b->z->zones.corner[a] + row, f[a]);
}

/* Of a half of the lanes of a group. */
static void bare_group(const bare *b, const bare_point *p, tl_slot *slot, const tl_zone_group *g, size_t half)
{
    bare_zone zone[TL_CLUSTER_MOST];
    bare4 factor[TL_CLUSTER_MOST], sum = {0, 0, 0, 0}, all = {0, 0, 0, 0}, change = {0, 0, 0, 0};
    for (size_t k = 0; k < g->depth; k++) {
        for (size_t l = 0; l < 4; l++)
            factor[k][l] = k < g->count[half + l] ? 1.0 / 6 : 0;
        bare_strain(b, p, g->start + TL_LANES * k + half, factor[k], &zone[k]);
        sum += zone[k].volume * (zone[k].strain[0] + zone[k].strain[1] + zone[k].strain[2]);
        all += zone[k].volume;
    }
    all = bare_choose(all > 0, all, (bare4){1, 1, 1, 1});
    sum /= all;
    for (size_t k = 0; k < g->depth; k++) {
        bare_law(b, sum, &zone[k]);
        change += zone[k].volume * zone[k].change;
    }
    change /= all;
    for (size_t k = 0; k < g->depth; k++)
        bare_push(b, slot, g->start + TL_LANES * k + half, factor[k], change, &zone[k]);
}

/* ---------------------------------------------------------------- a step ----------------- */

static void bare_parcels(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    static _Thread_local bare_point point[TL_PARCEL_POINTS];
    const bare *b = user;
    for (size_t parcel = begin; parcel < end; parcel++) {
        const tl_parcel *of = &b->z->parcels.of[parcel];
        for (uint32_t k = of->point_begin; k < of->point_end; k++) {
            const uint32_t row = b->z->listed[k];
            for (int i = 0; i < 3; i++) {
                point[k - of->point_begin].of[i] = b->x[i][row];
                point[k - of->point_begin].of[4 + i] = b->dt * b->v[i][row];
            }
            b->slot[k] = (tl_slot){{0}};
        }
        for (uint32_t k = of->group_begin; k < of->group_end; k++) {
            bare_group(b, point, b->slot + of->point_begin, &b->z->group[k], 0);
            bare_group(b, point, b->slot + of->point_begin, &b->z->group[k], 4);
        }
    }
}

static void bare_points(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const bare *b = user;
    const uint32_t *start = b->z->use_start, *use = b->z->use;
    for (size_t row = begin; row < end; row++) {
        bare4 sum = {0, 0, 0, 0};
        for (uint32_t k = start[row]; k < start[row + 1]; k++)
            sum += *(const bare4 *)b->slot[use[k]].of;
        const bool held = b->z->points.fixed[row] != 0;
        for (int i = 0; i < 3; i++) {
            b->v[i][row] += held ? 0 : b->dt / b->mass[row] * sum[i];
            b->x[i][row] += b->dt * b->v[i][row];
        }
    }
}

/* One step of all zones and gridpoints. */
static void bare_step(bare *b, tl_pool *pool)
{
    tl_parallel_for(pool, b->z->parcels.table.rows, 1, bare_parcels, b);
    tl_parallel_for(pool, b->z->points.table.rows, 256, bare_points, b);
}

#endif
