/* zone_near.h - whether points that have been taken are near a place.
 *
 * Points come in levels, whose cells have half the side from one to the next. A cell holds a list. */
#ifndef TL_GEOMETRY_ZONE_NEAR_H
#define TL_GEOMETRY_ZONE_NEAR_H

#include <stdbool.h>
#include <stddef.h>
#include <talus/types.h>

/* All zeros to begin with; kept between uses. */
typedef struct tl_zone_near {
    double side; /* of a cell of level 0 */
    uint32_t count, levels;
    struct tl_near_point *point;
    uint32_t *first; /* [slots] */
    size_t point_room, first_room, slots;
} tl_zone_near;

/* Forgets all points; cells of level 0 have this side. */
bool tl_zone_near_begin(tl_zone_near *near, double side);
bool tl_zone_near_add(tl_zone_near *near, uint32_t level, tl_vec3 place);
/* Whether one lies nearer than a distance. */
bool tl_zone_near_any(const tl_zone_near *near, tl_vec3 place, double distance);
void tl_zone_near_free(tl_zone_near *near);

#endif
