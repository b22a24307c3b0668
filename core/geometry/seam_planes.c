/* seam_planes.c - planes of a body's surface that count for a part though they belong to faces of other parts.
 *
 * The depth of a point in a body is its distance from the body's surface. The nearest outer face may belong to another part than
 * the point does: where a seam meets an edge of the body, or where it runs close below a face. So a part is given the planes of
 * the other parts' outer faces behind which it lies as a whole. They bound nothing of it. A convex body lies behind all planes
 * of its outer faces, so the depth in its parts is that in the body, however it is cut.
 *
 * Left out is a plane from which every corner of the part is at least as far as from one other: depths are linear, so no point
 * of the part is nearer to it. */
#include "geometry/polyhedron.h"

#include "base/error.h"
#include "geometry/assemble.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

/* A part lies behind a plane, and two planes are one, within this times its size: as parts fit (seam.c). */
#define FIT 1e-6

/* Planes, of outer faces or of those that count for a part. */
typedef struct planes {
    tl_plane *plane;
    size_t count, capacity;
} planes;

static double depth(tl_plane plane, tl_vec3 x)
{
    return plane.offset - tl_v3_dot(plane.normal, x);
}

/* Depth of the vertex that lies the least deep. */
static double least_depth(const tl_poly *p, tl_plane plane)
{
    double least = INFINITY;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        least = fmin(least, depth(plane, p->vertex[v]));
    return least;
}

/* Whether no vertex of a part is nearer to plane f than to plane g. */
static bool is_farther(const tl_poly *p, tl_plane f, tl_plane g)
{
    double slack = FIT * p->size;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (depth(f, p->vertex[v]) < depth(g, p->vertex[v]) - slack)
            return false;
    return true;
}

/* Whether a plane is the nearest of all to some point of a part, as far as single ones tell. */
static bool counts_for(const tl_poly *p, tl_plane plane, const planes *others)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!p->covered[f] && is_farther(p, plane, p->plane[f]))
            return false;
    for (size_t k = 0; k < others->count; k++)
        if (is_farther(p, plane, others->plane[k]))
            return false;
    return true;
}

static bool append(planes *c, tl_plane plane)
{
    if (c->count == c->capacity) {
        size_t capacity = 2 * c->capacity + 8;
        tl_plane *all = realloc(c->plane, capacity * sizeof *all);
        if (!all)
            return false;
        c->plane = all;
        c->capacity = capacity;
    }
    c->plane[c->count++] = plane;
    return true;
}

/* Adds what counts for a part of the planes of a body's outer faces. false: out of memory. */
static bool choose_for(const tl_poly *p, const planes *outer, planes *chosen)
{
    chosen->count = 0;
    for (size_t k = 0; k < outer->count; k++) {
        tl_plane plane = outer->plane[k];
        if (depth(plane, p->vertex[0]) < -FIT * p->size)
            continue; /* most cut a part of a large body, or pass it by */
        double least = least_depth(p, plane);
        if (least < -FIT * p->size || !counts_for(p, plane, chosen))
            continue;
        plane.offset -= fmin(least, 0); /* it cuts nothing off */
        if (!append(chosen, plane))
            return false;
    }
    return true;
}

/* Leaves out the planes that a later one has made idle. */
static void tidy(const tl_poly *p, planes *c)
{
    size_t kept = 0;
    for (size_t k = 0; k < c->count; k++) {
        bool idle = false;
        for (size_t m = k + 1; m < c->count && !idle; m++)
            idle = is_farther(p, c->plane[k], c->plane[m]);
        if (!idle)
            c->plane[kept++] = c->plane[k];
    }
    c->count = kept;
}

static bool gather_outer(tl_poly *const *parts, size_t count, planes *outer)
{
    for (size_t k = 0; k < count; k++)
        for (uint32_t f = 0; f < parts[k]->face_count; f++)
            if (!parts[k]->covered[f] && !append(outer, parts[k]->plane[f]))
                return false;
    return true;
}

/* A part's own planes are no farther than they are themselves, so they are not chosen. */
tl_status tl_poly_share_planes(tl_poly *const *parts, size_t count, tl_error *error)
{
    planes outer = {0}, chosen = {0};
    bool done = count < 2 || gather_outer(parts, count, &outer);
    for (size_t i = 0; i < count && done; i++) {
        done = choose_for(parts[i], &outer, &chosen);
        tidy(parts[i], &chosen);
        size_t most = TL_POLY_MAX_FACES - parts[i]->face_count; /* numbers of planes have 16 bits */
        done = done && tl_poly_add_planes(parts[i], chosen.plane,
                                          (uint32_t)(chosen.count < most ? chosen.count : most));
    }
    free(outer.plane);
    free(chosen.plane);
    return done ? TL_OK : tl_fail_memory(error);
}
