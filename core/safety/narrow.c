/* narrow.c - makes trials until neighbours on a grid of factors hold and fail.
 *
 * A trial that rests may hang on how soft joints are, and one with stiffer joints takes longer than all others. What
 * holds at a factor holds at any lower one. So only the last trial that rests is confirmed (safety/trial.c). Where it
 * fails then, the search goes on below it, and confirms each trial that rests. */
#include "safety/narrow.h"

/* Confirms the largest factor that holds. *again: it fails, and the search goes on. */
static tl_status confirm(tl_trials *t, tl_bracket *b, double factor, double moved, tl_trial_taker taker, void *user,
                         bool *again)
{
    tl_safety_trial trial;
    tl_fall fall;
    tl_status status = tl_trials_confirm(t, factor, moved, &trial, &fall);
    if (status != TL_OK || trial.cycles == 0)
        return status;
    *again = !trial.holds;
    if (*again) {
        b->fails = b->holds;
        b->holds = b->lowest - 1;
        b->width = 1;
        tl_trials_confirm_all(t, true);
    }
    return taker(user, &trial, &fall);
}

tl_status tl_narrow(tl_trials *t, tl_bracket *b, tl_factor_fn factor_at, tl_trial_taker taker, void *user)
{
    tl_status status = TL_OK;
    double moved = 0; /* in the last trial that held */
    tl_trials_confirm_all(t, false);
    for (bool on = true; on && status == TL_OK;) {
        tl_safety_trial trial;
        tl_fall fall;
        status = tl_ahead(t, b, factor_at, user);
        const int64_t at = tl_bracket_next(b);
        on = at >= 0;
        if (status != TL_OK)
            break;
        if (on) {
            status = tl_trials_try(t, factor_at(user, at), &trial, &fall);
            if (status != TL_OK)
                break;
            moved = trial.holds ? fall.moved : moved;
            tl_bracket_take(b, at, trial.holds != 0);
            status = taker(user, &trial, &fall);
        } else if (!t->confirms && b->holds >= b->lowest) {
            status = confirm(t, b, factor_at(user, b->holds), moved, taker, user, &on);
        }
    }
    return status;
}
