/* zone_points.c - the points of the zones of one block: its corners, the frame, the planes.
 *
 * All choices are made in a frame of the block: its origin is the first vertex, x goes along the longest edge, y into
 * the face to its left. Places in it are made of differences of vertices. A block that is moved, or made larger by
 * a power of two, so has the same choices to the bit. Its own coordinates must not be rounded by that.
 *
 * Lengths within TIE of each other count as equal; then the edge with the lower number is the longest. */
#include "geometry/zone_points.h"

#include "base/random.h"
#include "base/table.h"
#include "geometry/make.h"

#include <stdlib.h>
#include <talus/vmath.h>

/* Tolerance: lengths that differ by less than this share count as equal. */
#define TIE 1e-9

bool tl_zone_points_add(tl_zone_points *p, tl_vec3 place, double size, uint64_t key)
{
    const size_t need = (size_t)p->count + 1;
    if (need > TL_DELAUNAY_MOST / 8 || !tl_grow(&p->place, &p->place_room, need, sizeof *p->place) ||
        !tl_grow(&p->size, &p->size_room, need, sizeof *p->size) ||
        !tl_grow(&p->chance, &p->chance_room, need, sizeof *p->chance))
        return false;
    p->place[p->count] = place;
    p->size[p->count] = size;
    p->chance[p->count] = tl_uniform(key);
    p->count++;
    return true;
}

bool tl_zone_points_add_outer(tl_zone_points *p, tl_vec3 place, tl_vec3 real, tl_point2 flat, double size, uint64_t key)
{
    const size_t need = (size_t)p->count + 1;
    if (!tl_grow(&p->real, &p->real_room, need, sizeof *p->real) ||
        !tl_grow(&p->flat, &p->flat_room, need, sizeof *p->flat))
        return false;
    p->real[p->count] = real;
    p->flat[p->count] = flat;
    return tl_zone_points_add(p, place, size, key);
}

tl_status tl_zone_size_check(double size, tl_vec3 place, tl_error *error)
{
    if (isfinite(size) && size > 0)
        return TL_OK;
    return tl_fail(error, TL_E_ARGUMENT, "the wanted edge of zones is %g at (%g, %g, %g): it must be positive", size,
                   place.x, place.y, place.z);
}

tl_vec3 tl_zone_out_of_frame(const tl_zone_points *p, tl_vec3 place)
{
    return tl_v3_add(p->poly->vertex[0], tl_m3_tmul(&p->axes, place));
}

static tl_vec3 along(const tl_poly *poly, const tl_edge *e)
{
    return tl_v3_sub(poly->vertex[e->b], poly->vertex[e->a]);
}

/* x along the longest edge, y into the face to its left. */
static void choose_frame(tl_zone_points *p)
{
    const tl_poly *poly = p->poly;
    uint32_t longest = 0;
    double best = 0;
    for (uint32_t e = 0; e < poly->edge_count; e++) {
        const double length = tl_v3_norm(along(poly, &poly->edge[e]));
        if (length > best * (1 + TIE))
            best = length, longest = e;
    }
    const tl_edge *e = &poly->edge[longest];
    const tl_vec3 x = tl_v3_unit(along(poly, e)), from = poly->vertex[e->a];
    double deepest = 0;
    tl_vec3 inward = {0, 0, 0};
    for (uint32_t i = poly->start[e->left]; i < poly->start[e->left + 1]; i++) {
        const tl_vec3 to = tl_v3_sub(poly->vertex[poly->loop[i]], from);
        const tl_vec3 across = tl_v3_madd(to, -tl_v3_dot(to, x), x);
        if (tl_v3_norm2(across) > deepest * (1 + TIE))
            deepest = tl_v3_norm2(across), inward = across;
    }
    const tl_vec3 y = tl_v3_unit(tl_v3_madd(inward, -tl_v3_dot(inward, x), x));
    p->axes = tl_m3_of_rows(x, y, tl_v3_cross(x, y));
}

/* The plane of a face by its corners in the frame, and how far they are off. */
static void fit_plane(tl_zone_points *p, uint32_t face)
{
    const tl_poly *poly = p->poly;
    const uint16_t *loop = poly->loop + poly->start[face];
    const uint32_t corners = tl_poly_face_size(poly, face);
    tl_plane *plane = &p->plane[face];
    plane->normal = tl_v3_unit(tl_poly_fan_area(p->place, loop, corners));
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < corners; i++) {
        const double height = tl_v3_dot(plane->normal, p->place[loop[i]]);
        low = height < low ? height : low;
        high = height > high ? height : high;
    }
    plane->offset = low + 0.5 * (high - low);
    p->bend[face] = 0.5 * (high - low);
}

/* The centroid in the frame, by tetrahedra about the first vertex, which is its origin. */
static void find_centroid(tl_zone_points *p)
{
    const tl_poly *poly = p->poly;
    double six = 0;
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t f = 0; f < poly->face_count; f++) {
        const uint16_t *loop = poly->loop + poly->start[f];
        for (uint32_t i = 1; i + 1 < tl_poly_face_size(poly, f); i++) {
            const tl_vec3 a = p->place[loop[0]], b = p->place[loop[i]], c = p->place[loop[i + 1]];
            const double part = tl_v3_dot(a, tl_v3_cross(b, c));
            six += part;
            sum = tl_v3_madd(sum, part, tl_v3_add(tl_v3_add(a, b), c));
        }
    }
    p->centroid = tl_v3_scale(1 / (4 * six), sum);
    double most = 0;
    for (uint32_t v = 0; v < poly->vertex_count; v++)
        most = fmax(most, tl_v3_norm2(tl_v3_sub(p->place[v], p->centroid)));
    p->extent = sqrt(most);
}

/* Which edge goes from each place of a loop to the next. */
static void find_edges(tl_zone_points *p)
{
    const tl_poly *poly = p->poly;
    for (uint32_t e = 0; e < poly->edge_count; e++)
        for (int side = 0; side < 2; side++) {
            const tl_edge *edge = &poly->edge[e];
            const uint32_t face = side ? edge->right : edge->left, from = side ? edge->b : edge->a;
            const uint32_t to = side ? edge->a : edge->b;
            for (uint32_t h = poly->start[face]; h < poly->start[face + 1]; h++)
                if (poly->loop[h] == from && poly->loop[tl_poly_after(poly, face, h)] == to)
                    p->edge_at[h] = e;
        }
}

static bool make_room(tl_zone_points *p)
{
    const size_t faces = p->poly->face_count, edges = p->poly->edge_count;
    return tl_grow(&p->edge_start, &p->edge_start_room, edges + 1, sizeof *p->edge_start) &&
           tl_grow(&p->edge_at, &p->edge_at_room, 2 * edges, sizeof *p->edge_at) &&
           tl_grow(&p->edge_part, &p->edge_part_room, edges, sizeof *p->edge_part) &&
           tl_grow(&p->plane, &p->plane_room, faces, sizeof *p->plane) &&
           tl_grow(&p->bend, &p->bend_room, faces, sizeof *p->bend) &&
           tl_grow(&p->turn, &p->turn_room, faces, sizeof *p->turn) &&
           tl_grow(&p->face_from, &p->face_from_room, faces + 1, sizeof *p->face_from);
}

tl_status tl_zone_points_begin(tl_zone_points *p, const tl_poly *poly, const tl_shape_zoning *zoning, tl_error *error)
{
    p->poly = poly;
    p->zoning = zoning;
    p->count = 0;
    if (!make_room(p))
        return tl_fail_memory(error);
    choose_frame(p);
    for (uint32_t v = 0; v < poly->vertex_count; v++) {
        const tl_vec3 real = poly->vertex[v];
        const tl_vec3 place = tl_zone_into_frame(p, tl_v3_sub(real, poly->vertex[0]));
        const double size = tl_zoning_size(zoning, real);
        const tl_status status = tl_zone_size_check(size, real, error);
        if (status)
            return status;
        if (!tl_zone_points_add_outer(p, place, real, (tl_point2){0, 0}, size, tl_mix64(tl_zone_corner_key(p, v))))
            return tl_fail_memory(error);
    }
    p->corner_end = p->count;
    for (uint32_t f = 0; f < poly->face_count; f++)
        fit_plane(p, f);
    find_centroid(p);
    find_edges(p);
    return TL_OK;
}

void tl_zone_points_free(tl_zone_points *p)
{
    free(p->place);
    free(p->real);
    free(p->size);
    free(p->chance);
    free(p->flat);
    free(p->edge_start);
    free(p->edge_at);
    free(p->edge_part);
    free(p->plane);
    free(p->bend);
    free(p->turn);
    free(p->face_from);
    free(p->start);
    free(p->filled);
    free(p->in_face);
    *p = (tl_zone_points){0};
}
