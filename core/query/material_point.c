/* material_point.c - points of the material of deformable blocks, by the zones in which they lie. */
#include "base/error.h"
#include "query/zone_at.h"
#include "zone/grid.h"

#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

/* Weights of the corners of a zone at a place: the share of the volume that is left with the place for that corner. */
static void weigh(const tl_zone_at *at, tl_vec3 place, double weight[4])
{
    const double volume = tl_tetrahedron_volume(at->x);
    const tl_vec3 local = tl_v3_sub(place, at->m->origin);
    weight[0] = 1;
    for (int a = 1; a < 4; a++) {
        tl_vec3 x[4];
        memcpy(x, at->x, sizeof x);
        x[a] = local;
        weight[a] = tl_tetrahedron_volume(x) / volume;
        weight[0] -= weight[a];
    }
}

tl_status tl_material_point_at(tl_model *m, tl_vec3 place, tl_material_point *point)
{
    tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *names = NULL;
    size_t count;
    filter.containing = &place;
    tl_status status = tl_zones_select(m, &filter, &names, &count);
    if (status == TL_OK && count == 0)
        status =
            tl_fail(&m->error, TL_E_NOT_FOUND, "the point (%g, %g, %g) is in no zone of a visible deformable block",
                    place.x, place.y, place.z);
    uint32_t corner[1][4];
    if (status == TL_OK)
        status = tl_zones_corners(m, names, 1, corner);
    if (status == TL_OK) {
        const tl_body_mesh *mesh = &m->zones->mesh[tl_mesh_of(m, names[0].body)];
        const tl_zone_at at = tl_zone_at_number(m, mesh, names[0].number);
        point->zone = names[0];
        weigh(&at, place, point->weight);
        for (int a = 0; a < 4; a++)
            point->gridpoint[a] = (tl_zone_name){names[0].body, corner[0][a]};
    }
    free(names);
    return status;
}
