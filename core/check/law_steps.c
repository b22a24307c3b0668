/* law_steps.c - shear of one direction, at a constant closure, leads to the same force whether it is made in a few steps or in
 * many. A law that forgets a state between the steps, or finds the wrong slip of a step, does not keep to this. */
#include "check/law_steps.h"

#include "check/checker.h"
#include "check/law_trial.h"
#include "check/params.h"
#include "check/points.h"

#include <math.h>
#include <string.h>

/* Steps of the coarse path and of the fine one; both take the same time, s. */
#define COARSE 12
#define FINE 96
#define TIME (FINE * TL_CHECK_DT)
/* Tolerance: share of the force by which the two may differ, for the path in few steps is not exact. Where a joint
 * jumps they differ by more, so that most points that slip must, and some number of them. Test: unit/test_check. */
#define ERROR 0.1
#define SOME 12
/* Tolerance: share of the stress that the path leads to below which a stress is none. Test: unit/test_check. */
#define FAINT 1e-3

static void begin(const tl_law_trial *t, tl_check_points *p, tl_vec3 slide[TL_CHECK_POINTS])
{
    memset(p, 0, sizeof *p);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = tl_key(tl_key(2001, (uint64_t)t->c->set), i);
        double area = tl_check_scale(tl_key(key, 1), -1, 1);
        tl_vec3 normal = tl_check_direction(tl_key(key, 2)),
                any = tl_check_direction(tl_key(key, 3));
        double size = t->law.slide * tl_check_scale(tl_key(key, 4), -1, 2.5);
        any = tl_v3_sub(any, tl_v3_scale(tl_v3_dot(any, normal), normal));
        slide[i] = tl_v3_scale(size, any);
        p->c[TL_AT_AREA][i] = area;
        p->c[TL_AT_CLOSURE][i] = p->c[TL_AT_EDGE][i] =
            t->law.closure * tl_check_between(tl_key(key, 5), 0.2, 1);
        p->c[TL_AT_DU_N][i] = -p->c[TL_AT_CLOSURE][i];
        tl_check_put(p, TL_AT_NORMAL, i, normal);
        for (uint32_t k = 0; k < t->law.of.columns; k++)
            p->c[TL_AT_STATE + k][i] = t->law.of.initial[k];
    }
}

/* `pressed`: normal forces before the shear. */
static bool walk(tl_law_trial *t, int steps, tl_check_points *p, double pressed[TL_CHECK_POINTS])
{
    tl_vec3 slide[TL_CHECK_POINTS];
    begin(t, p, slide);
    for (int k = 0; k <= steps; k++) { /* the first closes the joint */
        tl_check_call call = {0};
        tl_check_points in = *p;
        in.dt = k > 0 ? TIME / steps : 0;
        for (size_t i = 0; i < TL_CHECK_POINTS && k > 0; i++) {
            in.c[TL_AT_DU_N][i] = 0;
            tl_check_put(&in, TL_AT_DU_S, i, tl_v3_scale(1.0 / steps, slide[i]));
        }
        *p = in;
        tl_check_call_law(&t->law.of, &in, p, NULL, 0, TL_CHECK_POINTS, &call);
        if (call.status != TL_OK)
            return false;
        if (k == 0)
            memcpy(pressed, p->c[TL_AT_F_N], sizeof p->c[TL_AT_F_N]);
    }
    return true;
}

void tl_law_check_steps(tl_law_trial *t)
{
    tl_check_points coarse, fine;
    double before[TL_CHECK_POINTS];
    int differ = 0, slip = 0;
    size_t worst = 0;
    double most = 0;
    if (tl_check_failed(t->c, TL_LAW_STEPS) || !walk(t, COARSE, &coarse, before) ||
        !walk(t, FINE, &fine, before))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(&coarse, TL_AT_F_S, i), b = tl_check_vec(&fine, TL_AT_F_S, i);
        double pressed = coarse.c[TL_AT_F_N][i], presses = fine.c[TL_AT_F_N][i];
        double error = fmax(tl_v3_norm(tl_v3_sub(a, b)), fabs(pressed - presses));
        double size = tl_v3_norm(b) + fabs(presses);
        double faint = FAINT * t->law.stress * fine.c[TL_AT_AREA][i];
        /* dilation that changes the pressure itself may follow from that of the beginning of a step */
        if (fabs(presses - before[i]) > ERROR * before[i])
            continue;
        double share = error / (ERROR * size + faint);
        differ += share > 1;
        slip += share > 1 || fine.flags[i] & TL_POINT_SLIPPING;
        worst = share > most ? i : worst;
        most = fmax(most, share);
    }
    if (differ >= SOME && 2 * differ > slip)
        tl_check_note(t->c, TL_LAW_STEPS,
                      "the same shear, made in %d steps, leads to |f_s| = %.5g N, f_n = %.5g N, "
                      "and in %d steps "
                      "to %.5g N, %.5g N",
                      COARSE, tl_v3_norm(tl_check_vec(&coarse, TL_AT_F_S, worst)),
                      coarse.c[TL_AT_F_N][worst], FINE,
                      tl_v3_norm(tl_check_vec(&fine, TL_AT_F_S, worst)), fine.c[TL_AT_F_N][worst]);
}
