/* shear.h - the shear of a contact, and what becomes of it when its area changes (shear.c). */
#ifndef TL_CONTACT_SHEAR_H
#define TL_CONTACT_SHEAR_H

#include "model/model.h"

/* Changes of a contact's area up to this part of it are rounding. */
#define TL_SAME_AREA 1e-12

/* The shear of all points of a contact. */
typedef struct tl_shear {
    double area, energy;   /* of the springs, times 2 ks */
    tl_vec3 force, moment; /* on B, about A's centroid */
} tl_shear;

/* Of a patch. */
tl_shear tl_shear_of(const tl_model *m, uint32_t contact);
/* After points have been given other areas, stresses as they were, which makes `now` of `before`. What comes into contact
 * brings no shear, and what goes takes its own with it: where the area has grown, the shear force is brought down to
 * what it was; the springs never have more energy than before. What they have less is heat. */
void tl_shear_resized(tl_model *m, uint32_t contact, const tl_shear *before, const tl_shear *now);
/* Notes as heat what the springs have lost, and half of the work in the last step's motion of the forces that are less: the
 * ledger has the mean of the forces at both ends of a step work, and those of its beginning were still whole. */
void tl_shear_release(tl_model *m, uint32_t contact, const tl_shear *before, const tl_shear *now);

/* What shear holds beyond its springs, J: the sum of such a state of the law over the points of a contact. */
double tl_shear_kept(const tl_model *m, uint32_t contact);
/* Gives new points, whose state is 0, that sum: those of a patch by their areas, in a field contact the point of shear. Without points it is
 * heat. */
void tl_shear_keep(tl_model *m, uint32_t contact, double energy);

/* The motion of B against A in the last step: at an arm from A's centroid, `way` + `turn` x arm. */
typedef struct tl_contact_motion {
    tl_vec3 way, turn;
} tl_contact_motion;

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t contact);

#endif
