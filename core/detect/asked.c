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
 * Only the ids that contacts were asked by stay theirs, in what is copied and saved, too. Contacts that nobody has
 * asked for count on from these, in the order of their births. */
#include "detect/asked.h"

#include "contact/store.h"

#include <stdlib.h>

/* Whether some contact has been in a step, or bears an initial stress. */
static bool has_begun(const tl_detect *d)
{
    return d->stepped_contact > 0 || d->points.initial;
}

/* ---------------------------------------------------------------- ids -------------------- */

static int compare(const void *x, const void *y)
{
    const tl_asked_id *p = x, *q = y;
    return tl_pair_order(p->a, p->b, q->a, q->b);
}

bool tl_asked_note(tl_model *m)
{
    if (m->found_for == TL_FOR_STEPS || !m->detect)
        return true;
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    tl_id last = m->stepped ? m->stepped->next_contact : 0;
    tl_asked_id *list = malloc((c->table.rows + 1) * sizeof *list);
    m->next_contact = d->next_contact;
    if (!list)
        return false;
    size_t count = 0;
    for (size_t i = 0; i < c->table.rows; i++)
        if (c->id[i] > last)
            list[count++] = (tl_asked_id){d->known_blocks[c->a[i]].id, d->known_blocks[c->b[i]].id, c->id[i]};
    if (count > 1)
        qsort(list, count, sizeof *list, compare);
    free(m->asked_ids);
    m->asked_ids = list;
    m->asked_count = count;
    return true;
}

/* New contacts get ids beyond those that were given to somebody who asked. */
static void go_on_counting(tl_model *m)
{
    if (m->detect->next_contact < m->next_contact)
        m->detect->next_contact = m->next_contact;
}

/* ---------------------------------------------------------------- life ------------------- */

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
    if (!tl_asked_note(m))
        return tl_fail_memory(&m->error);
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
    go_on_counting(m);
    return TL_OK;
}

void tl_asked_step_failed(tl_model *m)
{
    if (m->found_for == TL_FOR_STEPS && m->detect && !has_begun(m->detect))
        m->found_for = TL_FOR_QUERIES;
}

void tl_asked_end(tl_model *m)
{
    (void)tl_asked_note(m); /* without the memory for it contacts get other ids */
    if (m->found_for != TL_FOR_STEPS) {
        if (m->detect)
            tl_detect_destroy(m->detect);
        m->detect = m->stepped;
        m->stepped = NULL;
        m->found_for = TL_FOR_STEPS;
    }
    if (m->detect)
        go_on_counting(m);
}

/* Stands for the id of a contact that was not known when ids were noted. */
#define UNKNOWN UINT32_MAX

bool tl_asked_name(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    tl_id first = m->next_contact + 1, last = m->next_contact;
    size_t born = m->asked_count ? d->next_contact - m->next_contact : 0;
    tl_id *name = born ? calloc(born, sizeof *name) : NULL;
    if (born && !name)
        return false;
    for (size_t i = 0; born && i < c->table.rows; i++) {
        if (c->id[i] < first)
            continue;
        tl_asked_id one = {m->blocks.id[c->a[i]], m->blocks.id[c->b[i]], 0};
        const tl_asked_id *known = bsearch(&one, m->asked_ids, m->asked_count, sizeof one, compare);
        name[c->id[i] - first] = known ? known->contact : UNKNOWN;
    }
    for (size_t k = 0; k < born; k++)
        if (name[k] == UNKNOWN)
            name[k] = ++last;
    for (size_t i = 0; born && i < c->table.rows; i++)
        if (c->id[i] >= first)
            c->id[i] = name[c->id[i] - first];
    if (born) {
        d->next_contact = last;
        d->by_id_fresh = false;
    }
    free(name);
    free(m->asked_ids);
    m->asked_ids = NULL;
    m->asked_count = 0;
    return true;
}
