/* law_reads.h - what a law gives depends on its states and parameters, each of them, and on nothing that is not its own. */
#ifndef TL_CHECK_LAW_READS_H
#define TL_CHECK_LAW_READS_H

#include "check/checker.h"
#include "check/law_trial.h"

/* What the law gives depends on its parameters and states, and on nothing that is not its own. */
void tl_law_check_reads(tl_law_trial *t);
void tl_law_see_states(tl_law_trial *t);
void tl_law_see_params(tl_law_trial *t, tl_check_law varied[], const bool open[]);
void tl_law_tell_unseen(tl_checker *c, const tl_check_seen *seen);

#endif
