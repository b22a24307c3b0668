/* cut_planes.h - random planes of every kind a cut may meet, for the test and the benchmark of cutting. */
#ifndef TALUS_TESTS_CUT_PLANES_H
#define TALUS_TESTS_CUT_PLANES_H

#include "check.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

static uint64_t seed = 20240607;

static double uniform(double low, double high)
{
    return low + (high - low) * check_random(&seed);
}

static uint32_t pick(uint32_t n)
{
    return (uint32_t)(check_random(&seed) * n);
}

static tl_vec3 direction(void)
{
    for (;;) {
        tl_vec3 v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        double n = tl_v3_norm(v);
        if (n > 0.1 && n <= 1)
            return tl_v3_unit(v);
    }
}

static tl_vec3 inner_point(const tl_poly *p)
{
    tl_vec3 sum = {0, 0, 0};
    double total = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double w = uniform(0, 1);
        sum = tl_v3_madd(sum, w, tl_v3_sub(p->vertex[v], p->vertex[0]));
        total += w;
    }
    return tl_v3_madd(p->vertex[0], 1 / total, sum);
}

static tl_plane plane_through(tl_vec3 normal, tl_vec3 point)
{
    return (tl_plane){normal, tl_v3_dot(normal, point)};
}

typedef enum kind {
    ANY,        /* through a random inner point */
    VERTEX,     /* through a vertex */
    EDGE,       /* through an edge */
    DIAGONAL,   /* through three vertices */
    PARALLEL,   /* along a face, at any depth */
    COINCIDENT, /* of a face */
    GRID,       /* normal to an axis, at a multiple of 1/64 of the first block's side */
    TILTED,     /* nearly along a face: cuts of this kind leave faces that almost coincide */
    TOUCHING    /* passes a vertex by anything from a rounding to 1e-8 of the size */
} kind;

static tl_plane random_plane(const tl_poly *p, kind which)
{
    tl_vec3 a = p->vertex[pick(p->vertex_count)], inside = inner_point(p);
    tl_plane face = p->plane[pick(p->face_count)];
    tl_edge edge = p->edge[pick(p->edge_count)];
    switch (which) {
    case VERTEX: return plane_through(direction(), a);
    case EDGE: {
        tl_vec3 along = tl_v3_sub(p->vertex[edge.b], p->vertex[edge.a]);
        tl_vec3 n = tl_v3_cross(along, tl_v3_sub(inside, p->vertex[edge.a]));
        return plane_through(tl_v3_unit(n), p->vertex[edge.a]);
    }
    case DIAGONAL: {
        tl_vec3 b = p->vertex[pick(p->vertex_count)], c = p->vertex[pick(p->vertex_count)];
        tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
        return tl_v3_norm(n) > 0 ? plane_through(n, a) : plane_through(direction(), a);
    }
    case PARALLEL: return plane_through(pick(2) ? face.normal : tl_v3_neg(face.normal), inside);
    case COINCIDENT: return pick(2) ? face : (tl_plane){tl_v3_neg(face.normal), -face.offset};
    case TILTED: {
        double tilt = pow(10, uniform(-12, -2));
        return plane_through(tl_v3_unit(tl_v3_madd(face.normal, tilt, direction())), inside);
    }
    case GRID: {
        static const tl_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        tl_vec3 n = axes[pick(3)];
        return (tl_plane){n, 0.125 * floor(8 * tl_v3_dot(n, inside) + 0.5)};
    }
    case TOUCHING: {
        tl_plane plane = plane_through(direction(), a);
        plane.offset += (pick(2) ? 1 : -1) * p->size * pow(10, uniform(-17, -8));
        return plane;
    }
    case ANY: break;
    }
    return plane_through(direction(), inside);
}

#endif
