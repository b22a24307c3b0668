/* chain.h - the steel of a bolt and the springs that hold it: find its displacements. */
#ifndef BOLT_CHAIN_H
#define BOLT_CHAIN_H

#include <talus/plugin.h>

#include <stdbool.h>

/* Segment k goes from node k to the next. */
typedef struct chain {
    uint32_t count;
    double w[TL_ELEMENT_NODES], rock[TL_ELEMENT_NODES], slip[TL_ELEMENT_NODES]; /* m */
    double hold[TL_ELEMENT_NODES];                                              /* N/m, of the grout */
    double bond[TL_ELEMENT_NODES], residual[TL_ELEMENT_NODES];                  /* N */
    bool worn[TL_ELEMENT_NODES];
    double stiff[TL_ELEMENT_NODES], even[TL_ELEMENT_NODES]; /* N/m, of segments: E A / h and E A / gauge */
    double plastic[TL_ELEMENT_NODES], limit[TL_ELEMENT_NODES];
    double gauge[TL_ELEMENT_NODES];        /* m, over which the strain counts */
    double seat, plate_stiff, plate_limit; /* the plate is at node 0 */
    double pull;                           /* N, by which the mouth is pulled out */
    /* the answer: forces, forces that there would be without a limit, and what is left of the stiffness */
    double grout[TL_ELEMENT_NODES], grout_trial[TL_ELEMENT_NODES], grout_tangent[TL_ELEMENT_NODES];
    double tension[TL_ELEMENT_NODES], tension_trial[TL_ELEMENT_NODES], tension_tangent[TL_ELEMENT_NODES];
    double plate, plate_trial, plate_tangent;
    double off[TL_ELEMENT_NODES]; /* N, unbalance of the steel */
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
