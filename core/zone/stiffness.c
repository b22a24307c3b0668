/* stiffness.c - how stiff the zones hold each gridpoint: what that asks of the time step.
 *
 * The row of gridpoint a of the stiffness matrix has at the most
 *
 *     k_a = sum over its zones of V M |g_a| sum_b |g_b|
 *
 * with the largest constrained modulus M of the solid and the gradients g of the shape functions. That is in the norm
 * of the 3 x 3 blocks. No eigenvalue of K x = w^2 m x is higher than the largest k_a / m_a (Gershgorin), so steps up to
 * 2 / sqrt(k_a / m_a) are stable. Means over clusters take stiffness away only. */
#include "zone/stiffness.h"

#include "base/parallel.h"

#include <math.h>

/* Cost only: steps after which stiffness is found again as zones deform. */
#define RATE_EVERY 64
/* Gridpoints that a thread takes at a time. */
#define CHUNK 1024

/* The vector area over 3 of the side of a zone beside corner a: 6 V g_a. */
static tl_vec3 side_of(const tl_vec3 x[4], int a)
{
    const tl_vec3 e1 = tl_v3_sub(x[1], x[0]), e2 = tl_v3_sub(x[2], x[0]), e3 = tl_v3_sub(x[3], x[0]);
    if (a > 0)
        return a == 1 ? tl_v3_cross(e2, e3) : a == 2 ? tl_v3_cross(e3, e1) : tl_v3_cross(e1, e2);
    return tl_v3_cross(tl_v3_sub(e2, e1), tl_v3_sub(e3, e1));
}

static void add_zone(const struct tl_zones *z, const tl_parcel *of, size_t row, double modulus)
{
    tl_vec3 x[4];
    double size[4], all = 0;
    for (int a = 0; a < 4; a++)
        x[a] = tl_gridpoint_place(&z->points, z->listed[of->point_begin + z->zones.corner[a][row]]);
    for (int a = 0; a < 4; a++) {
        size[a] = tl_v3_norm(side_of(x, a));
        all += size[a];
    }
    const double six = fabs(tl_v3_dot(side_of(x, 1), tl_v3_sub(x[1], x[0])));
    for (int a = 0; a < 4; a++)
        z->slot[of->point_begin + z->zones.corner[a][row]].of[3] += modulus * size[a] * all / (6 * six);
}

static void parcel_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const struct tl_zones *z = user;
    for (size_t k = begin; k < end; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        const double modulus = z->solid[of->solid].of.constrained;
        for (uint32_t s = of->point_begin; s < of->point_end; s++)
            z->slot[s].of[3] = 0;
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (size_t row = z->group[g].start, last = row + (size_t)z->group[g].depth * TL_LANES; row < last; row++)
                if (z->zones.number[row] != TL_NO_ROW)
                    add_zone(z, of, row, modulus);
    }
}

static void point_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const struct tl_zones *z = user;
    for (size_t p = begin; p < end; p++) {
        double sum = 0;
        for (uint32_t k = z->use_start[p]; k < z->use_start[p + 1]; k++)
            sum += z->slot[z->use[k]].of[3];
        z->points.stiffness[p] = sum;
    }
}

/* Twice the stiffness of a face of the stiffest joint, by thirds of each of its triangles: what lands on it or comes to
 * lie on it holds it no stiffer, and the step does not shrink then. */
static void find_floors(const tl_model *m, struct tl_zones *z)
{
    double stiffest = 0;
    for (size_t k = 0; k < m->joint_law_count; k++)
        stiffest = fmax(stiffest, fmax(m->joint_laws[k].kn, m->joint_laws[k].ks));
    for (size_t row = 0; row < z->points.table.rows; row++)
        z->points.floor[row] = 0;
    for (size_t k = 0; k < z->part_count; k++) {
        const uint32_t *c = z->part[k].corner;
        const tl_vec3 x = tl_gridpoint_place(&z->points, c[0]);
        const tl_vec3 a = tl_v3_sub(tl_gridpoint_place(&z->points, c[1]), x);
        const double area = 0.5 * tl_v3_norm(tl_v3_cross(a, tl_v3_sub(tl_gridpoint_place(&z->points, c[2]), x)));
        for (int i = 0; i < 3; i++)
            z->points.floor[c[i]] += 2 * stiffest * area / 3;
    }
}

bool tl_zones_stiffen(tl_model *m)
{
    struct tl_zones *z = m->zones;
    if (z->rated_for == z->version && m->cycles / RATE_EVERY == z->rated_at / RATE_EVERY)
        return false;
    tl_parallel_for(m->pool, z->parcels.table.rows, 1, parcel_range, z);
    tl_parallel_for(m->pool, z->points.table.rows, CHUNK, point_range, z);
    find_floors(m, z);
    z->rated_for = z->version;
    z->rated_at = m->cycles;
    return true;
}

/* Whether something else than gridpoints can move. */
static bool bodies_move(const tl_model *m)
{
    bool some = false;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        some = some || m->bodies.fixed[body] != TL_FIX_ALL;
    return some;
}

/* Finds the rates of the gridpoints that may move, or of those that are held. */
static void rate(struct tl_zones *z, bool held)
{
    const tl_gridpoints *p = &z->points;
    z->highest_rate = 0;
    z->lowest_rate = INFINITY;
    z->highest = z->lowest = TL_NO_ROW;
    for (uint32_t row = 0; row < p->table.rows; row++) {
        const double rate = p->holds[row] / p->mass[row];
        if ((p->fixed[row] == (TL_FIX_X | TL_FIX_Y | TL_FIX_Z)) != held || p->zones[row] == 0)
            continue;
        z->lowest = rate < z->lowest_rate ? row : z->lowest;
        z->lowest_rate = rate < z->lowest_rate ? rate : z->lowest_rate;
        z->highest = rate > z->highest_rate ? row : z->highest;
        z->highest_rate = rate > z->highest_rate ? rate : z->highest_rate;
    }
}

void tl_zones_rate(tl_model *m)
{
    rate(m->zones, false);
    if (m->zones->highest == TL_NO_ROW && !bodies_move(m)) /* all go as they are driven, in steps that suit the zones */
        rate(m->zones, true);
}
