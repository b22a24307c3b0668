/* params.h - the parameters a kind is tried with. */
#ifndef TL_CHECK_PARAMS_H
#define TL_CHECK_PARAMS_H

#include "check/checker.h"

/* A set of parameters as values. Set 0 has the given ones, and a plausible one of each that is required; later sets draw what
 * is not given. `*values`, and `*held`, in which vectors are, are to be freed after the last use, on failure too. */
tl_status tl_check_values(tl_checker *c, int set, tl_value **values, size_t *count, void **held);
/* The same, read into `params`, of the kind's params_size bytes; `*held` likewise. */
tl_status tl_check_params(tl_checker *c, int set, void *params, void **held);
/* The same with another value of one parameter. */
tl_status tl_check_varied(tl_checker *c, int set, uint32_t param, void *params, void **held);
/* Whether an effect of that parameter is asked for: of those that are given, or of all when none is. */
bool tl_check_asked(const tl_checker *c, uint32_t param);

/* Keeps the first fault that a check finds, with the parameters it was found with. */
void tl_check_note(tl_checker *c, int check, const char *format, ...) TL_PRINTF(3, 4);
/* 10 to a power in [low, high), for scales. */
double tl_check_scale(uint64_t key, double low, double high);
/* A unit vector of a key. */
tl_vec3 tl_check_direction(uint64_t key);

#endif
