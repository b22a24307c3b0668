/* options.h - reading the structs of options that callers give. */
#ifndef TL_MODEL_OPTIONS_H
#define TL_MODEL_OPTIONS_H

#include "model/functions.h"

#include <talus/talus.h>

/* Copies a caller's struct of options into the library's own, `own`. What the caller's headers did not know yet has
 * its default. So has everything when `given` is NULL. Refuses a struct without size, or of headers newer than this
 * library. */
tl_status tl_options_read(tl_options which, const void *given, void *own, tl_error *error);

/* The same, with the type in the place of its number. */
#define TL_OPTIONS_READ(type, given, own, error)                                                                       \
    tl_options_read(TL_OPTIONS_OF_##type, 1 ? (given) : (const type *)NULL, 1 ? (own) : (type *)NULL, (error))

/* TL_E_ARGUMENT with a sentence for what is none of the values 0 .. most of an enumeration. */
tl_status tl_check_choice(tl_error *error, const char *name, int value, int most);

#endif
