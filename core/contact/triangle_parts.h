/* triangle_parts.h - integrals over the parts of a triangle where a linear overlap u is above 0 and below: what presses
 * of a cell of a patch that is partly open, and what is apart (cells.c). The corner that u = 0 cuts off is a triangle
 * again. */
#ifndef TL_CONTACT_TRIANGLE_PARTS_H
#define TL_CONTACT_TRIANGLE_PARTS_H

#include "contact/triangle_integrals.h"

/* What presses of a triangle or cell, and what is apart, u there taken positive. */
typedef struct cell_parts {
    integrals pressed, apart;
} cell_parts;

TL_INLINE void add_triangle(const node n[3], const double u[3], double f, bool curved, cell_parts *to)
{
    const integrals all = whole_of(n, u, f, curved);
    const size_t above = (size_t)((u[0] > 0) + (u[1] > 0) + (u[2] > 0));
    if (above == 3 || above == 2)
        add_integrals(&to->pressed, &all, 1, 1, curved);
    else
        add_integrals(&to->apart, &all, -1, 1, curved); /* of -u */
    if (above % 3 == 0)
        return;
    const bool presses = above == 1; /* the corner that is cut off, or else it is apart */
    size_t k = presses ? (u[0] > 0 ? 0 : u[1] > 0 ? 1 : 2) : u[0] > 0 ? (u[1] > 0 ? 2 : 1) : 0;
    const integrals some = corner_of(n, u, f, k, presses ? 1 : -1, curved);
    add_integrals(presses ? &to->pressed : &to->apart, &some, 1, 1, curved);
    add_integrals(presses ? &to->apart : &to->pressed, &some, 1, -1, curved);
}

#endif
