/* room.c - the memory that the geometry of a pair works in. */
#include "narrow/room.h"

#include "narrow/polygon.h"

#include <stdlib.h>

void tl_narrow_free(tl_narrow *n)
{
    free(n->vertex_b);
    free(n->normal_b);
    free(n->dots);
    free(n->share);
    free(n->manifold.facets);
    free(n->manifold.points);
    free(n->old);
    free(n->value);
    tl_polygon_free(n->polygon, &n->patch);
}

bool tl_manifold_reserve(tl_manifold *m, size_t count)
{
    if (m->point_count + count <= m->point_room)
        return true;
    size_t room = 2 * (m->point_count + count);
    tl_contact_point *points = room > UINT16_MAX ? NULL : realloc(m->points, room * sizeof *points);
    if (!points) {
        m->failed = true;
        return false;
    }
    m->points = points;
    m->point_room = room;
    return true;
}

bool tl_manifold_add_point(tl_manifold *m, tl_contact_point point)
{
    if (!(point.area > 0)) /* a point without area carries nothing, and has no stress */
        return true;
    if (!tl_manifold_reserve(m, 1))
        return false;
    m->points[m->point_count++] = point;
    return true;
}

bool tl_manifold_reserve_facets(tl_manifold *m, size_t room)
{
    if (room <= m->facet_room)
        return true;
    tl_facet *facets = realloc(m->facets, 2 * room * sizeof *facets);
    if (!facets) {
        m->failed = true;
        return false;
    }
    m->facets = facets;
    m->facet_room = 2 * room;
    return true;
}
