/* triangle_integrals.h - integrals of powers of an overlap u, which is linear, and of them times the place: over a
 * triangle, a corner of it, and the parts of it where u is above 0 and below. */
#ifndef TL_CONTACT_TRIANGLE_INTEGRALS_H
#define TL_CONTACT_TRIANGLE_INTEGRALS_H

#include "base/inline.h"

#include <stdbool.h>
#include <stddef.h>

/* A place in a triangle of the fan: shares of the two corners beside that of the centroid. */
typedef struct node {
    double a, b;
} node;

/* Over a part of the triangle, times 1 over its area: integrals of 1 and of powers of u, and of them times the
 * place. */
typedef struct integrals {
    double one, a, b;
    double u, ua, ub, uu;
    double uua, uub, uuu, uuuu, uuua, uuub; /* for laws that are not linear; else 0 */
} integrals;

/* int u^2 x over a triangle of area 60, of values at its corners. */
TL_INLINE double square_times(const double u[3], double x, double y, double z)
{
    double sum = u[0] + u[1] + u[2], squares = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    double mixed = u[0] * x + u[1] * y + u[2] * z;
    double high = u[0] * u[0] * x + u[1] * u[1] * y + u[2] * u[2] * z;
    return (sum * sum + squares) * (x + y + z) + 2 * (sum * mixed + high);
}

/* int u^n over a triangle is 2 / ((n + 1) (n + 2)) times the sum of all products of n of the values at its corners. */
TL_INLINE void put_powers(const node n[3], const double u[3], double f, integrals *out)
{
    double x = u[0], y = u[1], z = u[2], xx = x * x;
    double two = xx + y * (x + y), three = xx * x + y * two, four = xx * xx + y * three;
    double sum = x + y + z, pairs = two + z * sum, all = three + z * pairs;
    out->uuu = f / 10 * all;
    out->uuuu = f / 15 * (four + z * all);
    for (int k = 0; k < 3; k++) { /* int u^3 x is a quarter of how that changes as u goes by x */
        double by = f / 60 * (all + u[k] * (pairs + u[k] * (sum + u[k])));
        out->uuua += by * n[k].a;
        out->uuub += by * n[k].b;
    }
}

/* Of a triangle of the share f of the area. */
TL_INLINE integrals whole_of(const node n[3], const double u[3], double f, bool curved)
{
    double sum = u[0] + u[1] + u[2], by = f / 12;
    double a = n[0].a + n[1].a + n[2].a, b = n[0].b + n[1].b + n[2].b;
    integrals out = {
        .one = f,
        .a = f / 3 * a,
        .b = f / 3 * b,
        .u = f / 3 * sum,
        .ua = by * (sum * a + u[0] * n[0].a + u[1] * n[1].a + u[2] * n[2].a),
        .ub = by * (sum * b + u[0] * n[0].b + u[1] * n[1].b + u[2] * n[2].b),
        .uu = f / 6 * (0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + 0.5 * sum * sum),
    };
    if (curved) {
        out.uua = f / 60 * square_times(u, n[0].a, n[1].a, n[2].a);
        out.uub = f / 60 * square_times(u, n[0].b, n[1].b, n[2].b);
        put_powers(n, u, f, &out);
    }
    return out;
}

/* Of the part of it at corner k where `sign` u > 0, when that is so at no other corner; u taken times the sign. */
TL_INLINE integrals corner_of(const node n[3], const double u[3], double f, size_t k, double sign, bool curved)
{
    size_t i = (k + 1) % 3, j = (k + 2) % 3;
    double top = sign * u[k], s = u[k] / (u[k] - u[i]), t = u[k] / (u[k] - u[j]);
    double area = f * s * t, by = area * top / 12, by_square = area * top * top / 30;
    double a = 4 * n[k].a + s * (n[i].a - n[k].a) + t * (n[j].a - n[k].a);
    double b = 4 * n[k].b + s * (n[i].b - n[k].b) + t * (n[j].b - n[k].b);
    integrals out = {.one = area,
                     .a = area / 3 * (a - n[k].a),
                     .b = area / 3 * (b - n[k].b),
                     .u = area * top / 3,
                     .ua = by * a,
                     .ub = by * b,
                     .uu = area * top * top / 6};
    if (curved) {
        out.uua = by_square * (n[k].a + a);
        out.uub = by_square * (n[k].b + b);
        out.uuu = 3 * by_square * top;
        out.uuuu = 2 * by_square * top * top;
        out.uuua = 0.5 * by_square * top * (2 * n[k].a + a);
        out.uuub = 0.5 * by_square * top * (2 * n[k].b + b);
    }
    return out;
}

/* Adds x with a sign for the odd powers of u and one for the even ones. */
TL_INLINE void add_integrals(integrals *to, const integrals *x, double odd, double even, bool curved)
{
    to->one += even * x->one;
    to->a += even * x->a;
    to->b += even * x->b;
    to->u += odd * x->u;
    to->ua += odd * x->ua;
    to->ub += odd * x->ub;
    to->uu += even * x->uu;
    if (!curved)
        return;
    to->uua += even * x->uua;
    to->uub += even * x->uub;
    to->uuu += odd * x->uuu;
    to->uuuu += even * x->uuuu;
    to->uuua += odd * x->uuua;
    to->uuub += odd * x->uuub;
}

/* ---------------------------------------------------------------- parts ------------------
 *
 * What presses of a cell of a patch that is partly open, and what is apart (cells.c). The corner that u = 0 cuts off is
 * a triangle again. */

/* What presses of a triangle or cell, and what is apart, u there taken positive. */
typedef struct cell_parts {
    integrals pressed, apart;
} cell_parts;

TL_INLINE void add_triangle(const node n[3], const double u[3], double f, bool curved, cell_parts *to)
{
    const integrals all = whole_of(n, u, f, curved);
    const size_t above = (size_t)((u[0] > 0) + (u[1] > 0) + (u[2] > 0));
    if (above == 3) {
        add_integrals(&to->pressed, &all, 1, 1, curved);
    } else if (above == 0) {
        add_integrals(&to->apart, &all, -1, 1, curved); /* of -u */
    } else if (above == 2) {                            /* the corner that is cut off is apart */
        const size_t k = u[0] > 0 ? (u[1] > 0 ? 2 : 1) : 0;
        const integrals some = corner_of(n, u, f, k, -1, curved);
        add_integrals(&to->pressed, &all, 1, 1, curved);
        add_integrals(&to->apart, &some, 1, 1, curved);
        add_integrals(&to->pressed, &some, 1, -1, curved);
    } else { /* it presses */
        const size_t k = u[0] > 0 ? 0 : u[1] > 0 ? 1 : 2;
        const integrals some = corner_of(n, u, f, k, 1, curved);
        add_integrals(&to->apart, &all, -1, 1, curved);
        add_integrals(&to->pressed, &some, 1, 1, curved);
        add_integrals(&to->apart, &some, 1, -1, curved);
    }
}

#endif
