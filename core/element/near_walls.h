/* near_walls.h - of the walls that a wall faces in one place, the nearest: rock lies before those behind it. */
#ifndef TL_ELEMENT_NEAR_WALLS_H
#define TL_ELEMENT_NEAR_WALLS_H

#include "element/placing.h"
#include "geometry/point2.h"

/* Tolerance: area of a polygon over the square of its smaller block's size, below which it is none: an edge on an edge.
 * Test: lua/test_water. */
#define TL_WALL_NO_AREA 1e-9

/* Tolerance: area that is no wall, for rock lies before it or in its place, over the square of its block's size. Less
 * than that stays a wall: blocks side by side press into each other by less than the way after which polygons are found
 * again. Test: lua/test_drawdown, lua/test_water_between. */
#define TL_WALL_LEAST_HIDDEN 1e-3

/* A flat wall of a block, from the model's origin, counter-clockwise from outside. */
typedef struct tl_flat {
    tl_id block;
    uint32_t row, face;
    tl_tag tag;
    tl_plane plane;
    size_t corner, count; /* in the list of corners */
} tl_flat;

/* All walls, block by block, and boxes about blocks. */
typedef struct tl_flats {
    const tl_model *m;
    tl_flat *at;
    tl_vec3 *corner;
    size_t count, capacity, corner_count, corner_capacity;
    size_t *first;  /* [blocks + 1] */
    tl_bounds *box; /* [blocks] */
    tl_point2 *point[4];
    size_t point_capacity[4];
} tl_flats;

/* How far a line along n from a point on a block's wall goes on inside of it: to the nearest wall that it leaves by. */
double tl_flats_depth(const tl_flats *f, uint32_t row, tl_vec3 x, tl_vec3 n);

/* Of the walls of p a polygon: which walls of blocks its sides are, and whether it is asked for. */
typedef struct tl_wall_sides {
    size_t flat[2];
    bool meant;
} tl_wall_sides;

/* Takes from each polygon what has rock before it on either side, and polygons that are not asked for. What
 * is left is convex: where a polygon loses its middle, several take its place. The lists of corners are those of
 * p->wall_corner, wall by wall. false: out of memory. */
bool tl_walls_keep_near(tl_placing *p, const tl_flats *flats, const tl_wall_sides *sides);

#endif
