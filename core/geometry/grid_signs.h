/* grid_signs.h - on which side of a plane, of a sphere, of a circle a point is, exactly.
 *
 * Points lie on a grid: their coordinates are whole numbers from 0 to 2^TL_GRID_BITS, kept as doubles. A product of
 * doubles decides where its rounding cannot matter, whole numbers of 128 and 256 bits where it may.
 *
 * Each point has a weight w, the square of a length. A point p is inside the sphere of four others when its power is
 * less than theirs:
 *
 *     |x - c|^2 - w < r^2   where   |x_i - c|^2 - w_i = r^2   at the four
 *
 * Weights of 0 make that the common sphere. Small ones decide among points that lie on one, and always alike. */
#ifndef TL_GEOMETRY_GRID_SIGNS_H
#define TL_GEOMETRY_GRID_SIGNS_H

#include "base/inline.h"

#include <math.h>

#define TL_GRID_BITS 40
/* Limit: weights on the grid, whole numbers, too. */
#define TL_GRID_HEAVIEST 0x1p70

/* Tolerance: bound of the rounding of each product of doubles, as a part of the largest terms. The terms are six,
 * twenty-four and twelve. Each passes through at most 7, 15 and 11 roundings. */
#define TL_ORIENT_BOUND 1e-14
#define TL_SPHERE_BOUND 1e-13
#define TL_CIRCLE_BOUND 5e-14

typedef struct tl_site {
    double x, y, z;
    double weight;
} tl_site;

/* A point of a plane. */
typedef struct tl_site2 {
    double x, y;
    double weight;
} tl_site2;

/* The same by whole numbers alone. */
int tl_orient_exactly(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d);
int tl_sphere_exactly(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d, const tl_site *p);
int tl_circle_exactly(const tl_site2 *a, const tl_site2 *b, const tl_site2 *c, const tl_site2 *p);

TL_INLINE double tl_larger(double a, double b)
{
    return a > b ? a : b;
}

TL_INLINE double tl_farthest(double a, double b, double c)
{
    return tl_larger(tl_larger(fabs(a), fabs(b)), fabs(c));
}

/* The sign of (b - a) . ((c - a) x (d - a)): 1 where d lies over the triangle a, b, c as one sees it counter-clockwise.
 */
TL_INLINE int tl_orient_sign(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d)
{
    const double bx = b->x - a->x, by = b->y - a->y, bz = b->z - a->z;
    const double cx = c->x - a->x, cy = c->y - a->y, cz = c->z - a->z;
    const double dx = d->x - a->x, dy = d->y - a->y, dz = d->z - a->z;
    const double six = bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
    const double most = tl_farthest(bx, cx, dx) * tl_farthest(by, cy, dy) * tl_farthest(bz, cz, dz);
    if (fabs(six) > TL_ORIENT_BOUND * most)
        return six > 0 ? 1 : -1;
    return tl_orient_exactly(a, b, c, d);
}

/* 1 where p is inside the sphere of a, b, c, d, for which tl_orient_sign is 1. */
TL_INLINE int tl_sphere_sign(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d, const tl_site *p)
{
    const double ax = a->x - p->x, ay = a->y - p->y, az = a->z - p->z;
    const double bx = b->x - p->x, by = b->y - p->y, bz = b->z - p->z;
    const double cx = c->x - p->x, cy = c->y - p->y, cz = c->z - p->z;
    const double dx = d->x - p->x, dy = d->y - p->y, dz = d->z - p->z;
    const double al = ax * ax + ay * ay + az * az + (p->weight - a->weight);
    const double bl = bx * bx + by * by + bz * bz + (p->weight - b->weight);
    const double cl = cx * cx + cy * cy + cz * cz + (p->weight - c->weight);
    const double dl = dx * dx + dy * dy + dz * dz + (p->weight - d->weight);
    const double ab = ax * by - ay * bx, bc = bx * cy - by * cx, cd = cx * dy - cy * dx;
    const double da = dx * ay - dy * ax, ac = ax * cy - ay * cx, bd = bx * dy - by * dx;
    const double abc = az * bc - bz * ac + cz * ab, bcd = bz * cd - cz * bd + dz * bc;
    const double cda = cz * da + dz * ac + az * cd, dab = dz * ab + az * bd + bz * da;
    const double inside = (al * bcd - bl * cda) + (cl * dab - dl * abc);
    const double far_x = tl_larger(tl_farthest(ax, bx, cx), fabs(dx));
    const double far_y = tl_larger(tl_farthest(ay, by, cy), fabs(dy));
    const double far_z = tl_larger(tl_farthest(az, bz, cz), fabs(dz));
    const double most = far_x * far_y * far_z * tl_larger(tl_farthest(al, bl, cl), fabs(dl));
    if (fabs(inside) > TL_SPHERE_BOUND * most)
        return inside > 0 ? 1 : -1;
    return tl_sphere_exactly(a, b, c, d, p);
}

/* 1 where p is inside the circle of a, b, c, which go counter-clockwise. */
TL_INLINE int tl_circle_sign(const tl_site2 *a, const tl_site2 *b, const tl_site2 *c, const tl_site2 *p)
{
    const double ax = a->x - p->x, ay = a->y - p->y, bx = b->x - p->x, by = b->y - p->y;
    const double cx = c->x - p->x, cy = c->y - p->y;
    const double al = ax * ax + ay * ay + (p->weight - a->weight);
    const double bl = bx * bx + by * by + (p->weight - b->weight);
    const double cl = cx * cx + cy * cy + (p->weight - c->weight);
    const double inside = al * (bx * cy - by * cx) + bl * (cx * ay - cy * ax) + cl * (ax * by - ay * bx);
    const double most = tl_farthest(ax, bx, cx) * tl_farthest(ay, by, cy) * tl_farthest(al, bl, cl);
    if (fabs(inside) > TL_CIRCLE_BOUND * most)
        return inside > 0 ? 1 : -1;
    return tl_circle_exactly(a, b, c, p);
}

#endif
