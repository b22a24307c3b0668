/* block_zones.h - the zones of one block on their way into the tables: mesh, clusters, surface. */
#ifndef TL_ZONE_BLOCK_ZONES_H
#define TL_ZONE_BLOCK_ZONES_H

#include "geometry/zoning.h"
#include "zone/zones.h"

typedef struct tl_block_zones {
    tl_id block;
    tl_zone_mesh mesh; /* in the coordinates of the block's body */
    tl_zone_clusters clusters;
    tl_surface_part *surface; /* corners are numbers of the mesh's points */
    uint32_t surface_count;
} tl_block_zones;

/* Divides a block of this shape. No triangle of a face with inside[face] is of the surface; NULL: all are. Sentences
 * begin with the block. Free *zones in any case. */
tl_status tl_block_zones_make(tl_block_zones *zones, tl_id block, const tl_poly *shape, const tl_shape_zoning *zoning,
                              const uint8_t *inside, tl_zone_scratch *scratch, tl_error *error);
/* The same of zones that are there already, which go over: without the surface, which tl_block_zones_surface lists. */
tl_status tl_block_zones_take(tl_block_zones *zones, tl_id block, tl_zone_mesh *mesh, tl_error *error);
tl_status tl_block_zones_surface(tl_block_zones *zones, tl_error *error);
void tl_block_zones_free(tl_block_zones *zones);

#endif
