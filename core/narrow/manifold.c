/* manifold.c - what touches: two flush faces make a patch (patch.c), all else a field contact (press.c).
 *
 * A patch is the fast form of the energy of press.c where that is the energy of the patch alone. The faces are nearly
 * parallel, overlap by little, and no other faces face each other nearby. A patch with a bond stays one up to a larger
 * tilt. A field contact has two points at the centre of its pressure (facet.h). */
#include "narrow/manifold.h"

#include "geometry/measure.h"
#include "narrow/flush.h"
#include "narrow/patch.h"

/* Tolerance: share of the limits of a patch within which a field contact becomes one: so none changes to and fro.
 * Without it a cube in a groove takes 36000 steps to rest, not 3300. */
#define BACK 0.5
/* Tolerance: overlaps by which faces across a blunt edge must stay behind those of a patch. For the blocks press on
 * each other over it, too, by this share of the patch's force. Test: unit/test_patch. */
#define BLUNT 2000.0
/* Tolerance: minimum area over that of a patch up to which it makes no difference: by less than 2e-3 of the force.
 * Test: unit/test_stored. */
#define MOST_MIN_AREA 0.05

/* Tolerance: share of a face's area on another, from which on it lies on it wholly. Test: verify/peers_arch,
 * lua/test_corner_springs. */
#define WHOLLY 0.99

/* Cost only: way over the size, after which a patch that only its bonds keep one is looked at again. */
#define LOOK_AGAIN 1e-6

/* The press of what is no field contact. */
static const tl_press none;

/* ---------------------------------------------------------------- patches ---------------- */

/* Whether one of two faces lies wholly on the other. Else the corners of their patch do not all go with one of them. */
static bool lies_on(const tl_pair_view *view, uint32_t fa, uint32_t fb, double area)
{
    return area >= WHOLLY * fmin(tl_poly_face_area(view->a, fa), tl_poly_face_area(view->b, fb));
}

/* Whether the flush faces of the region are a patch and nothing else is there. */
static bool is_patch(const tl_pair_view *view, const tl_region *r, const tl_touch_rule *rule,
                     const tl_manifold_before *before, tl_narrow_scratch *scratch)
{
    tl_manifold *m = &scratch->manifold;
    double size = view->size, part = before->kind == TL_FACET_FIELD ? BACK : 1;
    if (!r->flush || r->gap > rule->reach)
        return false;
    double overlap = fmax(0, -r->flush_gap), away = TL_CONTACT_TOLERANCE * size;
    double behind = fmin(r->flush_lead - away, (r->blunt_lead - BLUNT * overlap - away) / BLUNT);
    const bool corners = rule->corners && tl_at_corners(view->a, r->flush_a, view->b, r->flush_b);
    const tl_flush_limits limits = tl_flush_limits_of(corners);
    double most_tilt = fmax(part * limits.tilt, before->born_tilt);
    const double tilt = tl_region_tilt(view, r->flush_a, r->flush_b);
    if (!(behind > 0 && most_tilt - tilt > 0))
        return false;
    double area = tl_patch_add(view, r->flush_a, r->flush_b, rule, scratch);
    if (!(area > 0) || rule->min_area > MOST_MIN_AREA * area)
        return false;
    if (!lies_on(view, r->flush_a, r->flush_b, area))
        most_tilt = fmax(fmin(most_tilt, part * limits.points_tilt), before->born_tilt);
    const double tilt_margin = most_tilt - tilt;
    if (!(tilt_margin > 0))
        return false;
    double shallow = part * limits.points_depth * sqrt(area) + scratch->patch.gap;
    if (!(shallow > 0))
        return false;
    /* when the pair moves, none of these changes by more than twice the way */
    double way = 0.5 * fmin(fmin(behind, shallow), tilt_margin * size);
    m->valid = fmin(way, TL_LIST_MARGIN * size);
    return true;
}

/* Whether the faces of a patch with bonds are still one. `way`: how far the pair may move until they would be none
 * without bonds, which may break on the way. */
static bool stays_patch(const tl_pair_view *view, const tl_touch_rule *rule, const tl_manifold_before *before,
                        double way, tl_narrow_scratch *scratch)
{
    const tl_face_pair f = before->faces;
    double left = INFINITY;
    if (before->most_tilt < INFINITY)
        left = before->most_tilt - tl_region_tilt(view, f.a, f.b);
    if (!(left > 0) || !(tl_patch_add(view, f.a, f.b, rule, scratch) > 0))
        return false;
    tl_manifold *m = &scratch->manifold;
    m->valid = fmin(fmin(m->valid, way), 0.5 * left * view->size);
    return true;
}

/* How far a pair may move until the faces of a patch with bonds would be none without them. */
static double way_without_bonds(const tl_pair_view *view, const tl_region *r, const tl_touch_rule *rule,
                                const tl_manifold_before *before, tl_narrow_scratch *scratch)
{
    if (before->most_tilt == INFINITY)
        return INFINITY;
    const bool same = r->flush && r->flush_a == before->faces.a && r->flush_b == before->faces.b;
    return same && is_patch(view, r, rule, before, scratch) ? scratch->manifold.valid : LOOK_AGAIN * view->size;
}

/* ---------------------------------------------------------------- fields ----------------- */

bool tl_manifold_press(const tl_press *press, const tl_press_extra *extra, tl_face_pair faces,
                       tl_narrow_scratch *scratch)
{
    tl_manifold *m = &scratch->manifold;
    m->point_count = 0;
    m->press = press;
    m->extra = extra;
    if (!tl_manifold_reserve(m, TL_FIELD_POINTS))
        return false;
    m->facet =
        (tl_facet){.kind = TL_FACET_FIELD, .ia = faces.a, .ib = faces.b, .na = press->normal, .offset = press->overlap};
    for (uint32_t k = 0; k < TL_FIELD_POINTS && press->area > 0; k++)
        m->points[m->point_count++] = (tl_contact_point){.p = press->point, .area = press->area, .key = k};
    return true;
}

tl_press_query tl_manifold_query(const tl_pair_view *view, const tl_region *region, const tl_touch_rule *rule,
                                 const tl_manifold_before *before)
{
    return (tl_press_query){.view = view,
                            .region = region,
                            .min_area = rule->min_area,
                            .corners = rule->corners,
                            .volumes = rule->volumes,
                            .opens = rule->opens,
                            .shift = before->shift,
                            .shifted = before->shifted,
                            .lean = before->leans ? before->lean : NULL,
                            .opened = before->opened};
}

static bool find_field(const tl_pair_view *view, const tl_region *r, const tl_touch_rule *rule,
                       const tl_manifold_before *before, tl_narrow_scratch *scratch)
{
    const tl_press_query query = tl_manifold_query(view, r, rule, before);
    const tl_face_pair faces = {r->flush_a, r->flush_b};
    tl_press *press = &scratch->found;
    tl_press_extra *extra = &scratch->extra;
    scratch->manifold.point_count = 0;
    scratch->manifold.valid = TL_LIST_MARGIN * view->size;
    return tl_press_find(&query, 1, scratch, press, extra) && tl_manifold_press(press, extra, faces, scratch);
}

/* ---------------------------------------------------------------- all of it -------------- */

bool tl_manifold_find(const tl_pair_view *view, const tl_region *r, const tl_touch_rule *rule,
                      const tl_manifold_before *before, tl_narrow_scratch *scratch)
{
    tl_manifold *m = &scratch->manifold;
    bool was_field = before->kind == TL_FACET_FIELD;
    m->failed = false;
    m->point_count = 0;
    m->press = &none;
    m->extra = NULL;
    m->valid = TL_LIST_MARGIN * view->size;
    if (before->holds) {
        const double way = way_without_bonds(view, r, rule, before, scratch);
        m->valid = TL_LIST_MARGIN * view->size;
        if (!m->failed && stays_patch(view, rule, before, way, scratch))
            return true;
    }
    if (m->failed || ((before->calm || !was_field) && is_patch(view, r, rule, before, scratch)))
        return !m->failed;
    m->point_count = 0;
    if (m->failed || r->gap > before->reach)
        return !m->failed;
    return find_field(view, r, rule, before, scratch);
}

/* ---------------------------------------------------------------- joint ------------------ */

/* The face whose outward normal is nearest a direction, and the cosine between them. It must reach to within the
 * contact tolerance of the block's end in that direction. A face can be nearer still and lie elsewhere. */
static uint16_t touching_face(const tl_pair_view *view, bool of_b, tl_vec3 direction, double *cosine)
{
    const tl_poly *p = of_b ? view->b : view->a;
    const tl_vec3 *vertex = of_b ? view->vertex_b : p->vertex;
    double slack = TL_CONTACT_TOLERANCE * view->size, end = -INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        end = fmax(end, tl_v3_dot(direction, vertex[i]));
    uint16_t best = 0;
    *cosine = -2;
    for (uint16_t i = 0; i < p->face_count; i++) {
        double c = tl_v3_dot(of_b ? view->normal_b[i] : p->plane[i].normal, direction);
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

/* The faces that touch along a direction from A to B, with the cosines between it and their normals. */
static tl_face_pair touching_faces(const tl_pair_view *view, tl_vec3 n, double *ca, double *cb)
{
    uint16_t fa = touching_face(view, false, n, ca);
    return (tl_face_pair){fa, touching_face(view, true, tl_v3_neg(n), cb)};
}

tl_face_pair tl_touching_faces(const tl_pair_view *view, tl_vec3 n)
{
    double ca, cb;
    return touching_faces(view, n, &ca, &cb);
}

tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n)
{
    if (!has_joint(view->a) && !has_joint(view->b))
        return (tl_tag){0, 0};
    double ca, cb;
    const tl_face_pair f = touching_faces(view, n, &ca, &cb);
    tl_tag a = view->a->tag[f.a], b = view->b->tag[f.b];
    if (a.joint == 0 || b.joint == 0)
        return tl_flush_tag(a, b);
    /* of flush faces both are equally near */
    double same = 0.5 * TL_FLUSH_TILT * TL_FLUSH_TILT;
    if (ca > cb + same)
        return a;
    if (cb > ca + same)
        return b;
    return tl_flush_tag(a, b);
}
