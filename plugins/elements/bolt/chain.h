/* chain.h - the steel of a bolt and the springs that hold it: find its displacements. */
#ifndef BOLT_CHAIN_H
#define BOLT_CHAIN_H

#include <talus/plugin.h>

#include <stdbool.h>

/* Cost only: so many nodes have room. Columns of 4096 bytes would all fall into the same lines of the cache. */
#define CHAIN_ROOM (TL_ELEMENT_NODES + 24)

/* Segment k goes from node k to the next. */
typedef struct chain {
    uint32_t count;
    double w[CHAIN_ROOM], rock[CHAIN_ROOM], slip[CHAIN_ROOM]; /* m */
    double hold[CHAIN_ROOM];                                  /* N/m, of the grout */
    double bond[CHAIN_ROOM], residual[CHAIN_ROOM];            /* N */
    double bears[CHAIN_ROOM];                                 /* N, the one of them that counts */
    double worn[CHAIN_ROOM];                                  /* 1: it bears the residual; else 0 */
    double stiff[CHAIN_ROOM];                                 /* N/m, of segments: E A / h */
    double plastic[CHAIN_ROOM], limit[CHAIN_ROOM];
    double gauge[CHAIN_ROOM];              /* m, over which the strain counts */
    double seat, plate_stiff, plate_limit; /* the plate is at node 0 */
    double pull;                           /* N, by which the mouth is pulled out */
    /* the answer: forces, forces that there would be without a limit, and what is left of the stiffness */
    double grout[CHAIN_ROOM], grout_trial[CHAIN_ROOM], grout_tangent[CHAIN_ROOM];
    double tension[CHAIN_ROOM], tension_trial[CHAIN_ROOM], tension_tangent[CHAIN_ROOM];
    double plate, plate_trial, plate_tangent;
    double off[CHAIN_ROOM];  /* N, unbalance of the steel */
    double rounding, enough; /* N, of it that rounding of displacements explains, and that is equilibrium */
} chain;

/* As fmax and fmin, which compilers do not put inline for the sake of NaN. */
static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

/* Finds w and the forces, and which grout wears. false: no w holds what pulls at the mouth. */
bool chain_solve(chain *c);

#endif
