/* asked.c - contacts found for somebody who asks between edits.
 *
 * A contact of which a block has got another shape or frame is made anew, and what it carries is rounded. Were that done whenever
 * somebody asks, once after each of several edits instead of once after all, later steps would have other digits for
 * it. So what is asked for is found in a copy, and the next step goes on from the contacts as the last one left them, through all
 * edits at once. Nothing is copied for contacts that no step has seen: these are found as if nobody had asked (edited.c). */
#include "detect/asked.h"

#include "contact/copy.h"
#include "contact/store.h"
#include "detect/edited.h"

/* Whether blocks have come, gone or changed since contacts were found. */
static bool is_stale(const tl_model *m)
{
    return m->detect->structure != m->structure || m->detect->rows_changed;
}

tl_status tl_asked_begin(tl_model *m)
{
    bool copies = m->detect && is_stale(m) && (m->stepped || tl_edited_stepped(m));
    if (!copies)
        return TL_OK;
    tl_detect *copy = tl_detect_copy(tl_detect_lasting(m));
    if (!copy)
        return tl_fail_memory(&m->error);
    if (m->stepped)
        tl_detect_destroy(m->detect);
    else
        m->stepped = m->detect;
    m->detect = copy;
    return TL_OK;
}

void tl_asked_end(tl_model *m)
{
    if (!m->stepped)
        return;
    bool found = !is_stale(m); /* then it would be found once more */
    tl_detect_destroy(found ? m->stepped : m->detect);
    m->detect = found ? m->detect : m->stepped;
    m->stepped = NULL;
}
