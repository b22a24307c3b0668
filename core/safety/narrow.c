/* narrow.c - makes trials until neighbours on a grid of factors hold and fail. */
#include "safety/narrow.h"

tl_status tl_narrow(tl_trials *t, tl_bracket *b, tl_factor_fn factor_at, tl_trial_taker taker, void *user)
{
    tl_safety_trial trial;
    tl_fall fall;
    b->by_steps = tl_trials_by_steps(t);
    tl_status status = tl_ahead(t, b, factor_at, user);
    for (int64_t at; status == TL_OK && (at = tl_bracket_next(b)) >= 0;) {
        status = tl_trials_try(t, factor_at(user, at), tl_bracket_is_sure(b, at), &trial, &fall);
        if (status != TL_OK)
            break;
        tl_bracket_take(b, at, trial.holds != 0);
        status = taker(user, &trial, &fall);
        if (status == TL_OK)
            status = tl_ahead(t, b, factor_at, user);
    }
    return status;
}
