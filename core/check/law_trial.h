/* law_trial.h - a law that is tried: the checks by number, and what they share. */
#ifndef TL_CHECK_LAW_TRIAL_H
#define TL_CHECK_LAW_TRIAL_H

#include "check/checker.h"
#include "check/points.h"

enum {
    TL_LAW_RUNS,
    TL_LAW_REPEATS,
    TL_LAW_ALONE,
    TL_LAW_SPLIT,
    TL_LAW_ENERGIES,
    TL_LAW_WRITES,
    TL_LAW_READS,
    TL_LAW_PADDING,
    TL_LAW_FINITE,
    TL_LAW_PLANE,
    TL_LAW_STILL,
    TL_LAW_TURNED,
    TL_LAW_AREA,
    TL_LAW_STIFFNESS,
    TL_LAW_CYCLE,
    TL_LAW_BALANCE,
    TL_LAW_HEAT,
    TL_LAW_STEPS,
    TL_LAW_STATES,
    TL_LAW_PARAMETERS,
    TL_LAW_FLAGS,
    TL_LAW_PULLS,
    TL_LAW_PRESSES
};

/* Constant: s, of a step. */
#define TL_CHECK_DT 1e-4
/* Tolerance: relative error of forces that rounding explains: some thousand roundings. Test: unit/test_check. */
#define TL_CHECK_ROUNDING 1e-11
/* Parameters of a law whose effect is looked for, at most. */
#define TL_CHECK_PARAMS 64

/* A law with a set of parameters, and what it is moved by. */
typedef struct tl_check_law {
    tl_check_law_of of;
    double kn, ks;         /* Pa/m, of stiffness() */
    double stress;         /* Pa, that the motion is to lead to */
    double closure, slide; /* M, by which kn and ks give it */
} tl_check_law;

/* What has been seen with one set of parameters or another. */
typedef struct tl_check_seen {
    uint32_t written;              /* Bit k: state column k has been written */
    uint32_t read;                 /* ... what else the law gives depends on it */
    uint32_t kept;                 /* ... its own next value depends on it */
    bool slips, heats;             /* A point was flagged as slipping; shear was turned to heat */
    bool matters[TL_CHECK_PARAMS]; /* What the law gives depends on that parameter */
} tl_check_seen;

/* One set of parameters, and the points as they are. */
typedef struct tl_law_trial {
    tl_checker *c;
    tl_check_law law;
    tl_check_points now, in, out;
    double scale[TL_CHECK_POINTS]; /* N, of a point's forces */
    bool unmet[TL_CHECK_POINTS];   /* Made apart, and the walls have not met since */
    tl_check_seen *seen;
} tl_law_trial;

/* What points carry where their walls are apart, as the host finds it: what lifts them, m, the share of tension that they hold
 * in a part apart, and in a point that is wholly apart. */
typedef struct tl_check_gaps {
    double lift[TL_CHECK_POINTS], hold[TL_CHECK_POINTS], bond[TL_CHECK_POINTS];
} tl_check_gaps;

/* Calls the law and notes what every call must keep to; false when it failed. */
bool tl_law_call(tl_law_trial *t, const tl_check_points *in, tl_check_points *out,
                 const size_t *order, size_t begin, size_t count, tl_check_call *call);
/* Whether two calls gave the point the same, to the bit. */
bool tl_law_same(const tl_check_points *a, const tl_check_points *b, size_t i, bool energies);

#endif
