/* crossing.c - the points of an edge of one block and an edge of the other that touch, and how nearly their normal is that
 * of a face beside them. */
#include "narrow/crossing.h"

#include "base/random.h"
#include "narrow/share.h"
#include "narrow/stand.h"

#include <string.h>

tl_line tl_line_of(const tl_edge *e, const tl_vec3 *vertex)
{
    tl_line l = {.from = vertex[e->a], .along = tl_v3_sub(vertex[e->b], vertex[e->a])};
    l.unit = tl_v3_unit(l.along);
    return l;
}

/* Where the lines of two edges come nearest, within the edges: half-way between them. */
static tl_vec3 nearest(const tl_line *a, const tl_line *b)
{
    tl_vec3 u = a->along, v = b->along, w = tl_v3_sub(b->from, a->from);
    double uu = tl_v3_norm2(u), vv = tl_v3_norm2(v), uv = tl_v3_dot(u, v);
    double det = uu * vv - uv * uv, wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v);
    double s = det > 0 ? (wu * vv - wv * uv) / det : 0.5;
    double t = det > 0 ? (wu * uv - wv * uu) / det : 0.5;
    tl_vec3 p = tl_v3_madd(a->from, fmin(1, fmax(0, s)), u);
    tl_vec3 q = tl_v3_madd(b->from, fmin(1, fmax(0, t)), v);
    return tl_v3_scale(0.5, tl_v3_add(p, q));
}

/* Where the ends of an edge lie along a direction, and the edge's point there. */
typedef struct stretch {
    double start, end;
} stretch;

static tl_vec3 point_at(const tl_line *l, stretch s, double t)
{
    return tl_v3_madd(l->from, (t - s.start) / (s.end - s.start), l->along);
}

/* How nearly parallel two edges are. */
static tl_weight parallelism(const tl_line *a, const tl_line *b)
{
    tl_vec3 cross = tl_v3_cross(a->unit, b->unit);
    double sine = tl_v3_norm(cross), slope = tl_fade_slope(sine, TL_TILT_FULL, TL_TILT_NONE);
    tl_weight w = {.value = tl_fade(sine, TL_TILT_FULL, TL_TILT_NONE)};
    if (slope != 0)
        w.swing = tl_v3_scale((tl_v3_dot(a->unit, b->unit) < 0 ? slope : -slope) / w.value,
                              tl_v3_unit(cross));
    return w;
}

/* The ends of the common stretch of two edges that are nearly parallel, measured along their bisector so that neither
 * block is preferred. */
static void common_ends(const tl_line *a, const tl_line *b, tl_vec3 ends[2])
{
    double same = tl_v3_dot(a->unit, b->unit) < 0 ? -1 : 1;
    tl_vec3 d = tl_v3_unit(tl_v3_madd(a->unit, same, b->unit)), apart = tl_v3_sub(b->from, a->from);
    stretch on_a = {0, tl_v3_dot(d, a->along)}, on_b = {.start = tl_v3_dot(d, apart)};
    on_b.end = on_b.start + tl_v3_dot(d, b->along);
    double low = fmax(on_a.start, fmin(on_b.start, on_b.end));
    double high = fmin(on_a.end, fmax(on_b.start, on_b.end));
    if (low > high)
        low = high = 0.5 * (low + high);
    for (int end = 0; end < 2; end++) {
        double t = end ? high : low;
        ends[end] = tl_v3_scale(0.5, tl_v3_add(point_at(a, on_a, t), point_at(b, on_b, t)));
    }
}

void tl_crossing_add(const tl_pair_view *view, const tl_crossing *edges, tl_weight weight,
                     const tl_from *from, tl_share_points *found)
{
    uint64_t key = tl_key(tl_key(3, edges->ia), edges->ib);
    tl_share_point point = {.facet = {.kind = TL_FACET_EDGES,
                                      .ia = (uint16_t)edges->ia,
                                      .ib = (uint16_t)edges->ib,
                                      .na = edges->n},
                            .p = nearest(&edges->a, &edges->b),
                            .key = key};
    tl_sides sides = tl_stand_sides(view, edges, from);
    tl_weight onward = weight; /* over the border, however aslant */
    if (from)
        weight = tl_weight_product(weight, from->like);
    for (int k = 0; k < 4; k++)
        point.beside[k] =
            tl_weight_product(from && from->b_stands == (k < 2) ? onward : weight, sides.alike[k]);
    weight = tl_weight_product(weight, sides.stops);
    tl_weight two = tl_weight_product(parallelism(&edges->a, &edges->b), sides.aside);
    double one = 1 - two.value;
    if (one > 0)
        point.weight =
            tl_weight_product(weight, (tl_weight){one, tl_v3_scale(-two.value / one, two.swing)});
    tl_share_points_add(found, point);
    if (!(two.value > 0))
        return;
    tl_vec3 ends[2];
    common_ends(&edges->a, &edges->b, ends);
    two.value *= 0.5;
    point.weight = tl_weight_product(weight, two);
    memset(point.beside, 0, sizeof point.beside);
    for (uint32_t end = 0; end < 2; end++) {
        point.p = ends[end];
        point.key = tl_key(key, end + 1);
        tl_share_points_add(found, point);
    }
}

/* n = u x v / |u x v| follows B's turn by that of v. */
tl_weight tl_crossing_likeness(bool of_a, tl_vec3 out, tl_vec3 n, const tl_line *a,
                               const tl_line *b)
{
    double sine = tl_v3_norm(tl_v3_cross(n, out));
    if (tl_v3_dot(n, out) <= 0)
        return (tl_weight){0};
    tl_weight w = {.value = tl_fade(sine, TL_LIKE_FULL, TL_LIKE_NONE)};
    double slope = tl_fade_slope(sine, TL_LIKE_FULL, TL_LIKE_NONE);
    if (slope == 0)
        return w;
    tl_vec3 u = a->unit, v = b->unit, cross = tl_v3_cross(u, v);
    double sign = tl_v3_dot(cross, n) < 0 ? -1 : 1;
    tl_vec3 across = tl_v3_madd(out, -tl_v3_dot(out, n), n);
    /* of the cosine between both, against B's turn */
    tl_vec3 g = tl_v3_madd(tl_v3_scale(tl_v3_dot(u, v), across), -tl_v3_dot(out, v), u);
    g = tl_v3_scale(sign / tl_v3_norm(cross), g);
    if (!of_a)
        g = tl_v3_add(g, tl_v3_cross(out, n));
    w.swing = tl_v3_scale(slope / (sine * w.value), g);
    return w;
}
