/* convex.h - a plane polygon divided into convex parts (convex.c). */
#ifndef PRISM_CONVEX_H
#define PRISM_CONVEX_H

#include <talus/kit.h>

/* Edges that come closer than this times the polygon's extent without sharing a corner cross or touch, and corners so
 * close coincide: what is lost when coordinates are written with seven digits. */
#define CONVEX_FIT 1e-6

/* Part p has the corners corner[start[p]] .. corner[start[p + 1] - 1], counter-clockwise, as indices of the points
 * given. */
typedef struct convex_parts {
    size_t *corner, *start;
    size_t parts;
} convex_parts;

typedef enum convex_status {
    CONVEX_DONE,
    CONVEX_MEMORY,
    CONVEX_COINCIDE, /* points one and other, neighbours */
    CONVEX_CROSSES,  /* the edges that begin at one and other */
    CONVEX_EMPTY,    /* encloses no area */
    CONVEX_FAILED    /* should not happen: the parts found do not make up the polygon */
} convex_status;

/* Divides a polygon, given either way round, into convex parts that meet along whole edges; corners on a straight line
 * may be left out. A convex polygon is one part. On CONVEX_DONE free corner and start; otherwise there is nothing to
 * free. */
convex_status convex_divide(const tl_flat *at, size_t count, convex_parts *parts, size_t *one, size_t *other);

#endif
