/* update.h - one contact brought up to the present place of its blocks. */
#ifndef TL_DETECT_UPDATE_H
#define TL_DETECT_UPDATE_H

#include "contact/detection.h"
#include "contact/kind.h"
#include "contact/layout.h"
#include "contact/pair_view.h"
#include "model/model.h"

/* Whether they are although it has moved. */
bool tl_contact_points_hold_yet(tl_model *m, uint32_t contact);
/* Whether a contact's points are still good. */
static inline bool tl_contact_points_hold(tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    /* the blocks of one that ends may be gone; one that wants room is made when it has got it */
    if (c->pending[contact] == TL_PENDING_DIE || tl_pending_waits(c->pending[contact]))
        return true;
    double odometer = tl_contact_odometer(m, contact);
    bool valid = odometer <= c->points_valid_to[contact] && odometer <= c->faces_valid_to[contact];
    return (valid && m->config.reuse_geometry) || tl_contact_points_hold_yet(m, contact);
}
/* Brings a contact up to the present place; `pending` tells what is left to do. */
void tl_contact_update(tl_model *m, uint32_t contact, unsigned thread);
/* The same for a contact of bodies that have other frames than when its points were made. */
void tl_contact_reframe(tl_model *m, uint32_t contact, unsigned thread);
/* Lays the points of a contact that has just been given its room, unless it wants more: then it is still to grow;
 * false when out of memory. */
bool tl_contact_fill(tl_model *m, uint32_t contact);

/* Brings the facets of the contacts of a SIMD group up to the present place, if they are stale; `pending` tells what is
 * left to do. false when none was. */
bool tl_simd_group_update(tl_model *m, const tl_simd_group *group, unsigned thread);

#endif
