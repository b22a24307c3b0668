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
 * A corner bears at the most sum |f| <= sqrt(n sum f^2) of n zones. That is what rest compares forces with: it needs no
 * root for each zone. */
#include "zone/pass.h"

#include "base/extremes.h"
#include "base/inline.h"
#include "base/solid_columns.h"

#include <string.h>

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
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++)
            to->of[i][l] = from[i][corner[l]];
}

TL_INLINE void take(lanes3 *from, const lanes3 *other)
{
    for (int i = 0; i < 3; i++)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++)
            from->of[i][l] -= other->of[i][l];
}

TL_INLINE void cross(lanes3 *out, const lanes3 *a, const lanes3 *b)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        out->of[0][l] = a->of[1][l] * b->of[2][l] - a->of[2][l] * b->of[1][l];
        out->of[1][l] = a->of[2][l] * b->of[0][l] - a->of[0][l] * b->of[2][l];
        out->of[2][l] = a->of[0][l] * b->of[1][l] - a->of[1][l] * b->of[0][l];
    }
}

/* Q of the turn w. */
static tl_mat3 turn_of(tl_vec3 w)
{
    const double x = 0.5 * w.x, y = 0.5 * w.y, z = 0.5 * w.z, s = 2 / (1 + (x * x + y * y + z * z));
    return (tl_mat3){{{1 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y)},
                      {s * (x * y + z), 1 - s * (x * x + z * z), s * (y * z - x)},
                      {s * (x * z - y), s * (y * z + x), 1 - s * (x * x + y * y)}}};
}

/* Turns the stresses of a row of zones: Q stress Q^T, with rows of Q stress on the way. */
TL_INLINE void turn_row(double *const stress[6], size_t row, size_t at, group_rows *restrict r)
{
    const double *restrict sxx = stress[0] + row, *restrict syy = stress[1] + row, *restrict szz = stress[2] + row;
    const double *restrict sxy = stress[3] + row, *restrict syz = stress[4] + row, *restrict szx = stress[5] + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double x = 0.5 * r->spin[0][at + l], y = 0.5 * r->spin[1][at + l], z = 0.5 * r->spin[2][at + l];
        const double s = 2 / (1 + (x * x + y * y + z * z));
        const double a0 = 1 - s * (y * y + z * z), a1 = s * (x * y - z), a2 = s * (x * z + y);
        const double b0 = s * (x * y + z), b1 = 1 - s * (x * x + z * z), b2 = s * (y * z - x);
        const double c0 = s * (x * z - y), c1 = s * (y * z + x), c2 = 1 - s * (x * x + y * y);
        const double xx = sxx[l], yy = syy[l], zz = szz[l], xy = sxy[l], yz = syz[l], zx = szx[l];
        const double p0 = a0 * xx + a1 * xy + a2 * zx, p1 = a0 * xy + a1 * yy + a2 * yz,
                     p2 = a0 * zx + a1 * yz + a2 * zz;
        const double q0 = b0 * xx + b1 * xy + b2 * zx, q1 = b0 * xy + b1 * yy + b2 * yz,
                     q2 = b0 * zx + b1 * yz + b2 * zz;
        const double t0 = c0 * xx + c1 * xy + c2 * zx, t1 = c0 * xy + c1 * yy + c2 * yz,
                     t2 = c0 * zx + c1 * yz + c2 * zz;
        r->before[0][at + l] = p0 * a0 + p1 * a1 + p2 * a2;
        r->before[1][at + l] = q0 * b0 + q1 * b1 + q2 * b2;
        r->before[2][at + l] = t0 * c0 + t1 * c1 + t2 * c2;
        r->before[3][at + l] = p0 * b0 + p1 * b1 + p2 * b2;
        r->before[4][at + l] = q0 * c0 + q1 * c1 + q2 * c2;
        r->before[5][at + l] = t0 * a0 + t1 * a1 + t2 * a2;
    }
}

/* The zones of one row of a group: number k of their clusters. */
TL_INLINE void strain_row(const struct tl_zones *z, const tl_parcel_points *p, const tl_zone_group *g, size_t k,
                          group_rows *restrict r)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    uint16_t *const *corner = z->zones.corner;
    lanes3 x0, way0, edge[3], way[3], mid[3], area[3];
    double factor[TL_LANES], per[TL_LANES], d[3][3][TL_LANES];
    load(&x0, p->x, corner[0] + row);
    load(&way0, p->way, corner[0] + row);
    for (int a = 0; a < 3; a++) {
        load(&edge[a], p->x, corner[a + 1] + row);
        load(&way[a], p->way, corner[a + 1] + row);
        take(&edge[a], &x0);
        take(&way[a], &way0);
        for (int i = 0; i < 3; i++)
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++)
                mid[a].of[i][l] = edge[a].of[i][l] - 0.5 * way[a].of[i][l];
    }
    for (int a = 0; a < 3; a++) {
        cross(&area[a], &edge[(a + 1) % 3], &edge[(a + 2) % 3]);
        for (int i = 0; i < 3; i++)
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++)
                r->area[a][i][at + l] = area[a].of[i][l];
    }
    for (size_t l = 0; l < TL_LANES; l++)
        factor[l] = k < g->count[l] ? 1.0 / 6 : 0;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        r->volume[at + l] = factor[l] * (area[0].of[0][l] * edge[0].of[0][l] + area[0].of[1][l] * edge[0].of[1][l] +
                                         area[0].of[2][l] * edge[0].of[2][l]);
        r->extent[at + l] = g->extent[l];
    }
    for (int a = 0; a < 3; a++)
        cross(&area[a], &mid[(a + 1) % 3], &mid[(a + 2) % 3]);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double six = area[0].of[0][l] * mid[0].of[0][l] + area[0].of[1][l] * mid[0].of[1][l] +
                           area[0].of[2][l] * mid[0].of[2][l];
        r->middle[at + l] = factor[l] * six;
        per[l] = 1 / six;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++)
                d[i][j][l] = per[l] * (way[0].of[i][l] * area[0].of[j][l] + way[1].of[i][l] * area[1].of[j][l] +
                                       way[2].of[i][l] * area[2].of[j][l]);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        r->strain[0][at + l] = d[0][0][l];
        r->strain[1][at + l] = d[1][1][l];
        r->strain[2][at + l] = d[2][2][l];
        r->strain[3][at + l] = 0.5 * (d[0][1][l] + d[1][0][l]);
        r->strain[4][at + l] = 0.5 * (d[1][2][l] + d[2][1][l]);
        r->strain[5][at + l] = 0.5 * (d[2][0][l] + d[0][2][l]);
        r->spin[0][at + l] = 0.5 * (d[2][1][l] - d[1][2][l]);
        r->spin[1][at + l] = 0.5 * (d[0][2][l] - d[2][0][l]);
        r->spin[2][at + l] = 0.5 * (d[1][0][l] - d[0][1][l]);
    }
    turn_row(z->zones.stress, row, at, r);
}

/* ---------------------------------------------------------------- clusters --------------- */

/* Each zone gets the mean change of volume of its cluster. The square of the largest strain. */
TL_INLINE double share_volume(group_rows *restrict r, size_t depth)
{
    double sum[TL_LANES] = {0}, all[TL_LANES] = {0}, most[TL_LANES] = {0};
    for (size_t k = 0; k < depth; k++)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l;
            sum[l] += r->middle[i] * (r->strain[0][i] + r->strain[1][i] + r->strain[2][i]);
            all[l] += r->middle[i];
        }
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++)
        sum[l] /= all[l] != 0 ? all[l] : 1;
    for (size_t k = 0; k < depth; k++)
#pragma omp simd
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
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l, j = row + i;
            const double change =
                (stress[0][j] - r->before[0][i]) + (stress[1][j] - r->before[1][i]) + (stress[2][j] - r->before[2][i]);
            sum[l] += r->volume[i] * change;
            all[l] += r->volume[i];
        }
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++)
        sum[l] /= all[l] != 0 ? all[l] : 1;
    for (size_t k = 0; k < depth; k++)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l, j = row + i;
            const double change =
                (stress[0][j] - r->before[0][i]) + (stress[1][j] - r->before[1][i]) + (stress[2][j] - r->before[2][i]);
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
#pragma omp simd
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

/* What a zone does to a corner: three components and the square of the size. */
typedef struct push {
    _Alignas(4 * sizeof(double)) double of[4][TL_LANES][4]; /* of each corner */
} push;

/* Forces on corner a, 1 to 3, of one row of zones: the stress, by -1/6, times the vector area. */
TL_INLINE void push_corner(double *const stress[6], size_t row, const double factor[TL_LANES], int a,
                           const group_rows *restrict r, size_t at, push *restrict out)
{
    const double *restrict sxx = stress[0] + row, *restrict syy = stress[1] + row, *restrict szz = stress[2] + row;
    const double *restrict sxy = stress[3] + row, *restrict syz = stress[4] + row, *restrict szx = stress[5] + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double x = -factor[l] * r->area[a - 1][0][at + l], y = -factor[l] * r->area[a - 1][1][at + l];
        const double z = -factor[l] * r->area[a - 1][2][at + l];
        const double fx = sxx[l] * x + sxy[l] * y + szx[l] * z, fy = sxy[l] * x + syy[l] * y + syz[l] * z;
        const double fz = szx[l] * x + syz[l] * y + szz[l] * z;
        out->of[a][l][0] = fx;
        out->of[a][l][1] = fy;
        out->of[a][l][2] = fz;
        out->of[a][l][3] = fx * fx + fy * fy + fz * fz;
    }
}

/* Adds the forces of one row of zones to the slots, lane by lane, corner by corner. */
TL_INLINE void push_row(const struct tl_zones *z, const tl_zone_group *g, size_t k, const group_rows *restrict r,
                        tl_slot *restrict slots)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    double factor[TL_LANES];
    push by;
    for (size_t l = 0; l < TL_LANES; l++)
        factor[l] = k < g->count[l] ? 1.0 / 6 : 0;
    for (int a = 1; a < 4; a++)
        push_corner(z->zones.stress, row, factor, a, r, at, &by);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double fx = -(by.of[1][l][0] + by.of[2][l][0] + by.of[3][l][0]);
        const double fy = -(by.of[1][l][1] + by.of[2][l][1] + by.of[3][l][1]);
        const double fz = -(by.of[1][l][2] + by.of[2][l][2] + by.of[3][l][2]);
        by.of[0][l][0] = fx;
        by.of[0][l][1] = fy;
        by.of[0][l][2] = fz;
        by.of[0][l][3] = fx * fx + fy * fy + fz * fz;
    }
    for (size_t l = 0; l < TL_LANES; l++)
        for (int a = 0; a < 4; a++) {
            double *restrict sum = slots[z->zones.corner[a][row + l]].of;
            const double *restrict add = by.of[a][l];
#pragma omp simd
            for (int i = 0; i < 4; i++)
                sum[i] += add[i];
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
            const uint32_t form = tl_solid_state(kind, k)->kind;
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
    tl_report report;
    const tl_status status = tl_solid_update(solid, &batch, &report);
    if (status != TL_OK)
        tl_failure_note(job->failure, parcel, status, g->start, tl_report_text(&report, status));
    return status == TL_OK;
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
        job->zones->slot[k] = (tl_slot){{0}};
    }
}

static void pass_parcel(const pass_job *job, size_t parcel, tl_parcel_points *p)
{
    struct tl_zones *z = job->zones;
    const tl_parcel *of = &z->parcels.of[parcel];
    const tl_named_solid *named = &z->solid[of->solid];
    const tl_solid *solid = &named->of;
    const double bulk = solid->constrained - 4.0 / 3 * solid->shear;
    double work = 0, heat = 0, most = 0;
    list_points(job, of, p);
    for (uint32_t k = of->group_begin; k < of->group_end; k++) {
        const tl_zone_group *g = &z->group[k];
        group_rows r;
        double lost;
        memset(r.dissipated, 0, sizeof r.dissipated);
        most = tl_larger(most, strain_group(z, p, g, &r));
        if (named->turns)
            turn_states(z, solid->kind, g, &r);
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
