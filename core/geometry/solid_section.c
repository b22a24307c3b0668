/* solid_section.c - the section of a solid by a plane, in parts that hang together.
 *
 * Each vertex is below, on or above the plane; all else follows from these signs. A face that the plane crosses has
 * spans: the stretches of their common line inside it. A span bounds the new face of either side.
 * An edge on the plane may bound the new face of the side of one of its faces. It does when the plane comes first on
 * the way from that face through the solid. So it is when the other face lies on the other side, and at a reflex edge.
 * A face that lies on the plane counts to the side where the solid is.
 *
 * Rims, the half-edges of the new faces, are chained to loops. Loops that share a span, an edge, or lie one in the hole
 * of the other, are one part of the section. A cut goes along one part only, so it ends where the solid ends. */
#include "geometry/solid_section.h"

#include "geometry/polyhedron.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

/* Tolerance: cosine of 36 degrees: a cut that leaves a sharper wedge at a reflex edge is taken in need only. */
#define SHARP 0.8
/* Tolerance: a cut that passes a vertex by less than this times the size of the solid is taken in need only. It is a
 * limit of blocks. */
#define NEAR_VERTEX TL_POLY_THIN
/* Tolerance: areas and lengths of cuts that differ by less are equal: so far they are the same however a solid is
 * turned. */
#define EQUAL 1e-6
/* Tolerance: ends on a line that are out of order by less than this many times what counts as on the plane. */
#define ORDER_SLACK 4

tl_section *tl_section_new(void)
{
    return calloc(1, sizeof(tl_section));
}

void tl_section_free(tl_section *s)
{
    if (!s)
        return;
    free(s->face);
    free(s->lies);
    free(s->end);
    free(s->span);
    free(s->crossing);
    free(s->rim);
    free(s->key);
    free(s->loop);
    free(s->score);
    free(s);
}

tl_vec3 tl_section_node(const tl_section *s, const tl_solid_mesh *m, uint32_t node)
{
    return node < m->vertices ? m->vertex[node] : s->crossing[node - m->vertices].at;
}

/* ---------------------------------------------------------------- sides ------------------ */

/* Lists the faces whose balls the plane meets, and forgets those that are other pieces' now. */
static bool gather(tl_section *s, tl_solid_mesh *m)
{
    tl_solid_piece *p = &m->piece[s->piece];
    const tl_plane plane = m->plane[s->plane];
    uint32_t kept = 0;
    s->faces = 0;
    for (uint32_t i = 0; i < p->faces; i++) {
        const uint32_t f = p->face[i];
        if (m->face[f].piece != s->piece)
            continue;
        p->face[kept++] = f;
        if (m->face[f].plane != s->plane &&
            fabs(tl_v3_dot(plane.normal, m->face[f].center) - plane.offset) > m->face[f].radius + m->on)
            continue;
        if (!tl_solid_grow(&s->face, &s->face_capacity, s->faces, sizeof *s->face) ||
            !tl_solid_grow(&s->lies, &s->lies_capacity, s->faces, sizeof *s->lies))
            return false;
        m->face[f].slot = s->faces;
        s->face[s->faces++] = f;
    }
    p->faces = kept;
    return true;
}

static void put_side(tl_solid_mesh *m, uint32_t v, const tl_plane *plane, bool on)
{
    if (m->vertex_mark[v] == m->stamp)
        return;
    m->vertex_mark[v] = m->stamp;
    m->height[v] = tl_v3_dot(plane->normal, m->vertex[v]) - plane->offset;
    m->side[v] = (int8_t)(on || fabs(m->height[v]) <= m->on ? 0 : m->height[v] < 0 ? -1 : 1);
}

/* Finds the sides of all vertices of the faces at hand: those of faces that have this plane are on it. */
static void find_sides(tl_section *s, tl_solid_mesh *m)
{
    const tl_plane plane = m->plane[s->plane];
    tl_solid_stamp(m);
    for (uint32_t i = 0; i < s->faces; i++)
        if (m->face[s->face[i]].plane == s->plane)
            TL_EACH_HALF(m, s->face[i], h, first)
    put_side(m, m->half[h].from, &plane, true);
    for (uint32_t i = 0; i < s->faces; i++) {
        bool lies = true;
        TL_EACH_HALF(m, s->face[i], h, first)
        {
            put_side(m, m->half[h].from, &plane, false);
            lies = lies && m->side[m->half[h].from] == 0;
        }
        s->lies[i] = lies;
    }
}

/* ---------------------------------------------------------------- spans ------------------ */

/* The place where an edge crosses the plane: the same bits from both ends. */
static tl_vec3 crossing_at(const tl_solid_mesh *m, uint32_t u, uint32_t w)
{
    const tl_vec3 a = m->vertex[u], b = m->vertex[w];
    const bool swap = a.x > b.x || (a.x == b.x && (a.y > b.y || (a.y == b.y && a.z > b.z)));
    const uint32_t from = swap ? w : u, to = swap ? u : w;
    const double t = m->height[from] / (m->height[from] - m->height[to]);
    return tl_v3_madd(m->vertex[from], t, tl_v3_sub(m->vertex[to], m->vertex[from]));
}

/* The number of the crossing of an edge; false without memory. */
static bool find_crossing(tl_section *s, tl_solid_mesh *m, uint32_t h, uint32_t *number)
{
    const uint32_t mate = m->half[h].mate, name = h < mate ? h : mate;
    if (m->half_mark[name] != m->stamp) {
        if (!tl_solid_grow(&s->crossing, &s->crossing_capacity, s->crossings, sizeof *s->crossing))
            return false;
        m->half_mark[name] = m->stamp;
        m->cross[name] = s->crossings;
        s->crossing[s->crossings++] =
            (tl_crossing){crossing_at(m, m->half[name].from, tl_half_to(m, name)), name, TL_SOLID_NONE};
    }
    *number = m->cross[name];
    return true;
}

/* Where an edge at a vertex on the plane leads, as quarters about the outward normal: 0 along the line, 1 below, 2 back
 * along the line, 3 above. The solid's face lies counter-clockwise from the outgoing edge to the incoming one. */
static int quarter(const tl_solid_mesh *m, uint32_t v, uint32_t other, tl_vec3 line)
{
    if (m->side[other] != 0)
        return m->side[other] < 0 ? 1 : 3;
    return tl_v3_dot(tl_v3_sub(m->vertex[other], m->vertex[v]), line) >= 0 ? 0 : 2;
}

static bool add_end(tl_section *s, tl_line_end end)
{
    if (!tl_solid_grow(&s->end, &s->end_capacity, s->ends, sizeof *s->end))
        return false;
    s->end[s->ends++] = end;
    return true;
}

/* Adds the ends of spans at a vertex on the plane: in a direction of the line that lies strictly inside the corner of
 * the face, one begins. */
static bool ends_at_vertex(tl_section *s, const tl_solid_mesh *m, uint32_t h, tl_vec3 normal, tl_vec3 line)
{
    const uint32_t v = m->half[h].from, in = m->half[m->half[h].prev].from, to = tl_half_to(m, h);
    const int out = quarter(m, v, to, line), back = quarter(m, v, in, line);
    bool ahead = false, behind = false;
    if (out != back) {
        for (int q = (out + 1) % 4; q != back; q = (q + 1) % 4) {
            ahead = ahead || q == 0;
            behind = behind || q == 2;
        }
    } else if (out == 0 || out == 2) {
        ahead = out == 2;
        behind = out == 0;
    } else {
        const tl_vec3 o = tl_v3_sub(m->vertex[to], m->vertex[v]), b = tl_v3_sub(m->vertex[in], m->vertex[v]);
        ahead = behind = tl_v3_dot(tl_v3_cross(o, b), normal) <= 0;
    }
    tl_line_end end = {.along = tl_v3_dot(m->vertex[v], line), .half = h, .from_below = out == 1};
    if (behind && !add_end(s, end))
        return false;
    end.starts = true;
    return !ahead || add_end(s, end);
}

static int by_along(const void *left, const void *right)
{
    const tl_line_end *a = left, *b = right;
    if (a->along > b->along || a->along < b->along)
        return a->along < b->along ? -1 : 1;
    if (a->half != b->half)
        return a->half < b->half ? -1 : 1;
    return (int)a->starts - (int)b->starts; /* at one corner a span ends, then the next one starts */
}

/* Makes spans of ends that take turns; ends that rounding has in the wrong order change places. */
static bool pair_ends(tl_section *s, uint32_t face, double slack, bool *sound)
{
    qsort(s->end, s->ends, sizeof *s->end, by_along);
    for (uint32_t i = 0; i < s->ends; i++) {
        const bool starts = i % 2 == 0;
        uint32_t j = i;
        while (j < s->ends && s->end[j].starts != starts)
            j++;
        if (j == s->ends || s->end[j].along - s->end[i].along > slack) {
            *sound = false;
            return true;
        }
        const tl_line_end moved = s->end[j];
        for (; j > i; j--)
            s->end[j] = s->end[j - 1];
        s->end[i] = moved;
    }
    *sound = *sound && s->ends % 2 == 0;
    for (uint32_t i = 0; i + 1 < s->ends; i += 2) {
        if (!tl_solid_grow(&s->span, &s->span_capacity, s->spans, sizeof *s->span))
            return false;
        s->span[s->spans++] = (tl_span){.face = face, .start = s->end[i], .end = s->end[i + 1], .made = TL_SOLID_NONE};
    }
    return true;
}

static bool find_spans(tl_section *s, tl_solid_mesh *m, uint32_t face, bool *sound)
{
    const tl_vec3 normal = tl_solid_normal(m, face);
    const tl_vec3 cross = tl_v3_cross(normal, m->plane[s->plane].normal), line = tl_v3_unit(cross);
    bool below = false, above = false;
    TL_EACH_HALF(m, face, h, first)
    {
        below = below || m->side[m->half[h].from] < 0;
        above = above || m->side[m->half[h].from] > 0;
    }
    if (!below || !above)
        return true;
    s->ends = 0;
    TL_EACH_HALF(m, face, h, first)
    {
        const int from = m->side[m->half[h].from], to = m->side[tl_half_to(m, h)];
        if (from == 0) {
            if (!ends_at_vertex(s, m, h, normal, line))
                return false;
        } else if (from * to < 0) {
            uint32_t number;
            if (!find_crossing(s, m, h, &number) ||
                !add_end(s, (tl_line_end){.along = tl_v3_dot(s->crossing[number].at, line),
                                          .half = h,
                                          .crosses = true,
                                          .starts = from < 0}))
                return false;
        }
    }
    return pair_ends(s, face, ORDER_SLACK * m->on / tl_v3_norm(cross), sound);
}

/* ---------------------------------------------------------------- rims ------------------- */

static bool add_rim(tl_section *s, tl_rim rim)
{
    if (!tl_solid_grow(&s->rim, &s->rim_capacity, s->rims, sizeof *s->rim))
        return false;
    rim.root = s->rims;
    rim.made = rim.next = rim.loop = TL_SOLID_NONE;
    s->rim[s->rims++] = rim;
    return true;
}

static uint32_t node_of(const tl_solid_mesh *m, const tl_line_end *end)
{
    if (!end->crosses)
        return m->half[end->half].from;
    const uint32_t mate = m->half[end->half].mate;
    return m->vertices + m->cross[end->half < mate ? end->half : mate];
}

/* Whether the face of a half-edge on the plane is on its upper side, next to the edge. */
static bool is_above(const tl_section *s, const tl_solid_mesh *m, uint32_t h)
{
    const uint32_t f = m->half[h].face;
    const tl_vec3 up = m->plane[s->plane].normal, normal = tl_solid_normal(m, f);
    if (s->lies[m->face[f].slot])
        return tl_v3_dot(normal, up) < 0;
    const tl_vec3 along = tl_v3_sub(m->vertex[tl_half_to(m, h)], m->vertex[m->half[h].from]);
    return tl_v3_dot(tl_v3_cross(normal, along), up) > 0;
}

/* Adds the rim along a half-edge on the plane, if it has one. */
static bool rim_of_edge(tl_section *s, const tl_solid_mesh *m, uint32_t h)
{
    const bool above = is_above(s, m, h);
    if (above == is_above(s, m, m->half[h].mate) && !m->half[h].reflex)
        return true;
    return add_rim(
        s, (tl_rim){.from = tl_half_to(m, h), .to = m->half[h].from, .origin = h, .above = above, .of_span = false});
}

static bool find_rims(tl_section *s, tl_solid_mesh *m)
{
    for (uint32_t i = 0; i < s->spans; i++) {
        tl_span *span = &s->span[i];
        const uint32_t p = node_of(m, &span->start), q = node_of(m, &span->end);
        span->first_rim = s->rims;
        if (!add_rim(s, (tl_rim){.from = q, .to = p, .origin = i, .above = 0, .of_span = true}) ||
            !add_rim(s, (tl_rim){.from = p, .to = q, .origin = i, .above = 1, .of_span = true}))
            return false;
    }
    for (uint32_t i = 0; i < s->faces; i++)
        TL_EACH_HALF(m, s->face[i], h, first)
    if (m->side[m->half[h].from] == 0 && m->side[tl_half_to(m, h)] == 0 && !rim_of_edge(s, m, h))
        return false;
    return true;
}

/* ---------------------------------------------------------------- loops ------------------ */

uint32_t tl_section_part(tl_section *s, uint32_t rim)
{
    while (s->rim[rim].root != rim)
        rim = s->rim[rim].root = s->rim[s->rim[rim].root].root;
    return rim;
}

static void unite(tl_section *s, uint32_t a, uint32_t b)
{
    a = tl_section_part(s, a);
    b = tl_section_part(s, b);
    if (a < b)
        s->rim[b].root = a;
    else
        s->rim[a].root = b;
}

static int by_key(const void *left, const void *right)
{
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* A number that grows with the angle from one direction to another, counter-clockwise, in (0, 4]. */
static double turn(const tl_section *s, tl_vec3 from, tl_vec3 to, bool above)
{
    const double fx = tl_v3_dot(from, s->t1), fy = tl_v3_dot(from, s->t2);
    const double tx = tl_v3_dot(to, s->t1), ty = tl_v3_dot(to, s->t2);
    const double cosine = fx * tx + fy * ty, sine = (fx * ty - fy * tx) * (above ? -1 : 1);
    const double t = cosine / (fabs(cosine) + fabs(sine));
    const double angle = sine >= 0 ? 1 - t : 3 + t;
    return angle > 0 ? angle : 4;
}

/* Of the rims that begin at the end of another, the one that keeps the section in one piece there: the first one
 * clockwise from the way back. */
static uint32_t rim_after(const tl_section *s, const tl_solid_mesh *m, uint32_t rim, uint32_t low, uint32_t high)
{
    const tl_rim *r = &s->rim[rim];
    const tl_vec3 at = tl_section_node(s, m, r->to), back = tl_v3_sub(tl_section_node(s, m, r->from), at);
    uint32_t best = TL_SOLID_NONE;
    double least = INFINITY;
    for (uint32_t i = low; i < high; i++) {
        const uint32_t other = (uint32_t)s->key[i];
        const tl_vec3 out = tl_v3_sub(tl_section_node(s, m, s->rim[other].to), at);
        const double angle = turn(s, out, back, r->above);
        if (angle < least) {
            least = angle;
            best = other;
        }
    }
    return best;
}

/* Chains the rims: each one is followed by one that begins where it ends, and follows one. */
static bool chain_rims(tl_section *s, const tl_solid_mesh *m, bool *sound)
{
    /* nodes of one side, then those of the other */
    const uint64_t side = (uint64_t)m->vertices + s->crossings;
    if (side > INT32_MAX)
        return *sound = false, true;
    s->keys = 0;
    for (uint32_t i = 0; i < s->rims; i++) {
        if (!tl_solid_grow(&s->key, &s->key_capacity, s->keys, sizeof *s->key))
            return false;
        s->key[s->keys++] = (s->rim[i].above * side + s->rim[i].from) << 32 | i;
    }
    qsort(s->key, s->keys, sizeof *s->key, by_key);
    for (uint32_t i = 0; i < s->rims; i++) {
        const uint64_t node = s->rim[i].above * side + s->rim[i].to;
        uint32_t low = 0, high = s->keys;
        while (low < high) {
            const uint32_t middle = low + (high - low) / 2;
            if (s->key[middle] >> 32 < node)
                low = middle + 1;
            else
                high = middle;
        }
        while (high < s->keys && s->key[high] >> 32 == node)
            high++;
        if (high == low)
            return *sound = false, true;
        s->rim[i].next = high == low + 1 ? (uint32_t)s->key[low] : rim_after(s, m, i, low, high);
        unite(s, i, s->rim[i].next);
    }
    return true;
}

/* Makes one part of what shares a span or an edge. */
static void unite_origins(tl_section *s, tl_solid_mesh *m)
{
    for (uint32_t i = 0; i < s->spans; i++)
        unite(s, s->span[i].first_rim, s->span[i].first_rim + 1);
    tl_solid_stamp(m);
    for (uint32_t i = 0; i < s->rims; i++) {
        if (s->rim[i].of_span)
            continue;
        const uint32_t h = s->rim[i].origin, mate = m->half[h].mate, name = h < mate ? h : mate;
        if (m->half_mark[name] == m->stamp)
            unite(s, i, m->cross[name]);
        m->half_mark[name] = m->stamp;
        m->cross[name] = i;
    }
}

static void flat_node(const tl_section *s, const tl_solid_mesh *m, uint32_t node, double at[2])
{
    const tl_vec3 x = tl_v3_sub(tl_section_node(s, m, node), m->center);
    at[0] = tl_v3_dot(x, s->t1);
    at[1] = tl_v3_dot(x, s->t2);
}

/* Measures the loop that begins with a rim; false when the chain does not come back to it. */
static bool measure_loop(tl_section *s, const tl_solid_mesh *m, uint32_t number)
{
    tl_rim_loop *l = &s->loop[number];
    double base[2], before[2] = {0, 0};
    flat_node(s, m, s->rim[l->first].from, base);
    for (int k = 0; k < 2; k++)
        l->low[k] = l->high[k] = base[k];
    l->area = 0;
    uint32_t i = l->first;
    do {
        if (s->rim[i].loop != TL_SOLID_NONE)
            return false;
        s->rim[i].loop = number;
        double at[2];
        flat_node(s, m, s->rim[i].to, at);
        for (int k = 0; k < 2; k++) {
            l->low[k] = fmin(l->low[k], at[k]);
            l->high[k] = fmax(l->high[k], at[k]);
            at[k] -= base[k];
        }
        l->area += 0.5 * (before[0] * at[1] - before[1] * at[0]);
        before[0] = at[0];
        before[1] = at[1];
        i = s->rim[i].next;
    } while (i != l->first);
    if (s->rim[i].above)
        l->area = -l->area;
    return true;
}

static bool find_loops(tl_section *s, const tl_solid_mesh *m, bool *sound)
{
    s->loops = 0;
    for (uint32_t i = 0; i < s->rims; i++) {
        if (s->rim[i].loop != TL_SOLID_NONE)
            continue;
        if (!tl_solid_grow(&s->loop, &s->loop_capacity, s->loops, sizeof *s->loop))
            return false;
        s->loop[s->loops] = (tl_rim_loop){.first = i, .in = TL_SOLID_NONE};
        if (!measure_loop(s, m, s->loops))
            return *sound = false, true;
        s->loops++;
    }
    return true;
}

/* 1 where a point lies inside a loop, -1 outside, 0 on it. */
static int in_rims(const tl_section *s, const tl_solid_mesh *m, const tl_rim_loop *l, const double at[2])
{
    int turns = 0;
    double a[2], b[2];
    uint32_t i = l->first;
    flat_node(s, m, s->rim[i].from, a);
    do {
        flat_node(s, m, s->rim[i].to, b);
        const double dx = b[0] - a[0], dy = b[1] - a[1], px = at[0] - a[0], py = at[1] - a[1];
        const double length2 = dx * dx + dy * dy;
        const double t = length2 > 0 ? fmin(1, fmax(0, (px * dx + py * dy) / length2)) : 0;
        const double ox = px - t * dx, oy = py - t * dy;
        if (ox * ox + oy * oy <= m->on * m->on)
            return 0;
        if ((a[1] > at[1]) != (b[1] > at[1]) && (dx * py - dy * px > 0) == (b[1] > a[1]))
            turns += b[1] > a[1] ? 1 : -1;
        a[0] = b[0];
        a[1] = b[1];
        i = s->rim[i].next;
    } while (i != l->first);
    return turns != 0 ? 1 : -1;
}

/* Whether a loop lies in another: decided by its first corner or middle of a rim that is not on the other one. */
static bool lies_in(const tl_section *s, const tl_solid_mesh *m, const tl_rim_loop *inner, const tl_rim_loop *outer)
{
    for (int k = 0; k < 2; k++)
        if (inner->low[k] < outer->low[k] - m->on || inner->high[k] > outer->high[k] + m->on)
            return false;
    uint32_t i = inner->first;
    do {
        double a[2], b[2];
        flat_node(s, m, s->rim[i].from, a);
        flat_node(s, m, s->rim[i].to, b);
        int where = in_rims(s, m, outer, a);
        if (where == 0)
            where = in_rims(s, m, outer, (const double[2]){0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])});
        if (where != 0)
            return where > 0;
        i = s->rim[i].next;
    } while (i != inner->first);
    return false;
}

/* Finds the loops around holes. Loops without area are slits, which lie in others like holes. */
static void nest(tl_section *s, const tl_solid_mesh *m)
{
    for (uint32_t i = 0; i < s->loops; i++) {
        tl_rim_loop *l = &s->loop[i];
        if (l->area > m->on * (l->high[0] - l->low[0] + l->high[1] - l->low[1]))
            l->in = i;
    }
    for (uint32_t i = 0; i < s->loops; i++) {
        tl_rim_loop *hole = &s->loop[i];
        if (hole->in == i)
            continue;
        for (uint32_t j = 0; j < s->loops; j++) {
            const tl_rim_loop *outer = &s->loop[j];
            if (outer->in == j && s->rim[outer->first].above == s->rim[hole->first].above &&
                (hole->in == TL_SOLID_NONE || outer->area < s->loop[hole->in].area) && lies_in(s, m, hole, outer))
                hole->in = j;
        }
        if (hole->in != TL_SOLID_NONE)
            unite(s, hole->first, s->loop[hole->in].first);
    }
}

bool tl_section_make(tl_section *s, tl_solid_mesh *m, uint32_t piece, uint32_t plane, bool *sound)
{
    s->piece = piece;
    s->plane = plane;
    s->spans = s->crossings = s->rims = s->loops = 0;
    s->t1 = tl_v3_perpendicular(m->plane[plane].normal);
    s->t2 = tl_v3_cross(m->plane[plane].normal, s->t1);
    *sound = true;
    if (!gather(s, m))
        return false;
    find_sides(s, m);
    for (uint32_t i = 0; i < s->faces && *sound; i++)
        if (!s->lies[i] && !find_spans(s, m, s->face[i], sound))
            return false;
    if (!*sound)
        return true;
    if (!find_rims(s, m) || !chain_rims(s, m, sound))
        return false;
    if (*sound && !find_loops(s, m, sound))
        return false;
    if (*sound) {
        unite_origins(s, m);
        nest(s, m);
    }
    return true;
}

/* ---------------------------------------------------------------- which cut -------------- */

typedef struct tl_part_score {
    int32_t ended, split;
    bool bad, thin;
    double wedge;
    uint32_t edge;
    double area;
    tl_vec3 moment; /* of the new face's boundary: its middle times its length */
    double length;
} tl_part_score;

/* Looks at a reflex edge on the plane: how sharp the wedges are that the cut leaves there. */
static void score_edge(const tl_section *s, const tl_solid_mesh *m, const tl_rim *r, tl_part_score *score)
{
    const uint32_t h = r->origin;
    if (!m->half[h].reflex)
        return;
    if (score->edge == TL_SOLID_NONE || h < score->edge)
        score->edge = h;
    score->ended += h < m->half[h].mate; /* it has two rims */
    const tl_vec3 along = tl_v3_unit(tl_v3_sub(m->vertex[tl_half_to(m, h)], m->vertex[m->half[h].from]));
    tl_vec3 inward = tl_v3_cross(along, m->plane[s->plane].normal);
    if (r->above)
        inward = tl_v3_neg(inward);
    score->thin = score->thin || tl_v3_dot(tl_v3_cross(tl_solid_normal(m, m->half[h].face), along), inward) > SHARP;
}

/* The sine of the angle between the plane and the face at a rim, where the cut leaves a wedge; else 1. */
static double wedge_at(const tl_section *s, const tl_solid_mesh *m, const tl_rim *r)
{
    const tl_vec3 up = m->plane[s->plane].normal;
    const uint32_t face = r->of_span ? s->span[r->origin].face : m->half[r->origin].face;
    const tl_vec3 normal = tl_solid_normal(m, face);
    const double opposite = tl_v3_dot(normal, up) * (r->above ? 1 : -1);
    return opposite > 0 && (r->of_span || !s->lies[m->face[face].slot]) ? tl_v3_norm(tl_v3_cross(normal, up)) : 1;
}

static void score_rims(tl_section *s, const tl_solid_mesh *m)
{
    for (uint32_t i = 0; i < s->rims; i++) {
        const tl_rim *r = &s->rim[i];
        tl_part_score *score = &s->score[tl_section_part(s, i)];
        const tl_rim_loop *l = &s->loop[r->loop];
        score->bad = score->bad || l->in == TL_SOLID_NONE;
        if (l->first == i && !r->above)
            score->area += l->area;
        const tl_vec3 a = tl_section_node(s, m, r->from), b = tl_section_node(s, m, r->to);
        const double length = tl_v3_norm(tl_v3_sub(b, a));
        score->length += length;
        score->moment = tl_v3_madd(score->moment, 0.5 * length, tl_v3_add(a, b));
        score->wedge = fmin(score->wedge, wedge_at(s, m, r));
        if (!r->of_span)
            score_edge(s, m, r, score);
        if (r->from < m->vertices || r->above)
            continue;
        const uint32_t h = s->crossing[r->from - m->vertices].half;
        score->split += m->half[h].reflex;
        score->thin = score->thin ||
                      fmin(fabs(m->height[m->half[h].from]), fabs(m->height[tl_half_to(m, h)])) < NEAR_VERTEX * m->size;
    }
}

bool tl_solid_cut_better(const tl_solid_cut *a, const tl_solid_cut *b)
{
    if (a->gain != b->gain)
        return a->gain > b->gain;
    if (a->thin != b->thin)
        return b->thin;
    if (fabs(a->area - b->area) > EQUAL * b->area)
        return a->area < b->area;
    return a->length < b->length * (1 - EQUAL);
}

bool tl_section_cuts(tl_section *s, tl_solid_mesh *m, uint32_t piece, uint32_t plane, tl_solid_cuts *cuts)
{
    bool sound;
    if (!tl_section_make(s, m, piece, plane, &sound))
        return false;
    if (!sound || s->rims == 0)
        return true;
    if (!tl_solid_grow(&s->score, &s->score_capacity, s->rims, sizeof *s->score))
        return false;
    for (uint32_t i = 0; i < s->rims; i++)
        s->score[i] = (tl_part_score){.edge = TL_SOLID_NONE, .wedge = 1};
    score_rims(s, m);
    for (uint32_t i = 0; i < s->rims; i++) {
        const tl_part_score *score = &s->score[i];
        if (s->rim[i].root != i || score->bad || score->ended == 0)
            continue;
        const tl_vec3 middle = tl_v3_scale(1 / score->length, score->moment);
        if (!tl_solid_grow(&cuts->cut, &cuts->capacity, cuts->count, sizeof *cuts->cut))
            return false;
        cuts->cut[cuts->count++] = (tl_solid_cut){.plane = plane,
                                                  .edge = score->edge,
                                                  .gain = score->ended - score->split,
                                                  .thin = score->thin,
                                                  .thickness = score->wedge,
                                                  .area = score->area,
                                                  .length = tl_v3_norm(tl_v3_sub(middle, m->center))};
    }
    return true;
}
