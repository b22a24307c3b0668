/* law_points.h - a law that is tried: its contact points, calling it on some of them as the host would, and the checks
 * by number. */
#ifndef TL_CHECK_LAW_POINTS_H
#define TL_CHECK_LAW_POINTS_H

#include "base/law_columns.h"
#include "check/checker.h"

/* The checks: number, name, and what each asks. */
#define TL_LAW_RULES(RULE)                                                                                             \
    RULE(TL_LAW_RUNS, "runs", "update() returns TL_OK, always when never_fails is set")                                \
    RULE(TL_LAW_REPEATS, "repeats", "the same call gives the same bits")                                               \
    RULE(TL_LAW_ALONE, "one by one", "a point alone gets the bits that it gets in a batch")                            \
    RULE(TL_LAW_SPLIT, "split", "batches of other sizes and orders give the same bits")                                \
    RULE(TL_LAW_ENERGIES, "energies", "forces do not depend on whether energies are asked for")                        \
    RULE(TL_LAW_WRITES, "writes", "nothing is written but forces, flags, energies and declared states")                \
    RULE(TL_LAW_READS, "reads", "nothing depends on states that are not declared, nor on what is to be written")       \
    RULE(TL_LAW_PADDING, "padding", "lanes of no area carry nothing")                                                  \
    RULE(TL_LAW_FINITE, "finite", "forces, states and energies are finite numbers")                                    \
    RULE(TL_LAW_PLANE, "plane", "the shear force lies in the common plane")                                            \
    RULE(TL_LAW_STILL, "no motion", "without motion and time the forces stay as they are")                             \
    RULE(TL_LAW_TURNED, "turned", "a turned point gets the turned forces, the same energies and states")               \
    RULE(TL_LAW_AREA, "area", "twice the area carries twice the force and the energy")                                 \
    RULE(TL_LAW_STIFFNESS, "stiffness", "no point is stiffer than stiffness() says")                                   \
    RULE(TL_LAW_CYCLE, "closed cycle", "a closed path of motion gives no energy")                                      \
    RULE(TL_LAW_BALANCE, "balance", "the work on a path is stored or turned to heat")                                  \
    RULE(TL_LAW_HEAT, "heat", "dissipated is not negative, and 0 without motion")                                      \
    RULE(TL_LAW_STEPS, "steps", "shear in a few steps leads to the forces that it does in many")                       \
    RULE(TL_LAW_STATES, "states",                                                                                      \
         "each declared state is written and read, and none written while stateless() says so")                        \
    RULE(TL_LAW_PARAMETERS, "parameters", "each parameter has an effect")                                              \
    RULE(TL_LAW_FLAGS, "flags", "points that are open carry nothing, those that have failed stay so")                  \
    RULE(TL_LAW_PULLS, "pulls", "no normal force across a gap where pulls() and across_gap() say so")                  \
    RULE(TL_LAW_PRESSES, "presses", "the normal force and what it stores are those that linear or pressed() tells")    \
    RULE(TL_LAW_STRENGTHS, "strengths", "with marked strengths divided by 0.5 and 2 points bear 1/F of what they bore")
#define TL_LAW_NUMBER(number, name, doc) number,
enum { TL_LAW_RULES(TL_LAW_NUMBER) };

/* Constant: s, of a step. */
#define TL_CHECK_DT 1e-4
/* Tolerance: relative error of forces that rounding explains: some thousand roundings. Test: unit/test_check. */
#define TL_CHECK_ROUNDING 1e-11
/* Lanes of the longest batch, in which points are there more than once: no multiple of what a law may take at a
 * time. */
#define TL_CHECK_LANES (2 * TL_CHECK_POINTS + TL_LANES)

typedef struct tl_check_points {
    double c[TL_AT_COUNT][TL_CHECK_POINTS];
    uint32_t flags[TL_CHECK_POINTS];
    double dt;
} tl_check_points;

/* A law with a set of parameters, and what it is moved by. */
typedef struct tl_check_law {
    const tl_kind *kind;
    const tl_law_ops *ops;
    void *self;
    uint32_t columns; /* of its states */
    double initial[TL_STATE_COLUMNS];
    bool tangent[TL_STATE_COLUMNS];   /* the first column of a tangent */
    bool extensive[TL_STATE_COLUMNS]; /* goes with the area */
    bool resets[TL_STATE_COLUMNS];    /* begins anew where the area changes */
    double kn, ks;                    /* Pa/m, of stiffness() */
    double stress;                    /* Pa, that the motion is to lead to */
    double closure, slide;            /* m, by which kn and ks give it */
} tl_check_law;

/* What is filled with other numbers than usually, for nothing may depend on it. */
enum { TL_OTHER_STATES = 1, TL_OTHER_BEHIND = 2, TL_OTHER_ENERGIES = 4, TL_OTHER_ALL = 7 };

/* What a call did besides its work. */
typedef struct tl_check_call {
    uint32_t other;        /* asked: TL_OTHER_* */
    bool no_energies;      /* asked: without the columns of energies */
    tl_status status;      /* of the law */
    const char *overwrote; /* what it must not write to, and has; NULL: nothing */
    bool padding;          /* lanes of no area carry something */
    tl_report report;
} tl_check_call;

/* Calls the law on the points order[begin] .. order[begin + count - 1], or in turn when `order` is NULL; at most
 * TL_CHECK_LANES. They are a batch of their own that is padded, between guards. What the law gives goes to `out`; of a
 * point that is there twice what the last gives. */
void tl_law_call(const tl_check_law *law, const tl_check_points *in, tl_check_points *out, const size_t *order,
                 size_t begin, size_t count, tl_check_call *call);
/* The same on all points, in one batch with energies. */
tl_status tl_law_call_all(const tl_check_law *law, const tl_check_points *in, tl_check_points *out);

/* A point with the states of a new one. */
void tl_law_begin(const tl_check_law *law, tl_check_points *p, size_t i, double area, tl_vec3 normal);
/* A vector in the common plane. */
tl_vec3 tl_law_tangent(uint64_t key, tl_vec3 normal, double size);

/* What has been seen with one set of parameters or another. */
typedef struct tl_check_seen {
    uint32_t written;              /* bit k: state column k has been written */
    uint32_t read;                 /* ... what else the law gives depends on it */
    uint32_t kept;                 /* ... its own next value depends on it */
    bool slips, heats;             /* a point was flagged as slipping; shear was turned to heat */
    bool matters[TL_CHECK_PARAMS]; /* what the law gives depends on that parameter */
    int divided, wrong;            /* sets whose strengths were divided, and those that then bore something else */
    char strengths[300];           /* what the first of these bore */
} tl_check_seen;

/* One set of parameters, and the points as they are. */
typedef struct tl_law_trial {
    tl_checker *c;
    tl_check_law law;
    tl_check_points now, in, out;
    double scale[TL_CHECK_POINTS]; /* N, of a point's forces */
    bool unmet[TL_CHECK_POINTS];   /* made apart, and the walls have not met since */
    tl_check_seen seen;            /* with this set and those before */
} tl_law_trial;

#endif
