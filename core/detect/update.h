/* update.h - one contact brought up to the present place of its blocks (update.c). */
#ifndef TL_DETECT_UPDATE_H
#define TL_DETECT_UPDATE_H

#include "model/model.h"
#include "narrow/axis.h"

/* How far a pair may run before its axis is searched again. */
double tl_axis_margin(const tl_axis *axis, double size);
/* Whether a contact's facets are still good. */
bool tl_contact_stands(const tl_model *m, uint32_t contact);
/* Whether a contact is two faces on each other and nothing else, and its axis stands. */
bool tl_contact_is_patch(const tl_model *m, uint32_t contact);
/* Lets a contact whose facets have just been made move a little before they are made anew; less where areas depend on a
 * gap (tl_manifold). */
void tl_contact_allow_reuse(tl_model *m, uint32_t contact, bool brief);
/* Brings the facets of a contact up to the present place; its fate tells what is left to do. */
void tl_contact_update(tl_model *m, uint32_t contact, unsigned thread);
/* The same for a contact of bodies that have other frames than when its facets were made. */
void tl_contact_reframe(tl_model *m, uint32_t contact, unsigned thread);
/* Builds the facets of a contact that has just been given its room, unless it wants more: then its fate is still to
 * grow; false when out of memory. */
bool tl_contact_fill(tl_model *m, uint32_t contact);

#endif
