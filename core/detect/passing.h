/* passing.h - whether a step would carry a block into another so far that nobody knows which way it came. */
#ifndef TL_DETECT_PASSING_H
#define TL_DETECT_PASSING_H

#include "model/model.h"

/* What a step does to a body: displacement, m, and turn about the centroid, rad, in the model's axes. */
typedef struct tl_step_motion {
    tl_vec3 shift, turn;
} tl_step_motion;

/* How far a corner of a body moves in the step, at the most, m. */
static inline double tl_step_travel(const tl_model *m, const tl_step_motion *motion, uint32_t body)
{
    return tl_v3_norm(motion[body].shift) + tl_v3_norm(motion[body].turn) * m->bodies.radius[body];
}

/* The pair of blocks that a step carries into each other by most of what is allowed. */
typedef struct tl_passing {
    double part;    /* of the step, at which they overlap by what is allowed; INFINITY: none do */
    uint32_t a, b;  /* rows of the blocks, a < b */
    double deeper;  /* by how much they overlap more after the whole step, m */
    double allowed; /* by how much they may, m */
} tl_passing;

/* Bounds of a block over a step. */
typedef struct tl_swept {
    tl_bounds box;
    uint32_t row;
    bool moves; /* far enough to be one of a pair that passes */
} tl_swept;

/* Least thickness that a block of volume V and surface S can have, m: a convex body holds a ball of radius V / S. */
double tl_least_thickness(const tl_model *m, uint32_t row);
/* Finds the pair whose overlap would first grow by more than `share` of the thinner block's thickness. `motion`: of
 * each body; `thinnest`: the least thickness of all blocks, m; `list`: a place for each block, overwritten. */
tl_passing tl_passing_find(const tl_model *m, const tl_step_motion *motion, double share, double thinnest,
                           tl_swept *list);

#endif
