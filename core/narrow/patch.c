/* patch.c - face on face: the contact points of the common polygon (common_polygon.c).
 *
 * Contact points lie at the centroid, at 5/8 of the way to the corners, and at 5/6 of that to the middles of
 * edges. Let a_i be the area of the fan triangle of edge i about the centroid. A corner's point has the area 16/75
 * (a_{i-1} + a_i), a middle's 12/25 a_i, the centroid 7/75 of all. These points integrate every quadratic polynomial
 * over each fan triangle exactly, so any linear gap and its moments over the polygon. (Corners lie at the share s of
 * the way out with the weight w, middles at t with v. That asks for w s^2 = 1/12, v t^2 = 1/3 and w s + v t/2 = 1/3.
 * So t is free. Friction against a spin is right to 2 % for squares, triangles and rectangles up to 1:5 with t = 5/6).
 *
 * With points at the corners only, each takes half of its two fan triangles:
 * resultants are right, turning is 3 times too stiff for a rectangle, 4 times for a triangle.
 *
 * All points have one normal (contact/facing.h). Areas are those on the faces, not in the bisecting plane. So the area
 * of a face that lies wholly on another does not change as it tilts. */
#include "narrow/patch.h"

#include "base/columns.h"
#include "narrow/common_polygon.h"
#include "narrow/flush.h"

#include <stdlib.h>

/* Everything a point needs to become one. */
typedef struct patch {
    const tl_common_polygon *of;
    tl_point_rule rule;
    uint32_t faces; /* key of the two faces */
    tl_patch_points *out;
} patch;

/* Adds a point for which there is room; without area it would carry nothing, and have no stress. */
static void add_point(const patch *p, tl_point2 at, double area, uint32_t key)
{
    tl_patch_points *out = p->out;
    size_t i = out->count;
    tl_columns_put(out->p, i, tl_frame2_point(&p->of->frame, at));
    out->area[i] = p->of->frame.secant * area;
    out->key[i] = p->faces ^ key;
    out->count += p->of->frame.secant * area > 0;
}

/* Adds the point that belongs to a corner. */
static void add_corner(const patch *p, const tl_corner *c, double area)
{
    double reach = p->rule.reach;
    tl_point2 at = {tl_drawn_in(reach, p->of->centroid.x, c->at.x), tl_drawn_in(reach, p->of->centroid.y, c->at.y)};
    add_point(p, at, area, c->key);
}

/* Adds the point that belongs to the middle between two corners. */
static void add_middle(const patch *p, const tl_corner *c, const tl_corner *d, double area)
{
    double reach = p->rule.out;
    tl_point2 at = {tl_drawn_in(reach, p->of->centroid.x, 0.5 * (c->at.x + d->at.x)),
                    tl_drawn_in(reach, p->of->centroid.y, 0.5 * (c->at.y + d->at.y))};
    add_point(p, at, area, tl_key_of(TL_POINT_MIDDLE, c->key, d->key));
}

/* Adds middles and corners. */
static void add_edges(const patch *p, const tl_corner *c, size_t count)
{
    for (size_t i = 0; i < count; i++)
        add_middle(p, &c[i], &c[i + 1 == count ? 0 : i + 1], p->rule.middle * c[i].fan);
    for (size_t i = 0; i < count; i++)
        add_corner(p, &c[i], p->rule.corner * (c[i ? i - 1 : count - 1].fan + c[i].fan));
}

/* Makes room for `count` points. */
static bool reserve(tl_patch_points *out, size_t count)
{
    if (count <= out->capacity)
        return true;
    size_t capacity = 2 * count;
    double *block = capacity > UINT16_MAX ? NULL : malloc(capacity * (4 * sizeof(double) + sizeof(uint32_t)));
    if (!block)
        return false;
    free(out->p[0]);
    for (int k = 0; k < 3; k++)
        out->p[k] = block + (size_t)k * capacity;
    out->area = block + 3 * capacity;
    out->key = (uint32_t *)(void *)(block + 4 * capacity);
    out->capacity = capacity;
    return true;
}

/* The smallest gap of the corners. */
static double least_gap(const tl_common_polygon *of)
{
    tl_patch_gap gap = tl_patch_gap_of(&of->frame, of->b);
    double least = INFINITY;
    for (size_t i = 0; i < of->count; i++) {
        double g = tl_gap_at(gap, of->corner[i].at);
        least = g < least ? g : least;
    }
    return least;
}

/* The share by which the points go along with B: that of the fan area over edges of B. When B moves by u in the plane,
 * the centroid moves by this times u, in the mean over the directions of u. */
static double ride_of(const tl_common_polygon *of)
{
    double whole = 0, of_b = 0;
    for (size_t i = 0; i < of->count; i++) {
        const tl_corner *here = &of->corner[i], *after = &of->corner[i + 1 == of->count ? 0 : i + 1];
        double fan = 0.5 * tl_cross2(of->centroid, here->at, after->at);
        fan = fan > 0 ? fan : 0;
        whole += fan;
        of_b += fan * tl_common_edge_ride(of, here->edge);
    }
    return of_b / whole;
}

/* Adds the points at the corners, with the areas they have there. */
static void add_corners(const patch *one, tl_outlines *p)
{
    const tl_common_polygon *of = one->of;
    double *fan = (double *)(void *)p->next, *area = fan + of->count; /* the clipping is over */
    for (size_t i = 0; i < of->count; i++)
        fan[i] = of->corner[i].fan;
    tl_corner_areas(of->corner, fan, of->count, area);
    for (size_t i = 0; i < of->count; i++)
        add_corner(one, &of->corner[i], area[i]);
}

double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_touch_rule *rule,
                    tl_narrow_scratch *scratch)
{
    const bool corners = rule->corners && tl_at_corners(view->a, fa, view->b, fb);
    tl_common_polygon common;
    tl_patch_points *out = &scratch->patch;
    const patch one = {.of = &common, .rule = tl_point_rule_of(corners), .faces = tl_key_of(0, fa, fb), .out = out};
    out->count = 0;
    if (!tl_common_polygon_find(view, fa, fb, scratch, &common)) {
        scratch->manifold.failed = true;
        return 0;
    }
    if (common.count == 0)
        return 0;
    out->ride = ride_of(&common);
    out->gap = least_gap(&common);
    if (out->gap > rule->reach)
        return 0;
    /* a middle for every two corners, the corners, the centroid */
    if (!reserve(out, 2 * tl_corners_weigh(&common, corners) + 1)) {
        scratch->manifold.failed = true;
        return 0;
    }
    if (corners) {
        add_corners(&one, &scratch->outlines);
    } else {
        add_edges(&one, common.corner, common.count);
        add_point(&one, common.centroid, one.rule.centroid * common.area, tl_key_of(TL_POINT_CENTROID, 0, 0));
    }
    return common.frame.secant * common.area;
}

double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_touch_rule *rule,
                    tl_narrow_scratch *scratch)
{
    tl_manifold *m = &scratch->manifold;
    m->point_count = 0;
    double area = tl_patch_lay(view, fa, fb, rule, scratch);
    const tl_patch_points *from = &scratch->patch;
    if (!(area > 0) || !tl_manifold_reserve(m, from->count))
        return 0;
    tl_plane plane = view->b->plane[fb];
    m->facet = (tl_facet){.kind = TL_FACET_PATCH,
                          .ia = (uint16_t)fa,
                          .ib = (uint16_t)fb,
                          .na = view->a->plane[fa].normal,
                          .nb = plane.normal,
                          .offset = view->a->plane[fa].offset + plane.offset,
                          .ride = from->ride,
                          .laid = {view->turn, view->shift}};
    for (size_t i = 0; i < from->count; i++)
        m->points[m->point_count++] =
            (tl_contact_point){.p = tl_columns_get(from->p, i), .area = from->area[i], .key = from->key[i]};
    return area;
}
