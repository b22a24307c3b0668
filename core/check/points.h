/* points.h - contact points as columns, and calling a law on some of them as the host would. */
#ifndef TL_CHECK_POINTS_H
#define TL_CHECK_POINTS_H

#include "check/checker.h"

/* Points that a law is tried with at once. */
#define TL_CHECK_POINTS 64
/* Lanes of the longest batch, in which points are there more than once: no multiple of what a law may take at a time. */
#define TL_CHECK_LANES (2 * TL_CHECK_POINTS + TL_LANES)

/* Columns of a batch. */
enum {
    TL_AT_AREA,
    TL_AT_CLOSURE,
    TL_AT_F_N0,
    TL_AT_NORMAL,
    TL_AT_DU_N = TL_AT_NORMAL + 3,
    TL_AT_DU_S,
    TL_AT_EDGE = TL_AT_DU_S + 3,
    TL_AT_APART,
    TL_AT_F_N, /* from here on the law writes */
    TL_AT_F_S,
    TL_AT_STORED = TL_AT_F_S + 3,
    TL_AT_DISSIPATED,
    TL_AT_STATE,
    TL_AT_COUNT = TL_AT_STATE + TL_STATE_COLUMNS
};

typedef struct tl_check_points {
    double c[TL_AT_COUNT][TL_CHECK_POINTS];
    uint32_t flags[TL_CHECK_POINTS];
    double dt;
} tl_check_points;

/* A law with its parameters. */
typedef struct tl_check_law_of {
    const tl_kind *kind;
    const tl_law_ops *ops;
    const void *self;
    uint32_t columns; /* of its states */
    double initial[TL_STATE_COLUMNS];
    bool tangent[TL_STATE_COLUMNS];   /* the first column of a tangent */
    bool extensive[TL_STATE_COLUMNS]; /* goes with the area */
    bool resets[TL_STATE_COLUMNS];    /* begins anew where the area changes */
} tl_check_law_of;

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

/* Calls the law on the points order[begin] .. order[begin + count - 1] (all in turn when `order` is NULL), in a batch of
 * their own that is padded, between guards, and writes what it gives to `out`; of a point that is there twice what the last gives.
 * At most TL_CHECK_LANES. */
void tl_check_call_law(const tl_check_law_of *law, const tl_check_points *in, tl_check_points *out,
                       const size_t *order, size_t begin, size_t count, tl_check_call *call);

/* A number that fills what belongs to nobody, of a size that goes with the column; `other`: another one. */
double tl_check_nobodys(int column, bool other);

static inline tl_vec3 tl_check_vec(const tl_check_points *p, int column, size_t i)
{
    return tl_v3(p->c[column][i], p->c[column + 1][i], p->c[column + 2][i]);
}

static inline void tl_check_put(tl_check_points *p, int column, size_t i, tl_vec3 v)
{
    p->c[column][i] = v.x;
    p->c[column + 1][i] = v.y;
    p->c[column + 2][i] = v.z;
}

#endif
