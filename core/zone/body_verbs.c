/* body_verbs.c - what verbs on blocks do to the gridpoints of deformable bodies.
 *
 * A load at a point acts on the zone there, which has weights N_a at the point and gradients g_a of them:
 *
 *     f_a = N_a F + M x g_a / 2,    sum f_a = F,    the moment of f_a about the point is M
 *
 * Without a point it acts on all gridpoints by their masses m_a. Their arms from their mean by mass are r_a, and J is
 * the sum of m_a (r_a.r_a I - r_a r_a^T):
 *
 *     f_a = m_a (F / sum m + J^-1 M x r_a)
 *
 * Either is found once, where the block is now: the forces stay and go with their gridpoints. */
#include "zone/body_verbs.h"

#include "base/columns.h"
#include "base/error.h"
#include "geometry/polar.h"
#include "zone/columns.h"
#include "zone/follow.h"
#include "zone/held.h"
#include "zone/outer.h"
#include "zone/resolid.h"

#include <math.h>

/* Tolerance: least weight at which a point still lies in a block whose faces have bent: a loaded point. */
#define OUTSIDE (-0.05)

#define ALL (TL_FIX_X | TL_FIX_Y | TL_FIX_Z)

static const tl_body_mesh *mesh_of(const tl_model *m, uint32_t body)
{
    return &m->zones->mesh[m->bodies.mesh[body] - 1];
}

/* ---------------------------------------------------------------- motion ----------------- */

tl_vec3 tl_mesh_velocity(const tl_model *m, uint32_t mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *of = &m->zones->mesh[mesh];
    tl_vec3 sum = {0, 0, 0};
    double mass = 0;
    for (uint32_t row = of->point_begin; row < of->point_end; row++) {
        sum = tl_v3_madd(sum, p->mass[row], tl_columns_get(p->v, row));
        mass += p->mass[row];
    }
    return tl_v3_scale(1 / mass, sum);
}

static void move(tl_model *m, uint32_t body, tl_vec3 velocity, tl_vec3 angular_velocity)
{
    const tl_body_mesh *of = mesh_of(m, body);
    tl_gridpoints *p = &m->zones->points;
    const tl_vec3 at = tl_body_place(&m->bodies, body);
    const bool moves = !isnan(velocity.x), turns = !isnan(angular_velocity.x);
    if (!moves && !turns)
        return;
    const tl_vec3 v = moves ? velocity : tl_mesh_velocity(m, (uint32_t)(of - m->zones->mesh));
    const tl_vec3 w = turns ? angular_velocity : tl_v3(0, 0, 0);
    for (uint32_t row = of->point_begin; row < of->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), at);
        tl_columns_put(p->v, row, tl_v3_add(v, tl_v3_cross(w, arm)));
    }
    m->zones->steps_kept = TL_STEPS_KEPT;
}

/* ---------------------------------------------------------------- holding ---------------- */

static void changed(tl_model *m)
{
    m->zones->rated_for = 0; /* others may be the stiffest that move */
    m->zones->steps_kept = TL_STEPS_KEPT;
}

static void fix(tl_model *m, uint32_t body, unsigned what)
{
    const tl_body_mesh *of = mesh_of(m, body);
    tl_gridpoints *p = &m->zones->points;
    for (uint32_t row = of->point_begin; row < of->point_end; row++) {
        tl_columns_put(p->v, row, tl_free_axes(tl_columns_get(p->v, row), what));
        p->fixed[row] = (uint8_t)(p->fixed[row] | (what & ALL));
    }
    changed(m);
}

static void let_go(tl_model *m, uint32_t body)
{
    tl_outer_let_go(m, m->bodies.mesh[body] - 1);
    changed(m);
}

static bool is_held(const tl_model *m, uint32_t body)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *of = mesh_of(m, body);
    bool held = true;
    for (uint32_t row = of->point_begin; held && row < of->point_end; row++)
        for (int k = 0; held && k < 3; k++)
            held = tl_v3_is_zero(tl_gridpoint_free_part(p, row, tl_v3(k == 0, k == 1, k == 2)));
    return held;
}

static void count_drives(tl_model *m)
{
    const struct tl_zones *z = m->zones;
    for (size_t row = 0; z && z->points.drive && row < z->points.table.rows; row++)
        if (z->points.drive[row])
            m->drives[z->points.drive[row] - 1].bodies++;
    for (size_t i = 0; z && i < z->outer_count; i++)
        if (z->outer[i].drive)
            m->drives[z->outer[i].drive - 1].bodies++;
}

void tl_mesh_reaction(const tl_model *m, uint32_t mesh, tl_vec3 *force)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *of = &m->zones->mesh[mesh];
    for (uint32_t row = of->point_begin; row < of->point_end; row++)
        *force = tl_v3_add(*force, tl_gridpoint_reaction(p, row));
}

/* ---------------------------------------------------------------- loads ------------------ */

/* The zone at a place: its gridpoints, edges and weights there. */
typedef struct zone_at {
    uint32_t point[4];
    tl_mat3 inverse; /* of the edges from the first corner: its rows are the gradients of the other three weights */
    double weight[4], least;
} zone_at;

static zone_at weigh(const tl_model *m, const tl_parcel *of, uint32_t row, tl_vec3 place)
{
    const struct tl_zones *z = m->zones;
    zone_at out;
    tl_vec3 x[4];
    for (int a = 0; a < 4; a++) {
        out.point[a] = z->listed[of->point_begin + z->zones.corner[a][row]];
        x[a] = tl_gridpoint_place(&z->points, out.point[a]);
    }
    const tl_vec3 a = tl_v3_sub(x[1], x[0]), b = tl_v3_sub(x[2], x[0]), c = tl_v3_sub(x[3], x[0]);
    const tl_mat3 edges = {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
    out.inverse = tl_m3_inverse(&edges);
    const tl_vec3 w = tl_m3_mul(&out.inverse, tl_v3_sub(place, x[0]));
    out.weight[0] = 1 - w.x - w.y - w.z;
    out.weight[1] = w.x;
    out.weight[2] = w.y;
    out.weight[3] = w.z;
    out.least = fmin(fmin(w.x, w.y), fmin(w.z, out.weight[0]));
    return out;
}

/* The zone of a body in which a place lies, or the least outside of. */
static zone_at find_zone(const tl_model *m, uint32_t body, tl_vec3 place)
{
    const struct tl_zones *z = m->zones;
    const tl_body_mesh *mesh = mesh_of(m, body);
    zone_at best = {.least = -INFINITY};
    for (uint32_t k = mesh->parcel_begin; k < mesh->parcel_end; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (uint32_t row = z->group[g].start; row < z->group[g].start + z->group[g].depth * (uint32_t)TL_LANES;
                 row++) {
                if (z->zones.number[row] == TL_NO_ROW)
                    continue;
                const zone_at at = weigh(m, of, row, place);
                if (at.least > best.least)
                    best = at;
            }
    }
    return best;
}

static tl_status check_load(tl_model *m, uint32_t body, const tl_load *load)
{
    if (!isnan(load->at.x)) {
        const tl_vec3 place = tl_v3_sub(load->at, m->origin);
        if (find_zone(m, body, place).least < OUTSIDE)
            return tl_fail(&m->error, TL_E_ARGUMENT,
                           "load: {%g, %g, %g} lies in no zone of block %u, which is deformable; give a point of the "
                           "block, or none",
                           load->at.x, load->at.y, load->at.z, m->bodies.id[body]);
    }
    return TL_OK;
}

static bool hold_loads(tl_model *m)
{
    return tl_gridpoints_hold_loads(&m->zones->points);
}

/* Puts a load on the zone at its point. */
static void load_zone(tl_model *m, uint32_t body, const tl_load *load)
{
    tl_gridpoints *p = &m->zones->points;
    const zone_at at = find_zone(m, body, tl_v3_sub(load->at, m->origin));
    tl_vec3 gradient[4] = {{0, 0, 0}};
    for (int a = 1; a < 4; a++) {
        gradient[a] = tl_v3(at.inverse.m[a - 1][0], at.inverse.m[a - 1][1], at.inverse.m[a - 1][2]);
        gradient[0] = tl_v3_sub(gradient[0], gradient[a]);
    }
    for (int a = 0; a < 4; a++) {
        const tl_vec3 turning = tl_v3_scale(0.5, tl_v3_cross(load->moment, gradient[a]));
        tl_columns_put(p->load, at.point[a], tl_v3_madd(turning, at.weight[a], load->force));
    }
}

/* Puts a load on all gridpoints of a body, by mass. */
static void load_all(tl_model *m, uint32_t body, const tl_load *load)
{
    tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *of = mesh_of(m, body);
    const tl_vec3 centre = tl_body_place(&m->bodies, body);
    tl_mat3 inertia = {{{0}}};
    double mass = 0;
    for (uint32_t row = of->point_begin; row < of->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        const double r[3] = {arm.x, arm.y, arm.z}, r2 = tl_v3_norm2(arm);
        mass += p->mass[row];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                inertia.m[i][j] += p->mass[row] * ((i == j ? r2 : 0) - r[i] * r[j]);
    }
    const tl_mat3 inverse = tl_m3_inverse(&inertia);
    const tl_vec3 turn = tl_m3_mul(&inverse, load->moment);
    for (uint32_t row = of->point_begin; row < of->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        const tl_vec3 force = tl_v3_madd(tl_v3_cross(turn, arm), 1 / mass, load->force);
        tl_columns_put(p->load, row, tl_v3_scale(p->mass[row], force));
    }
}

static void load(tl_model *m, uint32_t body, const tl_load *given)
{
    tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *of = mesh_of(m, body);
    for (uint32_t row = of->point_begin; row < of->point_end; row++)
        tl_columns_put(p->load, row, tl_v3(0, 0, 0));
    if (isnan(given->at.x))
        load_all(m, body, given);
    else
        load_zone(m, body, given);
}

const tl_zone_verbs tl_zone_body_verbs = {.follow = tl_zones_follow,
                                          .check_load = check_load,
                                          .hold_loads = hold_loads,
                                          .load = load,
                                          .fix = fix,
                                          .free = let_go,
                                          .is_held = is_held,
                                          .move = move,
                                          .count_drives = count_drives,
                                          .resolid = tl_blocks_resolid};
