/* triangulate.c - the triangulated convex hull of points on an integer grid, exactly.
 *
 * Incremental: each point outside takes away the triangles that see it and is joined to their
 * horizon. Which side of a plane a point is on is decided in exact integer arithmetic (a double
 * product decides first where its rounding cannot matter), so the result is a closed convex surface
 * whatever the points, coplanar ones included.
 *
 * Needs a compiler with 128-bit integers (gcc and clang on 64-bit machines): a height is at most
 * 6 (2^41)^3 < 2^126. The work is proportional to points times triangles. */
#include "geometry/triangulate.h"

#include <float.h>
#include <math.h>
#include <string.h>

__extension__ typedef __int128 wide_int;

/* Tolerance: error over the sum of magnitudes of a double product of two cross product components and a difference.
 * Beyond this bound its sign is right, and integers are not needed. */
#define SIGN_BOUND (8 * DBL_EPSILON)

static wide_int wide(int64_t a)
{
    return (wide_int)a;
}

/* Twice the area vector of the grid triangle, exact. */
static void area_vector(const tl_hull *h, const uint32_t v[3], wide_int n[3])
{
    const int64_t *a = h->grid[v[0]], *b = h->grid[v[1]], *c = h->grid[v[2]];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = wide(b[j] - a[j]) * wide(c[k] - a[k]) - wide(b[k] - a[k]) * wide(c[j] - a[j]);
    }
}

/* The sign of the height of point p over the triangle's plane. */
static int height_sign(const tl_hull *h, const tl_hull_triangle *t, uint32_t p)
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
static tl_hull_triangle *new_triangle(tl_hull *h, uint32_t a, uint32_t b, uint32_t c,
                                      uint32_t *index)
{
    *index = h->free_count ? h->free[--h->free_count] : h->triangle_count++;
    tl_hull_triangle *t = &h->triangle[*index];
    *t = (tl_hull_triangle){.vertex = {a, b, c}, .alive = true};
    wide_int n[3];
    area_vector(h, t->vertex, n);
    for (int i = 0; i < 3; i++)
        t->normal[i] = (double)n[i];
    return t;
}

/* Makes the tetrahedron of four points that span a volume. */
static void start_tetrahedron(tl_hull *h, const uint32_t corner[4])
{
    uint32_t v[4] = {corner[0], corner[1], corner[2], corner[3]}, index;
    tl_hull_triangle probe = {.vertex = {v[0], v[1], v[2]}};
    if (height_sign(h, &probe, v[3]) > 0) {
        v[1] = corner[2];
        v[2] = corner[1];
    }
    /* Below the first face lies v[3]; side i of a triangle runs from vertex i to the next. */
    tl_hull_triangle *t = new_triangle(h, v[0], v[1], v[2], &index);
    memcpy(t->adjacent, (uint32_t[]){1, 2, 3}, sizeof t->adjacent);
    t = new_triangle(h, v[1], v[0], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 3, 2}, sizeof t->adjacent);
    t = new_triangle(h, v[2], v[1], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 1, 3}, sizeof t->adjacent);
    t = new_triangle(h, v[0], v[2], v[3], &index);
    memcpy(t->adjacent, (uint32_t[]){0, 2, 1}, sizeof t->adjacent);
}

static int side_towards(const tl_hull_triangle *t, uint32_t neighbour)
{
    return t->adjacent[0] == neighbour ? 0 : t->adjacent[1] == neighbour ? 1 : 2;
}

/* Marks the triangles that see point p; whether there are any. */
static bool mark_visible(tl_hull *h, uint32_t p)
{
    bool any = false;
    for (uint32_t i = 0; i < h->triangle_count; i++) {
        tl_hull_triangle *t = &h->triangle[i];
        t->visible = t->alive && height_sign(h, t, p) > 0;
        any = any || t->visible;
    }
    return any;
}

/* Adds point p: the triangles that see it give way to a fan from p to their horizon. */
static void add_point(tl_hull *h, uint32_t p)
{
    if (!mark_visible(h, p))
        return;
    /* Horizon edges, each kept with the triangle beyond it; `at[a]` is the one that starts in a. */
    uint32_t edges = 0, before = h->triangle_count;
    for (uint32_t i = 0; i < before; i++) {
        tl_hull_triangle *t = &h->triangle[i];
        for (int side = 0; t->visible && side < 3; side++) {
            const tl_hull_triangle *beyond = &h->triangle[t->adjacent[side]];
            if (beyond->visible)
                continue;
            uint32_t a = t->vertex[side], b = t->vertex[(side + 1) % 3];
            h->horizon[edges++] =
                (tl_hull_edge){a, b, t->adjacent[side], side_towards(beyond, i), 0};
        }
    }
    for (uint32_t i = 0; i < before; i++)
        if (h->triangle[i].visible) {
            h->triangle[i].alive = h->triangle[i].visible = false;
            h->free[h->free_count++] = i;
        }
    for (uint32_t e = 0; e < edges; e++) {
        tl_hull_edge *edge = &h->horizon[e];
        tl_hull_triangle *t = new_triangle(h, edge->a, edge->b, p, &edge->triangle);
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

void tl_hull_triangulate(tl_hull *h, const uint32_t corner[4])
{
    start_tetrahedron(h, corner);
    for (uint32_t p = 0; p < h->count; p++)
        if (!h->duplicate[p])
            add_point(h, p);
}
