/* meshes.c - the mesh of a deformable body as a whole: what bears and moves it, and whether it rests.
 *
 * Internal forces of a mesh cancel. So the sum over its gridpoints tells what acts on the body, as that of a rigid one.
 * A mesh swings more softly than one of its gridpoints by far. So at rest its kinetic energy is compared over the whole
 * of it:
 *
 *     sum m v.v / 2  <  the smaller of ratio and 1000 ratio^2, times sum B^2 / (2 k)
 *
 * with the mass that the step moves. In a relaxation that is more than the mesh weighs. */
#include "cycle/meshes.h"

#include "base/parallel.h"
#include "cycle/gridpoint.h"
#include "cycle/loose.h"
#include "geometry/polar.h"

#include <math.h>

const tl_body_mesh *tl_mesh_of_body(const tl_model *m, uint32_t body)
{
    return m->zones && m->bodies.mesh[body] ? &m->zones->mesh[m->bodies.mesh[body] - 1] : NULL;
}

/* Adds m (r.r - r r^T). */
static void add_inertia(tl_mat3 *sum, double mass, tl_vec3 r)
{
    const double at[3] = {r.x, r.y, r.z}, square = tl_v3_norm2(r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum->m[i][j] += mass * ((i == j ? square : 0) - at[i] * at[j]);
}

tl_mesh_whole tl_mesh_whole_of(const tl_model *m, const tl_body_mesh *mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    const double gravity = tl_v3_norm(m->config.gravity);
    const tl_vec3 centre = tl_body_place(&m->bodies, mesh->row);
    tl_mesh_whole out = {.weight = 0};
    tl_mat3 inertia = {{{0}}};
    tl_vec3 spin = {0, 0, 0};
    double mass = 0, energy = 0;
    for (size_t row = mesh->point_begin; row < mesh->point_end; row++) {
        const tl_vec3 force = tl_columns_get(p->force, row), v = tl_columns_get(p->v, row);
        const tl_vec3 free = tl_free_part(force, p->fixed[row]), arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        out.force = tl_v3_add(out.force, free);
        out.moment = tl_v3_add(out.moment, tl_v3_cross(arm, free));
        out.velocity = tl_v3_madd(out.velocity, p->mass[row], v);
        spin = tl_v3_madd(spin, p->mass[row], tl_v3_cross(arm, v));
        add_inertia(&inertia, p->mass[row], arm);
        out.borne += p->touched[row] + (p->fixed[row] ? tl_v3_norm(tl_v3_sub(force, free)) : 0);
        out.weight += tl_gridpoint_weight(p, row, gravity);
        out.power += tl_v3_dot(free, v);
        mass += p->mass[row];
        energy += p->mass[row] * tl_v3_norm2(v);
    }
    const tl_mat3 inverse = tl_m3_inverse(&inertia);
    out.velocity = tl_v3_scale(1 / mass, out.velocity);
    out.turn = tl_m3_mul(&inverse, spin);
    out.speed = sqrt(energy / mass);
    return out;
}

bool tl_body_is_free(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    if (!mesh)
        return m->bodies.fixed[body] != TL_FIX_ALL;
    size_t row = mesh->point_begin;
    while (row < mesh->point_end && tl_gridpoint_is_held(&m->zones->points, row))
        row++;
    return row < mesh->point_end;
}

double tl_body_speed(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    return mesh ? tl_mesh_whole_of(m, mesh).speed : tl_v3_norm(m->bodies.v[body]);
}

static void judge_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    for (size_t k = begin; k < end; k++) {
        const tl_mesh_whole of = tl_mesh_whole_of(m, &m->zones->mesh[k]);
        const double power = tl_v3_dot(of.force, of.velocity) + tl_v3_dot(of.moment, of.turn);
        const bool loose = tl_v3_norm(of.force) > TL_LOOSE * fmax(of.borne, of.weight); /* as loose.h */
        m->zones->motion[k] = (tl_mesh_motion){.velocity = of.velocity,
                                               .turn = of.turn,
                                               .power = power,
                                               .strain_power = of.power - power,
                                               .loose = m->cycle->settling.calm && loose};
    }
}

void tl_meshes_judge(tl_model *m)
{
    struct tl_zones *z = m->zones;
    tl_exact *sum = &m->cycle->gathered[0].sum[TL_SUM_POWER];
    tl_parallel_for(m->pool, z->mesh_count, 1, judge_range, m);
    for (size_t k = 0; k < z->mesh_count; k++)
        if (!z->motion[k].loose)
            tl_exact_add(sum, &z->motion[k].power, 1);
}

uint32_t tl_mesh_moving(const tl_model *m, double share)
{
    const double gravity = tl_v3_norm(m->config.gravity);
    uint32_t out = TL_NO_ROW;
    for (size_t k = 0; m->zones && k < m->zones->mesh_count; k++) {
        const tl_gridpoints *p = &m->zones->points;
        const tl_body_mesh *mesh = &m->zones->mesh[k];
        double kinetic = 0, stored = 0;
        for (size_t row = mesh->point_begin; row < mesh->point_end; row++) {
            const double mass = p->mass[row] * tl_gridpoint_scale(m, row), bears = tl_gridpoint_borne(m, row, gravity);
            kinetic += 0.5 * mass * tl_v3_norm2(tl_free_part(tl_columns_get(p->v, row), p->fixed[row]));
            stored += p->holds[row] > 0 ? 0.5 * bears * bears / p->holds[row] : 0;
        }
        if (kinetic > 0 && !(kinetic < share * stored) && mesh->row < out)
            out = mesh->row;
    }
    return out;
}

double tl_mesh_yielding(const tl_model *m, const tl_body_mesh *mesh)
{
    const struct tl_zones *z = m->zones;
    size_t yielding = 0;
    for (uint32_t k = mesh->zone_begin; k < mesh->zone_end; k++)
        yielding += (z->zones.flags[z->row_of[k]] & (TL_ZONE_SHEAR | TL_ZONE_TENSION | TL_ZONE_JOINT)) != 0;
    return mesh->zone_end > mesh->zone_begin ? (double)yielding / (double)(mesh->zone_end - mesh->zone_begin) : 0;
}

tl_vec3 tl_gridpoint_strained(const tl_model *m, const tl_body_mesh *mesh, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_pose *pose = &m->bodies.pose[mesh->row];
    const tl_vec3 centre = tl_v3_add(pose->x_ref, mesh->made_u);
    const tl_mat3 before = tl_q_matrix(mesh->made_q);
    const tl_vec3 arm = tl_v3_sub(tl_columns_get(p->ref, row), centre);
    const tl_vec3 turned = tl_m3_mul(&pose->r, tl_m3_tmul(&before, arm));
    const tl_vec3 whole = tl_v3_add(tl_v3_sub(pose->u, mesh->made_u), tl_v3_sub(turned, arm));
    return tl_v3_sub(tl_columns_get(p->u, row), whole);
}
