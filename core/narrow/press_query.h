/* press_query.h - what is asked of the press of a pair. */
#ifndef TL_NARROW_PRESS_QUERY_H
#define TL_NARROW_PRESS_QUERY_H

#include "narrow/region.h"

/* A face of A and one of B. */
typedef struct tl_face_pair {
    uint16_t a, b;
} tl_face_pair;

/* A pair that has been placed, and how it is to be pressed. */
typedef struct tl_press_query {
    const tl_pair_view *view;
    const tl_region *region;
    double min_area; /* m^2 */
    /* how far both faces `shifted` together are moved out by an initial stress and by slip, m: each goes half of the way */
    double shift;
    tl_face_pair shifted;
    const tl_plane *
        lean; /* of A and of B: before they are moved out these faces lean so, in the own frames; NULL: not at all */
    double opened; /* part of the shift that slip has opened in the last step, m */
    bool corners;  /* the patch has points at its corners only */
    bool volumes;  /* the powers are wanted, for a law that is not linear: press.c */
    /* Slip opens the joint. The next part of a body may be moved out otherwise, so nothing passes through a seam. */
    bool opens;
} tl_press_query;

#endif
