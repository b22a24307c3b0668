/* handover.h - a manifold takes the place of a contact. */
#ifndef TL_CONTACT_HANDOVER_H
#define TL_CONTACT_HANDOVER_H

#include "contact/kind.h"
#include "model/model.h"
#include "narrow/narrow.h"
#include "narrow/press.h"

/* Patches and field contacts, made. */
extern const tl_kind_make tl_patch_make, tl_field_make;
/* Heat, J, of a contact that is another one after this step, with a force on B, a moment about A's centroid and
 * an energy. It is what the contact has lost of its energy, less the work of the step by the mean of the forces
 * before and after. */
double tl_contact_lost(const tl_model *m, uint32_t contact, tl_vec3 force, tl_vec3 moment, double stored);
/* The same of one that ends. */
static inline double tl_contact_ends(const tl_model *m, uint32_t contact)
{
    return tl_contact_lost(m, contact, tl_v3(0, 0, 0), tl_v3(0, 0, 0), 0);
}
/* Says which faces of a contact's blocks its shift moves out. */
void tl_press_shift_faces(tl_model *m, uint32_t contact, tl_face_pair faces);
/* Brings the shift of a field contact's faces up to how far slip has opened its joint. Returns by how much in
 * the last step, m. */
double tl_contact_lift_field(tl_model *m, uint32_t contact);
/* What the shear springs of a field contact hold, J; 0 of a patch, whose open points hold none. */
double tl_contact_sheared(const tl_model *m, uint32_t contact);

#endif
