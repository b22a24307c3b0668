/* area.c - the area of the part of a disc that is in a box.
 *
 * The square about the disc, in its plane, is cut by the six faces of the box. What is left is a convex polygon. The
 * area that it has in common with the disc is a sum over its edges. The part of an edge from p to q inside the circle
 * adds its triangle with the centre, (p x q) / 2. A part outside adds a sector, r^2 / 2 times its angle. */
#include "discs.h"

/* Corners of a square that is cut six times. */
#define MOST_CORNERS 10

typedef struct polygon {
    tl_vec3 at[MOST_CORNERS + 1];
    size_t count;
} polygon;

/* Keeps what has sign * coordinate < limit. */
static void cut_polygon(polygon *p, int axis, double sign, double limit)
{
    polygon kept = {.count = 0};
    for (size_t i = 0; i < p->count; i++) {
        const tl_vec3 a = p->at[i], b = p->at[(i + 1) % p->count];
        const double ends[2] = {axis == 0 ? a.x : axis == 1 ? a.y : a.z, axis == 0 ? b.x : axis == 1 ? b.y : b.z};
        const double from = sign * ends[0] - limit, to = sign * ends[1] - limit;
        if (from <= 0 && kept.count < MOST_CORNERS)
            kept.at[kept.count++] = a;
        if (((from < 0 && to > 0) || (from > 0 && to < 0)) && kept.count < MOST_CORNERS)
            kept.at[kept.count++] = tl_v3_madd(a, from / (from - to), tl_v3_sub(b, a));
    }
    *p = kept;
}

static double angle(tl_flat p, tl_flat q)
{
    return tl_atan2(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y);
}

/* Twice the area between the centre of a circle and the edge from p to q, inside the circle. */
static double twice_area(tl_flat p, tl_flat q, double r2)
{
    const tl_flat d = {q.x - p.x, q.y - p.y};
    const double a = d.x * d.x + d.y * d.y, b = p.x * d.x + p.y * d.y, c = p.x * p.x + p.y * p.y - r2;
    const double root2 = b * b - a * c;
    if (!(a > 0))
        return 0;
    if (root2 <= 0)
        return r2 * angle(p, q);
    const double root = sqrt(root2), first = (-b - root) / a, last = (-b + root) / a;
    if (last <= 0 || first >= 1)
        return r2 * angle(p, q);
    const double u = fmax(first, 0), v = fmin(last, 1);
    const tl_flat in = {p.x + u * d.x, p.y + u * d.y}, out = {p.x + v * d.x, p.y + v * d.y};
    const double before = first > 0 ? r2 * angle(p, in) : 0, after = last < 1 ? r2 * angle(out, q) : 0;
    return before + (in.x * out.y - in.y * out.x) + after;
}

double disc_area_in_box(const disc *d, const tl_bounds *box)
{
    const tl_vec3 e = tl_v3_perpendicular(d->normal), f = tl_v3_cross(d->normal, e);
    polygon p = {.count = 4};
    for (int i = 0; i < 4; i++) {
        const tl_vec3 along = tl_v3_scale(i == 0 || i == 3 ? d->radius : -d->radius, e);
        p.at[i] = tl_v3_add(d->center, tl_v3_madd(along, i < 2 ? d->radius : -d->radius, f));
    }
    const double min[3] = {box->min.x, box->min.y, box->min.z}, max[3] = {box->max.x, box->max.y, box->max.z};
    for (int axis = 0; axis < 3 && p.count > 0; axis++) {
        cut_polygon(&p, axis, 1, max[axis]);
        cut_polygon(&p, axis, -1, -min[axis]);
    }
    double sum = 0;
    tl_flat flat[MOST_CORNERS + 1];
    for (size_t i = 0; i < p.count; i++) {
        const tl_vec3 arm = tl_v3_sub(p.at[i], d->center);
        flat[i] = (tl_flat){tl_v3_dot(arm, e), tl_v3_dot(arm, f)};
    }
    for (size_t i = 0; i < p.count; i++)
        sum += twice_area(flat[i], flat[(i + 1) % p.count], d->radius * d->radius);
    return fmax(0.5 * sum, 0);
}
