/* carry.c - what carries a node: a rigid body, or a zone (elements.h has the formulas).
 *
 * A node of a deformable block lies in one of its zones, with the weights N_a of the corners. A node on a face lies on
 * a triangle of the surface, whose corners come first: the present normal is that of the triangle. A body with a mesh
 * begins at the pose u, R that it had when the mesh was made:
 *
 *     x_ref + u + R p = sum N_a ref_a */
#include "element/carry.h"

#include "base/columns.h"
#include "zone/grid.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- frames ----------------- */

/* The place of a point of the material when its block was made, less its place in the body's frame now: shift and turn
 * of tl_block_made. */
static tl_vec3 made_of(tl_base made, tl_vec3 local)
{
    const tl_mat3 turn = tl_q_matrix(made.turn);
    return tl_v3_add(made.shift, tl_m3_mul(&turn, local));
}

/* Where a body has a point of its frame, less x_ref: now or, with a mesh, when that was made. */
static tl_vec3 begun_of(const tl_model *m, uint32_t body, tl_vec3 local)
{
    const tl_pose *pose = &m->bodies.pose[body];
    if (!m->bodies.mesh[body])
        return tl_v3_add(pose->u, tl_m3_mul(&pose->r, local));
    const tl_body_mesh *mesh = &m->zones->mesh[m->bodies.mesh[body] - 1];
    const tl_mat3 turn = tl_q_matrix(mesh->made_q);
    return tl_v3_add(mesh->made_u, tl_m3_mul(&turn, local));
}

/* The way back: the point of the frame at a place, less x_ref. */
static tl_vec3 local_of(const tl_model *m, uint32_t body, tl_vec3 place)
{
    const tl_pose *pose = &m->bodies.pose[body];
    if (!m->bodies.mesh[body])
        return tl_m3_tmul(&pose->r, tl_v3_sub(place, pose->u));
    const tl_body_mesh *mesh = &m->zones->mesh[m->bodies.mesh[body] - 1];
    const tl_mat3 turn = tl_q_matrix(mesh->made_q);
    return tl_m3_tmul(&turn, tl_v3_sub(place, mesh->made_u));
}

double tl_block_depth(const tl_model *m, uint32_t block, tl_vec3 place)
{
    const tl_poly *p = m->blocks.shape[block];
    const tl_vec3 local = tl_body_local(&m->bodies, m->blocks.body[block], place);
    double depth = INFINITY;
    for (uint32_t f = 0; f < p->face_count; f++)
        depth = fmin(depth, p->plane[f].offset - tl_v3_dot(p->plane[f].normal, local));
    return depth;
}

/* ---------------------------------------------------------------- zones ------------------ */

/* Where corners of zones are looked at: as they are, or as they were made. */
static tl_vec3 corner_at(const tl_gridpoints *p, uint32_t row, bool now)
{
    return now ? tl_gridpoint_place(p, row) : tl_columns_get(p->ref, row);
}

/* Weights of a place between four corners; the least of them. */
static double weigh(const tl_gridpoints *p, const uint32_t corner[4], bool now, tl_vec3 place, double weight[4])
{
    const tl_vec3 o = corner_at(p, corner[0], now);
    const tl_vec3 a = tl_v3_sub(corner_at(p, corner[1], now), o), b = tl_v3_sub(corner_at(p, corner[2], now), o);
    const tl_vec3 c = tl_v3_sub(corner_at(p, corner[3], now), o), d = tl_v3_sub(place, o);
    const double six = tl_v3_dot(a, tl_v3_cross(b, c));
    weight[1] = tl_v3_dot(d, tl_v3_cross(b, c)) / six;
    weight[2] = tl_v3_dot(a, tl_v3_cross(d, c)) / six;
    weight[3] = tl_v3_dot(a, tl_v3_cross(b, d)) / six;
    weight[0] = 1 - weight[1] - weight[2] - weight[3];
    return fmin(fmin(weight[0], weight[1]), fmin(weight[2], weight[3]));
}

/* A search for the zone that holds a place, or is the nearest by weights. */
typedef struct zone_search {
    const tl_model *m;
    const tl_body_mesh *mesh;
    bool now;
    tl_vec3 place;
    double best;
    uint32_t corner[4];
    double weight[4];
} zone_search;

static void try_zone(zone_search *s, const uint32_t corner[4])
{
    double weight[4];
    const double least = weigh(&s->m->zones->points, corner, s->now, s->place, weight);
    if (!(least > s->best))
        return;
    s->best = least;
    memcpy(s->corner, corner, sizeof s->corner);
    memcpy(s->weight, weight, sizeof s->weight);
}

/* Tolerance: cosine of the angle that a triangle of a face makes with the normal given for a node on it. A face bends
 * with its block; those beside it make larger angles. */
#define ON_FACE 0.9

/* The triangle of a face that a node with a normal lies on. */
static void search_surface(zone_search *s, tl_id block, tl_vec3 normal)
{
    const struct tl_zones *z = s->m->zones;
    for (uint32_t k = s->mesh->part_begin; k < s->mesh->part_end; k++) {
        const tl_surface_part *part = &z->part[k];
        const uint32_t corner[4] = {part->corner[0], part->corner[1], part->corner[2], part->apex};
        const tl_vec3 o = corner_at(&z->points, corner[0], s->now);
        const tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(corner_at(&z->points, corner[1], s->now), o),
                                                 tl_v3_sub(corner_at(&z->points, corner[2], s->now), o)));
        if (part->block == block && tl_v3_dot(n, normal) > ON_FACE)
            try_zone(s, corner);
    }
}

static void search_zones(zone_search *s, tl_id block)
{
    const struct tl_zones *z = s->m->zones;
    for (uint32_t k = s->mesh->parcel_begin; k < s->mesh->parcel_end; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        for (uint32_t g = of->group_begin; of->block == block && g < of->group_end; g++)
            for (uint32_t i = 0; i < z->group[g].depth * (uint32_t)TL_LANES; i++) {
                const uint32_t row = z->group[g].start + i;
                uint32_t corner[4];
                for (int a = 0; a < 4; a++)
                    corner[a] = z->listed[of->point_begin + z->zones.corner[a][row]];
                if (z->zones.number[row] != TL_NO_ROW)
                    try_zone(s, corner);
            }
    }
}

/* Finds the zone of a node, at a place as gridpoints are or were made. */
static void put_in_zone(tl_model *m, size_t row, bool now, tl_vec3 place, tl_vec3 normal)
{
    tl_node_table *n = &m->elements->nodes;
    zone_search s = {m, &m->zones->mesh[m->bodies.mesh[n->body[row]] - 1], now, place, -INFINITY, {0}, {0}};
    if (tl_v3_norm2(normal) > 0)
        search_surface(&s, n->block[row], normal);
    if (!(s.best > -INFINITY))
        search_zones(&s, n->block[row]);
    for (int a = 0; a < 4; a++) {
        n->point[row][a] = s.corner[a] - s.mesh->point_begin;
        n->share[row][a] = s.weight[a];
    }
}

uint32_t tl_node_first_point(const tl_model *m, size_t row)
{
    const tl_node_table *n = &m->elements->nodes;
    const uint32_t body = n->body[row];
    if (body == TL_NO_ROW || !m->bodies.mesh[body])
        return TL_NO_ROW;
    return m->zones->mesh[m->bodies.mesh[body] - 1].point_begin;
}

/* The sum of its shares of a vector of the gridpoints. */
static tl_vec3 shared(const tl_node_table *n, size_t row, double *const column[3], uint32_t first)
{
    tl_vec3 sum = {0, 0, 0};
    for (int a = 0; a < 4; a++)
        sum = tl_v3_madd(sum, n->share[row][a], tl_columns_get(column, first + n->point[row][a]));
    return sum;
}

/* ---------------------------------------------------------------- nodes ------------------ */

bool tl_block_has_moved(const tl_model *m, uint32_t block)
{
    static const tl_base stays = {{0, 0, 0}, {1, 0, 0, 0}};
    const tl_mat3 turn = tl_m3_identity();
    const tl_base made = tl_block_made(m, block);
    const uint32_t body = m->blocks.body[block];
    const tl_pose *pose = &m->bodies.pose[body];
    return m->bodies.mesh[body] || tl_v3_norm2(pose->u) > 0 || memcmp(&pose->r, &turn, sizeof turn) != 0 ||
           memcmp(&made, &stays, sizeof stays) != 0;
}

void tl_node_install(tl_model *m, size_t row, tl_vec3 place, tl_vec3 normal)
{
    tl_node_table *n = &m->elements->nodes;
    const uint32_t block = n->block[row] == TL_NO_ID ? TL_NO_ROW : tl_block_row_quiet(m, n->block[row]);
    tl_columns_put(n->rest, row, place);
    n->body[row] = TL_NO_ROW;
    if (block == TL_NO_ROW)
        return;
    const uint32_t body = n->body[row] = m->blocks.body[block];
    const tl_vec3 x_ref = m->bodies.pose[body].x_ref;
    const tl_base made = tl_block_made(m, block);
    const tl_mat3 turn = tl_q_matrix(made.turn);
    const uint32_t first = tl_node_first_point(m, row);
    tl_vec3 begun = place;
    if (first != TL_NO_ROW) {
        put_in_zone(m, row, true, place, normal);
        begun = shared(n, row, m->zones->points.ref, first);
    }
    const tl_vec3 local = local_of(m, body, tl_v3_sub(begun, x_ref));
    const tl_vec3 base = first != TL_NO_ROW ? shared(n, row, m->zones->points.u, first) : begun_of(m, body, local);
    tl_columns_put(n->local, row, local);
    if (n->base[0])
        tl_columns_put(n->base, row, base);
    const tl_vec3 moved = first != TL_NO_ROW ? tl_v3_add(base, begun_of(m, body, local)) : base;
    if (n->from[0])
        tl_columns_put(n->from, row, tl_v3_sub(moved, made_of(made, local)));
    const tl_vec3 own = tl_m3_tmul(&m->bodies.pose[body].r, normal);
    if (n->outward[0])
        tl_columns_put(n->outward, row, tl_m3_mul(&turn, own));
    if (n->normal[0])
        tl_columns_put(n->normal, row, own);
}

void tl_node_reframe(tl_model *m, size_t row, uint32_t block)
{
    tl_node_table *n = &m->elements->nodes;
    const uint32_t body = n->body[row] = m->blocks.body[block];
    const tl_vec3 x_ref = m->bodies.pose[body].x_ref, from = tl_node_from(n, row);
    const tl_base made = tl_block_made(m, block);
    const tl_mat3 turn = tl_q_matrix(made.turn);
    const tl_vec3 began = tl_v3_sub(tl_v3_sub(tl_columns_get(n->rest, row), from), x_ref);
    const tl_vec3 local = tl_m3_tmul(&turn, tl_v3_sub(began, made.shift));
    const tl_vec3 normal = tl_m3_tmul(&turn, tl_node_outward(n, row));
    tl_vec3 base = tl_v3_add(made_of(made, local), from);
    tl_columns_put(n->local, row, local);
    if (n->normal[0])
        tl_columns_put(n->normal, row, normal);
    if (tl_node_first_point(m, row) != TL_NO_ROW) {
        const tl_body_mesh *mesh = &m->zones->mesh[m->bodies.mesh[body] - 1];
        const tl_mat3 begun = tl_q_matrix(mesh->made_q);
        const tl_vec3 at = begun_of(m, body, local);
        put_in_zone(m, row, false, tl_v3_add(x_ref, at), tl_m3_mul(&begun, normal));
        base = tl_v3_sub(base, at);
    }
    if (n->base[0])
        tl_columns_put(n->base, row, base);
}

tl_vec3 tl_node_moved(const tl_model *m, size_t row)
{
    const tl_node_table *n = &m->elements->nodes;
    const uint32_t body = n->body[row];
    if (body == TL_NO_ROW)
        return tl_columns_get(n->u, row); /* the ground, or where its block went */
    const uint32_t first = tl_node_first_point(m, row);
    const tl_vec3 now = first != TL_NO_ROW ? shared(n, row, m->zones->points.u, first)
                                           : begun_of(m, body, tl_columns_get(n->local, row));
    return tl_v3_sub(now, tl_columns_get(tl_node_bases(n), row));
}

tl_vec3 tl_node_normal(const tl_model *m, size_t row)
{
    const tl_node_table *n = &m->elements->nodes;
    const uint32_t body = n->body[row], first = tl_node_first_point(m, row);
    double *const *own = tl_node_normals(n);
    const tl_vec3 normal = own[0] && body != TL_NO_ROW ? tl_columns_get(own, row) : tl_v3(0, 0, 0);
    if (tl_v3_norm2(normal) == 0)
        return tl_v3(0, 0, 0);
    if (first == TL_NO_ROW)
        return tl_m3_mul(&m->bodies.pose[body].r, normal);
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 o = tl_gridpoint_place(p, first + n->point[row][0]);
    return tl_v3_unit(tl_v3_cross(tl_v3_sub(tl_gridpoint_place(p, first + n->point[row][1]), o),
                                  tl_v3_sub(tl_gridpoint_place(p, first + n->point[row][2]), o)));
}
