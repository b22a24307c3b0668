/* transfer.h - new contact points in the place of old ones. */
#ifndef TL_CONTACT_TRANSFER_H
#define TL_CONTACT_TRANSFER_H

#include "contact/layout.h"
#include "model/model.h"
#include "narrow/narrow.h"

/* Puts the manifold's points in the place of the contact's, for which there is room. State goes over so that
 * total force and moment follow the area. false: out of memory. */
bool tl_contact_transfer(tl_model *m, uint32_t contact, tl_narrow_scratch *scratch, const tl_point_lanes *lanes);

/* Puts the points of a manifold in the place of a contact's, without stress, their states at the beginning.
 * Arms and normals are in the lanes. */
void tl_contact_place_points(tl_model *m, uint32_t contact, const tl_manifold *manifold, const tl_point_lanes *lanes);

#endif
