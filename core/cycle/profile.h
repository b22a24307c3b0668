/* profile.h - what a step costs. */
#ifndef TL_CYCLE_PROFILE_H
#define TL_CYCLE_PROFILE_H

#include "cycle/cycle_data.h"

/* Times a phase that ends now and began when the one before ended, or with the step. */
void tl_profile_step(tl_model *m);
void tl_profile_phase(tl_model *m, tl_phase phase);
static inline void tl_step_begins(tl_model *m)
{
    if (m->profiling)
        tl_profile_step(m);
}
static inline void tl_phase_ends(tl_model *m, tl_phase phase)
{
    if (m->profiling)
        tl_profile_phase(m, phase);
}

#endif
