/* handover.h - a contact that was a patch becomes a field contact, or the other way round. */
#ifndef TL_CONTACT_HANDOVER_H
#define TL_CONTACT_HANDOVER_H

#include "contact/layout.h"
#include "model/model.h"
#include "narrow/narrow.h"
#include "narrow/press.h"

/* Puts the manifold's points in the place of the contact's, for which there is room, and notes the press of a
 * field. Force and moment of the shear are kept as far as the energy of its springs goes. The moment is lost
 * where the old points are `reframed`, in frames that are no more. */
void tl_contact_hand_over(tl_model *m, uint32_t contact, const tl_manifold *manifold, bool reframed,
                          const tl_point_lanes *lanes);
/* Heat, J, of a contact that is another one after this step, with a force on B, a moment about A's centroid and
 * an energy. It is what the contact has lost of its energy, less the work of the step by the mean of the forces
 * before and after. Or of one that ends. */
double tl_contact_lost(const tl_model *m, uint32_t contact, tl_vec3 force, tl_vec3 moment,
                       double stored);
double tl_contact_ends(const tl_model *m, uint32_t contact);
/* Notes that heat of a contact that is left without points. Its faces stay moved out by `lift`, m: what slip
 * has opened is forgotten, and of a patch all. */
void tl_contact_let_go(tl_model *m, uint32_t contact, double lift);
/* Puts the manifold of a field contact in the place of what it was. */
void tl_contact_refit_field(tl_model *m, uint32_t contact, const tl_manifold *manifold);
/* Says which faces of a contact's blocks its shift moves out. */
void tl_press_shift_faces(tl_model *m, uint32_t contact, tl_face_pair faces);
/* Brings the shift of a field contact's faces up to how far slip has opened its joint. Returns by how much in
 * the last step, m. */
double tl_contact_lift_field(tl_model *m, uint32_t contact);
/* What the shear springs of a field contact hold, J; 0 of a patch, whose open points hold none. */
double tl_contact_sheared(const tl_model *m, uint32_t contact);

#endif
