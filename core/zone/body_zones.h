/* body_zones.h - the zones of a body on their way into the tables: those of all its blocks. */
#ifndef TL_ZONE_BODY_ZONES_H
#define TL_ZONE_BODY_ZONES_H

#include "geometry/zoning.h"
#include "zone/corner_keys.h"
#include "zone/grid.h"

typedef struct tl_body_zones {
    tl_vec3 *point; /* in the coordinates of the body */
    uint32_t point_count;
    uint32_t (*zone)[4];
    uint32_t zone_count;
    uint32_t *cluster_start, *cluster_zone;
    uint32_t cluster_count;
    tl_surface_part *surface; /* by block and face */
    size_t surface_count;
    tl_grid_block *block;
    size_t block_count;
    double least_altitude, least_share;
    tl_id worst; /* the block that has the least share */
} tl_body_zones;

/* Divides the blocks of a body. Of several, those that lie on each other share gridpoints there. `zoning` tells the
 * wanted edge. Nothing of the model changes. Free *zones in any case. */
tl_status tl_body_zones_make(tl_model *m, uint32_t body, const tl_shape_zoning *zoning, const tl_corner_keys *keys,
                             tl_zone_scratch *scratch, tl_body_zones *zones);
/* The same of meshes that its blocks have already, by rows, which go over. Of several blocks the triangles of what they
 * have in common must be those of both. */
tl_status tl_body_zones_take(tl_model *m, uint32_t body, tl_zone_mesh *mesh, tl_body_zones *zones);
void tl_body_zones_free(tl_body_zones *zones);

#endif
