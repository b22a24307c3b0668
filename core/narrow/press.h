/* press.h - what two blocks press on each other with: the pressure field and, where two faces lie flush, their patch, in
 * one energy (press.c). */
#ifndef TL_NARROW_PRESS_H
#define TL_NARROW_PRESS_H

#include "narrow/region.h"

/* Tilt of two faces, as a sine, up to which their patch is all there is, and from which the field is: 0.05 and 0.15
 * degrees. Joints of a rock mass under load stay below, at some 1e-5. */
#define TL_FLUSH_TILT 8.7266e-4
#define TL_FIELD_TILT 2.6180e-3
/* The same of the overlap of the patch over the root of its area. */
#define TL_FLUSH_DEPTH 4e-3
#define TL_FIELD_DEPTH 1e-2

/* Depth over the size of the smaller block up to which blocks only touch: roundings of places. */
#define TL_TOUCHING 1e-12

/* A pair that has been placed, and how it is to be pressed. */
typedef struct tl_press_query {
    const tl_pair_view *view;
    const tl_region *region;
    double min_area; /* m^2 */
    double shift;    /* how far face `shifted` of A is moved out by an initial stress, m */
    uint32_t shifted;
} tl_press_query;

/* The presses of some pairs, up to TL_FIELD_PAIRS: 0 where the blocks have nothing in common. false: out of memory. */
bool tl_press_find(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch,
                   tl_press press[]);

#endif
