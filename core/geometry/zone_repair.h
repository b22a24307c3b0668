/* zone_repair.h - points of zones are moved until no zone is flatter than it must be. */
#ifndef TL_GEOMETRY_ZONE_REPAIR_H
#define TL_GEOMETRY_ZONE_REPAIR_H

#include "geometry/zone_flips.h"
#include "geometry/zone_points.h"

/* Space that the next use has again. All zeros to begin with. */
typedef struct tl_zone_repair {
    uint32_t *first, *zone_of; /* zones of point i are zone_of[first[i] .. first[i + 1]) */
    double *share;             /* [zone] its least altitude over the wanted edge */
    size_t first_room, zone_of_room, share_room;
} tl_zone_repair;

/* Moves points inside, and those on free faces. Zones that stay flat give way to others. */
tl_status tl_zone_repair_make(tl_zone_repair *repair, tl_zone_points *points, tl_zone_lists *lists, tl_error *error);
void tl_zone_repair_free(tl_zone_repair *repair);

#endif
