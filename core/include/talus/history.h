/* talus/history.h - samples of a value while a model runs. Included by talus.h.
 *
 * The kernel keeps histories with their model, so that copies and files have them. It takes no sample itself: the
 * program that runs the model does, as `model:history{...}` of Lua. A history changes nothing of a run. */
#ifndef TALUS_HISTORY_H
#define TALUS_HISTORY_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;

/* Longest name; most numbers of a sample; most histories of a model. */
#define TL_HISTORY_NAME 63
#define TL_HISTORY_WIDEST 64
#define TL_MOST_HISTORIES 4096

/* What is sampled. */
typedef enum tl_history_source {
    TL_FROM_FUNCTION,  /* what a function of the program gives: no file keeps that */
    TL_FROM_MODEL,     /* a value of the model */
    TL_FROM_BLOCKS,    /* a field of blocks */
    TL_FROM_CONTACTS,  /* a field of contacts */
    TL_FROM_ZONES,     /* a field of zones */
    TL_FROM_GRIDPOINTS /* a field of gridpoints */
} tl_history_source;

/* What is made of the values of several. */
typedef enum tl_history_take { TL_TAKE_MEAN, TL_TAKE_SUM, TL_TAKE_MIN, TL_TAKE_MAX } tl_history_take;

typedef struct tl_history {
    char name[TL_HISTORY_NAME + 1];
    char asked[TL_HISTORY_NAME + 1]; /* name of the value or field; "" of a function */
    int64_t every, first;            /* steps between two samples; the cycle of the first one */
    tl_history_source source;
    tl_history_take take;
    bool selection; /* they are of a selection, not of one block or contact */
    bool lost;      /* it was told that a block no longer exists */
    bool list;      /* a sample is a list, even of one number */
    size_t id_count;
    /* their names: one list, the others are NULL */
    tl_id *ids; /* of blocks */
    tl_contact_name *contacts;
    tl_zone_name *zones;           /* or gridpoints */
    double *weights;               /* by which their values are multiplied; NULL: by 1 */
    size_t width, count, capacity; /* numbers of a sample; samples; room for them */
    int64_t *cycles;               /* of each sample, ascending */
    double *times, *values;        /* s; width numbers for each sample */
} tl_history;

/* Makes a history without samples at the end of the model's list: `what` gives its name, asked, every, source, take,
 * selection, names and weights, which are copied; the first sample is that of the present cycle. TL_E_ARGUMENT: a
 * name that is empty, not of one line, or that of another history; every < 1; no ids. `made` may be NULL. */
TL_API tl_status tl_history_add(struct tl_model *model, const tl_history *what, tl_history **made);
/* Ends history i, with its samples. */
TL_API void tl_history_end(struct tl_model *model, size_t i);
/* History i, in the order in which they were made; NULL past the last one. */
TL_API tl_history *tl_history_at(const struct tl_model *model, size_t i);
/* Adds a sample at the present cycle and time. TL_E_ARGUMENT: of another width than those before, or none in [1,
 * TL_HISTORY_WIDEST]; of a cycle that is sampled already. */
TL_API tl_status tl_history_sample(struct tl_model *model, tl_history *history, const double *values, size_t width);

#ifdef __cplusplus
}
#endif
#endif
