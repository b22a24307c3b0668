/* delaunay.h - tetrahedra of points, none of which lies in the sphere of a tetrahedron.
 *
 * The points lie on a grid and have weights (grid_signs.h). They may be any points, or those of a convex block whose
 * surface points are told. Points of one face then count as exactly flat. Their triangles are the Delaunay triangles of
 * the coordinates that they have in the face, so they depend on the face alone. */
#ifndef TL_GEOMETRY_DELAUNAY_H
#define TL_GEOMETRY_DELAUNAY_H

#include "base/error.h"
#include "geometry/grid_signs.h"

#include <stdbool.h>

/* The last corner of a ghost is this plus its face: a ghost stands for all that lies beyond a triangle of the hull. */
#define TL_GHOST 0x80000000u
/* The face of a ghost whose corners have none in common. */
#define TL_NO_FACE 0x7fffffffu
/* Limit: places of corners are numbered by 4 t + i in 32 bits, and ghosts are told by their highest bit. */
#define TL_DELAUNAY_MOST 0x3fffffffu

/* Corners 0, 1, 2 go counter-clockwise as seen from corner 3. So the volume is positive, and a ghost's triangle goes
 * counter-clockwise as seen from outside. Across the triangle opposite corner i lies tetrahedron next[i] / 4, whose
 * corner next[i] % 4 is opposite. */
typedef struct tl_tetrahedron {
    uint32_t corner[4]; /* UINT32_MAX in the first: none */
    uint32_t next[4];
} tl_tetrahedron;

/* A surface point in a face: coordinates of its plane, on a grid. */
typedef struct tl_in_face {
    uint32_t face;
    tl_site2 at;
} tl_in_face;

typedef struct tl_delaunay_points {
    uint32_t count;
    const tl_site *site; /* [count] */
    /* Of a block: its corners come first, then its other points on edges and faces. Else 0. */
    uint32_t corner_count, surface_count;
    const uint32_t *start;     /* [surface_count + 1] into in_face */
    const tl_in_face *in_face; /* each point's faces */
    bool flat; /* the faces count as exactly flat. Else as the grid has them, which must then make no face hollow */
    const signed char *turn; /* [face] 1: counter-clockwise in its coordinates is so as seen from outside; -1: not */
} tl_delaunay_points;

/* What is made, and space that the next use has again. All zeros to begin with. */
typedef struct tl_delaunay {
    tl_tetrahedron *tetrahedron; /* [used], some none, some ghosts */
    uint32_t used;
    uint32_t hidden; /* points left out: they repeat others, or are too light beside them */

    const tl_delaunay_points *points;
    size_t tetrahedron_room, mark_room, spare_room, cavity_room, border_room, passed_room, order_room, other_room;
    unsigned char *mark; /* [used] */
    uint32_t *spare, *cavity, *border, *passed;
    uint32_t spare_count, cavity_count, border_count, passed_count;
    uint64_t *order, *other; /* keys of the points by which they are put in, and their numbers */
    uint32_t last;
    uint32_t steps; /* of walks, which begin with another side each time */
} tl_delaunay;

/* TL_E_GEOMETRY for fewer than four points, points in one plane, and faces that are no faces of a convex block. */
tl_status tl_delaunay_make(tl_delaunay *d, const tl_delaunay_points *points, tl_error *error);
void tl_delaunay_free(tl_delaunay *d);

static inline bool tl_is_ghost(const tl_tetrahedron *t)
{
    return t->corner[3] >= TL_GHOST;
}
/* Whether a place holds a tetrahedron or ghost. */
static inline bool tl_is_there(const tl_tetrahedron *t)
{
    return t->corner[0] != UINT32_MAX;
}

#endif
