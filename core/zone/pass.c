/* pass.c - zones follow their gridpoints: strain, stress, forces.
 *
 * Let v be the velocity of the last motion and h its duration, x the present places and x' = x - v h / 2 those half-way.
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
 * A corner bears at the most sum |f| <= sqrt(n sum f^2) of n zones. That is what rest compares forces with: it needs no
 * root for each zone. */
#include "zone/pass.h"

#include "base/extremes.h"
#include "base/inline.h"
#include "plugin/loader.h"

#include <stdio.h>

/* Rows of a SIMD group. */
#define ROWS (TL_CLUSTER_ZONES * TL_LANES)

/* What the rows of a group have. */
typedef struct group_rows {
    _Alignas(TL_ALIGN) double strain[6][ROWS]; /* increment */
    double before[6][ROWS];                    /* turned stress */
    double area[3][3][ROWS];                   /* 6 V g_a at the present places, corners 1 to 3 */
    double spin[3][ROWS];                      /* turn of the step, rad */
    double middle[ROWS], volume[ROWS];         /* V half-way and now, m3; of an inert row 0 */
    double extent[ROWS], dissipated[ROWS];     /* m, and J/m3 */
} group_rows;

typedef struct pass_job {
    tl_model *m;
    struct tl_zones *zones;
    double dt;
    tl_failure *failure;
} pass_job;

typedef struct lanes3 {
    double of[3][TL_LANES];
} lanes3;

/* ---------------------------------------------------------------- strain ----------------- */

TL_INLINE void load(lanes3 *to, const double (*from)[TL_PARCEL_POINTS], const uint16_t *corner)
{
    for (int i = 0; i < 3; i++)
        for (size_t l = 0; l < TL_LANES; l++)
            to->of[i][l] = from[i][corner[l]];
}

TL_INLINE void take(lanes3 *from, const lanes3 *other)
{
    for (int i = 0; i < 3; i++)
        for (size_t l = 0; l < TL_LANES; l++)
            from->of[i][l] -= other->of[i][l];
}

TL_INLINE void cross(lanes3 *out, const lanes3 *a, const lanes3 *b)
{
    for (size_t l = 0; l < TL_LANES; l++) {
        out->of[0][l] = a->of[1][l] * b->of[2][l] - a->of[2][l] * b->of[1][l];
        out->of[1][l] = a->of[2][l] * b->of[0][l] - a->of[0][l] * b->of[2][l];
        out->of[2][l] = a->of[0][l] * b->of[1][l] - a->of[1][l] * b->of[0][l];
    }
}

/* Turns a stress by Q of the turn w, lane by lane. */
TL_INLINE void turn(double *const stress[6], double (*before)[ROWS], size_t row, size_t at, const lanes3 *w)
{
    for (size_t l = 0; l < TL_LANES; l++) {
        const double kx = 0.5 * w->of[0][l], ky = 0.5 * w->of[1][l], kz = 0.5 * w->of[2][l];
        const double s = 2 / (1 + (kx * kx + ky * ky + kz * kz));
        const double q[3][3] = {
            {1 - s * (ky * ky + kz * kz), s * (kx * ky - kz), s * (kx * kz + ky)},
            {s * (kx * ky + kz), 1 - s * (kx * kx + kz * kz), s * (ky * kz - kx)},
            {s * (kx * kz - ky), s * (ky * kz + kx), 1 - s * (kx * kx + ky * ky)}};
        const double xx = stress[0][row + l], yy = stress[1][row + l], zz = stress[2][row + l];
        const double xy = stress[3][row + l], yz = stress[4][row + l], zx = stress[5][row + l];
        double t[3][3];
        for (int i = 0; i < 3; i++) {
            t[i][0] = q[i][0] * xx + q[i][1] * xy + q[i][2] * zx;
            t[i][1] = q[i][0] * xy + q[i][1] * yy + q[i][2] * yz;
            t[i][2] = q[i][0] * zx + q[i][1] * yz + q[i][2] * zz;
        }
        before[0][at + l] = t[0][0] * q[0][0] + t[0][1] * q[0][1] + t[0][2] * q[0][2];
        before[1][at + l] = t[1][0] * q[1][0] + t[1][1] * q[1][1] + t[1][2] * q[1][2];
        before[2][at + l] = t[2][0] * q[2][0] + t[2][1] * q[2][1] + t[2][2] * q[2][2];
        before[3][at + l] = t[0][0] * q[1][0] + t[0][1] * q[1][1] + t[0][2] * q[1][2];
        before[4][at + l] = t[1][0] * q[2][0] + t[1][1] * q[2][1] + t[1][2] * q[2][2];
        before[5][at + l] = t[2][0] * q[0][0] + t[2][1] * q[0][1] + t[2][2] * q[0][2];
    }
}

/* The zones of one row of a group: number k of their clusters. */
TL_INLINE void strain_row(const struct tl_zones *z, const tl_parcel_points *p, const tl_zone_group *g, size_t k,
                          group_rows *restrict r)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    uint16_t *const *corner = z->zones.corner;
    lanes3 x0, way0, edge[3], way[3], mid[3], area[3], w;
    load(&x0, p->x, corner[0] + row);
    load(&way0, p->way, corner[0] + row);
    for (int a = 0; a < 3; a++) {
        load(&edge[a], p->x, corner[a + 1] + row);
        load(&way[a], p->way, corner[a + 1] + row);
        take(&edge[a], &x0);
        take(&way[a], &way0);
        for (int i = 0; i < 3; i++)
            for (size_t l = 0; l < TL_LANES; l++)
                mid[a].of[i][l] = edge[a].of[i][l] - 0.5 * way[a].of[i][l];
    }
    for (int a = 0; a < 3; a++) {
        cross(&area[a], &edge[(a + 1) % 3], &edge[(a + 2) % 3]);
        for (int i = 0; i < 3; i++)
            for (size_t l = 0; l < TL_LANES; l++)
                r->area[a][i][at + l] = area[a].of[i][l];
    }
    for (size_t l = 0; l < TL_LANES; l++) {
        const double factor = k < g->count[l] ? 1.0 / 6 : 0;
        r->volume[at + l] = factor * (area[0].of[0][l] * edge[0].of[0][l] + area[0].of[1][l] * edge[0].of[1][l] +
                                      area[0].of[2][l] * edge[0].of[2][l]);
        r->extent[at + l] = g->extent[l];
    }
    for (int a = 0; a < 3; a++)
        cross(&area[a], &mid[(a + 1) % 3], &mid[(a + 2) % 3]);
    for (size_t l = 0; l < TL_LANES; l++) {
        const double six = area[0].of[0][l] * mid[0].of[0][l] + area[0].of[1][l] * mid[0].of[1][l] +
                           area[0].of[2][l] * mid[0].of[2][l];
        const double per = 1 / six;
        double d[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                d[i][j] = per * (way[0].of[i][l] * area[0].of[j][l] + way[1].of[i][l] * area[1].of[j][l] +
                                 way[2].of[i][l] * area[2].of[j][l]);
        r->middle[at + l] = k < g->count[l] ? six / 6 : 0;
        r->strain[0][at + l] = d[0][0];
        r->strain[1][at + l] = d[1][1];
        r->strain[2][at + l] = d[2][2];
        r->strain[3][at + l] = 0.5 * (d[0][1] + d[1][0]);
        r->strain[4][at + l] = 0.5 * (d[1][2] + d[2][1]);
        r->strain[5][at + l] = 0.5 * (d[2][0] + d[0][2]);
        w.of[0][l] = 0.5 * (d[2][1] - d[1][2]);
        w.of[1][l] = 0.5 * (d[0][2] - d[2][0]);
        w.of[2][l] = 0.5 * (d[1][0] - d[0][1]);
    }
    for (int i = 0; i < 3; i++)
        for (size_t l = 0; l < TL_LANES; l++)
            r->spin[i][at + l] = w.of[i][l];
    turn(z->zones.stress, r->before, row, at, &w);
}

/* ---------------------------------------------------------------- clusters --------------- */

/* Each zone gets the mean change of volume of its cluster. The square of the largest strain. */
TL_INLINE double share_volume(group_rows *restrict r, size_t depth)
{
    double sum[TL_LANES] = {0}, all[TL_LANES] = {0}, most[TL_LANES] = {0};
    for (size_t k = 0; k < depth; k++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l;
            sum[l] += r->middle[i] * (r->strain[0][i] + r->strain[1][i] + r->strain[2][i]);
            all[l] += r->middle[i];
        }
    for (size_t l = 0; l < TL_LANES; l++)
        sum[l] /= all[l] != 0 ? all[l] : 1;
    for (size_t k = 0; k < depth; k++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l;
            const double more = (sum[l] - (r->strain[0][i] + r->strain[1][i] + r->strain[2][i])) / 3;
            double square = 0;
            for (int j = 0; j < 6; j++)
                square += (j < 3 ? 1 : 2) * r->strain[j][i] * r->strain[j][i];
            most[l] = square > most[l] ? square : most[l];
            for (int j = 0; j < 3; j++)
                r->strain[j][i] += more;
        }
    double out = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        out = most[l] > out ? most[l] : out;
    return out;
}

/* Each zone gets the mean change of mean stress of its cluster. The sum of V (P - dp)^2: twice the bulk modulus times
 * the energy that this takes. */
TL_INLINE double share_stress(group_rows *restrict r, double *const stress[6], size_t row, size_t depth)
{
    double sum[TL_LANES] = {0}, all[TL_LANES] = {0}, lost[TL_LANES] = {0};
    for (size_t k = 0; k < depth; k++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l, j = row + i;
            const double change = (stress[0][j] - r->before[0][i]) + (stress[1][j] - r->before[1][i]) +
                                  (stress[2][j] - r->before[2][i]);
            sum[l] += r->volume[i] * change;
            all[l] += r->volume[i];
        }
    for (size_t l = 0; l < TL_LANES; l++)
        sum[l] /= all[l] != 0 ? all[l] : 1;
    for (size_t k = 0; k < depth; k++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l, j = row + i;
            const double change = (stress[0][j] - r->before[0][i]) + (stress[1][j] - r->before[1][i]) +
                                  (stress[2][j] - r->before[2][i]);
            const double more = (sum[l] - change) / 3;
            for (int c = 0; c < 3; c++)
                stress[c][j] += more;
            lost[l] += r->volume[i] * more * more;
        }
    double out = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        out += lost[l];
    return out;
}

/* ---------------------------------------------------------------- forces ----------------- */

/* The work of a group's stresses over the strain, J. */
TL_INLINE double work_of(const group_rows *r, double *const stress[6], size_t row, size_t depth)
{
    double sum[TL_LANES] = {0};
    for (size_t k = 0; k < depth; k++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l;
            double straight = 0, shear = 0;
            for (int j = 0; j < 3; j++)
                straight += (r->before[j][i] + stress[j][row + i]) * r->strain[j][i];
            for (int j = 3; j < 6; j++)
                shear += (r->before[j][i] + stress[j][row + i]) * r->strain[j][i];
            sum[l] += r->middle[i] * (straight + 2 * shear);
        }
    double out = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        out += 0.5 * sum[l];
    return out;
}

/* Adds the forces of one row of zones to the slots, lane by lane, corner by corner. */
TL_INLINE void push_row(const struct tl_zones *z, const tl_zone_group *g, size_t k, const group_rows *restrict r,
                        tl_slot *restrict slots)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    double *const *s = z->zones.stress;
    _Alignas(TL_ALIGN) double force[4][4][TL_LANES];
    for (size_t l = 0; l < TL_LANES; l++) {
        const double by = k < g->count[l] ? -1.0 / 6 : 0, xx = by * s[0][row + l], yy = by * s[1][row + l];
        const double zz = by * s[2][row + l], xy = by * s[3][row + l], yz = by * s[4][row + l], zx = by * s[5][row + l];
        double sum[3] = {0, 0, 0};
        for (int a = 0; a < 3; a++) {
            const double x = r->area[a][0][at + l], y = r->area[a][1][at + l], v = r->area[a][2][at + l];
            const double f[3] = {xx * x + xy * y + zx * v, xy * x + yy * y + yz * v, zx * x + yz * y + zz * v};
            for (int i = 0; i < 3; i++) {
                force[a + 1][i][l] = f[i];
                sum[i] -= f[i];
            }
            force[a + 1][3][l] = f[0] * f[0] + f[1] * f[1] + f[2] * f[2];
        }
        for (int i = 0; i < 3; i++)
            force[0][i][l] = sum[i];
        force[0][3][l] = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
    }
    for (size_t l = 0; l < TL_LANES; l++)
        for (int a = 0; a < 4; a++) {
            tl_slot *slot = &slots[z->zones.corner[a][row + l]];
            for (int i = 0; i < 3; i++)
                slot->force[i] += force[a][i][l];
            slot->square += force[a][3][l];
        }
}

/* ---------------------------------------------------------------- groups and parcels ----- */

TL_VECTORIZED static double strain_group(const struct tl_zones *z, const tl_parcel_points *p, const tl_zone_group *g,
                                         group_rows *r)
{
    for (size_t k = 0; k < g->depth; k++)
        strain_row(z, p, g, k, r);
    for (int j = 0; j < 6; j++)
        for (size_t i = 0; i < (size_t)g->depth * TL_LANES; i++)
            z->zones.stress[j][g->start + i] = r->before[j][i];
    return share_volume(r, g->depth);
}

TL_VECTORIZED static void push_group(const struct tl_zones *z, const tl_zone_group *g, const group_rows *r,
                                     tl_slot *slots)
{
    for (size_t k = 0; k < g->depth; k++)
        push_row(z, g, k, r, slots);
}

TL_VECTORIZED static double close_group(const struct tl_zones *z, const tl_zone_group *g, group_rows *r, double *lost)
{
    *lost = share_stress(r, z->zones.stress, g->start, g->depth);
    return work_of(r, z->zones.stress, g->start, g->depth);
}

/* States that are directions or tensors turn with their zones. */
static void turn_states(const struct tl_zones *z, const tl_solid *solid, const tl_zone_group *g, const group_rows *r)
{
    double *const *state = z->zones.state;
    tl_state_columns at = {0};
    while (tl_state_next(solid->kind, UINT32_MAX, &at))
        for (size_t i = 0; at.count > 1 && i < (size_t)g->depth * TL_LANES; i++) {
            const tl_mat3 q = tl_zone_turn(tl_v3(r->spin[0][i], r->spin[1][i], r->spin[2][i]));
            if (at.count == 3)
                tl_turn_axis(&q, state + at.begin, g->start + i);
            else
                tl_turn_tensor(&q, state + at.begin, g->start + i);
        }
}

/* Calls the solid for the rows of a group. */
static bool call_solid(const pass_job *job, const tl_solid *solid, const tl_zone_group *g, group_rows *r, size_t parcel)
{
    const struct tl_zones *z = job->zones;
    const tl_solid_ops *ops = solid->kind->ops;
    double *state[TL_STATE_COLUMNS];
    for (uint32_t k = 0; k < solid->columns; k++)
        state[k] = z->zones.state[k] + g->start;
    tl_solid_batch batch = {.size = sizeof batch,
                            .count = (uint32_t)(g->depth * TL_LANES),
                            .dt = job->dt,
                            .volume = r->volume,
                            .extent = r->extent,
                            .state = state,
                            .flags = z->zones.flags + g->start,
                            .dissipated = r->dissipated};
    for (int j = 0; j < 6; j++) {
        batch.strain[j] = r->strain[j];
        batch.stress[j] = z->zones.stress[j] + g->start;
    }
    tl_report report = {.size = sizeof report};
    tl_enter(solid->kind, "update");
    const tl_status status = ops->update(solid->self, &batch, &report);
    tl_leave();
    if (status == TL_OK)
        return true;
    tl_failure_note(job->failure, parcel, status, g->start, tl_report_text(&report, status));
    return false;
}

/* The places of a parcel's gridpoints, and their way in the last step. */
static void list_points(const pass_job *job, const tl_parcel *of, tl_parcel_points *p)
{
    const tl_gridpoints *g = &job->zones->points;
    for (uint32_t k = of->point_begin; k < of->point_end; k++) {
        const uint32_t row = job->zones->listed[k], at = k - of->point_begin;
        for (int i = 0; i < 3; i++) {
            p->x[i][at] = g->ref[i][row] + g->u[i][row];
            p->way[i][at] = job->dt * g->moved[i][row];
        }
        job->zones->slot[k] = (tl_slot){.square = 0};
    }
}

static void pass_parcel(const pass_job *job, size_t parcel, tl_parcel_points *p)
{
    struct tl_zones *z = job->zones;
    const tl_parcel *of = &z->parcels.of[parcel];
    const tl_solid *solid = &z->solid[of->solid];
    const double bulk = solid->constrained - 4.0 / 3 * solid->shear;
    double work = 0, heat = 0, most = 0;
    list_points(job, of, p);
    for (uint32_t k = of->group_begin; k < of->group_end; k++) {
        const tl_zone_group *g = &z->group[k];
        group_rows r;
        double lost;
        most = tl_larger(most, strain_group(z, p, g, &r));
        if (solid->turns)
            turn_states(z, solid, g, &r);
        if (!call_solid(job, solid, g, &r, parcel))
            return;
        work += close_group(z, g, &r, &lost);
        heat += bulk > 0 ? 0.5 * lost / bulk : 0;
        for (size_t i = 0; i < (size_t)g->depth * TL_LANES; i++)
            heat += r.volume[i] * r.dissipated[i];
        push_group(z, g, &r, z->slot + of->point_begin);
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
        pass_parcel(job, parcel, &job->zones->scratch[thread]);
}

void tl_zones_pass(tl_model *m, double dt, tl_failure *failure)
{
    pass_job job = {m, m->zones, dt, failure};
    tl_parallel_for(m->pool, m->zones->parcels.table.rows, 1, pass_range, &job);
}
