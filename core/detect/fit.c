/* fit.c - how the blocks of a pair fit, and planes for their faces in which they do.
 *
 * Two faces a and b on each other, of areas A_a and A_b, are put into one plane:
 *
 *     n ~ A_a n_a - A_b n_b,    n . x = c,  c ~ A_a c_a - A_b c_b
 *
 * This is the mean of both, by area: a small block takes the plane of the floor below it. Blocks may overlap without
 * such faces, by an edge or a vertex. Then the face along which they overlap the least is drawn back. */
#include "detect/fit.h"

#include "contact/detection.h"
#include "contact/pair_view.h"
#include "geometry/measure.h"
#include "narrow/common_polygon.h"
#include "narrow/manifold.h"
#include "narrow/press.h"
#include "narrow/region.h"

#include <math.h>

/* Tolerance: sine of the tilt up to which a face lies along a plane. Faces tilted by more are a wedge that is meant
 * where a gap alone is beyond its limit. A region's are tilted by 15 degrees at the most. Test: lua/test_masonry. */
#define MOST_TILT 0.1
/* Tolerance: blocks that overlap along their flush faces by more than so many times the least, along another face, are
 * not on each other by them. Test: lua/test_masonry. */
#define DEEPER 2.0
/* Tolerance: gaps and overlaps over the size of the smaller block that are the rounding of places. A pair that fits to
 * that stays as it is. Test: lua/test_seat_limits. */
#define FITS 1e-12
/* Tolerance: the same over the distance between both centroids, from which places are reckoned. Test:
 * lua/test_seat_limits. */
#define ROUNDED 1e-14

typedef struct search {
    tl_narrow_scratch *scratch;
    tl_fit_limits limits;
} search;

/* The plane between two faces, in A's frame. */
static tl_plane plane_between(const tl_pair_view *view, uint32_t fa, uint32_t fb)
{
    const tl_plane a = tl_view_plane(view, false, fa), b = tl_view_plane(view, true, fb);
    const double area_a = tl_poly_face_area(view->a, fa), area_b = tl_poly_face_area(view->b, fb);
    const tl_vec3 n = tl_v3_madd(tl_v3_scale(area_a, a.normal), -area_b, b.normal);
    const double length = tl_v3_norm(n);
    return (tl_plane){tl_v3_scale(1 / length, n), (area_a * a.offset - area_b * b.offset) / length};
}

/* The plane of one block of a pair as the other one has it for a face of its own. */
static tl_plane across(const tl_pair_view *view, bool of_b, tl_plane plane)
{
    if (!of_b)
        return (tl_plane){tl_m3_tmul(&view->turn, tl_v3_neg(plane.normal)),
                          tl_v3_dot(plane.normal, view->shift) - plane.offset};
    const tl_vec3 n = tl_m3_mul(&view->turn, plane.normal);
    return (tl_plane){tl_v3_neg(n), -plane.offset - tl_v3_dot(n, view->shift)};
}

/* Puts the planes of both faces into one, each in its own frame. */
static void put_planes(const tl_pair_view *view, uint32_t fa, uint32_t fb, tl_pair_fit *out)
{
    const tl_plane mid = plane_between(view, fa, fb);
    out->face[0] = fa;
    out->face[1] = fb;
    out->plane[0] = mid;
    out->plane[1] = across(view, false, mid);
}

/* Measures two faces on each other; TL_FIT_APART: they have no area in common. false: out of memory. */
static bool measure_faces(const search *s, const tl_pair_view *view, const tl_region *r, double tiny, tl_pair_fit *out)
{
    tl_common_polygon common;
    const uint32_t fa = r->flush_a, fb = r->flush_b;
    if (!r->flush || r->flush_gap < DEEPER * fmin(r->gap, -tiny))
        return true;
    if (!tl_common_polygon_find(view, fa, fb, s->scratch, &common))
        return false;
    if (common.count == 0)
        return true;
    const tl_patch_gap of = tl_patch_gap_of(&common.frame, common.b);
    double least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < common.count; i++) {
        const double gap = tl_gap_at(of, common.corner[i].at);
        least = fmin(least, gap);
        most = fmax(most, gap);
    }
    const double mean = tl_gap_at(of, common.centroid);
    out->area = common.frame.secant * common.area;
    const bool wedge = tl_region_tilt(view, fa, fb) > MOST_TILT && most > s->limits.gap;
    if (least > s->limits.gap || (wedge && -least <= s->limits.overlap))
        return true;
    out->gap = fmax(most, 0);
    out->overlap = fmax(-least, 0);
    out->mean_gap = fmax(mean, 0);
    out->mean_overlap = fmax(-mean, 0);
    out->how = most <= tiny && least >= -tiny ? TL_FIT_WELL : TL_FIT_FACES;
    const double area_a = tl_poly_face_area(view->a, fa), area_b = tl_poly_face_area(view->b, fb);
    out->drawn[0] = out->overlap * area_b / (area_a + area_b);
    out->drawn[1] = out->overlap * area_a / (area_a + area_b);
    put_planes(view, fa, fb, out);
    return true;
}

/* The face of a block along which the other one lies highest, of those that no seam covers. */
static uint32_t highest(const tl_poly *p, const double *low)
{
    uint32_t best = TL_NO_ROW;
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!p->covered[f] && (best == TL_NO_ROW || low[f] > low[best]))
            best = f;
    return best;
}

/* The face of a block that lies along a plane, nowhere deeper behind it than `gap`; TL_NO_ROW: there is none. */
static uint32_t face_along(const tl_poly *p, tl_plane plane, double gap)
{
    uint32_t best = TL_NO_ROW;
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!p->covered[f] && (best == TL_NO_ROW || tl_v3_dot(p->plane[f].normal, plane.normal) >
                                                        tl_v3_dot(p->plane[best].normal, plane.normal)))
            best = f;
    if (best == TL_NO_ROW || !(tl_v3_dot(p->plane[best].normal, plane.normal) > 0) ||
        tl_v3_norm(tl_v3_cross(p->plane[best].normal, plane.normal)) > MOST_TILT)
        return TL_NO_ROW;
    for (uint32_t k = p->start[best]; k < p->start[best + 1]; k++)
        if (plane.offset - tl_v3_dot(plane.normal, p->vertex[p->loop[k]]) > gap)
            return TL_NO_ROW;
    return best;
}

/* Draws one face back by the overlap of a pair that presses. A face of the other block that lies along it is put into
 * its plane, so that no gap is left between them. false: out of memory. */
static bool measure_edges(const search *s, const tl_pair_view *view, const tl_region *r, tl_pair_fit *out)
{
    tl_press press;
    tl_region_lows lows;
    const tl_press_query query = {.view = view, .region = r};
    if (!tl_press_find(&query, 1, s->scratch, &press, NULL))
        return false;
    if (!(press.area > 0) || !tl_region_gap(view, s->scratch, &lows))
        return !s->scratch->failed;
    const uint32_t fa = highest(view->a, lows.b_over_a), fb = highest(view->b, lows.a_over_b);
    const bool of_b = fa == TL_NO_ROW || (fb != TL_NO_ROW && lows.a_over_b[fb] > lows.b_over_a[fa]);
    if (of_b && fb == TL_NO_ROW)
        return true;
    const double low = of_b ? lows.a_over_b[fb] : lows.b_over_a[fa];
    out->how = TL_FIT_EDGES;
    out->overlap = out->drawn[of_b] = fmax(-low, 0);
    out->mean_overlap = 0.5 * out->overlap;
    out->area = press.area;
    out->face[of_b] = of_b ? fb : fa;
    out->plane[of_b] = of_b ? view->b->plane[fb] : view->a->plane[fa];
    out->plane[of_b].offset += fmin(low, 0);
    const tl_plane other = across(view, of_b, out->plane[of_b]);
    out->face[!of_b] = face_along(of_b ? view->a : view->b, other, s->limits.gap);
    if (out->face[!of_b] != TL_NO_ROW)
        out->plane[!of_b] = other;
    return true;
}

/* How a pair lies with the shapes of a view. false: out of memory. */
static bool measure(const search *s, tl_pair_view view, tl_pair_fit *out)
{
    *out = (tl_pair_fit){.how = TL_FIT_APART, .face = {TL_NO_ROW, TL_NO_ROW}};
    const double tiny = FITS * view.size + ROUNDED * tl_v3_norm(view.shift);
    tl_region region;
    if (!tl_pair_place(&view, s->scratch) ||
        !tl_region_find(&view, TL_LIST_MARGIN * view.size + s->limits.gap, s->scratch, &region))
        return false;
    if (region.gap > s->limits.gap)
        return true;
    if (!measure_faces(s, &view, &region, tiny, out) ||
        (out->how == TL_FIT_APART && region.gap < -tiny && !measure_edges(s, &view, &region, out)))
        return false;
    return true;
}

bool tl_fit_measure(tl_model *m, uint32_t a, uint32_t b, bool drawn, tl_fit_limits limits, tl_pair_fit *out)
{
    const search s = {&m->detect->narrow[0], limits};
    tl_pair_view view = tl_pair_view_of(m, a, b);
    if (drawn) {
        view.a = m->blocks.shape[a];
        view.b = m->blocks.shape[b];
    }
    return measure(&s, view, out);
}
