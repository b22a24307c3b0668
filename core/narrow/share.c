/* share.c - the point share: the vertices and edges that a pair's axis rests on.
 *
 * Where the axis is the normal of a face, the other block *stands* on that face by the vertex that reaches farthest, and
 * by those that edges join to it which lie nearly in the face, all clipped to the face (stand.c). Where it is the normal
 * of two edges, they touch where they cross (crossing.c); and as far as one of them lies nearly in a face beside the
 * other, it stands on that face by its end over it, too. From there it goes on over the faces beside all edges that
 * cross. So nothing jumps where the axis goes over from the face to the edges: an edge that lies on a face and hangs
 * out over it may rest on either end and rock between them in no time, and a jump would keep it rocking. */
#include "narrow/share.h"

#include "base/table.h"
#include "narrow/crossing.h"
#include "narrow/room.h"
#include "narrow/stand.h"

#include <stdlib.h>
#include <string.h>

/* Sum of weights, 1 at the first vertex, below which nothing is left to share out: long chains of edges that hardly lie in
 * the face, and none of it over the face but their ends. */
#define FORLORN 1e-100
/* An arc is longer than its sine by no more than this, up to 25 degrees. */
#define ARC_OVER_SINE 1.04

/* 1 up to `full` degrees, 0 from `none` on, linear between. */
static double nearness(double sine, double full, double none)
{
    double least = sine * (180 / TL_PI);
    if (least >= none)
        return 0;
    if (ARC_OVER_SINE * least <= full)
        return 1;
    double x = (none - tl_asin(fmin(1, sine)) * (180 / TL_PI)) / (none - full);
    return fmin(1, fmax(0, x));
}

double tl_fade(double sine, double full, double none)
{
    double x = nearness(sine, full, none);
    return x * x * (3 - 2 * x);
}

double tl_fade_slope(double sine, double full, double none)
{
    double x = nearness(sine, full, none);
    return x <= 0 || x >= 1 ? 0 : -6 * x * (1 - x) * (180 / TL_PI) / (none - full);
}

/* ---------------------------------------------------------------- points ----------------- */

static bool same_point(const tl_share_point *a, const tl_share_point *b)
{
    return a->key == b->key && a->facet.kind == b->facet.kind && a->facet.ia == b->facet.ia &&
           a->facet.ib == b->facet.ib;
}

/* The weight of a point itself and of what stands beside it. */
static double all_of(const tl_share_point *p)
{
    double sum = p->weight.value;
    for (int k = 0; k < 4; k++)
        sum += p->beside[k].value;
    return sum;
}

void tl_share_points_add(tl_share_points *found, tl_share_point point)
{
    tl_narrow *room = found->room;
    if (!(all_of(&point) > 0))
        return;
    for (size_t i = 0; i < found->count; i++) {
        tl_share_point *there = &room->share[i];
        if (!same_point(there, &point))
            continue;
        if (all_of(there) < all_of(&point))
            *there = point; /* found from another face, too */
        return;
    }
    if (tl_grow(&room->share, &room->share_room, found->count + 1, sizeof *room->share))
        room->share[found->count++] = point;
    else
        room->manifold.failed = true;
}

static bool same_facet(const tl_facet *f, const tl_facet *g)
{
    return f->kind == g->kind && f->ia == g->ia && f->ib == g->ib && f->swing[0] == g->swing[0] &&
           f->swing[1] == g->swing[1] && f->swing[2] == g->swing[2];
}

/* The points that have the share between them, each by its weight; `swing` is the couple of all of it. Those that follow
 * each other have one facet, unless their weights vary differently with tilt. */
static void add_points(tl_manifold *m, const tl_share_point *list, size_t count, tl_vec3 swing)
{
    double sum = 0;
    tl_vec3 mean = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        sum += list[i].weight.value;
        mean = tl_v3_madd(mean, list[i].weight.value, list[i].weight.swing);
    }
    if (!(sum > FORLORN))
        return;
    mean = tl_v3_scale(1 / sum, mean);
    if (!tl_manifold_reserve_facets(m, m->facet_count + count))
        return;
    size_t first = m->facet_count;
    for (size_t i = 0; i < count; i++) {
        tl_contact_point point = {
            .p = list[i].p, .area = list[i].weight.value / sum, .key = (uint32_t)list[i].key};
        if (!(point.area > 0))
            continue;
        tl_facet facet = list[i].facet;
        tl_facet_set_swing(&facet, tl_v3_add(swing, tl_v3_sub(list[i].weight.swing, mean)));
        facet.begin = (uint16_t)m->point_count;
        if (!tl_manifold_add_point(m, point))
            return;
        if (m->facet_count == first || !same_facet(&m->facets[m->facet_count - 1], &facet))
            m->facets[m->facet_count++] = facet;
        m->facets[m->facet_count - 1].count++;
    }
}

/* ---------------------------------------------------------------- all of it -------------- */

/* Looks for what stands on the faces beside the edges that cross, and beside those found to cross there, the heaviest
 * first: an edge may lie across several faces with next to no angle between them. */
static void spread(const tl_pair_view *view, tl_share_points *found)
{
    for (;;) {
        const tl_share_point *list = found->room->share;
        size_t from = found->count;
        int to = 0;
        for (size_t i = 0; i < found->count; i++)
            for (int side = 0; side < 4; side++) {
                double most = from < found->count ? list[from].beside[to].value : 0;
                if (list[i].beside[side].value > most &&
                    !tl_stand_seen(view, &list[i], side, found)) {
                    from = i;
                    to = side;
                }
            }
        if (from == found->count)
            return;
        tl_share_point point = list[from]; /* the list may move as it grows */
        tl_stand_beside(view, &point, to, found);
    }
}

/* Room for one stand; false when out of memory. */
static bool found_begin(tl_share_points *found, const tl_pair_view *view, tl_narrow *room)
{
    size_t stand = tl_stand_room(view), faces = view->a->face_count + view->b->face_count;
    size_t seen = faces * sizeof(bool) / sizeof(double) + 1;
    if (!tl_grow(&room->dots, &room->dot_room, stand + seen, sizeof(double))) {
        room->manifold.failed = true;
        return false;
    }
    bool *marks = (void *)(room->dots + stand);
    memset(marks, 0, faces * sizeof *marks);
    *found = (tl_share_points){.room = room, .seen = {marks, marks + view->a->face_count}};
    return true;
}

static void add_axis_edges(const tl_pair_view *view, const tl_axis *axis, tl_share_points *found)
{
    tl_crossing edges = {axis->ia, axis->ib, tl_line_of(&view->a->edge[axis->ia], view->a->vertex),
                         tl_line_of(&view->b->edge[axis->ib], view->vertex_b), axis->n};
    tl_crossing_add(view, &edges, (tl_weight){.value = 1}, NULL, found);
}

void tl_share_add(const tl_pair_view *view, const tl_axis *axis, tl_vec3 swing, tl_narrow *room)
{
    tl_share_points found;
    if (!found_begin(&found, view, room))
        return;
    bool b_stands = axis->kind == TL_AXIS_FACE_A;
    if (axis->kind == TL_AXIS_EDGES)
        add_axis_edges(view, axis, &found);
    else
        tl_stand_on_face(view, b_stands, b_stands ? axis->ia : axis->ib, &found);
    spread(view, &found);
    if (!room->manifold.failed)
        add_points(&room->manifold, room->share, found.count, swing);
}
