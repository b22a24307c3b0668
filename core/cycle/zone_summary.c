/* zone_summary.c - what a model has of deformable blocks: how many zones, and how flat the flattest is. */
#include "segment/segments.h"
#include "zone/zones.h"

#include <math.h>
#include <talus/zones.h>

/* The altitude of a zone over its largest side: three volumes over the area of that. */
static double altitude_of(const struct tl_zones *z, const tl_parcel *of, size_t row)
{
    tl_vec3 x[4];
    double largest = 0;
    for (int a = 0; a < 4; a++)
        x[a] = tl_gridpoint_place(&z->points, z->listed[of->point_begin + z->zones.corner[a][row]]);
    for (int a = 0; a < 4; a++) {
        const tl_vec3 b = x[(a + 1) % 4], c = tl_v3_sub(x[(a + 2) % 4], b), d = tl_v3_sub(x[(a + 3) % 4], b);
        largest = fmax(largest, tl_v3_norm(tl_v3_cross(c, d)));
    }
    const tl_vec3 b = tl_v3_sub(x[1], x[0]), c = tl_v3_sub(x[2], x[0]), d = tl_v3_sub(x[3], x[0]);
    return tl_v3_dot(b, tl_v3_cross(c, d)) / largest;
}

static void add_parcel(const struct tl_zones *z, const tl_parcel *of, tl_zone_summary *all)
{
    for (uint32_t g = of->group_begin; g < of->group_end; g++) {
        const tl_zone_group *group = &z->group[g];
        for (size_t l = 0; l < TL_LANES; l++)
            all->clusters += group->count[l] > 0;
        for (size_t row = group->start; row < group->start + (size_t)group->depth * TL_LANES; row++) {
            const double altitude = z->zones.number[row] != TL_NO_ROW ? altitude_of(z, of, row) : NAN;
            if (!isnan(altitude) && !(altitude >= all->least_altitude)) {
                all->least_altitude = altitude;
                all->worst = of->block;
            }
        }
    }
}

tl_zone_summary tl_model_zone_summary(const tl_model *m)
{
    tl_zone_summary all = {.least_altitude = NAN, .worst = TL_NO_ID};
    const struct tl_zones *z = m->zones;
    for (size_t row = 0; row < m->blocks.table.rows; row++)
        all.blocks += tl_block_deforms(m, (uint32_t)row);
    for (size_t k = 0; z && k < z->mesh_count; k++) {
        all.zones += z->mesh[k].zone_end - z->mesh[k].zone_begin;
        all.gridpoints += z->mesh[k].point_end - z->mesh[k].point_begin;
    }
    for (size_t k = 0; z && k < z->parcels.table.rows; k++)
        add_parcel(z, &z->parcels.of[k], &all);
    for (size_t k = 0; m->segments && k < m->segments->table.table.rows; k++)
        all.segments += m->segments->table.of[k].meet != TL_NO_ROW;
    return all;
}
