/* held.c - contacts between two bodies that are held still: told apart from the others, and left alone at rest.
 *
 * Such contacts have spans of their own (simd_groups.c). Their gaps and areas do not change, so they are followed only until a
 * step finds that their laws leave them exactly as they were. Laws are functions of their points' parameters, states and
 * motion, so every later step would find the same, and the whole span is passed over. A law that goes on with time at rest
 * keeps its span followed. Whatever could change that wakes all such spans: blocks that are fixed, freed, driven or
 * given a velocity, that come or go, another law or initial stress, another contact in the span. */
#include "contact/held.h"

#include "contact/detection.h"

static bool is_still(const tl_bodies *b, uint32_t body)
{
    return b->fixed[body] == TL_FIX_ALL && b->drive[body] == 0 && tl_v3_is_zero(b->v[body]) &&
           tl_v3_is_zero(b->w[body]);
}

bool tl_blocks_held_still(const tl_model *m, uint32_t a, uint32_t b)
{
    return is_still(&m->bodies, m->blocks.body[a]) && is_still(&m->bodies, m->blocks.body[b]);
}

/* Bodies none of whose contacts can change the sum of their forces. */
static void find_idle(tl_model *m)
{
    tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        d->idle[body] = is_still(&m->bodies, body);
    for (uint32_t i = 0; i < c->table.rows; i++) {
        if (c->held[i])
            continue;
        d->idle[m->blocks.body[c->a[i]]] = false;
        d->idle[m->blocks.body[c->b[i]]] = false;
    }
}

void tl_held_wake(tl_model *m)
{
    tl_detect *d = m->detect;
    for (size_t r = 0; r < d->layout.span_count; r++)
        d->layout.spans[r].rest = TL_SPAN_WOKEN;
    d->any_idle = false;
}

void tl_held_sort(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        bool held = tl_blocks_held_still(m, c->a[row], c->b[row]);
        if (held != c->held[row] && c->pending[row] == TL_PENDING_NONE)
            c->pending[row] = TL_PENDING_MOVE;
        c->held[row] = held;
    }
    tl_held_wake(m);
}

void tl_held_followed(tl_model *m)
{
    tl_detect *d = m->detect;
    bool rests = false, all = true;
    for (size_t r = 0; r < d->layout.span_count; r++) {
        tl_span *span = &d->layout.spans[r];
        if (!span->held || span->rest == TL_SPAN_RESTS)
            continue;
        /* the first step may still have met motion from before the bodies were held */
        span->rest =
            span->rest == TL_SPAN_WOKEN || span->changed ? TL_SPAN_FOLLOWED : TL_SPAN_RESTS;
        rests = rests || span->rest == TL_SPAN_RESTS;
        all = all && span->rest == TL_SPAN_RESTS;
    }
    if (!rests || !all)
        return;
    find_idle(m);
    d->any_idle = true;
}
