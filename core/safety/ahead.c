/* ahead.c - trials that are made before their turn, in processes beside this one.
 *
 * A trial begins with the last one that rests. As long as trials fail, the next ones all begin with the same copy. So a
 * search with n processes makes the next n trials at once that it would come to if all failed. It takes them in its own
 * order, up to the first one that rests, and no others. So the trials that it takes, and all that it finds, are the
 * same for any number. The processes end when none of the trials that are open is needed any more. The copy of a trial
 * that rests comes back as the bytes of a saved model. */
#include "safety/ahead.h"

#include "base/error.h"
#include "model/model.h"
#include "state/save.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <talus/workers.h>

/* Cost only: seconds after which an interrupt is looked for. */
#define PATIENCE 0.1

/* What a process sends: this, the ids of the blocks that fail, and of those that are small and did, and the copy that
 * rests. */
typedef struct report {
    int32_t made; /* 0: an error */
    tl_safety_trial trial;
    tl_fall fall;
    size_t state_bytes;
} report;

/* One set of trials. */
typedef struct batch {
    tl_trials *trials;
    double factor[TL_MOST_WORKERS];
    bool by_steps[TL_MOST_WORKERS];
    char *bytes; /* in a process: its answer */
} batch;

static size_t put(char *to, size_t at, const void *from, size_t bytes)
{
    if (bytes > 0)
        memcpy(to + at, from, bytes);
    return at + bytes;
}

/* In a process: makes a trial. What `why` points to is at the same address in both processes. */
static void do_trial(void *user, uint64_t job, const void **data, size_t *size)
{
    batch *of = user;
    tl_trials *t = of->trials;
    report r = {.made = 0};
    unsigned char *state = NULL;
    t->options.on_trial = NULL;
    r.made = tl_trials_try(t, of->factor[job], of->by_steps[job], &r.trial, &r.fall) == TL_OK;
    if (r.made && r.trial.holds && tl_trials_by_steps(t))
        r.made = tl_model_bytes(t->base, &state, &r.state_bytes) == TL_OK;
    const size_t ids = r.made ? r.fall.count * sizeof *r.fall.ids : 0;
    const size_t small = r.made ? r.fall.small_count * sizeof *r.fall.small : 0;
    of->bytes = malloc(sizeof r + ids + small + r.state_bytes);
    if (!of->bytes)
        _Exit(EXIT_FAILURE);
    *size = put(of->bytes, 0, &r, sizeof r);
    *size = put(of->bytes, *size, r.fall.ids, ids);
    *size = put(of->bytes, *size, r.fall.small, small);
    *size = put(of->bytes, *size, state, r.made ? r.state_bytes : 0);
    *data = of->bytes;
    free(state);
    tl_fall_free(&r.fall);
}

/* ---------------------------------------------------------------- in this process -------- */

/* Copies bytes out of an answer; NULL when there are none, or no memory. */
static void *taken(const char **from, size_t bytes, bool *lost)
{
    void *to = bytes > 0 ? malloc(bytes) : NULL;
    if (to)
        memcpy(to, *from, bytes);
    *lost = *lost || (bytes > 0 && !to);
    *from += bytes;
    return to;
}

/* Keeps an answer; one of a process that failed is left out, and its trial is made here when its turn comes. */
static tl_status keep(tl_trials *t, const tl_worker_answer *answer)
{
    report r;
    if (!answer->data || answer->size < sizeof r)
        return TL_OK;
    memcpy(&r, answer->data, sizeof r);
    if (!r.made)
        return TL_OK;
    const char *from = (const char *)answer->data + sizeof r;
    bool lost = false;
    tl_trial_ahead made = {.trial = r.trial, .fall = r.fall, .state_bytes = r.state_bytes};
    made.fall.ids = taken(&from, r.fall.count * sizeof *r.fall.ids, &lost);
    made.fall.small = taken(&from, r.fall.small_count * sizeof *r.fall.small, &lost);
    made.fall.small_capacity = r.fall.small_count;
    made.state = taken(&from, r.state_bytes, &lost);
    if (lost || !tl_grow(&t->ahead, &t->ahead_capacity, t->ahead_count + 1, sizeof *t->ahead)) {
        tl_trial_ahead_free(&made);
        return tl_fail_memory(&t->asked->error);
    }
    t->ahead[t->ahead_count++] = made;
    return TL_OK;
}

/* Whether a search that goes on as the trials so far say needs one more of the batch that is still open. */
static bool needs_more(const batch *of, const bool *ended, size_t count, tl_bracket b, tl_factor_fn factor_at,
                       const void *user)
{
    for (;;) {
        const int64_t at = tl_bracket_next(&b);
        const double factor = at >= 0 ? factor_at(user, at) : 0;
        const tl_trial_ahead *made = at >= 0 ? tl_trials_made(of->trials, factor) : NULL;
        if (!made) {
            for (size_t i = 0; at >= 0 && i < count; i++)
                if (of->factor[i] == factor)
                    return !ended[i];
            return false;
        }
        tl_bracket_take(&b, at, made->trial.holds != 0);
    }
}

static tl_status run(batch *of, size_t count, const tl_bracket *b, tl_factor_fn factor_at, const void *user)
{
    tl_trials *t = of->trials;
    tl_workers *workers;
    tl_worker_answer answer;
    bool ended[TL_MOST_WORKERS] = {false};
    tl_status status = tl_workers_start((unsigned)count, do_trial, of, &workers, &t->asked->error);
    for (unsigned i = 0; status == TL_OK && i < count; i++)
        status = tl_workers_give(workers, i, i, &t->asked->error);
    while (status == TL_OK && needs_more(of, ended, count, *b, factor_at, user)) {
        status = tl_workers_take(workers, PATIENCE, &answer, &t->asked->error);
        if (status == TL_OK && tl_model_interrupted(t->asked))
            status = tl_fail(&t->asked->error, TL_E_CANCELLED, "%s: stopped; the model is as it was", t->what);
        if (status != TL_OK || answer.worker == UINT_MAX)
            continue;
        ended[answer.job] = true;
        status = keep(t, &answer);
    }
    tl_workers_end(workers);
    return status;
}

tl_status tl_ahead(tl_trials *t, const tl_bracket *b, tl_factor_fn factor_at, const void *user)
{
    int64_t places[TL_MOST_WORKERS];
    batch of = {.trials = t};
    tl_bracket first = *b;
    const int64_t at = tl_bracket_next(&first);
    if (t->options.workers < 2 || at < 0 || tl_trials_made(t, factor_at(user, at)))
        return TL_OK;
    const size_t count = tl_bracket_ahead(b, places, (size_t)t->options.workers);
    for (size_t i = 0; i < count; i++) {
        of.factor[i] = factor_at(user, places[i]);
        of.by_steps[i] = tl_bracket_is_sure(b, places[i]);
    }
    return run(&of, count, b, factor_at, user);
}
