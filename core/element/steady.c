/* steady.c - forces that depend on places alone are kept while bodies hardly move.
 *
 * A kind says so (`steady`). Let F and M be the sums over the nodes of a rigid body, in its own frame. They turn with
 * it: at the rotation R they are R F and R M. All such elements are asked for their forces again when one of their
 * bodies has gone farther than FAR of its size. Every LOOK_EVERY steps, and in a relaxation, it is STEADY of it. No
 * model is at rest while a body has gone farther than that. So forces at rest are exact, and what moves does not ask in
 * every step. Their nodes then first get places and forces of the last step. So what a kind books is the work of one
 * step.
 *
 * The work of a step is the sum over the nodes of the mean force times the motion. From the pose u0, R0 to u1, R1 it is
 *
 *     W = (R0 F + R1 F) . (u1 - u0) / 2 + M . a,    a = axial part of R0^t R1 = n sin(angle)
 *
 * for the terms f . p of the ends cancel. With rows a_k of R0 and b_k of R1, a = -sum a_k x b_k. This is exact, so the
 * ledger closes to rounding. */
#include "element/steady.h"

#include "base/columns.h"

#include <string.h>

/* Tolerance: way of a body over its radius, along its path, for which forces are kept. Pressures are off by that of a
 * head of this share of the radius. Test: lua/test_steady_water. */
#define STEADY 1e-6
/* Tolerance: the same in the steps between. Test: lua/test_steady_water. */
#define FAR 1e-4
/* Constant: steps from one look by STEADY to the next. So long may pressures be off by FAR. */
#define LOOK_EVERY 64

bool tl_steady_fit(tl_model *m)
{
    tl_steady_table *s = &m->elements->steady;
    const size_t rows = m->elements->any_steady ? m->bodies.table.rows : 0;
    if (s->table.rows == rows)
        return true;
    tl_table_resize(&s->table, 0);
    if (!tl_table_resize(&s->table, rows))
        return false;
    if (rows > 0)
        memset(s->held, 0, rows * sizeof *s->held);
    return true;
}

static bool has_some(const struct tl_elements *e, uint32_t body)
{
    return e->steady_start[body] < e->use_start[body + 1];
}

static tl_vec3 row_of(const tl_mat3 *r, int k)
{
    return tl_v3(r->m[k][0], r->m[k][1], r->m[k][2]);
}

/* Takes what is kept on a body on to where it is now. Returns the work on the way, J. */
static double take_on(tl_steady_table *s, uint32_t body, const tl_pose *now)
{
    const tl_mat3 *before = &s->turn[body];
    const tl_vec3 force = tl_m3_mul(&now->r, s->force[body]), f = tl_v3_add(s->acts[body], force);
    tl_vec3 a = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        a = tl_v3_add(a, tl_v3_cross(row_of(&now->r, k), row_of(before, k)));
    const double work = 0.5 * (tl_v3_dot(f, tl_v3_sub(now->u, s->at[body])) + tl_v3_dot(s->moment[body], a));
    s->acts[body] = force;
    s->turns[body] = tl_m3_mul(&now->r, s->moment[body]);
    s->at[body] = now->u;
    s->turn[body] = now->r;
    return work;
}

/* Whether some body has gone farther than `way` of its size since its forces were asked for. */
static bool has_gone(const tl_model *m, double way)
{
    const tl_steady_table *s = &m->elements->steady;
    for (uint32_t body = 0; body < s->table.rows; body++)
        if (has_some(m->elements, body) &&
            (!s->held[body] || m->bodies.odometer[body] - s->odometer[body] > way * m->bodies.radius[body]))
            return true;
    return false;
}

bool tl_steady_is_exact(const tl_model *m)
{
    return !m->elements || !m->elements->any_steady || !has_gone(m, STEADY);
}

bool tl_steady_keeps(tl_model *m)
{
    struct tl_elements *e = m->elements;
    tl_steady_table *s = &e->steady;
    const double way = m->relaxing || m->cycles % LOOK_EVERY == 0 ? STEADY : FAR;
    if (has_gone(m, way))
        return false;
    for (uint32_t body = 0; body < s->table.rows; body++) {
        if (has_some(e, body))
            s->given[body] = take_on(s, body, &m->bodies.pose[body]);
    }
    return true;
}

void tl_steady_bring(tl_model *m)
{
    struct tl_elements *e = m->elements;
    tl_steady_table *s = &e->steady;
    tl_node_table *n = &e->nodes;
    for (uint32_t body = 0; body < s->table.rows; body++) {
        s->given[body] = 0;
        for (uint32_t k = e->steady_start[body]; s->held[body] && k < e->use_start[body + 1]; k++) {
            const uint32_t row = e->use[k];
            const tl_vec3 arm = tl_m3_mul(&s->turn[body], tl_columns_get(n->local, row));
            const tl_vec3 f = tl_m3_tmul(&s->from[body], tl_columns_get(n->force, row));
            tl_columns_put(n->u, row, tl_v3_sub(tl_v3_add(s->at[body], arm), tl_columns_get(tl_node_bases(n), row)));
            tl_columns_put(n->force, row, tl_m3_mul(&s->turn[body], f));
        }
    }
}

void tl_steady_take(tl_model *m)
{
    struct tl_elements *e = m->elements;
    tl_steady_table *s = &e->steady;
    for (uint32_t body = 0; body < s->table.rows; body++) {
        const tl_pose *now = &m->bodies.pose[body];
        tl_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
        double magnitude = 0;
        for (uint32_t k = e->steady_start[body]; k < e->use_start[body + 1]; k++) {
            const tl_vec3 world = tl_columns_get(e->nodes.force, e->use[k]), f = tl_m3_tmul(&now->r, world);
            force = tl_v3_add(force, f);
            moment = tl_v3_add(moment, tl_v3_cross(tl_columns_get(e->nodes.local, e->use[k]), f));
            magnitude += tl_v3_norm(world);
        }
        s->force[body] = force;
        s->moment[body] = moment;
        s->magnitude[body] = magnitude;
        s->acts[body] = tl_m3_mul(&now->r, force);
        s->turns[body] = tl_m3_mul(&now->r, moment);
        s->at[body] = now->u;
        s->turn[body] = s->from[body] = now->r;
        s->odometer[body] = m->bodies.odometer[body];
        s->held[body] = 1;
    }
}

void tl_steady_let_go(tl_model *m)
{
    struct tl_elements *e = m->elements;
    if (e->any_steady && tl_elements_are_listed(m) && e->steady.table.rows == m->bodies.table.rows)
        tl_steady_bring(m);
    if (e->steady.table.rows > 0)
        memset(e->steady.held, 0, e->steady.table.rows * sizeof *e->steady.held);
}

bool tl_steady_add(const tl_model *m, uint32_t body, tl_acting *on)
{
    const struct tl_elements *e = m->elements;
    const tl_steady_table *s = &e->steady;
    if (!e->any_steady || body >= s->table.rows || !s->held[body])
        return false;
    if (!has_some(e, body))
        return true;
    on->force = tl_v3_add(on->force, s->acts[body]);
    on->moment = tl_v3_add(on->moment, s->turns[body]);
    on->magnitude += s->magnitude[body];
    return true;
}

double tl_steady_given(const tl_model *m)
{
    const tl_steady_table *s = &m->elements->steady;
    double sum = 0;
    for (size_t body = 0; m->elements->any_steady && body < s->table.rows; body++)
        sum += s->given[body];
    return sum;
}
