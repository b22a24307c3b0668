/* profile.c - what a step costs: the time of its phases, by the wall clock, while the user wants to know;
 * and how much a step works on. Nothing that is computed depends on it. */
#include "cycle/profile.h"

#include "base/clock.h"
#include "contact/detection.h"

#include <string.h>

void tl_model_profiling(tl_model *m, bool on)
{
    if (on)
        memset(&m->profile, 0, sizeof m->profile);
    m->profiling = on;
}

void tl_profile_step(tl_model *m)
{
    m->phase_began = tl_clock();
    m->profile.steps++;
}

void tl_profile_phase(tl_model *m, tl_phase phase)
{
    double now = tl_clock();
    m->profile.seconds[phase] += now - m->phase_began;
    m->phase_began = now;
}

tl_profile tl_model_profile(const tl_model *m)
{
    tl_profile profile = m->profile;
    const tl_detect *d = m->detect;
    if (!d)
        return profile;
    profile.pairs = d->pair_count;
    profile.contacts = d->contacts.table.rows;
    for (size_t c = 0; c < d->contacts.table.rows; c++) {
        profile.points += d->contacts.point_count[c];
        profile.loaded += tl_v3_norm2(d->contacts.force[c]) > 0;
    }
    return profile;
}
