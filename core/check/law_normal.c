/* law_normal.c - the normal force, and what a law tells of it: `linear`, `pressed`, `across_gap`, `pulls`, and the
 * flags.
 *
 * With u = closure + lift, the share `hold` of tension and a part of the area that is apart by `apart` in the mean,
 *
 *     linear:      f_n = kn A (u - hold apart)        where u > 0, and 0 or kn A hold u where it is not
 *     pressed:     f_n = d pressed / d closure
 *     stored >= what the normal force holds, and at the beginning no more than that. */
#include "check/law_normal.h"

#include "base/inside.h"

#include <math.h>
#include <string.h>

/* Tolerance: share of the closures by which the slope of `pressed` is found, and its relative error, and that of an
 * initial force. Test: unit/test_check. */
#define SMALL 1e-4
#define SLOPE_ERROR 1e-3
/* Tolerance: the same of forces and energies that are compared, which differ by roundings of closures. Test:
 * unit/test_check. */
#define ERROR 1e-7

/* ---------------------------------------------------------------- what a law tells ------- */

/* States that a law does not declare, and where all of them are. */
typedef struct beyond {
    _Alignas(TL_ALIGN) double nobodys[TL_CHECK_POINTS];
    double *state[2 * TL_STATE_COLUMNS];
} beyond;

/* A batch of what the functions besides update() are given. */
static tl_law_batch batch_of(tl_check_points *p, beyond *other)
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        other->nobodys[i] = tl_check_nobodys(0, false);
    for (int k = 0; k < 2 * TL_STATE_COLUMNS; k++)
        other->state[k] = k < TL_STATE_COLUMNS ? p->c[TL_AT_STATE + k] : other->nobodys;
    return (tl_law_batch){.size = sizeof(tl_law_batch),
                          .count = TL_CHECK_POINTS,
                          .area = p->c[TL_AT_AREA],
                          .f_n0 = p->c[TL_AT_F_N0],
                          .state = other->state,
                          .flags = p->flags};
}

void tl_law_gaps(const tl_check_law *law, const tl_check_points *given, tl_check_gaps *gaps)
{
    const tl_law_ops *ops = law->ops;
    beyond other;
    tl_check_points p = *given;
    uint32_t pulls = ops->pulls ? ops->pulls(law->self) : TL_PULL_ANY;
    const tl_law_batch batch = batch_of(&p, &other);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        bool lost = pulls == TL_PULL_BONDED && p.flags[i] & TL_POINT_FAILED;
        double spring = law->kn * p.c[TL_AT_AREA][i];
        gaps->lift[i] = p.c[TL_AT_F_N0][i] / (spring > 0 ? spring : 1);
        gaps->hold[i] = 0;
        gaps->bond[i] = pulls == TL_PULL_NONE || lost || p.flags[i] & TL_POINT_APART ? 0 : 1;
    }
    if (!ops->across_gap)
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) /* the law is to write all of them */
        gaps->lift[i] = gaps->hold[i] = NAN;
    tl_enter(law->kind, "across_gap");
    ops->across_gap(law->self, &batch, gaps->lift, gaps->hold);
    tl_leave();
    memcpy(gaps->bond, gaps->hold, sizeof gaps->bond);
}

double tl_law_edge(double closure, double apart, double lift, double below)
{
    /* o from -e to f in a line: the means of its parts are f^2 / (2 (e + f)) and e^2 / (2 (e + f)) */
    double u = fmax(0, closure + lift);
    return apart > 0 ? -lift - 2 * (apart + sqrt(u * apart)) : closure - below;
}

/* What `pressed` tells at the points' closures moved by `move`: energies, and forces or not-a-number. */
static void pressed_at(const tl_check_law *law, const tl_check_points *given, double move,
                       double energy[TL_CHECK_POINTS], double force[TL_CHECK_POINTS])
{
    beyond other;
    tl_check_points p = *given;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        p.c[TL_AT_CLOSURE][i] += move;
        force[i] = NAN;
    }
    tl_law_batch batch = batch_of(&p, &other);
    batch.closure = p.c[TL_AT_CLOSURE];
    batch.f_n = force;
    tl_enter(law->kind, "pressed");
    law->ops->pressed(law->self, &batch, energy);
    tl_leave();
}

/* ---------------------------------------------------------------- checks ----------------- */

/* A point and what is known of it. */
typedef struct point {
    double lift, u, apart, hold, spring, f_n, kept; /* m, m, m, share, N/m, N; kept: what is stored, J */
    double error, rounding;                         /* N, m */
    bool fresh, no_shear;
} point;

static point point_at(const tl_law_trial *t, const tl_check_gaps *gaps, size_t i, int step)
{
    double spring = t->law.kn * t->out.c[TL_AT_AREA][i];
    double lift = gaps->lift[i], u = t->in.c[TL_AT_CLOSURE][i] + lift;
    double size = fabs(lift) + fabs(t->in.c[TL_AT_CLOSURE][i]) + t->law.closure;
    tl_vec3 shear = tl_check_vec(t->out.c[TL_AT_F_S], i);
    return (point){.lift = lift,
                   .u = u,
                   .apart = t->in.c[TL_AT_APART][i],
                   .hold = u < 0 ? gaps->bond[i] : gaps->hold[i],
                   .spring = spring,
                   .f_n = t->out.c[TL_AT_F_N][i],
                   .kept = t->out.c[TL_AT_STORED][i],
                   .error = ERROR * (t->scale[i] + spring * size),
                   .rounding = 1e3 * TL_CHECK_ROUNDING * size,
                   .fresh = step == 0,
                   .no_shear = tl_v3_norm(shear) == 0};
}

static void check_linear(tl_law_trial *t, const point *p)
{
    double pull = p->u > 0 ? p->hold * p->apart : 0, u = p->u > 0 ? p->u : p->hold * p->u;
    double expected = p->spring * (u - pull);
    bool told = t->law.ops->across_gap != NULL;
    bool none = p->f_n == 0 && p->u <= 0 && !told; /* those that may pull need not */
    if (!none && fabs(p->f_n - expected) > p->error)
        tl_check_note(t->c, TL_LAW_PRESSES,
                      "f_n = %g N at a closure with lift of %g m, a part apart by %g m, hold = %g: by "
                      "kn of stiffness()%s the normal force is %g N",
                      p->f_n, p->u, p->apart, p->hold, told ? " and across_gap()" : "", expected);
    double presses = p->spring * (p->u > 0 ? p->u : 0);
    double pulls = none ? 0 : p->spring * p->hold * (p->u > 0 ? p->apart : -p->u);
    /* a share of the springs holds that share of their energy, or all at a share of the stretch */
    double per = p->spring > 0 ? 0.5 / p->spring : 0;
    double holds = per * (presses * presses + pulls * pulls);
    double most = per * (presses * presses + (p->hold > 0 ? pulls * pulls / p->hold : 0));
    double error = p->error * (t->law.closure + fabs(p->u) + p->apart);
    if (p->kept < holds - error)
        tl_check_note(t->c, TL_LAW_PRESSES, "stored = %g J is less than the normal springs hold, %g J", p->kept, holds);
    if (p->fresh && p->no_shear && p->kept > most + error)
        tl_check_note(t->c, TL_LAW_PRESSES,
                      "stored = %g J of a new point without shear, whose normal springs hold %g J", p->kept, most);
}

/* What presses by its energy; `energy` at the closure, and a little less and more. */
/* `told`: the force that pressed() tells, or not-a-number. */
static void check_pressed(tl_law_trial *t, const point *p, const double energy[3], double told)
{
    double slope = (energy[2] - energy[0]) / (2 * SMALL * t->law.closure);
    double expected = p->f_n < 0 ? 0 : p->f_n + p->spring * p->hold * p->apart;
    double error = SLOPE_ERROR * (p->error / ERROR), holds = error * t->law.closure;
    if (!(fabs(slope - expected) <= error))
        tl_check_note(t->c, TL_LAW_PRESSES, "f_n = %g N at a closure with lift of %g m, where pressed() rises by %g N",
                      p->f_n, p->u, slope);
    if (!(isnan(told) || fabs(slope - told) <= error))
        tl_check_note(t->c, TL_LAW_PRESSES,
                      "pressed() tells the force %g N at a closure with lift of %g m, where its energy rises by %g N",
                      told, p->u, slope);
    if (p->kept < energy[1] - holds)
        tl_check_note(t->c, TL_LAW_PRESSES, "stored = %g J is less than what presses holds by pressed(), %g J", p->kept,
                      energy[1]);
    if (p->fresh && p->no_shear && p->u > 0 && p->kept > energy[1] + holds)
        tl_check_note(t->c, TL_LAW_PRESSES, "stored = %g J of a new point without shear, and pressed() says %g J",
                      p->kept, energy[1]);
}

/* The initial force is that at closure 0, and a bond that is not pulled nor sheared holds. */
static void check_initial(tl_law_trial *t, const point *p, size_t i)
{
    bool made_apart = (t->in.flags[i] & TL_POINT_APART) != 0;
    double fibre = p->u - (t->in.c[TL_AT_CLOSURE][i] - t->in.c[TL_AT_EDGE][i]);
    if (p->fresh && !made_apart && fibre >= 0 && t->out.flags[i] & TL_POINT_FAILED)
        tl_check_note(t->c, TL_LAW_FLAGS, "a new point that is neither pulled nor sheared is flagged as failed");
    double f_n0 = t->in.c[TL_AT_F_N0][i];
    bool there = p->fresh && t->in.c[TL_AT_CLOSURE][i] == 0 && p->apart == 0 && f_n0 > 0;
    if (there && fabs(p->f_n - f_n0) > SLOPE_ERROR * f_n0)
        tl_check_note(t->c, TL_LAW_PRESSES,
                      "f_n = %g N of a new point at closure 0, where the initial force is f_n0 = %g N", p->f_n, f_n0);
}

static void check_gap(tl_law_trial *t, const point *p, size_t i)
{
    const tl_law_ops *ops = t->law.ops;
    uint32_t pulls = ops->pulls ? ops->pulls(t->law.self) : TL_PULL_ANY;
    bool failed = (t->out.flags[i] & TL_POINT_FAILED) != 0;
    bool may = pulls == TL_PULL_ANY || (pulls == TL_PULL_BONDED && !failed);
    if (!may && p->u < -p->rounding && p->f_n != 0)
        tl_check_note(t->c, TL_LAW_PULLS, "f_n = %g N across a gap of %g m", p->f_n, -p->u);
    if (!may && p->f_n < 0)
        tl_check_note(t->c, TL_LAW_PULLS, "f_n = %g N pulls, and pulls() says that %s", p->f_n,
                      failed ? "a point that has failed does not" : "no point does");
    if (t->unmet[i] && p->u < -p->rounding && p->f_n != 0)
        tl_check_note(t->c, TL_LAW_PULLS,
                      "f_n = %g N across a gap of %g m between walls that were apart and have not met", p->f_n, -p->u);
    if (!isfinite(p->lift))
        tl_check_note(t->c, TL_LAW_PULLS, "across_gap() leaves lift unwritten, or gives one that is not finite");
    if (!(p->hold >= 0 && p->hold <= 1))
        tl_check_note(t->c, TL_LAW_PULLS, "across_gap() gives hold = %g, which must be in [0, 1]", p->hold);
    if (p->u > 10 * p->rounding && p->apart == 0 && !(p->f_n > 0) && t->law.kn > 0)
        tl_check_note(t->c, TL_LAW_PULLS, "f_n = %g N of walls that press each other by %g m, closure and lift", p->f_n,
                      p->u);
    if (p->u < -p->rounding && p->f_n == 0 && p->no_shear && !(t->out.flags[i] & TL_POINT_OPEN))
        tl_check_note(t->c, TL_LAW_FLAGS, "a point that carries nothing across a gap of %g m is not flagged as open",
                      -p->u);
    if (p->u >= 0)
        t->unmet[i] = false;
}

static void check_flags(tl_law_trial *t)
{
    const uint32_t known = TL_POINT_SLIPPING | TL_POINT_OPEN | TL_POINT_FAILED | TL_POINT_APART;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint32_t was = t->in.flags[i], is = t->out.flags[i];
        double shear = tl_v3_norm(tl_check_vec(t->out.c[TL_AT_F_S], i)), f_n = t->out.c[TL_AT_F_N][i];
        if (is & ~known)
            tl_check_note(t->c, TL_LAW_FLAGS, "flags are %u, of which only %u have a meaning", is, known);
        if (is & TL_POINT_OPEN && (f_n != 0 || shear != 0))
            tl_check_note(t->c, TL_LAW_FLAGS, "a point that is flagged as open carries f_n = %g N, |f_s| = %g N", f_n,
                          shear);
        if (was & ~is & TL_POINT_FAILED)
            tl_check_note(t->c, TL_LAW_FLAGS, "a point that had failed is whole again: the flag is to stay");
        t->seen.slips |= (is & TL_POINT_SLIPPING) != 0;
    }
}

void tl_law_check_normal(tl_law_trial *t, int step)
{
    const tl_law_ops *ops = t->law.ops;
    tl_check_gaps gaps;
    tl_check_points at = t->out;
    double energy[3][TL_CHECK_POINTS], force[3][TL_CHECK_POINTS];
    tl_law_gaps(&t->law, &t->out, &gaps);
    memcpy(at.c[TL_AT_CLOSURE], t->in.c[TL_AT_CLOSURE], sizeof at.c[TL_AT_CLOSURE]);
    for (int k = 0; k < 3 && !ops->linear && ops->pressed; k++)
        pressed_at(&t->law, &at, (k - 1) * SMALL * t->law.closure, energy[k], force[k]);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        point p = point_at(t, &gaps, i, step);
        check_gap(t, &p, i);
        check_initial(t, &p, i);
        if (ops->linear)
            check_linear(t, &p);
        else if (ops->pressed)
            check_pressed(t, &p, (double[3]){energy[0][i], energy[1][i], energy[2][i]}, force[1][i]);
        if (!ops->linear && ops->pressed && isnan(force[1][i]) != isnan(force[1][0]))
            tl_check_note(t->c, TL_LAW_PRESSES, "pressed() tells the forces of some points and not of others");
    }
    check_flags(t);
}
