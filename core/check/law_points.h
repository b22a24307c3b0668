/* law_points.h - a law that is tried: its contact points, calling it on some of them as the host would, and the checks
 * by number. */
#ifndef TL_CHECK_LAW_POINTS_H
#define TL_CHECK_LAW_POINTS_H

#include "base/law_columns.h"
#include "check/checker.h"

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
