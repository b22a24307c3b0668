/* zone_places.h - places that are numbered: those that are near each other count as one. */
#ifndef TL_GEOMETRY_ZONE_PLACES_H
#define TL_GEOMETRY_ZONE_PLACES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <talus/types.h>

typedef struct tl_zone_places {
    tl_vec3 *at;
    uint32_t count;
    double near; /* nearer than this to one that is there a place is no new one */
    /* the last place of each bucket, and the one before each in its bucket; UINT32_MAX: none */
    uint32_t *last, *before;
    size_t at_room, before_room, buckets;
} tl_zone_places;

/* The number of a place, which is put in unless one near it is there; UINT32_MAX: out of memory. `places` begins with
 * zeros and `near`. */
uint32_t tl_zone_places_put(tl_zone_places *places, tl_vec3 at);
void tl_zone_places_free(tl_zone_places *places);

#endif
