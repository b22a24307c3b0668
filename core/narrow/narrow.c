/* narrow.c - the memory that the geometry of a pair works in. */
#include "narrow/narrow.h"

#include <stdlib.h>

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
