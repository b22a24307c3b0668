/* fit.c - tetrahedra of a file become the zones of the blocks in which they lie.
 *
 * A tetrahedron belongs to the block in which its centroid lies the deepest. The zones of a block fill it when
 *
 *     no corner lies outside of it
 *     each side of a zone lies on a side of another, from the other side, or on a face
 *     they add up to its volume
 *
 * For then the surface of the zones covers that of the block as often everywhere, and once by the volume. */
#include "zone/fit.h"

#include "geometry/box_tree.h"
#include "geometry/measure.h"
#include "geometry/zone_points.h"
#include "geometry/zoning.h"
#include "mesh/pair.h"
#include "mesh/read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Tolerance: corners miss faces by less than this times the block's size, for files have coordinates of six digits and
 * more. What the block's own corners miss faces by is added. Zones add up to its volume within this share. */
#define ON_FACE 1e-6

#define NONE TL_MESH_NONE

typedef struct fitting {
    tl_model *m;
    tl_fitted *to;
    tl_mesh mesh;
    uint32_t *row; /* [blocks] rows of those that were chosen */
    uint32_t blocks;
    tl_bounds *box; /* [blocks] where they are, from the model's origin */
    tl_box_tree tree;
    uint32_t *owner;         /* [zones of the file] the block it belongs to */
    uint32_t *on;            /* [sides] */
    uint32_t *start, *order; /* [blocks + 1] into order: zones, block by block */
    uint32_t *place;         /* [zones] its place among those of its block */
    uint32_t *number;        /* [points] in the block that is being made; NONE: it has not got it yet */
    double *bend;            /* [faces of a block] by how much its corners miss it */
} fitting;

/* ---------------------------------------------------------------- who has what ----------- */

static bool hold(fitting *f, const unsigned char *chosen)
{
    const size_t rows = f->m->blocks.table.rows, zones = f->mesh.zone_count;
    f->row = malloc((rows + 1) * sizeof *f->row);
    f->box = malloc((rows + 1) * sizeof *f->box);
    f->owner = malloc((zones + 1) * sizeof *f->owner);
    f->on = malloc((4 * zones + 1) * sizeof *f->on);
    f->start = calloc(rows + 2, sizeof *f->start);
    f->order = malloc((zones + 1) * sizeof *f->order);
    f->place = malloc((zones + 1) * sizeof *f->place);
    f->number = malloc(((size_t)f->mesh.point_count + 1) * sizeof *f->number);
    f->bend = malloc(TL_POLY_MAX_FACES * sizeof *f->bend);
    f->to->mesh = calloc(rows + 1, sizeof *f->to->mesh);
    f->to->rows = rows;
    if (!f->row || !f->box || !f->owner || !f->on || !f->start || !f->order || !f->place || !f->number || !f->bend ||
        !f->to->mesh)
        return false;
    for (uint32_t row = 0; row < rows; row++)
        if (chosen[row])
            f->row[f->blocks++] = row;
    for (uint32_t p = 0; p < f->mesh.point_count; p++)
        f->number[p] = NONE;
    return true;
}

static const tl_poly *shape_of(const fitting *f, uint32_t block)
{
    return f->m->blocks.shape[f->row[block]];
}

static uint32_t body_of(const fitting *f, uint32_t block)
{
    return f->m->blocks.body[f->row[block]];
}

/* A point of the file in the coordinates of a block's body. */
static tl_vec3 local_point(const fitting *f, uint32_t block, uint32_t point)
{
    return tl_body_local(&f->m->bodies, body_of(f, block), tl_v3_sub(f->mesh.point[point], f->m->origin));
}

static bool find_boxes(fitting *f)
{
    for (uint32_t b = 0; b < f->blocks; b++) {
        const tl_poly *shape = shape_of(f, b);
        tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
        for (uint32_t v = 0; v < shape->vertex_count; v++) {
            const tl_vec3 x = tl_body_point(&f->m->bodies, body_of(f, b), shape->vertex[v]);
            low = (tl_vec3){fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z)};
            high = (tl_vec3){fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z)};
        }
        f->box[b] = (tl_bounds){low, high};
    }
    return tl_box_tree_make(&f->tree, f->box, f->blocks);
}

/* How far a place of a body lies outside of one of its blocks; below 0: inside. */
static double outside(const tl_poly *shape, tl_vec3 at)
{
    double most = -INFINITY;
    for (uint32_t k = 0; k < shape->face_count; k++)
        most = fmax(most, tl_v3_dot(shape->plane[k].normal, at) - shape->plane[k].offset);
    return most;
}

/* The search for the block of a centroid. */
typedef struct search {
    const fitting *f;
    tl_vec3 at; /* from the model's origin */
    uint32_t block;
    double outside;
} search;

static void look_at(void *user, uint32_t block)
{
    search *s = user;
    const fitting *f = s->f;
    const double out = outside(shape_of(f, block), tl_body_local(&f->m->bodies, body_of(f, block), s->at));
    if (out < s->outside || (out <= s->outside && block < s->block)) {
        s->outside = out;
        s->block = block;
    }
}

/* Gives each tetrahedron to a block, and lists those of each. */
static tl_status find_owners(fitting *f)
{
    const tl_mesh *mesh = &f->mesh;
    for (uint32_t z = 0; z < mesh->zone_count; z++) {
        const uint32_t *v = mesh->zone[z];
        const tl_vec3 sum =
            tl_v3_add(tl_v3_add(mesh->point[v[0]], mesh->point[v[1]]), tl_v3_add(mesh->point[v[2]], mesh->point[v[3]]));
        search s = {f, tl_v3_sub(tl_v3_scale(0.25, sum), f->m->origin), NONE, 0};
        tl_box_tree_ask(&f->tree, s.at, look_at, &s);
        f->owner[z] = s.block;
        if (s.block != NONE)
            f->start[s.block + 2]++;
    }
    for (uint32_t b = 0; b < f->blocks; b++)
        f->start[b + 2] += f->start[b + 1];
    for (uint32_t z = 0; z < mesh->zone_count; z++)
        if (f->owner[z] != NONE)
            f->order[f->start[f->owner[z] + 1]++] = z;
    for (uint32_t b = 0; b < f->blocks; b++)
        for (uint32_t k = f->start[b]; k < f->start[b + 1]; k++)
            f->place[f->order[k]] = k - f->start[b];
    return tl_mesh_pair(mesh, f->owner, f->on, &f->m->error);
}

/* ---------------------------------------------------------------- sentences -------------- */

static tl_id id_of(const fitting *f, uint32_t block)
{
    return f->m->blocks.id[f->row[block]];
}

static tl_status refuse_none(const fitting *f, uint32_t block)
{
    const tl_bounds is = tl_points_bounds(f->mesh.point, f->mesh.point_count), *box = &f->box[block];
    const tl_vec3 low = tl_v3_add(f->m->origin, box->min), high = tl_v3_add(f->m->origin, box->max);
    return tl_fail(
        &f->m->error, TL_E_GEOMETRY,
        "file '%.200s' has no tetrahedra in block %u: its points span {%g, %g, %g} to {%g, %g, %g}, the block "
        "{%g, %g, %g} to {%g, %g, %g}; give the blocks that it fills, in its units",
        f->mesh.file, id_of(f, block), is.min.x, is.min.y, is.min.z, is.max.x, is.max.y, is.max.z, low.x, low.y, low.z,
        high.x, high.y, high.z);
}

static tl_status refuse_outside(const fitting *f, uint32_t block, uint32_t zone, uint32_t point, double out)
{
    char where[TL_MESH_WHERE];
    const tl_vec3 x = f->mesh.point[point];
    return tl_fail(&f->m->error, TL_E_GEOMETRY,
                   "%s: its point %u at {%.9g, %.9g, %.9g} lies %.3g m outside of block %u, in which it is (%.3g m are "
                   "allowed): tetrahedra must end at the faces of blocks",
                   tl_mesh_where(&f->mesh, zone, where), f->mesh.node[point], x.x, x.y, x.z, out, id_of(f, block),
                   ON_FACE * shape_of(f, block)->size);
}

/* Another point of a block's zones near one; NONE: there is none. */
static uint32_t point_beside(const fitting *f, uint32_t block, uint32_t point)
{
    const double near = ON_FACE * shape_of(f, block)->size;
    const tl_mesh *mesh = &f->mesh;
    for (uint32_t k = f->start[block]; k < f->start[block + 1]; k++)
        for (int a = 0; a < 4; a++) {
            const uint32_t other = mesh->zone[f->order[k]][a];
            if (other != point && tl_v3_norm2(tl_v3_sub(mesh->point[other], mesh->point[point])) <= near * near)
                return other;
        }
    return NONE;
}

/* A side inside a block that no other zone has. */
static tl_status refuse_side(const fitting *f, uint32_t block, uint32_t side)
{
    char where[TL_MESH_WHERE];
    uint32_t v[3], other = NONE, at = 0;
    const tl_mesh *mesh = &f->mesh;
    tl_mesh_side_corners(mesh, side, v);
    tl_mesh_where(mesh, side / 4, where);
    for (; at < 3 && other == NONE; at++)
        other = point_beside(f, block, v[at]);
    const tl_vec3 x = mesh->point[v[other == NONE ? 0 : at - 1]];
    if (other != NONE)
        return tl_fail(
            &f->m->error, TL_E_GEOMETRY,
            "%s: its points %u and %u are in one place, {%.9g, %.9g, %.9g} in block %u, so zones do not hang "
            "together there: merge such points",
            where, mesh->node[v[at - 1]], mesh->node[other], x.x, x.y, x.z, id_of(f, block));
    return tl_fail(
        &f->m->error, TL_E_GEOMETRY,
        "%s: its side of the points %u, %u and %u near {%.9g, %.9g, %.9g} lies inside block %u, and no other "
        "tetrahedron has it: the mesh has a gap there, or points that hang on sides",
        where, mesh->node[v[0]], mesh->node[v[1]], mesh->node[v[2]], x.x, x.y, x.z, id_of(f, block));
}

/* ---------------------------------------------------------------- the zones of a block --- */

static tl_status check_inside(fitting *f, uint32_t block)
{
    const tl_poly *shape = shape_of(f, block);
    double bent = 0;
    for (uint32_t k = 0; k < shape->face_count; k++) {
        f->bend[k] = 0;
        for (uint32_t h = shape->start[k]; h < shape->start[k + 1]; h++)
            f->bend[k] = fmax(f->bend[k], fabs(tl_v3_dot(shape->plane[k].normal, shape->vertex[shape->loop[h]]) -
                                               shape->plane[k].offset));
        bent = fmax(bent, f->bend[k]);
    }
    for (uint32_t k = f->start[block]; k < f->start[block + 1]; k++)
        for (int a = 0; a < 4; a++) {
            const uint32_t zone = f->order[k], point = f->mesh.zone[zone][a];
            const double out = outside(shape, local_point(f, block, point));
            if (out > ON_FACE * shape->size + bent)
                return refuse_outside(f, block, zone, point, out);
        }
    return TL_OK;
}

/* The face on which a side lies, or NONE. Of several, that whose direction it has most. */
static uint32_t face_of(const fitting *f, uint32_t block, uint32_t side)
{
    const tl_poly *shape = shape_of(f, block);
    uint32_t v[3], found = NONE;
    tl_vec3 x[3];
    tl_mesh_side_corners(&f->mesh, side, v);
    for (int k = 0; k < 3; k++)
        x[k] = local_point(f, block, v[k]);
    const tl_vec3 area = tl_v3_cross(tl_v3_sub(x[1], x[0]), tl_v3_sub(x[2], x[0]));
    double best = 0;
    for (uint32_t k = 0; k < shape->face_count; k++) {
        const tl_plane *plane = &shape->plane[k];
        const double most = ON_FACE * shape->size + f->bend[k], along = tl_v3_dot(plane->normal, area);
        bool lies = along > best;
        for (int i = 0; i < 3; i++)
            lies = lies && fabs(tl_v3_dot(plane->normal, x[i]) - plane->offset) <= most;
        if (!lies)
            continue;
        best = along;
        found = k;
    }
    return found;
}

static void number_point(fitting *f, tl_zone_mesh *to, uint32_t block, uint32_t point)
{
    if (f->number[point] != NONE)
        return;
    f->number[point] = to->point_count;
    to->point[to->point_count++] = local_point(f, block, point);
}

/* Lists the triangles of the surface by face; points on it come first. */
static tl_status take_surface(fitting *f, tl_zone_mesh *to, uint32_t block)
{
    const uint32_t faces = shape_of(f, block)->face_count, begin = 4 * f->start[block], end = 4 * f->start[block + 1];
    uint32_t *at = calloc((size_t)faces + 2, sizeof *at),
             *face = malloc(((size_t)to->triangle_count + 1) * sizeof *face);
    tl_status status = at && face ? TL_OK : tl_fail_memory(&f->m->error);
    for (uint32_t k = begin, t = 0; status == TL_OK && k < end; k++) {
        const uint32_t side = 4 * f->order[k / 4] + k % 4;
        if (f->on[side] != NONE)
            continue;
        face[t] = face_of(f, block, side);
        if (face[t] == NONE)
            status = refuse_side(f, block, side);
        else
            at[face[t++] + 2]++;
    }
    for (uint32_t k = 0; status == TL_OK && k < faces; k++)
        at[k + 2] += at[k + 1];
    for (uint32_t k = begin, t = 0; status == TL_OK && k < end; k++) {
        const uint32_t side = 4 * f->order[k / 4] + k % 4;
        uint32_t v[3];
        if (f->on[side] != NONE)
            continue;
        tl_zone_triangle *triangle = &to->triangle[at[face[t] + 1]++];
        tl_mesh_side_corners(&f->mesh, side, v);
        triangle->face = face[t++];
        for (int i = 0; i < 3; i++) {
            number_point(f, to, block, v[i]);
            triangle->corner[i] = f->number[v[i]];
        }
    }
    to->face_end = to->point_count;
    free(at);
    free(face);
    return status;
}

static bool hold_mesh(const fitting *f, tl_zone_mesh *to, uint32_t block)
{
    to->zone_count = f->start[block + 1] - f->start[block];
    for (uint32_t k = f->start[block]; k < f->start[block + 1]; k++)
        for (uint32_t a = 0; a < 4; a++)
            to->triangle_count += f->on[4 * f->order[k] + a] == NONE;
    const size_t zones = to->zone_count;
    to->point = malloc((4 * zones + 1) * sizeof *to->point);
    to->zone = malloc((zones + 1) * sizeof *to->zone);
    to->beside = malloc((zones + 1) * sizeof *to->beside);
    to->triangle = malloc(((size_t)to->triangle_count + 1) * sizeof *to->triangle);
    return to->point && to->zone && to->beside && to->triangle;
}

static void take_zones(fitting *f, tl_zone_mesh *to, uint32_t block)
{
    for (uint32_t k = 0; k < to->zone_count; k++)
        for (uint32_t a = 0; a < 4; a++) {
            const uint32_t zone = f->order[f->start[block] + k], side = f->on[4 * zone + a];
            number_point(f, to, block, f->mesh.zone[zone][a]);
            to->zone[k][a] = f->number[f->mesh.zone[zone][a]];
            to->beside[k][a] = side == NONE ? NONE : f->place[side / 4];
        }
    for (uint32_t k = f->start[block]; k < f->start[block + 1]; k++)
        for (int a = 0; a < 4; a++)
            f->number[f->mesh.zone[f->order[k]][a]] = NONE;
}

/* Volume and altitudes. An altitude's share is that of the zone's edges, as their root mean square. */
static void measure(tl_zone_mesh *m)
{
    m->least_altitude = m->least_share = INFINITY;
    for (uint32_t z = 0; z < m->zone_count; z++) {
        tl_vec3 x[4];
        double edges2 = 0;
        for (int a = 0; a < 4; a++)
            x[a] = m->point[m->zone[z][a]];
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++)
                edges2 += tl_v3_norm2(tl_v3_sub(x[a], x[b])) / 6;
        const double altitude = tl_zone_altitude(x[0], x[1], x[2], x[3]), share = altitude / sqrt(edges2);
        m->volume += tl_tetrahedron_volume(x);
        m->least_altitude = fmin(m->least_altitude, altitude);
        if (share < m->least_share) {
            m->least_share = share;
            m->worst = z;
        }
    }
}

static tl_status check_volume(const fitting *f, const tl_zone_mesh *made, uint32_t block)
{
    const tl_poly *shape = shape_of(f, block);
    const double volume = f->m->blocks.volume[f->row[block]];
    double off = ON_FACE * volume;
    for (uint32_t k = 0; k < shape->face_count; k++)
        off += 2 * f->bend[k] * tl_poly_face_area(shape, k);
    if (!(made->least_altitude > 0))
        return tl_fail(&f->m->error, TL_E_GEOMETRY,
                       "file '%.200s': a tetrahedron of block %u has no volume in coordinates of %g: move the model "
                       "nearer to the origin",
                       f->mesh.file, id_of(f, block), tl_v3_norm(made->point[made->zone[made->worst][0]]));
    if (fabs(made->volume - volume) <= off)
        return TL_OK;
    return tl_fail(&f->m->error, TL_E_GEOMETRY,
                   "file '%.200s' does not fill block %u: its tetrahedra there have %.9g m3, the block has %.9g m3",
                   f->mesh.file, id_of(f, block), made->volume, volume);
}

static tl_status make_block(fitting *f, uint32_t block)
{
    tl_zone_mesh *made = &f->to->mesh[f->row[block]];
    if (f->start[block] == f->start[block + 1])
        return refuse_none(f, block);
    tl_status status = tl_model_go_on(f->m);
    if (status == TL_OK)
        status = check_inside(f, block);
    if (status == TL_OK && !hold_mesh(f, made, block))
        status = tl_fail_memory(&f->m->error);
    if (status == TL_OK)
        status = take_surface(f, made, block);
    if (status != TL_OK)
        return status;
    take_zones(f, made, block);
    measure(made);
    return check_volume(f, made, block);
}

tl_status tl_fit_make(tl_model *m, const char *file, const unsigned char *chosen, tl_fitted *fitted)
{
    fitting f = {.m = m, .to = fitted};
    *fitted = (tl_fitted){0};
    tl_status status = tl_mesh_read(file, &f.mesh, &m->error);
    if (status == TL_OK && !(hold(&f, chosen) && find_boxes(&f)))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = find_owners(&f);
    for (uint32_t b = 0; status == TL_OK && b < f.blocks; b++)
        status = make_block(&f, b);
    tl_mesh_free(&f.mesh);
    tl_box_tree_free(&f.tree);
    free(f.row);
    free(f.box);
    free(f.owner);
    free(f.on);
    free(f.start);
    free(f.order);
    free(f.place);
    free(f.number);
    free(f.bend);
    return status;
}

void tl_fit_free(tl_fitted *fitted)
{
    for (size_t row = 0; fitted->mesh && row < fitted->rows; row++)
        tl_zone_mesh_free(&fitted->mesh[row]);
    free(fitted->mesh);
    *fitted = (tl_fitted){0};
}
