/* corner_sums.h - the patch of two flush faces with springs at its corners, in the press of a pair. */
#ifndef TL_NARROW_CORNER_SUMS_H
#define TL_NARROW_CORNER_SUMS_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* Two flush faces, and the planes where they press, in A's frame: moved out, and leaning. */
typedef struct tl_corner_faces {
    uint32_t fa, fb;
    tl_plane a, b;
} tl_corner_faces;

/* The sums in the place of the integrals over the patch, about an origin, without gradients; 0 where no corner
 * presses. false: out of memory. */
bool tl_corner_sums_find(const tl_pair_view *view, const tl_corner_faces *faces, tl_vec3 origin,
                         tl_narrow_scratch *scratch, tl_field_sums *out);
/* Adds minus the gradients to sums whose energy is above 0. */
bool tl_corner_sums_slopes(const tl_pair_view *view, const tl_corner_faces *faces, tl_vec3 origin,
                           tl_narrow_scratch *scratch, tl_field_sums *sums);

#endif
