/* secants.c - the stiffness of contacts as their last motions tell it, and the motion to equilibrium that follows.
 *
 * A contact's force on B, and moment about its place, are a function f of six motions of B against A. What a law, a
 * patch that is partly open or a pressure field make of it need not be known: each step shows a motion s and a change
 * y = f_before - f_now. The stiffness K of the contact, at first that of its closed points, follows these by
 *
 *     K <- K + y y^T / (y.s) - K s s^T K / (s.K s)                                        (BFGS)
 *
 * Where the contact gives way, as it opens, y.s is made no less than KEEPS of s.K s: so K stays positive. If it slips
 * K is made no less: a leap must not carry on what slides. K is kept as a root, K = J J^T:
 *
 *     J <- J + (y - J z) z^T / (z.z),    z = (y.s / s.K s)^1/2 J^T s
 *
 * With secants contact by contact, and not of the whole, few steps show all there is to know, however many blocks there
 * are. The motion x of all bodies that would bring equilibrium is
 *
 *     (sum T^T K T + hold M / dt^2) x = F
 *
 * T: motion of B against A by those of the bodies. The second term holds what nothing else does. Conjugate gradients
 * solve it, with the six rows of each body as preconditioner.
 *
 * Sources: A. Griewank and Ph. L. Toint, "Partitioned variable metric updates for large structured optimization
 * problems", Numerische Mathematik 39 (1982) 119-137; K. Levenberg, Quarterly of Applied Mathematics 2 (1944) 164-168;
 * M. J. D. Powell's damping, Lecture Notes in Mathematics 630 (1978) 144-157. */
#include "cycle/secants.h"

#include "base/columns.h"
#include "base/inline.h"
#include "base/parallel.h"
#include "contact/facing.h"
#include "contact/places.h"
#include "contact/sides.h"

#include <math.h>
#include <string.h>

/* Tolerance: share of the stiffness along a motion that one step leaves of it at the least. */
#define KEEPS 0.1
/* Tolerance: share of the largest stiffness that a contact has in all directions. */
#define LEAST 1e-9
/* Tolerance: change of force over the force below which a motion tells rounding. */
#define ROUNDING 1e-10
/* Tolerance: share of a diagonal of Cholesky below which what is left of it is rounding. */
#define ROUNDED 1e-12
/* Tolerance: of the residual of conjugate gradients, in the norm of their preconditioner. */
#define SOLVED 0.03
/* Limit: of their iterations. */
#define MOST_ITERATIONS 400

/* ---------------------------------------------------------------- small matrices --------- */

/* k += by d d^T with d = (n, s x n): a spring along n at s. */
static void add_spring(double k[6][6], double by, tl_vec3 n, tl_vec3 s)
{
    const tl_vec3 c = tl_v3_cross(s, n);
    const double d[6] = {n.x, n.y, n.z, c.x, c.y, c.z};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            k[i][j] += by * d[i] * d[j];
}

/* The same for a spring against turning about n. */
static void add_turn(double k[6][6], double by, tl_vec3 n)
{
    const double d[3] = {n.x, n.y, n.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            k[3 + i][3 + j] += by * d[i] * d[j];
}

/* The Cholesky factor of a matrix in its lower half. What rounding would make no positive diagonal is made one. */
static void factorise(double a[6][6])
{
    for (int j = 0; j < 6; j++) {
        const double own = a[j][j];
        double d = own;
        for (int k = 0; k < j; k++)
            d -= a[j][k] * a[j][k];
        a[j][j] = sqrt(fmax(d, ROUNDED * own));
        for (int i = j + 1; i < 6; i++) {
            double t = a[i][j];
            for (int k = 0; k < j; k++)
                t -= a[i][k] * a[j][k];
            a[i][j] = a[j][j] > 0 ? t / a[j][j] : 0;
        }
    }
}

/* Makes a Cholesky factor its inverse. A direction that has no stiffness gets none. */
static void invert_factor(double a[6][6])
{
    for (int j = 0; j < 6; j++) {
        a[j][j] = a[j][j] > 0 ? 1 / a[j][j] : 0;
        for (int i = j + 1; i < 6; i++) {
            double t = 0;
            for (int k = j; k < i; k++)
                t -= a[i][k] * a[k][j];
            a[i][j] = a[i][i] > 0 ? t / a[i][i] : 0;
        }
    }
    for (int i = 0; i < 6; i++)
        for (int j = i + 1; j < 6; j++)
            a[i][j] = 0;
}

/* x = R^T R f, of R the lower half. */
TL_INLINE void solve_by(double r[6][6], const double f[6], double x[6])
{
    double turned[6];
    for (int i = 0; i < 6; i++) {
        turned[i] = 0;
        for (int k = 0; k <= i; k++)
            turned[i] += r[i][k] * f[k];
    }
    for (int i = 0; i < 6; i++) {
        x[i] = 0;
        for (int k = i; k < 6; k++)
            x[i] += r[k][i] * turned[k];
    }
}

static double dot(const double x[6], const double y[6])
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += x[i] * y[i];
    return sum;
}

static void put_vec(double to[3], tl_vec3 v)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static tl_vec3 vec_of(const double v[3])
{
    return tl_v3(v[0], v[1], v[2]);
}

/* ---------------------------------------------------------------- one contact ------------ */

/* What a closed patch is as stiff as: its points that press. */
static void add_points(const tl_model *m, uint32_t contact, const tl_law *law, tl_vec3 arm, double k[6][6])
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_points_table *points = &m->detect->points;
    const tl_vec3 n = c->facet[contact].last, e = tl_facing_aside(n), g = tl_v3_cross(n, e);
    for (size_t i = 0; i < c->point_count[contact]; i++) {
        const size_t row = tl_point_row(c, contact, i);
        if (!(points->f_n[row] > 0))
            continue;
        const tl_vec3 at = tl_v3_sub(tl_contact_point_arm(m, contact, i), arm);
        add_spring(k, law->kn * points->area[row], n, at);
        add_spring(k, law->ks * points->area[row], e, at);
        add_spring(k, law->ks * points->area[row], g, at);
    }
}

/* The same of a field: its area, at the centre of its pressure. */
static void add_field(const tl_model *m, uint32_t contact, const tl_law *law, double k[6][6])
{
    const tl_press *press = &tl_press_row_of(m, contact)->press;
    const tl_vec3 n = m->detect->contacts.facet[contact].last, here = {0, 0, 0};
    const tl_vec3 e = tl_facing_aside(n), g = tl_v3_cross(n, e);
    const double turn = 0.5 * press->area * press->radius * press->radius;
    add_spring(k, law->kn * press->area, n, here);
    add_spring(k, law->ks * press->area, e, here);
    add_spring(k, law->ks * press->area, g, here);
    add_turn(k, law->kn * turn, e);
    add_turn(k, law->kn * turn, g);
    add_turn(k, 2 * law->ks * turn, n);
}

/* Where the contact is: the arm from A's centroid to the middle of its points. */
static tl_vec3 place_of(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    if (tl_facet_is_field(&c->facet[contact]))
        return tl_side_arm(m, tl_contact_sides(m, contact).a, tl_press_row_of(m, contact)->press.point);
    tl_vec3 sum = {0, 0, 0};
    double area = 0;
    for (size_t i = 0; i < c->point_count[contact]; i++) {
        const double own = m->detect->points.area[tl_point_row(c, contact, i)];
        sum = tl_v3_madd(sum, own, tl_contact_point_arm(m, contact, i));
        area += own;
    }
    return area > 0 ? tl_v3_scale(1 / area, sum) : sum;
}

/* Force and moment on B about its place, which goes along half with A and half with B: so A and B may change places. */
static void force_of(const tl_model *m, uint32_t contact, const tl_secant *s, double force[6])
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_vec3 apart = tl_sides_apart(m, tl_contact_sides(m, contact));
    const tl_vec3 arm = tl_v3_scale(0.5, tl_v3_add(vec_of(s->arm_a), tl_v3_add(vec_of(s->arm_b), apart)));
    put_vec(force, c->force[contact]);
    put_vec(force + 3, tl_v3_sub(c->moment[contact], tl_v3_cross(arm, c->force[contact])));
}

static void secant_begin(const tl_model *m, uint32_t contact, tl_secant *s)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_law *law = &m->joint_laws[c->law[contact]];
    const tl_vec3 arm = place_of(m, contact);
    *s = (tl_secant){.born = c->born[contact], .a = c->a[contact], .b = c->b[contact], .kind = c->kind[contact]};
    put_vec(s->arm_a, arm);
    put_vec(s->arm_b, tl_v3_sub(arm, tl_sides_apart(m, tl_contact_sides(m, contact))));
    if (tl_facet_is_field(&c->facet[contact]))
        add_field(m, contact, law, s->root);
    else
        add_points(m, contact, law, arm, s->root);
    double most[2] = {0, 0};
    for (int i = 0; i < 6; i++)
        most[i / 3] = fmax(most[i / 3], s->root[i][i]);
    for (int i = 0; i < 6; i++)
        s->root[i][i] += LEAST * most[i / 3];
    factorise(s->root);
    for (int i = 0; i < 6; i++)
        for (int j = i + 1; j < 6; j++)
            s->root[i][j] = 0;
    force_of(m, contact, s, s->force);
}

/* K s, by way of J^T s. */
static void times_root(const tl_secant *of, const double s[6], double turned[6], double ks[6])
{
    for (int i = 0; i < 6; i++) {
        turned[i] = 0;
        for (int k = 0; k < 6; k++)
            turned[i] += of->root[k][i] * s[k];
    }
    for (int i = 0; i < 6; i++)
        ks[i] = dot(of->root[i], turned);
}

/* Whether none of the contact has pressed so far. No motion can teach what has no stiffness, so it begins anew until
 * it presses. Else nothing but the hold would bound the leaps of bodies whose contacts close. */
static bool is_open(const tl_secant *of)
{
    return !(dot(of->root[0], of->root[0]) > 0);
}

/* A step with the motion s has changed the force by -y. */
static void secant_update(tl_secant *of, const double s[6], double y[6], double keeps)
{
    double turned[6], ks[6], jz[6];
    times_root(of, s, turned, ks);
    const double was = dot(s, ks);
    if (!(was > 0) || !(dot(ks, ks) > ROUNDING * ROUNDING * dot(of->force, of->force)))
        return;
    double is = dot(y, s);
    if (is < keeps * was) {
        const double part = is < was ? (1 - keeps) * was / (was - is) : 1;
        for (int i = 0; i < 6; i++)
            y[i] = part * y[i] + (1 - part) * ks[i];
        is = dot(y, s);
    }
    const double scale = sqrt(is / was), per = 1 / is; /* z.z is y.s */
    if (!(is > 0) || !isfinite(scale) || !isfinite(per))
        return;
    for (int i = 0; i < 6; i++)
        jz[i] = y[i] - scale * ks[i];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            of->root[i][j] += jz[i] * scale * turned[j] * per;
}

/* ---------------------------------------------------------------- all contacts ----------- */

/* Whether a contact has a stiffness at all. */
static bool counts(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    return c->law[contact] != TL_NO_ROW && c->point_count[contact] > 0 && !c->held[contact];
}

/* Whether some of it slips. */
static bool slips(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    bool any = false;
    for (size_t i = 0; i < c->point_count[contact]; i++)
        any = any || (m->detect->points.flags[tl_point_row(c, contact, i)] & TL_POINT_SLIPPING);
    return any;
}

typedef struct follow_job {
    tl_model *m;
    bool anew;
} follow_job;

static void follow_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const follow_job *job = user;
    const tl_model *m = job->m;
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        tl_secant *s = &m->cycle->secant[i];
        if (!counts(m, i)) {
            s->born = -1;
            continue;
        }
        const bool same = s->born == c->born[i] && s->a == c->a[i] && s->b == c->b[i] && s->kind == c->kind[i];
        if (job->anew || !same || is_open(s)) {
            secant_begin(m, i, s);
            continue;
        }
        const tl_contact_motion by = tl_contact_moved(m, i);
        double way[6], now[6], change[6];
        put_vec(way, tl_v3_add(by.way, tl_v3_cross(by.turn, vec_of(s->arm_a))));
        put_vec(way + 3, by.turn);
        force_of(m, i, s, now);
        for (int k = 0; k < 6; k++)
            change[k] = s->force[k] - now[k];
        secant_update(s, way, change, slips(m, i) ? 1 : KEEPS);
        memcpy(s->force, now, sizeof now);
    }
}

static void follow(tl_model *m, bool anew)
{
    follow_job job = {m, anew};
    const size_t contacts = m->detect->contacts.table.rows;
    for (size_t i = m->cycle->secant_count; i < contacts; i++)
        m->cycle->secant[i].born = -1;
    m->cycle->secant_count = contacts;
    tl_parallel_for(m->pool, contacts, TL_CONTACT_CHUNK, follow_range, &job);
}

bool tl_secants_prepare(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const size_t contacts = m->detect->contacts.table.rows;
    return tl_grow(&c->secant, &c->secant_capacity, contacts, sizeof *c->secant) &&
           tl_grow(&c->link, &c->link_capacity, contacts, sizeof *c->link) &&
           tl_fit(&c->leap, &c->leap_capacity, m->bodies.table.rows, sizeof *c->leap);
}

void tl_secants_begin(tl_model *m)
{
    follow(m, true);
}

void tl_secants_follow(tl_model *m)
{
    follow(m, false);
}

/* ---------------------------------------------------------------- the leap --------------- */

static void link_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        const tl_secant *s = &m->cycle->secant[i];
        tl_leap_link *link = &m->cycle->link[i];
        const tl_sides on = tl_contact_bodies(m, i);
        if (s->born < 0) {
            link->a = link->b = on.a;
            continue;
        }
        link->a = on.a;
        link->b = on.b;
        link->arm_a = vec_of(s->arm_a);
        link->arm_b = vec_of(s->arm_b);
        memset(link->k, 0, sizeof link->k);
        for (int j = 0; j < 6; j++)
            for (int k = 0; k <= j; k++)
                link->k[j][k] = link->k[k][j] = dot(s->root[j], s->root[k]);
    }
}

/* The motion at a contact's place by that of a body; and the force on the body by that at the place. */
TL_INLINE void at_place(const double x[6], tl_vec3 arm, double out[6])
{
    put_vec(out, tl_v3_add(vec_of(x), tl_v3_cross(vec_of(x + 3), arm)));
    put_vec(out + 3, vec_of(x + 3));
}

TL_INLINE void add_on_body(double to[6], double by, const double f[6], tl_vec3 arm)
{
    const tl_vec3 moment = tl_v3_add(vec_of(f + 3), tl_v3_cross(arm, vec_of(f)));
    for (int i = 0; i < 3; i++)
        to[i] += by * f[i];
    put_vec(to + 3, tl_v3_madd(vec_of(to + 3), by, moment));
}

/* Adds T^T K T of one side of a contact to the body's rows: what each unit motion of the body does to it. */
static void add_block(double to[6][6], double k[6][TL_LANES], tl_vec3 arm)
{
    const tl_vec3 ways[3] = {{0, -arm.z, arm.y}, {arm.z, 0, -arm.x}, {-arm.y, arm.x, 0}}; /* of unit turns */
    for (int j = 0; j < 6; j++) {
        double force[6], column[6] = {0};
        for (int i = 0; i < 6; i++)
            force[i] =
                j < 3 ? k[j][i] : ways[j - 3].x * k[0][i] + ways[j - 3].y * k[1][i] + ways[j - 3].z * k[2][i] + k[j][i];
        add_on_body(column, 1, force, arm);
        for (int i = 0; i < 6; i++)
            to[i][j] += column[i];
    }
}

/* Components that are held do not move. */
static void free_rows(const tl_model *m, uint32_t body, double x[6])
{
    const unsigned fixed = m->bodies.fixed[body];
    if (!fixed)
        return;
    put_vec(x, tl_free_part(vec_of(x), fixed));
    if (fixed & TL_FIX_ROTATION)
        put_vec(x + 3, tl_v3(0, 0, 0));
}

static void hold_body(const tl_model *m, uint32_t body, double by, tl_leap_body *of)
{
    const tl_bodies *b = &m->bodies;
    const tl_vec3 moments = tl_moments_of(m, body);
    const double mass = by * b->mass[body] * tl_inertia_scale(m->cycle, body);
    const double turn = by * (moments.x + moments.y + moments.z) / 3 * tl_turn_scale(m->cycle, body);
    for (int i = 0; i < 6; i++) {
        of->hold[i] = i < 3 ? mass : turn;
        of->block[i][i] += of->hold[i];
    }
    double ones[6] = {1, 1, 1, 1, 1, 1};
    free_rows(m, body, ones);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            if (ones[i] == 0 || ones[j] == 0)
                of->block[i][j] = i == j;
    factorise(of->block);
    invert_factor(of->block);
}

static void begin_bodies(const tl_model *m, double by)
{
    const struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    const size_t bodies = b->table.rows;
    memset(c->leap, 0, bodies * sizeof *c->leap);
    for (size_t i = 0; i < m->detect->contacts.table.rows; i++) {
        tl_leap_link *link = &c->link[i];
        if (link->a == link->b)
            continue;
        add_block(c->leap[link->a].block, link->k, link->arm_a);
        add_block(c->leap[link->b].block, link->k, link->arm_b);
    }
    for (uint32_t body = 0; body < bodies; body++) {
        tl_leap_body *of = &c->leap[body];
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        hold_body(m, body, by, of);
        put_vec(of->force, b->force[body]);
        put_vec(of->force + 3, b->moment[body]);
        free_rows(m, body, of->force);
    }
}

/* Goes `by` along the way. What force is left is preconditioned, block^-1 force; returns the product of both. */
static double go_along(const tl_model *m, double by)
{
    double sum = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        tl_leap_body *of = &m->cycle->leap[body];
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        for (int i = 0; i < 6; i++) {
            of->motion[i] += by * of->way[i];
            of->force[i] -= by * of->image[i];
        }
        solve_by(of->block, of->force, of->preconditioned);
        free_rows(m, body, of->preconditioned);
        sum += dot(of->force, of->preconditioned);
    }
    return sum;
}

/* The next way: what is preconditioned, and `turn` times the last one. Begins its image by what is held. */
static void choose_way(const tl_model *m, double turn)
{
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        tl_leap_body *of = &m->cycle->leap[body];
        for (int i = 0; i < 6; i++) {
            of->way[i] = of->preconditioned[i] + turn * of->way[i];
            of->image[i] = of->hold[i] * of->way[i];
        }
    }
}

/* Adds what the contacts do to the image of the way. */
TL_VECTORIZED static void add_stiffness(tl_leap_body *leap, const tl_leap_link *links, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const tl_leap_link *link = &links[i];
        if (link->a == link->b)
            continue;
        tl_leap_body *a = &leap[link->a], *b = &leap[link->b];
        double way_a[6], way[6], force[TL_LANES] = {0};
        at_place(a->way, link->arm_a, way_a);
        at_place(b->way, link->arm_b, way);
        for (int k = 0; k < 6; k++) {
            const double by = way[k] - way_a[k];
#pragma omp simd
            for (unsigned l = 0; l < TL_LANES; l++)
                force[l] += link->k[k][l] * by;
        }
        add_on_body(b->image, 1, force, link->arm_b);
        add_on_body(a->image, -1, force, link->arm_a);
    }
}

/* image = (stiffness + hold) way; returns the product of both. */
static double times_stiffness(const tl_model *m)
{
    tl_leap_body *leap = m->cycle->leap;
    double sum = 0;
    add_stiffness(leap, m->cycle->link, m->detect->contacts.table.rows);
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        free_rows(m, body, leap[body].image);
        sum += dot(leap[body].way, leap[body].image);
    }
    return sum;
}

void tl_leap_find(tl_model *m, double dt, double hold)
{
    tl_parallel_for(m->pool, m->detect->contacts.table.rows, TL_CONTACT_CHUNK, link_range, m);
    begin_bodies(m, hold / (dt * dt));
    double left = go_along(m, 0);
    const double least = SOLVED * SOLVED * left;
    choose_way(m, 0);
    for (int k = 0; k < MOST_ITERATIONS && left > least; k++) {
        const double curve = times_stiffness(m);
        if (!(curve > 0))
            break;
        const double next = go_along(m, left / curve), turn = next / left;
        left = next;
        choose_way(m, turn);
    }
}
