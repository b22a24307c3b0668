/* update.h - one contact brought up to the present place of its blocks (update.c). */
#ifndef TL_DETECT_UPDATE_H
#define TL_DETECT_UPDATE_H

#include "contact/detection.h"
#include "contact/pair_view.h"
#include "model/model.h"

/* Whether a contact's points are still good although its odometers have run out. */
bool tl_contact_points_hold_yet(tl_model *m, uint32_t contact);

/* Whether a contact's points are still good. */
static inline bool tl_contact_points_hold(tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    /* the blocks of one that ends may be gone; one that wants room is made when it has got it */
    if (c->pending[contact] == TL_PENDING_DIE || tl_pending_waits(c->pending[contact]))
        return true;
    double odometer = tl_pair_odometer(m, c->a[contact], c->b[contact]);
    bool valid = odometer <= c->points_valid_to[contact] && odometer <= c->faces_valid_to[contact];
    return (valid && m->config.reuse_geometry) || tl_contact_points_hold_yet(m, contact);
}
/* Whether a contact is a patch and stays one. */
bool tl_contact_is_patch(tl_model *m, uint32_t contact);
/* Lets a contact whose points have just been made move a little before they are made anew. */
void tl_contact_allow_reuse(tl_model *m, uint32_t contact);
/* Brings a contact up to the present place; `pending` tells what is left to do. */
void tl_contact_update(tl_model *m, uint32_t contact, unsigned thread);
/* The same for some field contacts that go on, up to TL_FIELD_PAIRS. */
void tl_contacts_follow(tl_model *m, const uint32_t contact[], uint32_t count, unsigned thread);
/* The same for a contact of bodies that have other frames than when its points were made. */
void tl_contact_reframe(tl_model *m, uint32_t contact, unsigned thread);
/* Lays the points of a contact that has just been given its room, unless it wants more: then it is still to grow;
 * false when out of memory. */
bool tl_contact_fill(tl_model *m, uint32_t contact);

#endif
