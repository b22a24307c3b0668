/* names.h - names a user types: the nearest known one, and the refusal of an unknown one. The function
 * tl_nearest_name is declared in talus.h, for front ends. */
#ifndef TL_BASE_NAMES_H
#define TL_BASE_NAMES_H

#include <talus/talus.h>

/* Number of letters to insert, delete, replace or swap with their neighbour to make `b` of `a`, upper
 * and lower case counted as equal; SIZE_MAX when either is longer than 63 letters. */
size_t tl_edit_distance(const char *a, const char *b);

/* Refuses with `status` and "<context>unknown <what> 'word'; did you mean 'near'? (known: a, b)".
 * The known names are listed when they are few; `context` goes in front as it is. */
tl_status tl_fail_unknown(tl_error *error, tl_status status, const char *context, const char *what, const char *word,
                          const char *const *names, size_t count);

#endif
