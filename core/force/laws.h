/* laws.h - contact forces: the laws of the contacts of a model, and the sum per contact. */
#ifndef TL_FORCE_LAWS_H
#define TL_FORCE_LAWS_H

#include "base/exact.h"
#include "base/parallel.h"
#include "contact/kind.h"
#include "contact/layout.h"
#include "model/model.h"

/* What the laws give the step besides forces, and what the step does before they overwrite anything. */
typedef struct tl_law_phase {
    tl_failure *failure;
    tl_exact *heat; /* of each thread: what contacts turn to heat in this step, J */
    /* keeps what the points of some SIMD groups and their contacts carry; on any thread */
    void (*keep)(tl_model *m, const tl_simd_group *groups, size_t count);
    /* of each contact that is not held still: what its damping adds, on B and about A's centroid; NULL: nothing */
    tl_wrench *damping;
    double damping_rate; /* beta over the last step */
} tl_law_phase;

/* Patches, from places to forces. */
extern const tl_kind_force tl_patch_force;

/* Calls the laws on their spans of contact points and sums forces per contact. */
tl_status tl_laws_apply(tl_model *m, const tl_law_phase *phase);
/* Every contact has a law, or a sentence that names one that has not. */
tl_status tl_laws_check(tl_model *m);

#endif
