/* parts.c - the convex solids that a mesh fills.
 *
 * Tetrahedra of one region that hang together over their sides are a part. A point of its surface is a corner where
 * sides of three directions meet: others lie on faces and edges. The part is convex when the hull of its corners holds
 * what its tetrahedra hold. */
#include "mesh/parts.h"

#include "base/table.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "mesh/pair.h"
#include "mesh/read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Tolerance: sine of the angle by which sides of one face may differ in direction: roundings of coordinates in files,
 * which have six digits and more. A corner flatter than that makes no difference of FILLED. */
#define SAME_DIRECTION 1e-6
/* Tolerance: a part fills the hull of its corners within this share. Blocks must be filled as well (zone/fit.c). */
#define FILLED 1e-6

/* The directions of sides that meet at a point: so many of them differ. */
typedef struct meeting {
    tl_vec3 normal[2];
    uint32_t count;
} meeting;

typedef struct finding {
    tl_mesh_parts *to;
    const tl_mesh *m;
    tl_error *error;
    uint32_t *on;           /* [sides] */
    uint32_t *part, *start; /* [zones]; [parts + 1] into order */
    uint32_t *order;        /* zones, part by part */
    uint32_t parts;
    meeting *at; /* [points] */
} finding;

static bool hold(finding *f)
{
    const size_t zones = f->m->zone_count;
    f->on = malloc((4 * zones + 1) * sizeof *f->on);
    f->part = malloc((zones + 1) * sizeof *f->part);
    f->order = malloc((zones + 1) * sizeof *f->order);
    f->start = calloc(zones + 2, sizeof *f->start);
    f->at = calloc((size_t)f->m->point_count + 1, sizeof *f->at);
    return f->on && f->part && f->order && f->start && f->at;
}

/* Numbers parts in the order of their first tetrahedra. */
static void number_parts(finding *f)
{
    uint32_t end = 0;
    for (uint32_t z = 0; z < f->m->zone_count; z++)
        f->part[z] = TL_MESH_NONE;
    for (uint32_t first = 0; first < f->m->zone_count; first++) {
        if (f->part[first] != TL_MESH_NONE)
            continue;
        f->part[first] = f->parts;
        f->order[end++] = first;
        for (uint32_t k = end - 1; k < end; k++)
            for (uint32_t a = 0; a < 4; a++) {
                const uint32_t side = f->on[4 * f->order[k] + a];
                if (side == TL_MESH_NONE || f->part[side / 4] != TL_MESH_NONE)
                    continue;
                f->part[side / 4] = f->parts;
                f->order[end++] = side / 4;
            }
        f->start[++f->parts] = end;
    }
}

static bool is_along(tl_vec3 a, tl_vec3 b)
{
    return tl_v3_dot(a, b) > 0 && tl_v3_norm2(tl_v3_cross(a, b)) <= SAME_DIRECTION * SAME_DIRECTION;
}

static void note_side(finding *f, uint32_t side)
{
    uint32_t v[3];
    tl_mesh_side_corners(f->m, side, v);
    const tl_vec3 *x = f->m->point;
    const tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(x[v[1]], x[v[0]]), tl_v3_sub(x[v[2]], x[v[0]])));
    for (int k = 0; k < 3; k++) {
        meeting *at = &f->at[v[k]];
        bool known = at->count > 2;
        for (uint32_t i = 0; i < at->count && !known; i++)
            known = is_along(at->normal[i], n);
        if (known)
            continue;
        if (at->count < 2)
            at->normal[at->count] = n;
        at->count++;
    }
}

/* Adds the corners of a part to the list, and forgets what met at its points. */
static tl_status take_corners(finding *f, uint32_t part)
{
    tl_mesh_parts *to = f->to;
    const size_t before = to->corner_count;
    for (uint32_t k = f->start[part]; k < f->start[part + 1]; k++)
        for (int a = 0; a < 4; a++) {
            const uint32_t p = f->m->zone[f->order[k]][a];
            const uint32_t met = f->at[p].count;
            f->at[p].count = 0;
            if (met < 3)
                continue;
            if (!tl_grow(&to->corner, &to->corner_room, to->corner_count + 1, sizeof *to->corner))
                return tl_fail_memory(f->error);
            to->corner[to->corner_count++] = f->m->point[p];
        }
    if (to->corner_count - before <= TL_POLY_MAX_VERTICES)
        return TL_OK;
    char where[TL_MESH_WHERE];
    return tl_fail(f->error, TL_E_GEOMETRY,
                   "%s: its region has %zu corners, for its faces are not flat; a block can have %d at the most",
                   tl_mesh_where(f->m, f->order[f->start[part]], where), to->corner_count - before,
                   TL_POLY_MAX_VERTICES);
}

/* Whether the part fills the hull of its corners, which take the place of those that were found. */
static tl_status check_convex(finding *f, uint32_t part, size_t before, double volume)
{
    tl_mesh_parts *to = f->to;
    tl_poly *hull = NULL;
    char where[TL_MESH_WHERE];
    tl_mesh_where(f->m, f->order[f->start[part]], where);
    const tl_status status =
        tl_poly_hull(to->corner + before, to->corner_count - before, TL_HULL_OF_ANY, &hull, f->error);
    if (status != TL_OK)
        return tl_error_prefix(f->error, "%s: its region makes no block: ", where);
    const double held = tl_poly_mass(hull).volume;
    for (uint32_t v = 0; v < hull->vertex_count; v++)
        to->corner[before + v] = hull->vertex[v];
    to->corner_count = before + hull->vertex_count;
    tl_poly_free(hull);
    if (fabs(held - volume) <= FILLED * volume)
        return TL_OK;
    return tl_fail(f->error, TL_E_GEOMETRY,
                   "%s: its region is not convex, or has gaps: it holds %.9g m3, the hull of its corners %.9g m3; give "
                   "each convex part a region of its own",
                   where, volume, held);
}

static tl_status find_part(finding *f, uint32_t part)
{
    tl_mesh_parts *to = f->to;
    const size_t before = to->corner_count;
    const tl_mesh *m = f->m;
    double volume = 0;
    for (uint32_t k = f->start[part]; k < f->start[part + 1]; k++) {
        const uint32_t *v = m->zone[f->order[k]];
        volume += tl_tetrahedron_volume((tl_vec3[4]){m->point[v[0]], m->point[v[1]], m->point[v[2]], m->point[v[3]]});
        for (uint32_t a = 0; a < 4; a++)
            if (f->on[4 * f->order[k] + a] == TL_MESH_NONE)
                note_side(f, 4 * f->order[k] + a);
    }
    tl_status status = take_corners(f, part);
    if (status == TL_OK)
        status = check_convex(f, part, before, volume);
    if (status == TL_OK && !tl_grow(&to->list, &to->list_room, to->count + 1, sizeof *to->list))
        status = tl_fail_memory(f->error);
    if (status == TL_OK)
        to->list[to->count++] = (tl_mesh_part){.group = m->group[m->region[f->order[f->start[part]]]],
                                               .corner_count = to->corner_count - before,
                                               .volume = volume};
    return status;
}

tl_status tl_mesh_parts_read(const char *file, tl_mesh_parts *to, tl_error *error)
{
    *to = (tl_mesh_parts){0};
    finding f = {.to = to, .m = &to->mesh, .error = error};
    tl_status status = tl_mesh_read(file, &to->mesh, error);
    if (status == TL_OK && !hold(&f))
        status = tl_fail_memory(error);
    if (status == TL_OK)
        status = tl_mesh_pair(f.m, f.m->region, f.on, error);
    if (status == TL_OK)
        number_parts(&f);
    for (uint32_t k = 0; status == TL_OK && k < f.parts; k++)
        status = find_part(&f, k);
    size_t corner = 0;
    for (size_t k = 0; k < to->count; k++) {
        to->list[k].corners = to->corner + corner;
        corner += to->list[k].corner_count;
    }
    free(f.on);
    free(f.part);
    free(f.order);
    free(f.start);
    free(f.at);
    return status;
}

void tl_mesh_parts_free(tl_mesh_parts *parts)
{
    tl_mesh_free(&parts->mesh);
    free(parts->list);
    free(parts->corner);
    *parts = (tl_mesh_parts){0};
}
