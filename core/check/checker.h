/* checker.h - what the conformance checks of the types of plugins share: parameters, faults found, and random
 * numbers. */
#ifndef TL_CHECK_CHECKER_H
#define TL_CHECK_CHECKER_H

#include "base/error.h"
#include "base/random.h"

#include <talus/check.h>
#include <talus/talus.h>
#include <talus/vmath.h>

/* Sets of parameters that a law or a damping is tried with: the given and default ones first, then drawn ones. */
#define TL_CHECK_SETS 20
/* Checks of one type of kind, at most. */
#define TL_CHECK_MOST 32
/* Contact points or bodies that a law or a damping is tried with at once. */
#define TL_CHECK_POINTS 64
/* Parameters of a law or a damping whose effect is looked for, at most. */
#define TL_CHECK_PARAMS 64
/* The number of no parameter. */
#define TL_CHECK_NONE (-1)

/* A check by its name, and what it asks. */
typedef struct tl_check_rule {
    const char *name, *doc;
} tl_check_rule;

/* The check of one kind. */
typedef struct tl_checker {
    const tl_kind *kind;
    const tl_args *args; /* given by the user */
    tl_error *error;
    int set;               /* of parameters */
    char params_text[300]; /* that set, for sentences */
    char fault[TL_CHECK_MOST][TL_ERROR_TEXT];
} tl_checker;

/* The checks of one type of kind: `rules` ends with one without a name. */
typedef struct tl_check_type {
    const tl_check_rule *rules;
    tl_status (*check)(tl_checker *c);
} tl_check_type;

/* A set of parameters as values. Set 0 has the given ones, and a plausible one of each that is required; later sets
 * draw what is not given. The parameter `varied`, unless TL_CHECK_NONE, has another value than it would. `*values`, and
 * `*held`, in which vectors are, are to be freed after the last use, on failure too. */
tl_status tl_check_values(tl_checker *c, int set, int varied, tl_value **values, size_t *count, void **held);
/* The same, read into `params`, of the kind's params_size bytes; `*held` likewise. */
tl_status tl_check_params(tl_checker *c, int set, int varied, void *params, void **held);
/* Whether an effect of that parameter is asked for: of those that are given, or of all when none is. */
bool tl_check_asked(const tl_checker *c, uint32_t param);
/* What a kind's `create` makes of parameters; the parameters themselves where it is NULL. */
tl_status tl_check_create(tl_checker *c, tl_status (*create)(const void *, void **, tl_report *), void *params,
                          void **self);
/* Calls `try_set` with one set of parameters after another, until TL_CHECK_SETS have been tried. It gives TL_E_MEMORY,
 * or another failure where the kind refuses the set. Fails where the given ones are refused, or all. */
tl_status tl_check_sets(tl_checker *c, tl_status (*try_set)(tl_checker *c, void *params, void *user), void *user);

/* Keeps the first fault that a check finds, with the parameters it was found with. */
void tl_check_note(tl_checker *c, int check, const char *format, ...) TL_PRINTF(3, 4);
/* Whether that check has found a fault already. */
static inline bool tl_check_failed(const tl_checker *c, int check)
{
    return c->fault[check][0] != '\0';
}

/* A number in [low, high) of a key. */
static inline double tl_check_between(uint64_t key, double low, double high)
{
    return low + tl_uniform(key) * (high - low);
}
/* 10 to a power in [low, high), for scales. */
double tl_check_scale(uint64_t key, double low, double high);
/* A unit vector of a key. */
tl_vec3 tl_check_direction(uint64_t key);
/* A number that fills what belongs to nobody, of a size that goes with the column; `other`: another one. */
double tl_check_nobodys(int column, bool other);

/* Which entries of columns a batch takes: `count` of those that `order` names (NULL: one after the other), from number
 * `begin` on; then padding up to `padded`; then what is nobody's, up to `end`. */
typedef struct tl_check_batch {
    const size_t *order;
    size_t begin, count, padded, end;
} tl_check_batch;

static inline size_t tl_check_entry(const tl_check_batch *b, size_t i)
{
    return b->order ? b->order[b->begin + i] : b->begin + i;
}
/* Fills a column of a batch; from NULL all of it is nobody's. */
void tl_check_fill(const tl_check_batch *b, double *column, const double *from, double padding, double nobodys);

/* A vector in `column` and the two columns behind it, of TL_CHECK_POINTS numbers each. */
static inline tl_vec3 tl_check_vec(const double *column, size_t i)
{
    return tl_v3(column[i], column[TL_CHECK_POINTS + i], column[2 * TL_CHECK_POINTS + i]);
}

static inline void tl_check_put(double *column, size_t i, tl_vec3 v)
{
    column[i] = v.x;
    column[TL_CHECK_POINTS + i] = v.y;
    column[2 * TL_CHECK_POINTS + i] = v.z;
}

#endif
