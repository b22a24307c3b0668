/* check.h - what the conformance checks of the four types of plugins share. */
#ifndef TL_CHECK_CHECK_H
#define TL_CHECK_CHECK_H

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

/* Keeps the first fault that a check finds, with the parameters it was found with. */
void tl_check_note(tl_checker *c, int check, const char *format, ...) TL_PRINTF(3, 4);
/* Whether that check has found a fault already. */
static inline bool tl_check_failed(const tl_checker *c, int check)
{
    return c->fault[check][0] != '\0';
}

/* A set of parameters as values. Set 0 has the given ones, and a plausible one of each that is required; later sets draw what
 * is not given. `*values`, and `*held`, in which vectors are, are to be freed after the last use, on failure too. */
tl_status tl_check_values(tl_checker *c, int set, tl_value **values, size_t *count, void **held);
/* The same, read into `params`, of the kind's params_size bytes; `*held` likewise. */
tl_status tl_check_params(tl_checker *c, int set, void *params, void **held);
/* The same with another value of one parameter. */
tl_status tl_check_varied(tl_checker *c, int set, uint32_t param, void *params, void **held);
/* Whether an effect of that parameter is asked for: of those that are given, or of all when none is. */
bool tl_check_asked(const tl_checker *c, uint32_t param);

/* A number in [low, high) of a key. */
static inline double tl_check_between(uint64_t key, double low, double high)
{
    return low + tl_uniform(key) * (high - low);
}

/* 10 to a power in [low, high), for scales. */
double tl_check_scale(uint64_t key, double low, double high);
/* A unit vector of a key. */
tl_vec3 tl_check_direction(uint64_t key);

/* The four checks, one set of rules each. They fail when the kind cannot be tried at all. */
extern const tl_check_rule tl_check_law_rules[], tl_check_damping_rules[],
    tl_check_generator_rules[], tl_check_screen_rules[];
tl_status tl_check_law_kind(tl_checker *c);
tl_status tl_check_damping_kind(tl_checker *c);
tl_status tl_check_generator_kind(tl_checker *c);
tl_status tl_check_screen_kind(tl_checker *c);

#endif
