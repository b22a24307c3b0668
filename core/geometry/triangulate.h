/* triangulate.h - the triangulated hull of points on a grid, for hull.c only. */
#ifndef TL_GEOMETRY_TRIANGULATE_H
#define TL_GEOMETRY_TRIANGULATE_H

#include <stdbool.h>
#include <stdint.h>

/* Tolerance: grid coordinates lie in [0, 2^TL_HULL_BITS]. The grid is finer than TL_POLY_ON and coarser than rounding,
 * and hulls are exact on it. */
#define TL_HULL_BITS 40

typedef struct tl_hull_triangle {
    uint32_t vertex[3];   /* counter-clockwise from outside */
    uint32_t adjacent[3]; /* triangle across the side from vertex i to the next */
    double normal[3];     /* area vector in grid units, rounded */
    uint32_t face;        /* for the caller */
    bool alive, visible;
} tl_hull_triangle;

typedef struct tl_hull_edge {
    uint32_t a, b;     /* as the triangle taken away had it */
    uint32_t beyond;   /* triangle on the other side ... */
    int side;          /* ... and its side along this edge */
    uint32_t triangle; /* the new one on this side */
} tl_hull_edge;

/* Working space; the caller provides the arrays. */
typedef struct tl_hull {
    uint32_t count;             /* points */
    int64_t (*grid)[3];         /* [count] */
    bool *duplicate;            /* [count] points to leave out */
    tl_hull_triangle *triangle; /* [2 count] */
    uint32_t *free;             /* [2 count] dead triangles */
    tl_hull_edge *horizon;      /* [count] */
    uint32_t *at;               /* [count] horizon edge that starts in a point */
    uint32_t triangle_count, free_count;
} tl_hull;

/* The hull of the points that are no duplicates. `corner` are four points that span a volume. */
void tl_hull_triangulate(tl_hull *hull, const uint32_t corner[4]);

#endif
