/* heirs.h - the parts of a patch carry what the whole would have carried. */
#ifndef TL_FORCE_HEIRS_H
#define TL_FORCE_HEIRS_H

#include "contact/estate.h"
#include "contact/layout.h"
#include "model/model.h"

#include <stdbool.h>

/* Notes in its estate what a patch would carry in the next step that ends because a block of it was cut. */
void tl_estate_weigh(tl_model *m, uint32_t contact, tl_estate *estate, const tl_testator *a,
                     const tl_testator *b);
/* After all parts have taken over their shares: brings them to where they carry the same. false: out of memory. */
bool tl_heirs_carry(tl_model *m);

/* Most numbers that are looked for. */
#define TL_ROOTS 6
/* What is missing by this is not missing. */
#define TL_ROOTS_EXACT 1e-11

/* What is missed falls with each number as fast as by 1 / unit, about, where all is plain. */
typedef struct tl_roots {
    int count;
    double unit;
    double
        hopeless; /* share of what is missed that is left after a step by fresh slopes, from which the search ends */
    /* What is missed with such numbers, up to TL_ROOTS of both; false: it is not known. */
    bool (*miss)(const void *user, const double x[], double missed[]);
    const void *user;
} tl_roots;

/* What presses on B, and its moment about A's centroid. */
typedef struct tl_word {
    tl_vec3 force, moment;
    double most; /* sum of the magnitudes of the points' normal forces, N */
} tl_word;

/* Asks the law of a patch. In the first lanes are arms, normals, closures and motions of the points, and in `before` from 1 on their shear
 * forces; there those after are given. false: the law failed, or what it says is no number. */

#endif
