/* talus/verdict.h - how a model stands, in one line, and the stage from which its motion counts. Included by
 * talus.h. */
#ifndef TALUS_VERDICT_H
#define TALUS_VERDICT_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;

/* Longest name of a stage, in bytes. */
#define TL_STAGE_NAME 63

/* Begins a stage: displacements of all blocks, and so what joints have slipped and opened by the verdict, count from
 * now. What laws keep stays. The name, "" for none, is in verdicts, pages, copies and files. TL_E_ARGUMENT: it is
 * longer than TL_STAGE_NAME, not of one line, or no UTF-8. */
TL_API tl_status tl_model_stage(struct tl_model *model, const char *name);

typedef enum tl_standing {
    TL_STANDING_UNKNOWN,      /* no step has been made */
    TL_STANDING_AT_REST,      /* below the local ratio of the last solve that asked for one, else below 1e-5 */
    TL_STANDING_MOVING,       /* neither at rest nor failed */
    TL_STANDING_ACCELERATING, /* so, and the unbalanced forces push on */
    TL_STANDING_FAILED        /* by the criterion of `stop_at_failure`, in the last solve */
} tl_standing;

/* How a model stands as of its last step. Blocks have moved whose displacement is more than `closed` and more than a
 * twentieth of the largest, and the one that has failed. A body of several parts counts once, with the displacement of
 * its centroid. */
typedef struct tl_verdict {
    tl_standing standing;
    double ratio; /* the local unbalanced force ratio; NaN: no step has been made */
    /* m: blocks that have not moved, but closed their joints, have displacements up to this */
    double closed;
    size_t moved;        /* bodies */
    double volume;       /* of these, m3 */
    tl_vec3 direction;   /* of their mean motion by volume, a unit vector; 0: none has moved */
    tl_id farthest;      /* first block of the body that has moved the most; TL_NO_ID: there is none */
    double displacement; /* of that, m */
    /* The largest since the stage began, m: how far two bodies have moved along each other and apart. It is measured
     * where faces that look the same way meet, as the mean of their contacts by area. */
    double slip, opening;
    tl_contact_name slipped, opened; /* contacts of these; of blocks TL_NO_ID: none */
    size_t contacts, slipping;
    char stage[TL_STAGE_NAME + 1]; /* "": none */
} tl_verdict;

/* Finds the verdict. Nothing in the model changes. TL_E_MEMORY and TL_E_STATE as of contacts that are asked for. */
TL_API tl_status tl_model_verdict(struct tl_model *model, tl_verdict *out);
/* "unknown", "at rest", "moving", "accelerating", "failed". */
TL_API const char *tl_standing_name(tl_standing standing);
/* The verdict as a sentence of one line, cut off where `size` bytes are too few; 400 suffice. */
TL_API void tl_verdict_text(const tl_verdict *verdict, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
