/* press.h - what two blocks press on each other with: the pressure field and, where two faces lie flush, their patch, in
 * one energy (press.c). */
#ifndef TL_NARROW_PRESS_H
#define TL_NARROW_PRESS_H

#include "narrow/flush.h"
#include "narrow/press_query.h"

/* Depth over the size of the smaller block up to which blocks only touch: roundings of places. */
#define TL_TOUCHING 1e-12

/* The presses of some pairs, up to TL_FIELD_PAIRS: 0 where the blocks have nothing in common; and what those that have more have
 * besides. NULL: neither powers nor what slip has opened are wanted. false: out of memory. */
bool tl_press_find(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch,
                   tl_press press[], tl_press_extra extra[]);

#endif
