/* zone_at.c - a zone where it is: its volume, centroid, stress and strain, and means of them over a mesh. */
#include "query/zone_at.h"

#include "base/columns.h"
#include "geometry/measure.h"

#include <math.h>
#include <talus/elementary.h>

/* The parcel that has a row: they ascend. */
static const tl_parcel *parcel_of(const struct tl_zones *z, const tl_body_mesh *mesh, uint32_t row)
{
    uint32_t low = mesh->parcel_begin, high = mesh->parcel_end;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (z->group[z->parcels.of[middle].group_begin].start <= row)
            low = middle;
        else
            high = middle;
    }
    return &z->parcels.of[low];
}

tl_zone_at tl_zone_at_number(const tl_model *m, const tl_body_mesh *mesh, uint32_t number)
{
    const struct tl_zones *z = m->zones;
    tl_zone_at at = {.m = m, .mesh = mesh, .row = z->row_of[mesh->zone_begin + number]};
    at.parcel = parcel_of(z, mesh, at.row);
    for (int a = 0; a < 4; a++) {
        const uint32_t point = z->listed[at.parcel->point_begin + z->zones.corner[a][at.row]];
        at.x[a] = tl_gridpoint_place(&z->points, point);
        at.ref[a] = tl_columns_get(z->points.ref, point);
    }
    return at;
}

tl_vec3 tl_zone_centroid(const tl_zone_at *at)
{
    const tl_vec3 sum = tl_v3_add(tl_v3_add(at->x[0], at->x[1]), tl_v3_add(at->x[2], at->x[3]));
    return tl_v3_madd(at->m->origin, 0.25, sum);
}

tl_sym3 tl_zone_stress(const tl_zone_at *at)
{
    double *const *s = at->m->zones->zones.stress;
    const uint32_t row = at->row;
    return (tl_sym3){s[0][row], s[1][row], s[2][row], s[3][row], s[4][row], s[5][row]};
}

/* How the zone has stretched and turned since it was made: edges now by those then. */
static tl_mat3 gradient_of(const tl_zone_at *at)
{
    tl_mat3 f = {{{0}}};
    const double six = 6 * tl_tetrahedron_volume(at->ref);
    tl_vec3 e[3], r[3];
    for (int a = 0; a < 3; a++) {
        e[a] = tl_v3_sub(at->x[a + 1], at->x[0]);
        r[a] = tl_v3_sub(at->ref[a + 1], at->ref[0]);
    }
    for (int a = 0; a < 3; a++) {
        const tl_vec3 g = tl_v3_scale(1 / six, tl_v3_cross(r[(a + 1) % 3], r[(a + 2) % 3]));
        const double x[3] = {e[a].x, e[a].y, e[a].z}, y[3] = {g.x, g.y, g.z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f.m[i][j] += x[i] * y[j];
    }
    return f;
}

/* A tensor of principal values about axes. */
static tl_sym3 about(tl_quat axes, const double value[3])
{
    const tl_mat3 q = tl_q_matrix(axes);
    double t[3][3] = {{0}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                t[i][j] += value[k] * q.m[i][k] * q.m[j][k];
    return (tl_sym3){t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[2][0]};
}

/* Logarithmic strain, ln V of F = V R, in the axes of the model. */
tl_sym3 tl_zone_strain(const tl_zone_at *at)
{
    const tl_mat3 f = gradient_of(at);
    double b[3][3] = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                b[i][j] += f.m[i][k] * f.m[j][k];
    tl_vec3 squares;
    tl_quat axes;
    tl_principal_axes((tl_sym3){b[0][0], b[1][1], b[2][2], b[0][1], b[1][2], b[2][0]}, &squares, &axes);
    const double ln[3] = {0.5 * tl_log1p(squares.x - 1), 0.5 * tl_log1p(squares.y - 1), 0.5 * tl_log1p(squares.z - 1)};
    return about(axes, ln);
}

tl_sym3 tl_mesh_mean(const tl_model *m, const tl_body_mesh *mesh, tl_id block, tl_sym3 (*of)(const tl_zone_at *))
{
    tl_sym3 sum = {0, 0, 0, 0, 0, 0};
    double volume = 0;
    for (uint32_t k = 0; mesh && k < mesh->zone_end - mesh->zone_begin; k++) {
        const tl_zone_at at = tl_zone_at_number(m, mesh, k);
        if (at.parcel->block != block)
            continue;
        const double own = tl_tetrahedron_volume(at.x);
        const tl_sym3 t = of(&at);
        volume += own;
        sum = (tl_sym3){sum.xx + own * t.xx, sum.yy + own * t.yy, sum.zz + own * t.zz,
                        sum.xy + own * t.xy, sum.yz + own * t.yz, sum.zx + own * t.zx};
    }
    const double share = volume > 0 ? 1 / volume : NAN;
    return (tl_sym3){share * sum.xx, share * sum.yy, share * sum.zz, share * sum.xy, share * sum.yz, share * sum.zx};
}
