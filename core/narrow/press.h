/* press.h - what two blocks press on each other with: the pressure field and, where two faces lie flush, their patch,
 * in one energy. */
#ifndef TL_NARROW_PRESS_H
#define TL_NARROW_PRESS_H

#include "narrow/field_sums.h"
#include "narrow/flush.h"
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
    /* how far both faces `shifted` together are moved out by an initial stress and by slip, m: each goes half of the
     * way */
    double shift;
    tl_face_pair shifted;
    const tl_plane
        *lean; /* of A and of B: before they are moved out these faces lean so, in the own frames; NULL: not at all */
    double opened; /* part of the shift that slip has opened in the last step, m */
    bool corners;  /* the patch has points at its corners only */
    bool volumes;  /* the powers are wanted, for a law that is not linear: press.c */
    /* Slip opens the joint. The next part of a body may be moved out otherwise, so nothing passes through a seam. */
    bool opens;
    /* of B only the listed faces are in A's frame yet: the rest is placed where it is needed */
    bool faces_only;
    /* gets the slopes of force and moment, turns about A's zero, where a mesh tells them and no patch presses; NULL:
     * not wanted */
    tl_field_slope *slope;
} tl_press_query;

/* Tolerance: depth over the size of the smaller block up to which blocks only touch: roundings of places. */
#define TL_TOUCHING 1e-12

/* Where a face presses, in A's frame: moved out and leaning, if it does. */
tl_plane tl_pressing_plane(const tl_press_query *query, bool of_b, uint32_t face);
/* The presses of some pairs, up to TL_FIELD_PAIRS: 0 where the blocks have nothing in common; and what those that have
 * more have besides. NULL: neither powers nor what slip has opened are wanted. false: out of memory. */
bool tl_press_find(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch, tl_press press[],
                   tl_press_extra extra[]);

#endif
