/* asked.h - whether what is asked of a search for factors can be answered. */
#ifndef TL_SAFETY_ASKED_H
#define TL_SAFETY_ASKED_H

#include "model/model.h"

#include <talus/safety.h>

/* Tolerance: the least factor: what strengths are divided by while joints settle, and then nothing that holds at all
 * slips. */
#define TL_LEAST_FACTOR 0.05

/* Checks options, bodies and processes, or refuses with a sentence that begins with `what`. *which, to be freed: of
 * each law whether it is divided. */
tl_status tl_asked_check(tl_model *m, const char *what, const tl_safety *options, uint8_t **which);

#endif
