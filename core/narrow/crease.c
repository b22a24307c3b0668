/* crease.c - edge along edge, where four faces cross like the strokes of an X.
 *
 * Two planes cut through rock leave four blocks along their line, and those on opposite sides of it meet
 * in nothing but that line. Every direction between the normals of the two planes separates them: the
 * common plane is not determined, and the least overlap falls on one of the faces by rounding. A user who
 * gives such a contact an area (an absolute minimum area) wants a normal that prefers neither plane: the
 * bisector, the mean of the four faces' normals. The plane through A's edge with that normal is fixed to
 * A; the points are the ends of the common stretch, fixed to B.
 *
 * Limits: both pairs of faces must be flush (see FLUSH_* in manifold.c, whose fade the caller gives);
 * other edges along each other have a common plane of their own. */
#include "narrow/crease.h"

#include "base/random.h"
#include "narrow/room.h"

/* The common stretch of two edges counts from this length on, relative to the size: rounding. */
#define STRETCH 1e-9

/* Two edges along each other. */
typedef struct crease {
    uint32_t ia, ib;
    tl_vec3 n;        /* A to B, in A's frame */
    tl_vec3 from, to; /* of the common stretch, on B's edge, in A's frame */
    double length;
    double flush;
} crease;

/* How flush two faces look at each other: 1 parallel, 0 tilted or facing elsewhere. */
static double facing(tl_vec3 na, tl_vec3 nb, double (*flush)(double sine))
{
    return tl_v3_dot(na, nb) < 0 ? flush(tl_v3_norm(tl_v3_cross(na, nb))) : 0;
}

/* How flush the four faces of two edges are, each with the one across. */
static double crossing(const tl_pair_view *view, const tl_edge *ea, const tl_edge *eb,
                       double (*flush)(double sine))
{
    tl_vec3 a1 = view->a->plane[ea->left].normal, a2 = view->a->plane[ea->right].normal;
    tl_vec3 b1 = view->normal_b[eb->left], b2 = view->normal_b[eb->right];
    return fmax(fmin(facing(a1, b1, flush), facing(a2, b2, flush)),
                fmin(facing(a1, b2, flush), facing(a2, b1, flush)));
}

/* The stretch of B's edge beside A's; false when there is none or it is farther than `near`. */
static bool common_stretch(const tl_pair_view *view, const tl_edge *ea, const tl_edge *eb,
                           double near, crease *out)
{
    tl_vec3 a = view->a->vertex[ea->a], d = tl_v3_sub(view->a->vertex[ea->b], a);
    tl_vec3 b = view->vertex_b[eb->a], e = tl_v3_sub(view->vertex_b[eb->b], b);
    double length = tl_v3_norm(d), along = tl_v3_dot(d, e) / length;
    double start = tl_v3_dot(d, tl_v3_sub(b, a)) / length;
    double low = fmax(0, fmin(start, start + along)),
           high = fmin(length, fmax(start, start + along));
    if (!(high - low > STRETCH * view->size))
        return false;
    out->from = tl_v3_madd(b, (low - start) / along, e);
    out->to = tl_v3_madd(b, (high - start) / along, e);
    out->length = high - low;
    tl_vec3 across = tl_v3_sub(tl_v3_scale(0.5, tl_v3_add(out->from, out->to)), a);
    across = tl_v3_madd(across, -tl_v3_dot(across, d) / (length * length), d);
    return tl_v3_norm(across) <= near;
}

/* The longest crease of the pair; false when there is none. */
static bool find_crease(const tl_pair_view *view, double near, double (*flush)(double sine),
                        crease *best)
{
    *best = (crease){0};
    for (uint32_t i = 0; i < view->a->edge_count; i++) {
        const tl_edge *ea = &view->a->edge[i];
        if (view->a->hidden[i])
            continue;
        for (uint32_t j = 0; j < view->b->edge_count; j++) {
            const tl_edge *eb = &view->b->edge[j];
            crease one = {.ia = i, .ib = j};
            if (view->b->hidden[j])
                continue;
            one.flush = crossing(view, ea, eb, flush);
            if (one.flush > 0 && common_stretch(view, ea, eb, near, &one) &&
                one.length > best->length)
                *best = one;
        }
    }
    if (!(best->length > 0))
        return false;
    const tl_edge *ea = &view->a->edge[best->ia], *eb = &view->b->edge[best->ib];
    tl_vec3 sum =
        tl_v3_sub(tl_v3_add(view->a->plane[ea->left].normal, view->a->plane[ea->right].normal),
                  tl_v3_add(view->normal_b[eb->left], view->normal_b[eb->right]));
    /* B's normals lean a little along the edge when B has turned: the plane must contain A's edge */
    tl_vec3 along = tl_v3_unit(tl_v3_sub(view->a->vertex[ea->b], view->a->vertex[ea->a]));
    best->n = tl_v3_unit(tl_v3_madd(sum, -tl_v3_dot(sum, along), along));
    return true;
}

double tl_crease_add(const tl_pair_view *view, double near, double (*flush)(double sine),
                     tl_manifold *m)
{
    crease one;
    if (!find_crease(view, near, flush, &one))
        return 0;
    size_t begin = m->point_count;
    uint64_t key = tl_key(tl_key(4, one.ia), one.ib);
    tl_vec3 ends[2] = {one.from, one.to};
    for (uint32_t k = 0; k < 2; k++) {
        tl_contact_point point = {.p = tl_m3_tmul(&view->turn, tl_v3_sub(ends[k], view->shift)),
                                  .area = 0.5,
                                  .key = (uint32_t)tl_key(key, k + 1)};
        if (!tl_manifold_add_point(m, point))
            return 0;
    }
    tl_vec3 foot = view->a->vertex[view->a->edge[one.ia].a];
    m->facets[m->facet_count++] = (tl_facet){.kind = TL_FACET_FACE_A,
                                             .ia = (uint16_t)one.ia,
                                             .ib = (uint16_t)one.ib,
                                             .begin = (uint16_t)begin,
                                             .count = 2,
                                             .na = one.n,
                                             .offset = tl_v3_dot(one.n, foot)};
    return one.flush;
}
