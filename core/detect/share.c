/* share.c - the point share: the vertices and edges that a pair's axis rests on.
 *
 * Where the axis is the normal of a face, the other block *stands* on that face by the vertex that reaches farthest, and
 * by those that edges join to it which lie nearly in the face, all clipped to the face. Where it is the normal of two
 * edges, they touch where they cross; and as far as one of them lies nearly in a face beside the other, it stands on
 * that face by its end over it, too. So nothing jumps where the axis goes over from the face to the edges: an edge
 * that lies on a face and hangs out over it may rest on either end and rock between them in no time, and a jump would
 * keep it rocking. */
#include "detect/share.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* A vertex this near the border of a face, relative to the size, is over it. */
#define BORDER 1e-9
/* Tilt of an edge and a face up to which the edge lies in the face, and from which not at all: degrees. */
#define LYING_FULL 0.25
#define LYING_NONE 1.0
/* Square of the sine of the latter. */
#define LYING_SINE2 0.00030458649045213493
/* Angle of the normals of two edges and of a face up to which an edge that lies in the face stands on it where it crosses
 * the border, and from which not at all: degrees. The normal of an edge that crosses aslant leans more than the edge
 * does; only that of one along the border leans far, and it may belong to the face beyond as well. */
#define LIKE_FULL 5.0
#define LIKE_NONE 20.0
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
    double x = (none - asin(fmin(1, sine)) * (180 / TL_PI)) / (none - full);
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

/* A weight that depends on a tilt, and the couple on B that goes with it: its derivative against B's turn, over its
 * value, 1/rad. */
typedef struct weight {
    double value;
    tl_vec3 swing;
} weight;

static weight product(weight a, weight b)
{
    return (weight){a.value * b.value, tl_v3_add(a.swing, b.swing)};
}

/* ---------------------------------------------------------------- points ----------------- */

/* A contact point to be: its facet without the points, its place, and its weight among those it belongs with. */
typedef struct candidate {
    tl_facet facet;
    tl_vec3 p;
    weight weight;
    uint64_t key;
} candidate;

/* The points of a share. */
typedef struct found_points {
    candidate *list;
    size_t count;
    void *rest; /* of the room: for one stand */
} found_points;

static bool same_facet(const tl_facet *f, const tl_facet *g)
{
    return f->kind == g->kind && f->ia == g->ia && f->ib == g->ib && f->swing[0] == g->swing[0] &&
           f->swing[1] == g->swing[1] && f->swing[2] == g->swing[2];
}

/* Points that have `part` of the share between them, each by its weight. Those that follow each other have one facet,
 * unless their weights vary differently with tilt. */
static void add_points(tl_manifold *m, const candidate *list, size_t count, weight part)
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
        tl_contact_point point = {.p = list[i].p,
                                  .area = part.value * list[i].weight.value / sum,
                                  .key = (uint32_t)list[i].key};
        if (!(point.area > 0))
            continue;
        tl_facet facet = list[i].facet;
        tl_facet_set_swing(&facet, tl_v3_add(part.swing, tl_v3_sub(list[i].weight.swing, mean)));
        facet.begin = (uint16_t)m->point_count;
        if (!tl_manifold_add_point(m, point))
            return;
        if (m->facet_count == first || !same_facet(&m->facets[m->facet_count - 1], &facet))
            m->facets[m->facet_count++] = facet;
        m->facets[m->facet_count - 1].count++;
    }
}

/* ---------------------------------------------------------------- crossing edges --------- */

/* An edge in A's frame, its direction, and where its ends lie along another one. */
typedef struct line {
    tl_vec3 from, along, unit;
    double start, end;
} line;

static line line_of(const tl_edge *e, const tl_vec3 *vertex)
{
    line l = {.from = vertex[e->a], .along = tl_v3_sub(vertex[e->b], vertex[e->a])};
    l.unit = tl_v3_unit(l.along);
    return l;
}

static tl_vec3 line_at(const line *l, double t)
{
    return tl_v3_madd(l->from, (t - l->start) / (l->end - l->start), l->along);
}

static tl_vec3 between(tl_vec3 p, tl_vec3 q)
{
    return tl_v3_scale(0.5, tl_v3_add(p, q));
}

/* Where the lines of two edges come nearest, within the edges: half-way between them. */
static tl_vec3 crossing_point(const line *a, const line *b)
{
    tl_vec3 u = a->along, v = b->along, w = tl_v3_sub(b->from, a->from);
    double uu = tl_v3_norm2(u), vv = tl_v3_norm2(v), uv = tl_v3_dot(u, v);
    double det = uu * vv - uv * uv, wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v);
    double s = det > 0 ? (wu * vv - wv * uv) / det : 0.5;
    double t = det > 0 ? (wu * uv - wv * uu) / det : 0.5;
    return between(tl_v3_madd(a->from, fmin(1, fmax(0, s)), u),
                   tl_v3_madd(b->from, fmin(1, fmax(0, t)), v));
}

/* A point of two edges that touch along n. */
static candidate crossing_candidate(uint32_t ia, uint32_t ib, tl_vec3 n, tl_vec3 p, weight w,
                                    uint32_t number)
{
    uint64_t key = tl_key(tl_key(3, ia), ib);
    return (candidate){
        .facet = {.kind = TL_FACET_EDGES, .ia = (uint16_t)ia, .ib = (uint16_t)ib, .na = n},
        .p = p,
        .weight = w,
        .key = number ? tl_key(key, number) : key};
}

/* How nearly the normal n of two edges is that of a face beside one of them, which is A's or B's; `out` is the face's
 * normal, turned from A to B. n = u x v / |u x v| follows B's turn by that of v. */
static weight likeness(bool of_a, tl_vec3 out, tl_vec3 n, const line *a, const line *b)
{
    double sine = tl_v3_norm(tl_v3_cross(n, out));
    if (tl_v3_dot(n, out) <= 0)
        return (weight){0};
    weight w = {.value = tl_fade(sine, LIKE_FULL, LIKE_NONE)};
    double slope = tl_fade_slope(sine, LIKE_FULL, LIKE_NONE);
    if (slope == 0)
        return w;
    tl_vec3 u = a->unit, v = b->unit, cross = tl_v3_cross(u, v);
    double sign = tl_v3_dot(cross, n) < 0 ? -1 : 1;
    tl_vec3 across = tl_v3_madd(out, -tl_v3_dot(out, n), n);
    /* of the cosine between both, against B's turn */
    tl_vec3 g = tl_v3_madd(tl_v3_scale(tl_v3_dot(u, v), across), -tl_v3_dot(out, v), u);
    g = tl_v3_scale(sign / tl_v3_norm(cross), g);
    if (!of_a)
        g = tl_v3_add(g, tl_v3_cross(out, n));
    w.swing = tl_v3_scale(slope / (sine * w.value), g);
    return w;
}

/* ---------------------------------------------------------------- standing on a face ----- */

/* A vertex of the block that stands. */
typedef struct foot {
    uint16_t vertex;
    weight share;
    bool settled; /* it will not get more */
    bool over;    /* over the face */
    bool beamed;  /* an edge from it lies in the face */
    bool crosses; /* its share is where the edges of the axis cross */
    /* of one that is not over it, of the edges by which its block comes over it: their sum, and of the couples */
    double lies;
    tl_vec3 swing;
} foot;

/* An edge that lies in the face, from the end with the larger share, and the part of it over the face (see over). */
typedef struct beam {
    size_t end[2]; /* of the feet */
    uint16_t edge;
    weight lies;
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
    found_points *found; /* to which it adds its points */
} stand;

/* How nearly an edge along d of the standing block lies in the face. */
static weight lying(const stand *s, tl_vec3 d)
{
    double rise = tl_v3_dot(s->up, d), length2 = tl_v3_norm2(d);
    if (rise * rise >= LYING_SINE2 * length2) /* most edges */
        return (weight){0};
    double sine = fabs(rise) / sqrt(length2);
    weight out = {.value = tl_fade(sine, LYING_FULL, LYING_NONE)};
    /* by B's turn, when B has the edge; when it has the face, the other way round */
    double slope = (s->b_stands ? -1 : 1) * tl_fade_slope(sine, LYING_FULL, LYING_NONE);
    if (slope != 0)
        out.swing =
            tl_v3_scale((rise < 0 ? -slope : slope) / out.value, tl_v3_unit(tl_v3_cross(d, s->up)));
    return out;
}

/* Gives a vertex that share, unless it has a larger one; returns its place among the feet. */
static size_t give_share(stand *s, uint16_t vertex, weight w)
{
    if (s->place[vertex] == 0) {
        s->feet[s->foot_count] = (foot){.vertex = vertex};
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
static void add_beam(stand *s, size_t from, uint32_t edge, weight share)
{
    const tl_edge *e = &s->standing->edge[edge];
    uint16_t v = s->feet[from].vertex, u = e->a == v ? e->b : e->a;
    if (s->place[u] && s->feet[s->place[u] - 1].settled)
        return;
    weight lies = lying(s, tl_v3_sub(s->vertex[u], s->vertex[v]));
    if (!(lies.value > 0))
        return;
    size_t to = give_share(s, u, product(share, lies));
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
        if (e->t[k] == k) {
            f->over = true;
        } else {
            f->lies += e->lies.value;
            f->swing = tl_v3_madd(f->swing, e->lies.value, e->lies.swing);
        }
    }
    return true;
}

/* Where an edge that lies in the face crosses its border on the way to an end that is not over it: edges touch there,
 * not a vertex and a face. Such an end has its share where its edges come over the face. */
static void add_crossing(stand *s, const beam *e, int end)
{
    const foot *f = &s->feet[e->end[end]];
    const tl_poly *base = s->b_stands ? s->view->a : s->view->b;
    uint32_t border = side_edge(base, s->face, e->side[end]);
    const tl_edge *own = &s->standing->edge[e->edge], *other = &base->edge[border];
    line a = line_of(s->b_stands ? other : own, s->view->a->vertex);
    line b = line_of(s->b_stands ? own : other, s->view->vertex_b);
    tl_vec3 out = s->b_stands ? s->up : tl_v3_neg(s->up), n = tl_v3_cross(a.unit, b.unit);
    double sine = tl_v3_norm(n);
    if (!(sine > 0))
        return;
    n = tl_v3_scale((tl_v3_dot(n, out) < 0 ? -1 : 1) / sine, n);
    weight part = {e->lies.value / f->lies, tl_v3_madd(e->lies.swing, -1 / f->lies, f->swing)};
    weight w = product(product(f->share, part), likeness(s->b_stands, out, n, &a, &b));
    if (!(w.value > 0))
        return;
    candidate c = crossing_candidate(s->b_stands ? border : e->edge, s->b_stands ? e->edge : border,
                                     n, crossing_point(&a, &b), w, 0);
    for (size_t i = 0; i < s->found->count; i++)
        if (s->found->list[i].key == c.key) { /* the other block stands there, too */
            if (s->found->list[i].weight.value < w.value)
                s->found->list[i].weight = w;
            return;
        }
    s->found->list[s->found->count++] = c;
}

static void add_foot(stand *s, const foot *f)
{
    const tl_pair_view *view = s->view;
    tl_vec3 x = s->vertex[f->vertex];
    s->found->list[s->found->count++] =
        (candidate){.facet = face_facet(view, s->face, s->b_stands),
                    .p = s->b_stands ? tl_m3_tmul(&view->turn, tl_v3_sub(x, view->shift)) : x,
                    .weight = f->share,
                    .key = tl_key(s->b_stands ? 1 : 2, f->vertex)};
}

static void add_feet(stand *s)
{
    size_t crossing = 0; /* beams that are somewhere over the face come first */
    for (size_t i = 0; i < s->beam_count; i++)
        if (clip_beam(s, &s->beams[i]))
            s->beams[crossing++] = s->beams[i];
    for (size_t i = 0; i < crossing; i++)
        for (int end = 0; end < 2; end++)
            if (s->beams[i].t[end] != end && !s->feet[s->beams[i].end[end]].crosses)
                add_crossing(s, &s->beams[i], end);
    for (size_t i = 0; i < s->foot_count; i++) {
        const foot *f = &s->feet[i];
        tl_vec3 x = s->vertex[f->vertex];
        double t[2];
        size_t side[2];
        if (!f->crosses && (f->over || (!f->beamed && over(s, x, x, t, side))))
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

/* A face of a block and the other one, nothing of which stands on it yet. */
static stand stand_of(const tl_pair_view *view, bool b_stands, uint32_t face, found_points *found)
{
    const tl_poly *base = b_stands ? view->a : view->b;
    const tl_vec3 *vertex = b_stands ? view->a->vertex : view->vertex_b;
    stand s = {.view = view,
               .b_stands = b_stands,
               .standing = b_stands ? view->b : view->a,
               .vertex = b_stands ? view->vertex_b : view->a->vertex,
               .corner_count = tl_poly_face_size(base, face),
               .face = face,
               .up = b_stands ? view->a->plane[face].normal : view->normal_b[face],
               .slack = BORDER * view->size,
               .found = found};
    tl_vec3 *border = found->rest;
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
    return s;
}

/* What of a block stands on a face of the other, from its lowest vertex on. */
static void stand_on_face(const tl_pair_view *view, bool b_stands, uint32_t face,
                          found_points *found)
{
    stand s = stand_of(view, b_stands, face, found);
    give_share(&s, lowest_vertex(&s), (weight){.value = 1});
    find_feet(&s);
    add_feet(&s);
}

/* ---------------------------------------------------------------- the axis of two edges -- */

/* The points of two crossing edges: where they cross and, as far as they are nearly parallel, the
 * ends of their common stretch, measured along their bisector so that neither block is preferred. */
static void add_crossing_edges(const tl_axis *axis, line a, line b, found_points *found)
{
    tl_vec3 u = a.unit, v = b.unit;
    double same = tl_v3_dot(u, v) < 0 ? -1 : 1, sine = tl_v3_norm(tl_v3_cross(u, v));
    double parallel = tl_fade(sine, TL_TILT_FULL, TL_TILT_NONE);
    tl_vec3 swing = tl_v3_scale(-same * tl_fade_slope(sine, TL_TILT_FULL, TL_TILT_NONE),
                                tl_v3_unit(tl_v3_cross(u, v)));
    if (parallel < 1)
        found->list[found->count++] =
            crossing_candidate(axis->ia, axis->ib, axis->n, crossing_point(&a, &b),
                               (weight){1 - parallel, tl_v3_scale(-1 / (1 - parallel), swing)}, 0);
    if (!(parallel > 0))
        return;
    tl_vec3 d = tl_v3_unit(tl_v3_madd(u, same, v)), apart = tl_v3_sub(b.from, a.from);
    a.start = 0;
    a.end = tl_v3_dot(d, a.along);
    b.start = tl_v3_dot(d, apart);
    b.end = b.start + tl_v3_dot(d, b.along);
    double low = fmax(a.start, fmin(b.start, b.end));
    double high = fmin(a.end, fmax(b.start, b.end));
    if (low > high)
        low = high = 0.5 * (low + high);
    for (uint32_t end = 0; end < 2; end++) {
        double t = end ? high : low;
        found->list[found->count++] = crossing_candidate(
            axis->ia, axis->ib, axis->n, between(line_at(&a, t), line_at(&b, t)),
            (weight){0.5 * parallel, tl_v3_scale(1 / parallel, swing)}, end ? 2 : 1);
    }
}

/* Of two crossing edges, what the one stands on that crosses the border of a face: on all but its end beyond, for whose
 * share it is that both cross. */
static void stand_on_border(const tl_pair_view *view, bool b_stands, const tl_axis *axis,
                            bool right, const line *a, const line *b, found_points *found)
{
    const tl_poly *base = b_stands ? view->a : view->b, *standing = b_stands ? view->b : view->a;
    const tl_edge *border = &base->edge[b_stands ? axis->ia : axis->ib];
    uint32_t face = right ? border->right : border->left, edge = b_stands ? axis->ib : axis->ia;
    tl_vec3 up = b_stands ? view->a->plane[face].normal : view->normal_b[face];
    tl_vec3 side = b_stands ? a->unit : b->unit, d = b_stands ? b->unit : a->unit;
    double rise = tl_v3_dot(up, d);
    if (base->covered[face] || rise * rise >= LYING_SINE2)
        return;
    weight on = likeness(b_stands, b_stands ? up : tl_v3_neg(up), axis->n, a, b);
    if (!(on.value > 0))
        return;
    stand s = stand_of(view, b_stands, face, found);
    bool begins_outside = (tl_v3_dot(tl_v3_cross(up, side), d) > 0) != right;
    const tl_edge *e = &standing->edge[edge];
    give_share(&s, begins_outside ? e->a : e->b, (weight){.value = 1});
    s.feet[0].settled = s.feet[0].crosses = true;
    add_beam(&s, 0, edge, on);
    find_feet(&s);
    add_feet(&s);
}

/* ---------------------------------------------------------------- all of it -------------- */

/* Room for the points of a share, and for one stand; false when out of memory. */
static bool found_begin(found_points *found, const tl_pair_view *view, bool edges, tl_narrow *room)
{
    size_t v = view->a->vertex_count + view->b->vertex_count;
    size_t e = view->a->edge_count + view->b->edge_count;
    size_t most = edges ? 3 + 2 * (v + 2 * e) : v + 2 * e; /* of two faces beside each edge */
    size_t bytes = most * sizeof(candidate) + 2 * v * sizeof(tl_vec3) + v * sizeof(foot) +
                   e * sizeof(beam) + v * sizeof(uint16_t);
    if (!tl_grow(&room->dots, &room->dot_room, bytes / sizeof(double) + 1, sizeof(double))) {
        room->manifold.failed = true;
        return false;
    }
    found->list = (void *)room->dots;
    found->count = 0;
    found->rest = found->list + most;
    return true;
}

void tl_share_add(const tl_pair_view *view, const tl_axis *axis, tl_vec3 swing, tl_narrow *room)
{
    found_points found;
    if (!found_begin(&found, view, axis->kind == TL_AXIS_EDGES, room))
        return;
    if (axis->kind != TL_AXIS_EDGES) {
        bool b_stands = axis->kind == TL_AXIS_FACE_A;
        stand_on_face(view, b_stands, b_stands ? axis->ia : axis->ib, &found);
    } else {
        line a = line_of(&view->a->edge[axis->ia], view->a->vertex);
        line b = line_of(&view->b->edge[axis->ib], view->vertex_b);
        add_crossing_edges(axis, a, b, &found);
        for (int k = 0; k < 4; k++)
            stand_on_border(view, k < 2, axis, k % 2, &a, &b, &found);
    }
    if (found.count > 0)
        add_points(&room->manifold, found.list, found.count, (weight){1, swing});
}
