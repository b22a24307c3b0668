/* share.c - the point share: the vertices and edges that a pair's axis rests on.
 *
 * Where the axis is the normal of a face, the other block *stands* on that face by the vertex that reaches farthest, and
 * by those that edges join to it which lie nearly in the face, all clipped to the face. Where it is the normal of two
 * edges, they touch where they cross; but as far as that normal is nearly a face's, an edge lies on the face over
 * whose border it leaves it, and then it stands there, too. So nothing jumps where the axis goes over from the
 * face to the edges: an edge that lies on a face and hangs out over it may rest on either end and rock between them
 * in no time, and a jump would keep it rocking. */
#include "detect/share.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* A vertex this near the border of a face, relative to the size, is over it. */
#define BORDER 1e-9
/* Tilt of an edge and a face up to which the edge lies in the face, and from which not at all: degrees. */
#define LYING_FULL 1.0
#define LYING_NONE 5.0
/* Square of the sine of the latter. */
#define LYING_SINE2 0.00759612349389597
/* An arc is longer than its sine by no more than this, up to TL_TILT_NONE. */
#define ARC_OVER_SINE 1.02

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

/* How the cosine between the normal n of two edges and that of a face beside one of them, which is A's or B's, changes
 * with B's turn, 1/rad; `out` is the face's normal, turned from A to B. n = u x v / |u x v| follows that turn by v. */
static tl_vec3 cosine_by_turn(bool of_a, tl_vec3 out, tl_vec3 n, const line *a, const line *b)
{
    tl_vec3 u = a->unit, v = b->unit, cross = tl_v3_cross(u, v);
    double sign = tl_v3_dot(cross, n) < 0 ? -1 : 1;
    tl_vec3 across = tl_v3_madd(out, -tl_v3_dot(out, n), n);
    tl_vec3 g = tl_v3_madd(tl_v3_scale(tl_v3_dot(u, v), across), -tl_v3_dot(out, v), u);
    g = tl_v3_scale(sign / tl_v3_norm(cross), g);
    return of_a ? g : tl_v3_add(g, tl_v3_cross(out, n));
}

/* How nearly n is the face's normal. */
static weight likeness(bool of_a, tl_vec3 out, tl_vec3 n, const line *a, const line *b)
{
    if (tl_v3_dot(n, out) <= 0)
        return (weight){0};
    double sine = tl_v3_norm(tl_v3_cross(n, out));
    weight w = {.value = tl_fade(sine, LYING_FULL, LYING_NONE)};
    double slope = tl_fade_slope(sine, LYING_FULL, LYING_NONE);
    if (slope != 0)
        w.swing = tl_v3_scale(slope / (sine * w.value), cosine_by_turn(of_a, out, n, a, b));
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
    foot *feet;       /* [vertices of `standing`] those with a share */
    uint16_t *place;  /* [vertices of `standing`] 1 + that among the feet, or 0 */
    beam *beams;      /* [edges of `standing`] */
    candidate *found; /* [vertices + 2 edges of `standing`] the points */
    size_t foot_count, beam_count, found_count;
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

/* The vertices that rest on the face with a first one, and the edges between them. Each has the largest share that a
 * chain of edges from the first one leaves it, so that it does not matter at which of several that lie in the
 * face the chains begin. */
static void find_feet(stand *s, uint16_t first)
{
    const tl_poly *p = s->standing;
    give_share(s, first, (weight){.value = 1});
    for (size_t i; (i = next_foot(s)) < s->foot_count;) {
        uint16_t v = s->feet[i].vertex;
        s->feet[i].settled = true;
        for (uint32_t e = 0; e < p->edge_count; e++) {
            if (p->edge[e].a != v && p->edge[e].b != v)
                continue;
            uint16_t u = p->edge[e].a == v ? p->edge[e].b : p->edge[e].a;
            if (s->place[u] && s->feet[s->place[u] - 1].settled)
                continue;
            weight lies = lying(s, tl_v3_sub(s->vertex[u], s->vertex[v]));
            if (!(lies.value > 0))
                continue;
            size_t to = give_share(s, u, product(s->feet[i].share, lies));
            s->beams[s->beam_count++] = (beam){.end = {i, to}, .edge = (uint16_t)e, .lies = lies};
        }
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
    if (w.value > 0)
        s->found[s->found_count++] =
            crossing_candidate(s->b_stands ? border : e->edge, s->b_stands ? e->edge : border, n,
                               crossing_point(&a, &b), w, 0);
}

static void add_foot(stand *s, const foot *f)
{
    const tl_pair_view *view = s->view;
    tl_vec3 x = s->vertex[f->vertex];
    s->found[s->found_count++] =
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
            if (s->beams[i].t[end] != end)
                add_crossing(s, &s->beams[i], end);
    for (size_t i = 0; i < s->foot_count; i++) {
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

/* The lower end of an edge of the standing block. */
static uint16_t lower_end(const stand *s, const tl_edge *e)
{
    return tl_v3_dot(s->up, tl_v3_sub(s->vertex[e->b], s->vertex[e->a])) < 0 ? e->b : e->a;
}

/* Room for what is noted of a stand and of the face's border. */
static bool stand_reserve(stand *s, tl_vec3 **border, tl_narrow *room)
{
    size_t v = s->standing->vertex_count, e = s->standing->edge_count;
    size_t bytes = 2 * s->corner_count * sizeof(tl_vec3) + v * sizeof(foot) + e * sizeof(beam) +
                   (v + 2 * e) * sizeof(candidate) + v * sizeof *s->place;
    if (!tl_grow(&room->dots, &room->dot_room, bytes / sizeof(double) + 1, sizeof(double))) {
        room->manifold.failed = true;
        return false;
    }
    void *at = room->dots;
    *border = at;
    s->feet = (void *)(*border + 2 * s->corner_count);
    s->beams = (void *)(s->feet + v);
    s->found = (void *)(s->beams + e);
    s->place = (void *)(s->found + v + 2 * e);
    memset(s->place, 0, v * sizeof *s->place);
    return true;
}

/* What of a block stands on a face of the other, with an edge of it, or from its lowest vertex on: a facet that has `part`
 * of the share. false when none. */
static bool share_of_face(const tl_pair_view *view, bool b_stands, uint32_t face,
                          const tl_edge *edge, weight part, tl_narrow *room)
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
               .slack = BORDER * view->size};
    tl_vec3 *border;
    if (!stand_reserve(&s, &border, room))
        return false;
    s.corners = border;
    s.inward = border + s.corner_count;
    for (size_t i = 0; i < s.corner_count; i++)
        border[i] = vertex[base->loop[base->start[face] + i]];
    for (size_t i = 0; i < s.corner_count; i++) {
        tl_vec3 side = tl_v3_sub(border[i + 1 == s.corner_count ? 0 : i + 1], border[i]);
        border[s.corner_count + i] = tl_v3_unit(tl_v3_cross(s.up, side));
    }
    find_feet(&s, edge ? lower_end(&s, edge) : lowest_vertex(&s));
    add_feet(&s);
    if (s.found_count > 0)
        add_points(&room->manifold, s.found, s.found_count, part);
    return s.found_count > 0;
}

/* ---------------------------------------------------------------- the axis of two edges -- */

/* The points of two crossing edges: where they cross and, as far as they are nearly parallel, the
 * ends of their common stretch, measured along their bisector so that neither block is preferred. */
static void share_of_edges(const tl_axis *axis, line a, line b, weight part, tl_manifold *m)
{
    tl_vec3 u = a.unit, v = b.unit;
    double same = tl_v3_dot(u, v) < 0 ? -1 : 1, sine = tl_v3_norm(tl_v3_cross(u, v));
    double parallel = tl_fade(sine, TL_TILT_FULL, TL_TILT_NONE);
    tl_vec3 swing = tl_v3_scale(-same * tl_fade_slope(sine, TL_TILT_FULL, TL_TILT_NONE),
                                tl_v3_unit(tl_v3_cross(u, v)));
    candidate found[3];
    size_t count = 0;
    if (parallel < 1)
        found[count++] =
            crossing_candidate(axis->ia, axis->ib, axis->n, crossing_point(&a, &b),
                               (weight){1 - parallel, tl_v3_scale(-1 / (1 - parallel), swing)}, 0);
    if (parallel > 0) {
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
            found[count++] = crossing_candidate(
                axis->ia, axis->ib, axis->n, between(line_at(&a, t), line_at(&b, t)),
                (weight){0.5 * parallel, tl_v3_scale(1 / parallel, swing)}, end ? 2 : 1);
        }
    }
    add_points(m, found, count, part);
}

/* Square of a sine that is nothing, and a part of the share that is. */
#define NO_SINE2 1e-30
#define REST 1e-9

/* A face beside one of two crossing edges. */
typedef struct beside {
    bool of_a;
    uint32_t face;
    weight like;  /* how nearly the edges' normal is the face's */
    weight claim; /* that over the square of the angle between: the nearest face has nearly all */
} beside;

/* The faces whose normals are near to that of the edges; how many. */
static size_t faces_beside(const tl_pair_view *view, const tl_axis *axis, const line *a,
                           const line *b, beside list[4])
{
    size_t count = 0;
    for (int k = 0; k < 4; k++) {
        bool of_a = k < 2;
        const tl_edge *e = of_a ? &view->a->edge[axis->ia] : &view->b->edge[axis->ib];
        uint32_t face = k % 2 ? e->right : e->left;
        tl_vec3 out = of_a ? view->a->plane[face].normal : tl_v3_neg(view->normal_b[face]);
        weight like = likeness(of_a, out, axis->n, a, b);
        if (!(like.value > 0) || (of_a ? view->a : view->b)->covered[face])
            continue;
        double sine2 = tl_v3_norm2(tl_v3_cross(axis->n, out)) + NO_SINE2;
        weight claim = {like.value / sine2,
                        tl_v3_madd(like.swing, -2 * tl_v3_dot(axis->n, out) / sine2,
                                   cosine_by_turn(of_a, out, axis->n, a, b))};
        list[count++] = (beside){of_a, face, like, claim};
    }
    return count;
}

/* What the faces have together of the share, the edges the rest: all of it where one of them has the edges' normal. */
static weight part_of_faces(const beside *list, size_t count)
{
    double none = 1;
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        none *= 1 - list[i].like.value;
    for (size_t i = 0; i < count; i++) {
        double others = list[i].like.value;
        for (size_t j = 0; j < count; j++)
            others *= j == i ? 1 : 1 - list[j].like.value;
        sum = tl_v3_madd(sum, others, list[i].like.swing);
    }
    return (weight){1 - none, tl_v3_scale(1 / (1 - none), sum)};
}

/* The share of two edges, of which an edge may lie in faces beside the other. */
static void share_beside(const tl_pair_view *view, const tl_axis *axis, weight all, tl_narrow *room)
{
    const tl_edge *ea = &view->a->edge[axis->ia], *eb = &view->b->edge[axis->ib];
    line a = line_of(ea, view->a->vertex), b = line_of(eb, view->vertex_b);
    beside list[4];
    size_t count = faces_beside(view, axis, &a, &b, list);
    double claims = 0, rest = all.value;
    tl_vec3 mean = {0, 0, 0}, swing = all.swing;
    for (size_t i = 0; i < count; i++) {
        claims += list[i].claim.value;
        mean = tl_v3_madd(mean, list[i].claim.value, list[i].claim.swing);
    }
    for (size_t i = 0; i < count; i++) {
        weight part = {list[i].claim.value / claims,
                       tl_v3_madd(list[i].claim.swing, -1 / claims, mean)};
        part = product(product(part, part_of_faces(list, count)), all);
        if (!share_of_face(view, list[i].of_a, list[i].face, list[i].of_a ? eb : ea, part, room))
            continue; /* nothing stands on it after all */
        /* what is left: swings go with values */
        swing = tl_v3_scale(1 / (rest - part.value),
                            tl_v3_madd(tl_v3_scale(rest, swing), -part.value, part.swing));
        rest -= part.value;
    }
    if (rest > REST)
        share_of_edges(axis, a, b, (weight){rest, swing}, &room->manifold);
}

/* Makes one of points that several faces have in common, from a facet on: those of the same two edges or vertex. */
static void merge_points(tl_manifold *m, size_t first)
{
    size_t facets = first, points = first < m->facet_count ? m->facets[first].begin : 0;
    for (size_t k = first; k < m->facet_count; k++) {
        tl_facet f = m->facets[k];
        const tl_contact_point *own = &m->points[f.begin];
        size_t j = f.count == 1 ? first : facets;
        while (j < facets && (m->facets[j].count > 1 || m->facets[j].kind != f.kind ||
                              m->points[m->facets[j].begin].key != own->key))
            j++;
        if (j < facets) {
            tl_contact_point *other = &m->points[m->facets[j].begin];
            double area = other->area + own->area;
            tl_vec3 swing = tl_v3_scale(other->area / area, tl_facet_swing(&m->facets[j]));
            tl_facet_set_swing(&m->facets[j],
                               tl_v3_madd(swing, own->area / area, tl_facet_swing(&f)));
            other->area = area;
            continue;
        }
        memmove(&m->points[points], own, f.count * sizeof *own);
        f.begin = (uint16_t)points;
        points += f.count;
        m->facets[facets++] = f;
    }
    m->facet_count = facets;
    m->point_count = points;
}

void tl_share_add(const tl_pair_view *view, const tl_axis *axis, tl_vec3 swing, tl_narrow *room)
{
    const weight all = {1, swing};
    bool of_a = axis->kind == TL_AXIS_FACE_A;
    size_t first = room->manifold.facet_count;
    if (axis->kind != TL_AXIS_EDGES) {
        share_of_face(view, of_a, of_a ? axis->ia : axis->ib, NULL, all, room);
        return;
    }
    share_beside(view, axis, all, room);
    if (room->manifold.facet_count > first)
        merge_points(&room->manifold, first);
}
