/* stand.c - where a block stands on a face of the other: on the vertices that lie in the face, and where edges that lie in
 * it cross its border.
 *
 * From one vertex the others are found along the edges between them, as far as these lie nearly in the face: a chain of
 * edges hands on the product of what each lies in it. So nothing jumps where another vertex becomes the lowest. */
#include "narrow/stand.h"

#include "base/random.h"
#include "narrow/crossing.h"
#include "narrow/share.h"

#include <string.h>

/* A vertex this near the border of a face, relative to the size, is over it. */
#define BORDER 1e-9
/* Tilt of an edge and a face up to which the edge lies in the face, and from which not at all: degrees. */
#define LYING_FULL 0.25
#define LYING_NONE 1.0
/* Square of the sine of the latter. */
#define LYING_SINE2 0.00030458649045213493
/* No edge. */
#define NO_EDGE UINT32_MAX

/* ---------------------------------------------------------------- feet and beams -------- */

/* How far none of some edges lies in a face: 1 when none does at all, 0 when one fully does. */
typedef struct none_of {
    double value, some; /* they add up to 1, but of edges that hardly lie in it only `some` tells */
    tl_vec3 change;     /* derivative of the first against B's turn */
} none_of;

static const none_of no_edges = {.value = 1};

/* Outward normal of a face of the block on which the other one stands. */
static tl_vec3 face_up(const tl_pair_view *view, bool b_stands, uint32_t face)
{
    return b_stands ? view->a->plane[face].normal : view->normal_b[face];
}

static none_of none_with(none_of n, tl_weight lies)
{
    tl_vec3 change = tl_v3_scale(1 - lies.value, n.change);
    return (none_of){n.value * (1 - lies.value), n.some + lies.value * n.value,
                     tl_v3_madd(change, -lies.value * n.value, lies.swing)};
}

/* A vertex of the block that stands. */
typedef struct foot {
    uint16_t vertex;
    tl_weight share;
    bool settled; /* it will not get more */
    bool over;    /* over the face */
    bool beamed;  /* an edge from it lies in the face */
    none_of none; /* of one that is not over it: of its edges that come over the face */
} foot;

/* An edge that lies in the face, from the end with the larger share, and the part of it over the face (see over). */
typedef struct beam {
    size_t end[2]; /* of the feet */
    uint16_t edge;
    tl_weight lies;
    double t[2];
    size_t side[2];
} beam;

/* A face of one block and the other block standing on it; all in A's frame. */
typedef struct stand {
    const tl_pair_view *view;
    bool b_stands;
    const tl_poly *standing;
    const tl_vec3 *vertex;           /* of `standing` */
    const tl_vec3 *corners, *inward; /* of the face, and along it from each side */
    size_t corner_count;
    uint32_t face;
    tl_vec3 up; /* the face's outward normal */
    double slack;
    foot *feet;      /* [vertices of `standing`] those with a share */
    uint16_t *place; /* [vertices of `standing`] 1 + that among the feet, or 0 */
    beam *beams;     /* [edges of `standing`] */
    size_t foot_count, beam_count;
    uint32_t entry; /* the edge of the first foot that is known to cross the border, or NO_EDGE */
    tl_share_points *found; /* to which it adds its points */
} stand;

/* How nearly an edge along d of the standing block lies in the face that looks up. */
static tl_weight lying(bool b_stands, tl_vec3 up, tl_vec3 d)
{
    double rise = tl_v3_dot(up, d), length2 = tl_v3_norm2(d);
    if (rise * rise >= LYING_SINE2 * length2) /* most edges */
        return (tl_weight){0};
    double sine = fabs(rise) / sqrt(length2);
    tl_weight out = {.value = tl_fade(sine, LYING_FULL, LYING_NONE)};
    /* by B's turn, when B has the edge; when it has the face, the other way round */
    double slope = (b_stands ? -1 : 1) * tl_fade_slope(sine, LYING_FULL, LYING_NONE);
    if (slope != 0)
        out.swing =
            tl_v3_scale((rise < 0 ? -slope : slope) / out.value, tl_v3_unit(tl_v3_cross(d, up)));
    return out;
}

/* Gives a vertex that share, unless it has a larger one; returns its place among the feet. */
static size_t give_share(stand *s, uint16_t vertex, tl_weight w)
{
    if (s->place[vertex] == 0) {
        s->feet[s->foot_count] = (foot){.vertex = vertex, .none = no_edges};
        s->place[vertex] = (uint16_t)++s->foot_count;
    }
    foot *f = &s->feet[s->place[vertex] - 1];
    if (w.value > f->share.value)
        f->share = w;
    return s->place[vertex] - 1u;
}

/* The foot of the largest share among those not settled; the number of feet when all are. */
static size_t next_foot(const stand *s)
{
    size_t best = s->foot_count;
    for (size_t i = 0; i < s->foot_count; i++)
        if (!s->feet[i].settled &&
            (best == s->foot_count || s->feet[i].share.value > s->feet[best].share.value))
            best = i;
    return best;
}

/* Gives the vertex at the other end of an edge that share times what the edge lies in the face. */
static void add_beam(stand *s, size_t from, uint32_t edge, tl_weight share)
{
    const tl_edge *e = &s->standing->edge[edge];
    uint16_t v = s->feet[from].vertex, u = e->a == v ? e->b : e->a;
    if (s->place[u] && s->feet[s->place[u] - 1].settled)
        return;
    tl_weight lies = lying(s->b_stands, s->up, tl_v3_sub(s->vertex[u], s->vertex[v]));
    if (!(lies.value > 0))
        return;
    size_t to = give_share(s, u, tl_weight_product(share, lies));
    s->beams[s->beam_count++] = (beam){.end = {from, to}, .edge = (uint16_t)edge, .lies = lies};
}

/* The vertices that rest on the face with those there are, and the edges between them. Each has the largest share that a
 * chain of edges from the first one leaves it, so that it does not matter at which of several that lie in the
 * face the chains begin. */
static void find_feet(stand *s)
{
    const tl_poly *p = s->standing;
    for (size_t i; (i = next_foot(s)) < s->foot_count;) {
        s->feet[i].settled = true;
        for (uint32_t e = 0; e < p->edge_count; e++)
            if (p->edge[e].a == s->feet[i].vertex || p->edge[e].b == s->feet[i].vertex)
                add_beam(s, i, e, s->feet[i].share);
    }
}

/* The part t0 .. t1 of the segment from p to q over the face, `slack` beyond its border included, and over which sides of
 * the face it comes and goes where these are not its ends. */
static bool over(const stand *s, tl_vec3 p, tl_vec3 q, double t[2], size_t side[2])
{
    t[0] = 0;
    t[1] = 1;
    for (size_t i = 0; i < s->corner_count; i++) {
        double hp = tl_v3_dot(s->inward[i], tl_v3_sub(p, s->corners[i])) + s->slack;
        double hq = tl_v3_dot(s->inward[i], tl_v3_sub(q, s->corners[i])) + s->slack;
        if (hp < 0 && hq < 0)
            return false;
        int end = hp < 0 ? 0 : 1;
        double at = hp < 0 || hq < 0 ? hp / (hp - hq) : 2;
        if (at <= 1 && (end ? at < t[1] : at > t[0])) {
            t[end] = at;
            side[end] = i;
        }
    }
    return t[0] <= t[1];
}

/* The edge along a side of a face. */
static uint32_t side_edge(const tl_poly *p, uint32_t face, size_t side)
{
    uint32_t h = p->start[face] + (uint32_t)side;
    uint16_t from = p->loop[h], to = p->loop[tl_poly_after(p, face, h)];
    for (uint32_t e = 0; e < p->edge_count; e++)
        if ((p->edge[e].a == from && p->edge[e].b == to) ||
            (p->edge[e].a == to && p->edge[e].b == from))
            return e;
    return 0; /* every side has one */
}

static tl_facet face_facet(const tl_pair_view *view, uint32_t face, bool b_stands)
{
    if (b_stands) {
        tl_plane plane = view->a->plane[face];
        return (tl_facet){.kind = TL_FACET_FACE_A,
                          .ia = (uint16_t)face,
                          .na = plane.normal,
                          .offset = plane.offset};
    }
    tl_plane plane = view->b->plane[face];
    return (tl_facet){
        .kind = TL_FACET_FACE_B, .ib = (uint16_t)face, .nb = plane.normal, .offset = plane.offset};
}

/* Clips an edge to the face, and notes what that tells of its ends; false when it is nowhere over it. */
static bool clip_beam(stand *s, beam *e)
{
    for (int k = 0; k < 2; k++)
        s->feet[e->end[k]].beamed = true;
    if (!over(s, s->vertex[s->feet[e->end[0]].vertex], s->vertex[s->feet[e->end[1]].vertex], e->t,
              e->side))
        return false;
    for (int k = 0; k < 2; k++) {
        foot *f = &s->feet[e->end[k]];
        if (e->t[k] == k)
            f->over = true;
        else
            f->none = none_with(f->none, e->lies);
    }
    return true;
}

/* Where an edge that lies in the face crosses its border on the way to an end that is not over it: edges touch there,
 * not a vertex and a face. Such an end has its share where its edges come over the face, all of it where one of them
 * fully lies in it. */
static void add_crossing(stand *s, const beam *e, int end)
{
    const foot *f = &s->feet[e->end[end]];
    const tl_poly *base = s->b_stands ? s->view->a : s->view->b;
    uint32_t border = side_edge(base, s->face, e->side[end]);
    tl_crossing x = {.ia = s->b_stands ? border : e->edge, .ib = s->b_stands ? e->edge : border};
    x.a = tl_line_of(&s->view->a->edge[x.ia], s->view->a->vertex);
    x.b = tl_line_of(&s->view->b->edge[x.ib], s->view->vertex_b);
    tl_vec3 out = s->b_stands ? s->up : tl_v3_neg(s->up), n = tl_v3_cross(x.a.unit, x.b.unit);
    double sine = tl_v3_norm(n), some = f->none.some;
    if (!(sine > 0))
        return;
    x.n = tl_v3_scale((tl_v3_dot(n, out) < 0 ? -1 : 1) / sine, n);
    tl_weight part = {e->lies.value / some, tl_v3_madd(e->lies.swing, 1 / some, f->none.change)};
    tl_from from = {s->b_stands, s->face, e->lies,
                    tl_crossing_likeness(s->b_stands, out, x.n, &x.a, &x.b)};
    tl_crossing_add(s->view, &x, tl_weight_product(f->share, part), &from, s->found);
}

static void add_foot(stand *s, const foot *f)
{
    const tl_pair_view *view = s->view;
    tl_vec3 x = s->vertex[f->vertex];
    tl_share_points_add(
        s->found,
        (tl_share_point){.facet = face_facet(view, s->face, s->b_stands),
                         .p = s->b_stands ? tl_m3_tmul(&view->turn, tl_v3_sub(x, view->shift)) : x,
                         .weight = f->share,
                         .key = tl_key(s->b_stands ? 1 : 2, f->vertex)});
}

/* The end of a beam by which the block is known to stand on the face: its crossing is there. */
static bool enters(const stand *s, const beam *e, int end)
{
    return e->edge == s->entry && e->end[end] == 0;
}

static void add_feet(stand *s)
{
    size_t crossing = 0; /* beams that are somewhere over the face come first */
    for (size_t i = 0; i < s->beam_count; i++)
        if (clip_beam(s, &s->beams[i]))
            s->beams[crossing++] = s->beams[i];
    for (size_t i = 0; i < crossing; i++)
        for (int end = 0; end < 2; end++)
            if (s->beams[i].t[end] != end && !enters(s, &s->beams[i], end))
                add_crossing(s, &s->beams[i], end);
    for (size_t i = s->entry == NO_EDGE ? 0 : 1; i < s->foot_count; i++) {
        const foot *f = &s->feet[i];
        tl_vec3 x = s->vertex[f->vertex];
        double t[2];
        size_t side[2];
        if (f->over || (!f->beamed && over(s, x, x, t, side)))
            add_foot(s, f);
    }
}

/* Vertex of the standing block that reaches farthest into the face. */
static uint16_t lowest_vertex(const stand *s)
{
    uint16_t low = 0;
    for (uint16_t i = 1; i < s->standing->vertex_count; i++)
        if (tl_v3_dot(s->up, s->vertex[i]) < tl_v3_dot(s->up, s->vertex[low]))
            low = i;
    return low;
}

size_t tl_stand_room(const tl_pair_view *view)
{
    size_t v = view->a->vertex_count + view->b->vertex_count;
    size_t e = view->a->edge_count + view->b->edge_count;
    size_t bytes =
        2 * v * sizeof(tl_vec3) + v * sizeof(foot) + e * sizeof(beam) + v * sizeof(uint16_t);
    return bytes / sizeof(double) + 1;
}

/* A face of a block and the other one, nothing of which stands on it yet. */
static stand stand_of(const tl_pair_view *view, bool b_stands, uint32_t face,
                      tl_share_points *found)
{
    const tl_poly *base = b_stands ? view->a : view->b;
    const tl_vec3 *vertex = b_stands ? view->a->vertex : view->vertex_b;
    stand s = {.view = view,
               .b_stands = b_stands,
               .standing = b_stands ? view->b : view->a,
               .vertex = b_stands ? view->vertex_b : view->a->vertex,
               .corner_count = tl_poly_face_size(base, face),
               .face = face,
               .up = face_up(view, b_stands, face),
               .slack = BORDER * view->size,
               .entry = NO_EDGE,
               .found = found};
    tl_vec3 *border = (void *)found->room->dots;
    s.corners = border;
    s.inward = border + s.corner_count;
    s.feet = (void *)(border + 2 * s.corner_count);
    s.beams = (void *)(s.feet + s.standing->vertex_count);
    s.place = (void *)(s.beams + s.standing->edge_count);
    memset(s.place, 0, s.standing->vertex_count * sizeof *s.place);
    for (size_t i = 0; i < s.corner_count; i++)
        border[i] = vertex[base->loop[base->start[face] + i]];
    for (size_t i = 0; i < s.corner_count; i++) {
        tl_vec3 side = tl_v3_sub(border[i + 1 == s.corner_count ? 0 : i + 1], border[i]);
        border[s.corner_count + i] = tl_v3_unit(tl_v3_cross(s.up, side));
    }
    found->seen[!b_stands][face] = true;
    return s;
}

void tl_stand_on_face(const tl_pair_view *view, bool b_stands, uint32_t face,
                      tl_share_points *found)
{
    stand s = stand_of(view, b_stands, face, found);
    give_share(&s, lowest_vertex(&s), (tl_weight){.value = 1});
    find_feet(&s);
    add_feet(&s);
}

/* One of the four ways to stand on a face beside edges that cross: that of A is a border of faces of A, on which B stands,
 * and the other way round. */
typedef struct way {
    bool b_stands, right;
    uint32_t face, edge; /* of the block that stands */
} way;

static way way_of(const tl_pair_view *view, uint32_t ia, uint32_t ib, int side)
{
    way w = {.b_stands = side < 2, .right = side % 2};
    const tl_edge *border = w.b_stands ? &view->a->edge[ia] : &view->b->edge[ib];
    w.face = w.right ? border->right : border->left;
    w.edge = w.b_stands ? ib : ia;
    return w;
}

static tl_weight weight_of(none_of none)
{
    if (!(none.value > 0))
        return (tl_weight){0};
    return (tl_weight){none.value, tl_v3_scale(1 / none.value, none.change)};
}

/* How nearly two faces of a block are one; it does not depend on how the blocks lie. */
static tl_weight continuity(tl_vec3 up, tl_vec3 next)
{
    double sine = tl_v3_norm(tl_v3_cross(up, next));
    bool same_way = tl_v3_dot(up, next) > 0;
    return (tl_weight){.value = same_way ? tl_fade(sine, TL_LIKE_FULL, TL_LIKE_NONE) : 0};
}

/* How nearly the normal of a face beside edges that cross is theirs, or, where one of them comes from the other face of the
 * border, that face's; 0 when the edge does not lie in it anyway. */
static tl_weight alikeness(const tl_pair_view *view, const tl_crossing *x, way w, bool onward,
                           uint32_t from)
{
    tl_vec3 up = face_up(view, w.b_stands, w.face), own = w.b_stands ? x->b.unit : x->a.unit;
    double rise = tl_v3_dot(up, own);
    if (rise * rise >= LYING_SINE2 || (w.b_stands ? view->a : view->b)->covered[w.face])
        return (tl_weight){0}; /* most */
    if (onward)
        return continuity(face_up(view, w.b_stands, from), up);
    return tl_crossing_likeness(w.b_stands, w.b_stands ? up : tl_v3_neg(up), x->n, &x->a, &x->b);
}

tl_sides tl_stand_sides(const tl_pair_view *view, const tl_crossing *edges, const tl_from *from)
{
    tl_sides out = {0};
    none_of aside = no_edges, stops = no_edges;
    for (int pair = 0; pair < 4; pair += 2) {
        tl_weight lies[2] = {0};
        for (int k = 0; k < 2; k++) {
            way w = way_of(view, edges->ia, edges->ib, pair + k);
            bool along = from && from->b_stands == w.b_stands;
            if (along && from->face == w.face) {
                aside = none_with(aside, tl_weight_product(from->like, from->lies));
                lies[k] = (tl_weight){.value = 1}; /* of what has come from there */
                continue;
            }
            tl_weight alike = alikeness(view, edges, w, along, along ? from->face : 0);
            if (!(alike.value > 0))
                continue;
            out.alike[pair + k] = alike;
            tl_vec3 own = w.b_stands ? edges->b.unit : edges->a.unit;
            lies[k] =
                tl_weight_product(alike, lying(w.b_stands, face_up(view, w.b_stands, w.face), own));
            aside = none_with(aside, lies[k]);
        }
        stops = none_with(stops, tl_weight_product(lies[0], lies[1]));
    }
    out.aside = weight_of(aside);
    out.stops = weight_of(stops);
    return out;
}

bool tl_stand_seen(const tl_pair_view *view, const tl_share_point *crossing, int side,
                   const tl_share_points *found)
{
    way w = way_of(view, crossing->facet.ia, crossing->facet.ib, side);
    return found->seen[!w.b_stands][w.face];
}

void tl_stand_beside(const tl_pair_view *view, const tl_share_point *crossing, int side,
                     tl_share_points *found)
{
    way w = way_of(view, crossing->facet.ia, crossing->facet.ib, side);
    tl_weight weight = crossing->beside[side];
    stand s = stand_of(view, w.b_stands, w.face, found);
    const tl_poly *base = w.b_stands ? view->a : view->b;
    const tl_vec3 *corner = w.b_stands ? view->a->vertex : view->vertex_b;
    const tl_edge *e = &s.standing->edge[w.edge];
    const tl_edge *border = &base->edge[w.b_stands ? crossing->facet.ia : crossing->facet.ib];
    tl_vec3 along = tl_v3_sub(corner[border->b], corner[border->a]);
    tl_vec3 own = tl_v3_sub(s.vertex[e->b], s.vertex[e->a]);
    bool begins_outside = (tl_v3_dot(tl_v3_cross(s.up, along), own) > 0) != w.right;
    s.entry = w.edge;
    give_share(&s, begins_outside ? e->a : e->b, weight);
    find_feet(&s);
    add_feet(&s);
}
