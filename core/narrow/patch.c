/* patch.c - face on face: the contact polygon and its contact points.
 *
 * The two faces are projected along the bisector of their normals into the bisecting plane, where one
 * clips the other (Sutherland and Hodgman 1974). Contact points lie at the polygon's corners, middles
 * of edges and area centroid; with a_i the area of the fan triangle of edge i about the centroid, a
 * corner has the area (a_{i-1} + a_i)/12, a middle a_i/3, the centroid half of all. These weights
 * integrate any linear gap, and its moments, exactly. With points at the corners only, each takes half of
 * its two fan triangles: resultants are right, turning is up to three times too stiff.
 *
 * The gap at a corner opens along the normal of the features that make it: of B's face where a vertex of A
 * stands on it, of A's face where B's vertex does, of both edges where two cross (a point's *lean*);
 * middles and centroid lie between their corners, in this too. With the bisector for all, a force would do
 * work along a smooth tilted face. Areas are those on the faces, not in the bisecting plane, so
 * that the area of a face that lies wholly on another does not change as it tilts.
 *
 * Corners with a turning angle below TL_STRAIGHT are left out. Between TL_STRAIGHT and TL_CORNER the points are
 * a mixture of those with and without the corner, so that a corner that comes or goes while blocks
 * wobble does not change the force. */
#include "narrow/patch.h"

#include "base/columns.h"
#include "narrow/frame2.h"
#include "narrow/polygon.h"
#include "narrow/room.h"

#include <stdlib.h>
#include <string.h>

/* Longest run of blended corners that is mixed; longer runs belong to round outlines. */
#define BLEND_RUN 3

/* Of a mean of corners. */
static tl_lean between(tl_lean a, tl_lean b)
{
    return (tl_lean){0.5f * (a.face + b.face), 0.5f * (a.edge + b.edge)};
}

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

/* Gives each corner its share by its turning angle and each edge its fan area; drops corners of share
 * 0, whose fan area goes to the edge before. Returns the number of corners, and whether all are full. */
static size_t weigh_corners(tl_corner *c, size_t count, tl_point2 centroid, bool *full)
{
    size_t blended = 0, solid = 0, kept = 0;
    for (size_t i = 0; i < count; i++) {
        tl_point2 before = c[i ? i - 1 : count - 1].at, here = c[i].at;
        tl_point2 after = c[i + 1 == count ? 0 : i + 1].at;
        c[i].share = corner_share(before, here, after);
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
    double corner,
        middle;     /* of the fan triangle of an edge: the share of each end, of its middle */
    double near;    /* corners nearer to each other are one */
    double least;   /* area from which on there is a patch */
    double reach;   /* gap beyond which there is none */
    uint32_t faces; /* key of the two faces */
    tl_patch_points *out;
} patch;

/* Adds a point for which there is room; without area it would carry nothing, and have no stress. */
static void add_point(const patch *p, tl_point2 at, tl_lean lean, double area, uint32_t key)
{
    tl_patch_points *out = p->out;
    size_t i = out->count;
    tl_columns_put(out->p, i, tl_frame2_point(&p->frame, at));
    out->lean[i] = lean;
    out->area[i] = p->weight * area;
    out->key[i] = p->faces ^ key;
    out->count += p->weight * area > 0;
}

/* Adds middles and corners when all corners are full. */
static void add_full_edges(const patch *p, const tl_corner *c, size_t count)
{
    for (size_t i = 0; i < count && p->middle > 0; i++) {
        const tl_corner *next = &c[i + 1 == count ? 0 : i + 1];
        tl_point2 middle = {0.5 * (c[i].at.x + next->at.x), 0.5 * (c[i].at.y + next->at.y)};
        add_point(p, middle, between(c[i].lean, next->lean), p->middle * c[i].fan,
                  tl_key_of(TL_POINT_MIDDLE, c[i].key, next->key));
    }
    for (size_t i = 0; i < count; i++) {
        double fans = c[i ? i - 1 : count - 1].fan + c[i].fan;
        add_point(p, c[i].at, c[i].lean, p->corner * fans, c[i].key);
    }
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
                tl_point2 middle = {0.5 * (c[i].at.x + c[j].at.x), 0.5 * (c[i].at.y + c[j].at.y)};
                add_point(p, middle, between(c[i].lean, c[j].lean), p->middle * area,
                          tl_key_of(TL_POINT_MIDDLE, c[i].key, c[j].key));
                corner_area[i] += p->corner * area;
                corner_area[j] += p->corner * area;
            }
            chance *= 1 - share;
        }
    }
    for (size_t i = 0; i < count; i++)
        add_point(p, c[i].at, c[i].lean, corner_area[i], c[i].key);
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
    return tl_polygon_clip(p, na, nb, one->near, one->frame.rise);
}

/* Makes room for `count` points. */
static bool reserve(tl_patch_points *out, size_t count)
{
    if (count <= out->room)
        return true;
    size_t room = 2 * count;
    double *block = room > UINT16_MAX
                        ? NULL
                        : malloc(room * (4 * sizeof(double) + sizeof(tl_lean) + sizeof(uint32_t)));
    if (!block)
        return false;
    free(out->p[0]);
    for (int k = 0; k < 3; k++)
        out->p[k] = block + (size_t)k * room;
    out->area = block + 3 * room;
    out->lean = (tl_lean *)(void *)(block + 4 * room);
    out->key = (uint32_t *)(void *)(out->lean + room);
    out->room = room;
    return true;
}

/* Whether every gap is beyond reach. The smallest is at a corner, and no larger than the centroid's. */
static bool out_of_reach(const patch *p, const tl_corner *c, size_t count, tl_point2 centroid)
{
    tl_patch_gap gap = tl_patch_gap_of(&p->frame, p->b);
    if (tl_gap_at(gap, centroid) <= p->reach)
        return false;
    double nearest = INFINITY;
    for (size_t i = 0; i < count; i++) {
        double g = tl_gap_at(gap, c[i].at);
        nearest = g < nearest ? g : nearest;
    }
    return nearest > p->reach;
}

/* Of the centroid, which is a mean of the corners by their fan triangles. */
static tl_lean mean_lean(const tl_corner *c, size_t count)
{
    double face = 0, edge = 0, area = 0;
    for (size_t i = 0; i < count; i++) {
        double fans = c[i ? i - 1 : count - 1].fan + c[i].fan;
        face += fans * c[i].lean.face;
        edge += fans * c[i].lean.edge;
        area += fans;
    }
    return (tl_lean){(float)(face / area), (float)(edge / area)};
}

double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    const tl_share_rule *rule, tl_narrow *room)
{
    const tl_poly *a = view->a, *b = view->b;
    patch one = {.corner = tl_corner_weight(rule->corners),
                 .middle = tl_middle_weight(rule->corners),
                 .near = TL_MERGE * view->size,
                 .least = TL_THIN * fmax(a->size, b->size) * view->size,
                 .reach = rule->reach,
                 .faces = tl_key_of(0, fa, fb),
                 .out = &room->patch,
                 .a = a->plane[fa],
                 .b = tl_plane_placed(&view->turn, view->shift, b->plane[fb])};
    one.frame = tl_frame2_of(one.a.normal, one.b.normal, a->vertex[a->loop[a->start[fa]]]);
    one.weight = weight * one.frame.secant;
    struct tl_polygon *p =
        tl_polygon_room(room, tl_poly_face_size(a, fa), tl_poly_face_size(b, fb));
    room->patch.count = 0;
    if (!p) {
        room->manifold.failed = true;
        return 0;
    }
    size_t count = clip_faces(view, fa, fb, &one, p);
    tl_point2 centroid = {0, 0};
    double area = count >= 3 ? area_of(p->now, count, &centroid) : 0;
    if (!(area > one.least))
        return 0;
    tl_frame2_move(&one.frame, one.a, one.b, centroid);
    if (out_of_reach(&one, p->now, count, centroid))
        return 0;
    bool full;
    count = weigh_corners(p->now, count, centroid, &full);
    /* a middle for every two corners that may follow each other, the corners, the centroid */
    if (!reserve(one.out, full ? 2 * count + 1 : (BLEND_RUN + 2) * count + 1)) {
        room->manifold.failed = true;
        return 0;
    }
    if (full)
        add_full_edges(&one, p->now, count);
    else /* the clipping is over: its room is free */
        add_edges(&one, p->now, count, (double *)(void *)p->next);
    add_point(&one, centroid, mean_lean(p->now, count), (1 - 2 * one.corner - one.middle) * area,
              tl_key_of(TL_POINT_CENTROID, 0, 0));
    return one.weight * area;
}

double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    tl_vec3 swing, const tl_share_rule *rule, tl_narrow *room)
{
    double area = tl_patch_lay(view, fa, fb, weight, rule, room);
    tl_manifold *m = &room->manifold;
    const tl_patch_points *from = &room->patch;
    if (!(area > 0) || !tl_manifold_reserve(m, from->count))
        return 0;
    tl_plane plane = view->b->plane[fb];
    tl_facet facet = {.kind = TL_FACET_PATCH,
                      .ia = (uint16_t)fa,
                      .ib = (uint16_t)fb,
                      .begin = (uint16_t)m->point_count,
                      .count = (uint16_t)from->count,
                      .na = view->a->plane[fa].normal,
                      .nb = plane.normal,
                      .offset = view->a->plane[fa].offset + plane.offset};
    tl_facet_set_swing(&facet, swing);
    m->facets[m->facet_count++] = facet;
    for (size_t i = 0; i < from->count; i++)
        m->points[m->point_count++] = (tl_contact_point){.p = tl_columns_get(from->p, i),
                                                         .lean = from->lean[i],
                                                         .area = from->area[i],
                                                         .key = from->key[i]};
    return area;
}
