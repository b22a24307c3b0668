/* triangle_parts.h - integrals over the parts of a triangle where a linear overlap u is above 0 and below: what presses of a cell of a
 * patch that is partly open, and what is apart (partly_open.c). The corner that u = 0 cuts off is a triangle again. */
#ifndef TL_FORCE_TRIANGLE_PARTS_H
#define TL_FORCE_TRIANGLE_PARTS_H

#include "force/triangle_integrals.h"

/* What presses of a triangle or cell, and what is apart, u there taken positive. */
typedef struct cell_parts {
    integrals pressed, apart;
} cell_parts;

static inline void add_triangle(const node n[3], const double u[3], double f, bool curved,
                                cell_parts *to)
{
    integrals all = whole_of(n, u, f, curved), some;
    size_t above = (size_t)((u[0] > 0) + (u[1] > 0) + (u[2] > 0));
    integrals none = {0}, under = added(none, all, -1, 1); /* of -u */
    if (above == 3)
        to->pressed = added(to->pressed, all, 1, 1);
    if (above == 0)
        to->apart = added(to->apart, under, 1, 1);
    if (above % 3 == 0)
        return;
    size_t k = above == 1 ? (u[0] > 0 ? 0 : u[1] > 0 ? 1 : 2) : (u[0] > 0 ? (u[1] > 0 ? 2 : 1) : 0);
    some = corner_of(n, u, f, k, above == 1 ? 1 : -1, curved);
    to->pressed = added(to->pressed, above == 1 ? some : added(all, some, 1, -1), 1, 1);
    to->apart = added(to->apart, above == 1 ? added(under, some, 1, -1) : some, 1, 1);
}

#endif
