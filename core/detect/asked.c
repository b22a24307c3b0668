/* asked.c - contacts found for somebody who asks.
 *
 * After edits contacts are made anew, and what they carry is rounded. That must not be done whenever somebody asks:
 * later steps would then have other digits, and a law that is set would find contacts that no step has found. So what
 * is asked for after edits is found in a copy. The next step, or what is put on contacts, goes on from the contacts as
 * the last step left them, through all edits at once. m->found_for tells which contacts m->detect has:
 *
 *     TL_FOR_STEPS  -- query after edits -------------------------->  TL_FOR_QUERIES_IN_COPY  (steps: m->stepped)
 *                   <- next step, stress or law: drops the copy -----
 *
 *     TL_FOR_STEPS  -- query, or failed step, before a first step --->  TL_FOR_QUERIES  (steps: nothing yet)
 *                   <- next step, stress or law: drops all ----------
 *
 * A contact that is found for somebody who asks has the name by which the next step finds it: its blocks, and the
 * number of steps that have been made. */
#include "detect/asked.h"

#include "contact/store.h"

#include <stdlib.h>

/* Whether some contact has been in a step, or bears an initial stress. */
static bool has_begun(const tl_detect *d)
{
    return d->stepped || d->points.initial;
}

/* Contacts that follow other rules than the model's now are found anew. */
static void drop_other_rules(tl_model *m)
{
    const tl_detect *d = m->detect;
    if (!d || (d->rules == m->rules && d->contact_points == m->config.contact_points))
        return;
    tl_detect_destroy(m->detect);
    m->detect = NULL;
}

tl_status tl_asked_begin(tl_model *m)
{
    tl_detect *lasting = tl_detect_lasting(m);
    if (!lasting || !has_begun(lasting)) {
        drop_other_rules(m);
        m->found_for = TL_FOR_QUERIES;
        return TL_OK;
    }
    tl_detect *copy = tl_detect_copy(lasting);
    if (!copy)
        return tl_fail_memory(&m->error);
    if (m->found_for == TL_FOR_QUERIES_IN_COPY)
        tl_detect_destroy(m->detect);
    m->stepped = lasting;
    m->detect = copy;
    m->found_for = TL_FOR_QUERIES_IN_COPY;
    return TL_OK;
}

void tl_asked_step_failed(tl_model *m)
{
    if (m->found_for == TL_FOR_STEPS && m->detect && !has_begun(m->detect))
        m->found_for = TL_FOR_QUERIES;
}

void tl_asked_end(tl_model *m)
{
    if (m->found_for == TL_FOR_STEPS)
        return;
    if (m->detect)
        tl_detect_destroy(m->detect);
    m->detect = m->stepped;
    m->stepped = NULL;
    m->found_for = TL_FOR_STEPS;
}
