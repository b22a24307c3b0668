/* moved_face.c - a polyhedron with one face in another plane.
 *
 * A vertex v of the face goes along the one edge that leaves the face there. So it stays on the planes of the two faces
 * beside it:
 *
 *     v' = v - (n . v - c) e / (n . e)        e along the edge, n . x = c the new plane
 *
 * Where several edges leave it, or the edge is nearly in the face, it goes along n instead. It is then off the planes
 * of its other faces by what it has moved. */
#include "geometry/moved_face.h"

#include "base/table.h"
#include "geometry/make.h"
#include "geometry/measure.h"

#include <math.h>
#include <talus/vmath.h>

/* Tolerance: sine of the angle between an edge and the face, below which the edge is not followed: a vertex would run
 * along it by ten times the way of the face. */
#define STEEP 0.1
/* Tolerance: share of an edge that it may get shorter by. */
#define SHORTER 0.5

/* The vertex at the other end of the one edge that leaves a face at a vertex; TL_NO_ROW: there are several. */
static uint32_t inner_end(const tl_poly *p, uint32_t face, uint32_t vertex)
{
    uint32_t end = TL_NO_ROW, count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        const tl_edge *edge = &p->edge[e];
        if ((edge->a != vertex && edge->b != vertex) || edge->left == face || edge->right == face)
            continue;
        end = edge->a == vertex ? edge->b : edge->a;
        count++;
    }
    return count == 1 ? end : TL_NO_ROW;
}

/* Where a vertex of the face goes that lies `height` over the plane. */
static tl_vec3 moved(const tl_poly *p, uint32_t face, uint32_t vertex, tl_vec3 n, double height)
{
    const tl_vec3 v = p->vertex[vertex];
    const uint32_t end = inner_end(p, face, vertex);
    if (end != TL_NO_ROW) {
        const tl_vec3 edge = tl_v3_sub(p->vertex[end], v);
        const double fall = -tl_v3_dot(n, edge);
        if (fall > STEEP * tl_v3_norm(edge) && height < SHORTER * fall)
            return tl_v3_madd(v, height / fall, edge);
    }
    return tl_v3_madd(v, -height, n);
}

/* Drops planes of other parts behind which the polyhedron no longer lies. */
static void drop_planes(tl_poly *p)
{
    uint32_t kept = p->face_count;
    for (uint32_t k = p->face_count; k < p->plane_count; k++) {
        const tl_plane plane = p->plane[k];
        double most = -INFINITY;
        for (uint32_t v = 0; v < p->vertex_count; v++)
            most = fmax(most, tl_v3_dot(plane.normal, p->vertex[v]) - plane.offset);
        if (most <= TL_POLY_ON * p->size)
            p->plane[kept++] = plane;
    }
    p->plane_count = kept;
}

tl_poly *tl_poly_move_face(const tl_poly *p, uint32_t face, tl_plane plane, double *way)
{
    tl_poly *out = tl_poly_copy(p);
    if (!out)
        return NULL;
    out->plane[face] = plane;
    for (uint32_t k = p->start[face]; k < p->start[face + 1]; k++) {
        const uint32_t v = p->loop[k];
        out->vertex[v] = moved(p, face, v, plane.normal, tl_v3_dot(plane.normal, p->vertex[v]) - plane.offset);
    }
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const double over = tl_v3_dot(plane.normal, out->vertex[v]) - plane.offset;
        if (over > 0) /* by its rounding, or beside an edge that is nearly in the face */
            out->vertex[v] = tl_v3_madd(out->vertex[v], -over, plane.normal);
        *way = fmax(*way, tl_v3_norm(tl_v3_sub(out->vertex[v], p->vertex[v])));
    }
    tl_poly_find_size(out);
    drop_planes(out);
    return out;
}
