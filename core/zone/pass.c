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
#include "base/inline.h"
#include "base/solid_columns.h"

#include <string.h>
#include <talus/number.h>

/* Rows of a SIMD group. */
#define ROWS (TL_CLUSTER_MOST * TL_LANES)

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

/* ---------------------------------------------------------------- strain ----------------- */

/* The corners of a row of zones: places, and ways in the last step. */
typedef struct row_corners {
    _Alignas(TL_ALIGN) double x[4][3][TL_LANES];
    double way[4][3][TL_LANES];
} row_corners;

TL_INLINE void load_corners(const tl_parcel_points *p, uint16_t *const corner[4], size_t row, row_corners *restrict to)
{
    for (int a = 0; a < 4; a++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const double *from = p->of[corner[a][row + l]];
            for (int i = 0; i < 3; i++) {
                to->x[a][i][l] = from[i];
                to->way[a][i][l] = from[3 + i];
            }
        }
}

TL_INLINE tl_vec3 lane_of(double (*v)[TL_LANES], size_t l)
{
    return (tl_vec3){v[0][l], v[1][l], v[2][l]};
}

/* Q stress Q^T of one zone. */
TL_INLINE tl_sym3 turned(tl_sym3 s, tl_vec3 w)
{
    const double x = 0.5 * w.x, y = 0.5 * w.y, z = 0.5 * w.z, f = 2 / (1 + (x * x + y * y + z * z));
    const tl_vec3 a = {1 - f * (y * y + z * z), f * (x * y - z), f * (x * z + y)};
    const tl_vec3 b = {f * (x * y + z), 1 - f * (x * x + z * z), f * (y * z - x)};
    const tl_vec3 c = {f * (x * z - y), f * (y * z + x), 1 - f * (x * x + y * y)};
    const tl_vec3 row_x = {s.xx, s.xy, s.zx}, row_y = {s.xy, s.yy, s.yz}, row_z = {s.zx, s.yz, s.zz};
    const tl_vec3 p = {tl_v3_dot(a, row_x), tl_v3_dot(a, row_y), tl_v3_dot(a, row_z)};
    const tl_vec3 q = {tl_v3_dot(b, row_x), tl_v3_dot(b, row_y), tl_v3_dot(b, row_z)};
    const tl_vec3 t = {tl_v3_dot(c, row_x), tl_v3_dot(c, row_y), tl_v3_dot(c, row_z)};
    return (tl_sym3){.xx = tl_v3_dot(p, a),
                     .yy = tl_v3_dot(q, b),
                     .zz = tl_v3_dot(t, c),
                     .xy = tl_v3_dot(p, b),
                     .yz = tl_v3_dot(q, c),
                     .zx = tl_v3_dot(t, a)};
}

/* The zones of one row of a group: number k of their clusters. All of a zone in one go, so that it stays in
 * registers. */
TL_INLINE void strain_row(const struct tl_zones *z, const tl_parcel_points *p, const tl_zone_group *g, size_t k,
                          group_rows *restrict r)
{
    const size_t row = g->start + TL_LANES * k, at = TL_LANES * k;
    double *const *s = z->zones.stress;
    double *restrict sxx = s[0] + row, *restrict syy = s[1] + row, *restrict szz = s[2] + row;
    double *restrict sxy = s[3] + row, *restrict syz = s[4] + row, *restrict szx = s[5] + row;
    double factor[TL_LANES];
    row_corners c;
    load_corners(p, z->zones.corner, row, &c);
    for (size_t l = 0; l < TL_LANES; l++)
        factor[l] = k < g->count[l] ? 1.0 / 6 : 0;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 x0 = lane_of(c.x[0], l), w0 = lane_of(c.way[0], l);
        const tl_vec3 e1 = tl_v3_sub(lane_of(c.x[1], l), x0), e2 = tl_v3_sub(lane_of(c.x[2], l), x0);
        const tl_vec3 e3 = tl_v3_sub(lane_of(c.x[3], l), x0), w1 = tl_v3_sub(lane_of(c.way[1], l), w0);
        const tl_vec3 w2 = tl_v3_sub(lane_of(c.way[2], l), w0), w3 = tl_v3_sub(lane_of(c.way[3], l), w0);
        const tl_vec3 a1 = tl_v3_cross(e2, e3), a2 = tl_v3_cross(e3, e1), a3 = tl_v3_cross(e1, e2);
        r->area[0][0][at + l] = a1.x, r->area[0][1][at + l] = a1.y, r->area[0][2][at + l] = a1.z;
        r->area[1][0][at + l] = a2.x, r->area[1][1][at + l] = a2.y, r->area[1][2][at + l] = a2.z;
        r->area[2][0][at + l] = a3.x, r->area[2][1][at + l] = a3.y, r->area[2][2][at + l] = a3.z;
        r->volume[at + l] = factor[l] * tl_v3_dot(a1, e1);
        r->extent[at + l] = g->extent[l];
        const tl_vec3 m1 = tl_v3_madd(e1, -0.5, w1), m2 = tl_v3_madd(e2, -0.5, w2), m3 = tl_v3_madd(e3, -0.5, w3);
        const tl_vec3 b1 = tl_v3_cross(m2, m3), b2 = tl_v3_cross(m3, m1), b3 = tl_v3_cross(m1, m2);
        const double six = tl_v3_dot(b1, m1), per = 1 / six;
        const double dxy = per * (w1.x * b1.y + w2.x * b2.y + w3.x * b3.y);
        const double dyx = per * (w1.y * b1.x + w2.y * b2.x + w3.y * b3.x);
        const double dyz = per * (w1.y * b1.z + w2.y * b2.z + w3.y * b3.z);
        const double dzy = per * (w1.z * b1.y + w2.z * b2.y + w3.z * b3.y);
        const double dzx = per * (w1.z * b1.x + w2.z * b2.x + w3.z * b3.x);
        const double dxz = per * (w1.x * b1.z + w2.x * b2.z + w3.x * b3.z);
        r->middle[at + l] = factor[l] * six;
        r->strain[0][at + l] = per * (w1.x * b1.x + w2.x * b2.x + w3.x * b3.x);
        r->strain[1][at + l] = per * (w1.y * b1.y + w2.y * b2.y + w3.y * b3.y);
        r->strain[2][at + l] = per * (w1.z * b1.z + w2.z * b2.z + w3.z * b3.z);
        r->strain[3][at + l] = 0.5 * (dxy + dyx);
        r->strain[4][at + l] = 0.5 * (dyz + dzy);
        r->strain[5][at + l] = 0.5 * (dzx + dxz);
        const tl_vec3 spin = {0.5 * (dzy - dyz), 0.5 * (dxz - dzx), 0.5 * (dyx - dxy)};
        r->spin[0][at + l] = spin.x, r->spin[1][at + l] = spin.y, r->spin[2][at + l] = spin.z;
        const tl_sym3 was = {.xx = sxx[l], .yy = syy[l], .zz = szz[l], .xy = sxy[l], .yz = syz[l], .zx = szx[l]};
        const tl_sym3 now = turned(was, spin);
        r->before[0][at + l] = sxx[l] = now.xx;
        r->before[1][at + l] = syy[l] = now.yy;
        r->before[2][at + l] = szz[l] = now.zz;
        r->before[3][at + l] = sxy[l] = now.xy;
        r->before[4][at + l] = syz[l] = now.yz;
        r->before[5][at + l] = szx[l] = now.zx;
    }
}

/* ---------------------------------------------------------------- clusters --------------- */

/* Whether no zone is turned inside out. Rows that are inert have the volume 0. */
TL_INLINE bool is_outside_out(const tl_zone_group *g, const group_rows *restrict r)
{
    int bad[TL_LANES] = {0};
    for (size_t k = 0; k < g->depth; k++)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            const size_t i = TL_LANES * k + l;
            bad[l] |= (k < g->count[l]) & (!(r->volume[i] > 0) | !(r->middle[i] > 0));
        }
    int any = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        any |= bad[l];
    return any == 0;
}

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

/* false: a zone is turned inside out. `most`: the square of the largest strain. */
TL_VECTORIZED static bool strain_group(const struct tl_zones *z, const tl_parcel_points *p, const tl_zone_group *g,
                                       group_rows *r, double *most)
{
    for (size_t k = 0; k < g->depth; k++)
        strain_row(z, p, g, k, r);
    *most = share_volume(r, g->depth);
    return is_outside_out(g, r);
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

/* Q of the turn w. */
static tl_mat3 turn_of(tl_vec3 w)
{
    const double x = 0.5 * w.x, y = 0.5 * w.y, z = 0.5 * w.z, s = 2 / (1 + (x * x + y * y + z * z));
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
            p->of[at][i] = g->ref[i][row] + g->u[i][row];
            p->of[at][3 + i] = job->dt * g->moved[i][row];
        }
        job->zones->slot[k] = (tl_slot){{0}};
    }
}

/* Says which zone of a group is turned inside out. */
static void note_inside_out(const pass_job *job, const tl_parcel_points *p, const tl_zone_group *g, const group_rows *r,
                            size_t parcel)
{
    const tl_zone_table *t = &job->zones->zones;
    for (size_t i = 0; i < (size_t)g->depth * TL_LANES; i++) {
        const size_t row = g->start + i;
        if (t->number[row] == TL_NO_ROW || (r->volume[i] > 0 && r->middle[i] > 0))
            continue;
        tl_vec3 at = job->m->origin;
        for (int a = 0; a < 4; a++) {
            const double *x = p->of[t->corner[a][row]];
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
        double lost, strain2;
        memset(r.dissipated, 0, sizeof r.dissipated);
        if (!strain_group(z, p, g, &r, &strain2)) {
            note_inside_out(job, p, g, &r, parcel);
            return;
        }
        most = tl_larger(most, strain2);
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
