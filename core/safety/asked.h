/* asked.h - whether what is asked of a search for factors can be answered. */
#ifndef TL_SAFETY_ASKED_H
#define TL_SAFETY_ASKED_H

#include "safety/trial.h"

/* Tolerance: the least factor: what strengths are divided by while joints settle, and then nothing that holds at all
 * slips. */
#define TL_TRIALS_LEAST 0.05

/* Checks options, bodies and processes, and chooses the laws: t->which. Refuses with a sentence. */
tl_status tl_trials_check(tl_trials *t);

#endif
