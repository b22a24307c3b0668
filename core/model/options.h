/* options.h - reading the structs of options that callers give. */
#ifndef TL_MODEL_OPTIONS_H
#define TL_MODEL_OPTIONS_H

#include <talus/talus.h>

/* Default: minimum area of field contacts, as a share of the smaller block's mean face area: none. Hart, Cundall and
 * Lemos (1988) have 1 % of a face. */
#define TL_AREA_FRACTION 0.0
/* Default: FRAC of (27), by the rule: one contact counts (Hart, Cundall and Lemos 1988), or all of a body. At 0.7 all
 * verification holds, too, but 150 stones that fall into a tray on soft joints gain up to 60 % energy. With 0.5 they
 * gain up to 7 %, by the paper with 0.1 up to 11 %. */
#define TL_PAPER_FRACTION 0.1
#define TL_BODY_FRACTION 0.5

/* Default: share of the mass that may be added for a longer step: what slides or falls is then as much slower at the
 * most. Test: lua/test_mass_added. */
#define TL_MOST_ADDED 0.05

/* Copies a caller's struct of options into the library's own, `own`: what the caller's headers did not know yet has its
 * default, and so has everything when `given` is NULL. Refuses a struct without size, or of headers newer than this
 * library. */
tl_status tl_options_read(tl_options which, const void *given, void *own, tl_error *error);

/* The same, with the type in the place of its number. */
#define TL_OPTIONS_READ(type, given, own, error)                                                   \
    tl_options_read(TL_OPTIONS_OF_##type, 1 ? (given) : (const type *)NULL,                        \
                    1 ? (own) : (type *)NULL, (error))

/* TL_E_ARGUMENT with a sentence for what is none of the values 0 .. most of an enumeration. */
tl_status tl_check_choice(tl_error *error, const char *name, int value, int most);

#endif
