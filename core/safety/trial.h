/* trial.h - whether a model comes to rest with its strengths divided by a factor. */
#ifndef TL_SAFETY_TRIAL_H
#define TL_SAFETY_TRIAL_H

#include "model/model.h"

#include <talus/safety.h>

/* What fails in a copy. */
typedef struct tl_fall {
    tl_id *ids;
    size_t count;
    double volume; /* m3 */
    tl_vec3 way;   /* unit, or zero */
    tl_safety_mode mode;
    tl_id *small; /* what has failed before, and was deleted in the copy: smaller than least_volume */
    size_t small_count, small_capacity;
} tl_fall;

/* A trial that was made before its turn (safety/ahead.h). */
typedef struct tl_trial_ahead {
    tl_safety_trial trial;
    tl_fall fall;
    unsigned char *state; /* of the copy that has come to rest, where the next trial begins with it; or NULL */
    size_t state_bytes;
} tl_trial_ahead;

/* A search for factors of a model: what its trials begin with. */
typedef struct tl_trials {
    const char *what; /* begins sentences */
    tl_model *asked;  /* stays as it is */
    tl_safety options;
    uint8_t *which; /* of the laws: whether strengths are divided */
    tl_model *base; /* what a trial begins with: the copy of the last one that rests, or one with high strengths */
    double reached; /* factor of that trial, or TL_LEAST_FACTOR */
    tl_id *small;   /* what was small and has failed on the way there */
    size_t small_count, small_capacity;
    double stiffness;  /* of its joints, over that of the model */
    double settles;    /* how far its elastic joints settle, m */
    bool measured;     /* whether that is known; else a guess by the size of blocks */
    bool may_put_back; /* whether copies with stiffer joints begin as the model was cut */
    int64_t window;    /* steps between two looks at a trial */
    int64_t cycles;    /* made so far, of all copies */
    double began;      /* s, of the clock */
    size_t undecided;
    tl_trial_ahead *ahead; /* [ahead_count], begun as the next trial will */
    size_t ahead_count, ahead_capacity;
} tl_trials;

void tl_fall_free(tl_fall *fall);
void tl_trial_ahead_free(tl_trial_ahead *made);

/* Checks what is asked and how the model is, and makes the copy. TL_OK, and fall->count > 0: it does not come to rest
 * even with high strengths; the copy then has not. Small blocks that do not are deleted in the copy. */
tl_status tl_trials_begin(tl_trials *t, const char *what, tl_model *m, const tl_safety *given, tl_fall *fall);
/* The base, of which blocks may be deleted or held. */
tl_model *tl_trials_go_on(tl_trials *t);
/* Brings the base to rest again, with high strengths. */
tl_status tl_trials_rest(tl_trials *t, tl_fall *fall);
/* Whether a trial begins with the last one that rests. In a model with zones each begins with the first copy. */
bool tl_trials_by_steps(const tl_trials *t);
/* Makes a trial. It fails: `fall` has what does. `sure`: where it fails at once, strengths are lowered step by step
 * from the last trial that rests. Small blocks that fail are deleted in its own copy only. */
tl_status tl_trials_try(tl_trials *t, double factor, bool sure, tl_safety_trial *trial, tl_fall *fall);
/* A trial at a factor that was made ahead, and not yet taken; or NULL. */
tl_trial_ahead *tl_trials_made(const tl_trials *t, double factor);
void tl_trials_end(tl_trials *t);

#endif
