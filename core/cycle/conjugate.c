/* conjugate.c - leaps of many bodies: along ways that are conjugate to each other.
 *
 * Conjugate gradients with the scaled inertia M as preconditioner, made of steps: each leap is one iteration, and the
 * stiffness K of the whole is known only by the forces before and after it (R. Fletcher and C. M. Reeves, The Computer
 * Journal 7 (1964) 149-154). With F the unbalanced forces, d the way and a the length that was tried along it,
 *
 *     K d = (F_before - F - c K d_before) / a       c: what the last leap went along the way before
 *     l = a + F.d / d.K d                           the length that was right
 *     F' = F - (l - a) K d                          what forces will be there
 *     d' = M^-1 F' + b d,   b = -M^-1 F'.K d / d.K d
 *     motion = (l - a) d + a' d'                    a' = UNDER l
 *
 * So a leap makes up for what the last one lacked, and no step is spent on finding a length. A little less than the
 * last length is tried: going back would turn slip around. The cost of a leap is that of a step, however many bodies
 * there are. */
#include "cycle/conjugate.h"

#include "base/columns.h"
#include "base/parallel.h"
#include "cycle/secants.h"

#include <math.h>
#include <string.h>

/* Tolerance: length of a leap over dt^2 at first; over that which would have been right in the last one; and the
 * largest change of it from leap to leap. */
#define FIRST_LENGTH 0.5
#define UNDER 0.9
#define LENGTH_GROWTH 2.0
/* Tolerance: length that was right over the one tried below which a way was none to go on from. */
#define SHORTEST 0.1

bool tl_conjugate_prepare(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const size_t bodies = m->bodies.table.rows;
    return tl_grow(&c->conjugate, &c->conjugate_capacity, bodies, sizeof *c->conjugate) &&
           tl_fit(&c->leap, &c->leap_capacity, bodies, sizeof *c->leap);
}

void tl_conjugate_begin(tl_model *m)
{
    m->cycle->conjugate_count = 0;
    m->cycle->settling.length = m->cycle->settling.made_up = 0;
}

/* The turn that a moment gives the scaled inertia. */
static tl_vec3 turned_by(const tl_model *m, uint32_t body, tl_vec3 moment)
{
    const tl_quat to_model = tl_q_mul(m->bodies.q[body], m->bodies.axes[body]);
    const tl_vec3 moments = tl_moments_of(m, body), own = tl_q_rotate(tl_q_conj(to_model), moment);
    const double per = 1 / tl_turn_scale(m->cycle, body);
    return tl_q_rotate(to_model, tl_v3(per * own.x / moments.x, per * own.y / moments.y, per * own.z / moments.z));
}

static double product(tl_vec3 force, tl_vec3 way, tl_vec3 moment, tl_vec3 turn)
{
    return tl_v3_dot(force, way) + tl_v3_dot(moment, turn);
}

/* What a leap's ways have shown. */
typedef struct leap_search {
    tl_model *m;
    double per, made_up; /* 1 over the length tried, and what was made up for; per 0: there was no leap */
    double back;         /* what is to be made up for now */
} leap_search;

/* Finds what the last way does to the forces. */
static void learn_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const leap_search *s = user;
    const tl_bodies *b = &s->m->bodies;
    for (size_t body = begin; body < end; body++) {
        tl_conjugate *of = &s->m->cycle->conjugate[body];
        if (!(s->per > 0)) {
            const tl_vec3 none = {0, 0, 0};
            *of = (tl_conjugate){b->force[body], b->moment[body], none, none, none, none, none, none};
            continue;
        }
        const tl_vec3 force = tl_v3_sub(of->force, b->force[body]), moment = tl_v3_sub(of->moment, b->moment[body]);
        of->way_force = tl_v3_scale(s->per, tl_v3_madd(force, -s->made_up, of->way_force));
        of->turn_moment = tl_v3_scale(s->per, tl_v3_madd(moment, -s->made_up, of->turn_moment));
        of->force = b->force[body];
        of->moment = b->moment[body];
    }
}

/* Finds what the forces that are left give the inertia. */
static void precondition_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const leap_search *s = user;
    const tl_model *m = s->m;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        tl_conjugate *of = &m->cycle->conjugate[body];
        const unsigned fixed = m->bodies.fixed[body];
        if (fixed == TL_FIX_ALL)
            continue;
        const double per = 1 / (m->bodies.mass[body] * tl_inertia_scale(m->cycle, body));
        of->move = tl_v3_scale(per, tl_v3_madd(of->force, -s->back, of->way_force));
        of->spin = fixed & TL_FIX_ROTATION ? tl_v3(0, 0, 0)
                                           : turned_by(m, body, tl_v3_madd(of->moment, -s->back, of->turn_moment));
    }
}

/* The length that was right along the last way, within what is believed; 0: begin anew. */
static double right_length(const tl_model *m, double tried, double curve)
{
    tl_addends left = {.count = 0};
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        const tl_conjugate *of = &m->cycle->conjugate[body];
        tl_addends_put(&left, product(of->force, of->way, of->moment, of->turn));
    }
    const double right = curve > 0 ? tried + tl_addends_sum(&left) / curve : 0;
    return right > SHORTEST * tried ? fmin(right, LENGTH_GROWTH * tried) : 0;
}

static double curve_of(const tl_model *m)
{
    tl_addends curve = {.count = 0};
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        const tl_conjugate *of = &m->cycle->conjugate[body];
        tl_addends_put(&curve, product(of->way_force, of->way, of->turn_moment, of->turn));
    }
    return tl_addends_sum(&curve);
}

/* Share of the last way in the next one. */
static double share_of_last(const tl_model *m, double curve)
{
    tl_addends along = {.count = 0};
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        const tl_conjugate *of = &m->cycle->conjugate[body];
        tl_addends_put(&along, product(of->way_force, of->move, of->turn_moment, of->spin));
    }
    return fmax(0, -tl_addends_sum(&along) / curve);
}

/* Puts the motion, and the way that the next forces tell of. Nothing holds it. */
static void put_motion(tl_model *m, double share, double length, double back)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        tl_conjugate *of = &m->cycle->conjugate[body];
        double *x = m->cycle->leap[body].motion;
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        const tl_vec3 way = tl_v3_madd(of->move, share, of->way), turn = tl_v3_madd(of->spin, share, of->turn);
        const tl_vec3 go = tl_v3_madd(tl_v3_scale(back, of->way), length, way);
        const tl_vec3 spin = tl_v3_madd(tl_v3_scale(back, of->turn), length, turn);
        of->way = way;
        of->turn = turn;
        x[0] = go.x, x[1] = go.y, x[2] = go.z;
        x[3] = spin.x, x[4] = spin.y, x[5] = spin.z;
        memset(m->cycle->leap[body].hold, 0, sizeof m->cycle->leap[body].hold);
    }
}

void tl_conjugate_find(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    const size_t bodies = m->bodies.table.rows;
    tl_settling *s = &c->settling;
    const double tried = c->conjugate_count == bodies ? s->length : 0;
    leap_search search = {.m = m, .per = tried > 0 ? 1 / tried : 0, .made_up = s->made_up};
    c->conjugate_count = bodies;
    tl_parallel_for(m->pool, bodies, TL_READ_CHUNK, learn_range, &search);
    const double curve = tried > 0 ? curve_of(m) : 0, right = tried > 0 ? right_length(m, tried, curve) : 0;
    search.back = right > 0 ? right - tried : 0;
    tl_parallel_for(m->pool, bodies, TL_READ_CHUNK, precondition_range, &search);
    const double share = right > 0 ? share_of_last(m, curve) : 0;
    s->length = right > 0 ? fmax(UNDER * right, tried / LENGTH_GROWTH) : FIRST_LENGTH * dt * dt;
    s->made_up = search.back;
    put_motion(m, share, s->length, search.back);
}
