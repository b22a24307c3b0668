/* closed.c - segments of which a part is closed and a part apart: their pressure integrated exactly.
 *
 * The closure u is linear over a segment. In the coordinates y of its outline, in which means are 0 and second moments
 * 1, it is u = m + g . y with g = sqrt(2) / 3 sum u_k e_k of the closures of the three points at sqrt(2) e_k. What
 * presses is max(0, u). Of all linear functions that of the closures
 *
 *     p_k = P + sqrt(2) e_k . H,    P = mean of max(0, u),    H = mean of max(0, u) y
 *
 * has the same force and moments, so linear springs at the points act as the whole of what is closed does, and
 *
 *     U = kn A / 2 mean of max(0, u)^2
 *
 * has this force for its gradient. So whatever pieces a face is divided into, they sum up to the same. A law must not
 * get a closure below 0 where nothing pulls. So it gets those above 0, all by the factor that leaves the sum. What is
 * left over, of force and energy, is added behind the law with the stiffness that it has told by its forces. */
#include "segment/closed.h"

#include <math.h>

/* e_k: cos and sin of 0, 120 and 240 degrees, times sqrt(2). */
static const double point[TL_SEGMENT_POINTS][2] = {{1.4142135623730950488, 0},
                                                   {-0.70710678118654752440, 1.2247448713915890491},
                                                   {-0.70710678118654752440, -1.2247448713915890491}};

/* A place of the outline and the closure there. */
typedef struct corner {
    tl_point2 y;
    double u;
} corner;

/* Integrals over what is closed. */
typedef struct sums {
    double first, x, y, second;
} sums;

static void add_triangle(corner a, corner b, corner c, sums *to)
{
    const double area = 0.5 * ((b.y.x - a.y.x) * (c.y.y - a.y.y) - (c.y.x - a.y.x) * (b.y.y - a.y.y));
    const double all = a.u + b.u + c.u, part = area / 12;
    to->first += area * all / 3;
    to->x += part * (all * (a.y.x + b.y.x + c.y.x) + a.u * a.y.x + b.u * b.y.x + c.u * c.y.x);
    to->y += part * (all * (a.y.y + b.y.y + c.y.y) + a.u * a.y.y + b.u * b.y.y + c.u * c.y.y);
    to->second += part * (all * all + a.u * a.u + b.u * b.u + c.u * c.u);
}

/* Where the closure is 0 between two corners. */
static corner border(corner a, corner b)
{
    const double t = a.u / (a.u - b.u);
    return (corner){{a.y.x + t * (b.y.x - a.y.x), a.y.y + t * (b.y.y - a.y.y)}, 0};
}

/* A fan of what is closed, corner after corner. */
typedef struct fan {
    corner first, last;
    size_t count;
    sums of;
} fan;

static void add_corner(fan *f, corner c)
{
    if (f->count == 0)
        f->first = c;
    else if (f->count > 1)
        add_triangle(f->first, f->last, c, &f->of);
    f->last = c;
    f->count++;
}

bool tl_closed_part(const tl_point2 *outline, size_t corners, const double closure[TL_SEGMENT_POINTS], tl_closed *out)
{
    const double mean = (closure[0] + closure[1] + closure[2]) / 3;
    double gx = 0, gy = 0, whole = 0, low = INFINITY, high = -INFINITY;
    for (int k = 0; k < TL_SEGMENT_POINTS; k++) {
        gx += closure[k] * point[k][0] / 3;
        gy += closure[k] * point[k][1] / 3;
    }
    for (size_t i = 0; i < corners; i++) {
        const double u = mean + gx * outline[i].x + gy * outline[i].y;
        low = fmin(low, u);
        high = fmax(high, u);
    }
    if (!(low < 0 && high > 0))
        return false;
    fan f = {.count = 0};
    for (size_t i = 0; i < corners; i++) {
        const tl_point2 a = outline[i], b = outline[i + 1 < corners ? i + 1 : 0];
        const corner here = {a, mean + gx * a.x + gy * a.y}, next = {b, mean + gx * b.x + gy * b.y};
        whole += 0.5 * (a.x * b.y - a.y * b.x);
        if (here.u > 0)
            add_corner(&f, here);
        if ((here.u > 0) != (next.u > 0))
            add_corner(&f, border(here, next));
    }
    const double first = f.of.first / whole;
    double sum = 0, square = 0;
    for (int k = 0; k < TL_SEGMENT_POINTS; k++) {
        out->rest[k] = first + (point[k][0] * f.of.x + point[k][1] * f.of.y) / whole;
        out->even[k] = fmax(out->rest[k], 0);
        sum += out->even[k];
    }
    for (int k = 0; k < TL_SEGMENT_POINTS; k++) {
        out->even[k] *= sum > 0 ? 3 * first / sum : 0;
        out->rest[k] -= out->even[k];
        square += out->even[k] * out->even[k] / 3;
    }
    out->second = f.of.second / whole - square;
    return true;
}
