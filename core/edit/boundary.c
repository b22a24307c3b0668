/* boundary.c - the outer faces of a model by side, plane, box or direction; holding their blocks and loading them.
 *
 * What is done to deformable blocks is done to triangles of their surfaces: zone_faces.c. A rigid block bears it whole.
 * A traction t = t_o + b z that is linear in the height z gives the body of a face, with r from the body's centroid,
 *
 *     F = int t dS,    M = int r x t dS
 *
 * both exact. What all faces put on a body becomes one load. The force F acts at the mean place of the faces, weighted
 * by the lengths of their forces, and goes with the body. What is left of M is a constant moment. Where a load has a
 * level, its integrals go over what of the faces lies below it. */
#include "model/model.h"

#include "base/error.h"
#include "contact/body_contacts.h"
#include "contact/sides.h"
#include "cycle/contributors.h"
#include "detect/detect.h"
#include "edit/zone_faces.h"
#include "geometry/point2.h"
#include "geometry/seam.h"
#include "model/loads.h"
#include "zone/body_verbs.h"
#include "zone/outer.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/boundary.h>

/* Integrals over a plane area in its own coordinates u, v. */
typedef struct area_sums {
    double a, u, v, uu, uv, vv; /* of 1, u, v, u u, u v, v v */
} area_sums;

/* The outer part of a face. A point of its plane is at o + u t1 + v t2. */
typedef struct outer_face {
    uint32_t row, face;
    tl_vec3 normal, o, t1, t2; /* axes of the model; o relative to its origin */
    area_sums sums;
    area_sums loaded;  /* of what lies below the level of the load */
    double level;      /* relative to the origin, or NaN */
    tl_bare_face bare; /* of a deformable block: its triangles */
} outer_face;

/* Tolerance: largest component across an axis of the normal of a face whose roller is held along that axis. */
#define ALONG 1e-2
/* What is put on faces. */
typedef struct face_loads {
    tl_face_load *at;
    size_t count, capacity;
} face_loads;

/* What is put on a body: about its centroid. */
typedef struct body_sum {
    tl_vec3 force, moment;
    tl_vec3 arm; /* weighted by the length of the forces */
    double weight;
    bool acts;    /* some of it is not 0 */
    bool changes; /* some load is put on faces of it: one of 0, as above still water, takes the place of what it had */
} body_sum;

/* One call: what its actions do, before any of it is done. */
typedef struct plan {
    tl_model *m;
    bool add;
    uint8_t *fix;    /* of each row of blocks: how rigid ones are to be held */
    uint32_t *drive; /* likewise the number of a drive, or 0 */
    body_sum *sums;  /* of each body */
    face_loads loads;
    bool changes; /* the loads of some bodies */
    tl_covers covers;
    tl_bare_list bare;
    tl_outer_list outer;
    uint32_t now;    /* the drive of the action being planned, or 0 */
    double level;    /* likewise of its load, relative to the origin, or NaN */
    double left_out; /* area of triangles that reach out of its box, m2 */
} plan;

/* ---------------------------------------------------------------- outer parts of faces ----
 *
 * The parts of faces that lie on no other block, and integrals over them.
 *
 * From a face's polygon the common parts with the faces that lie on it are taken away. They are those of contact
 * patches, and those of other blocks of the body. Blocks do not overlap, so neither do these parts. Each is a convex
 * polygon, over which polynomials of the second degree are integrated exactly: by triangles, at the middles of their
 * edges. */

/* Tolerance: share of a face that may be left bare for roundings. */
#define UNCOVERED 1e-5

static tl_point2 flatten(const outer_face *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (tl_point2){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

/* Places of a vertex and of corner i of a face, relative to the model's origin. */
static tl_vec3 vertex_at(const tl_model *m, uint32_t row, uint32_t vertex)
{
    return tl_body_point(&m->bodies, m->blocks.body[row], m->blocks.shape[row]->vertex[vertex]);
}

static tl_vec3 corner_at(const tl_model *m, uint32_t row, uint32_t face, uint32_t i)
{
    const tl_poly *p = m->blocks.shape[row];
    return vertex_at(m, row, p->loop[p->start[face] + i]);
}

/* Adds `sign` times the integrals over a polygon. */
static void add_polygon(area_sums *s, const tl_point2 *c, size_t count, double sign)
{
    for (size_t i = 1; i + 1 < count; i++) {
        double third = sign * tl_cross2(c[0], c[i], c[i + 1]) / 6;
        const tl_point2 corner[3] = {c[0], c[i], c[i + 1]};
        for (int k = 0; k < 3; k++) {
            double u = 0.5 * (corner[k].x + corner[(k + 1) % 3].x);
            double v = 0.5 * (corner[k].y + corner[(k + 1) % 3].y);
            s->a += third;
            s->u += third * u;
            s->v += third * v;
            s->uu += third * u * u;
            s->uv += third * u * v;
            s->vv += third * v * v;
        }
    }
}

/* Likewise of what lies below a height: a fan of triangles as the polygon is cut. */
static void add_below(const outer_face *f, area_sums *s, const tl_point2 *c, size_t count, double sign)
{
    tl_point2 fan[3];
    size_t had = 0;
    for (size_t i = 0; i < count; i++) {
        const tl_point2 a = c[i], b = c[i + 1 < count ? i + 1 : 0];
        const double from = f->level - f->o.z - a.x * f->t1.z - a.y * f->t2.z;
        const double to = f->level - f->o.z - b.x * f->t1.z - b.y * f->t2.z, part = from / (from - to);
        const tl_point2 next[2] = {a, {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)}};
        for (int k = from > 0 ? 0 : 1; k < ((from > 0) != (to > 0) ? 2 : 1); k++) {
            fan[had < 2 ? had : 2] = next[k];
            if (had++ >= 2) {
                add_polygon(s, fan, 3, sign);
                fan[1] = fan[2];
            }
        }
    }
}

/* Adds a polygon to what a face has. */
static void add_area(outer_face *f, const tl_point2 *c, size_t count, double sign)
{
    add_polygon(&f->sums, c, count, sign);
    if (!isnan(f->level))
        add_below(f, &f->loaded, c, count, sign);
}

/* Takes away what a face has in common with one that looks at it, as seen along its normal. */
static tl_status take_away(tl_model *m, outer_face *f, uint32_t row, uint32_t face)
{
    uint32_t mine = tl_poly_face_size(m->blocks.shape[f->row], f->face);
    uint32_t its = tl_poly_face_size(m->blocks.shape[row], face);
    size_t capacity = mine + its;
    tl_point2 *memory = malloc(3 * capacity * sizeof *memory);
    if (!memory)
        return tl_fail_memory(&m->error);
    tl_point2 *now = memory, *next = now + capacity, *by = next + capacity;
    for (uint32_t i = 0; i < mine; i++)
        now[i] = flatten(f, corner_at(m, f->row, f->face, i));
    for (uint32_t i = 0; i < its; i++) /* clockwise, as seen from here */
        by[i] = flatten(f, corner_at(m, row, face, i));
    size_t count = tl_polygon_common(&now, &next, mine, by, its);
    add_area(f, now, count, -1);
    free(memory);
    return TL_OK;
}

/* Takes away the patches of contacts. */
static tl_status take_contacts(tl_model *m, outer_face *f)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_status status = TL_OK;
    for (tl_body_contacts at = tl_contacts_of_block(m, f->row); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        const tl_facet *facet = &c->facet[i];
        bool first = c->a[i] == f->row;
        if (status == TL_OK && tl_facet_is_patch(facet) && c->point_count[i] &&
            (first ? facet->ia : facet->ib) == f->face)
            status = take_away(m, f, tl_contact_partner(c, i, f->row), first ? facet->ib : facet->ia);
    }
    return status;
}

/* Takes away the triangles of deformable blocks that lie on a face. */
static tl_status take_zones(tl_model *m, outer_face *f, const tl_covers *covers)
{
    size_t at;
    const size_t end = tl_covers_of(covers, f->row, f->face, &at);
    for (; at < end; at++) {
        const tl_surface_part *part = &m->zones->part[covers->list[at].other_part];
        const uint32_t mine = tl_poly_face_size(m->blocks.shape[f->row], f->face);
        const size_t capacity = mine + 3;
        tl_point2 by[3], *memory = malloc(2 * capacity * sizeof *memory), *now = memory, *next = memory + capacity;
        if (!memory)
            return tl_fail_memory(&m->error);
        for (uint32_t i = 0; i < mine; i++)
            now[i] = flatten(f, corner_at(m, f->row, f->face, i));
        for (int i = 0; i < 3; i++)
            by[i] = flatten(f, tl_gridpoint_place(&m->zones->points, part->corner[i]));
        const size_t count = tl_polygon_common(&now, &next, mine, by, 3);
        add_area(f, now, count, -1);
        free(memory);
    }
    return TL_OK;
}

/* Takes away what lies on other blocks of the body, and raises the share that may be left bare. */
static tl_status take_members(tl_model *m, outer_face *f, double *bare)
{
    const tl_poly *shape = m->blocks.shape[f->row];
    uint32_t body = m->blocks.body[f->row];
    const uint32_t *member = m->members + m->bodies.member_start[body];
    for (uint32_t i = 0; i < m->bodies.member_count[body]; i++) {
        const tl_poly *other = m->blocks.shape[member[i]];
        for (uint32_t g = 0; g < other->face_count && member[i] != f->row; g++) {
            tl_status status = TL_OK;
            if (tl_poly_faces_meet(shape, f->face, other, g, bare))
                status = take_away(m, f, member[i], g);
            if (status != TL_OK)
                return status;
        }
    }
    return TL_OK;
}

/* Measures the outer part of a face of the block in a row, after a tl_detect_refresh. Its area is 0 where all of the
 * face but for roundings lies on others. */
static tl_status outer_measure(const plan *p, uint32_t row, uint32_t face, outer_face *out)
{
    tl_model *m = p->m;
    const tl_poly *shape = m->blocks.shape[row];
    *out = (outer_face){.row = row, .face = face, .level = p->level};
    out->normal = tl_m3_mul(&m->bodies.pose[m->blocks.body[row]].r, shape->plane[face].normal);
    out->t1 = tl_v3_perpendicular(out->normal);
    out->t2 = tl_v3_cross(out->normal, out->t1);
    out->o = corner_at(m, row, face, 0);
    uint32_t count = tl_poly_face_size(shape, face);
    tl_point2 *corners = malloc(count * sizeof *corners);
    if (!corners)
        return tl_fail_memory(&m->error);
    for (uint32_t i = 0; i < count; i++)
        corners[i] = flatten(out, corner_at(m, row, face, i));
    add_area(out, corners, count, 1);
    free(corners);
    double whole = out->sums.a, bare = UNCOVERED;
    tl_status status = take_contacts(m, out);
    if (status == TL_OK)
        status = take_zones(m, out, &p->covers);
    if (status == TL_OK)
        status = take_members(m, out, &bare);
    if (out->sums.a <= bare * whole)
        out->sums = (area_sums){0};
    if (isnan(p->level) || out->sums.a == 0)
        out->loaded = out->sums;
    return status;
}

/* Centroid of it, or of its loaded part, relative to the origin. */
static tl_vec3 outer_centroid(const outer_face *f, const area_sums *s)
{
    double u = s->u / s->a, v = s->v / s->a;
    return tl_v3_madd(tl_v3_madd(f->o, u, f->t1), v, f->t2);
}

/* ---------------------------------------------------------------- which faces ------------ */

typedef struct face_list {
    outer_face *at;
    size_t count, capacity;
} face_list;

/* Measures the triangles of a face of a deformable block that are meant, as its outer part. */
static tl_status bare_measure(plan *p, const tl_face_filter *filter, uint32_t row, uint32_t face, outer_face *out)
{
    *out = (outer_face){.row = row, .face = face};
    if (!tl_bare_find(p->m, filter, &p->covers, row, face, &p->bare, &out->bare))
        return tl_fail_memory(&p->m->error);
    out->normal = out->bare.normal;
    out->o = out->bare.centroid;
    out->sums.a = out->bare.area;
    p->left_out += out->bare.left_out;
    return TL_OK;
}

/* Zones that do not end at the box make the area another one than is wanted. */
static void remark_left_out(const plan *p, double area)
{
    if (p->left_out > 0)
        tl_model_say(p->m,
                     "boundary: triangles with %.3g m2 have their middle in the box, but reach out of it and are left "
                     "out; %.3g m2 are in it: let zones end where the box does, at a joint, or make them smaller",
                     p->left_out, area);
}

static tl_status find_faces(plan *p, const tl_face_filter *filter, face_list *faces)
{
    tl_model *m = p->m;
    tl_status status = TL_OK;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        for (uint32_t f = 0; f < m->blocks.shape[row]->face_count && status == TL_OK; f++) {
            const bool deforms = tl_block_deforms(m, row);
            if (!deforms && !tl_face_is_there(m, filter, row, f))
                continue;
            if (!tl_grow(&faces->at, &faces->capacity, faces->count + 1, sizeof *faces->at))
                return tl_fail_memory(&m->error);
            outer_face *out = &faces->at[faces->count];
            status = deforms ? bare_measure(p, filter, row, f, out) : outer_measure(p, row, f, out);
            faces->count += status == TL_OK && out->sums.a > 0;
        }
    if (status == TL_OK && faces->count == 0)
        return tl_fail(&m->error, TL_E_NOT_FOUND,
                       "boundary: no outer face is there%s; %s tells where the "
                       "model ends, tolerance (m) how far off a face may be",
                       m->blocks.table.rows ? "" : ", for the model has no blocks",
                       tl_words(m, "model:blocks():bounds()", "tl_block_mesh_get()"));
    return status;
}

/* ---------------------------------------------------------------- what is done ----------- */

/* Force and moment, about the body's centroid, of the traction on a face. */
static void face_load(const tl_model *m, const tl_boundary_action *a, const outer_face *f, tl_vec3 *force,
                      tl_vec3 *moment)
{
    const area_sums *s = &f->loaded;
    double height = f->o.z + m->origin.z - a->at.z;
    tl_vec3 b = tl_s3_mul(a->gradient, f->normal);
    tl_vec3 t = tl_v3_madd(tl_v3_add(tl_s3_mul(a->stress, f->normal), a->traction), height, b);
    tl_vec3 tu = tl_v3_scale(f->t1.z, b), tv = tl_v3_scale(f->t2.z, b);
    /* int t dS, int u t dS, int v t dS */
    tl_vec3 sum = tl_v3_madd(tl_v3_madd(tl_v3_scale(s->a, t), s->u, tu), s->v, tv);
    tl_vec3 sum_u = tl_v3_madd(tl_v3_madd(tl_v3_scale(s->u, t), s->uu, tu), s->uv, tv);
    tl_vec3 sum_v = tl_v3_madd(tl_v3_madd(tl_v3_scale(s->v, t), s->uv, tu), s->vv, tv);
    tl_vec3 arm = tl_v3_sub(f->o, tl_body_place(&m->bodies, m->blocks.body[f->row]));
    *force = sum;
    *moment = tl_v3_add(tl_v3_cross(arm, sum), tl_v3_add(tl_v3_cross(f->t1, sum_u), tl_v3_cross(f->t2, sum_v)));
}

static tl_status add_load(plan *p, const tl_boundary_action *a, const outer_face *f, tl_boundary_result *result)
{
    tl_model *m = p->m;
    face_loads *loads = &p->loads;
    uint32_t body = m->blocks.body[f->row];
    tl_vec3 force, moment, place = tl_body_place(&m->bodies, body);
    body_sum *sum = &p->sums[body];
    sum->changes = p->changes = true;
    if (!(f->loaded.a > 0))
        return TL_OK;
    face_load(m, a, f, &force, &moment);
    const double weight = tl_v3_norm(force);
    if (!(weight > 0) && !(tl_v3_norm2(moment) > 0))
        return TL_OK;
    sum->force = tl_v3_add(sum->force, force);
    sum->moment = tl_v3_add(sum->moment, moment);
    sum->arm = tl_v3_madd(sum->arm, weight, tl_v3_sub(outer_centroid(f, &f->loaded), place));
    sum->weight += weight;
    sum->acts = true;
    result->force = tl_v3_add(result->force, force);
    tl_vec3 about = tl_v3_cross(tl_v3_add(m->origin, place), force);
    result->moment = tl_v3_add(result->moment, tl_v3_add(moment, about));
    if (!tl_grow(&loads->at, &loads->capacity, loads->count + 1, sizeof *loads->at))
        return tl_fail_memory(&m->error);
    tl_vec3 arm = tl_v3_sub(tl_face_plate(m, f->row, f->face).place, place);
    moment = tl_v3_sub(moment, tl_v3_cross(arm, force));
    loads->at[loads->count++] = (tl_face_load){m->blocks.id[f->row], f->face, force, moment};
    return TL_OK;
}

/* The components in which a roller at a face holds its body; 0 when it looks along no axis. */
static unsigned roller_of(tl_vec3 n)
{
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    if (fmax(y, z) < ALONG)
        return TL_FIX_X;
    if (fmax(x, z) < ALONG)
        return TL_FIX_Y;
    return fmax(x, y) < ALONG ? TL_FIX_Z : 0;
}

static tl_status add_fixing(plan *p, const tl_boundary_action *a, const outer_face *f)
{
    tl_model *m = p->m;
    unsigned what = a->fixed ? TL_FIX_ALL : 0;
    if (a->quiet)
        return tl_fail(&m->error, TL_E_STATE,
                       "boundary: block %u is rigid, and only deformable blocks have quiet faces of this sort: put "
                       "elements of the kind 'quiet' on rigid ones",
                       m->blocks.id[f->row]);
    if (a->roller && !a->fixed) {
        what = roller_of(f->normal);
        if (!what)
            return tl_fail(&m->error, TL_E_ARGUMENT,
                           "boundary: a roller is held along x, y or z, but face %u of block %u looks along {%.3g, "
                           "%.3g, %.3g}; use fixed, or a box or side whose faces look along an axis",
                           f->face + 1, m->blocks.id[f->row], f->normal.x, f->normal.y, f->normal.z);
        what |= a->rotation ? TL_FIX_ROTATION : 0;
    }
    p->fix[f->row] |= (uint8_t)what;
    if (p->now)
        p->drive[f->row] = p->now;
    return TL_OK;
}

/* Whether an action does something to what it finds. */
static bool does_something(const tl_boundary_action *a)
{
    return a->loads || a->fixed || a->roller || a->quiet || a->drive;
}

/* What an action does to triangles of a deformable block. */
static tl_status add_triangles(plan *p, const tl_boundary_action *a, const tl_face_filter *filter, const outer_face *f,
                               tl_boundary_result *result)
{
    tl_model *m = p->m;
    if (!does_something(a))
        return TL_OK;
    if ((a->fixed || a->roller || a->drive) && m->bodies.drive[m->blocks.body[f->row]])
        return tl_fail(&m->error, TL_E_STATE,
                       "boundary: block %u is driven as a whole, so its faces cannot be held; let it go first",
                       m->blocks.id[f->row]);
    for (size_t k = f->bare.begin; a->loads && !isnan(a->level) && k < f->bare.end; k++)
        if (tl_bare_crosses(m, &p->bare.at[k], a->level))
            return tl_fail(&m->error, TL_E_ARGUMENT,
                           "boundary: the level %g m crosses a triangle of face %u of block %u that another block "
                           "covers in part: give another level, or let zones end where that block does",
                           a->level, f->face + 1, m->blocks.id[f->row]);
    return tl_bare_act(m, a, filter, p->now, f->row, &p->bare, &f->bare, &p->outer, result) ? TL_OK
                                                                                            : tl_fail_memory(&m->error);
}

/* Writes what was found; false when out of memory. Faces are in order of rows, and so of ids. */
static bool fill_result(const tl_model *m, const face_list *faces, tl_boundary_result *r)
{
    r->faces = malloc((faces->count + 1) * sizeof *r->faces);
    r->blocks = malloc((faces->count + 1) * sizeof *r->blocks);
    for (size_t i = 0; i < faces->count && r->faces && r->blocks; i++) {
        const outer_face *f = &faces->at[i];
        tl_id id = m->blocks.id[f->row];
        r->faces[r->face_count++] =
            (tl_boundary_face){id, f->face, f->sums.a, f->normal, tl_v3_add(m->origin, outer_centroid(f, &f->sums))};
        if (r->block_count == 0 || r->blocks[r->block_count - 1] != id)
            r->blocks[r->block_count++] = id;
        r->area += f->sums.a;
    }
    return r->faces && r->blocks;
}

/* Refuses what does not go together. */
static tl_status check_action(tl_model *m, const tl_boundary_action *a)
{
    if (a->quiet && (a->fixed || a->roller || a->drive))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "boundary: a quiet face moves, so it cannot be held as well: give quiet without fixed, roller "
                       "and velocity");
    if (!a->drive)
        return TL_OK;
    if (a->fixed || a->roller)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "boundary: a face with a velocity is held by that: give it without fixed and roller");
    if (a->drive->angular_velocity_at || tl_v3_norm2(a->drive->angular_velocity) > 0)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "boundary: faces get a velocity and do not turn; drive the block to turn it");
    return tl_check_motion(&m->error, "boundary", a->drive->velocity, a->drive->angular_velocity);
}

/* Finds the faces of one action and notes what is to be done. */
static tl_status plan_action(plan *p, const tl_boundary_action *a, tl_boundary_result *result)
{
    tl_model *m = p->m;
    face_list faces = {0};
    tl_face_filter filter;
    p->left_out = 0;
    p->level = a->level - m->origin.z;
    tl_status status = check_action(m, a);
    if (status == TL_OK)
        status = tl_face_filter_begin(m, &a->where, &filter);
    if (status == TL_OK)
        status = find_faces(p, &filter, &faces);
    for (size_t i = 0; i < faces.count && status == TL_OK; i++) {
        const outer_face *f = &faces.at[i];
        if (tl_block_deforms(m, f->row)) {
            status = add_triangles(p, a, &filter, f, result);
            continue;
        }
        status = add_fixing(p, a, f);
        if (a->loads && f->sums.a > 0 && status == TL_OK)
            status = add_load(p, a, f, result);
    }
    if (status == TL_OK && !fill_result(m, &faces, result))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK && a->loads && !isnan(a->level) && !(tl_v3_norm2(result->force) > 0))
        status = tl_fail(
            &m->error, TL_E_NOT_FOUND,
            "boundary: no outer face there lies below the level %g m: give a higher one or other faces or, to take "
            "water away, pressure = 0",
            a->level);
    if (status == TL_OK && (!tl_v3_finite(result->force) || !tl_v3_finite(result->moment)))
        status = tl_fail(&m->error, TL_E_NUMERIC, "boundary: the load is not finite");
    if (status == TL_OK && does_something(a))
        remark_left_out(p, result->area);
    free(faces.at);
    return status;
}

/* What was summed, as a load of a body: the force at the mean place of the faces, and the moment that is left. */
static tl_load load_of(const tl_model *m, uint32_t body, const body_sum *sum, bool add)
{
    tl_vec3 arm = sum->weight > 0 ? tl_v3_scale(1 / sum->weight, sum->arm) : tl_v3(0, 0, 0);
    tl_load load = tl_load_default();
    if (!sum->acts && !add)
        return load;
    load.force = sum->force;
    load.moment = sum->moment;
    if (add) {
        tl_body_load had = tl_load_of(&m->bodies, body);
        tl_vec3 at = tl_m3_mul(&m->bodies.pose[body].r, had.arm);
        load.force = tl_v3_add(load.force, had.force);
        load.moment = tl_v3_add(load.moment, tl_v3_add(had.moment, tl_v3_cross(at, had.force)));
        double before = tl_v3_norm(had.force), all = sum->weight + before;
        if (all > 0)
            arm = tl_v3_scale(1 / all, tl_v3_madd(sum->arm, before, at));
    }
    load.moment = tl_v3_sub(load.moment, tl_v3_cross(arm, load.force));
    load.at = tl_v3_add(m->origin, tl_v3_add(tl_body_place(&m->bodies, body), arm));
    return load;
}

/* Before any of them is put on: none may be refused half-way. */
static tl_status check_loads(tl_model *m, const body_sum *sums, bool add)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (!sums[body].acts)
            continue;
        tl_load load = load_of(m, body, &sums[body], add);
        if (!tl_v3_finite(load.force) || !tl_v3_finite(load.moment) || !tl_v3_finite(load.at))
            return tl_fail(&m->error, TL_E_NUMERIC,
                           "boundary: the load on block %u is not finite: give smaller numbers", m->bodies.id[body]);
    }
    return TL_OK;
}

/* Adds to what is put on faces what the model has of others, or of all with `add`. */
static bool keep_others(const tl_model *m, const body_sum *sums, bool add, face_loads *loads)
{
    size_t most = loads->count + m->face_load_count;
    if (!tl_grow(&loads->at, &loads->capacity, most, sizeof *loads->at))
        return false;
    for (size_t i = 0; i < m->face_load_count; i++) {
        uint32_t row = tl_block_row_quiet(m, m->face_loads[i].block);
        if (row != TL_NO_ROW && (add || !sums[m->blocks.body[row]].changes))
            loads->at[loads->count++] = m->face_loads[i];
    }
    return true;
}

/* Whether a body gets another load: nothing takes the place of nothing. */
static bool changes_load(const plan *p, uint32_t body)
{
    const body_sum *sum = &p->sums[body];
    return sum->acts || (sum->changes && !p->add && tl_body_loaded(&p->m->bodies, body));
}

/* Does what was planned: what can fail comes first. */
static tl_status carry_out(plan *p)
{
    tl_model *m = p->m;
    tl_status status = check_loads(m, p->sums, p->add);
    size_t replaced = 0;
    if (status == TL_OK && p->changes && !keep_others(m, p->sums, p->add, &p->loads))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK && p->outer.count)
        status = tl_outer_put(m, p->outer.at, p->outer.count, p->add);
    if (status == TL_OK && p->changes)
        m->face_load_count = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows && status == TL_OK; body++) {
        if (!changes_load(p, body))
            continue;
        replaced += !p->add && tl_body_loaded(&m->bodies, body);
        tl_load load = load_of(m, body, &p->sums[body], p->add);
        const tl_id id = m->bodies.id[body]; /* the table may move */
        status = tl_blocks_load(m, &id, 1, &load);
    }
    if (status == TL_OK && p->changes) {
        tl_face_loads_set(m, p->loads.at, p->loads.count, p->loads.capacity);
        p->loads.at = NULL;
    }
    for (uint32_t row = 0; row < m->blocks.table.rows && status == TL_OK; row++) {
        if (p->fix[row])
            status = tl_blocks_fix(m, &m->blocks.id[row], 1, p->fix[row]);
        if (p->drive[row])
            tl_drive_follow(m, m->blocks.body[row], p->drive[row]);
        m->constraints += p->drive[row] != 0;
    }
    if (replaced)
        tl_model_say(m,
                     "boundary: %zu bod%s had a load, which this one takes the place of; give all "
                     "sides in one call, or add = true",
                     replaced, replaced == 1 ? "y" : "ies");
    return status;
}

tl_boundary_action tl_boundary_action_default(void)
{
    const tl_vec3 none = {NAN, NAN, NAN};
    return (tl_boundary_action){.where = {.side = TL_SIDE_ANY,
                                          .normal = none,
                                          .at = none,
                                          .box = {none, none},
                                          .facing = none,
                                          .within = NAN,
                                          .tolerance = NAN},
                                .level = NAN};
}

/* Makes room for a plan. */
static tl_status begin_plan(plan *p, bool loads)
{
    tl_model *m = p->m;
    p->fix = calloc(m->blocks.table.rows + 1, sizeof *p->fix);
    p->drive = calloc(m->blocks.table.rows + 1, sizeof *p->drive);
    p->sums = calloc(m->bodies.table.rows + 1, sizeof *p->sums);
    const bool enough = p->fix && p->drive && p->sums && (!loads || tl_bodies_hold_loads(&m->bodies)) &&
                        (!tl_model_deforms(m) || tl_meets_cover(m, &p->covers.list, &p->covers.count));
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

static void end_plan(plan *p)
{
    free(p->loads.at);
    free(p->fix);
    free(p->drive);
    free(p->sums);
    free(p->covers.list);
    free(p->bare.at);
    free(p->outer.at);
}

/* Makes the drive of an action, which it keeps in use until something follows it. `made`: numbers of all so far. */
static tl_status begin_drive(plan *p, const tl_boundary_action *a, uint32_t *made)
{
    *made = p->now = 0;
    if (!a->drive)
        return TL_OK;
    p->now = *made = tl_drive_new(p->m, a->drive);
    if (!p->now)
        return tl_fail_memory(&p->m->error);
    p->m->drives[p->now - 1].bodies = 1;
    return TL_OK;
}

/* Drives that were made count what follows them. After a failure they are the caller's as before. */
static void end_drives(tl_model *m, const uint32_t *made, size_t count, bool failed)
{
    for (size_t i = 0; i < count; i++)
        if (made[i] && failed) {
            tl_drive_let_records_go(&m->drives[made[i] - 1].drive);
            m->drives[made[i] - 1] = (tl_drive_record){.bodies = 0};
        }
    tl_drives_recount(m);
}

tl_status tl_model_boundary(tl_model *m, const tl_boundary_action *actions, size_t count, bool add,
                            tl_boundary_result *results)
{
    bool acts = false, loads = false;
    for (size_t i = 0; i < count; i++) {
        if (results)
            results[i] = (tl_boundary_result){0};
        loads = loads || actions[i].loads;
        acts = acts || does_something(&actions[i]);
    }
    tl_status status = acts ? tl_model_may_set(m, "hold or load a boundary") : TL_OK;
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    plan p = {.m = m, .add = add};
    uint32_t *made = calloc(count + 1, sizeof *made);
    status = made ? begin_plan(&p, loads) : tl_fail_memory(&m->error);
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        tl_boundary_result found = {0};
        status = begin_drive(&p, &actions[i], &made[i]);
        if (status == TL_OK)
            status = plan_action(&p, &actions[i], &found);
        if (results)
            results[i] = found;
        else
            tl_boundary_free(&found);
    }
    if (status == TL_OK)
        status = carry_out(&p);
    for (size_t i = 0; i < count && results && status != TL_OK; i++)
        tl_boundary_free(&results[i]);
    if (acts && made)
        end_drives(m, made, count, status != TL_OK);
    free(made);
    end_plan(&p);
    return status;
}

void tl_boundary_free(tl_boundary_result *r)
{
    free(r->faces);
    free(r->blocks);
    *r = (tl_boundary_result){0};
}

/* What contacts, segments, elements, weight and load put on a body, as of the last step: the moment about its centroid.
 */
static tl_wrench acting_on(const tl_model *m, uint32_t body)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_wrench load = tl_body_loaded(&m->bodies, body) ? tl_load_wrench(&m->bodies, body) : (tl_wrench){0};
    tl_vec3 force = tl_v3_madd(load.force, m->bodies.mass[body], m->config.gravity), moment = load.moment;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        const uint32_t i = at.contact;
        force = tl_v3_madd(force, tl_contact_sign(c, i, at.block), c->force[i]);
        moment = tl_v3_add(moment, tl_contact_moment(m, i, tl_contact_is_b(c, i, at.block)));
    }
    const tl_wrench pushed = tl_body_pushed(m, body);
    return (tl_wrench){tl_v3_add(force, pushed.force), tl_v3_add(moment, pushed.moment)};
}

tl_status tl_blocks_reaction(tl_model *m, const tl_id *ids, size_t count, tl_vec3 *force)
{
    *force = tl_v3(0, 0, 0);
    tl_status status = tl_detect_refresh(m);
    unsigned char *seen = calloc(m->bodies.table.rows + 1, 1);
    if (status == TL_OK && !seen)
        status = tl_fail_memory(&m->error);
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t row = tl_block_row(m, ids[i]);
        if (row == TL_NO_ROW) {
            status = m->error.status;
            continue;
        }
        uint32_t body = m->blocks.body[row];
        if (m->bodies.mesh[body]) {
            if (!seen[body])
                tl_mesh_reaction(m, m->bodies.mesh[body] - 1, force);
            seen[body] = 1;
            continue;
        }
        unsigned fixed = m->bodies.fixed[body];
        tl_vec3 f = fixed && !seen[body] ? acting_on(m, body).force : tl_v3(0, 0, 0);
        seen[body] = 1;
        force->x -= fixed & TL_FIX_X ? f.x : 0;
        force->y -= fixed & TL_FIX_Y ? f.y : 0;
        force->z -= fixed & TL_FIX_Z ? f.z : 0;
    }
    free(seen);
    return status;
}

/* Puts what holds a body in some components on it as a load, and lets them go. The columns of loads are held. */
static tl_status release_body(tl_model *m, uint32_t row, unsigned what)
{
    const uint32_t body = m->blocks.body[row];
    const tl_id id = m->blocks.id[row];
    const unsigned fixed = m->bodies.fixed[body];
    const tl_wrench on = acting_on(m, body);
    const tl_wrench had = tl_body_loaded(&m->bodies, body) ? tl_load_wrench(&m->bodies, body) : (tl_wrench){0};
    tl_load load = tl_load_default();
    load.force = tl_v3_sub(had.force, tl_free_part(on.force, ~what));
    load.moment = what & TL_FIX_ROTATION ? tl_v3_sub(had.moment, on.moment) : had.moment;
    load.at = tl_v3_add(m->origin, tl_body_place(&m->bodies, body));
    if (!tl_v3_finite(load.force) || !tl_v3_finite(load.moment))
        return tl_fail(&m->error, TL_E_NUMERIC, "boundary: what holds block %u is not finite", id);
    tl_status status = tl_blocks_free(m, &id, 1);
    if (status == TL_OK)
        status = tl_blocks_load(m, &id, 1, &load);
    if (status == TL_OK && (fixed & ~what))
        status = tl_blocks_fix(m, &id, 1, fixed & ~what);
    return status;
}

tl_status tl_blocks_release(tl_model *m, const tl_id *ids, size_t count, const uint8_t *what)
{
    tl_status status = tl_model_may_set(m, "let blocks go");
    if (status == TL_OK)
        status = tl_blocks_check_rigid(m, ids, count, "release", "let its gridpoints go");
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        if (m->bodies.drive[m->blocks.body[tl_block_row_quiet(m, ids[i])]])
            status = tl_fail(&m->error, TL_E_STATE,
                             "boundary: block %u is driven, so its faces cannot be quiet; let it go first: "
                             "selection:free()",
                             ids[i]);
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        const uint32_t row = tl_block_row_quiet(m, ids[i]);
        const unsigned held = what[i] & m->bodies.fixed[m->blocks.body[row]];
        if (held)
            status = tl_bodies_hold_loads(&m->bodies) ? release_body(m, row, held) : tl_fail_memory(&m->error);
    }
    return status;
}
