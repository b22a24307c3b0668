/* solid_crossing.c - whether the surface of a solid crosses itself.
 *
 * Where two faces cross, an edge of one goes through the inside of the other, or lies in it. Each edge is tried against
 * the faces whose bounds it meets. It goes through a face when its ends lie on both sides and the point between lies
 * inside. An edge may also lie in the plane of a face, and run inside it for a stretch. Then it crosses the face when
 * its own faces lie on both sides, or one along the face, looking the same way. What only touches is let be. */
#include "geometry/solid_crossing.h"

#include "base/error.h"
#include "geometry/box_tree.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

typedef struct search {
    const tl_solid_mesh *m;
    uint32_t edge, face; /* at hand; found */
    tl_vec3 at;
    double *stretch; /* places on the edge where it meets edges of a face, as parts of its length */
    uint32_t stretches, capacity;
    bool found, lost; /* lost: out of memory */
} search;

static bool add_place(search *s, double at)
{
    if (!tl_solid_grow(&s->stretch, &s->capacity, s->stretches, sizeof *s->stretch))
        return false;
    s->stretch[s->stretches++] = at;
    return true;
}

/* Adds where the edge, from a along `way`, meets an edge from b to c in a plane across `normal`. Where that is lost in
 * rounding, as the edges are nearly parallel, it is near one of the ends of the other edge: these are added as well. A
 * place too many only divides a stretch. */
static bool add_meeting(search *s, tl_vec3 a, tl_vec3 way, tl_vec3 b, tl_vec3 c, tl_vec3 normal)
{
    const tl_vec3 from = tl_v3_sub(b, a), across = tl_v3_cross(normal, tl_v3_sub(c, b));
    const double down = tl_v3_dot(way, across), length2 = tl_v3_dot(way, way);
    return add_place(s, tl_v3_dot(from, way) / length2) && add_place(s, tl_v3_dot(tl_v3_sub(c, a), way) / length2) &&
           (fabs(down) == 0 || add_place(s, tl_v3_dot(from, across) / down));
}

static int by_value(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Whether the edge, which lies in the plane of a face, runs inside it for a stretch; that is put into `at`. */
static bool runs_inside(search *s, uint32_t face)
{
    const tl_solid_mesh *m = s->m;
    const tl_vec3 a = m->vertex[m->half[s->edge].from], way = tl_v3_sub(m->vertex[tl_half_to(m, s->edge)], a);
    const tl_vec3 normal = tl_solid_normal(m, face);
    const double length = tl_v3_norm(way);
    s->stretches = 0;
    s->lost = !add_place(s, 0);
    TL_EACH_HALF(m, face, h, first)
    s->lost = s->lost || !add_meeting(s, a, way, m->vertex[m->half[h].from], m->vertex[tl_half_to(m, h)], normal);
    if (s->lost)
        return false;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->stretches; i++)
        if (s->stretch[i] >= 0 && s->stretch[i] <= 1)
            s->stretch[kept++] = s->stretch[i];
    qsort(s->stretch, kept, sizeof *s->stretch, by_value);
    for (uint32_t i = 0; i < kept; i++) {
        const double to = i + 1 < kept ? s->stretch[i + 1] : 1;
        if ((to - s->stretch[i]) * length <= 4 * m->on)
            continue;
        s->at = tl_v3_madd(a, 0.5 * (s->stretch[i] + to), way);
        if (tl_solid_in_face(m, face, s->at) > 0)
            return true;
    }
    return false;
}

/* The side of a plane on which the face of a half-edge lies next to it: 0 along the plane, looking the same way; 2
 * looking the other way. */
static int side_of(const tl_solid_mesh *m, uint32_t h, tl_vec3 up)
{
    const tl_vec3 normal = tl_solid_normal(m, m->half[h].face);
    const tl_vec3 along = tl_v3_unit(tl_v3_sub(m->vertex[tl_half_to(m, h)], m->vertex[m->half[h].from]));
    const double rise = tl_v3_dot(tl_v3_cross(normal, along), up);
    if (fabs(rise) * m->face[m->half[h].face].radius > m->on)
        return rise > 0 ? 1 : -1;
    return tl_v3_dot(normal, up) > 0 ? 0 : 2;
}

static bool crosses_along(search *s, uint32_t face)
{
    const tl_solid_mesh *m = s->m;
    const tl_vec3 up = tl_solid_normal(m, face);
    const int a = side_of(m, s->edge, up), b = side_of(m, m->half[s->edge].mate, up);
    return (a == 0 || b == 0 || a * b == -1) && runs_inside(s, face);
}

static void try_face(void *user, uint32_t face)
{
    search *s = user;
    const tl_solid_mesh *m = s->m;
    const uint32_t mate = m->half[s->edge].mate;
    if (s->found || s->lost)
        return;
    const tl_plane p = m->plane[m->face[face].plane];
    const tl_vec3 a = m->vertex[m->half[s->edge].from], b = m->vertex[tl_half_to(m, s->edge)];
    const double ha = tl_v3_dot(p.normal, a) - p.offset, hb = tl_v3_dot(p.normal, b) - p.offset;
    if (fabs(ha) <= m->on && fabs(hb) <= m->on)
        s->found = m->half[s->edge].face != face && m->half[mate].face != face && crosses_along(s, face);
    else if ((ha > m->on && hb < -m->on) || (ha < -m->on && hb > m->on)) {
        s->at = tl_v3_madd(a, ha / (ha - hb), tl_v3_sub(b, a));
        s->found = tl_solid_in_face(m, face, s->at) > 0;
    }
    s->face = face;
}

static tl_bounds bounds_of(const tl_solid_mesh *m, uint32_t h, bool loop)
{
    tl_bounds b = {m->vertex[m->half[h].from], m->vertex[m->half[h].from]};
    uint32_t k = m->half[h].next;
    do {
        b.min = tl_v3_min(b.min, m->vertex[m->half[k].from]);
        b.max = tl_v3_max(b.max, m->vertex[m->half[k].from]);
        k = m->half[k].next;
    } while (loop && k != h);
    return b;
}

tl_status tl_solid_check_crossing(const tl_solid_mesh *m, tl_error *error)
{
    tl_bounds *bounds = malloc(((size_t)m->faces + 1) * sizeof *bounds);
    tl_box_tree tree;
    if (!bounds)
        return tl_fail_memory(error);
    for (uint32_t f = 0; f < m->faces; f++)
        bounds[f] = bounds_of(m, m->face[f].first, true);
    if (!tl_box_tree_make(&tree, bounds, m->faces)) {
        free(bounds);
        return tl_fail_memory(error);
    }
    search s = {.m = m};
    for (uint32_t h = 0; h < m->halves && !s.found && !s.lost; h++) {
        if (m->half[h].face == TL_SOLID_NONE || h > m->half[h].mate)
            continue;
        const tl_bounds edge = bounds_of(m, h, false);
        s.edge = h;
        tl_box_tree_meet(&tree, &edge, try_face, &s);
        if (s.found)
            break;
    }
    tl_box_tree_free(&tree);
    free(bounds);
    free(s.stretch);
    if (s.lost)
        return tl_fail_memory(error);
    if (!s.found)
        return TL_OK;
    const tl_vec3 a = tl_solid_shown(m, m->half[s.edge].from), b = tl_solid_shown(m, tl_half_to(m, s.edge));
    const tl_vec3 at = tl_v3_add(m->place, s.at);
    return tl_fail(
        error, TL_E_GEOMETRY,
        "the surface crosses itself at {%g, %g, %g}: the edge from {%g, %g, %g} to {%g, %g, %g} goes through "
        "another face",
        at.x, at.y, at.z, a.x, a.y, a.z, b.x, b.y, b.z);
}
