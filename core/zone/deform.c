/* deform.c - rigid bodies become deformable: the zones of their blocks are made, and laid into the tables.
 *
 * All bodies are divided before any is changed. Then each gets its mesh, in the order of their first blocks. */
#include "base/columns.h"
#include "geometry/measure.h"
#include "geometry/zoning.h"
#include "model/deformable.h"
#include "model/loads.h"
#include "model/rows.h"
#include "model/seats.h"
#include "zone/body_zones.h"
#include "zone/columns.h"
#include "zone/corner_keys.h"
#include "zone/fit.h"
#include "zone/solids.h"
#include "zone/stiffness.h"

#include <math.h>
#include <stdlib.h>
#include <talus/zones.h>

/* Tolerance: distance over the block's size up to which a loaded point outside counts as one of the surface. */
#define TOUCHES 1e-6
/* Limit: zones that a block may be expected to get: half of what Delaunay has numbers for. */
#define MOST_ZONES 5e8
/* Tolerance: zones of a call from which a remark tells what they take. Making them takes a minute and more. */
#define MANY_ZONES 5e6
/* Constant: bytes that a zone and its share of gridpoints take in a model, without segments. */
#define BYTES_OF_ZONE 250

/* A body on its way. */
typedef struct part {
    uint32_t body; /* its row */
    tl_body_zones zones;
} part;

/* One call. */
typedef struct dividing {
    tl_model *m;
    const tl_zoning *how;
    unsigned char *chosen; /* [rows of blocks] */
    size_t blocks;
    part *part; /* in the order of their first blocks */
    size_t count;
    uint32_t body; /* that is being divided */
    tl_corner_keys keys;
    tl_zone_scratch *scratch;
    tl_fitted fitted; /* meshes of a file */
} dividing;

/* ---------------------------------------------------------------- checks ----------------- */

static tl_status refuse(tl_model *m, tl_id block, const char *why)
{
    return tl_fail(&m->error, TL_E_STATE, "block %u cannot get zones: %s", block, why);
}

/* Whether a place, in a body's frame, lies in one of its blocks. */
static bool lies_in(const tl_model *m, uint32_t body, tl_vec3 at)
{
    bool some = false;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const uint32_t row = tl_body_blocks(m, body)[k];
        const tl_poly *shape = m->blocks.shape[row];
        bool inside = true;
        for (uint32_t f = 0; f < shape->face_count; f++)
            inside = inside &&
                     tl_v3_dot(shape->plane[f].normal, at) <= shape->plane[f].offset + TOUCHES * m->blocks.size[row];
        some = some || inside;
    }
    return some;
}

/* A load goes over to the zone at its point, or without one to all gridpoints by mass. */
static tl_status check_load(tl_model *m, uint32_t row)
{
    const tl_id block = m->blocks.id[row];
    const tl_vec3 at = m->bodies.load[m->blocks.body[row]].arm;
    for (size_t k = 0; k < m->face_load_count; k++)
        if (m->face_loads[k].block == block)
            return refuse(m, block, "its faces are loaded; take the load off, and put it on when it has zones");
    if (!lies_in(m, m->blocks.body[row], at))
        return refuse(m, block, "it carries a load at a point outside of it; take that off");
    return TL_OK;
}

static tl_status check_block(tl_model *m, uint32_t row)
{
    const tl_bodies *b = &m->bodies;
    const uint32_t body = m->blocks.body[row];
    const tl_id block = m->blocks.id[row];
    if (b->mesh[body])
        return refuse(m, block, "it has zones already");
    if (tl_block_is_seated(m, block))
        return refuse(m, block, "it is seated on a neighbour, and only rigid blocks are; draw it so that it fits");
    return tl_body_loaded(b, body) ? check_load(m, row) : TL_OK;
}

/* A body comes whole: all blocks that are joined to a chosen one are chosen. */
static tl_status check_whole(const dividing *d, uint32_t row)
{
    tl_model *m = d->m;
    const uint32_t body = m->blocks.body[row], *rows = tl_body_blocks(m, body);
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
        if (!d->chosen[rows[k]])
            return tl_fail(
                &m->error, TL_E_STATE,
                "block %u cannot get zones: it is joined to block %u, which is not among the blocks given; give "
                "all blocks of a body, or unjoin them",
                m->blocks.id[row], m->blocks.id[rows[k]]);
    return TL_OK;
}

/* Lists the bodies of the blocks, each once. */
static tl_status list_bodies(dividing *d, const tl_id *blocks, size_t count)
{
    tl_model *m = d->m;
    d->part = calloc(count + 1, sizeof *d->part);
    d->chosen = calloc(m->blocks.table.rows + 1, 1);
    if (!d->part || !d->chosen)
        return tl_fail_memory(&m->error);
    for (size_t k = 0; k < count; k++) {
        const uint32_t row = tl_block_row(m, blocks[k]);
        if (row == TL_NO_ROW)
            return m->error.status;
        const tl_status status = check_block(m, row);
        if (status != TL_OK)
            return status;
        d->chosen[row] = 1;
    }
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        if (!d->chosen[row])
            continue;
        const tl_status status = check_whole(d, row);
        if (status != TL_OK)
            return status;
        d->blocks++;
        if (*tl_body_blocks(m, m->blocks.body[row]) == row)
            d->part[d->count++].body = m->blocks.body[row];
    }
    return TL_OK;
}

/* Zones of one size: how many a block gets follows from its volume and surface. */
static tl_status check_count(const dividing *d)
{
    tl_model *m = d->m;
    const double edge = d->how->edge;
    double all = 0;
    for (uint32_t row = 0; !d->how->edge_at && !d->how->file && row < m->blocks.table.rows; row++) {
        const tl_poly *shape = m->blocks.shape[row];
        double surface = 0;
        if (!d->chosen[row])
            continue;
        for (uint32_t f = 0; f < shape->face_count; f++)
            surface += tl_poly_face_area(shape, f);
        const double zones = tl_zoning_expected(m->blocks.volume[row], surface, edge);
        if (zones > MOST_ZONES)
            return tl_fail(&m->error, TL_E_ARGUMENT,
                           "block %u would get some %.2g zones with an edge of %g m, and can have %.2g: give larger "
                           "ones, or a function that makes them small only where they need be",
                           m->blocks.id[row], zones, edge, MOST_ZONES);
        all += zones;
    }
    if (all > MANY_ZONES)
        tl_model_say(m, "an edge of %g m makes some %.2g zones, which take some %.2g GB and long steps", edge, all,
                     1e-9 * BYTES_OF_ZONE * all);
    return TL_OK;
}

static tl_status check_all(dividing *d, const tl_id *blocks, size_t count, uint32_t *solid)
{
    tl_model *m = d->m;
    tl_status status = tl_model_may_change(m, "give blocks zones");
    if (status == TL_OK)
        tl_rows_tidy(m);
    if (status == TL_OK && d->how->file && (d->how->edge_at || !isnan(d->how->edge)))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "give the edge of zones or a file of them, not both");
    if (status == TL_OK && !d->how->file && !d->how->edge_at && !(d->how->edge > 0))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "the edge of zones must be > 0 m (it is %g)", d->how->edge);
    if (status == TL_OK && !d->how->solid)
        status = tl_fail(&m->error, TL_E_ARGUMENT, "no solid is given for the zones: give one that was named with %s",
                         tl_words(m, "model:solid", "tl_model_solid"));
    *solid = status == TL_OK && m->zones ? tl_solid_find(m, d->how->solid) : TL_NO_ROW;
    if (status == TL_OK && *solid == TL_NO_ROW)
        status = tl_solid_missing(m, d->how->solid);
    if (status == TL_OK)
        status = list_bodies(d, blocks, count);
    return status == TL_OK ? check_count(d) : status;
}

/* ---------------------------------------------------------------- zones of a body -------- */

/* The wanted edge at a place of the body that is being divided. */
static double edge_at(const void *user, tl_vec3 local)
{
    const dividing *d = user;
    return d->how->edge_at(d->how->user, tl_model_point(d->m, d->body, local));
}

static tl_status divide_body(dividing *d, part *of)
{
    const tl_shape_zoning zoning = {.edge = d->how->edge, .size = d->how->edge_at ? edge_at : NULL, .user = d};
    d->body = of->body;
    const tl_status status = d->how->file
                                 ? tl_body_zones_take(d->m, of->body, d->fitted.mesh, &of->zones)
                                 : tl_body_zones_make(d->m, of->body, &zoning, &d->keys, d->scratch, &of->zones);
    for (uint32_t p = 0; status == TL_OK && p < of->zones.point_count; p++) /* from the model's origin from now on */
        of->zones.point[p] = tl_body_point(&d->m->bodies, of->body, of->zones.point[p]);
    return status;
}

/* ---------------------------------------------------------------- laying ----------------- */

/* The load of a block acts on its gridpoints, and no longer on the block. */
static void take_over_load(tl_model *m, uint32_t body)
{
    if (!tl_body_loaded(&m->bodies, body))
        return;
    const tl_body_load had = m->bodies.load[body];
    tl_load load = tl_load_default();
    load.force = had.force;
    load.moment = had.moment;
    if (!tl_v3_is_zero(had.arm))
        load.at = tl_model_point(m, body, had.arm);
    m->bodies.load[body] = (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    tl_load_begins_anew(m, body);
    m->zone_verbs->load(m, body, &load);
}

/* Gridpoints move and are held as their body was, whose own motion ends. */
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
    take_over_load(m, mesh->row);
    for (uint32_t k = 0; k < b->member_count[mesh->row]; k++)
        tl_block_changes(m, tl_body_blocks(m, mesh->row)[k]);
}

static tl_status lay(dividing *d, const part *of, uint32_t solid)
{
    tl_model *m = d->m;
    const tl_body_zones *z = &of->zones;
    const tl_grid grid = {.point = z->point,
                          .point_count = z->point_count,
                          .zone = (const uint32_t(*)[4])z->zone,
                          .zone_count = z->zone_count,
                          .cluster_start = z->cluster_start,
                          .cluster_zone = z->cluster_zone,
                          .cluster_count = z->cluster_count,
                          .block = z->block,
                          .block_count = z->block_count,
                          .part = z->surface,
                          .part_count = z->surface_count};
    return tl_zones_add(m, m->bodies.id[of->body], &grid, solid);
}

/* Lays all meshes; takes them back when memory does not suffice. */
static tl_status lay_all(dividing *d, uint32_t solid)
{
    tl_model *m = d->m;
    const uint32_t meshes = (uint32_t)m->zones->mesh_count;
    uint8_t *fixed = malloc(d->count + 1);
    bool loaded = false;
    for (size_t k = 0; k < d->count; k++)
        loaded = loaded || tl_body_loaded(&m->bodies, d->part[k].body);
    const bool enough = fixed && (!loaded || tl_gridpoints_hold_loads(&m->zones->points));
    tl_status status = enough ? TL_OK : tl_fail_memory(&m->error);
    for (size_t k = 0; status == TL_OK && k < d->count; k++) {
        fixed[k] = m->bodies.fixed[d->part[k].body];
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
    tl_zones_trim(m->zones);
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
    *made = (tl_zoned){.blocks = d->blocks, .least_altitude = INFINITY, .least_share = INFINITY};
    const size_t from = m->zones->mesh_count - d->count;
    for (size_t k = from; k < m->zones->mesh_count; k++)
        made->inertia = fmax(made->inertia, inertia_ratio(m, &m->zones->mesh[k]));
    made->time_step = d->count > 0 ? step_of(m, from) : 0;
    for (size_t k = 0; k < d->count; k++) {
        const tl_body_zones *of = &d->part[k].zones;
        made->zones += of->zone_count;
        made->gridpoints += of->point_count;
        made->clusters += of->cluster_count;
        made->least_altitude = fmin(made->least_altitude, of->least_altitude);
        if (of->least_share < made->least_share) {
            made->least_share = of->least_share;
            made->worst = of->worst;
        }
    }
}

static void end(dividing *d)
{
    for (size_t k = 0; k < d->count; k++)
        tl_body_zones_free(&d->part[k].zones);
    free(d->part);
    free(d->chosen);
    tl_corner_keys_free(&d->keys);
    tl_zone_scratch_free(d->scratch);
    tl_fit_free(&d->fitted);
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
    if (status == TL_OK && how->file) {
        status = tl_fit_make(m, how->file, d.chosen, &d.fitted);
    } else if (status == TL_OK) {
        d.scratch = tl_zone_scratch_create();
        if (!d.scratch || !tl_corner_keys_make(m, &d.keys))
            status = tl_fail_memory(&m->error);
    }
    for (size_t k = 0; status == TL_OK && k < d.count; k++) {
        status = tl_model_go_on(m);
        if (status == TL_OK)
            status = divide_body(&d, &d.part[k]);
    }
    if (status == TL_OK)
        status = lay_all(&d, solid);
    if (status == TL_OK)
        report(&d, made);
    end(&d);
    return status;
}
