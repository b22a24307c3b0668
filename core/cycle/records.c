/* records.c - runs in which blocks follow records of motion. */
#include "cycle/records.h"

#include "base/error.h"
#include "model/loads.h"
#include "model/record.h"

/* The least time between samples of the records that are followed, s; INFINITY: none is. */
static double least_dt(const tl_model *m)
{
    double least = INFINITY;
    for (size_t i = 0; i < m->drive_count; i++)
        for (int k = 0; k < 3 && m->drives[i].bodies > 0; k++)
            if (m->drives[i].drive.record[k])
                least = fmin(least, m->drives[i].drive.record[k]->dt);
    return least;
}

/* A damping whose forces grow with the unbalanced ones says so by its step factor. It takes most of the energy of any
 * vibration, whatever its frequency. */
tl_status tl_records_check(tl_model *m)
{
    const tl_damping_ops *ops = m->damping && !m->relaxing ? m->damping->ops : NULL;
    if (!ops || !ops->step_factor || !(ops->step_factor(m->damping_self) < 1) || isinf(least_dt(m)))
        return TL_OK;
    return tl_fail(
        &m->error, TL_E_STATE,
        "a block follows a record of motion under damping '%s', which takes out vibrations of all frequencies: "
        "choose another for the run, as of talus help dampings",
        m->damping->name);
}

void tl_records_remark(tl_model *m)
{
    const double least = least_dt(m);
    if (!m->relaxing && m->dt > least && tl_model_says(m, TL_REMARK_RECORD))
        tl_model_say(
            m,
            "the step, %.3g s, is longer than the %.3g s between samples of a record that is followed: part of the "
            "motion is left out",
            m->dt, least);
}
