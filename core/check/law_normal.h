/* law_normal.h - the normal force, and what a law tells of it. */
#ifndef TL_CHECK_LAW_NORMAL_H
#define TL_CHECK_LAW_NORMAL_H

#include "check/law_trial.h"
#include "check/points.h"

/* The normal force, what it stores and what is told of gaps. */
void tl_law_gaps(const tl_check_law *law, const tl_check_points *p, tl_check_gaps *gaps);
/* Closure at the outermost fibre, `below` that in the middle; where a part is apart, that of a joint that opens in a line. */
double tl_law_edge(double closure, double apart, double lift, double below);
void tl_law_check_normal(tl_law_trial *t, int step);
void tl_law_check_flags(tl_law_trial *t);

#endif
