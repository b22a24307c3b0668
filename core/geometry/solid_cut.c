/* solid_cut.c - makes a cut of a piece, and finds the pieces that it leaves.
 *
 * Edges that the plane crosses get a vertex. Each span becomes an edge of its face. The part below lies at the left of
 * one half-edge, and the part above at the left of the other. The rims become two new faces, one for each side. What
 * hangs together over edges is then a piece. */
#include "geometry/solid_cut.h"

#include "geometry/make.h"
#include "geometry/solid_part.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

/* Cost only: pieces of more faces are not measured. They are cut again, or thick. */
#define SMALL_PIECE 64

/* A half-edge or a face as it was before the cut. */
typedef struct saved_half {
    uint32_t number;
    tl_half_edge old;
} saved_half;

typedef struct saved_face {
    uint32_t number;
    tl_solid_face old;
} saved_face;

typedef struct cutter {
    tl_section *s;
    tl_solid_mesh *m;
    uint32_t part;                           /* of the section: what is cut */
    uint32_t *open, opens, open_capacity;    /* first half-edges of the loops of a face */
    uint32_t *cap, caps, cap_capacity;       /* the new faces */
    uint32_t *shell, shells, shell_capacity; /* shells that the cut reaches */
    saved_half *half;                        /* what the cut changes, in order */
    uint32_t halves, half_capacity;
    saved_face *face;
    uint32_t faces, face_capacity;
    uint32_t old_vertices, old_halves, old_faces, old_listed, old_reflexes; /* counts before the cut */
} cutter;

/* ---------------------------------------------------------------- taking back ------------ */

static void begin(cutter *c)
{
    const tl_solid_mesh *m = c->m;
    c->old_vertices = m->vertices;
    c->old_halves = m->halves;
    c->old_faces = m->faces;
    c->old_listed = m->piece[c->s->piece].faces;
    c->old_reflexes = m->piece[c->s->piece].reflexes;
}

/* Notes a half-edge that is about to change; false without memory. */
static bool save_half(cutter *c, uint32_t h)
{
    if (h >= c->old_halves)
        return true;
    if (!tl_solid_grow(&c->half, &c->half_capacity, c->halves, sizeof *c->half))
        return false;
    c->half[c->halves++] = (saved_half){h, c->m->half[h]};
    return true;
}

static bool save_face(cutter *c, uint32_t face)
{
    if (face >= c->old_faces)
        return true;
    if (!tl_solid_grow(&c->face, &c->face_capacity, c->faces, sizeof *c->face))
        return false;
    c->face[c->faces++] = (saved_face){face, c->m->face[face]};
    return true;
}

/* Puts all back as it was before the cut. */
static void take_back(const cutter *c)
{
    tl_solid_mesh *m = c->m;
    for (uint32_t i = c->halves; i-- > 0;)
        m->half[c->half[i].number] = c->half[i].old;
    for (uint32_t i = c->faces; i-- > 0;)
        m->face[c->face[i].number] = c->face[i].old;
    m->vertices = c->old_vertices;
    m->halves = c->old_halves;
    m->faces = c->old_faces;
    m->piece[c->s->piece].faces = c->old_listed;
    m->piece[c->s->piece].reflexes = c->old_reflexes;
}

static bool reach_shell(cutter *c, uint32_t shell)
{
    if (!tl_solid_grow(&c->shell, &c->shell_capacity, c->shells, sizeof *c->shell))
        return false;
    c->shell[c->shells++] = shell;
    return true;
}

static bool is_cut(const cutter *c, const tl_span *span)
{
    return tl_section_part(c->s, span->first_rim) == c->part;
}

/* ---------------------------------------------------------------- edges ------------------ */

/* Divides the edge of half-edge h at a point. The new half-edges begin there. */
static bool divide_edge(cutter *c, tl_crossing *x)
{
    tl_solid_mesh *m = c->m;
    const uint32_t h = x->half, mate = m->half[h].mate;
    uint32_t far, near; /* behind h, behind its mate */
    if (!tl_solid_add_vertex(m, x->at, &x->vertex) || !tl_solid_add_half(m, m->half[h], &far) ||
        !tl_solid_add_half(m, m->half[mate], &near) || !save_half(c, h) || !save_half(c, mate) ||
        !save_half(c, m->half[h].next) || !save_half(c, m->half[mate].next))
        return false;
    tl_half_edge *a = &m->half[h], *b = &m->half[mate];
    const uint32_t behind[2] = {far, near}, before[2] = {h, mate};
    for (int k = 0; k < 2; k++) {
        tl_half_edge *made = &m->half[behind[k]];
        made->from = x->vertex;
        made->prev = before[k];
        made->mate = before[1 - k];
        made->ring = TL_SOLID_NONE;
        m->half[made->next].prev = behind[k];
        m->bisector[behind[k]] = m->bisector[before[k]];
    }
    a->next = far;
    b->next = near;
    a->mate = near;
    b->mate = far;
    /* the older half-edge of each edge is listed: h is, and `far` is younger than its mate */
    return !a->reflex || tl_piece_add_reflex(&m->piece[c->s->piece], mate);
}

/* Divides the edges that the cut crosses. Vertices come behind the nodes of crossings, so rims keep the old names. */
static bool divide_edges(cutter *c, uint32_t vertices)
{
    for (uint32_t i = 0; i < c->s->rims; i++) {
        const tl_rim *r = &c->s->rim[i];
        if (r->from < vertices || tl_section_part(c->s, i) != c->part)
            continue;
        tl_crossing *x = &c->s->crossing[r->from - vertices];
        if (x->vertex == TL_SOLID_NONE && !divide_edge(c, x))
            return false;
    }
    return true;
}

static uint32_t vertex_of(const cutter *c, uint32_t node, uint32_t vertices)
{
    return node < vertices ? node : c->s->crossing[node - vertices].vertex;
}

/* ---------------------------------------------------------------- spans ------------------ */

/* The half-edge that begins at the end of a span and before which the new edge comes in. */
static uint32_t corner_of(const cutter *c, const tl_line_end *end, const tl_span *before)
{
    const tl_solid_mesh *m = c->m;
    if (end->crosses)
        return m->half[end->half].next; /* the edge is divided */
    /* the span before may end at the same corner: what is nearer to the outgoing edge of the two is done with */
    if (end->starts && before && !before->end.crosses && before->end.half == end->half && end->from_below &&
        before->made != TL_SOLID_NONE)
        return before->made;
    return end->half;
}

static bool make_span(cutter *c, tl_span *span, const tl_span *before, uint32_t vertices)
{
    tl_solid_mesh *m = c->m;
    const uint32_t p = corner_of(c, &span->start, before), q = corner_of(c, &span->end, NULL);
    tl_half_edge edge = {.face = span->face, .ring = TL_SOLID_NONE};
    uint32_t below, above;
    edge.from = vertex_of(c, c->s->rim[span->first_rim].to, vertices);
    if (!tl_solid_add_half(m, edge, &below))
        return false;
    edge.from = vertex_of(c, c->s->rim[span->first_rim].from, vertices);
    if (!tl_solid_add_half(m, edge, &above))
        return false;
    const uint32_t into_p = m->half[p].prev;
    if (!save_half(c, p) || !save_half(c, into_p) || !save_half(c, q))
        return false;
    m->half[into_p].next = below;
    m->half[below].prev = into_p;
    m->half[above].next = p;
    m->half[p].prev = above;
    const uint32_t into_q = m->half[q].prev;
    if (!save_half(c, into_q))
        return false;
    m->half[into_q].next = above;
    m->half[above].prev = into_q;
    m->half[below].next = q;
    m->half[q].prev = below;
    span->made = above;
    /* until the rims are made, each is its own mate */
    m->half[below].mate = below;
    m->half[above].mate = above;
    return true;
}

/* ---------------------------------------------------------------- loops ------------------ */

static bool put_open(cutter *c, uint32_t h)
{
    if (!tl_solid_grow(&c->open, &c->open_capacity, c->opens, sizeof *c->open))
        return false;
    c->open[c->opens++] = h;
    return true;
}

/* Whether a loop lies in the one around a face. */
static bool hole_in(const tl_solid_mesh *m, uint32_t hole, uint32_t around, tl_vec3 normal)
{
    uint32_t h = hole;
    do {
        const tl_vec3 a = m->vertex[m->half[h].from], b = m->vertex[tl_half_to(m, h)];
        int where = tl_solid_in_loop(m, around, normal, a);
        if (where == 0)
            where = tl_solid_in_loop(m, around, normal, tl_v3_scale(0.5, tl_v3_add(a, b)));
        if (where != 0)
            return where > 0;
        h = m->half[h].next;
    } while (h != hole);
    return false;
}

/* Makes a loop the one around a face: the first one of the face at hand, a new face for those that follow. */
static bool put_around(cutter *c, uint32_t face, uint32_t first, bool *taken)
{
    tl_solid_mesh *m = c->m;
    uint32_t number = face;
    if (*taken && (!tl_solid_add_face(m, m->face[face], &number) || !tl_piece_add_face(&m->piece[c->s->piece], number)))
        return false;
    *taken = true;
    if (!save_face(c, number) || !save_half(c, first))
        return false;
    m->face[number].first = first;
    m->half[first].ring = TL_SOLID_NONE;
    uint32_t h = first;
    do {
        if (m->half[h].face != number && !save_half(c, h))
            return false;
        m->half[h].face = number;
        h = m->half[h].next;
    } while (h != first);
    tl_solid_find_ball(m, number);
    return true;
}

/* Puts a hole into the smallest of the faces from `added` on, or the face itself, whose loop goes around it. */
static bool put_hole(cutter *c, uint32_t face, uint32_t added, uint32_t hole)
{
    tl_solid_mesh *m = c->m;
    const tl_vec3 normal = tl_solid_normal(m, face);
    uint32_t best = face;
    if (added < m->faces) {
        double least = INFINITY;
        for (uint32_t i = added; i <= m->faces; i++) {
            const uint32_t f = i < m->faces ? i : face;
            const double area = tl_v3_dot(tl_solid_loop_area(m, m->face[f].first), normal);
            const double far = tl_v3_norm(tl_v3_sub(m->vertex[m->half[hole].from], m->face[f].center));
            if (area < least && far <= m->face[f].radius + m->on && hole_in(m, hole, m->face[f].first, normal)) {
                least = area;
                best = f;
            }
        }
    }
    if (!save_half(c, hole) || !save_half(c, m->face[best].first))
        return false;
    m->half[hole].ring = m->half[m->face[best].first].ring;
    m->half[m->face[best].first].ring = hole;
    uint32_t h = hole;
    do {
        if (m->half[h].face != best && !save_half(c, h))
            return false;
        m->half[h].face = best;
        h = m->half[h].next;
    } while (h != hole);
    return true;
}

/* Makes faces of the loops that begin with the half-edges in `open`; those listed twice count once. */
static bool make_faces(cutter *c, uint32_t face)
{
    tl_solid_mesh *m = c->m;
    const uint32_t stamp = tl_solid_stamp(m), added = m->faces;
    const tl_vec3 normal = tl_solid_normal(m, face);
    uint32_t holes = 0, largest = TL_SOLID_NONE;
    double most = -INFINITY;
    bool taken = false;
    for (uint32_t i = 0; i < c->opens; i++) {
        const uint32_t first = c->open[i];
        if (m->half_mark[first] == stamp)
            continue;
        for (uint32_t h = first; m->half_mark[h] != stamp; h = m->half[h].next)
            m->half_mark[h] = stamp;
        const double area = tl_v3_dot(tl_solid_loop_area(m, first), normal);
        if (area > 0) {
            if (!put_around(c, face, first, &taken))
                return false;
            continue;
        }
        if (area > most) {
            most = area;
            largest = holes;
        }
        c->open[holes++] = first;
    }
    const bool flat = !taken; /* a face without area: its largest loop goes around it */
    if (flat && holes > 0 && !put_around(c, face, c->open[largest], &taken))
        return false;
    for (uint32_t i = 0; i < holes; i++)
        if ((!flat || i != largest) && !put_hole(c, face, added, c->open[i]))
            return false;
    return true;
}

/* Divides the faces that have spans in the cut. Spans are listed by face, in order along its line. */
static bool divide_faces(cutter *c, uint32_t vertices)
{
    const tl_section *s = c->s;
    tl_solid_mesh *m = c->m;
    for (uint32_t i = 0, end; i < s->spans; i = end) {
        const uint32_t face = s->span[i].face;
        bool any = false;
        for (end = i; end < s->spans && s->span[end].face == face; end++)
            any = any || is_cut(c, &s->span[end]);
        if (!any)
            continue;
        c->opens = 0;
        for (uint32_t first = m->face[face].first; first != TL_SOLID_NONE; first = m->half[first].ring)
            if (!put_open(c, first))
                return false;
        for (uint32_t k = i; k < end; k++) {
            tl_span *span = &s->span[k];
            if (!is_cut(c, span))
                continue;
            if (!make_span(c, span, k > i ? span - 1 : NULL, vertices) || !put_open(c, span->made - 1) ||
                !put_open(c, span->made))
                return false;
        }
        if (!reach_shell(c, m->face[face].shell) || !make_faces(c, face))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------- new faces -------------- */

static void make_mates(tl_solid_mesh *m, uint32_t a, uint32_t b, bool flat)
{
    m->half[a].mate = b;
    m->half[b].mate = a;
    m->half[a].reflex = m->half[b].reflex = false;
    m->half[a].flat = m->half[b].flat = flat;
}

/* Makes the half-edges of the rims. */
static bool make_rims(cutter *c, uint32_t vertices)
{
    tl_section *s = c->s;
    tl_solid_mesh *m = c->m;
    for (uint32_t i = 0; i < s->rims; i++) {
        tl_rim *r = &s->rim[i];
        if (tl_section_part(s, i) != c->part)
            continue;
        const tl_half_edge edge = {.from = vertex_of(c, r->from, vertices), .ring = TL_SOLID_NONE};
        if (!tl_solid_add_half(m, edge, &r->made))
            return false;
        if (r->of_span) {
            const uint32_t above = s->span[r->origin].made;
            make_mates(m, r->made, r->above ? above : above - 1, false);
        } else {
            const tl_solid_face *f = &m->face[m->half[r->origin].face];
            if (!reach_shell(c, f->shell) || !save_half(c, r->origin))
                return false;
            make_mates(m, r->made, r->origin, s->lies[f->slot] != 0);
        }
    }
    for (uint32_t i = 0; i < s->rims; i++)
        if (s->rim[i].made != TL_SOLID_NONE) {
            const uint32_t next = s->rim[s->rim[i].next].made;
            m->half[s->rim[i].made].next = next;
            m->half[next].prev = s->rim[i].made;
        }
    return true;
}

/* Makes a face of each loop of rims that goes around, with the holes in it. */
static bool make_caps(cutter *c)
{
    tl_section *s = c->s;
    tl_solid_mesh *m = c->m;
    for (uint32_t i = 0; i < s->loops; i++) {
        const tl_rim *first = &s->rim[s->loop[i].first];
        if (first->made == TL_SOLID_NONE || s->loop[i].in != i)
            continue;
        uint32_t face;
        const tl_solid_face made = {.first = first->made,
                                    .plane = s->plane,
                                    .turned = first->above != 0,
                                    .inside = true,
                                    .piece = s->piece,
                                    .shell = m->face[m->half[m->half[first->made].mate].face].shell};
        if (!tl_solid_add_face(m, made, &face) || !tl_piece_add_face(&m->piece[s->piece], face) ||
            !tl_solid_grow(&c->cap, &c->cap_capacity, c->caps, sizeof *c->cap))
            return false;
        c->cap[c->caps++] = face;
        for (uint32_t k = 0; k < s->loops; k++) {
            const uint32_t loop = s->rim[s->loop[k].first].made;
            if (s->loop[k].in != i)
                continue;
            if (k != i) {
                m->half[loop].ring = m->half[first->made].ring;
                m->half[first->made].ring = loop;
            }
            for (uint32_t h = loop, begun = 0; h != loop || !begun; h = m->half[h].next, begun = 1)
                m->half[h].face = face;
        }
        tl_solid_find_ball(m, face);
    }
    return true;
}

/* ---------------------------------------------------------------- pieces ----------------- */

/* Faces that hang together with a new face, as far as they are found. */
typedef struct flood {
    uint32_t *face, count, capacity, done;
    uint32_t root; /* of floods that have met, the first one */
} flood;

static uint32_t flood_root(const flood *list, uint32_t i)
{
    while (list[i].root != i)
        i = list[i].root;
    return i;
}

static bool flood_reach(flood *list, uint32_t own, tl_solid_mesh *m, uint32_t stamp, uint32_t face)
{
    flood *f = &list[own];
    if (m->face[face].mark == stamp) {
        const uint32_t a = flood_root(list, own), b = flood_root(list, m->face[face].slot);
        list[a < b ? b : a].root = a < b ? a : b;
        return true;
    }
    if (!tl_solid_grow(&f->face, &f->capacity, f->count, sizeof *f->face))
        return false;
    m->face[face].mark = stamp;
    m->face[face].slot = own;
    f->face[f->count++] = face;
    return true;
}

/* Whether a flood, with those that it has met, has nothing left to look at. */
static bool is_whole(const flood *list, uint32_t count, uint32_t root)
{
    for (uint32_t i = 0; i < count; i++)
        if (flood_root(list, i) == root && list[i].done < list[i].count)
            return false;
    return true;
}

/* Lets the floods grow in turn until all have met, or all but one are whole and that one is large: what is large is not
 * walked. */
static bool grow_floods(flood *list, uint32_t count, tl_solid_mesh *m, uint32_t stamp)
{
    for (;;) {
        uint32_t roots = 0, growing = 0, reached = 0;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t root = flood_root(list, i);
            roots += root == i;
            if (is_whole(list, count, root))
                continue;
            growing += root == i;
            reached += list[i].count;
        }
        if (roots == 1 || growing == 0 || (growing == 1 && reached > SMALL_PIECE))
            return true;
        for (uint32_t i = 0; i < count; i++) {
            if (list[i].done == list[i].count)
                continue;
            const uint32_t face = list[i].face[list[i].done++];
            TL_EACH_HALF(m, face, h, first)
            if (!flood_reach(list, i, m, stamp, m->half[m->half[h].mate].face))
                return false;
        }
    }
}

/* Moves the faces of a flood, and cavities inside them, to a new piece. */
static bool move_piece(const flood *list, uint32_t count, uint32_t root, tl_solid_mesh *m, uint32_t piece)
{
    uint32_t number;
    if (!tl_solid_add_piece(m, &number))
        return false;
    tl_solid_piece *to = &m->piece[number], *from = &m->piece[piece];
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; flood_root(list, i) == root && k < list[i].count; k++) {
            m->face[list[i].face[k]].piece = number;
            if (!tl_piece_add_face(to, list[i].face[k]))
                return false;
        }
    const uint32_t own = to->faces;
    for (uint32_t i = 0; i < m->shells; i++) {
        const uint32_t seed = m->shell[i].face;
        if (!m->shell[i].apart || m->face[seed].piece != piece ||
            tl_solid_winding(m, to->face, own, m->vertex[m->half[m->face[seed].first].from]) != 1)
            continue;
        for (uint32_t k = 0; k < from->faces; k++)
            if (m->face[from->face[k]].shell == i) {
                m->face[from->face[k]].piece = number;
                if (!tl_piece_add_face(to, from->face[k]))
                    return false;
            }
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < from->reflexes; i++) {
        const uint32_t h = from->reflex[i];
        if (m->face[m->half[h].face].piece == piece)
            from->reflex[kept++] = h;
        else if (!tl_piece_add_reflex(to, h))
            return false;
    }
    from->reflexes = kept;
    return true;
}

/* Finds what hangs together on each side of the new faces. */
static bool flood_sides(const cutter *c, flood *list)
{
    tl_solid_mesh *m = c->m;
    const uint32_t stamp = tl_solid_stamp(m);
    for (uint32_t i = 0; i < c->caps; i++) {
        list[i].root = i;
        if (!flood_reach(list, i, m, stamp, c->cap[i]))
            return false;
    }
    return grow_floods(list, c->caps, m, stamp);
}

/* Whether the faces of a side that bends inward nowhere close a convex part; true for others. */
static tl_status try_part(tl_solid_mesh *m, const uint32_t *face, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        TL_EACH_HALF(m, face[i], h, first)
        {
            if (m->half[h].reflex)
                return TL_OK;
        }
    tl_poly *part;
    tl_error error;
    const tl_status status = tl_solid_part(m, face, count, &part, &error);
    if (status == TL_OK)
        tl_poly_free(part);
    return status;
}

/* The least extent of faces across the plane of one of them, relative to the size of them all. */
static double thickness_of(tl_solid_mesh *m, const uint32_t *face, uint32_t count, uint32_t *vertex)
{
    const uint32_t stamp = tl_solid_stamp(m);
    uint32_t vertices = 0;
    tl_bounds all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < count; i++)
        TL_EACH_HALF(m, face[i], h, first)
        {
            const uint32_t v = m->half[h].from;
            if (m->vertex_mark[v] == stamp)
                continue;
            m->vertex_mark[v] = stamp;
            vertex[vertices++] = v;
            all.min = tl_v3_min(all.min, m->vertex[v]);
            all.max = tl_v3_max(all.max, m->vertex[v]);
        }
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const tl_vec3 normal = m->plane[m->face[face[i]].plane].normal;
        double low = INFINITY, high = -INFINITY;
        for (uint32_t k = 0; k < vertices; k++) {
            const double at = tl_v3_dot(normal, m->vertex[vertex[k]]);
            low = fmin(low, at);
            high = fmax(high, at);
        }
        least = fmin(least, high - low);
    }
    return least / tl_v3_norm(tl_v3_sub(all.max, all.min));
}

/* Finds the least thickness of the small pieces that a cut leaves: INFINITY where it leaves none, 0 where one is not
 * sound. */
static bool find_thinnest(const cutter *c, const flood *list, double *thinnest)
{
    tl_solid_mesh *m = c->m;
    uint32_t *face = malloc(SMALL_PIECE * sizeof *face), *vertex = malloc(m->vertices * sizeof *vertex);
    bool enough = face && vertex;
    *thinnest = INFINITY;
    for (uint32_t root = 0; enough && *thinnest > 0 && root < c->caps; root++) {
        uint32_t count = 0;
        if (flood_root(list, root) != root || !is_whole(list, c->caps, root))
            continue;
        for (uint32_t i = root; i < c->caps; i++)
            for (uint32_t k = 0; flood_root(list, i) == root && k < list[i].count && count <= SMALL_PIECE; k++, count++)
                if (count < SMALL_PIECE)
                    face[count] = list[i].face[k];
        if (count > SMALL_PIECE)
            continue;
        const tl_status status = try_part(m, face, count);
        enough = status != TL_E_MEMORY;
        *thinnest = status == TL_OK ? fmin(*thinnest, thickness_of(m, face, count, vertex)) : 0;
    }
    free(face);
    free(vertex);
    return enough;
}

/* Makes pieces of all sides but one. */
static bool part_piece(const cutter *c, const flood *list)
{
    tl_solid_mesh *m = c->m;
    uint32_t stays = TL_SOLID_NONE;
    for (uint32_t i = 0; i < c->shells; i++)
        m->shell[c->shell[i]].apart = false;
    for (uint32_t i = 0; i < c->caps; i++)
        if (flood_root(list, i) == i && (stays == TL_SOLID_NONE || !is_whole(list, c->caps, i)))
            stays = i;
    for (uint32_t i = 0; i < c->caps; i++)
        if (flood_root(list, i) == i && i != stays && !move_piece(list, c->caps, i, m, c->s->piece))
            return false;
    return true;
}

/* ---------------------------------------------------------------- the cut ---------------- */

static bool make(cutter *c, double least, double *thinnest)
{
    const uint32_t vertices = c->m->vertices;
    if (!divide_edges(c, vertices) || !divide_faces(c, vertices) || !make_rims(c, vertices) || !make_caps(c))
        return false;
    flood *list = calloc((size_t)c->caps + 1, sizeof *list);
    bool done = list && flood_sides(c, list) && find_thinnest(c, list, thinnest);
    if (done && *thinnest < least)
        take_back(c);
    else
        done = done && part_piece(c, list);
    for (uint32_t i = 0; list && i < c->caps; i++)
        free(list[i].face);
    free(list);
    return done;
}

bool tl_solid_cut_make(tl_section *s, tl_solid_mesh *m, uint32_t piece, const tl_solid_cut *cut, double least,
                       double *thinnest)
{
    bool sound;
    if (!tl_section_make(s, m, piece, cut->plane, &sound))
        return false;
    cutter c = {.s = s, .m = m, .part = TL_SOLID_NONE};
    for (uint32_t i = 0; i < s->rims; i++)
        if (cut->edge == TL_SOLID_NONE || (!s->rim[i].of_span && s->rim[i].origin == cut->edge))
            c.part = tl_section_part(s, i);
    begin(&c);
    const bool done = make(&c, least, thinnest);
    free(c.open);
    free(c.cap);
    free(c.shell);
    free(c.half);
    free(c.face);
    return done;
}
