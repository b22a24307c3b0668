/* zone_flips.h - flat zones give way to others of the same points. */
#ifndef TL_GEOMETRY_ZONE_FLIPS_H
#define TL_GEOMETRY_ZONE_FLIPS_H

#include "geometry/zone_points.h"

/* Zones while they are made. Arrays are kept between blocks; all zeros to begin with. */
typedef struct tl_zone_lists {
    uint32_t (*zone)[4];   /* corners */
    uint32_t (*beside)[4]; /* the zone opposite each corner; UINT32_MAX: none */
    uint32_t count;
    size_t zone_room, beside_room;
} tl_zone_lists;

bool tl_zone_lists_room(tl_zone_lists *lists, uint32_t count);
void tl_zone_lists_free(tl_zone_lists *lists);

/* Gives zones whose share is below `limit` other edges and sides where that makes the worst of them better. The surface
 * stays. *flips is how many were made; zones are then numbered anew. False when out of memory. */
bool tl_zone_flips_make(const tl_zone_points *points, tl_zone_lists *lists, double limit, uint32_t *flips);

/* Gives zones whose share is below `limit` a point more inside the block, near the middle of an edge. That must make
 * the worst of the zones around the edge much better. *splits is how many. False when out of memory. */
bool tl_zone_splits_make(tl_zone_points *points, tl_zone_lists *lists, double limit, uint32_t *splits);

#endif
