/* borne.h - what bodies bear at the least: forces below it are rounding (rest.c). */
#ifndef TL_CYCLE_BORNE_H
#define TL_CYCLE_BORNE_H

#include "model/model.h"

/* Tolerance: overlap, relative to the body's radius, of which contacts cannot tell a ratio of 1e-5. Places and so
 * overlaps are rounded at some 1e-16 of the radius. */
#define TL_ROUNDED_OVERLAP 1e-10

/* Force that a body of a stiffness bears at the least: what its contacts carry at an overlap that is rounding. */
static inline double tl_least_borne(const tl_bodies *b, uint32_t body, double stiffness)
{
    return TL_ROUNDED_OVERLAP * b->radius[body] * stiffness;
}

#endif
