/* common_polygon.c - the common polygon of two faces on each other: its corners, what each edge belongs to, and the
 * areas of corners.
 *
 * The two faces are projected along the bisector of their normals into the bisecting plane, where one clips the other.
 * Corners with a turning angle below TL_STRAIGHT may be left out. Between TL_STRAIGHT and TL_CORNER the areas are then
 * a mixture of those with and without the corner. So a corner that comes or goes while blocks wobble does not change
 * the force. */
#include "narrow/common_polygon.h"

#include "base/table.h"

#include <string.h>

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
    if (s > 0 && (ahead <= 0 || s * s >= TL_CORNER * TL_CORNER * uv)) /* the sine is less than the angle */
        return 1;
    double turn = tl_asin(fmin(1, fmax(-1, s / sqrt(uv))));
    turn = ahead < 0 ? TL_PI - turn : turn;
    return smooth(tl_turn_over(turn));
}

size_t tl_corners_weigh(tl_common_polygon *p, bool blend)
{
    tl_corner *c = p->corner;
    const size_t count = p->count;
    size_t blended = 0, solid = 0, kept = 0;
    for (size_t i = 0; i < count; i++) {
        tl_point2 before = c[i ? i - 1 : count - 1].at, here = c[i].at;
        tl_point2 after = c[i + 1 == count ? 0 : i + 1].at;
        c[i].share = blend ? corner_share(before, here, after) : 1;
        double fan = 0.5 * tl_cross2(p->centroid, here, after);
        c[i].fan = fan > 0 ? fan : 0;
        blended += c[i].share < 1;
        solid += c[i].share >= 1;
    }
    if (blended == 0)
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
    return p->count = kept;
}

void tl_corner_areas(const tl_corner *c, const double *fan, size_t count, double *area)
{
    memset(area, 0, count * sizeof *area);
    for (size_t i = 0; i < count; i++) {
        double chance = c[i].share, between = 0;
        for (size_t step = 1; step <= count && chance > 0; step++) {
            size_t j = (i + step) % count;
            double share = step > TL_BLEND_RUN ? 1 : c[j].share;
            between += fan[(i + step - 1) % count];
            double half = 0.5 * chance * share * between;
            area[i] += half;
            area[j] += half;
            chance *= 1 - share;
        }
    }
}

/* ---------------------------------------------------------------- clipping ----------------
 *
 * One face clips the other (Sutherland and Hodgman 1974). Where an edge of A crosses one of B, the place follows from
 * the corners of both faces, not from what earlier lines have left. So it is the same to the bit however the
 * crossing was found (patch_batch.c). */

/* Makes room for faces of `na` and `nb` corners; false when out of memory. */
static bool reserve(tl_outlines *p, size_t na, size_t nb)
{
    /* each clip adds a corner, or two where rounding makes it cross a straight run of corners twice */
    const size_t corners = na + 2 * nb + 4;
    if (!tl_grow(&p->corner, &p->corner_capacity, 2 * corners, sizeof *p->corner) ||
        !tl_grow(&p->face, &p->face_capacity, na + nb, sizeof *p->face))
        return false;
    p->now = p->corner;
    p->next = p->corner + corners;
    p->clip = p->face + na;
    return true;
}

/* What the corner is where edges `one` and `other` of B meet at `cut`: B's own, if they are neighbours. */
static tl_corner meet(uint32_t one, uint32_t other, tl_point2 cut, const tl_point2 *clip, uint32_t count)
{
    tl_corner c = {.at = cut};
    uint32_t i = one - TL_EDGE_B, j = other - TL_EDGE_B;
    if ((i + 1) % count == j || (j + 1) % count == i) {
        uint32_t v = (i + 1) % count == j ? j : i;
        c.at = clip[v];
        c.key = tl_corner_key(TL_POINT_B, v);
        return c;
    }
    c.key = one < other ? tl_key_of(TL_POINT_CROSSING, one, other) : tl_key_of(TL_POINT_CROSSING, other, one);
    return c;
}

/* Where edge i of A crosses line j of B, from o to q. */
static tl_corner cross(const tl_outlines *p, uint32_t na, uint32_t i, uint32_t j, tl_point2 o, tl_point2 q)
{
    tl_point2 from = p->face[i], to = p->face[i + 1 == na ? 0 : i + 1];
    return (tl_corner){.at = tl_part_way(from, to, tl_cross2(o, q, from), tl_cross2(o, q, to)),
                       .key = tl_key_of(TL_POINT_CROSSING, i, TL_EDGE_B + j)};
}

/* Keeps what lies left of the line from clip[j] to clip[j + 1]; returns the number of corners. */
static size_t clip_by(tl_outlines *p, size_t count, uint32_t na, uint32_t j, uint32_t nb, double near)
{
    tl_point2 o = p->clip[j], q = p->clip[j + 1 == nb ? 0 : j + 1];
    double low = 0, on2 = near * near * tl_distance2(o, q);
    for (size_t i = 0; i < count; i++) {
        double h = tl_cross2(o, q, p->now[i].at);
        p->now[i].height = h * h > on2 ? h : 0;
        low = p->now[i].height < low ? p->now[i].height : low;
    }
    if (low == 0)
        return count; /* all of it: most lines cut nothing */
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const tl_corner *here = &p->now[i], *after = &p->now[i + 1 == count ? 0 : i + 1];
        double h = here->height, g = after->height;
        if (h >= 0)
            p->next[kept++] = *here;
        if (h == 0 && g < 0) /* the line passes through the corner: it only changes its edge */
            p->next[kept - 1].edge = TL_EDGE_B + j;
        if (!((h > 0 && g < 0) || (h < 0 && g > 0)))
            continue;
        tl_corner c = here->edge < TL_EDGE_B
                          ? cross(p, na, here->edge, j, o, q)
                          : meet(here->edge, TL_EDGE_B + j, tl_part_way(here->at, after->at, h, g), p->clip, nb);
        c.edge = h > 0 ? TL_EDGE_B + j : here->edge;
        p->next[kept++] = c;
    }
    tl_corner *swap = p->now;
    p->now = p->next;
    p->next = swap;
    return kept;
}

static size_t merge_near(tl_outlines *p, size_t count, double near)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || tl_distance2(p->now[i].at, p->now[kept - 1].at) > near * near)
            p->now[kept++] = p->now[i];
        else
            p->now[kept - 1].edge = p->now[i].edge;
    while (kept > 1 && tl_distance2(p->now[kept - 1].at, p->now[0].at) <= near * near)
        kept--;
    return kept;
}

/* Turns the list so that it begins with the lowest edge: the same polygon is the same list. */
static void begin_at_lowest(tl_outlines *p, size_t count)
{
    size_t first = 0;
    for (size_t i = 1; i < count; i++)
        first = p->now[i].edge < p->now[first].edge ? i : first;
    if (first == 0)
        return;
    memcpy(p->next, p->now + first, (count - first) * sizeof *p->now);
    memcpy(p->next + (count - first), p->now, first * sizeof *p->now);
    tl_corner *swap = p->now;
    p->now = p->next;
    p->next = swap;
}

/* Clips `face` by `clip`: into `now`, beginning with the corner whose edge has the lowest number; corners nearer
 * than `near` are one. Returns their number. */
static size_t clip_outlines(tl_outlines *p, uint32_t na, uint32_t nb, double near)
{
    for (uint32_t i = 0; i < na; i++)
        p->now[i] = (tl_corner){.at = p->face[i], .key = tl_corner_key(TL_POINT_A, i), .edge = i};
    size_t count = na;
    for (uint32_t j = 0; j < nb && count; j++)
        count = clip_by(p, count, na, j, nb, near);
    count = merge_near(p, count, near);
    begin_at_lowest(p, count);
    return count;
}

/* Projects both outlines, counter-clockwise seen against the patch normal, and clips. */
static size_t clip_faces(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_common_polygon *of,
                         tl_outlines *p)
{
    const tl_poly *a = view->a, *b = view->b;
    for (uint32_t i = 0; i < of->na; i++)
        p->face[i] = tl_frame2_project(&of->frame, a->vertex[a->loop[a->start[fa] + i]]);
    for (uint32_t i = 0; i < of->nb; i++)
        p->clip[i] = tl_frame2_project(&of->frame, view->vertex_b[b->loop[b->start[fb] + of->nb - 1 - i]]);
    return clip_outlines(p, of->na, of->nb, of->near);
}

bool tl_common_polygon_find(const tl_pair_view *view, uint32_t fa, uint32_t fb, tl_narrow_scratch *scratch,
                            tl_common_polygon *out)
{
    const tl_poly *a = view->a, *b = view->b;
    const double least = TL_MERGE * fmax(a->size, b->size) * view->size;
    *out = (tl_common_polygon){.na = tl_poly_face_size(a, fa),
                               .nb = tl_poly_face_size(b, fb),
                               .a = a->plane[fa],
                               .b = tl_plane_placed(&view->turn, view->shift, b->plane[fb]),
                               .near = TL_MERGE * view->size};
    out->frame = tl_frame2_of(out->a.normal, out->b.normal, a->vertex[a->loop[a->start[fa]]]);
    tl_outlines *p = &scratch->outlines;
    if (!reserve(p, out->na, out->nb))
        return false;
    const size_t count = clip_faces(view, fa, fb, out, p);
    out->outlines = p;
    out->corner = p->now;
    out->area = count >= 3 ? area_of(p->now, count, &out->centroid) : 0;
    out->count = out->area > least ? count : 0;
    if (out->count)
        tl_frame2_move(&out->frame, out->a, out->b, out->centroid);
    return true;
}

double tl_common_edge_ride(const tl_common_polygon *of, uint32_t edge)
{
    const bool of_b = edge >= TL_EDGE_B;
    const uint32_t i = of_b ? edge - TL_EDGE_B : edge;
    const uint32_t own = of_b ? of->nb : of->na, others = of_b ? of->na : of->nb;
    const tl_point2 *face = of_b ? of->outlines->clip : of->outlines->face;
    const tl_point2 *other = of_b ? of->outlines->face : of->outlines->clip;
    bool coincides = false;
    for (uint32_t j = 0; j < others && !coincides; j++)
        coincides = tl_edges_coincide(face[i], face[i + 1 == own ? 0 : i + 1], other[j],
                                      other[j + 1 == others ? 0 : j + 1], of->near);
    return tl_edge_ride(of_b, coincides);
}
