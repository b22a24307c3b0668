/* checker.h - what the conformance checks of the four types of plugins share. */
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

#endif
