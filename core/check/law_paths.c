/* law_paths.c - paths of closure and shear: what the walls' work puts into a point is stored or turned to heat, and a
 * closed path gives no energy.
 *
 *     W = sum of (f_n + f_n')/2 d(closure) - (f_s + f_s')/2 . du_s
 *     W - heat = stored - stored at the beginning,        W >= 0 over a closed path, J
 *
 * Every point begins and ends at the same place, on a path of straight parts of its own: closing, opening, small and
 * large shear, out of the plane of those before as well. Of eight points one is pressed by an initial force, and one is
 * made while its walls are apart. Of one a part is apart, which does work of its own. The work is a sum of means, so
 * where a force bends it is wrong by its change within a small step; the bound allows for that.
 *
 * Shear of one direction, at a constant closure, leads to the same force whether it is made in a few steps or in many.
 * A law that forgets a state between the steps, or finds the wrong slip of a step, does not keep to this. */
#include "check/law_paths.h"

#include "check/law_normal.h"

#include <math.h>
#include <string.h>

/* Corners of a path, and steps from one to the next. */
#define CORNERS 7
#define STEPS 150
/* Tolerance: energy that may seem to be made or lost, relative to the work of all steps: the error of the sum, where
 * forces bend, and of steps with heat, in which forces bend less. A heat by the force at the end of a step errs by
 * more. Test: unit/test_check. */
#define ERROR 2e-3
#define HEAT_ERROR 2e-4
/* Tolerance: heat of a step, of its work, below which it is rounding. */
#define NO_HEAT 1e-9

/* What a point of a path is. */
enum { PRESSED = 4, PRESSED_SHUT, APART, PARTLY, SORTS };

/* A place on a path, relative to where it begins. */
typedef struct place {
    double closure, apart;
    tl_vec3 slide;
} place;

/* What has been found of a point, J. */
typedef struct sums {
    double work, size;   /* size: of all steps, whatever their sign */
    double stored, heat; /* stored: at the end of the last step; heat: so far */
    double without_heat,
        with_heat; /* work that was neither stored nor turned to heat, or too much of it, in steps of either sort */
    double least;  /* of the heat of a step */
} sums;

typedef struct walk {
    const tl_check_law *law;
    tl_check_points at;
    place from[TL_CHECK_POINTS], to[TL_CHECK_POINTS];
    sums of[TL_CHECK_POINTS];
    double begins[TL_CHECK_POINTS], fibre[TL_CHECK_POINTS]; /* closure; m, of the edge below it */
    tl_check_seen *seen;
} walk;

static place corner_of(const tl_checker *c, const tl_check_law *law, size_t point, int corner, tl_vec3 normal)
{
    bool partly = point % SORTS == PARTLY;
    place at = {.closure = partly && corner > 0 && corner < CORNERS ? 0.5 * law->closure : 0};
    if (corner == 0 || corner == CORNERS)
        return at;
    uint64_t key = tl_key(tl_key(tl_key(1971, (uint64_t)c->set), point), (uint64_t)corner);
    double size = law->slide * tl_check_scale(tl_key(key, 2), -1.5, 1);
    bool opens = point % 2 && point % SORTS != PRESSED_SHUT;
    at.slide = tl_law_tangent(tl_key(key, 1), normal, size);
    if (!partly)
        at.closure = law->closure * tl_check_between(tl_key(key, 3), opens ? -0.3 : 0.05, 1);
    else if (corner > 1 && corner < CORNERS - 1)
        at.apart = law->closure * tl_check_between(tl_key(key, 3), 0, 0.5);
    return at;
}

static void begin(const tl_checker *c, walk *w)
{
    const tl_check_law *law = w->law;
    tl_check_points *p = &w->at;
    memset(p, 0, sizeof *p);
    p->dt = TL_CHECK_DT;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = tl_key(tl_key(1976, (uint64_t)c->set), i);
        size_t sort = i % SORTS;
        double area = tl_check_scale(tl_key(key, 1), -1, 1);
        tl_law_begin(law, p, i, area, tl_check_direction(tl_key(key, 2)));
        if (sort == PRESSED || sort == PRESSED_SHUT)
            p->c[TL_AT_F_N0][i] = area * law->stress * tl_check_between(tl_key(key, 3), 0, 1);
        if (sort == APART)
            p->flags[i] = TL_POINT_APART;
        w->begins[i] = sort == APART ? -0.3 * law->closure : 0;
        w->fibre[i] = i % 3 ? 0 : 0.05 * law->closure;
        p->c[TL_AT_CLOSURE][i] = w->begins[i];
    }
}

/* Puts the points to the part `share` of the way between the corners. */
static void move(const walk *w, double share, double before, tl_check_points *in)
{
    tl_check_gaps gaps;
    tl_law_gaps(w->law, in, &gaps);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        const place *from = &w->from[i], *to = &w->to[i];
        double closure = w->begins[i] + from->closure + (to->closure - from->closure) * share;
        double apart = from->apart + (to->apart - from->apart) * share;
        tl_vec3 du = tl_v3_scale(share - before, tl_v3_sub(to->slide, from->slide));
        in->c[TL_AT_DU_N][i] = (in->c[TL_AT_CLOSURE][i] - in->c[TL_AT_APART][i]) - (closure - apart);
        in->c[TL_AT_CLOSURE][i] = closure;
        in->c[TL_AT_APART][i] = apart;
        in->c[TL_AT_EDGE][i] = tl_law_edge(closure, apart, gaps.lift[i], w->fibre[i]);
        tl_check_put(in->c[TL_AT_DU_S], i, du);
    }
}

/* Adds what a step from `was` to `in`, which gave `out`, comes to. */
static void add_up(walk *w, const tl_check_points *was, const tl_check_points *in, const tl_check_points *out)
{
    tl_check_gaps before, after;
    tl_law_gaps(w->law, was, &before);
    tl_law_gaps(w->law, out, &after);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        sums *s = &w->of[i];
        double spring = w->law->kn * in->c[TL_AT_AREA][i];
        /* the part apart pulls, what presses beside it presses more */
        double apart0 = was->c[TL_AT_APART][i], apart1 = in->c[TL_AT_APART][i];
        double pull0 = spring * before.hold[i] * apart0, pull1 = spring * after.hold[i] * apart1;
        double closing = in->c[TL_AT_CLOSURE][i] - was->c[TL_AT_CLOSURE][i];
        double presses = in->c[TL_AT_F_N][i] + pull0 + out->c[TL_AT_F_N][i] + pull1;
        double across = 0.5 * (presses * closing + (pull0 + pull1) * (apart1 - apart0));
        tl_vec3 shear = tl_v3_add(tl_check_vec(in->c[TL_AT_F_S], i), tl_check_vec(out->c[TL_AT_F_S], i));
        double along = -0.5 * tl_v3_dot(shear, tl_check_vec(in->c[TL_AT_DU_S], i));
        double stored = out->c[TL_AT_STORED][i], heat = out->c[TL_AT_DISSIPATED][i];
        double left = across + along - heat - (stored - s->stored), size = fabs(across) + fabs(along);
        if ((apart0 > 0 || apart1 > 0) && before.lift[i] != after.lift[i])
            left = 0; /* how much of the area slip closes the law cannot know */
        *(heat > NO_HEAT * size ? &s->with_heat : &s->without_heat) += fabs(left);
        s->work += across + along;
        s->size += size;
        s->heat += heat;
        s->least = fmin(s->least, heat);
        s->stored = stored;
        bool lets_go = (out->flags[i] & (TL_POINT_FAILED | TL_POINT_OPEN)) != 0;
        w->seen->heats |= heat > 0.1 * size && size > 0 && !lets_go;
    }
}

/* A step to `share` of the way between the corners. */
static bool step(walk *w, int number)
{
    tl_check_points in = w->at, out;
    move(w, (double)(number + 1) / STEPS, (double)number / STEPS, &in);
    tl_status status = tl_law_call_all(w->law, &in, &out);
    add_up(w, &w->at, &in, &out);
    w->at = out;
    return status == TL_OK;
}

/* What is stored before the first step. */
static bool rest(walk *w)
{
    tl_check_points in = w->at;
    in.dt = 0;
    move(w, 0, 0, &in);
    tl_status status = tl_law_call_all(w->law, &in, &w->at);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        w->of[i].stored = w->at.c[TL_AT_STORED][i];
    w->at.dt = TL_CHECK_DT;
    return status == TL_OK;
}

static void judge(tl_law_trial *t, const walk *w, const double stored[TL_CHECK_POINTS])
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        const sums *s = &w->of[i];
        bool closed = i % SORTS < PRESSED || i % SORTS == PARTLY;
        double all = s->size + stored[i], most = ERROR * all, left = s->work - s->heat - (s->stored - stored[i]);
        if (closed && s->work < -most)
            tl_check_note(t->c, TL_LAW_CYCLE,
                          "%.3g J come out of a closed path of motion on which %.3g J went in and out", -s->work,
                          s->size);
        if (s->least < -NO_HEAT * s->size)
            tl_check_note(t->c, TL_LAW_HEAT, "dissipated = %.3g J in a step, which must not be negative", s->least);
        if (s->without_heat > most)
            tl_check_note(t->c, TL_LAW_BALANCE,
                          "%.3g J of the work are %s in steps without heat: stored does not change by the work of the "
                          "forces (work %.3g J, stored %.3g J at the end)",
                          s->without_heat, left > 0 ? "lost" : "made", s->work, s->stored);
        if (s->with_heat > HEAT_ERROR * all)
            tl_check_note(t->c, TL_LAW_BALANCE,
                          "%.3g J of the work are %s in steps with heat: dissipated is not the work less what is "
                          "stored (work %.3g J, stored %.3g J at the end, heat %.3g J)",
                          s->with_heat, left > 0 ? "lost" : "made", s->work, s->stored, s->heat);
    }
}

static void check_energy(tl_law_trial *t)
{
    walk w = {.law = &t->law, .seen = &t->seen};
    double stored[TL_CHECK_POINTS];
    begin(t->c, &w);
    for (int corner = 0; corner < CORNERS; corner++) {
        for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
            tl_vec3 normal = tl_check_vec(w.at.c[TL_AT_NORMAL], i);
            w.from[i] = corner_of(t->c, &t->law, i, corner, normal);
            w.to[i] = corner_of(t->c, &t->law, i, corner + 1, normal);
        }
        if (corner == 0 && !rest(&w))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS && corner == 0; i++)
            stored[i] = w.of[i].stored;
        for (int number = 0; number < STEPS; number++)
            if (!step(&w, number))
                return;
    }
    judge(t, &w, stored);
}

/* ---------------------------------------------------------------- few steps or many ------ */

/* Steps of the coarse path and of the fine one; both take the same time, s. */
#define COARSE 12
#define FINE 96
#define TIME (FINE * TL_CHECK_DT)
/* Tolerance: share of the force by which the two may differ, for the path in few steps is not exact. Where a joint
 * jumps they differ by more, so that most points that slip must, and some number of them. Test: unit/test_check. */
#define DIFFERENCE 0.1
#define SOME 12
/* Tolerance: share of the stress that the path leads to below which a stress is none. */
#define FAINT 1e-3

static void begin_shear(const tl_law_trial *t, tl_check_points *p, tl_vec3 slide[TL_CHECK_POINTS])
{
    memset(p, 0, sizeof *p);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = tl_key(tl_key(2001, (uint64_t)t->c->set), i);
        double area = tl_check_scale(tl_key(key, 1), -1, 1);
        tl_vec3 normal = tl_check_direction(tl_key(key, 2));
        double size = t->law.slide * tl_check_scale(tl_key(key, 4), -1, 2.5);
        slide[i] = tl_law_tangent(tl_key(key, 3), normal, size);
        tl_law_begin(&t->law, p, i, area, normal);
        p->c[TL_AT_CLOSURE][i] = p->c[TL_AT_EDGE][i] = t->law.closure * tl_check_between(tl_key(key, 5), 0.2, 1);
        p->c[TL_AT_DU_N][i] = -p->c[TL_AT_CLOSURE][i];
    }
}

/* `pressed`: normal forces before the shear. */
static bool shear_in(tl_law_trial *t, int steps, tl_check_points *p, double pressed[TL_CHECK_POINTS])
{
    tl_vec3 slide[TL_CHECK_POINTS];
    begin_shear(t, p, slide);
    for (int k = 0; k <= steps; k++) { /* the first closes the joint */
        tl_check_points in = *p;
        in.dt = k > 0 ? TIME / steps : 0;
        for (size_t i = 0; i < TL_CHECK_POINTS && k > 0; i++) {
            in.c[TL_AT_DU_N][i] = 0;
            tl_check_put(in.c[TL_AT_DU_S], i, tl_v3_scale(1.0 / steps, slide[i]));
        }
        if (tl_law_call_all(&t->law, &in, p) != TL_OK)
            return false;
        if (k == 0)
            memcpy(pressed, p->c[TL_AT_F_N], sizeof p->c[TL_AT_F_N]);
    }
    return true;
}

static void check_steps(tl_law_trial *t)
{
    tl_check_points coarse, fine;
    double before[TL_CHECK_POINTS];
    int differ = 0, slip = 0;
    size_t worst = 0;
    double most = 0;
    if (tl_check_failed(t->c, TL_LAW_STEPS) || !shear_in(t, COARSE, &coarse, before) ||
        !shear_in(t, FINE, &fine, before))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(coarse.c[TL_AT_F_S], i), b = tl_check_vec(fine.c[TL_AT_F_S], i);
        double pressed = coarse.c[TL_AT_F_N][i], presses = fine.c[TL_AT_F_N][i];
        double error = fmax(tl_v3_norm(tl_v3_sub(a, b)), fabs(pressed - presses));
        double size = tl_v3_norm(b) + fabs(presses);
        double faint = FAINT * t->law.stress * fine.c[TL_AT_AREA][i];
        /* dilation that changes the pressure itself may follow from that of the beginning of a step */
        if (fabs(presses - before[i]) > DIFFERENCE * before[i])
            continue;
        double share = error / (DIFFERENCE * size + faint);
        differ += share > 1;
        slip += share > 1 || fine.flags[i] & TL_POINT_SLIPPING;
        worst = share > most ? i : worst;
        most = fmax(most, share);
    }
    if (differ >= SOME && 2 * differ > slip)
        tl_check_note(t->c, TL_LAW_STEPS,
                      "the same shear, made in %d steps, leads to |f_s| = %.5g N, f_n = %.5g N, and in %d steps to "
                      "%.5g N, %.5g N",
                      COARSE, tl_v3_norm(tl_check_vec(coarse.c[TL_AT_F_S], worst)), coarse.c[TL_AT_F_N][worst], FINE,
                      tl_v3_norm(tl_check_vec(fine.c[TL_AT_F_S], worst)), fine.c[TL_AT_F_N][worst]);
}

void tl_law_check_paths(tl_law_trial *t)
{
    check_energy(t);
    check_steps(t);
}
