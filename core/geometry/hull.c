/* hull.c - the convex hull of points as a polyhedron.
 *
 * The points are put on a grid of 2^-40 of their extent, and the hull is the exact one of the grid points. The grid is
 * finer than TL_POLY_ON by 10^3 and coarser than the rounding of coordinates by 10^3, so neither shows. Triangles
 * within TL_POLY_FLAT times the extent of one plane then become one face, the largest first. So a sliver between two
 * faces joins one of them. Else the corners of a face, rounded in a file, would make several of it, which a joint
 * could not bond. A vertex left with fewer than three faces lies on a face or an edge and is dropped. Coordinates are
 * never moved; planes are fitted to the coordinates given. Should that leave faces that are no convex polygons,
 * triangles are merged anew within TL_POLY_ON. When noise is as large as that, they are merged with a wider tolerance
 * up to TL_POLY_THIN. Faces that miss a plane by more, but are one to tl_poly_flatten, it joins. Every loop starts at
 * its lowest vertex. The faces are in the order of their loops: the result depends on the points alone. */
#include "geometry/hull.h"

#include "geometry/flatten.h"
#include "geometry/make.h"
#include "geometry/measure.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define NO_FACE UINT32_MAX

/* Grid coordinates lie in [0, 2^GRID_BITS]. */
#define GRID_BITS 40

/* Faces fitted to vertices within the tolerance leave others this many tolerances off at most. */
#define SOUND 4
/* When noise about as large as the tolerance makes the border of two nearly coplanar faces zigzag, they are no convex
 * polygons. A tolerance this much wider takes it in. */
#define WIDER 8

typedef struct hull_triangle {
    uint32_t vertex[3];   /* counter-clockwise from outside */
    uint32_t adjacent[3]; /* triangle across the side from vertex i to the next */
    double normal[3];     /* area vector in grid units, rounded */
    uint32_t face;        /* for the caller */
    bool alive, visible;
} hull_triangle;

typedef struct hull_edge {
    uint32_t a, b;     /* as the triangle taken away had it */
    uint32_t beyond;   /* triangle on the other side ... */
    int side;          /* ... and its side along this edge */
    uint32_t triangle; /* the new one on this side */
} hull_edge;

/* Working space; the caller provides the arrays. */
typedef struct hull {
    uint32_t count;          /* points */
    int64_t (*grid)[3];      /* [count] */
    bool *duplicate;         /* [count] points to leave out */
    hull_triangle *triangle; /* [2 count] */
    uint32_t *free;          /* [2 count] dead triangles */
    hull_edge *horizon;      /* [count] */
    uint32_t *at;            /* [count] horizon edge that starts in a point */
    uint32_t triangle_count, free_count;
} hull;

typedef struct builder {
    const tl_vec3 *point;
    double extent;    /* diagonal of the bounds */
    double tolerance; /* lengths that do not count */
    double unit;      /* grid units per length */
    bool any;         /* points inside are left out, not refused */
    hull hull;
    uint32_t face_count;
    uint32_t *sectors; /* [count] faces that meet in a point */
    uint16_t *number;  /* [count] vertex number of a corner */
    uint32_t *order;   /* [2 count] triangles by area, faces by loop */
    uint32_t *pending; /* [2 count] triangles still to look around */
    uint32_t *start;   /* [2 count + 1] */
    uint16_t *loop;    /* [6 count] */
    tl_vec3 *vertex;   /* [count] */
    uint32_t vertex_count;
    void *memory;
} builder;

static bool allocate(builder *b, const tl_vec3 *points, size_t count)
{
    /* Arrays by falling alignment out of one block of zeros. */
    size_t per_point = sizeof(int64_t[3]) + sizeof(tl_vec3) + 2 * sizeof(hull_triangle) + sizeof(hull_edge) +
                       10 * sizeof(uint32_t) + 7 * sizeof(uint16_t) + sizeof(bool);
    b->memory = calloc(count + 1, per_point);
    if (!b->memory)
        return false;
    hull *h = &b->hull;
    b->point = points;
    h->count = (uint32_t)count;
    h->grid = b->memory;
    b->vertex = (tl_vec3 *)(h->grid + count);
    h->triangle = (hull_triangle *)(b->vertex + count);
    h->horizon = (hull_edge *)(h->triangle + 2 * count);
    h->free = (uint32_t *)(h->horizon + count);
    h->at = h->free + 2 * count;
    b->sectors = h->at + count;
    b->order = b->sectors + count;
    b->pending = b->order + 2 * count;
    b->start = b->pending + 2 * count;
    b->number = (uint16_t *)(b->start + 2 * count + 1);
    b->loop = b->number + count;
    h->duplicate = (bool *)(b->loop + 6 * count);
    return true;
}

/* ---- the triangulated hull ----
 *
 * Incremental: each point outside takes away the triangles that see it and is joined to their horizon. Which side of a
 * plane a point is on is decided in exact integer arithmetic; a double product decides first where its rounding cannot
 * matter. So the result is a closed convex surface whatever the points, coplanar ones included.
 *
 * Needs a compiler with 128-bit integers (gcc and clang on 64-bit machines): a height is at most
 * 6 (2^41)^3 < 2^126. The work is proportional to points times triangles. */

__extension__ typedef __int128 wide_int;

/* Tolerance: A double product of two cross product components and a difference is off by a few roundings of the sum of
 * magnitudes. Beyond this bound its sign is right. */
#define SIGN_BOUND (8 * DBL_EPSILON)

static wide_int wide(int64_t a)
{
    return (wide_int)a;
}

/* Twice the area vector of the grid triangle, exact. */
static void area_vector(const hull *h, const uint32_t v[3], wide_int n[3])
{
    const int64_t *a = h->grid[v[0]], *b = h->grid[v[1]], *c = h->grid[v[2]];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = wide(b[j] - a[j]) * wide(c[k] - a[k]) - wide(b[k] - a[k]) * wide(c[j] - a[j]);
    }
}

/* The sign of the height of point p over the triangle's plane. */
static int height_sign(const hull *h, const hull_triangle *t, uint32_t p)
{
    const int64_t *a = h->grid[t->vertex[0]], *x = h->grid[p];
    int64_t d[3] = {x[0] - a[0], x[1] - a[1], x[2] - a[2]};
    double px = t->normal[0] * (double)d[0], py = t->normal[1] * (double)d[1];
    double pz = t->normal[2] * (double)d[2];
    double height = px + py + pz;
    if (fabs(height) > SIGN_BOUND * (fabs(px) + fabs(py) + fabs(pz)))
        return height > 0 ? 1 : -1;
    wide_int n[3];
    area_vector(h, t->vertex, n);
    wide_int exact = n[0] * wide(d[0]) + n[1] * wide(d[1]) + n[2] * wide(d[2]);
    return (exact > 0) - (exact < 0);
}

/* Room for one more triangle, a dead one's where there is one. */
static hull_triangle *new_triangle(hull *h, uint32_t a, uint32_t b, uint32_t c, uint32_t *index)
{
    *index = h->free_count ? h->free[--h->free_count] : h->triangle_count++;
    hull_triangle *t = &h->triangle[*index];
    *t = (hull_triangle){.vertex = {a, b, c}, .alive = true};
    wide_int n[3];
    area_vector(h, t->vertex, n);
    for (int i = 0; i < 3; i++)
        t->normal[i] = (double)n[i];
    return t;
}

/* Makes the tetrahedron of four points that span a volume. */
static void start_tetrahedron(hull *h, const uint32_t corner[4])
{
    uint32_t v[4] = {corner[0], corner[1], corner[2], corner[3]}, index;
    hull_triangle probe = {.vertex = {v[0], v[1], v[2]}};
    if (height_sign(h, &probe, v[3]) > 0) {
        v[1] = corner[2];
        v[2] = corner[1];
    }
    /* Below the first face lies v[3]; side i of a triangle runs from vertex i to the next. */
    hull_triangle *t = new_triangle(h, v[0], v[1], v[2], &index);
    memcpy(t->adjacent, (uint32_t[]){1, 2, 3}, sizeof t->adjacent);
    t = new_triangle(h, v[1], v[0], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 3, 2}, sizeof t->adjacent);
    t = new_triangle(h, v[2], v[1], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 1, 3}, sizeof t->adjacent);
    t = new_triangle(h, v[0], v[2], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 2, 1}, sizeof t->adjacent);
}

/* The side of a triangle towards a neighbour. */
static int side_towards(const hull_triangle *t, uint32_t neighbour)
{
    return t->adjacent[0] == neighbour ? 0 : t->adjacent[1] == neighbour ? 1 : 2;
}

/* Marks the triangles that see point p; whether there are any. */
static bool mark_visible(hull *h, uint32_t p)
{
    bool any = false;
    for (uint32_t i = 0; i < h->triangle_count; i++) {
        hull_triangle *t = &h->triangle[i];
        t->visible = t->alive && height_sign(h, t, p) > 0;
        any = any || t->visible;
    }
    return any;
}

/* Adds point p: the triangles that see it give way to a fan from p to their horizon. */
static void add_point(hull *h, uint32_t p)
{
    if (!mark_visible(h, p))
        return;
    /* Horizon edges, each kept with the triangle beyond it; `at[a]` is the one that starts in a. */
    uint32_t edges = 0, before = h->triangle_count;
    for (uint32_t i = 0; i < before; i++) {
        hull_triangle *t = &h->triangle[i];
        for (int side = 0; t->visible && side < 3; side++) {
            const hull_triangle *beyond = &h->triangle[t->adjacent[side]];
            if (beyond->visible)
                continue;
            uint32_t a = t->vertex[side], b = t->vertex[(side + 1) % 3];
            h->horizon[edges++] = (hull_edge){a, b, t->adjacent[side], side_towards(beyond, i), 0};
        }
    }
    for (uint32_t i = 0; i < before; i++)
        if (h->triangle[i].visible) {
            h->triangle[i].alive = h->triangle[i].visible = false;
            h->free[h->free_count++] = i;
        }
    for (uint32_t e = 0; e < edges; e++) {
        hull_edge *edge = &h->horizon[e];
        hull_triangle *t = new_triangle(h, edge->a, edge->b, p, &edge->triangle);
        t->adjacent[0] = edge->beyond;
        h->triangle[edge->beyond].adjacent[edge->side] = edge->triangle;
        h->at[edge->a] = e;
    }
    for (uint32_t e = 0; e < edges; e++) {
        uint32_t here = h->horizon[e].triangle, next = h->horizon[h->at[h->horizon[e].b]].triangle;
        h->triangle[here].adjacent[1] = next;
        h->triangle[next].adjacent[2] = here;
    }
}

/* The hull of the points that are no duplicates. `corner` are four points that span a volume. */
static void triangulate(hull *h, const uint32_t corner[4])
{
    start_tetrahedron(h, corner);
    for (uint32_t p = 0; p < h->count; p++)
        if (!h->duplicate[p])
            add_point(h, p);
}

/* ---- points ---- */

static tl_status check_points(const tl_vec3 *points, size_t count, tl_error *error)
{
    if (count < 4)
        return tl_fail(error, TL_E_GEOMETRY,
                       "%zu vertices do not make a block: give four or more that do not lie in one plane", count);
    if (count > TL_POLY_MAX_VERTICES)
        return tl_fail(error, TL_E_GEOMETRY, "%zu vertices: one block can have %d at most", count,
                       TL_POLY_MAX_VERTICES);
    for (size_t i = 0; i < count; i++) {
        const double x[3] = {points[i].x, points[i].y, points[i].z};
        for (int k = 0; k < 3; k++)
            if (!isfinite(x[k]))
                return tl_fail(error, TL_E_GEOMETRY,
                               "the %c coordinate of vertex %zu is %g: it must be a finite number", "xyz"[k], i + 1,
                               x[k]);
    }
    return TL_OK;
}

/* Puts the points on the grid and marks those that repeat an earlier one within the tolerance. */
static tl_status place_on_grid(builder *b, tl_error *error)
{
    hull *h = &b->hull;
    const tl_bounds bounds = tl_points_bounds(b->point, h->count);
    const tl_vec3 low = bounds.min, sides = tl_v3_sub(bounds.max, low);
    double longest = fmax(sides.x, fmax(sides.y, sides.z));
    b->extent = tl_v3_norm(sides);
    if (longest == 0)
        return tl_fail(error, TL_E_GEOMETRY, "the %u vertices are one and the same point", h->count);
    /* Fifth powers of lengths occur in moments of inertia. */
    double fifth = b->extent * b->extent * b->extent * b->extent * b->extent;
    if (!isnormal(fifth))
        return tl_fail(error, TL_E_GEOMETRY,
                       "the vertices are %g apart, which cannot be computed with: use other units", longest);
    double reach = fmax(tl_v3_norm(low), tl_v3_norm(bounds.max));
    b->tolerance = fmax(TL_POLY_ON * b->extent, TL_POLY_ROUNDINGS * reach);
    if (b->tolerance > TL_POLY_THIN * b->extent)
        return tl_fail(
            error, TL_E_GEOMETRY,
            "vertices %g apart with coordinates of %g lose their digits: move the model nearer to the origin", longest,
            reach);
    int exponent;
    (void)frexp(longest, &exponent);
    b->unit = ldexp(1, GRID_BITS - exponent);
    for (uint32_t i = 0; i < h->count; i++) {
        tl_vec3 x = tl_v3_scale(b->unit, tl_v3_sub(b->point[i], low));
        h->grid[i][0] = llround(x.x);
        h->grid[i][1] = llround(x.y);
        h->grid[i][2] = llround(x.z);
    }
    double same = b->tolerance;
    for (uint32_t i = 0; i < h->count; i++)
        for (uint32_t j = 0; j < i && !h->duplicate[i]; j++)
            h->duplicate[i] = !h->duplicate[j] && tl_v3_norm2(tl_v3_sub(b->point[i], b->point[j])) <= same * same;
    return TL_OK;
}

static tl_status flat(const builder *b, double thickness, tl_error *error)
{
    /* A plane through three points leaves a height of rounding over it: that is none. */
    if (thickness < b->tolerance)
        thickness = 0;
    return tl_fail(error, TL_E_GEOMETRY,
                   "the %u vertices lie in one plane (thickness %.3g): a block needs a volume, at least %.3g thick for "
                   "a size of %.3g",
                   b->hull.count, thickness, TL_POLY_THIN * b->extent, b->extent);
}

/* Four points far apart: the first, the farthest from it, from their line, from their plane. */
static tl_status choose_corners(const builder *b, uint32_t corner[4], tl_error *error)
{
    const tl_vec3 *x = b->point;
    uint32_t n = b->hull.count;
    double best = 0;
    corner[0] = corner[1] = corner[2] = corner[3] = 0;
    for (uint32_t i = 1; i < n; i++) {
        double d = tl_v3_norm2(tl_v3_sub(x[i], x[0]));
        if (d > best && !b->hull.duplicate[i])
            best = d, corner[1] = i;
    }
    tl_vec3 along = tl_v3_unit(tl_v3_sub(x[corner[1]], x[0]));
    best = 0;
    for (uint32_t i = 1; i < n; i++) {
        double d = tl_v3_norm2(tl_v3_cross(along, tl_v3_sub(x[i], x[0])));
        if (d > best && !b->hull.duplicate[i])
            best = d, corner[2] = i;
    }
    if (!(sqrt(best) >= TL_POLY_THIN * b->extent))
        return flat(b, 0, error);
    tl_vec3 normal = tl_v3_unit(tl_v3_cross(along, tl_v3_sub(x[corner[2]], x[0])));
    double low = 0, high = 0;
    best = 0;
    for (uint32_t i = 1; i < n; i++) {
        double d = tl_v3_dot(normal, tl_v3_sub(x[i], x[0]));
        low = fmin(low, d);
        high = fmax(high, d);
        if (fabs(d) > best && !b->hull.duplicate[i])
            best = fabs(d), corner[3] = i;
    }
    if (!(high - low >= TL_POLY_THIN * b->extent))
        return flat(b, high - low, error);
    return TL_OK;
}

/* ---- faces from triangles ---- */

typedef struct area_rank {
    double area;
    uint32_t triangle;
} area_rank;

static int by_area(const void *left, const void *right)
{
    const area_rank *a = left, *b = right;
    if (a->area != b->area)
        return a->area > b->area ? -1 : 1;
    return a->triangle < b->triangle ? -1 : 1;
}

static bool order_by_area(builder *b)
{
    const hull *h = &b->hull;
    area_rank *rank = malloc(h->triangle_count * sizeof *rank);
    if (!rank)
        return false;
    uint32_t n = 0;
    for (uint32_t t = 0; t < h->triangle_count; t++) {
        const double *a = h->triangle[t].normal;
        if (h->triangle[t].alive)
            rank[n++] = (area_rank){a[0] * a[0] + a[1] * a[1] + a[2] * a[2], t};
    }
    qsort(rank, n, sizeof *rank, by_area);
    for (uint32_t i = 0; i < n; i++)
        b->order[i] = rank[i].triangle;
    b->pending[0] = n;
    free(rank);
    return true;
}

/* Whether all of a triangle lies within the tolerance of the seed's plane and faces its way. */
static bool joins(const builder *b, const hull_triangle *seed, const hull_triangle *t)
{
    const hull *h = &b->hull;
    const double *n = seed->normal, *m = t->normal;
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const int64_t *a = h->grid[seed->vertex[0]];
    for (int i = 0; i < 3; i++) {
        const int64_t *x = h->grid[t->vertex[i]];
        double height = n[0] * (double)(x[0] - a[0]) + n[1] * (double)(x[1] - a[1]) + n[2] * (double)(x[2] - a[2]);
        if (fabs(height) > b->tolerance * b->unit * length)
            return false;
    }
    return n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0;
}

/* Gives every triangle a face. */
static bool group_triangles(builder *b)
{
    hull *h = &b->hull;
    if (!order_by_area(b))
        return false;
    uint32_t alive = b->pending[0];
    for (uint32_t t = 0; t < h->triangle_count; t++)
        h->triangle[t].face = NO_FACE;
    for (uint32_t i = 0; i < alive; i++) {
        hull_triangle *seed = &h->triangle[b->order[i]];
        if (seed->face != NO_FACE)
            continue;
        uint32_t face = b->face_count++, waiting = 0;
        seed->face = face;
        b->pending[waiting++] = b->order[i];
        while (waiting) {
            const hull_triangle *t = &h->triangle[b->pending[--waiting]];
            for (int side = 0; side < 3; side++) {
                hull_triangle *next = &h->triangle[t->adjacent[side]];
                if (next->face != NO_FACE || !joins(b, seed, next))
                    continue;
                next->face = face;
                b->pending[waiting++] = t->adjacent[side];
            }
        }
    }
    return true;
}

static bool is_border(const hull *h, uint32_t t, int side)
{
    return h->triangle[t].face != h->triangle[h->triangle[t].adjacent[side]].face;
}

/* Counts the faces that meet in every point. */
static void count_sectors(builder *b)
{
    const hull *h = &b->hull;
    memset(b->sectors, 0, h->count * sizeof *b->sectors);
    for (uint32_t t = 0; t < h->triangle_count; t++)
        for (int side = 0; h->triangle[t].alive && side < 3; side++)
            if (is_border(h, t, side))
                b->sectors[h->triangle[t].vertex[side]]++;
}

/* Moves from a border side to the next one counter-clockwise around the same face. */
static void next_border(const hull *h, uint32_t *t, int *side)
{
    *side = (*side + 1) % 3;
    while (!is_border(h, *t, *side)) {
        uint32_t to = h->triangle[*t].adjacent[*side];
        *side = (side_towards(&h->triangle[to], *t) + 1) % 3;
        *t = to;
    }
}

/* Writes the corners of the face with border side (t, side); returns their number. `borders` counts
 * the sides passed. */
static uint32_t trace_face(const builder *b, uint32_t t, int side, uint16_t *loop, uint32_t *borders)
{
    uint32_t first = t, corners = 0;
    int first_side = side;
    *borders = 0;
    do {
        uint32_t v = b->hull.triangle[t].vertex[side];
        if (b->sectors[v] >= 3)
            loop[corners++] = (uint16_t)v;
        ++*borders;
        next_border(&b->hull, &t, &side);
    } while (t != first || side != first_side);
    return corners;
}

/* Finds a border side of every face: order[face] = 3 triangle + side. The face's border sides are
 * counted in pending[face]. */
static void find_borders(builder *b)
{
    const hull *h = &b->hull;
    for (uint32_t f = 0; f < b->face_count; f++) {
        b->order[f] = NO_FACE;
        b->pending[f] = 0;
    }
    for (uint32_t t = 0; t < h->triangle_count; t++)
        for (int side = 0; h->triangle[t].alive && side < 3; side++)
            if (is_border(h, t, side)) {
                uint32_t f = h->triangle[t].face;
                if (b->order[f] == NO_FACE)
                    b->order[f] = 3 * t + (uint32_t)side;
                b->pending[f]++;
            }
}

/* Gives the triangles of face `from` to the face beyond its border side. */
static void absorb(builder *b, uint32_t from, uint32_t border)
{
    hull *h = &b->hull;
    uint32_t to = h->triangle[h->triangle[border / 3].adjacent[border % 3]].face;
    for (uint32_t t = 0; t < h->triangle_count; t++)
        if (h->triangle[t].face == from)
            h->triangle[t].face = to;
}

/* Writes the loop of every face. A face with fewer than three corners is a sliver that no plane
 * took: its neighbour gets it, and the corners are found anew. */
static bool trace_faces(builder *b)
{
    uint32_t faces = 0, length = 0;
    count_sectors(b);
    find_borders(b);
    for (uint32_t f = 0; f < b->face_count; f++) {
        if (b->order[f] == NO_FACE)
            continue;
        uint32_t borders, corners = trace_face(b, b->order[f] / 3, (int)(b->order[f] % 3), b->loop + length, &borders);
        if (borders != b->pending[f])
            return false;
        if (corners < 3) {
            absorb(b, f, b->order[f]);
            count_sectors(b);
            find_borders(b);
            /* Start again: there is one face less each time. */
            f = UINT32_MAX;
            faces = length = 0;
            continue;
        }
        b->start[faces++] = length;
        length += corners;
    }
    b->start[faces] = length;
    b->face_count = faces;
    return faces >= 4;
}

/* ---- the polyhedron ---- */

/* Numbers the corners in the order of the points, starts every loop at its lowest. */
static void number_corners(builder *b)
{
    for (uint32_t i = 0; i < b->hull.count; i++)
        if (b->sectors[i] >= 3) {
            b->number[i] = (uint16_t)b->vertex_count;
            b->vertex[b->vertex_count++] = b->point[i];
        }
    for (uint32_t f = 0; f < b->face_count; f++) {
        uint16_t *loop = b->loop + b->start[f];
        uint32_t n = b->start[f + 1] - b->start[f], lowest = 0;
        for (uint32_t i = 0; i < n; i++) {
            loop[i] = b->number[loop[i]];
            lowest = loop[i] < loop[lowest] ? i : lowest;
        }
        for (; lowest > 0; lowest--) {
            uint16_t head = loop[0];
            memmove(loop, loop + 1, (n - 1) * sizeof *loop);
            loop[n - 1] = head;
        }
    }
}

/* Two different faces share at most two vertices, which they list in opposite order, so loops
 * differ in their first three. */
static uint64_t loop_key(const uint16_t *loop)
{
    return ((uint64_t)loop[0] << 32) | ((uint64_t)loop[1] << 16) | loop[2];
}

typedef struct loop_rank {
    uint64_t key;
    uint32_t face;
} loop_rank;

static int by_key(const void *left, const void *right)
{
    const loop_rank *a = left, *b = right;
    return (a->key > b->key) - (a->key < b->key);
}

/* The plane of a face from its vertices: Newell's normal, and the offset midway between the extremes of normal . x. So
 * a face normal to an axis gets exactly that axis and its coordinate. */
static tl_plane fit_plane(const tl_vec3 *vertices, const uint16_t *loop, size_t count)
{
    tl_plane plane = {.normal = tl_poly_normal(tl_poly_fan_area(vertices, loop, count))};
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        double height = tl_v3_dot(plane.normal, vertices[loop[i]]);
        low = height < low ? height : low;
        high = height > high ? height : high;
    }
    plane.offset = tl_poly_midway(low, high);
    return plane;
}

static tl_status assemble(builder *b, tl_poly **poly, tl_error *error)
{
    uint32_t n = b->face_count, length = b->start[n];
    loop_rank *rank = malloc(n * sizeof *rank);
    tl_poly *p = tl_poly_allocate(b->vertex_count, n, length / 2);
    if (!rank || !p) {
        free(rank);
        tl_poly_free(p);
        return tl_fail_memory(error);
    }
    for (uint32_t f = 0; f < n; f++)
        rank[f] = (loop_rank){loop_key(b->loop + b->start[f]), f};
    qsort(rank, n, sizeof *rank, by_key);
    memcpy(p->vertex, b->vertex, b->vertex_count * sizeof *p->vertex);
    p->start[0] = 0;
    for (uint32_t f = 0; f < n; f++) {
        uint32_t from = rank[f].face, corners = b->start[from + 1] - b->start[from];
        const uint16_t *loop = b->loop + b->start[from];
        memcpy(p->loop + p->start[f], loop, corners * sizeof *loop);
        p->start[f + 1] = (uint16_t)(p->start[f] + corners);
        p->plane[f] = fit_plane(p->vertex, loop, corners);
        p->tag[f] = (tl_tag){0, 0};
    }
    free(rank);
    return tl_poly_link(p, poly, error);
}

/* Refuses a hull that is too thin and a point that is no corner but lies inside. */
static tl_status check_hull(const builder *b, const tl_poly *p, tl_error *error)
{
    double shallow = fmax(b->tolerance, fmin(TL_POLY_BENT * b->extent, TL_POLY_SHALLOW * tl_poly_thickness(p)));
    for (uint32_t f = 0; f < p->face_count; f++) {
        double depth = 0;
        for (uint32_t v = 0; v < p->vertex_count; v++)
            depth = fmax(depth, p->plane[f].offset - tl_v3_dot(p->plane[f].normal, p->vertex[v]));
        if (depth < TL_POLY_THIN * b->extent)
            return flat(b, depth, error);
    }
    for (uint32_t i = 0; i < b->hull.count && !b->any; i++) {
        if (b->sectors[i] >= 3 || b->hull.duplicate[i])
            continue;
        double depth = INFINITY;
        for (uint32_t f = 0; f < p->face_count; f++)
            depth = fmin(depth, p->plane[f].offset - tl_v3_dot(p->plane[f].normal, b->point[i]));
        if (depth > shallow)
            return tl_fail(error, TL_E_GEOMETRY,
                           "vertex %u lies %.3g inside the hull of the others; a block must be convex: leave it out or "
                           "make two blocks of it",
                           i + 1, depth);
    }
    return TL_OK;
}

/* The polyhedron of the triangles merged with the present tolerance. *poly stays NULL when the
 * faces are not convex polygons. */
static tl_status merge(builder *b, tl_poly **poly, tl_error *error)
{
    b->face_count = b->vertex_count = 0;
    if (!group_triangles(b))
        return tl_fail_memory(error);
    if (!trace_faces(b))
        return TL_OK;
    if (b->face_count > TL_POLY_MAX_FACES)
        return tl_fail(error, TL_E_GEOMETRY, "the %u vertices make %u faces: one block can have %d", b->hull.count,
                       b->face_count, TL_POLY_MAX_FACES);
    number_corners(b);
    tl_poly *p = NULL;
    tl_status status = assemble(b, &p, error);
    if (!status && tl_poly_check(p, SOUND * b->tolerance / p->size, NULL) == TL_OK) {
        *poly = p;
        return TL_OK;
    }
    tl_poly_free(p);
    return status == TL_E_MEMORY ? status : TL_OK;
}

static tl_status build(builder *b, tl_poly **poly, tl_error *error)
{
    uint32_t corner[4];
    tl_status status = place_on_grid(b, error);
    if (!status)
        status = choose_corners(b, corner, error);
    if (status)
        return status;
    triangulate(&b->hull, corner);
    tl_poly *p = NULL;
    double fine = b->tolerance / WIDER;
    b->tolerance = fmax(TL_POLY_FLAT * b->extent, b->tolerance);
    status = merge(b, &p, error);
    while (!status && !p && WIDER * fine <= TL_POLY_THIN * b->extent) {
        fine *= WIDER;
        b->tolerance = fine;
        status = merge(b, &p, error);
    }
    if (status)
        return status;
    if (!p)
        return tl_fail(error, TL_E_GEOMETRY,
                       "the %u vertices do not make a block with flat faces: leave out vertices closer together than "
                       "%.3g, or nearer than that to a face they do not belong to",
                       b->hull.count, TL_POLY_THIN * b->extent);
    status = check_hull(b, p, error);
    if (!status)
        status = tl_poly_flatten(&p, error);
    if (status)
        tl_poly_free(p);
    else
        *poly = p;
    return status;
}

tl_status tl_poly_hull(const tl_vec3 *points, size_t count, tl_hull_of of, tl_poly **poly, tl_error *error)
{
    *poly = NULL;
    tl_status status = check_points(points, count, error);
    if (status)
        return status;
    builder b = {.any = of == TL_HULL_OF_ANY};
    if (!allocate(&b, points, count))
        return tl_fail_memory(error);
    status = build(&b, poly, error);
    free(b.memory);
    return status;
}
