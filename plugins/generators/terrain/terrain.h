/* terrain.h - the ground as a surface z(x, y) of triangles: of a file, by places, and clipped in the plan. */
#ifndef TERRAIN_TERRAIN_H
#define TERRAIN_TERRAIN_H

#include <stdbool.h>
#include <talus/kit.h>

/* Limit: bytes of a file. */
#define MOST_BYTES ((size_t)1 << 30)
/* Limit: m, of a coordinate, for shapes keep 1e-9 of their size. */
#define FARTHEST 1e9
/* Limit: rows and columns of a grid, and its nodes. */
#define MOST_LINES 1000000
#define MOST_NODES 100000000
/* Limit: corners of a triangle that three or four lines in the plan have clipped. */
#define MOST_CORNERS 8
/* Tolerance: relative, of lengths and areas that are sums of a few products: the roundings of coordinates. */
#define ROUNDINGS 1e-10

/* A triangle of the surface, its corners counter-clockwise in the plan, from the one with the least x, y, z on. */
typedef struct facet {
    tl_vec3 corner[3];
    tl_vec3 normal;     /* upward, of unit length */
    double fall[2];     /* dz/dx, dz/dy */
    uint32_t row, line; /* of a grid: row and column of its cell, from 1; of an STL: 0 and the triangle's number */
} facet;

/* A grid as the file has it: z[row * columns + column], the first row in the north; NaN where there is no data. */
typedef struct grid {
    uint32_t columns, rows;
    double x, y, dx, dy; /* the node in the south-west, and the distances of nodes */
    double *z;
} grid;

/* A polygon in the plan, counter-clockwise. */
typedef struct polygon {
    tl_flat at[MOST_CORNERS];
    uint32_t count;
} polygon;

typedef struct surface {
    const tl_host *host;
    const char *file;
    double scale; /* with `translate` it makes coordinates of the model of those of the file */
    tl_vec3 translate;
    facet *at;
    size_t count, capacity;
    grid grid;               /* without nodes where the file is an STL */
    uint32_t every;          /* rows and columns from node to node */
    double x, y, side;       /* cells of the plan that list facets: their corner in the south-west, and their side */
    uint32_t columns, rows;  /* of these cells */
    uint32_t *start, *facet; /* facets of cell k: facet[start[k]] .. facet[start[k + 1] - 1], ascending */
    uint8_t *seen;           /* [count] scratch of surface_list */
} surface;

/* Read the text of an ESRI ASCII grid, which ends in a zero byte, and an STL of `count` bytes. */
tl_status esri_read(const tl_host *host, const char *file, const char *text, grid *made);
tl_status stl_read(surface *s, const char *bytes, size_t count);

/* Adds a triangle, which it scales and moves. One that is vertical is refused. */
tl_status surface_add(surface *s, const tl_vec3 corner[3], uint32_t row, uint32_t line);
/* Makes the facets of the grid that may meet a box in the plan. */
tl_status surface_of_grid(surface *s, const tl_bounds *box);
/* Sorts the facets, lists them by places, and refuses those that lie one above the other. */
tl_status surface_index(surface *s);
/* Facets with an area in common with a box in the plan, ascending. `list` has room for `count` of the surface. */
size_t surface_list(surface *s, const tl_bounds *box, uint32_t *list);
/* Refuses a surface whose listed facets do not cover the box of a block in the plan. */
tl_status surface_covers(const surface *s, const tl_bounds *box, const uint32_t *list, size_t count);
void surface_free(surface *s);

double facet_height(const facet *f, tl_flat at);
/* The part of a facet in a box, in the plan: it has no corners where they have no area in common. */
polygon facet_in_box(const facet *f, const tl_bounds *box);
double polygon_area(const polygon *p);
/* How far, m, the least height of a facet's three is in the plan. */
double facet_width(const facet *f);

#endif
