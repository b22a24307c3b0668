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

/* s, of a step. */
#define TL_CHECK_DT 1e-4
/* Relative error of forces that rounding explains: some thousand roundings. */
#define TL_CHECK_ROUNDING 1e-11
/* Parameters of a law whose effect is looked for, at most. */
#define TL_CHECK_PARAMS 64

/* A law with a set of parameters, and what it is moved by. */
typedef struct tl_check_law {
    tl_check_law_of of;
    double kn, ks;         /* Pa/m, of stiffness() */
    double stress;         /* Pa, that the motion is to lead to */
    double closure, slide; /* m, by which kn and ks give it */
} tl_check_law;

/* What has been seen with one set of parameters or another. */
typedef struct tl_check_seen {
    uint32_t written;              /* bit k: state column k has been written */
    uint32_t read;                 /* ... what else the law gives depends on it */
    uint32_t kept;                 /* ... its own next value depends on it */
    bool slips, heats;             /* a point was flagged as slipping; shear was turned to heat */
    bool matters[TL_CHECK_PARAMS]; /* what the law gives depends on that parameter */
} tl_check_seen;

/* One set of parameters, and the points as they are. */
typedef struct tl_law_trial {
    tl_checker *c;
    tl_check_law law;
    tl_check_points now, in, out;
    double scale[TL_CHECK_POINTS]; /* N, of a point's forces */
    bool unmet[TL_CHECK_POINTS];   /* made apart, and the walls have not met since */
    tl_check_seen *seen;
} tl_law_trial;

/* What points carry where their walls are apart, as the host finds it: what lifts them, m, the share of tension that they hold
 * in a part apart, and in a point that is wholly apart. */
typedef struct tl_check_gaps {
    double lift[TL_CHECK_POINTS], hold[TL_CHECK_POINTS], bond[TL_CHECK_POINTS];
} tl_check_gaps;

/* law_call.c: calls the law and notes what every call must keep to; false when it failed. */
bool tl_law_call(tl_law_trial *t, const tl_check_points *in, tl_check_points *out,
                 const size_t *order, size_t begin, size_t count, tl_check_call *call);
/* Whether two calls gave the point the same, to the bit. */
bool tl_law_same(const tl_check_points *a, const tl_check_points *b, size_t i, bool energies);

/* law_normal.c: the normal force, what it stores and what is told of gaps. */
void tl_law_gaps(const tl_check_law *law, const tl_check_points *p, tl_check_gaps *gaps);
/* Closure at the outermost fibre, `below` that in the middle; where a part is apart, that of a joint that opens in a line. */
double tl_law_edge(double closure, double apart, double lift, double below);
void tl_law_check_normal(tl_law_trial *t, int step);
void tl_law_check_flags(tl_law_trial *t);

/* law_area.c: what goes with the area. */
void tl_law_check_area(tl_law_trial *t);

/* law_reads.c: what the law gives depends on its parameters and states, and on nothing that is not its own. */
void tl_law_check_reads(tl_law_trial *t);
void tl_law_see_states(tl_law_trial *t);
void tl_law_see_params(tl_law_trial *t, tl_check_law varied[], const bool open[]);
void tl_law_tell_unseen(tl_checker *c, const tl_check_seen *seen);

/* law_energy.c: the work on paths of motion is stored or turned to heat, and closed ones give no energy. */
void tl_law_check_energy(tl_law_trial *t);
/* law_steps.c: the same path in steps of other lengths. */
void tl_law_check_steps(tl_law_trial *t);

#endif
