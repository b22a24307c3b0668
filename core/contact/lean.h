/* lean.h - how an initial stress and slip have moved the faces of a patch apart, by a plane. */
#ifndef TL_CONTACT_LEAN_H
#define TL_CONTACT_LEAN_H

#include "contact/layout.h"
#include "model/model.h"
#include "narrow/press.h"

/* What points of a patch are lifted by, as a plane. `mean` is how far it moves the faces apart, m, in the mean of those
 * that press, or of all where none does. Where it is not the same everywhere both faces lean, each by half. */
typedef struct tl_lean {
    double mean;
    bool leans;
    tl_plane face[2]; /* of A and of B, in the frames of their bodies, before the mean moves them */
} tl_lean;

/* The mean alone, m. It reads no block: the rows of the contact may be those of a former state of the model. */
double tl_contact_mean_lift(const tl_model *m, uint32_t contact);
tl_lean tl_contact_lean(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* How far apart blocks may be whose faces press, m. They are moved out by `shift` together and, with `face` not
 * NULL, lean so from the normal n of A's face. `size`: of the smaller block. */
double tl_lean_reach(double shift, const tl_plane *face, tl_vec3 n, double size);

#endif
