/* convex.c - a plane polygon divided into convex parts.
 *
 * Ears (triangles of three corners in a row that hold no other corner; G. H. Meisters, Am. Math. Monthly 82 (1975)
 * 648-651) are clipped until nothing is left. Diagonals are then flipped to those of the constrained Delaunay
 * triangulation (C. L. Lawson, in Mathematical Software III, 1977), which has no thinner triangles than it must. Last,
 * diagonals are taken out as long as what they part is convex together (S. Hertel and K. Mehlhorn, Lect. Notes Comput.
 * Sci. 158 (1983) 207-218): at most four times the least number of parts. Diagonals of the thinnest triangles go first.
 *
 * Polygons that cross or touch themselves are refused before, and corners on a straight line are left out. What is left
 * is simple by a margin far above roundings. The parts are checked in the end: each is convex, and their areas add up.
 * Work grows with the square of the number of corners. */
#include "convex.h"

#include <stdbool.h>
#include <stdint.h>
#include <talus/kit.h>

/* Corners that lie off the line of their neighbours by less than this times the extent are on it. */
#define STRAIGHT 1e-9
/* By this share two sums of areas, or of cotangents, may differ for rounding. */
#define ROUNDED 1e-12

#define NONE SIZE_MAX

/* The triangulation as half-edges: three to a triangle, each from a corner to that of the next one. */
typedef struct mesh {
    const tl_flat *at;
    size_t count;  /* half-edges */
    size_t *from;  /* corner */
    size_t *next;  /* around the triangle, later around the part */
    size_t *twin;  /* the same edge the other way, or NONE on the outline */
    double *thin;  /* scratch: least height of the triangles at a diagonal */
    size_t *order; /* scratch */
    double near;   /* lengths that do not count */
} mesh;

static double dot(tl_flat o, tl_flat a, tl_flat b)
{
    return (a.x - o.x) * (b.x - o.x) + (a.y - o.y) * (b.y - o.y);
}

static convex_status check_simple(const tl_flat *at, size_t n, double extent, size_t *one, size_t *other)
{
    double near = CONVEX_FIT * extent;
    for (size_t i = 0; i < n; i++)
        if (tl_flat_apart(at[i], at[(i + 1) % n]) <= near) {
            *one = i;
            *other = (i + 1) % n;
            return CONVEX_COINCIDE;
        }
    return tl_polygon_crosses(at, n, near, one, other) ? CONVEX_CROSSES : CONVEX_DONE;
}

/* ---------------------------------------------------------------- triangles -------------- */

/* What is left while ears are clipped: corners, and the half-edge beyond the edge that begins at each. */
typedef struct ring {
    size_t *corner, *beyond, count;
} ring;

static void set_twins(mesh *m, size_t edge, size_t beyond)
{
    m->twin[edge] = beyond;
    if (beyond != NONE)
        m->twin[beyond] = edge;
}

/* Makes a triangle of the corner at place k and its neighbours, and takes the corner out. */
static void clip(mesh *m, ring *r, size_t k)
{
    size_t before = (k + r->count - 1) % r->count, after = (k + 1) % r->count, e = m->count;
    const size_t corner[3] = {r->corner[before], r->corner[k], r->corner[after]};
    for (size_t s = 0; s < 3; s++) {
        m->from[e + s] = corner[s];
        m->next[e + s] = e + (s + 1) % 3;
    }
    m->count += 3;
    set_twins(m, e, r->beyond[before]);
    set_twins(m, e + 1, r->beyond[k]);
    m->twin[e + 2] = NONE;
    if (r->count == 3)
        set_twins(m, e + 2, r->beyond[after]);
    r->beyond[before] = e + 2;
    r->count--;
    memmove(r->corner + k, r->corner + k + 1, (r->count - k) * sizeof *r->corner);
    memmove(r->beyond + k, r->beyond + k + 1, (r->count - k) * sizeof *r->beyond);
}

/* ---------------------------------------------------------------- flips ------------------ */

/* Flips the diagonal of half-edge h when the other one makes less thin triangles. The two triangles are abc and bad. */
static bool flip(mesh *m, size_t h)
{
    size_t t = m->twin[h];
    if (t == NONE)
        return false;
    size_t hn = m->next[h], hp = m->next[hn], tn = m->next[t], tp = m->next[tn];
    tl_flat a = m->at[m->from[h]], b = m->at[m->from[t]];
    tl_flat c = m->at[m->from[hp]], d = m->at[m->from[tp]];
    double here = dot(c, a, b) * tl_flat_cross(d, b, a), there = dot(d, b, a) * tl_flat_cross(c, a, b);
    if (here + there >= -ROUNDED * (fabs(here) + fabs(there)))
        return false;
    if (tl_flat_height(d, c, a) <= 0 || tl_flat_height(c, d, b) <= 0)
        return false;
    m->from[h] = m->from[tp];
    m->from[t] = m->from[hp];
    m->next[h] = hp, m->next[hp] = tn, m->next[tn] = h;
    m->next[t] = tp, m->next[tp] = hn, m->next[hn] = t;
    return true;
}

static void flip_all(mesh *m)
{
    bool changed = true;
    for (size_t sweep = 0; changed && sweep < m->count; sweep++) {
        changed = false;
        for (size_t h = 0; h < m->count; h++)
            changed |= flip(m, h);
    }
}

/* ---------------------------------------------------------------- parts ------------------ */

static size_t previous(const mesh *m, size_t h)
{
    size_t p = h;
    while (m->next[p] != h)
        p = m->next[p];
    return p;
}

/* Whether the corner where half-edge h begins is convex when its edge has gone. `least` is the height it needs. */
static bool stays_convex(const mesh *m, size_t h, double least)
{
    size_t into = previous(m, h), out = m->next[m->twin[h]];
    return tl_flat_height(m->at[m->from[into]], m->at[m->from[h]], m->at[m->from[m->next[out]]]) >= least;
}

/* Takes the edge of half-edge h out when what it parts is convex together. */
static bool take_out(mesh *m, size_t h, double least)
{
    size_t t = m->twin[h];
    if (t == NONE || !stays_convex(m, h, least) || !stays_convex(m, t, least))
        return false;
    size_t into_h = previous(m, h), into_t = previous(m, t);
    m->next[into_h] = m->next[t];
    m->next[into_t] = m->next[h];
    m->twin[h] = m->twin[t] = NONE;
    m->next[h] = m->next[t] = NONE; /* no part's any more */
    return true;
}

/* Least height of the two triangles at a half-edge. */
static double thinness(const mesh *m, size_t h)
{
    double least = INFINITY;
    const size_t sides[2] = {h, m->twin[h]};
    for (size_t s = 0; s < 2; s++) {
        size_t n = m->next[sides[s]];
        least = fmin(least, tl_flat_height(m->at[m->from[sides[s]]], m->at[m->from[n]], m->at[m->from[m->next[n]]]));
    }
    return least;
}

/* Lists diagonals, those of thin triangles first; of equal ones the one made first. */
static size_t list_diagonals(mesh *m)
{
    size_t count = 0;
    for (size_t h = 0; h < m->count; h++) {
        if (m->twin[h] == NONE || m->twin[h] < h)
            continue;
        m->thin[h] = thinness(m, h);
        size_t k = count++;
        for (; k > 0 && m->thin[m->order[k - 1]] > m->thin[h]; k--)
            m->order[k] = m->order[k - 1];
        m->order[k] = h;
    }
    return count;
}

/* First what leaves no corner on a straight line, so that parts meet along whole faces; then the rest. */
static void merge(mesh *m)
{
    size_t count = list_diagonals(m);
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < count; k++)
            if (m->next[m->order[k]] != NONE)
                take_out(m, m->order[k], pass == 0 ? 2 * m->near : -m->near);
}

/* Writes the corners of the part that half-edge h goes round, but for those on a straight line; returns their
 * number. */
static size_t walk(const mesh *m, size_t h, bool *seen, size_t *corner)
{
    size_t count = 0, e = h;
    do {
        seen[e] = true;
        size_t n = m->next[e], p = previous(m, e);
        if (tl_flat_height(m->at[m->from[p]], m->at[m->from[e]], m->at[m->from[n]]) > m->near)
            corner[count++] = m->from[e];
        e = n;
    } while (e != h);
    return count < 3 ? 0 : count;
}

static void list_parts(const mesh *m, bool *seen, convex_parts *parts)
{
    size_t at = 0;
    for (size_t h = 0; h < m->count; h++) {
        if (seen[h] || m->next[h] == NONE)
            continue;
        size_t count = walk(m, h, seen, parts->corner + at);
        if (count)
            parts->start[parts->parts++] = at;
        at += count;
    }
    parts->start[parts->parts] = at;
}

/* Twice the area. */
static double area_of(const tl_flat *at, const size_t *corner, size_t count)
{
    double sum = 0;
    for (size_t i = 2; i < count; i++)
        sum += tl_flat_cross(at[corner[0]], at[corner[i - 1]], at[corner[i]]);
    return sum;
}

/* Whether the parts are convex and their areas add up to twice the `area`, but for `off`. */
static bool are_sound(const tl_flat *at, const convex_parts *parts, double area, double off)
{
    double sum = 0;
    for (size_t p = 0; p < parts->parts; p++) {
        const size_t *corner = parts->corner + parts->start[p];
        size_t count = parts->start[p + 1] - parts->start[p];
        sum += area_of(at, corner, count);
        for (size_t i = 0; i < count; i++)
            if (tl_flat_height(at[corner[i]], at[corner[(i + 1) % count]], at[corner[(i + 2) % count]]) <= 0)
                return false;
    }
    return parts->parts > 0 && fabs(sum - area) <= off;
}

/* ---------------------------------------------------------------- all of it -------------- */

/* Writes the corners that count, counter-clockwise; returns their number. */
static size_t list_corners(const tl_flat *at, size_t n, double near, bool clockwise, size_t *corner)
{
    size_t count = 0;
    for (size_t k = 0; k < n; k++) {
        size_t i = clockwise ? n - 1 - k : k;
        tl_flat before = at[clockwise ? (i + 1) % n : (i + n - 1) % n];
        tl_flat after = at[clockwise ? (i + n - 1) % n : (i + 1) % n];
        if (count)
            before = at[corner[count - 1]];
        if (fabs(tl_flat_height(before, at[i], after)) > near)
            corner[count++] = i;
    }
    return count;
}

static convex_status divide(const tl_flat *at, size_t n, double area, double extent, convex_parts *parts)
{
    double near = STRAIGHT * extent, ear;
    size_t edges = 3 * n;
    mesh m = {.at = at, .near = near};
    m.from = malloc(6 * edges * sizeof *m.from);
    m.thin = malloc(edges * sizeof *m.thin);
    bool *seen = calloc(edges, sizeof *seen);
    parts->corner = malloc(edges * sizeof *parts->corner);
    parts->start = malloc((n + 1) * sizeof *parts->start);
    convex_status status = CONVEX_MEMORY;
    if (m.from && m.thin && seen && parts->corner && parts->start) {
        m.next = m.from + edges;
        m.twin = m.next + edges;
        m.order = m.twin + edges;
        ring r = {m.order + edges, m.order + 2 * edges, 0};
        r.count = list_corners(at, n, near, area < 0, r.corner);
        for (size_t k = 0; k < r.count; k++)
            r.beyond[k] = NONE;
        while (r.count >= 3)
            clip(&m, &r, tl_polygon_ear(at, r.corner, r.count, near, &ear));
        flip_all(&m);
        merge(&m);
        list_parts(&m, seen, parts);
        status = are_sound(at, parts, fabs(area), 4 * near * extent * (double)n) ? CONVEX_DONE : CONVEX_FAILED;
    }
    free(m.from);
    free(m.thin);
    free(seen);
    return status;
}

convex_status convex_divide(const tl_flat *at, size_t count, convex_parts *parts, size_t *one, size_t *other)
{
    *parts = (convex_parts){0};
    if (count < 3)
        return CONVEX_EMPTY;
    double extent = 0, area = 0; /* twice */
    for (size_t i = 1; i < count; i++) {
        extent = fmax(extent, tl_flat_apart(at[0], at[i]));
        area += tl_flat_cross(at[0], at[i - 1], at[i]);
    }
    convex_status status = check_simple(at, count, extent, one, other);
    if (status != CONVEX_DONE)
        return status;
    if (fabs(area) <= CONVEX_FIT * extent * extent)
        return CONVEX_EMPTY;
    status = divide(at, count, area, extent, parts);
    if (status != CONVEX_DONE) {
        free(parts->corner);
        free(parts->start);
        *parts = (convex_parts){0};
    }
    return status;
}
