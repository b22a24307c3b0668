/* law_energy.c - paths of closure and shear: what the walls' work puts into a point is stored or turned to heat, and a closed
 * path gives no energy.
 *
 *     W = sum of (f_n + f_n')/2 d(closure) - (f_s + f_s')/2 . du_s
 *     W - heat = stored - stored at the beginning,        W >= 0 over a closed path, J
 *
 * Every point begins and ends at the same place, on a path of straight parts of its own: closing, opening, small and large shear,
 * out of the plane of those before as well. Of eight points one is pressed by an initial force, one is made while its walls are
 * apart, and of one a part is apart, which does work of its own. The work is a sum of means, so where a force bends it is wrong by
 * its change within a small step; the bound allows for that. */
#include "check/law_energy.h"

#include "check/checker.h"
#include "check/law_normal.h"
#include "check/law_trial.h"
#include "check/params.h"
#include "check/points.h"

#include <math.h>
#include <string.h>

/* Corners of a path, and steps from one to the next. */
#define CORNERS 7
#define STEPS 150
/* Tolerance: energy that may seem to be made or lost, relative to the work of all steps. The first is the error of the
 * sum, where forces bend. The second is that of steps with heat, in which forces bend less. Laws of Talus err by up to
 * 1e-3 and 5e-5, those with linear springs by 3e-5. A heat by the force at the end of a step errs by more. Test:
 * unit/test_check, python/test_wrong_laws. */
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
    double least; /* of the heat of a step */
} sums;

typedef struct walk {
    const tl_check_law *law;
    tl_check_points at;
    place from[TL_CHECK_POINTS], to[TL_CHECK_POINTS];
    sums of[TL_CHECK_POINTS];
    double begins[TL_CHECK_POINTS], fibre[TL_CHECK_POINTS]; /* closure; m, of the edge below it */
    tl_check_seen *seen;
} walk;

static place corner_of(const tl_checker *c, const tl_check_law *law, size_t point, int corner,
                       tl_vec3 normal)
{
    bool partly = point % SORTS == PARTLY;
    place at = {.closure = partly && corner > 0 && corner < CORNERS ? 0.5 * law->closure : 0};
    if (corner == 0 || corner == CORNERS)
        return at;
    uint64_t key = tl_key(tl_key(tl_key(1971, (uint64_t)c->set), point), (uint64_t)corner);
    tl_vec3 any = tl_check_direction(tl_key(key, 1));
    double size = law->slide * tl_check_scale(tl_key(key, 2), -1.5, 1);
    bool opens = point % 2 && point % SORTS != PRESSED_SHUT;
    any = tl_v3_sub(any, tl_v3_scale(tl_v3_dot(any, normal), normal));
    at.slide = tl_v3_scale(size, any);
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
        p->c[TL_AT_AREA][i] = area;
        tl_check_put(p, TL_AT_NORMAL, i, tl_check_direction(tl_key(key, 2)));
        if (sort == PRESSED || sort == PRESSED_SHUT)
            p->c[TL_AT_F_N0][i] = area * law->stress * tl_check_between(tl_key(key, 3), 0, 1);
        if (sort == APART)
            p->flags[i] = TL_POINT_APART;
        w->begins[i] = sort == APART ? -0.3 * law->closure : 0;
        w->fibre[i] = i % 3 ? 0 : 0.05 * law->closure;
        p->c[TL_AT_CLOSURE][i] = w->begins[i];
        for (uint32_t k = 0; k < law->of.columns; k++)
            p->c[TL_AT_STATE + k][i] = law->of.initial[k];
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
        in->c[TL_AT_DU_N][i] =
            (in->c[TL_AT_CLOSURE][i] - in->c[TL_AT_APART][i]) - (closure - apart);
        in->c[TL_AT_CLOSURE][i] = closure;
        in->c[TL_AT_APART][i] = apart;
        in->c[TL_AT_EDGE][i] = tl_law_edge(closure, apart, gaps.lift[i], w->fibre[i]);
        tl_check_put(in, TL_AT_DU_S, i, du);
    }
}

/* Adds what a step from `was` to `in`, which gave `out`, comes to. */
static void add_up(walk *w, const tl_check_points *was, const tl_check_points *in,
                   const tl_check_points *out)
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
        tl_vec3 shear = tl_v3_add(tl_check_vec(in, TL_AT_F_S, i), tl_check_vec(out, TL_AT_F_S, i));
        double along = -0.5 * tl_v3_dot(shear, tl_check_vec(in, TL_AT_DU_S, i));
        double stored = out->c[TL_AT_STORED][i], heat = out->c[TL_AT_DISSIPATED][i];
        double left = across + along - heat - (stored - s->stored),
               size = fabs(across) + fabs(along);
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
static bool step(tl_law_trial *t, walk *w, int number)
{
    tl_check_points in = w->at, out;
    tl_check_call call = {0};
    move(w, (double)(number + 1) / STEPS, (double)number / STEPS, &in);
    out = in;
    tl_check_call_law(&t->law.of, &in, &out, NULL, 0, TL_CHECK_POINTS, &call);
    add_up(w, &w->at, &in, &out);
    w->at = out;
    return call.status == TL_OK;
}

/* What is stored before the first step. */
static bool rest(tl_law_trial *t, walk *w)
{
    tl_check_call call = {0};
    tl_check_points in = w->at, out;
    in.dt = 0;
    move(w, 0, 0, &in);
    out = in;
    tl_check_call_law(&t->law.of, &in, &out, NULL, 0, TL_CHECK_POINTS, &call);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        w->of[i].stored = out.c[TL_AT_STORED][i];
    w->at = out;
    w->at.dt = TL_CHECK_DT;
    return call.status == TL_OK;
}

static void judge(tl_law_trial *t, const walk *w, const double stored[TL_CHECK_POINTS])
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        const sums *s = &w->of[i];
        bool closed = i % SORTS < PRESSED || i % SORTS == PARTLY;
        double all = s->size + stored[i], most = ERROR * all,
               left = s->work - s->heat - (s->stored - stored[i]);
        if (closed && s->work < -most)
            tl_check_note(
                t->c, TL_LAW_CYCLE,
                "%.3g J come out of a closed path of motion on which %.3g J went in and out",
                -s->work, s->size);
        if (s->least < -NO_HEAT * s->size)
            tl_check_note(t->c, TL_LAW_HEAT,
                          "dissipated = %.3g J in a step, which must not be negative", s->least);
        if (s->without_heat > most)
            tl_check_note(t->c, TL_LAW_BALANCE,
                          "%.3g J of the work are %s in steps without heat: stored does not change "
                          "by the work "
                          "of the forces (work %.3g J, stored %.3g J at the end)",
                          s->without_heat, left > 0 ? "lost" : "made", s->work, s->stored);
        if (s->with_heat > HEAT_ERROR * all)
            tl_check_note(t->c, TL_LAW_BALANCE,
                          "%.3g J of the work are %s in steps with heat: dissipated is not the "
                          "work less what is "
                          "stored (work %.3g J, stored %.3g J at the end, heat %.3g J)",
                          s->with_heat, left > 0 ? "lost" : "made", s->work, s->stored, s->heat);
    }
}

void tl_law_check_energy(tl_law_trial *t)
{
    walk w = {.law = &t->law, .seen = t->seen};
    double stored[TL_CHECK_POINTS];
    begin(t->c, &w);
    for (int corner = 0; corner < CORNERS; corner++) {
        for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
            tl_vec3 normal = tl_check_vec(&w.at, TL_AT_NORMAL, i);
            w.from[i] = corner_of(t->c, &t->law, i, corner, normal);
            w.to[i] = corner_of(t->c, &t->law, i, corner + 1, normal);
        }
        if (corner == 0 && !rest(t, &w))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS && corner == 0; i++)
            stored[i] = w.of[i].stored;
        for (int number = 0; number < STEPS; number++)
            if (!step(t, &w, number))
                return;
    }
    judge(t, &w, stored);
}
