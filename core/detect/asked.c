/* asked.c - contacts found for somebody who asks.
 *
 * After edits contacts are made anew, and what they carry is rounded. Were that done whenever somebody asks, once after each of
 * several edits instead of once after all, later steps would have other digits for it; and a law that is set would find contacts
 * that no step has found. So what is asked for after edits is found in a copy, and the next step, or what is put on contacts,
 * goes on from the contacts as the last one left them, through all edits at once. Only the ids that contacts were asked by stay
 * theirs. */
#include "detect/asked.h"

#include "contact/copy.h"
#include "contact/store.h"

#include <stdlib.h>

/* Whether some contact has been in a step, or bears an initial stress. */
static bool has_begun(const tl_model *m)
{
    return m->detect->stepped_contact > 0 || m->detect->points.initial;
}

tl_status tl_asked_begin(tl_model *m)
{
    if (!m->detect || !has_begun(m)) {
        m->only_asked = true;
        return TL_OK;
    }
    tl_detect *copy = tl_detect_copy(tl_detect_lasting(m));
    if (!copy)
        return tl_fail_memory(&m->error);
    if (m->stepped) {
        copy->next_contact = m->detect->next_contact;
        tl_detect_destroy(m->detect);
    } else {
        m->stepped = m->detect;
    }
    m->detect = copy;
    return TL_OK;
}

/* ---------------------------------------------------------------- ids -------------------- */

static int compare(const void *x, const void *y)
{
    const tl_asked_id *p = x, *q = y;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

/* Notes the contacts that have ids above `last`, those of the last step. Without the memory for it they get others. */
static void note_ids(tl_model *m, tl_id last)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    tl_asked_id *list = malloc((c->table.rows + 1) * sizeof *list);
    size_t count = 0;
    for (size_t i = 0; list && i < c->table.rows; i++)
        if (c->id[i] > last)
            list[count++] =
                (tl_asked_id){d->known_blocks[c->a[i]].id, d->known_blocks[c->b[i]].id, c->id[i]};
    if (count > 1)
        qsort(list, count, sizeof *list, compare);
    free(m->asked_ids);
    m->asked_ids = list;
    m->asked_count = count;
    m->next_contact = d->next_contact;
}

void tl_asked_end(tl_model *m)
{
    if (m->stepped) {
        note_ids(m, m->stepped->next_contact);
        m->stepped->next_contact = m->next_contact;
        tl_detect_destroy(m->detect);
        m->detect = m->stepped;
        m->stepped = NULL;
    } else if (m->detect && m->only_asked) {
        note_ids(m, 0);
        tl_detect_destroy(m->detect);
        m->detect = NULL;
    }
    m->only_asked = false;
}

void tl_asked_name(tl_model *m)
{
    tl_detect *d = m->detect;
    for (size_t i = 0; m->asked_count > 0 && i < d->contacts.table.rows; i++) {
        tl_id *id = &d->contacts.id[i];
        tl_asked_id one = {m->blocks.id[d->contacts.a[i]], m->blocks.id[d->contacts.b[i]], 0};
        const tl_asked_id *known =
            *id > m->next_contact ? bsearch(&one, m->asked_ids, m->asked_count, sizeof one, compare)
                                  : NULL;
        *id = known ? known->contact : *id;
        d->by_id_fresh = d->by_id_fresh && !known;
    }
    free(m->asked_ids);
    m->asked_ids = NULL;
    m->asked_count = 0;
}
