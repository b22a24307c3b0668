/* grazing.c - grazing pairs, which touch without area: in a lattice a block meets most of its neighbours in an edge or
 * a corner only, and nothing is carried there.
 *
 * Two faces that are far from parallel show it. What the blocks have in common lies under both, in a prism as wide as
 * the overlaps o1 and o2 along their normals. Springs carry kn o1 o2 a metre of it. That goes unseen up to o1 o2 = u^2
 * with u = UNSEEN times the size: the force of a share UNSEEN of a face that overlaps by u. After motion m it is (o1 +
 * m) (o2 + m) at most. Both faces are flush with one of the other block, or else edges and corners would carry more. */
#include "detect/grazing.h"

#include "narrow/press.h"

#include <talus/vmath.h>

/* Tolerance: overlap along both of two directions that may go unseen, relative to the size. The energy of it, kn u^3 a
 * metre, is a millionth of what a face stores that overlaps by as much as 1e-3. Test: property/grazing_properties. */
#define UNSEEN 2e-4

/* Cost only: product of the blocks' numbers of faces up to which they may be of a lattice: others hardly ever have
 * flush faces. Test: property/grazing_properties, lua/test_common_volume. */
#define FEW 400

/* Cost only: depth over the contact tolerance from which on a face is not looked at. A pair that grazes is within one
 * tolerance, and roundings are far below. */
#define SURELY_DEEP 2.0

/* Whether two faces face each other with a tilt at which they may still be a patch's. */
static bool are_flush(tl_vec3 n, tl_vec3 other)
{
    return 1 + tl_v3_dot(n, other) <= 0.5 * TL_FIELD_TILT * TL_FIELD_TILT;
}

/* Whether one direction lies more across another than along it: at 45 degrees or more. */
static bool is_across(tl_vec3 n, tl_vec3 other)
{
    double c = tl_v3_dot(n, other);
    return 2 * c * c <= 1;
}

/* How far the other block is from the plane of a face, negative where it lies under it. */
static double gap_from(const tl_pair_view *view, uint32_t number)
{
    bool of_b = number & 1;
    const tl_poly *other = of_b ? view->a : view->b;
    tl_plane plane = (of_b ? view->b : view->a)->plane[number >> 1];
    tl_vec3 n = of_b ? tl_m3_mul(&view->turn, plane.normal) : tl_m3_tmul(&view->turn, plane.normal);
    double shift = of_b ? -tl_v3_dot(n, view->shift) : tl_v3_dot(plane.normal, view->shift);
    double low = tl_v3_dot(n, other->vertex[0]);
    for (uint32_t i = 1; i < other->vertex_count; i++) {
        double s = tl_v3_dot(n, other->vertex[i]);
        low = s < low ? s : low;
    }
    return low + shift - plane.offset;
}

/* The normal of a face in A's frame. */
static tl_vec3 normal_of(const tl_pair_view *view, uint32_t number)
{
    tl_vec3 n = (number & 1 ? view->b : view->a)->plane[number >> 1].normal;
    return number & 1 ? tl_m3_mul(&view->turn, n) : n;
}

/* Whether a face is flush with some face of the other block; neither lies on a seam. */
static bool is_flush(const tl_pair_view *view, uint32_t number)
{
    bool of_b = number & 1, out = false;
    const tl_poly *own = of_b ? view->b : view->a, *other = of_b ? view->a : view->b;
    tl_vec3 n = own->plane[number >> 1].normal;
    tl_vec3 there = of_b ? tl_m3_mul(&view->turn, n) : tl_m3_tmul(&view->turn, n);
    for (uint32_t f = 0; f < other->face_count && !own->covered[number >> 1] && !out; f++)
        out = are_flush(there, other->plane[f].normal) && !other->covered[f];
    return out;
}

/* The flush face with the largest gap that is across `than`, of those not too deep; false: there is none. */
static bool widest(const tl_pair_view *view, const tl_region_lows *lows, tl_vec3 than, uint32_t *number)
{
    const double deep = -SURELY_DEEP * TL_CONTACT_TOLERANCE * view->size;
    double best = -INFINITY;
    for (uint32_t of_b = 0; of_b < 2; of_b++) {
        uint32_t count = (of_b ? view->b : view->a)->face_count;
        const double *low = !lows ? NULL : of_b ? lows->a_over_b : lows->b_over_a;
        for (uint32_t f = 0; f < count; f++) {
            if (low && low[f] < deep)
                continue;
            uint32_t one = 2 * f + of_b; /* tl_pair_faces */
            double gap = is_across(normal_of(view, one), than) ? gap_from(view, one) : -INFINITY;
            if (gap > best && is_flush(view, one)) {
                best = gap;
                *number = one;
            }
        }
    }
    return best > -INFINITY;
}

bool tl_grazing_only_touches(const tl_pair_view *view, const tl_pair *p)
{
    tl_pair_faces faces = tl_pair_faces_of(p);
    double least = -TL_TOUCHING * view->size;
    return faces.one != faces.other && gap_from(view, faces.one) >= least && gap_from(view, faces.other) >= least;
}

bool tl_grazing_may_be(const tl_pair_view *view)
{
    return view->a->face_count * view->b->face_count <= FEW;
}

void tl_grazing_choose_faces(const tl_pair_view *view, tl_pair *p, const tl_region_lows *lows)
{
    uint32_t one, other;
    tl_pair_forget_faces(p);
    if (!tl_grazing_may_be(view))
        return;
    if (widest(view, lows, tl_v3(0, 0, 0), &one) && widest(view, lows, normal_of(view, one), &other))
        tl_pair_set_faces(p, (tl_pair_faces){one, other});
}

double tl_grazing_margin(const tl_pair_view *view, const tl_pair *p, double *gap)
{
    *gap = -INFINITY;
    tl_pair_faces faces = tl_pair_faces_of(p);
    if (faces.one == faces.other)
        return -INFINITY;
    double first = gap_from(view, faces.one), second = gap_from(view, faces.other);
    double tolerance = TL_CONTACT_TOLERANCE * view->size, unseen = UNSEEN * view->size;
    *gap = fmax(first, second);
    if (*gap > tolerance)
        return *gap - tolerance;
    if (fmin(first, second) < -tolerance || !is_flush(view, faces.one) || !is_flush(view, faces.other))
        return -INFINITY;
    double apart = first - second;
    return 0.5 * (first + second + sqrt(apart * apart + 4 * unseen * unseen));
}
