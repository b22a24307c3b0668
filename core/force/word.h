/* word.h - what the law of a patch says that it carries in the step to come (word.c). */
#ifndef TL_FORCE_WORD_H
#define TL_FORCE_WORD_H

#include "contact/layout.h"
#include "model/model.h"

/* What presses on B, and its moment about A's centroid. */
typedef struct tl_word {
    tl_vec3 force, moment;
    double most; /* sum of the magnitudes of the points' normal forces, N */
} tl_word;

/* Asks the law of a patch. In the first lanes are arms, normals, closures and motions of the points, and in `before` from 1 on their shear
 * forces; there those after are given. false: the law failed, or what it says is no number. */
bool tl_patch_word(tl_model *m, uint32_t contact, const tl_point_lanes *lanes, tl_word *out);
#endif
