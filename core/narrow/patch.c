/* patch.c - face on face: the contact polygon and its contact points.
 *
 * The two faces are projected along the bisector of their normals into the bisecting plane, where one
 * clips the other (Sutherland and Hodgman 1974). Contact points lie at the polygon's area centroid, at 5/8 of the
 * way from there to its corners and at 5/6 of that to the middles of its edges; with a_i the area of the fan triangle of
 * edge i about the centroid, a corner's point has the area 16/75 (a_{i-1} + a_i), a middle's 12/25 a_i, the centroid
 * 7/75 of all. These points integrate every quadratic polynomial over each fan triangle exactly, so any linear gap and
 * its moments over the polygon. (For corners at the share s of the way out with the weight w and middles at t with v,
 * that asks for w s^2 = 1/12, v t^2 = 1/3 and w s + v t/2 = 1/3: t is free, and friction against a spin is right to 2 %
 * for squares, triangles and rectangles up to 1:5 with t = 5/6.) With points at the corners only, each takes half of
 * its two fan triangles: resultants are right, turning is 3 times too stiff for a rectangle, 4 times for a
 * triangle.
 *
 * All points have one normal (contact/facing.h). Areas are those on the faces, not in the bisecting plane, so that the
 * area of a face that lies wholly on another does not change as it tilts.
 *
 * With points at the corners only, those with a turning angle below TL_STRAIGHT are left out. Between TL_STRAIGHT and
 * TL_CORNER the points are then a mixture of those with and without the corner, so that a corner that comes or goes while blocks
 * wobble does not change the force. */
#include "narrow/patch.h"

#include "base/columns.h"
#include "narrow/flush.h"
#include "narrow/frame2.h"
#include "narrow/polygon.h"
#include "narrow/scratch.h"

#include <stdlib.h>
#include <string.h>

/* Longest run of blended corners that is mixed; longer runs belong to round outlines. */
#define BLEND_RUN 3

/* Area and area centroid, taken about a corner. */
static double area_of(const tl_corner *c, size_t count, tl_point2 *centroid)
{
    double area = 0, x = 0, y = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        double a = 0.5 * tl_cross2(c[0].at, c[i].at, c[i + 1].at);
        area += a;
        x += a * ((c[i].at.x - c[0].at.x) + (c[i + 1].at.x - c[0].at.x));
        y += a * ((c[i].at.y - c[0].at.y) + (c[i + 1].at.y - c[0].at.y));
    }
    double share = area > 0 ? 1 / (3 * area) : 0;
    *centroid = (tl_point2){c[0].at.x + x * share, c[0].at.y + y * share};
    return area;
}

static double smooth(double x)
{
    return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x);
}

/* Share of a corner by its turning angle. */
static double corner_share(tl_point2 before, tl_point2 here, tl_point2 after)
{
    tl_point2 u = tl_from_to(before, here), v = tl_from_to(here, after);
    double uv = (u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y);
    double s = u.x * v.y - u.y * v.x, ahead = u.x * v.x + u.y * v.y;
    if (s > 0 &&
        (ahead <= 0 || s * s >= TL_CORNER * TL_CORNER * uv)) /* the sine is less than the angle */
        return 1;
    double turn = tl_asin(fmin(1, fmax(-1, s / sqrt(uv))));
    turn = ahead < 0 ? TL_PI - turn : turn;
    return smooth((turn - TL_STRAIGHT) / (TL_CORNER - TL_STRAIGHT));
}

/* Gives each corner its share, to be blended by its turning angle, and each edge its fan area; drops corners of share
 * 0, whose fan area goes to the edge before. Returns the number of corners, and whether all are full. */
static size_t weigh_corners(tl_corner *c, size_t count, tl_point2 centroid, bool blend, bool *full)
{
    size_t blended = 0, solid = 0, kept = 0;
    for (size_t i = 0; i < count; i++) {
        tl_point2 before = c[i ? i - 1 : count - 1].at, here = c[i].at;
        tl_point2 after = c[i + 1 == count ? 0 : i + 1].at;
        c[i].share = blend ? corner_share(before, here, after) : 1;
        double fan = 0.5 * tl_cross2(centroid, here, after);
        c[i].fan = fan > 0 ? fan : 0;
        blended += c[i].share < 1;
        solid += c[i].share >= 1;
    }
    *full = blended == 0;
    if (*full)
        return count;
    if (solid < 3 || blended > 2 * solid)
        for (size_t i = 0; i < count; i++)
            c[i].share = 1; /* a round outline: its small turns are no wobble */
    size_t first = 0;
    while (c[first].share < 1)
        first++;
    if (first) { /* begin at a full corner, so that what is dropped has one before it */
        for (size_t turns = 0; turns < first; turns++) {
            tl_corner head = c[0];
            memmove(c, c + 1, (count - 1) * sizeof *c);
            c[count - 1] = head;
        }
    }
    for (size_t i = 0; i < count; i++)
        if (c[i].share > 0)
            c[kept++] = c[i];
        else
            c[kept - 1].fan += c[i].fan;
    return kept;
}

/* Everything a point needs to become one. */
typedef struct patch {
    tl_frame2 frame;
    tl_plane a, b; /* in A's frame */
    double weight; /* from area in the plane of the patch to area of the points */
    tl_point_rule rule;
    tl_point2 centroid;
    double near;    /* corners nearer to each other are one */
    double least;   /* area from which on there is a patch: faces may only touch along an edge */
    double reach;   /* gap beyond which there is none */
    uint32_t faces; /* key of the two faces */
    tl_patch_points *out;
} patch;

/* Adds a point for which there is room; without area it would carry nothing, and have no stress. */
static void add_point(const patch *p, tl_point2 at, double area, uint32_t key)
{
    tl_patch_points *out = p->out;
    size_t i = out->count;
    tl_columns_put(out->p, i, tl_frame2_point(&p->frame, at));
    out->area[i] = p->weight * area;
    out->key[i] = p->faces ^ key;
    out->count += p->weight * area > 0;
}

/* Adds the point that belongs to a corner. */
static void add_corner(const patch *p, const tl_corner *c, double area)
{
    double reach = p->rule.reach;
    tl_point2 at = {tl_drawn_in(reach, p->centroid.x, c->at.x),
                    tl_drawn_in(reach, p->centroid.y, c->at.y)};
    add_point(p, at, area, c->key);
}

/* Adds the point that belongs to the middle between two corners. */
static void add_middle(const patch *p, const tl_corner *c, const tl_corner *d, double area)
{
    double reach = p->rule.out;
    tl_point2 at = {tl_drawn_in(reach, p->centroid.x, 0.5 * (c->at.x + d->at.x)),
                    tl_drawn_in(reach, p->centroid.y, 0.5 * (c->at.y + d->at.y))};
    add_point(p, at, area, tl_key_of(TL_POINT_MIDDLE, c->key, d->key));
}

/* Adds middles and corners when all corners are full. */
static void add_full_edges(const patch *p, const tl_corner *c, size_t count)
{
    for (size_t i = 0; i < count && p->rule.middle > 0; i++)
        add_middle(p, &c[i], &c[i + 1 == count ? 0 : i + 1], p->rule.middle * c[i].fan);
    for (size_t i = 0; i < count; i++)
        add_corner(p, &c[i], p->rule.corner * (c[i ? i - 1 : count - 1].fan + c[i].fan));
}

/* The same with a mixture: for every two corners that may follow each other in the mixture, the rule
 * of their edge, times the chance that they do. */
static void add_edges(const patch *p, tl_corner *c, size_t count, double *corner_area)
{
    memset(corner_area, 0, count * sizeof *corner_area);
    for (size_t i = 0; i < count; i++) {
        double chance = c[i].share, fan = 0;
        for (size_t step = 1; step <= count && chance > 0; step++) {
            size_t j = (i + step) % count;
            fan += c[(i + step - 1) % count].fan;
            double share = step > BLEND_RUN ? 1 : c[j].share;
            double area = chance * share * fan;
            if (area > 0) {
                add_middle(p, &c[i], &c[j], p->rule.middle * area);
                corner_area[i] += p->rule.corner * area;
                corner_area[j] += p->rule.corner * area;
            }
            chance *= 1 - share;
        }
    }
    for (size_t i = 0; i < count; i++)
        add_corner(p, &c[i], corner_area[i]);
}

/* Projects both outlines, counter-clockwise seen against the patch normal, and clips. */
static size_t clip_faces(const tl_pair_view *view, uint32_t fa, uint32_t fb, const patch *one,
                         struct tl_polygon *p)
{
    const tl_poly *a = view->a, *b = view->b;
    uint32_t na = tl_poly_face_size(a, fa), nb = tl_poly_face_size(b, fb);
    for (uint32_t i = 0; i < na; i++)
        p->face[i] = tl_frame2_project(&one->frame, a->vertex[a->loop[a->start[fa] + i]]);
    for (uint32_t i = 0; i < nb; i++)
        p->clip[i] =
            tl_frame2_project(&one->frame, view->vertex_b[b->loop[b->start[fb] + nb - 1 - i]]);
    return tl_polygon_clip(p, na, nb, one->near);
}

/* Whether the edge of the polygon that is edge `edge` of one face lies along an edge of the other. */
static bool coincides(const struct tl_polygon *p, uint32_t na, uint32_t nb, uint32_t edge,
                      double near)
{
    bool of_b = edge >= TL_EDGE_B;
    uint32_t i = of_b ? edge - TL_EDGE_B : edge, own = of_b ? nb : na, others = of_b ? na : nb;
    const tl_point2 *face = of_b ? p->clip : p->face, *other = of_b ? p->face : p->clip;
    for (uint32_t j = 0; j < others; j++)
        if (tl_edges_coincide(face[i], face[i + 1 == own ? 0 : i + 1], other[j],
                              other[j + 1 == others ? 0 : j + 1], near))
            return true;
    return false;
}

/* The share by which the points of a polygon go along with B: that of the fan area over edges of B. When B moves against A by u
 * in the plane, the centroid of the polygon moves by this times u, in the mean over the directions of u. */
static double ride_of(const struct tl_polygon *p, size_t count, uint32_t na, uint32_t nb,
                      tl_point2 centroid, double near)
{
    double whole = 0, of_b = 0;
    for (size_t i = 0; i < count; i++) {
        const tl_corner *here = &p->now[i], *after = &p->now[i + 1 == count ? 0 : i + 1];
        double fan = 0.5 * tl_cross2(centroid, here->at, after->at);
        fan = fan > 0 ? fan : 0;
        whole += fan;
        of_b += fan * tl_edge_ride(here->edge >= TL_EDGE_B, coincides(p, na, nb, here->edge, near));
    }
    return of_b / whole;
}

/* Makes room for `count` points. */
static bool reserve(tl_patch_points *out, size_t count)
{
    if (count <= out->capacity)
        return true;
    size_t capacity = 2 * count;
    double *block =
        capacity > UINT16_MAX ? NULL : malloc(capacity * (4 * sizeof(double) + sizeof(uint32_t)));
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
static double least_gap(const patch *p, const tl_corner *c, size_t count)
{
    tl_patch_gap gap = tl_patch_gap_of(&p->frame, p->b);
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        double g = tl_gap_at(gap, c[i].at);
        least = g < least ? g : least;
    }
    return least;
}

/* The common polygon's points, by its corners in p->now; false when out of memory. */
static bool add_points(patch *one, struct tl_polygon *p, size_t count, double area)
{
    bool full;
    count = weigh_corners(p->now, count, one->centroid, !(one->rule.middle > 0), &full);
    /* a middle for every two corners that may follow each other, the corners, the centroid */
    if (!reserve(one->out, full ? 2 * count + 1 : (BLEND_RUN + 2) * count + 1))
        return false;
    if (full)
        add_full_edges(one, p->now, count);
    else /* the clipping is over: its room is free */
        add_edges(one, p->now, count, (double *)(void *)p->next);
    add_point(one, one->centroid, one->rule.centroid * area, tl_key_of(TL_POINT_CENTROID, 0, 0));
    return true;
}

double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_touch_rule *rule,
                    tl_narrow_scratch *scratch)
{
    const tl_poly *a = view->a, *b = view->b;
    patch one = {.rule = tl_point_rule_of(rule->corners && tl_at_corners(a, fa, b, fb)),
                 .near = TL_MERGE * view->size,
                 .least = TL_MERGE * fmax(a->size, b->size) * view->size,
                 .reach = rule->reach,
                 .faces = tl_key_of(0, fa, fb),
                 .out = &scratch->patch,
                 .a = a->plane[fa],
                 .b = tl_plane_placed(&view->turn, view->shift, b->plane[fb])};
    one.frame = tl_frame2_of(one.a.normal, one.b.normal, a->vertex[a->loop[a->start[fa]]]);
    one.weight = one.frame.secant;
    struct tl_polygon *p =
        tl_polygon_reserve(scratch, tl_poly_face_size(a, fa), tl_poly_face_size(b, fb));
    scratch->patch.count = 0;
    if (!p) {
        scratch->manifold.failed = true;
        return 0;
    }
    size_t count = clip_faces(view, fa, fb, &one, p);
    double area = count >= 3 ? area_of(p->now, count, &one.centroid) : 0;
    if (!(area > one.least))
        return 0;
    scratch->patch.ride = ride_of(p, count, tl_poly_face_size(a, fa), tl_poly_face_size(b, fb),
                                  one.centroid, one.near);
    tl_frame2_move(&one.frame, one.a, one.b, one.centroid);
    scratch->patch.gap = least_gap(&one, p->now, count);
    if (scratch->patch.gap > one.reach)
        return 0;
    if (!add_points(&one, p, count, area)) {
        scratch->manifold.failed = true;
        return 0;
    }
    return one.weight * area;
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
        m->points[m->point_count++] = (tl_contact_point){
            .p = tl_columns_get(from->p, i), .area = from->area[i], .key = from->key[i]};
    return area;
}
