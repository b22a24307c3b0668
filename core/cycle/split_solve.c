/* split_solve.c - the tractions on the new faces of a body that was split.
 *
 * Wanted are tractions t that the laws bear and that bring to each part the force and moment it lacks. Of those the nearest to the
 * tractions t0 of the mean stress are taken, in the mean of squares over the faces:
 *
 *     least  int |t - t0|^2 dA    with    sum over the faces of a part of (t, x cross t) = what it lacks
 *
 * Then t - t0 is what springs of one stiffness would carry if the parts made small motions w:
 *
 *     t(x) = t0 + w_A(x) - w_B(x),    K w = what is lacking
 *
 * K is that of springs over all faces. Conjugate gradients solve it: linear tractions, in few steps, for a tree of cuts exactly. Where a
 * law does not bear t (a joint that cannot pull, or slips), its points lose that stiffness and the rest is found again, by Newton's
 * method with a line search. It ends when nothing lacks. Where no tractions do that the best is kept that was met: it leaves the
 * least acceleration of the parts, in the mean of m a^2. */
#include "cycle/split.h"

#include <math.h>
#include <string.h>

/* Stiffness of springs that hold each part, over that of its faces: motions that no face resists stay bounded. What lacks is wrong by that
 * share at the most. */
#define HOLD 1e-9
/* What lacks, of what was wanted, that is rounding. */
#define NOTHING 1e-11
/* Of a traction, what a law may change of it for rounding. */
#define SAME_TRACTION 1e-10
/* Rounds of Newton's method, and halvings of its step. It ends, too, when in so many rounds not LESS of what lacks is left. */
#define MOST_ROUNDS 60
#define MOST_HALVINGS 6
#define MOST_IDLE 6
#define LESS 0.98
/* Rounding of conjugate gradients. */
#define SOLVED 1e-13
/* Conjugate gradients take as many steps as there are unknowns, six a part, but for rounding. */
#define CG_STEPS(parts) (60 + 12 * (parts))

/* ---------------------------------------------------------------- springs ---------------- */

/* Traction on B at a point for small motions of both parts. */
static tl_vec3 spring(const tl_split_point *p, const tl_wrench *a, const tl_wrench *b)
{
    tl_vec3 way = tl_v3_sub(tl_v3_add(a->force, tl_v3_cross(a->moment, p->arm_a)),
                            tl_v3_add(b->force, tl_v3_cross(b->moment, p->arm_b)));
    double along = tl_v3_dot(way, p->n);
    return tl_v3_madd(tl_v3_scale(p->shear, way), (p->normal - p->shear) * along, p->n);
}

static void add(tl_wrench *to, double by, tl_vec3 force, tl_vec3 arm)
{
    to->force = tl_v3_madd(to->force, by, force);
    to->moment = tl_v3_madd(to->moment, by, tl_v3_cross(arm, force));
}

/* image = K step */
static void times_stiffness(tl_split_system *s)
{
    for (size_t i = 0; i < s->part_count; i++) {
        tl_split_part *p = &s->parts[i];
        double hold = HOLD * p->area;
        p->image.force = tl_v3_scale(hold, p->step.force);
        p->image.moment = tl_v3_scale(hold * p->size * p->size, p->step.moment);
    }
    for (size_t k = 0; k < s->point_count; k++) {
        const tl_split_point *p = &s->points[k];
        tl_split_part *a = &s->parts[p->a], *b = &s->parts[p->b];
        tl_vec3 t = spring(p, &a->step, &b->step);
        add(&a->image, p->area, t, p->arm_a);
        add(&b->image, -p->area, t, p->arm_b);
    }
}

static double dot(const tl_wrench *x, const tl_wrench *y)
{
    return tl_v3_dot(x->force, y->force) + tl_v3_dot(x->moment, y->moment);
}

static tl_wrench plus(tl_wrench x, double by, tl_wrench y)
{
    return (tl_wrench){tl_v3_madd(x.force, by, y.force), tl_v3_madd(x.moment, by, y.moment)};
}

/* Makes parts of all sizes alike. */
static tl_wrench precondition(const tl_split_part *p, tl_wrench x)
{
    double per = p->area > 0 ? 1 / p->area : 0;
    return (tl_wrench){tl_v3_scale(per, x.force), tl_v3_scale(per / (p->size * p->size), x.moment)};
}

/* Solves K way = -lacks: springs bring -K w. Overwrites `lacks`. */
static void solve_linear(tl_split_system *s)
{
    double rz = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        tl_split_part *p = &s->parts[i];
        p->lacks = plus((tl_wrench){{0, 0, 0}, {0, 0, 0}}, -1, p->lacks);
        p->way = (tl_wrench){{0, 0, 0}, {0, 0, 0}};
        p->step = precondition(p, p->lacks);
        rz += dot(&p->lacks, &p->step);
    }
    const double least = rz * SOLVED * SOLVED;
    for (size_t k = 0; k < CG_STEPS(s->part_count) && rz > least; k++) {
        double curve = 0, next = 0;
        times_stiffness(s);
        for (size_t i = 0; i < s->part_count; i++)
            curve += dot(&s->parts[i].step, &s->parts[i].image);
        if (!(curve > 0))
            return;
        for (size_t i = 0; i < s->part_count; i++) {
            tl_split_part *p = &s->parts[i];
            p->way = plus(p->way, rz / curve, p->step);
            p->lacks = plus(p->lacks, -rz / curve, p->image);
            p->preconditioned = precondition(p, p->lacks);
            next += dot(&p->lacks, &p->preconditioned);
        }
        for (size_t i = 0; i < s->part_count; i++)
            s->parts[i].step = plus(s->parts[i].preconditioned, next / rz, s->parts[i].step);
        rz = next;
    }
}

/* ---------------------------------------------------------------- laws ------------------- */

bool tl_split_bear(tl_split_system *s)
{
    s->stored = 0;
    for (size_t i = 0; i < s->contact_count; i++) {
        const tl_split_contact *c = &s->contacts[i];
        double stored;
        if (!tl_contact_bear(s->m, c->row, &s->given[c->first], &s->borne[c->first], &stored))
            return false;
        s->stored += stored;
    }
    return true;
}

/* What the parts lack with what is borne; returns the sum of the squares of the accelerations, times mass. */
static double find_lacking(tl_split_system *s)
{
    double sum = 0;
    for (size_t i = 0; i < s->part_count; i++)
        s->parts[i].lacks = plus(s->parts[i].wanted, -1, s->parts[i].outer);
    for (size_t k = 0; k < s->point_count; k++) {
        const tl_split_point *p = &s->points[k];
        tl_vec3 t = tl_v3_madd(s->borne[k].shear, s->borne[k].normal, p->n);
        add(&s->parts[p->a].lacks, p->area, t, p->arm_a);
        add(&s->parts[p->b].lacks, -p->area, t, p->arm_b);
    }
    for (size_t i = 0; i < s->part_count; i++) {
        const tl_split_part *p = &s->parts[i];
        sum += (tl_v3_norm2(p->lacks.force) + tl_v3_norm2(p->lacks.moment) / (p->size * p->size)) /
               p->mass;
    }
    return sum;
}

/* given = from + by times the tractions of `way`, in full where a point has lost its stiffness, too. */
static void give(tl_split_system *s, const tl_traction *from, double by)
{
    for (size_t k = 0; k < s->point_count; k++) {
        tl_split_point p = s->points[k];
        p.normal = p.shear = 1;
        tl_vec3 t = spring(&p, &s->parts[p.a].way, &s->parts[p.b].way);
        double along = tl_v3_dot(t, p.n);
        s->given[k].normal = from[k].normal + by * along;
        s->given[k].shear = tl_v3_madd(from[k].shear, by, tl_v3_madd(t, -along, p.n));
    }
}

/* Takes the stiffness of the points at which the laws bear less than what is given; true: of some. */
static bool soften(tl_split_system *s)
{
    double most = 0;
    bool any = false;
    for (size_t k = 0; k < s->point_count; k++)
        most = fmax(most, fabs(s->given[k].normal) + tl_v3_norm(s->given[k].shear));
    for (size_t k = 0; k < s->point_count; k++) {
        tl_split_point *p = &s->points[k];
        double along = fabs(s->borne[k].normal - s->given[k].normal);
        double across = tl_v3_norm(tl_v3_sub(s->borne[k].shear, s->given[k].shear));
        p->normal = along > SAME_TRACTION * most ? 0 : 1;
        p->shear = across > SAME_TRACTION * most ? 0 : 1;
        any = any || p->normal < 1 || p->shear < 1;
    }
    return any;
}

static void stiffen(tl_split_system *s)
{
    for (size_t k = 0; k < s->point_count; k++)
        s->points[k].normal = s->points[k].shear = 1;
}

/* Gives `from` and `by` times the tractions of `way`; what lacks then, or NAN: a law failed. */
static double try_step(tl_split_system *s, const tl_traction *from, double by)
{
    give(s, from, by);
    return tl_split_bear(s) ? find_lacking(s) : NAN;
}

/* Goes on from the tractions that were given by what brings what lacks. With `search` by less until less lacks, or by more as long as
 * ever less does, or not at all. `from` is scratch. Returns what lacks then, or NAN: a law failed. */
static double go_on(tl_split_system *s, bool search, double lacking, tl_traction *from)
{
    memcpy(from, s->given, s->point_count * sizeof *from);
    find_lacking(s);
    solve_linear(s);
    double by = 1, now = try_step(s, from, by);
    if (!search)
        return now;
    if (now < lacking) {
        for (int k = 0; k < MOST_HALVINGS; k++, by *= 2) {
            double next = try_step(s, from, 2 * by);
            if (!(next < now))
                return isnan(next) ? next : try_step(s, from, by);
            now = next;
        }
        return now;
    }
    for (int k = 0; k < MOST_HALVINGS && now >= lacking; k++)
        now = try_step(s, from, by *= 0.5);
    return now < lacking || isnan(now) ? now : try_step(s, from, 0);
}

bool tl_split_solve(tl_split_system *s)
{
    double wanted = 0, least = INFINITY, lacking;
    for (size_t i = 0; i < s->part_count; i++) {
        const tl_split_part *p = &s->parts[i];
        wanted += (tl_v3_norm2(p->wanted.force) + tl_v3_norm2(p->outer.force)) / p->mass;
    }
    memcpy(s->given, s->start, s->point_count * sizeof *s->start);
    memcpy(s->borne, s->start, s->point_count * sizeof *s->start);
    stiffen(s);
    lacking = go_on(s, false, INFINITY, s->start);
    for (int round = 0, idle = 0; round < MOST_ROUNDS && idle < MOST_IDLE; round++) {
        idle = lacking < LESS * least ? 0 : idle + 1;
        if (lacking < least) {
            least = lacking;
            memcpy(s->best, s->borne, s->point_count * sizeof *s->best);
        }
        if (lacking <= NOTHING * NOTHING * wanted || !soften(s))
            break;
        double next = go_on(s, true, lacking, s->start);
        if (!(next < lacking)) {
            stiffen(s);
            next = go_on(s, false, next, s->start);
        }
        lacking = next;
        if (isnan(lacking))
            return false;
    }
    memcpy(s->given, s->best, s->point_count * sizeof *s->best);
    return !isnan(lacking) && tl_split_bear(s); /* once more, for the energy */
}
