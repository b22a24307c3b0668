/* talus/watch.h - what a front end asks of a run as it goes: part of talus/talus.h. */
#ifndef TALUS_WATCH_H
#define TALUS_WATCH_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;
struct tl_solve;
struct tl_solve_result;

/* From on = true to on = false every call that would change the model or begin a run fails with TL_E_STATE: for
 * functions of the user's that are to read it only (histories). */
TL_API void tl_model_only_read(struct tl_model *model, bool on);

/* What a script may give to cycle: the parameters "cycle". */
typedef struct tl_cycle_args {
    int64_t cycles, every;
} tl_cycle_args;
/* tl_model_cycle with the functions of `calls`: each, progress, stop, with every and user. The rest of it is not read.
 * `calls` and `result` may be NULL. */
TL_API tl_status tl_model_cycle_calling(struct tl_model *model, int64_t cycles, const struct tl_solve *calls,
                                        struct tl_solve_result *result);

/* The unbalanced force ratios and the largest speed, m/s, of the last step; NaN before the first. */
typedef struct tl_balance {
    double ratio, ratio_maximum, ratio_local, max_velocity;
} tl_balance;
/* See tl_balance. Computes nothing that a step has not. */
TL_API tl_balance tl_model_balance(const struct tl_model *model);

/* As of the last step: how many contacts there are, how many slip (some point is at its shear limit), and how many are
 * open (no point carries anything). Computes nothing: a run goes on the same whether it is asked or not. */
typedef struct tl_contact_counts {
    size_t contacts, slipping, open;
} tl_contact_counts;
/* See tl_contact_counts. */
TL_API tl_contact_counts tl_model_contact_counts(const struct tl_model *model);

/* How far a generator has come. */
typedef struct tl_generate_progress {
    const char *generator;
    double share;          /* of all its work, as it says itself; 0: it has not said yet */
    size_t entry, entries; /* of a list of sets of parameters, from 1 */
    size_t cuts, blocks;   /* cuts made; blocks there are, of the model and new ones */
} tl_generate_progress;
/* From now on `show` is called often while a generator works, on the caller's thread. NULL: no more. */
TL_API void tl_model_watch_generate(struct tl_model *model, void (*show)(void *user, const tl_generate_progress *done),
                                    void *user);

#ifdef __cplusplus
}
#endif
#endif
