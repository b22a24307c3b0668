/* narrow.c - the memory that the geometry of a pair works in, and block B of a pair brought into A's frame there. */
#include "narrow/narrow.h"

#include "base/table.h"

#include <stdlib.h>
#include <talus/vmath.h>

void tl_narrow_scratch_free(tl_narrow_scratch *n)
{
    free(n->vertex_b);
    free(n->normal_b);
    free(n->corner);
    free(n->manifold.points);
    free(n->old);
    free(n->cell);
    free(n->plane);
    free(n->press);
    free(n->face);
    free(n->field.line);
    free(n->field.plane);
    free(n->field.number);
    free(n->outlines.corner);
    free(n->outlines.face);
    free(n->batch);
    free(n->patch.p[0]);
}

bool tl_manifold_reserve(tl_manifold *m, size_t count)
{
    if (m->point_count + count <= m->point_capacity)
        return true;
    size_t capacity = 2 * (m->point_count + count);
    tl_contact_point *points = capacity > UINT16_MAX ? NULL : realloc(m->points, capacity * sizeof *points);
    if (!points) {
        m->failed = true;
        return false;
    }
    m->points = points;
    m->point_capacity = capacity;
    return true;
}

/* Vectors turned and shifted: each is four lanes, of which the next vector takes the last one's place. */
TL_VECTORIZED static void place(const tl_mat3 *turn, tl_vec3 shift, const tl_vec3 *restrict from, size_t stride,
                                size_t count, double *restrict to)
{
    const double(*m)[3] = turn->m, t[4] = {shift.x, shift.y, shift.z, shift.z};
    const double x[4] = {m[0][0], m[1][0], m[2][0], m[2][0]};
    const double y[4] = {m[0][1], m[1][1], m[2][1], m[2][1]};
    const double z[4] = {m[0][2], m[1][2], m[2][2], m[2][2]};
    for (size_t i = 0; i < count; i++, to += 3) {
        const tl_vec3 v = *(const tl_vec3 *)(const void *)((const char *)from + i * stride);
#pragma omp simd
        for (int k = 0; k < 4; k++)
            to[k] = x[k] * v.x + y[k] * v.y + z[k] * v.z + t[k];
    }
}

/* The same of the normals of some planes, each into its own place. */
TL_VECTORIZED static void place_some(const tl_mat3 *turn, const tl_plane *restrict from, const uint16_t *restrict face,
                                     size_t count, tl_vec3 *restrict to)
{
    const double(*m)[3] = turn->m;
    const double x[4] = {m[0][0], m[1][0], m[2][0], m[2][0]};
    const double y[4] = {m[0][1], m[1][1], m[2][1], m[2][1]};
    const double z[4] = {m[0][2], m[1][2], m[2][2], m[2][2]};
    for (size_t i = 0; i < count; i++) {
        const tl_vec3 v = from[face[i]].normal;
        double turned[4];
#pragma omp simd
        for (int k = 0; k < 4; k++)
            turned[k] = x[k] * v.x + y[k] * v.y + z[k] * v.z + 0.0;
        to[face[i]] = tl_v3(turned[0], turned[1], turned[2]);
    }
}

bool tl_pairs_reserve(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch)
{
    size_t vertices = 1, faces = 1;
    for (uint32_t k = 0; k < count; k++) {
        vertices += view[k].b->vertex_count;
        faces += view[k].b->plane_count;
    }
    if (!tl_grow(&scratch->vertex_b, &scratch->vertex_capacity, vertices, sizeof(tl_vec3)) ||
        !tl_grow(&scratch->normal_b, &scratch->normal_capacity, faces, sizeof(tl_vec3)))
        return false;
    tl_vec3 *vertex = scratch->vertex_b, *normal = scratch->normal_b;
    for (tl_pair_view *v = view; v < view + count; v++) {
        v->vertex_b = vertex;
        v->normal_b = normal;
        vertex += v->b->vertex_count;
        normal += v->b->plane_count;
    }
    return true;
}

void tl_pair_place_normals(const tl_pair_view *v, const uint16_t *face, uint32_t count)
{
    place_some(&v->turn, v->b->plane, face, count, v->normal_b);
}

void tl_pair_place_all(const tl_pair_view *v)
{
    const tl_poly *b = v->b;
    tl_vec3 after_vertices = v->vertex_b[b->vertex_count], after_normals = v->normal_b[b->plane_count];
    place(&v->turn, v->shift, b->vertex, sizeof(tl_vec3), b->vertex_count, &v->vertex_b->x);
    place(&v->turn, tl_v3(0, 0, 0), &b->plane[0].normal, sizeof(tl_plane), b->plane_count, &v->normal_b->x);
    v->vertex_b[b->vertex_count] = after_vertices; /* of which the last fourth lanes have overwritten some */
    v->normal_b[b->plane_count] = after_normals;
}

bool tl_pairs_place(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch)
{
    if (!tl_pairs_reserve(view, count, scratch))
        return false;
    for (uint32_t k = 0; k < count; k++)
        tl_pair_place_all(&view[k]);
    return true;
}

bool tl_pair_place(tl_pair_view *view, tl_narrow_scratch *scratch)
{
    return tl_pairs_place(view, 1, scratch);
}
