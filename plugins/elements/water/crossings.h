/* crossings.h - where wet joints meet. */
#ifndef WATER_CROSSINGS_H
#define WATER_CROSSINGS_H

#include <talus/kit.h>

/* Polygons of wet joints, halfway between their walls. */
typedef struct flow_polygons {
    const tl_vec3 *corner;
    const uint32_t *first; /* [count + 1] */
    const double *slack;   /* m: so far from where they meet may their sides lie */
    size_t count;
} flow_polygons;

/* A part of a side, from the share `from` of its length on to the next part. */
typedef struct flow_piece {
    double from;
    uint32_t crossing;
} flow_piece;

/* Sides of all polygons, cut where another joint begins or ends: side k, from corner k to the next one of its polygon,
 * has the pieces first[k] .. first[k + 1]. */
typedef struct flow_crossings {
    flow_piece *piece;
    uint32_t *first;
    size_t count; /* of crossings */
} flow_crossings;

/* false: out of memory. flow_crossings_free in any case. */
bool flow_crossings_find(const flow_polygons *of, flow_crossings *found);
void flow_crossings_free(flow_crossings *found);

#endif
