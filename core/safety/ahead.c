/* ahead.c - trials that are made before their turn, in processes beside this one.
 *
 * A search with n processes makes the next n trials at once that it may come to, whatever is found at those before:
 * first that one which it needs in any case, then both that may follow, and so on. It takes those that it does come to,
 * in its own order, and no others. So the trials that it takes, and all that it finds, are the same for any number. The
 * processes end when none of the trials that are open is needed any more. */
#include "safety/ahead.h"

#include "base/error.h"
#include "model/model.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <talus/workers.h>

/* Cost only: seconds after which an interrupt is looked for. */
#define PATIENCE 0.1

/* What a process sends: this, the ids of the blocks that fail, and of those that are small and did. */
typedef struct report {
    int32_t made; /* 0: an error */
    tl_safety_trial trial;
    tl_fall fall;
} report;

/* One set of trials. */
typedef struct batch {
    tl_trials *trials;
    double factor[TL_MOST_WORKERS];
    char *bytes; /* in a process: its answer */
} batch;

/* In a process: makes a trial. What `why` points to is at the same address in both processes. */
static void do_trial(void *user, uint64_t job, const void **data, size_t *size)
{
    batch *of = user;
    report r = {.made = 0};
    of->trials->options.on_trial = NULL;
    r.made = tl_trials_try(of->trials, of->factor[job], &r.trial, &r.fall) == TL_OK;
    const size_t ids = r.made ? r.fall.count * sizeof *r.fall.ids : 0;
    const size_t small = r.made ? r.fall.small_count * sizeof *r.fall.small : 0;
    free(of->bytes);
    of->bytes = malloc(sizeof r + ids + small);
    if (!of->bytes)
        _Exit(EXIT_FAILURE);
    memcpy(of->bytes, &r, sizeof r);
    if (ids > 0)
        memcpy(of->bytes + sizeof r, r.fall.ids, ids);
    if (small > 0)
        memcpy(of->bytes + sizeof r + ids, r.fall.small, small);
    *data = of->bytes;
    *size = sizeof r + ids + small;
    if (r.made)
        tl_fall_free(&r.fall);
}

/* ---------------------------------------------------------------- in this process -------- */

/* Copies a list of ids out of an answer; false without memory. */
static bool copy_ids(tl_id **ids, const char *from, size_t count)
{
    *ids = count > 0 ? malloc(count * sizeof **ids) : NULL;
    if (count > 0 && *ids)
        memcpy(*ids, from, count * sizeof **ids);
    return count == 0 || *ids;
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
    const char *ids = (const char *)answer->data + sizeof r;
    tl_fall fall = r.fall;
    fall.ids = fall.small = NULL;
    fall.small_capacity = fall.small_count;
    if (!copy_ids(&fall.ids, ids, fall.count) ||
        !copy_ids(&fall.small, ids + fall.count * sizeof *fall.ids, fall.small_count) ||
        !tl_grow(&t->ahead, &t->ahead_capacity, t->ahead_count + 1, sizeof *t->ahead)) {
        tl_fall_free(&fall);
        return tl_fail_memory(&t->asked->error);
    }
    t->ahead[t->ahead_count++] = (tl_trial_ahead){r.trial, fall};
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
    for (size_t i = 0; i < count; i++)
        of.factor[i] = factor_at(user, places[i]);
    return run(&of, count, b, factor_at, user);
}
