/* manifold.c - what touches: from a pair's axis to facets with contact points.
 *
 * Every pair of faces that look at each other along the axis makes a patch (patch.c), weighted by
 * their tilt: fully up to TILT_FULL, fading to nothing at TILT_NONE. Where the patches' area falls
 * short of the minimum area (1 % of the smaller block's mean face, Hart, Cundall and Lemos 1988), the
 * rest is the *point share*: the vertices, or the edges, that the axis rests on. Blocks that meet in
 * an edge or a corner with their faces parallel get none, or eight blocks meeting in a corner would
 * have stiffness where they have no area; an absolute minimum area set by the user holds for them too. */
#include "detect/detect.h"

#include "base/random.h"

#include <stdlib.h>

/* Tilt of two faces, or of an edge and a face, or of two edges, up to which they count as parallel
 * contact, and from which not at all: degrees. */
#define TILT_FULL 5.0
#define TILT_NONE 15.0
/* Tilt of two faces below which their edges get no point share, and from which all of it: degrees.
 * Far above the rotations of blocks in a loaded assembly, below what is seen as an edge contact. */
#define FLUSH_NONE 0.5
#define FLUSH_FULL 1.5
/* A vertex this near the border of a face, relative to the size, is over it. */
#define BORDER 1e-9
/* Normals whose cosines with the axis differ by less are equally near to it. */
#define SAME_COSINE 1e-9

bool tl_manifold_add_point(tl_manifold *m, tl_vec3 p, double rest, double area, uint32_t key)
{
    if (m->point_count == m->point_room) {
        size_t room = m->point_room ? 2 * m->point_room : 64;
        tl_contact_point *points = realloc(m->points, room * sizeof *points);
        if (!points || room > UINT16_MAX) {
            m->points = points ? points : m->points;
            m->failed = true;
            return false;
        }
        m->points = points;
        m->point_room = room;
    }
    m->points[m->point_count++] = (tl_contact_point){p, rest, area, key};
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

/* 1 up to `full` degrees, 0 from `none` on, smooth between; `sine` is that of the angle (acute). */
static double fade(double sine, double full, double none)
{
    double degrees = asin(fmin(1, sine)) * (180 / TL_PI);
    double x = (none - degrees) / (none - full);
    return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x);
}

static void add_facet(tl_manifold *m, tl_facet facet, size_t begin)
{
    facet.begin = (uint16_t)begin;
    facet.count = (uint16_t)(m->point_count - begin);
    if (facet.count)
        m->facets[m->facet_count++] = facet;
}

/* ---------------------------------------------------------------- patches ---------------- */

/* Adds all patches; returns how flush the most parallel faces are: 1 parallel, 0 tilted. */
static double add_patches(const tl_pair_view *view, tl_vec3 n, const tl_share_rule *rule,
                          tl_narrow *room)
{
    const double facing = cos(TILT_NONE * TL_PI / 180);
    tl_manifold *m = &room->manifold;
    double flush = 0;
    for (uint32_t i = 0; i < view->a->face_count; i++) {
        tl_vec3 na = view->a->plane[i].normal;
        if (tl_v3_dot(na, n) < facing)
            continue;
        for (uint32_t j = 0; j < view->b->face_count; j++) {
            tl_vec3 nb = view->normal_b[j];
            if (-tl_v3_dot(nb, n) < facing || -tl_v3_dot(na, nb) < facing)
                continue;
            double sine = tl_v3_norm(tl_v3_cross(na, nb));
            double weight = fade(sine, TILT_FULL, TILT_NONE);
            flush = fmax(flush, fade(sine, FLUSH_NONE, FLUSH_FULL));
            if (weight > 0 && reserve_facets(m, m->facet_count + 2))
                m->patch_area += tl_patch_add(view, i, j, weight, rule, room);
        }
    }
    return flush;
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

/* Adds a point at x (A's frame) with area still relative to the others'. */
static bool add_resting(const tl_pair_view *view, bool b_stands, tl_manifold *m, tl_vec3 x,
                        double weight, uint32_t key)
{
    tl_vec3 p = b_stands ? tl_m3_tmul(&view->turn, tl_v3_sub(x, view->shift)) : x;
    return tl_manifold_add_point(m, p, 0, weight, key);
}

/* The points a block rests on: its lowest vertex and, as far as they lie nearly in the face, the other
 * ends of the edges there, all clipped to the face. Returns false when nothing is over the face. */
static bool add_support(const tl_pair_view *view, const resting *r, bool b_stands, tl_manifold *m)
{
    uint32_t low = lowest_vertex(r);
    const tl_poly *p = r->standing;
    tl_vec3 x = r->vertex[low];
    double t0, t1;
    bool over = tl_segment_over_face(x, x, r->corners, r->corner_count, r->up, r->slack, &t0, &t1);
    uint64_t side = b_stands ? 1 : 2;
    if (over && !add_resting(view, b_stands, m, x, 1, (uint32_t)tl_key(side, low)))
        return true;
    for (uint32_t k = p->star_at[low]; k < p->star_at[low + 1]; k++) {
        const tl_edge *edge = &p->edge[p->star[k]];
        uint32_t other = edge->a == low ? edge->b : edge->a;
        tl_vec3 d = tl_v3_sub(r->vertex[other], x);
        double weight = fade(fmax(0, tl_v3_dot(r->up, d)) / tl_v3_norm(d), TILT_FULL, TILT_NONE);
        if (weight <= 0 || !tl_segment_over_face(x, r->vertex[other], r->corners, r->corner_count,
                                                 r->up, r->slack, &t0, &t1))
            continue;
        uint64_t key = tl_key(tl_key(side, low), other + 1u);
        add_resting(view, b_stands, m, tl_v3_madd(x, t1, d), over ? weight : weight * weight,
                    (uint32_t)tl_key(key, 1));
        if (!over)
            add_resting(view, b_stands, m, tl_v3_madd(x, t0, d), weight, (uint32_t)tl_key(key, 2));
    }
    return over;
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
static bool share_of_face(const tl_pair_view *view, const tl_axis *axis, tl_narrow *room)
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
        return false;
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
    bool over = add_support(view, &r, b_stands, m);
    bool met = over || m->point_count > begin;
    if (!met) { /* nothing is over the face: the axis is not the one; the nearest vertex stands in */
        uint32_t low = lowest_vertex(&r);
        add_resting(view, b_stands, m, r.vertex[low], 1, (uint32_t)tl_key(b_stands ? 1 : 2, low));
    }
    if (corners != few)
        free(corners);
    add_facet(m, face_facet(view, axis, b_stands), begin);
    return met;
}

/* The point share of two crossing edges: where they cross and, as far as they are nearly parallel, the
 * ends of their common stretch. */
static void share_of_edges(const tl_pair_view *view, const tl_axis *axis, tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    const tl_edge *ea = &view->a->edge[axis->ia], *eb = &view->b->edge[axis->ib];
    tl_vec3 a = view->a->vertex[ea->a], u = tl_v3_sub(view->a->vertex[ea->b], a);
    tl_vec3 b = view->vertex_b[eb->a], v = tl_v3_sub(view->vertex_b[eb->b], b);
    tl_vec3 w = tl_v3_sub(b, a);
    double uu = tl_v3_norm2(u), vv = tl_v3_norm2(v), uv = tl_v3_dot(u, v);
    double det = uu * vv - uv * uv;
    double wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v);
    double crossing = det > 0 ? (wu * vv - wv * uv) / det : 0.5;
    crossing = fmin(1, fmax(0, crossing));
    double parallel = fade(sqrt(fmax(0, det) / (uu * vv)), TILT_FULL, TILT_NONE);
    /* B's ends on A's edge */
    double t0 = wu / uu, t1 = (wu + uv) / uu;
    double lo = fmin(1, fmax(0, fmin(t0, t1))), hi = fmin(1, fmax(0, fmax(t0, t1)));
    size_t begin = m->point_count;
    uint64_t key = tl_key(tl_key(3, axis->ia), axis->ib);
    if (parallel < 1)
        tl_manifold_add_point(m, tl_v3_madd(a, crossing, u), 0, 1 - parallel, (uint32_t)key);
    if (parallel > 0) {
        tl_manifold_add_point(m, tl_v3_madd(a, lo, u), 0, 0.5 * parallel, (uint32_t)tl_key(key, 1));
        tl_manifold_add_point(m, tl_v3_madd(a, hi, u), 0, 0.5 * parallel, (uint32_t)tl_key(key, 2));
    }
    add_facet(m,
              (tl_facet){.kind = TL_FACET_EDGES,
                         .ia = axis->ia,
                         .ib = axis->ib,
                         .na = u,
                         .nb = tl_v3_sub(view->b->vertex[eb->b], view->b->vertex[eb->a]),
                         .pa = a,
                         .side = axis->n,
                         .pb = view->b->vertex[eb->a]},
              begin);
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
    m->patch_area = 0;
    m->failed = false;
    m->grounded = true;
    double flush = add_patches(view, axis->n, rule, room);
    m->grounded = m->patch_area > 0;
    double share = rule->minimum - m->patch_area;
    if (!rule->unconditional)
        share *= 1 - flush;
    if (m->failed || !(share > 0) || axis->s > rule->reach ||
        !reserve_facets(m, m->facet_count + 2))
        return;
    size_t begin = m->point_count;
    if (axis->kind == TL_AXIS_EDGES)
        share_of_edges(view, axis, room);
    else
        m->grounded = share_of_face(view, axis, room) || m->grounded;
    scale_share(m, begin, share);
}

/* ---------------------------------------------------------------- joint ------------------ */

/* The face whose outward normal is nearest a direction, and the cosine between them. */
static uint32_t facing(const tl_poly *p, const tl_vec3 *normals, size_t stride, tl_vec3 direction,
                       double *cosine)
{
    uint32_t best = 0;
    *cosine = -2;
    for (uint32_t i = 0; i < p->face_count; i++) {
        tl_vec3 n = *(const tl_vec3 *)(const void *)((const char *)normals + i * stride);
        double c = tl_v3_dot(n, direction);
        if (c > *cosine) {
            *cosine = c;
            best = i;
        }
    }
    return best;
}

tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n)
{
    double ca, cb;
    uint32_t fa = facing(view->a, &view->a->plane[0].normal, sizeof(tl_plane), n, &ca);
    uint32_t fb = facing(view->b, view->normal_b, sizeof(tl_vec3), tl_v3_neg(n), &cb);
    tl_tag a = view->a->tag[fa], b = view->b->tag[fb];
    if (a.joint == 0 || b.joint == 0)
        return a.joint == 0 ? b : a;
    if (ca > cb + SAME_COSINE)
        return a;
    if (cb > ca + SAME_COSINE)
        return b;
    return a.joint < b.joint || (a.joint == b.joint && a.plane <= b.plane) ? a : b;
}
