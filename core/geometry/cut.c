/* cut.c - cutting a convex polyhedron in two by a plane.
 *
 * Every vertex is put below (-1), on (0) or above (+1) the plane; this classification alone decides the topology of
 * both children. Edges from -1 to +1 get one new vertex. A face with vertices on both sides is walked once and split
 * into its part below and its part above. Its cut from exit to entry is a half-edge of the cap. So is every edge that
 * lies on the plane between a lower and an upper face. The cap's half-edges must chain into one cycle, and both
 * children must satisfy Euler's formula, or the cut is refused. With vertices exact to rounding this does not happen.
 *
 * A new vertex is computed from its edge's end points in lexicographic order. So blocks on either side of a face,
 * which list the edge in opposite directions, get the same bits. */

#include "geometry/cut.h"

#include "geometry/make.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Scratch that fits on the stack: enough for about 80 vertices and 80 faces. */
#define LOCAL_SCRATCH 16384

#define NONE UINT16_MAX

/* Tolerance: A vertex this near the plane, relative to the farthest coordinate, is on it. A vertex made by a cut misses
 * its planes by one to three roundings, and a distance is computed to as many. */
#define ON_ROUNDINGS (8 * DBL_EPSILON)

/* One child while it is made. */
typedef struct child {
    uint16_t *map;  /* [vertices + cut edges] its vertex index, or NONE */
    uint16_t *face; /* [faces + 1] end of each of its loops */
    uint16_t *from; /* [faces] the parent's face of each of its own but the cap */
    uint16_t *loop; /* the loops, in the parent's numbering */
    uint32_t vertices, faces, loops;
} child;

typedef struct cutter {
    const tl_poly *poly;
    tl_plane plane;
    double reach;       /* the farthest coordinate that distances were computed from */
    tl_vec3 *point;     /* [cut edges] where the plane cuts each */
    double *distance;   /* [vertices] */
    signed char *side;  /* [vertices] */
    uint16_t *cap_next; /* [vertices + cut edges] the cap's half-edges as seen from the lower child */
    uint16_t *cut_edge; /* edges with vertices on both sides of the plane */
    uint32_t cut_edge_count;
    uint32_t cap_edges;
    child child[2]; /* below, above */
} cutter;

static size_t scratch_bytes(const tl_poly *p)
{
    size_t v = p->vertex_count, e = p->edge_count, f = p->face_count;
    size_t per_child = (v + e) + (f + 1) + f + (2 * e + 2 * f + v + e);
    return e * sizeof(tl_vec3) + v * sizeof(double) + (v + e + e + 2 * per_child) * sizeof(uint16_t) + v;
}

static void lay_out(cutter *c, void *scratch)
{
    size_t v = c->poly->vertex_count, e = c->poly->edge_count, f = c->poly->face_count;
    c->point = scratch;
    c->distance = (double *)(c->point + e);
    uint16_t *next = (uint16_t *)(c->distance + v);
    c->cap_next = next, next += v + e;
    c->cut_edge = next, next += e;
    for (int i = 0; i < 2; i++) {
        c->child[i].map = next, next += v + e;
        c->child[i].face = next, next += f + 1;
        c->child[i].from = next, next += f;
        c->child[i].loop = next, next += 2 * e + 2 * f + v + e;
    }
    c->side = (signed char *)next;
}

/* ---- classification ---- */

/* Sets the distances; the extremes go into *low and *high. */
static void measure(cutter *c, double *low, double *high)
{
    const tl_poly *p = c->poly;
    double reach = fmax(c->reach, fabs(c->plane.offset));
    *low = INFINITY, *high = -INFINITY;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        tl_vec3 x = p->vertex[v];
        double d = tl_v3_dot(c->plane.normal, x) - c->plane.offset;
        c->distance[v] = d;
        *low = d < *low ? d : *low;
        *high = d > *high ? d : *high;
        double far = fabs(x.x) + fabs(x.y) + fabs(x.z);
        reach = far > reach ? far : reach;
    }
    c->reach = reach;
}

/* A vertex is on the plane only when rounding cannot tell on which side it is. It is not moved: one farther off would
 * bend the cap, and the next cut through that cap would lose as much volume. */
static void classify(cutter *c)
{
    double on = ON_ROUNDINGS * c->reach;
    for (uint32_t v = 0; v < c->poly->vertex_count; v++)
        c->side[v] = (signed char)((c->distance[v] > on) - (c->distance[v] < -on));
}

/* A vertex on the plane is a corner of the cap only when edges leave it to both sides. One that the plane merely
 * brushes within rounding belongs to the side its edges are on. */
static void settle_brushed(cutter *c)
{
    const tl_poly *p = c->poly;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        if (c->side[v] != 0)
            continue;
        bool below = false, above = false;
        for (uint32_t e = 0; e < p->edge_count; e++) {
            tl_edge edge = p->edge[e];
            if (edge.a != v && edge.b != v)
                continue;
            signed char other = c->side[edge.a == v ? edge.b : edge.a];
            below = below || other < 0;
            above = above || other > 0;
        }
        if (!(below && above))
            c->side[v] = below || (!above && c->distance[v] < 0) ? -1 : 1;
    }
}

/* The face whose vertices all lie within `reach` of the plane and which faces along `sign` times its normal, the best
 * aligned of them. UINT32_MAX without one. */
static uint32_t face_along(const cutter *c, double reach, int sign)
{
    const tl_poly *p = c->poly;
    uint32_t best = UINT32_MAX;
    double best_cosine = 0;
    for (uint32_t f = 0; f < p->face_count; f++) {
        bool along = true;
        for (uint32_t i = p->start[f]; along && i < p->start[f + 1]; i++)
            along = fabs(c->distance[p->loop[i]]) <= reach;
        double cosine = sign * tl_v3_dot(p->plane[f].normal, c->plane.normal);
        if (along && cosine > best_cosine) {
            best = f;
            best_cosine = cosine;
        }
    }
    return best;
}

/* ---- new vertices ---- */

static bool before(tl_vec3 a, tl_vec3 b)
{
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/* Where edge number `e` meets the plane. The last step takes the rounding off the plane, which
 * makes coordinates exact where the plane is normal to an axis. */
static tl_vec3 cut_edge_point(const cutter *c, uint32_t e)
{
    tl_edge edge = c->poly->edge[e];
    uint16_t from = edge.a, to = edge.b;
    if (before(c->poly->vertex[to], c->poly->vertex[from])) {
        from = edge.b;
        to = edge.a;
    }
    tl_vec3 a = c->poly->vertex[from], b = c->poly->vertex[to];
    double da = c->distance[from], db = c->distance[to];
    tl_vec3 x = tl_v3_madd(a, da / (da - db), tl_v3_sub(b, a));
    double off = tl_v3_dot(c->plane.normal, x) - c->plane.offset;
    return tl_v3_madd(x, -off, c->plane.normal);
}

static void find_cut_edges(cutter *c)
{
    const tl_poly *p = c->poly;
    c->cut_edge_count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (c->side[p->edge[e].a] * c->side[p->edge[e].b] < 0)
            c->cut_edge[c->cut_edge_count++] = (uint16_t)e;
}

/* The new vertex on the edge between two neighbouring vertices. */
static uint16_t cut_vertex_between(const cutter *c, uint16_t a, uint16_t b)
{
    for (uint32_t i = 0; i < c->cut_edge_count; i++) {
        tl_edge edge = c->poly->edge[c->cut_edge[i]];
        if ((edge.a == a && edge.b == b) || (edge.a == b && edge.b == a))
            return (uint16_t)(c->poly->vertex_count + i);
    }
    return NONE;
}

/* ---- loops ---- */

static void put(child *ch, uint16_t vertex)
{
    ch->loop[ch->loops++] = vertex;
}

static void end_face(child *ch)
{
    ch->face[ch->faces++] = (uint16_t)ch->loops;
}

/* The vertex at a place of a loop that is taken twice. */
static uint16_t at_place(const uint16_t *loop, uint32_t n, uint32_t place)
{
    return loop[place < n ? place : place - n];
}

/* Notes the cap's half-edge from `a` to `b`; false when one leaves `a` already. */
static bool add_cap_edge(cutter *c, uint16_t a, uint16_t b)
{
    if (c->cap_next[a] != NONE || a == b)
        return false;
    c->cap_next[a] = b;
    c->cap_edges++;
    return true;
}

/* The vertices of a face below the plane: places [first, last] in its loop taken twice, with first
 * in the first round. */
typedef struct run {
    uint32_t first, last;
} run;

/* false when a vertex above the plane is among them, so that they are not one run. */
static bool find_run_below(const cutter *c, const uint16_t *loop, uint32_t n, run *below)
{
    uint32_t above = 0;
    while (c->side[loop[above]] <= 0)
        above++;
    /* From one above around to itself: the first and the last one below. */
    uint32_t first = UINT32_MAX, last = 0;
    for (uint32_t i = 1; i < n; i++) {
        if (c->side[at_place(loop, n, above + i)] < 0) {
            first = first == UINT32_MAX ? i : first;
            last = i;
        }
    }
    below->first = above + first < n ? above + first : above + first - n;
    below->last = below->first + (last - first);
    for (uint32_t i = below->first; i <= below->last; i++)
        if (c->side[at_place(loop, n, i)] > 0)
            return false;
    return true;
}

/* Gives a child a part of a face: a run of its loop between the cut's vertices `first` and `last`. */
static void put_part(child *ch, const tl_poly *p, uint32_t face, run part, uint16_t first, uint16_t last)
{
    ch->from[ch->faces] = (uint16_t)face;
    put(ch, first);
    for (uint32_t i = part.first; i <= part.last; i++)
        put(ch, at_place(p->loop + p->start[face], tl_poly_face_size(p, face), i));
    put(ch, last);
    end_face(ch);
}

/* Splits a face with vertices on both sides. Its loop is: the run below, the way out through the
 * plane, the run above, the way in. */
static bool split_face(cutter *c, uint32_t face)
{
    const uint16_t *loop = c->poly->loop + c->poly->start[face];
    uint32_t n = tl_poly_face_size(c->poly, face);
    run below;
    if (!find_run_below(c, loop, n, &below))
        return false;
    uint32_t next = below.last + 1, previous = below.first + n - 1;
    uint16_t head = loop[below.first], tail = at_place(loop, n, below.last);
    uint16_t ahead = at_place(loop, n, previous), behind = at_place(loop, n, next);
    uint16_t in = c->side[ahead] ? cut_vertex_between(c, ahead, head) : ahead;
    uint16_t out = c->side[behind] ? cut_vertex_between(c, tail, behind) : behind;
    /* The run above lies between, without vertices on the plane that serve as ways in and out. */
    run above = {c->side[behind] ? next : next + 1, c->side[ahead] ? previous : previous - 1};
    if (above.last < above.first || c->side[at_place(loop, n, above.first)] <= 0 ||
        c->side[at_place(loop, n, above.last)] <= 0)
        return false;
    put_part(&c->child[0], c->poly, face, below, in, out);
    put_part(&c->child[1], c->poly, face, above, out, in);
    /* The lower part runs out -> in along the cut, its cap the other way. */
    return add_cap_edge(c, in, out);
}

/* -1 or +1 for a face wholly on one side, 0 for one to be split, 2 for one wholly on the plane. */
static int face_side(const cutter *c, uint32_t face)
{
    bool below = false, above = false;
    for (uint32_t i = c->poly->start[face]; i < c->poly->start[face + 1]; i++) {
        below = below || c->side[c->poly->loop[i]] < 0;
        above = above || c->side[c->poly->loop[i]] > 0;
    }
    return below && above ? 0 : below ? -1 : above ? 1 : 2;
}

/* Deals the faces out to the children. */
static bool split_faces(cutter *c)
{
    const tl_poly *p = c->poly;
    for (uint32_t f = 0; f < p->face_count; f++) {
        int side = face_side(c, f);
        if (side == 2 || (side == 0 && !split_face(c, f)))
            return false;
        if (side == 0)
            continue;
        child *ch = &c->child[side > 0];
        ch->from[ch->faces] = (uint16_t)f;
        for (uint32_t i = p->start[f]; i < p->start[f + 1]; i++)
            put(ch, p->loop[i]);
        end_face(ch);
    }
    /* Edges on the plane between a face below and one above bound the cap. */
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_edge edge = p->edge[e];
        if (c->side[edge.a] != 0 || c->side[edge.b] != 0)
            continue;
        int left = face_side(c, edge.left), right = face_side(c, edge.right);
        if (left * right == 0)
            return false;
        if (left < right && !add_cap_edge(c, edge.b, edge.a))
            return false;
        if (left > right && !add_cap_edge(c, edge.a, edge.b))
            return false;
    }
    return true;
}

/* Chains the cap's half-edges and gives the loop to the lower child. The upper one gets its reverse from the same
 * vertex: both make the same fan of triangles. */
static bool close_cap(cutter *c)
{
    uint32_t all = c->poly->vertex_count + c->cut_edge_count, v = 0, corners = 0;
    while (v < all && c->cap_next[v] == NONE)
        v++;
    if (v == all || c->cap_edges < 3)
        return false;
    child *low = &c->child[0], *high = &c->child[1];
    uint16_t first = (uint16_t)v, at = first;
    do {
        put(low, at);
        at = c->cap_next[at];
        corners++;
    } while (at != first && at != NONE && corners < c->cap_edges);
    if (at != first || corners != c->cap_edges)
        return false;
    put(high, first);
    for (uint32_t i = 1; i < corners; i++)
        put(high, low->loop[low->loops - i]);
    end_face(low);
    end_face(high);
    return true;
}

/* ---- children ---- */

/* Numbers the vertices of both children: the parent's in its order, then the new ones. */
static void number_vertices(cutter *c)
{
    uint32_t n = c->poly->vertex_count;
    for (int i = 0; i < 2; i++) {
        child *ch = &c->child[i];
        int other = i ? -1 : 1;
        for (uint32_t v = 0; v < n; v++)
            ch->map[v] = c->side[v] == other ? NONE : (uint16_t)ch->vertices++;
        for (uint32_t k = 0; k < c->cut_edge_count; k++)
            ch->map[n + k] = (uint16_t)ch->vertices++;
    }
}

/* TL_E_GEOMETRY when the loops do not make a closed surface. */
static tl_status make_child(const cutter *c, int which, tl_tag tag, tl_poly **result, tl_error *error)
{
    const child *ch = &c->child[which];
    const tl_poly *parent = c->poly;
    if (ch->vertices > TL_POLY_MAX_VERTICES || ch->faces > TL_POLY_MAX_FACES ||
        ch->loops != 2 * (ch->vertices + ch->faces - 2))
        return TL_E_GEOMETRY;
    tl_poly *p = tl_poly_allocate(ch->vertices, ch->faces, ch->loops / 2);
    if (!p)
        return tl_fail_memory(error);
    for (uint32_t v = 0; v < parent->vertex_count; v++)
        if (ch->map[v] != NONE)
            p->vertex[ch->map[v]] = parent->vertex[v];
    memcpy(p->vertex + ch->vertices - c->cut_edge_count, c->point, c->cut_edge_count * sizeof *c->point);
    uint32_t cap = ch->faces - 1;
    p->start[0] = 0;
    for (uint32_t f = 0; f < cap; f++) {
        p->plane[f] = parent->plane[ch->from[f]];
        p->tag[f] = parent->tag[ch->from[f]];
        p->start[f + 1] = ch->face[f];
    }
    p->start[cap + 1] = ch->face[cap];
    p->tag[cap] = tag;
    p->plane[cap] = which == 0 ? c->plane : (tl_plane){tl_v3_neg(c->plane.normal), -c->plane.offset};
    for (uint32_t i = 0; i < ch->loops; i++)
        p->loop[i] = ch->map[ch->loop[i]];
    tl_status status = tl_poly_link(p, result, NULL);
    return status == TL_E_MEMORY ? tl_fail_memory(error) : status;
}

static tl_status make_children(cutter *c, tl_tag tag, tl_cut *cut, tl_error *error)
{
    number_vertices(c);
    for (uint32_t k = 0; k < c->cut_edge_count; k++)
        c->point[k] = cut_edge_point(c, c->cut_edge[k]);
    tl_status status = make_child(c, 0, tag, &cut->below, error);
    if (!status)
        status = make_child(c, 1, tag, &cut->above, error);
    if (status) {
        tl_poly_free(cut->below);
        cut->below = NULL;
    }
    return status;
}

static tl_status cut_with(cutter *c, tl_tag tag, tl_cut *cut, tl_error *error)
{
    double low, high, thin = TL_POLY_THIN * c->poly->size;
    measure(c, &low, &high);
    double on = fmax(TL_POLY_ON * c->poly->size, TL_POLY_ROUNDINGS * c->reach);
    if (!(fmin(high, -low) > on)) {
        bool below = -low > high;
        if ((below ? high : -low) >= -on)
            cut->face = face_along(c, on, below ? 1 : -1);
        cut->result = cut->face == UINT32_MAX ? TL_CUT_MISS : TL_CUT_COINCIDENT;
        return TL_OK;
    }
    cut->thickness = fmin(high, -low);
    cut->limit = thin;
    if (cut->thickness < thin) {
        cut->face = face_along(c, thin, high < -low ? 1 : -1);
        cut->result = TL_CUT_REFUSED;
        return TL_OK;
    }
    classify(c);
    settle_brushed(c);
    find_cut_edges(c);
    for (uint32_t v = 0; v < c->poly->vertex_count + c->cut_edge_count; v++)
        c->cap_next[v] = NONE;
    tl_status status = TL_E_GEOMETRY;
    if (split_faces(c) && close_cap(c))
        status = make_children(c, tag, cut, error);
    cut->result = status ? TL_CUT_REFUSED : TL_CUT_MADE;
    return status == TL_E_MEMORY ? status : TL_OK;
}

tl_status tl_poly_cut(const tl_poly *poly, tl_plane plane, double reach, tl_tag tag, tl_cut *cut, tl_error *error)
{
    *cut = (tl_cut){.result = TL_CUT_MISS, .face = UINT32_MAX};
    _Alignas(double) unsigned char local[LOCAL_SCRATCH];
    size_t bytes = scratch_bytes(poly);
    void *scratch = bytes <= sizeof local ? local : malloc(bytes);
    if (!scratch)
        return tl_fail_memory(error);
    cutter c = {.poly = poly, .plane = plane, .reach = reach};
    lay_out(&c, scratch);
    tl_status status = cut_with(&c, tag, cut, error);
    if (scratch != local)
        free(scratch);
    return status;
}
