/* fit.h - how the blocks of a pair fit, and planes for their faces in which they do. */
#ifndef TL_DETECT_FIT_H
#define TL_DETECT_FIT_H

#include "model/model.h"

/* The blocks touch and no more; are apart; have two faces on each other that do not fit; overlap by edges or
 * vertices. */
typedef enum tl_fit_kind { TL_FIT_WELL, TL_FIT_APART, TL_FIT_FACES, TL_FIT_EDGES } tl_fit_kind;

typedef struct tl_pair_fit {
    tl_fit_kind how;
    uint32_t face[2];                            /* TL_NO_ROW: it stays */
    tl_plane plane[2];                           /* in which they would fit, in the frames of their bodies */
    double gap, overlap, mean_gap, mean_overlap; /* m */
    double drawn[2];                             /* by how much a block's face would be drawn back, m */
    double area;                                 /* m^2 */
} tl_pair_fit;

/* Up to which gaps and overlaps are taken, m. */
typedef struct tl_fit_limits {
    double gap, overlap;
} tl_fit_limits;

/* How two blocks, by their rows, lie to each other: as the pair sees itself, or as they are drawn. Faces with no gap
 * below the limit are apart. Not for two threads at once. false: out of memory. */
bool tl_fit_measure(tl_model *m, uint32_t a, uint32_t b, bool drawn, tl_fit_limits limits, tl_pair_fit *out);

#endif
