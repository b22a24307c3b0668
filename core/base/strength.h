/* strength.h - parameters with their strengths divided by a factor of safety: the flags TL_PARAM_STRENGTH and so on. */
#ifndef TL_BASE_STRENGTH_H
#define TL_BASE_STRENGTH_H

#include <talus/talus.h>

/* Whether some parameter of a kind is marked as a strength. */
bool tl_kind_has_strength(const tl_kind *kind);

/* The marked parameters of a kind that have a value in `params`, as values of a call: divided by `factor` > 0. `*held`
 * keeps them, and is to be freed after the last use. false: out of memory. */
bool tl_strengths_divide(const tl_kind *kind, const void *params, double factor, tl_args *args, void **held);

#endif
