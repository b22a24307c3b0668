/* body_shape.c - how large, how small and how thin a body is, however many parts it has. */
#include "model/body_shape.h"

#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>

bool tl_body_is_visible(const tl_model *m, uint32_t body)
{
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        if (m->blocks.hidden[tl_body_blocks(m, body)[k]])
            return false;
    return true;
}

double tl_body_volume(const tl_model *m, uint32_t body)
{
    double volume = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        volume += m->blocks.volume[tl_body_blocks(m, body)[k]];
    return volume;
}

double tl_body_size(const tl_model *m, uint32_t body)
{
    return tl_cbrt(tl_body_volume(m, body));
}

double tl_body_least_thickness(const tl_model *m, uint32_t body)
{
    double least = INFINITY;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        least = fmin(least, tl_least_thickness(m, tl_body_blocks(m, body)[k]));
    return least;
}

/* The hull of points, which it spoils, as many at a time as a polyhedron can have; NULL: it has more corners. */
static tl_status hull_of_many(tl_vec3 *points, size_t count, tl_poly **hull)
{
    tl_error error;
    for (*hull = NULL;;) {
        const size_t some = count < TL_POLY_MAX_VERTICES ? count : TL_POLY_MAX_VERTICES;
        const tl_status status = tl_poly_hull(points, some, TL_HULL_OF_ANY, hull, &error);
        const size_t corners = *hull ? (*hull)->vertex_count : some;
        if (status == TL_E_MEMORY || some == count)
            return status == TL_E_MEMORY ? status : TL_OK;
        if (corners <= some / 2) {
            memcpy(points, (*hull)->vertex, corners * sizeof *points);
            memmove(points + corners, points + some, (count - some) * sizeof *points);
            count -= some - corners;
        }
        tl_poly_free(*hull);
        *hull = NULL;
        if (corners > some / 2)
            return TL_OK;
    }
}

/* The hull of all parts; NULL: it has too many corners. */
static tl_status hull_of_parts(const tl_model *m, uint32_t body, tl_poly **hull)
{
    size_t count = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        count += m->blocks.shape[tl_body_blocks(m, body)[k]]->vertex_count;
    tl_vec3 *points = malloc((count + 1) * sizeof *points), *end = points;
    if (!points)
        return TL_E_MEMORY;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const tl_poly *p = m->blocks.shape[tl_body_blocks(m, body)[k]];
        memcpy(end, p->vertex, p->vertex_count * sizeof *end);
        end += p->vertex_count;
    }
    const tl_status status = hull_of_many(points, count, hull);
    free(points);
    return status;
}

static tl_body_shape measure(const tl_poly *p)
{
    return (tl_body_shape){tl_poly_shortest_edge(p), tl_poly_diameter(p) / tl_poly_thickness(p)};
}

bool tl_body_shape_of(const tl_model *m, uint32_t body, tl_body_shape *out)
{
    if (m->bodies.member_count[body] == 1) {
        *out = measure(m->blocks.shape[tl_body_blocks(m, body)[0]]);
        return true;
    }
    tl_poly *hull = NULL;
    const tl_status status = hull_of_parts(m, body, &hull);
    *out = hull ? measure(hull) : (tl_body_shape){INFINITY, 1};
    tl_poly_free(hull);
    return status == TL_OK;
}
