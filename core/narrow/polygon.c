/* polygon.c - the common polygon of two convex faces in a plane: one clips the other (Sutherland and Hodgman
 * 1974).
 *
 * Where an edge of A crosses one of B, the place follows from the corners of both faces, not from what earlier
 * lines have left, so that it is the same to the bit however the crossing was found (patch_batch.c). */
#include "narrow/polygon.h"

#include <stdlib.h>
#include <string.h>

void tl_polygon_free(struct tl_polygon *polygon, tl_patch_points *points)
{
    free(points->p[0]);
    if (!polygon)
        return;
    free(polygon->now);
    free(polygon->next);
    free(polygon->face);
    free(polygon->batch);
    free(polygon);
}

struct tl_polygon *tl_polygon_reserve(tl_narrow_scratch *scratch, size_t na, size_t nb)
{
    if (!scratch->polygon && !(scratch->polygon = calloc(1, sizeof *scratch->polygon)))
        return NULL;
    struct tl_polygon *p = scratch->polygon;
    /* each clip adds a corner, or two where rounding makes it cross a straight run of corners twice */
    size_t corners = na + 2 * nb + 4;
    if (corners > p->capacity) {
        free(p->now);
        free(p->next);
        p->now = malloc(2 * corners * sizeof *p->now);
        p->next = malloc(2 * corners * sizeof *p->next);
        p->capacity = p->now && p->next ? 2 * corners : 0;
    }
    if (na + nb > p->face_capacity) {
        free(p->face);
        p->face = malloc(2 * (na + nb) * sizeof *p->face);
        p->face_capacity = p->face ? 2 * (na + nb) : 0;
    }
    p->clip = p->face + na;
    return corners <= p->capacity && na + nb <= p->face_capacity ? p : NULL;
}

/* What the corner is where edges `one` and `other` of B meet at `cut`: B's own, if they are neighbours. */
static tl_corner meet(uint32_t one, uint32_t other, tl_point2 cut, const tl_point2 *clip,
                      uint32_t count)
{
    tl_corner c = {.at = cut};
    uint32_t i = one - TL_EDGE_B, j = other - TL_EDGE_B;
    if ((i + 1) % count == j || (j + 1) % count == i) {
        uint32_t v = (i + 1) % count == j ? j : i;
        c.at = clip[v];
        c.key = tl_corner_key(TL_POINT_B, v);
        return c;
    }
    c.key = one < other ? tl_key_of(TL_POINT_CROSSING, one, other)
                        : tl_key_of(TL_POINT_CROSSING, other, one);
    return c;
}

/* Where edge i of A crosses line j of B, from o to q. */
static tl_corner cross(const struct tl_polygon *p, uint32_t na, uint32_t i, uint32_t j, tl_point2 o,
                       tl_point2 q)
{
    tl_point2 from = p->face[i], to = p->face[i + 1 == na ? 0 : i + 1];
    return (tl_corner){.at = tl_part_way(from, to, tl_cross2(o, q, from), tl_cross2(o, q, to)),
                       .key = tl_key_of(TL_POINT_CROSSING, i, TL_EDGE_B + j)};
}

/* Keeps what lies left of the line from clip[j] to clip[j + 1]; returns the number of corners. */
static size_t clip_by(struct tl_polygon *p, size_t count, uint32_t na, uint32_t j, uint32_t nb,
                      double near)
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
                          : meet(here->edge, TL_EDGE_B + j, tl_part_way(here->at, after->at, h, g),
                                 p->clip, nb);
        c.edge = h > 0 ? TL_EDGE_B + j : here->edge;
        p->next[kept++] = c;
    }
    tl_corner *swap = p->now;
    p->now = p->next;
    p->next = swap;
    return kept;
}

static size_t merge_near(struct tl_polygon *p, size_t count, double near)
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
static void begin_at_lowest(struct tl_polygon *p, size_t count)
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

size_t tl_polygon_clip(struct tl_polygon *p, uint32_t na, uint32_t nb, double near)
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
