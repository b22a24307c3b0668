/* bear.h - what a law bears at the points of a contact. */
#ifndef TL_FORCE_BEAR_H
#define TL_FORCE_BEAR_H

#include "model/model.h"

/* Tractions on B at the points of a contact, Pa: normal, compression positive, and shear in the common plane. */
typedef struct tl_traction {
    double normal;
    tl_vec3 shear;
} tl_traction;

/* Sets `borne` to what the law of a patch makes of tractions that were there before: what it can bear of them. *stored:
 * the energy of the springs then, J. [point_count] each. The contact is left as it is. false: the law failed. */
bool tl_contact_bear(const tl_model *m, uint32_t contact, const tl_traction *given, tl_traction *borne, double *stored);
/* The shear that a contact carries over that which its law bears at the present normal stresses. NaN where it carries
 * none or the law has no limit. The contact is left as it is. */
double tl_contact_shear_used(const tl_model *m, uint32_t contact);

#endif
