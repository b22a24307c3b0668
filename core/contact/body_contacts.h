/* body_contacts.h - the contacts of a body or of a block, one after the other: by ascending block, of each by ascending
 * partner.
 *
 *     for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);)
 *         area += c->area[at.contact];
 */
#ifndef TL_CONTACT_BODY_CONTACTS_H
#define TL_CONTACT_BODY_CONTACTS_H

#include "contact/detection.h"

typedef struct tl_body_contacts {
    uint32_t contact, block;                 /* rows: of a contact, and of the block of the body that has it */
    const uint32_t *next, *end;              /* contacts of this block that are left */
    const uint32_t *next_block, *blocks_end; /* blocks that are left */
    const tl_detect *d;
} tl_body_contacts;

static inline tl_body_contacts tl_contacts_of_body(const tl_model *m, uint32_t body)
{
    const uint32_t *blocks = tl_body_blocks(m, body);
    return (tl_body_contacts){
        .next_block = blocks, .blocks_end = blocks + m->bodies.member_count[body], .d = m->detect};
}

static inline tl_body_contacts tl_contacts_of_block(const tl_model *m, uint32_t block)
{
    const tl_detect *d = m->detect;
    return (tl_body_contacts){.block = block,
                              .next = d->by_block + d->by_block_start[block],
                              .end = d->by_block + d->by_block_start[block + 1]};
}

/* Goes on to the next block that has a contact; false: there is none. */
static inline bool tl_next_block(tl_body_contacts *at)
{
    while (at->next_block != at->blocks_end) {
        at->block = *at->next_block++;
        at->next = at->d->by_block + at->d->by_block_start[at->block];
        at->end = at->d->by_block + at->d->by_block_start[at->block + 1];
        if (at->next != at->end)
            return true;
    }
    return false;
}

/* Goes on to the next contact; false: there is none. */
static inline bool tl_next_contact(tl_body_contacts *at)
{
    if (at->next == at->end && !tl_next_block(at))
        return false;
    at->contact = *at->next++;
    return true;
}

/* Whether some contact of a body has contact points. */
static inline bool tl_body_has_points(const tl_model *m, uint32_t body)
{
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);)
        if (m->detect->contacts.point_count[at.contact] > 0)
            return true;
    return false;
}

#endif
