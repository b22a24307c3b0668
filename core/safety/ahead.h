/* ahead.h - trials that are made before their turn, in processes beside this one. */
#ifndef TL_SAFETY_AHEAD_H
#define TL_SAFETY_AHEAD_H

#include "safety/bracket.h"
#include "safety/trial.h"

typedef double (*tl_factor_fn)(const void *user, int64_t at);

/* Refuses processes where there can be none, before any work is done. */
tl_status tl_ahead_check(const tl_trials *t);
/* Makes the trial that a search needs next, and, beside it, those that it may need then. With one process, or when the
 * next one has been made, it does nothing. */
tl_status tl_ahead(tl_trials *t, const tl_bracket *b, tl_factor_fn factor_at, const void *user);
/* Whether a trial was made ahead; then it is handed over. */
bool tl_ahead_take(tl_trials *t, double factor, tl_safety_trial *trial, tl_fall *fall);
/* Forgets all trials: those to come begin with another copy. */
void tl_ahead_clear(tl_trials *t);

#endif
