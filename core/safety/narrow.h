/* narrow.h - makes trials until neighbours on a grid of factors hold and fail. */
#ifndef TL_SAFETY_NARROW_H
#define TL_SAFETY_NARROW_H

#include "safety/ahead.h"

/* Takes a trial, and keeps or frees what fails in it. */
typedef tl_status (*tl_trial_taker)(void *user, const tl_safety_trial *trial, tl_fall *fall);

/* Makes trials until neighbours on the grid of a bracket hold and fail, or it ends. */
tl_status tl_narrow(tl_trials *t, tl_bracket *b, tl_factor_fn factor_at, tl_trial_taker taker, void *user);

#endif
