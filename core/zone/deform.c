/* deform.c - rigid blocks become deformable: their zones are made, and laid into the tables.
 *
 * All blocks are divided before any is changed. Then each gets its mesh, in the order of the rows. */
#include "base/columns.h"
#include "geometry/zone_clusters.h"
#include "geometry/zoning.h"
#include "model/rows.h"
#include "zone/corner_keys.h"
#include "zone/grid.h"
#include "zone/solids.h"
#include "zone/stiffness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

/* The zones of one block on their way. */
typedef struct part {
    uint32_t row; /* of the block */
    tl_zone_mesh mesh;
    tl_zone_clusters clusters;
    tl_surface_part *surface;
} part;

/* One call. */
typedef struct dividing {
    tl_model *m;
    const tl_zoning *how;
    part *part; /* ascending rows */
    size_t count;
    uint32_t body; /* of the block that is being divided */
    tl_corner_keys keys;
    tl_zone_scratch *scratch;
} dividing;

/* ---------------------------------------------------------------- checks ----------------- */

static tl_status refuse(tl_model *m, tl_id block, const char *why)
{
    return tl_fail(&m->error, TL_E_STATE, "block %u cannot get zones: %s", block, why);
}

static tl_status check_block(tl_model *m, uint32_t row)
{
    const tl_bodies *b = &m->bodies;
    const uint32_t body = m->blocks.body[row];
    const tl_id block = m->blocks.id[row];
    if (b->mesh[body])
        return refuse(m, block, "it has zones already");
    if (b->member_count[body] > 1)
        return refuse(m, block, "it is joined to others; bodies of one block can be divided");
    if (b->drive[body])
        return refuse(m, block, "it is driven; drive gridpoints instead");
    if (tl_body_loaded(b, body))
        return refuse(m, block, "it carries a load; load gridpoints instead");
    return TL_OK;
}

static int by_row(const void *a, const void *b)
{
    const part *x = a, *y = b;
    return x->row < y->row ? -1 : x->row > y->row;
}

/* Lists the blocks, each once. */
static tl_status list_blocks(dividing *d, const tl_id *blocks, size_t count)
{
    d->part = calloc(count + 1, sizeof *d->part);
    if (!d->part)
        return tl_fail_memory(&d->m->error);
    for (size_t k = 0; k < count; k++) {
        const uint32_t row = tl_block_row(d->m, blocks[k]);
        if (row == TL_NO_ROW)
            return d->m->error.status;
        const tl_status status = check_block(d->m, row);
        if (status != TL_OK)
            return status;
        d->part[k].row = row;
    }
    if (count > 0)
        qsort(d->part, count, sizeof *d->part, by_row);
    for (size_t k = 0; k < count; k++)
        if (d->count == 0 || d->part[d->count - 1].row != d->part[k].row)
            d->part[d->count++].row = d->part[k].row;
    return TL_OK;
}

static tl_status check_all(dividing *d, const tl_id *blocks, size_t count, uint32_t *solid)
{
    tl_model *m = d->m;
    tl_status status = tl_model_may_change(m, "give blocks zones");
    if (status == TL_OK)
        tl_rows_tidy(m);
    if (status == TL_OK && !d->how->edge_at && !(d->how->edge > 0))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "the edge of zones must be > 0 m (it is %g)", d->how->edge);
    *solid = status == TL_OK && m->zones && d->how->solid ? tl_solid_find(m, d->how->solid) : TL_NO_ROW;
    if (status == TL_OK && *solid == TL_NO_ROW)
        status = tl_fail(&m->error, TL_E_ARGUMENT, "there is no solid '%s': name one with %s first",
                         d->how->solid ? d->how->solid : "", tl_words(m, "model:solid", "tl_model_solid"));
    return status == TL_OK ? list_blocks(d, blocks, count) : status;
}

/* ---------------------------------------------------------------- zones of a block ------- */

/* The wanted edge at a place of the block that is being divided. */
static double edge_at(const void *user, tl_vec3 local)
{
    const dividing *d = user;
    return d->how->edge_at(d->how->user, tl_model_point(d->m, d->body, local));
}

/* Lists of the free sides of zones by their lowest points: side `4 zone + corner` lies opposite the corner. */
typedef struct free_sides {
    uint32_t *start, *side;
} free_sides;

static uint32_t lowest_of(const tl_zone_mesh *mesh, uint32_t side)
{
    uint32_t lowest = UINT32_MAX;
    for (uint32_t a = 0; a < 4; a++)
        if (a != side % 4 && mesh->zone[side / 4][a] < lowest)
            lowest = mesh->zone[side / 4][a];
    return lowest;
}

static bool list_free_sides(const tl_zone_mesh *mesh, free_sides *sides)
{
    sides->start = calloc((size_t)mesh->point_count + 2, sizeof *sides->start);
    sides->side = malloc(((size_t)mesh->triangle_count + 1) * sizeof *sides->side);
    if (!sides->start || !sides->side)
        return false;
    for (uint32_t s = 0; s < 4 * mesh->zone_count; s++)
        if (mesh->beside[s / 4][s % 4] == UINT32_MAX)
            sides->start[lowest_of(mesh, s) + 2]++;
    for (uint32_t p = 0; p < mesh->point_count; p++)
        sides->start[p + 2] += sides->start[p + 1];
    for (uint32_t s = 0; s < 4 * mesh->zone_count; s++)
        if (mesh->beside[s / 4][s % 4] == UINT32_MAX)
            sides->side[sides->start[lowest_of(mesh, s) + 1]++] = s;
    return true;
}

/* Whether a side of a zone has the corners of a triangle. */
static bool is_side(const tl_zone_mesh *mesh, uint32_t side, const uint32_t corner[3])
{
    int shared = 0;
    for (uint32_t a = 0; a < 4; a++)
        for (int k = 0; a != side % 4 && k < 3; k++)
            shared += mesh->zone[side / 4][a] == corner[k];
    return shared == 3;
}

/* The point of a triangle's zone that is no corner of it. */
static uint32_t apex_of(const tl_zone_mesh *mesh, const free_sides *sides, const uint32_t corner[3])
{
    uint32_t lowest = corner[0];
    for (int k = 1; k < 3; k++)
        if (corner[k] < lowest)
            lowest = corner[k];
    for (uint32_t k = sides->start[lowest]; k < sides->start[lowest + 1]; k++)
        if (is_side(mesh, sides->side[k], corner))
            return mesh->zone[sides->side[k] / 4][sides->side[k] % 4];
    return UINT32_MAX;
}

static tl_status list_surface(dividing *d, part *of)
{
    const tl_zone_mesh *mesh = &of->mesh;
    const tl_id block = d->m->blocks.id[of->row];
    free_sides sides;
    of->surface = malloc(((size_t)mesh->triangle_count + 1) * sizeof *of->surface);
    const bool enough = list_free_sides(mesh, &sides) && of->surface;
    bool whole = true;
    for (uint32_t t = 0; enough && t < mesh->triangle_count; t++) {
        const tl_zone_triangle *from = &mesh->triangle[t];
        tl_surface_part *to = &of->surface[t];
        *to = (tl_surface_part){.face = from->face, .block = block};
        memcpy(to->corner, from->corner, sizeof to->corner);
        to->apex = apex_of(mesh, &sides, from->corner);
        whole = whole && to->apex != UINT32_MAX;
    }
    free(sides.start);
    free(sides.side);
    if (enough && !whole)
        return tl_fail(&d->m->error, TL_E_GEOMETRY, "block %u: its zones do not end at its faces", block);
    return enough ? TL_OK : tl_fail_memory(&d->m->error);
}

/* Places of points from the model's origin instead of those of the block. */
static void place_points(const dividing *d, part *of)
{
    for (uint32_t p = 0; p < of->mesh.point_count; p++)
        of->mesh.point[p] = tl_body_point(&d->m->bodies, d->body, of->mesh.point[p]);
}

static tl_status divide_block(dividing *d, part *of)
{
    tl_model *m = d->m;
    const tl_shape_zoning zoning = {.edge = d->how->edge,
                                    .size = d->how->edge_at ? edge_at : NULL,
                                    .user = d,
                                    .corner_key = d->keys.of + d->keys.start[of->row]};
    d->body = m->blocks.body[of->row];
    tl_status status = tl_zoning_make(m->blocks.shape[of->row], &zoning, d->scratch, &of->mesh, &m->error);
    if (status == TL_OK)
        status = tl_zone_clusters_make((const uint32_t(*)[4])of->mesh.zone, (const uint32_t(*)[4])of->mesh.beside,
                                       of->mesh.zone_count, &of->clusters, &m->error);
    if (status != TL_OK)
        return tl_error_prefix(&m->error, "block %u: ", m->blocks.id[of->row]);
    status = list_surface(d, of);
    place_points(d, of);
    return status;
}

/* ---------------------------------------------------------------- laying ----------------- */

/* Gridpoints move and are held as their block was, whose own motion ends. */
static void take_over_motion(tl_model *m, const tl_body_mesh *mesh, uint8_t fixed)
{
    tl_gridpoints *p = &m->zones->points;
    tl_bodies *b = &m->bodies;
    const tl_vec3 at = tl_body_place(b, mesh->row), v = b->v[mesh->row], w = b->w[mesh->row];
    const uint8_t held = fixed & (TL_FIX_X | TL_FIX_Y | TL_FIX_Z);
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), at);
        const tl_vec3 velocity = tl_v3_add(v, tl_v3_cross(w, arm));
        tl_columns_put(p->v, row, velocity);
        tl_columns_put(p->moved, row, velocity);
        p->fixed[row] = held;
    }
    b->v[mesh->row] = b->w[mesh->row] = tl_v3(0, 0, 0);
    tl_block_changes(m, *tl_body_blocks(m, mesh->row));
}

static tl_status lay(dividing *d, const part *of, uint32_t solid)
{
    tl_model *m = d->m;
    const tl_grid grid = {.point = of->mesh.point,
                          .point_count = of->mesh.point_count,
                          .zone = (const uint32_t(*)[4])of->mesh.zone,
                          .zone_count = of->mesh.zone_count,
                          .cluster_start = of->clusters.start,
                          .cluster_zone = of->clusters.zone,
                          .cluster_count = of->clusters.count,
                          .density = m->blocks.density[of->row],
                          .part = of->surface,
                          .part_count = of->mesh.triangle_count};
    return tl_zones_add(m, m->bodies.id[m->blocks.body[of->row]], &grid, solid);
}

/* Lays all meshes; takes them back when memory does not suffice. */
static tl_status lay_all(dividing *d, uint32_t solid)
{
    tl_model *m = d->m;
    const uint32_t meshes = (uint32_t)m->zones->mesh_count;
    uint8_t *fixed = malloc(d->count + 1);
    tl_status status = fixed ? TL_OK : tl_fail_memory(&m->error);
    for (size_t k = 0; status == TL_OK && k < d->count; k++) {
        fixed[k] = m->bodies.fixed[m->blocks.body[d->part[k].row]];
        status = lay(d, &d->part[k], solid);
    }
    for (uint32_t k = meshes; k < m->zones->mesh_count; k++)
        if (status == TL_OK)
            take_over_motion(m, &m->zones->mesh[k], fixed[k - meshes]);
        else
            m->bodies.fixed[m->zones->mesh[k].row] = fixed[k - meshes];
    if (status != TL_OK)
        tl_zones_end_at(m, meshes);
    else
        m->structure++;
    free(fixed);
    return status;
}

/* The trace of the inertia of a body's gridpoints about its centroid, over that of the body. */
static double inertia_ratio(const tl_model *m, const tl_body_mesh *mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 at = tl_body_place(&m->bodies, mesh->row), own = m->bodies.moments[mesh->row];
    double sum = 0;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        sum += 2 * p->mass[row] * tl_v3_norm2(tl_v3_sub(tl_gridpoint_place(p, row), at));
    return sum / (own.x + own.y + own.z);
}

/* The step that the gridpoints of meshes allow, free as they are: 2 / sqrt(k / m) of the stiffest. */
static double step_of(tl_model *m, size_t from)
{
    const tl_gridpoints *p = &m->zones->points;
    double most = 0;
    tl_zones_stiffen(m);
    for (uint32_t row = m->zones->mesh[from].point_begin; row < p->table.rows; row++)
        if (p->zones[row] > 0)
            most = fmax(most, p->stiffness[row] / p->mass[row]);
    m->zones->rated_for = 0; /* what segments hold gridpoints by is not in it */
    return most > 0 ? 2 / sqrt(most) : 0;
}

static void report(const dividing *d, tl_zoned *made)
{
    tl_model *m = d->m;
    *made = (tl_zoned){.blocks = d->count, .least_altitude = INFINITY, .least_share = INFINITY};
    const size_t from = m->zones->mesh_count - d->count;
    for (size_t k = from; k < m->zones->mesh_count; k++)
        made->inertia = fmax(made->inertia, inertia_ratio(m, &m->zones->mesh[k]));
    made->time_step = d->count > 0 ? step_of(m, from) : 0;
    for (size_t k = 0; k < d->count; k++) {
        const part *of = &d->part[k];
        made->zones += of->mesh.zone_count;
        made->gridpoints += of->mesh.point_count;
        made->clusters += of->clusters.count;
        made->least_altitude = fmin(made->least_altitude, of->mesh.least_altitude);
        if (of->mesh.least_share < made->least_share) {
            made->least_share = of->mesh.least_share;
            made->worst = m->blocks.id[of->row];
        }
    }
}

static void end(dividing *d)
{
    for (size_t k = 0; k < d->count; k++) {
        tl_zone_mesh_free(&d->part[k].mesh);
        tl_zone_clusters_free(&d->part[k].clusters);
        free(d->part[k].surface);
    }
    free(d->part);
    tl_corner_keys_free(&d->keys);
    tl_zone_scratch_free(d->scratch);
}

tl_zoning tl_zoning_default(void)
{
    return (tl_zoning){.size = sizeof(tl_zoning), .edge = NAN};
}

tl_status tl_blocks_deform(tl_model *m, const tl_id *blocks, size_t count, const tl_zoning *how, tl_zoned *made)
{
    dividing d = {.m = m, .how = how};
    uint32_t solid = TL_NO_ROW;
    tl_status status = check_all(&d, blocks, count, &solid);
    if (status == TL_OK) {
        d.scratch = tl_zone_scratch_create();
        if (!d.scratch || !tl_corner_keys_make(m, &d.keys))
            status = tl_fail_memory(&m->error);
    }
    for (size_t k = 0; status == TL_OK && k < d.count; k++) {
        status = tl_model_go_on(m);
        if (status == TL_OK)
            status = divide_block(&d, &d.part[k]);
    }
    if (status == TL_OK)
        status = lay_all(&d, solid);
    if (status == TL_OK)
        report(&d, made);
    end(&d);
    return status;
}
