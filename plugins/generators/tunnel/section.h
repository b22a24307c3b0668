/* section.h - the section of a tunnel as a plane polygon. */
#ifndef TUNNEL_SECTION_H
#define TUNNEL_SECTION_H

#include <stdbool.h>
#include <talus/types.h>

/* Corners are given with six digits or more: places closer than this times the size of the tunnel are the
 * same, and what is bent by less is flat. */
#define FIT 1e-6

typedef struct flat {
    double x, y;
} flat;

/* The polygon of one end in its own plane. */
typedef struct outline {
    flat *at; /* [count], counter-clockwise as seen against the normal */
    size_t count;
    tl_vec3 normal; /* of unit length */
    tl_vec3 middle; /* mean of the corners */
    double area;
    double spread; /* of the largest triangle of the middle and two corners */
    double bend;   /* largest distance of a corner from the plane */
} outline;

/* Convex parts that make up a polygon: part p has the corners corner[start[p]] .. corner[start[p + 1]]. */
typedef struct division {
    size_t *corner, *start;
    size_t parts;
} division;

/* Lays corners into the plane that fits them; false without memory. Corners on one line have
 * the spread 0 and no normal. Free `at`. */
bool outline_make(const tl_vec3 *corners, size_t count, outline *made);

/* The first two edges (counted from 0) that come closer than `near` though they share no corner, or that
 * fold back on each other. */
bool outline_crosses(const outline *section, double near, size_t *one, size_t *other);

/* Divides a polygon that does not cross itself into convex parts; a convex one is left whole with its
 * corners in order. False without memory. Free `corner` and `start`. */
bool outline_divide(const outline *section, double near, division *parts);

#endif
