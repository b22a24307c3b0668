/* law.h - the checks of a law, by number, and what they share. */
#ifndef TL_CHECK_LAW_H
#define TL_CHECK_LAW_H

#include "check/points.h"

enum {
    TL_LAW_RUNS,
    TL_LAW_REPEATS,
    TL_LAW_ALONE,
    TL_LAW_SPLIT,
    TL_LAW_ENERGIES,
    TL_LAW_WRITES,
    TL_LAW_PADDING,
    TL_LAW_FINITE,
    TL_LAW_PLANE,
    TL_LAW_STILL,
    TL_LAW_TURNED,
    TL_LAW_STIFFNESS,
    TL_LAW_CYCLE,
    TL_LAW_STATES,
    TL_LAW_PULLS
};

/* s, of a step. */
#define TL_CHECK_DT 1e-4

/* A law with a set of parameters, and what it is moved by. */
typedef struct tl_check_law {
    tl_check_law_of of;
    double kn, ks;         /* Pa/m, of stiffness() */
    double stress;         /* Pa, that the motion is to lead to */
    double closure, slide; /* m, by which kn and ks give it */
} tl_check_law;

/* law_cycle.c: closed paths of motion give no energy. */
void tl_check_cycles(tl_checker *c, const tl_check_law *law);

#endif
