/* talus/safety.h - factors of safety by dividing strengths. Included by talus.h.
 *
 * Source: Matsui and San, Soils and Foundations 32 (1992) 59-70; Griffiths and Lane, Geotechnique 49 (1999)
 * 387-403. */
#ifndef TALUS_SAFETY_H
#define TALUS_SAFETY_H

#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;

/* How what fails goes. */
typedef enum tl_safety_mode {
    TL_SAFETY_HOLDS,  /* nothing fails */
    TL_SAFETY_SLIDES, /* along what bears it */
    TL_SAFETY_TURNS,  /* its corners go farther by rotation than its centre does */
    TL_SAFETY_FALLS,  /* nothing bears it */
    TL_SAFETY_YIELDS  /* a deformable block is strained on and on */
} tl_safety_mode;

/* One trial: a copy of the model with its strengths divided by a factor. */
typedef struct tl_safety_trial {
    double factor;
    int32_t holds;     /* it came to rest, 1 or 0 */
    int32_t undecided; /* neither rest nor failure within max_cycles: counts as failing */
    int64_t cycles;
    const char *why; /* "at rest", "goes on", "far", "fails" or "undecided" */
} tl_safety_trial;

typedef tl_status (*tl_safety_trial_fn)(void *user, const tl_safety_trial *trial);

/* What factors are looked for, and in what: of tl_model_factor_of_safety and tl_model_safety_map. */
typedef struct tl_safety {
    uint32_t size;             /* sizeof(tl_safety) */
    double from, to;           /* least and largest factor; 0 < from < to */
    double resolution;         /* relative width of the bracket; (0, 0.5] */
    double step;               /* of a map: from one factor to the next; > 0 */
    int32_t hold;              /* of a map: what has failed is held, 1, or deleted, 0 */
    double least_volume;       /* what fails and is smaller than this is deleted and listed, m3; >= 0 */
    int64_t max_cycles;        /* of one trial */
    const char *const *joints; /* names of laws that are divided, as in tl_joint_law; NULL: all */
    size_t joint_count;
    int32_t solids;              /* strengths of solids are divided, too: 1 or 0 */
    tl_safety_trial_fn on_trial; /* after each trial, or NULL; not TL_OK ends the search. The model may only be read */
    void *user;
    int64_t workers;  /* processes that make trials at once, [1, 256]: what is found is the same for any number */
    int32_t elements; /* strengths of elements are divided, too: 1 or 0 */
} tl_safety;

/* Blocks that failed in a trial, or that went before they could be asked for. */
typedef struct tl_safety_blocks {
    tl_id *ids;
    size_t count;
} tl_safety_blocks;

typedef struct tl_safety_result {
    double factor;            /* sqrt(lower upper); 0: it fails whatever the strengths; infinite: it holds at `to` */
    double lower;             /* the largest factor that holds; 0: none did */
    double upper;             /* the least that fails; infinite: none did */
    tl_safety_blocks failing; /* what goes together at `upper`: blocks within 0.3 of the fastest */
    double volume;            /* of these, m3 */
    double direction[3];      /* in which they go: of length 1, or zero */
    int32_t mode;             /* tl_safety_mode */
    double keyblock_factor;   /* least factor of tl_model_keyblocks; NaN: none is known */
    tl_id keyblock;           /* and of which block; TL_NO_ID */
    tl_safety_blocks small;   /* deleted by least_volume in the copy of `upper` */
    tl_safety_trial *trials;  /* in the order in which they were made */
    size_t trial_count;
    int32_t undecided; /* trials that were */
    int64_t cycles;    /* of all steps */
    double wall;       /* s */
    char message[400]; /* what was found */
} tl_safety_result;

/* What had failed when factors came to one. */
typedef struct tl_safety_point {
    double factor, volume; /* m3, in all */
    size_t blocks;         /* in all */
} tl_safety_point;

typedef struct tl_safety_map {
    tl_id *ids;     /* of the blocks that could move */
    double *factor; /* at which each fails, once those before have gone; infinite: it holds at `to` */
    size_t count;
    tl_safety_point *curve; /* by ascending factors */
    size_t point_count;
    int32_t undecided;
    int64_t cycles;
    double wall; /* s */
} tl_safety_map;

/* Finds the factor by which strengths may be divided before the model does not come to rest any more. Strengths are
 * what laws, solids and, when asked for, elements mark with TL_PARAM_STRENGTH and the like. Trials are made on copies:
 * the model stays as it is. TL_E_ARGUMENT for options out of their ranges and for laws without strengths. TL_E_STATE
 * when nothing is free, something is driven or the model moves, or when other threads run beside `workers` > 1.
 * TL_E_CANCELLED on an interrupt. */
TL_API tl_status tl_model_factor_of_safety(struct tl_model *model, const tl_safety *options, tl_safety_result *result);
/* The same for every block: the factor goes up by steps, and what has failed is deleted or held before it goes on. */
TL_API tl_status tl_model_safety_map(struct tl_model *model, const tl_safety *options, tl_safety_map *map);
/* "holds", "slides", "turns", "falls" or "yields". */
TL_API const char *tl_safety_mode_name(tl_safety_mode mode);
/* Free the lists of a result and empty it. */
TL_API void tl_safety_free(tl_safety_result *result);
TL_API void tl_safety_map_free(tl_safety_map *map);

#ifdef __cplusplus
}
#endif
#endif
