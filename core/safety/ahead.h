/* ahead.h - trials that are made before their turn, in processes beside this one. */
#ifndef TL_SAFETY_AHEAD_H
#define TL_SAFETY_AHEAD_H

#include "safety/bracket.h"
#include "safety/trial.h"

typedef double (*tl_factor_fn)(const void *user, int64_t at);

/* Makes the trial that a search needs next, and, beside it, those that it may need then. With one process, or when the
 * next one has been made, it does nothing. */
tl_status tl_ahead(tl_trials *t, const tl_bracket *b, tl_factor_fn factor_at, const void *user);

#endif
