/* update.h - what update.c and renew.c share: contacts one by one, and eight patches at once. */
#ifndef TL_DETECT_UPDATE_H
#define TL_DETECT_UPDATE_H

#include "detect/detect.h"

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

#endif
