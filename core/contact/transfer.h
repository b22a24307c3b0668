/* transfer.h - new contact points in the place of old ones (transfer.c). */
#ifndef TL_CONTACT_TRANSFER_H
#define TL_CONTACT_TRANSFER_H

#include "contact/layout.h"
#include "model/model.h"
#include "narrow/narrow.h"

/* Puts the manifold's points in the place of the contact's, carrying over state so that total force
 * and moment follow the area; the points fit into the contact's room. */
bool tl_contact_transfer(tl_model *m, uint32_t contact, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes);

#endif
