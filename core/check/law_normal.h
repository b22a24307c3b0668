/* law_normal.h - what a law tells of the normal force, and whether that is so. */
#ifndef TL_CHECK_LAW_NORMAL_H
#define TL_CHECK_LAW_NORMAL_H

#include "check/law_points.h"

/* What points carry where their walls are apart, as the host finds it: what lifts them, m, the share of tension that
 * they hold in a part apart, and in a point that is wholly apart. */
typedef struct tl_check_gaps {
    double lift[TL_CHECK_POINTS], hold[TL_CHECK_POINTS], bond[TL_CHECK_POINTS];
} tl_check_gaps;

/* What the law tells of the points at their closures. */
void tl_law_gaps(const tl_check_law *law, const tl_check_points *p, tl_check_gaps *gaps);
/* Closure at the outermost fibre, `below` that in the middle; where a part is apart, that of a joint that opens in a
 * line. */
double tl_law_edge(double closure, double apart, double lift, double below);

/* After a step from t->in to t->out: the normal force and the flags. */
void tl_law_check_normal(tl_law_trial *t, int step);

#endif
