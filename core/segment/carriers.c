/* carriers.c - zones bear contacts that are no segments: edges, corners, faces askew.
 *
 * The place of the contact lies in a zone with weights N. It moves with that, x = sum N_a x_a, and the shape of the
 * block turns there with the zone: R = polar(F) R_0, with F from the edges as they were when the carrier began. A force
 * F and a moment M about the place act on the corners of the zone with
 *
 *     f_a = N_a F + M x g_a / 2,    sum f_a = F,    sum (x_a - x) x f_a = M
 *
 * the transpose of the zone's own motion: velocity at x, and half its curl. So work and energy agree to the first order
 * in strain. Where the place runs out of the zone, another one takes over with the pose as it is. */
#include "segment/carriers.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "contact/kind.h"
#include "contact/sides.h"
#include "contact/store.h"
#include "force/joint_laws.h"
#include "geometry/polar.h"
#include "segment/blend.h"
#include "zone/grid.h"

#include <math.h>

/* Tolerance: weight below which a place has run out of its zone. */
#define OUTSIDE (-0.75)

/* ---------------------------------------------------------------- zones ------------------ */

/* The first gridpoint of the body of a side. */
static uint32_t first_point(const tl_model *m, uint32_t contact, int side)
{
    const tl_contacts *c = &m->detect->contacts;
    const uint32_t body = m->blocks.body[(side ? c->b : c->a)[contact]];
    return m->zones->mesh[m->bodies.mesh[body] - 1].point_begin;
}

/* Where the corners of a zone are, by their numbers in a mesh that begins with row `first`. */
static void corners_of(const tl_model *m, uint32_t first, const uint32_t point[4], tl_vec3 x[4])
{
    for (int a = 0; a < 4; a++)
        x[a] = tl_gridpoint_place(&m->zones->points, first + point[a]);
}

/* Edges from the first corner, as columns. */
static tl_mat3 edges_of(const tl_vec3 x[4])
{
    const tl_vec3 a = tl_v3_sub(x[1], x[0]), b = tl_v3_sub(x[2], x[0]), c = tl_v3_sub(x[3], x[0]);
    return (tl_mat3){{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
}

/* Weights of a place between corners. */
static void weigh(const tl_vec3 x[4], tl_vec3 place, double weight[4])
{
    const tl_mat3 edges = edges_of(x), inverse = tl_m3_inverse(&edges);
    const tl_vec3 w = tl_m3_mul(&inverse, tl_v3_sub(place, x[0]));
    weight[0] = 1 - w.x - w.y - w.z;
    weight[1] = w.x;
    weight[2] = w.y;
    weight[3] = w.z;
}

static double least_of(const double weight[4])
{
    return fmin(fmin(weight[0], weight[1]), fmin(weight[2], weight[3]));
}

/* The zone at the surface of a block that a place lies in, or the least outside of. A block inside of its body has
 * none: then that of another block. */
static void find_zone(const tl_model *m, tl_id block, tl_vec3 place, uint32_t point[4], double weight[4])
{
    const struct tl_zones *z = m->zones;
    const tl_body_mesh *mesh = &z->mesh[tl_mesh_of(m, block)];
    double best = -INFINITY;
    bool own_surface = false;
    for (uint32_t k = mesh->part_begin; k < mesh->part_end; k++)
        own_surface = own_surface || z->part[k].block == block;
    for (uint32_t k = mesh->part_begin; k < mesh->part_end; k++) {
        const tl_surface_part *part = &z->part[k];
        const uint32_t own[4] = {part->apex - mesh->point_begin, part->corner[0] - mesh->point_begin,
                                 part->corner[1] - mesh->point_begin, part->corner[2] - mesh->point_begin};
        tl_vec3 x[4];
        double w[4];
        if (own_surface && part->block != block)
            continue;
        corners_of(m, mesh->point_begin, own, x);
        weigh(x, place, w);
        if (!(least_of(w) > best))
            continue;
        best = least_of(w);
        for (int a = 0; a < 4; a++) {
            point[a] = own[a];
            weight[a] = w[a];
        }
    }
}

/* ---------------------------------------------------------------- begin ------------------ */

/* The place at which a field contact presses, from the model's origin. */
static tl_vec3 place_of(const tl_model *m, uint32_t contact)
{
    const uint32_t a = tl_contact_sides(m, contact).a;
    return tl_v3_add(tl_side_place(m, a), tl_side_arm(m, a, tl_press_row_of(m, contact)->press.point));
}

/* Lets a zone carry a side of a contact, whose pose goes on as it is. */
static void begin(tl_model *m, uint32_t contact, int side, tl_vec3 place)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_sides sides = tl_contact_sides(m, contact);
    const uint32_t of = side ? sides.b : sides.a, body = tl_side_body(m, of);
    tl_carrier *by = &c->carrier[side][contact];
    tl_carrier next = {.pose = *tl_side_pose(m, of), .q = tl_side_quaternion(m, of), .on = 1};
    tl_vec3 x[4];
    next.v = tl_side_velocity(m, of, tl_v3(0, 0, 0));
    next.w = by->on ? by->w : m->bodies.w[body];
    next.odometer = by->on ? by->odometer : m->bodies.odometer[body];
    next.at = tl_side_local(m, of, place);
    next.begun = next.pose.r;
    find_zone(m, m->blocks.id[(side ? c->b : c->a)[contact]], place, next.point, next.weight);
    corners_of(m, first_point(m, contact, side), next.point, x);
    const tl_mat3 edges = edges_of(x);
    next.edges = tl_m3_inverse(&edges);
    *by = next;
}

/* Whether the place has run out of the zone that carries a side. */
static bool has_left(const tl_model *m, uint32_t first, const tl_carrier *by, tl_vec3 place)
{
    tl_vec3 x[4];
    double weight[4];
    corners_of(m, first, by->point, x);
    weigh(x, place, weight);
    return least_of(weight) < OUTSIDE && least_of(weight) < least_of(by->weight) - 0.25;
}

bool tl_carriers_begin(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    if (!tl_model_deforms(m) || c->table.rows == 0)
        return true;
    if (!tl_detect_hold_carriers(m->detect))
        return false;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        const bool carried = c->point_count[i] > 0 && tl_facet_is_field(&c->facet[i]);
        for (int side = 0; side < 2; side++) {
            if (!tl_block_deforms(m, (side ? c->b : c->a)[i]))
                continue;
            tl_carrier *by = &c->carrier[side][i];
            if (!carried)
                by->on = 0;
            else if (!by->on || has_left(m, first_point(m, i, side), by, place_of(m, i)))
                begin(m, i, side, place_of(m, i));
        }
    }
    tl_blends_share(m);
    return true;
}

/* ---------------------------------------------------------------- motion ----------------- */

static void follow(const tl_model *m, uint32_t first, tl_carrier *by, double dt)
{
    tl_vec3 x[4], place = {0, 0, 0};
    corners_of(m, first, by->point, x);
    for (int a = 0; a < 4; a++)
        place = tl_v3_madd(place, by->weight[a], x[a]);
    const tl_mat3 edges = edges_of(x), f = tl_m3_product(&edges, &by->edges), turn = tl_m3_polar(&f);
    const tl_mat3 r = tl_m3_product(&turn, &by->begun);
    const tl_quat q = tl_q_of_matrix(&r), made = tl_q_mul(q, tl_q_conj(by->q));
    const tl_vec3 u = tl_v3_sub(tl_v3_sub(place, tl_m3_mul(&r, by->at)), by->pose.x_ref);
    const tl_vec3 way = tl_v3_sub(u, by->pose.u), turned = tl_q_vector(made);
    by->v = by->pose.v_moved = tl_v3_scale(dt > 0 ? 1 / dt : 0, way);
    by->w = by->pose.w_moved = tl_v3_scale(dt > 0 ? 1 / dt : 0, turned);
    by->pose.u = u;
    by->pose.r = r;
    by->q = q;
}

void tl_carriers_follow(tl_model *m, double dt)
{
    tl_contacts *c = m->detect ? &m->detect->contacts : NULL;
    for (uint32_t i = 0; c && c->carrier[0] && i < c->table.rows; i++)
        for (int side = 0; side < 2; side++) {
            tl_carrier *by = &c->carrier[side][i];
            if (!by->on)
                continue;
            follow(m, first_point(m, i, side), by, dt);
            const double radius = tl_side_radius(m, TL_CARRIED | (2 * i + (uint32_t)side));
            by->odometer += dt * (tl_v3_norm(by->v) + tl_v3_norm(by->w) * radius);
        }
}

/* ---------------------------------------------------------------- forces ----------------- */

/* The forces on the corners of a zone of a force and a moment about the place of its carrier. */
static void corner_forces(const tl_model *m, uint32_t first, const tl_carrier *by, tl_vec3 force, tl_vec3 moment,
                          tl_vec3 out[4])
{
    tl_vec3 x[4];
    corners_of(m, first, by->point, x);
    const tl_mat3 edges = edges_of(x), inverse = tl_m3_inverse(&edges);
    tl_vec3 g[4] = {{0, 0, 0}};
    for (int a = 1; a < 4; a++) {
        g[a] = tl_v3(inverse.m[a - 1][0], inverse.m[a - 1][1], inverse.m[a - 1][2]);
        g[0] = tl_v3_sub(g[0], g[a]);
    }
    for (int a = 0; a < 4; a++)
        out[a] = tl_v3_madd(tl_v3_scale(0.5, tl_v3_cross(moment, g[a])), by->weight[a], force);
}

/* The forces of a contact on the corners of the zone that bears a side; of a force on B and a moment about A. */
static void side_forces(const tl_model *m, uint32_t contact, int side, tl_vec3 on_b, tl_vec3 about_a, tl_vec3 out[4])
{
    const tl_carrier *by = &m->detect->contacts.carrier[side][contact];
    const tl_vec3 force = tl_v3_scale(side ? 1 : -1, on_b);
    const tl_vec3 arm = tl_m3_mul(&by->pose.r, by->at); /* from the carrier's centroid to the place */
    const tl_vec3 moment = tl_contact_moment_of(m, contact, side, on_b, about_a);
    corner_forces(m, first_point(m, contact, side), by, force, tl_v3_sub(moment, tl_v3_cross(arm, force)), out);
}

void tl_carriers_push(tl_model *m)
{
    const tl_contacts *c = m->detect ? &m->detect->contacts : NULL;
    for (uint32_t i = 0; c && c->carrier[0] && i < c->table.rows; i++)
        for (int side = 0; side < 2; side++) {
            const tl_carrier *by = &c->carrier[side][i];
            if (!by->on)
                continue;
            tl_gridpoints *p = &m->zones->points;
            tl_vec3 f[4];
            side_forces(m, i, side, c->force[i], c->moment[i], f);
            for (int a = 0; a < 4; a++) {
                const uint32_t row = first_point(m, i, side) + by->point[a];
                tl_columns_put(p->force, row, tl_v3_add(tl_columns_get(p->force, row), f[a]));
                p->bears[row] += tl_v3_norm(f[a]);
                p->touched[row] += tl_v3_norm(f[a]);
            }
        }
}

void tl_carriers_damp(tl_model *m, const tl_wrench *damping)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_gridpoints *p = &m->zones->points;
    for (uint32_t i = 0; c->carrier[0] && i < c->table.rows; i++)
        for (int side = 0; side < 2; side++) {
            const tl_carrier *by = &c->carrier[side][i];
            tl_vec3 f[4];
            if (!by->on)
                continue;
            side_forces(m, i, side, damping[i].force, damping[i].moment, f);
            for (int a = 0; a < 4; a++) {
                const uint32_t row = first_point(m, i, side) + by->point[a];
                tl_columns_put(p->damping, row, tl_v3_add(tl_columns_get(p->damping, row), f[a]));
            }
        }
}

void tl_carriers_stiffen(tl_model *m)
{
    const tl_contacts *c = m->detect ? &m->detect->contacts : NULL;
    for (uint32_t i = 0; c && c->carrier[0] && i < c->table.rows; i++)
        for (int side = 0; side < 2; side++) {
            const tl_carrier *by = &c->carrier[side][i];
            if (!by->on || c->law[i] == TL_NO_ROW)
                continue;
            const tl_spread on = tl_contact_kind_of(m->detect, i)->place->bounds(m, i, side);
            const double k = tl_law_stiffness(&m->joint_laws[c->law[i]]) * on.sum;
            double all = 0;
            for (int a = 0; a < 4; a++)
                all += fabs(by->weight[a]);
            const uint32_t first = first_point(m, i, side);
            for (int a = 0; a < 4; a++)
                m->zones->points.holds[first + by->point[a]] += 2 * k * all * fabs(by->weight[a]);
        }
}

const char *tl_carriers_unsound(const tl_model *m)
{
    const tl_contacts *c = m->detect ? &m->detect->contacts : NULL;
    for (uint32_t i = 0; c && c->carrier[0] && i < c->table.rows; i++)
        for (int side = 0; side < 2; side++) {
            const tl_carrier *by = &c->carrier[side][i];
            /* contacts have the rows that blocks had when the detection last looked; some may have gone */
            const tl_id block = m->detect->known_blocks[(side ? c->b : c->a)[i]].id;
            const uint32_t row = tl_block_row_quiet(m, block);
            if (!by->on || row == TL_NO_ROW)
                continue;
            if (by->on != 1 || !tl_block_deforms(m, row))
                return "a contact is carried by a block without zones";
            const tl_body_mesh *mesh = &m->zones->mesh[m->bodies.mesh[m->blocks.body[row]] - 1];
            for (int a = 0; a < 4; a++)
                if (by->point[a] >= mesh->point_end - mesh->point_begin)
                    return "a contact is carried by an impossible gridpoint";
        }
    return NULL;
}
