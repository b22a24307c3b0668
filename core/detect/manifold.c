/* manifold.c - what touches: from a pair's axis to facets with contact points.
 *
 * Every pair of faces that look at each other along the axis makes a patch (patch.c), weighted by
 * their tilt: fully up to TILT_FULL, fading to nothing at TILT_NONE. Where the patches' area falls
 * short of the minimum area (1 % of the smaller block's mean face, Hart, Cundall and Lemos 1988), the
 * rest is the *point share*: the vertices, or the edges, that the axis rests on. Blocks that meet in
 * an edge or a corner with their faces parallel get none, or eight blocks meeting in a corner would
 * have stiffness where they have no area; an absolute minimum area set by the user holds for them too
 * (crease.c). */
#include "detect/detect.h"

#include "base/random.h"
#include "detect/crease.h"

#include <stdlib.h>
#include <string.h>

/* Tilt of two faces, or of an edge and a face, or of two edges, up to which they count as parallel
 * contact, and from which not at all: degrees. */
#define TILT_FULL 5.0
#define TILT_NONE 15.0
/* What faces may turn, degrees, before the axis is searched again at the latest (AXIS_MOST in update.c). */
#define TURN_MOST 3.0
/* Tilt of two faces below which their edges get no point share, and from which all of it: degrees.
 * Far above the rotations of blocks in a loaded assembly, below what is seen as an edge contact. */
#define FLUSH_NONE 0.5
#define FLUSH_FULL 1.5
/* A vertex this near the border of a face, relative to the size, is over it. */
#define BORDER 1e-9
/* Normals whose cosines with the axis differ by less are equally near to it. */
#define SAME_COSINE 1e-9

bool tl_manifold_reserve(tl_manifold *m, size_t count)
{
    if (m->point_count + count <= m->point_room)
        return true;
    size_t room = 2 * (m->point_count + count);
    tl_contact_point *points = room > UINT16_MAX ? NULL : realloc(m->points, room * sizeof *points);
    if (!points) {
        m->failed = true;
        return false;
    }
    m->points = points;
    m->point_room = room;
    return true;
}

bool tl_manifold_add_point(tl_manifold *m, tl_contact_point point)
{
    if (!(point.area > 0)) /* a point without area carries nothing, and has no stress */
        return true;
    if (!tl_manifold_reserve(m, 1))
        return false;
    m->points[m->point_count++] = point;
    return true;
}

static bool reserve_facets(tl_manifold *m, size_t room)
{
    if (room <= m->facet_room)
        return true;
    tl_facet *facets = realloc(m->facets, 2 * room * sizeof *facets);
    if (!facets) {
        m->failed = true;
        return false;
    }
    m->facets = facets;
    m->facet_room = 2 * room;
    return true;
}

/* An arc is longer than its sine by no more than this, up to TILT_NONE. */
#define ARC_OVER_SINE 1.02

/* 1 up to `full` degrees, 0 from `none` on, linear between; `sine` is that of the angle (acute). */
static double nearness(double sine, double full, double none)
{
    double least = sine * (180 / TL_PI);
    if (least >= none)
        return 0;
    if (ARC_OVER_SINE * least <= full)
        return 1;
    double x = (none - asin(fmin(1, sine)) * (180 / TL_PI)) / (none - full);
    return fmin(1, fmax(0, x));
}

/* The same, smooth. */
static double fade(double sine, double full, double none)
{
    double x = nearness(sine, full, none);
    return x * x * (3 - 2 * x);
}

/* Its derivative by the angle, 1/rad. */
static double fade_slope(double sine, double full, double none)
{
    double x = nearness(sine, full, none);
    return x <= 0 || x >= 1 ? 0 : -6 * x * (1 - x) * (180 / TL_PI) / (none - full);
}

static void add_facet(tl_manifold *m, tl_facet facet, size_t begin)
{
    facet.begin = (uint16_t)begin;
    facet.count = (uint16_t)(m->point_count - begin);
    if (facet.count)
        m->facets[m->facet_count++] = facet;
}

/* ---------------------------------------------------------------- patches ---------------- */

/* Distances of a face's corners from a plane: the least and the largest. */
static void spread(const tl_poly *p, uint32_t face, const tl_vec3 *vertex, tl_vec3 n, double offset,
                   double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (uint32_t i = p->start[face]; i < p->start[face + 1]; i++) {
        double h = tl_v3_dot(n, vertex[p->loop[i]]) - offset;
        *low = fmin(*low, h);
        *high = fmax(*high, h);
    }
}

/* Two nearly parallel faces that lie nearly in one plane, be it side by side. Of blocks that rest on
 * each other elsewhere, faces can be parallel without having to do with each other. */
static bool level(const tl_pair_view *view, uint32_t fa, uint32_t fb, double near)
{
    tl_vec3 nb = view->normal_b[fb];
    double offset_b = view->b->plane[fb].offset + tl_v3_dot(nb, view->shift), low, high;
    spread(view->a, fa, view->a->vertex, nb, offset_b, &low, &high);
    if (low > near || high < -near)
        return false;
    spread(view->b, fb, view->vertex_b, view->a->plane[fa].normal, view->a->plane[fa].offset, &low,
           &high);
    return low <= near && high >= -near;
}

/* How far from each other features of touching blocks may lie and still meet. */
static double reach_of(const tl_pair_view *view, const tl_axis *axis)
{
    return TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size + 2 * fabs(axis->s);
}

/* How flush two faces are, by the sine of the angle between them: 1 parallel, 0 tilted. */
static double flushness(double sine)
{
    return fade(sine, FLUSH_NONE, FLUSH_FULL);
}

/* Something that depends on the tilt of faces, and the couple on B that goes with it: its derivative
 * against B's turn, per radian. */
typedef struct tilted {
    double value;
    tl_vec3 swing;
} tilted;

/* All patches of a pair. */
typedef struct patches {
    tilted area;
    double whole; /* area, were none of them faded */
    tilted
        flush; /* how flush the most parallel faces are that meet, by area or side by side: 1 .. 0 */
} patches;

/* Cosines of the angles with the axis up to which faces of a patch look along it, and those that will soon:
 * of TILT_NONE, and of TURN_MOST more. */
#define FACING 0.96592582628906829
#define SOON 0.95105651629515357

/* The faces of B that look at A, into the list; how many will soon or do. */
static uint32_t list_looking(const tl_pair_view *view, tl_vec3 n, uint16_t *list, uint32_t *count)
{
    uint32_t soon = 0;
    *count = 0;
    for (uint32_t j = 0; j < view->b->face_count; j++) {
        double towards = -tl_v3_dot(view->normal_b[j], n);
        if (towards < SOON)
            continue;
        soon++;
        if (towards >= FACING && !view->b->covered[j])
            list[(*count)++] = (uint16_t)j;
    }
    return soon;
}

/* The patch of two faces, and how flush they are. */
static void add_face_pair(const tl_pair_view *view, uint32_t i, uint32_t j, double near,
                          const tl_share_rule *rule, tl_narrow *room, patches *sum)
{
    tl_manifold *m = &room->manifold;
    tl_vec3 hinge = tl_v3_cross(view->a->plane[i].normal, view->normal_b[j]);
    double sine = tl_v3_norm(hinge), area = 0; /* B turning about the hinge lessens the tilt */
    double weight = fade(sine, TILT_FULL, TILT_NONE);
    tl_vec3 swing = tl_v3_scale(fade_slope(sine, TILT_FULL, TILT_NONE), tl_v3_unit(hinge));
    if (weight > 0 && reserve_facets(m, m->facet_count + 2))
        area = tl_patch_add(view, i, j, weight, tl_v3_scale(1 / weight, swing), rule, room);
    if (area > 0) {
        sum->area.value += area;
        sum->area.swing = tl_v3_madd(sum->area.swing, area / weight, swing);
        sum->whole += area / weight;
    }
    double parallel = flushness(sine);
    if (parallel > sum->flush.value && (area > 0 || level(view, i, j, near)))
        sum->flush = (tilted){
            parallel, tl_v3_scale(fade_slope(sine, FLUSH_NONE, FLUSH_FULL), tl_v3_unit(hinge))};
}

static patches add_patches(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                           tl_narrow *room)
{
    const double near = reach_of(view, axis);
    void *scratch = room->dots; /* has room for more than the faces */
    uint16_t *list = scratch;
    uint32_t looking_a = 0, count;
    uint32_t looking_b = list_looking(view, axis->n, list, &count);
    patches sum = {0};
    for (uint32_t i = 0; i < view->a->face_count; i++) {
        tl_vec3 na = view->a->plane[i].normal;
        double towards = tl_v3_dot(na, axis->n);
        if (towards < SOON)
            continue;
        looking_a++;
        if (view->a->covered[i] || towards < FACING)
            continue;
        for (uint32_t k = 0; k < count; k++)
            if (-tl_v3_dot(na, view->normal_b[list[k]]) >= FACING)
                add_face_pair(view, i, list[k], near, rule, room, &sum);
    }
    room->manifold.lone = looking_a == 1 && looking_b == 1;
    return sum;
}

/* ---------------------------------------------------------------- point share ------------ */

/* A face of one block and the other block resting on it by vertices; all in A's frame. */
typedef struct resting {
    const tl_poly *standing; /* whose vertices rest */
    const tl_vec3 *vertex;   /* of `standing` */
    const tl_vec3 *corners;  /* of the face */
    size_t corner_count;
    tl_vec3 up; /* the face's outward normal */
    double slack;
} resting;

/* Vertex of the standing block nearest the face. */
static uint32_t lowest_vertex(const resting *r)
{
    uint32_t low = 0;
    for (uint32_t i = 1; i < r->standing->vertex_count; i++)
        if (tl_v3_dot(r->up, r->vertex[i]) < tl_v3_dot(r->up, r->vertex[low]))
            low = i;
    return low;
}

/* Adds a point at x (A's frame) with area still relative to the others'; `swing` per area. */
static void add_resting(const tl_pair_view *view, bool b_stands, tl_manifold *m, tl_vec3 x,
                        tilted weight, uint64_t key)
{
    tl_vec3 p = b_stands ? tl_m3_tmul(&view->turn, tl_v3_sub(x, view->shift)) : x;
    tl_manifold_add_point(
        m, (tl_contact_point){
               .p = p, .area = weight.value, .swing = weight.swing, .key = (uint32_t)key});
}

/* How nearly the edge along d of the standing block lies in the face; `swing` per value. */
static tilted lying(const resting *r, bool b_stands, tl_vec3 d)
{
    double sine = fmax(0, tl_v3_dot(r->up, d)) / tl_v3_norm(d);
    tilted out = {.value = fade(sine, TILT_FULL, TILT_NONE)};
    /* by B's turn, when B has the edge; when it has the face, the other way round */
    double slope = (b_stands ? -1 : 1) * fade_slope(sine, TILT_FULL, TILT_NONE);
    if (slope != 0)
        out.swing = tl_v3_scale(slope / out.value, tl_v3_unit(tl_v3_cross(d, r->up)));
    return out;
}

/* Where a block rests by the edge from its lowest vertex, which is over the face or not, to another one. */
static void add_resting_edge(const tl_pair_view *view, const resting *r, bool b_stands,
                             uint32_t low, uint32_t other, bool over, tl_manifold *m)
{
    double t0, t1;
    tl_vec3 x = r->vertex[low], d = tl_v3_sub(r->vertex[other], x);
    tilted weight = lying(r, b_stands, d);
    if (weight.value <= 0 || !tl_segment_over_face(x, r->vertex[other], r->corners, r->corner_count,
                                                   r->up, r->slack, &t0, &t1))
        return;
    uint64_t key = tl_key(tl_key(b_stands ? 1 : 2, low), other + 1u);
    tilted far =
        over ? weight : (tilted){weight.value * weight.value, tl_v3_scale(2, weight.swing)};
    add_resting(view, b_stands, m, tl_v3_madd(x, t1, d), far, tl_key(key, 1));
    if (!over)
        add_resting(view, b_stands, m, tl_v3_madd(x, t0, d), weight, tl_key(key, 2));
}

/* The first place from h on where a vertex is in the loop of a face; 2 edge_count for none. Four places at a time, of
 * which one is equal when what differs has a 16-bit zero. */
static uint32_t next_place(const tl_poly *p, uint32_t h, uint32_t vertex)
{
    const uint64_t ones = UINT64_C(0x0001000100010001), pattern = vertex * ones;
    uint32_t end = 2 * p->edge_count;
    for (uint64_t four; h + 4 <= end; h += 4) {
        memcpy(&four, p->loop + h, sizeof four);
        four ^= pattern;
        if ((four - ones) & ~four & (ones << 15))
            break;
    }
    while (h < end && p->loop[h] != vertex)
        h++;
    return h;
}

/* The points a block rests on: its lowest vertex and, as far as they lie nearly in the face, the other
 * ends of the edges there, all clipped to the face. */
static void add_support(const tl_pair_view *view, const resting *r, bool b_stands, tl_manifold *m)
{
    uint32_t low = lowest_vertex(r);
    const tl_poly *p = r->standing;
    tl_vec3 x = r->vertex[low];
    double t0, t1;
    bool over = tl_segment_over_face(x, x, r->corners, r->corner_count, r->up, r->slack, &t0, &t1);
    if (over)
        add_resting(view, b_stands, m, x, (tilted){.value = 1}, tl_key(b_stands ? 1 : 2, low));
    for (uint32_t h = 0, f = 0; (h = next_place(p, h, low)) < 2 * p->edge_count; h++) {
        while (p->start[f + 1] <= h)
            f++;
        /* each edge leaves it once */
        add_resting_edge(view, r, b_stands, low, p->loop[tl_poly_after(p, f, h)], over, m);
    }
}

static tl_facet face_facet(const tl_pair_view *view, const tl_axis *axis, bool b_stands)
{
    if (b_stands) {
        tl_plane plane = view->a->plane[axis->ia];
        return (tl_facet){
            .kind = TL_FACET_FACE_A, .ia = axis->ia, .na = plane.normal, .offset = plane.offset};
    }
    tl_plane plane = view->b->plane[axis->ib];
    return (tl_facet){
        .kind = TL_FACET_FACE_B, .ib = axis->ib, .nb = plane.normal, .offset = plane.offset};
}

/* The point share of an axis that is a face's normal. */
static void share_of_face(const tl_pair_view *view, const tl_axis *axis, tl_narrow *room)
{
    bool b_stands = axis->kind == TL_AXIS_FACE_A;
    tl_manifold *m = &room->manifold;
    const tl_poly *lying = b_stands ? view->a : view->b;
    const tl_vec3 *vertex = b_stands ? view->a->vertex : view->vertex_b;
    uint32_t face = b_stands ? axis->ia : axis->ib;
    uint32_t start = lying->start[face], count = tl_poly_face_size(lying, face);
    tl_vec3 few[64], *corners = count <= 64 ? few : malloc(count * sizeof *corners);
    if (!corners) {
        m->failed = true;
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        corners[i] = vertex[lying->loop[start + i]];
    resting r = {.standing = b_stands ? view->b : view->a,
                 .vertex = b_stands ? view->vertex_b : view->a->vertex,
                 .corners = corners,
                 .corner_count = count,
                 .up = b_stands ? axis->n : tl_v3_neg(axis->n),
                 .slack = BORDER * view->size};
    size_t begin = m->point_count;
    add_support(view, &r, b_stands, m);
    if (corners != few)
        free(corners);
    add_facet(m, face_facet(view, axis, b_stands), begin);
}

/* A line of an edge in A's frame, and where its ends lie along a direction. */
typedef struct line {
    tl_vec3 from, along;
    double start, end;
} line;

static tl_vec3 line_at(const line *l, double t)
{
    return tl_v3_madd(l->from, (t - l->start) / (l->end - l->start), l->along);
}

static tl_vec3 between(tl_vec3 p, tl_vec3 q)
{
    return tl_v3_scale(0.5, tl_v3_add(p, q));
}

/* Where the lines of two edges come nearest, within the edges: half-way between them. */
static tl_vec3 crossing_point(const line *a, const line *b)
{
    tl_vec3 u = a->along, v = b->along, w = tl_v3_sub(b->from, a->from);
    double uu = tl_v3_norm2(u), vv = tl_v3_norm2(v), uv = tl_v3_dot(u, v);
    double det = uu * vv - uv * uv, wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v);
    double s = det > 0 ? (wu * vv - wv * uv) / det : 0.5;
    double t = det > 0 ? (wu * uv - wv * uu) / det : 0.5;
    return between(tl_v3_madd(a->from, fmin(1, fmax(0, s)), u),
                   tl_v3_madd(b->from, fmin(1, fmax(0, t)), v));
}

static void add_crossing(tl_manifold *m, tl_vec3 p, double weight, tl_vec3 swing, uint64_t key)
{
    tl_manifold_add_point(
        m, (tl_contact_point){.p = p, .area = weight, .swing = swing, .key = (uint32_t)key});
}

/* The point share of two crossing edges: where they cross and, as far as they are nearly parallel, the
 * ends of their common stretch, measured along their bisector so that neither block is preferred. */
static void share_of_edges(const tl_pair_view *view, const tl_axis *axis, tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    const tl_edge *ea = &view->a->edge[axis->ia], *eb = &view->b->edge[axis->ib];
    line a = {.from = view->a->vertex[ea->a]}, b = {.from = view->vertex_b[eb->a]};
    a.along = tl_v3_sub(view->a->vertex[ea->b], a.from);
    b.along = tl_v3_sub(view->vertex_b[eb->b], b.from);
    tl_vec3 u = tl_v3_unit(a.along), v = tl_v3_unit(b.along);
    double same = tl_v3_dot(u, v) < 0 ? -1 : 1, sine = tl_v3_norm(tl_v3_cross(u, v));
    double parallel = fade(sine, TILT_FULL, TILT_NONE);
    tl_vec3 swing =
        tl_v3_scale(-same * fade_slope(sine, TILT_FULL, TILT_NONE), tl_v3_unit(tl_v3_cross(u, v)));
    size_t begin = m->point_count;
    uint64_t key = tl_key(tl_key(3, axis->ia), axis->ib);
    if (parallel < 1)
        add_crossing(m, crossing_point(&a, &b), 1 - parallel,
                     tl_v3_scale(-1 / (1 - parallel), swing), key);
    if (parallel > 0) {
        tl_vec3 d = tl_v3_unit(tl_v3_madd(u, same, v)), apart = tl_v3_sub(b.from, a.from);
        a.start = 0;
        a.end = tl_v3_dot(d, a.along);
        b.start = tl_v3_dot(d, apart);
        b.end = b.start + tl_v3_dot(d, b.along);
        double low = fmax(a.start, fmin(b.start, b.end));
        double high = fmin(a.end, fmax(b.start, b.end));
        if (low > high)
            low = high = 0.5 * (low + high);
        for (int end = 0; end < 2; end++) {
            double t = end ? high : low;
            add_crossing(m, between(line_at(&a, t), line_at(&b, t)), 0.5 * parallel,
                         tl_v3_scale(1 / parallel, swing), tl_key(key, end ? 2 : 1));
        }
    }
    add_facet(m, (tl_facet){.kind = TL_FACET_EDGES, .ia = axis->ia, .ib = axis->ib, .na = axis->n},
              begin);
}

/* Couples of the share's points, whose facet is the last: `swing` for all, and what the points' parts of the
 * share add to it, which takes a facet for each. */
static void add_swings(tl_manifold *m, tl_vec3 swing)
{
    tl_facet *facet = &m->facets[m->facet_count - 1];
    tl_facet_set_swing(facet, swing);
    size_t begin = facet->begin, count = facet->count;
    double area = 0, own = 0;
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = begin; i < begin + count; i++) {
        const tl_contact_point *p = &m->points[i];
        sum = tl_v3_madd(sum, p->area, p->swing);
        area += p->area;
        own += tl_v3_norm2(p->swing);
    }
    if (own == 0 || !reserve_facets(m, m->facet_count + count))
        return;
    tl_facet whole = m->facets[--m->facet_count];
    tl_vec3 mean = tl_v3_scale(1 / area, sum);
    for (size_t i = begin; i < begin + count; i++) {
        whole.begin = (uint16_t)i;
        whole.count = 1;
        tl_facet_set_swing(&whole, tl_v3_add(swing, tl_v3_sub(m->points[i].swing, mean)));
        m->facets[m->facet_count++] = whole;
    }
}

/* Scales the areas of the points from `begin` on to the sum `area`. */
static void scale_share(tl_manifold *m, size_t begin, double area)
{
    double sum = 0;
    for (size_t i = begin; i < m->point_count; i++)
        sum += m->points[i].area;
    for (size_t i = begin; i < m->point_count; i++)
        m->points[i].area *= area / sum;
}

void tl_manifold_build(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                       tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    m->facet_count = m->point_count = 0;
    m->failed = false;
    patches sum = add_patches(view, axis, rule, room);
    m->patch_area = sum.area.value;
    /* what the patches' whole area falls short of the minimum, and what they have lost of it by tilt */
    double enough = fmax(rule->minimum, sum.whole), missing = enough - sum.area.value;
    double share = rule->minimum / enough * missing;
    tl_vec3 swing = tl_v3_scale(-1 / missing, sum.area.swing);
    if (!rule->unconditional) {
        share *= 1 - sum.flush.value;
        swing = tl_v3_madd(swing, -1 / (1 - sum.flush.value), sum.flush.swing);
    }
    if (m->failed || !(share > 0) || axis->s > rule->reach ||
        !reserve_facets(m, m->facet_count + 3))
        return;
    size_t begin = m->point_count;
    double crease =
        rule->unconditional ? tl_crease_add(view, reach_of(view, axis), flushness, m) : 0;
    if (crease > 0) {
        scale_share(m, begin, crease * share);
        share *= 1 - crease;
        begin = m->point_count;
    }
    if (!(share > 0))
        return;
    size_t facets = m->facet_count;
    if (axis->kind == TL_AXIS_EDGES)
        share_of_edges(view, axis, room);
    else
        share_of_face(view, axis, room);
    scale_share(m, begin, share);
    if (m->facet_count > facets)
        add_swings(m, swing);
}

bool tl_manifold_renew(const tl_pair_view *view, uint32_t fa, uint32_t fb,
                       const tl_share_rule *rule, tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    double sine2 = tl_v3_norm2(tl_v3_cross(view->a->plane[fa].normal, view->normal_b[fb]));
    if (rule->unconditional || sine2 > TL_FLUSH_TILT2)
        return false;
    m->failed = false;
    return tl_patch_lay(view, fa, fb, 1, rule, room) > 0;
}

/* ---------------------------------------------------------------- joint ------------------ */

/* The face whose outward normal is nearest a direction, among those that reach to within `slack` of the
 * block's end in that direction, and the cosine between them. A face can be nearer still and lie
 * elsewhere. */
static uint32_t touching_face(const tl_poly *p, const tl_vec3 *vertex, const tl_vec3 *normals,
                              size_t stride, tl_vec3 direction, double slack, double *cosine)
{
    double end = -INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        end = fmax(end, tl_v3_dot(direction, vertex[i]));
    uint32_t best = 0;
    *cosine = -2;
    for (uint32_t i = 0; i < p->face_count; i++) {
        tl_vec3 n = *(const tl_vec3 *)(const void *)((const char *)normals + i * stride);
        double c = tl_v3_dot(n, direction);
        if (c <= *cosine || p->covered[i])
            continue;
        bool touches = false;
        for (uint32_t k = p->start[i]; k < p->start[i + 1] && !touches; k++)
            touches = tl_v3_dot(direction, vertex[p->loop[k]]) >= end - slack;
        if (touches) {
            *cosine = c;
            best = i;
        }
    }
    return best;
}

static bool has_joint(const tl_poly *p)
{
    for (uint32_t i = 0; i < p->face_count; i++)
        if (p->tag[i].joint)
            return true;
    return false;
}

tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n)
{
    if (!has_joint(view->a) && !has_joint(view->b))
        return (tl_tag){0, 0};
    double ca, cb, slack = TL_CONTACT_TOLERANCE * view->size;
    uint32_t fa = touching_face(view->a, view->a->vertex, &view->a->plane[0].normal,
                                sizeof(tl_plane), n, slack, &ca);
    uint32_t fb = touching_face(view->b, view->vertex_b, view->normal_b, sizeof(tl_vec3),
                                tl_v3_neg(n), slack, &cb);
    tl_tag a = view->a->tag[fa], b = view->b->tag[fb];
    if (a.joint == 0 || b.joint == 0)
        return a.joint == 0 ? b : a;
    if (ca > cb + SAME_COSINE)
        return a;
    if (cb > ca + SAME_COSINE)
        return b;
    return a.joint < b.joint || (a.joint == b.joint && a.plane <= b.plane) ? a : b;
}
