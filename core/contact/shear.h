/* shear.h - the shear of a contact: its sum over the points, and what becomes of its energy when their areas change. */
#ifndef TL_CONTACT_SHEAR_H
#define TL_CONTACT_SHEAR_H

#include "contact/detection.h"
#include "model/model.h"

/* Tolerance: changes of a contact's area up to this part of it are rounding. */
#define TL_SAME_AREA 1e-12

/* Twice the energy of a shear spring of the force f, times ks. */
static inline double tl_shear_energy(double f2, double area)
{
    return area > 0 ? f2 / area : 0;
}

/* Adds a point with its shear force. */
static inline void tl_shear_add(tl_shear *sum, double area, tl_vec3 arm, tl_vec3 force)
{
    sum->area += area;
    sum->energy += tl_shear_energy(tl_v3_norm2(force), area);
    sum->force = tl_v3_add(sum->force, force);
    sum->moment = tl_v3_add(sum->moment, tl_v3_cross(arm, force));
}

double tl_contact_area_of_points(const tl_detect *d, uint32_t contact);

/* Area, energy, force and moment about A's centroid of the points of a patch. */
tl_shear tl_shear_of(const tl_model *m, uint32_t contact);
/* Adds the energy of both springs of a field contact, and has its torsion. */
void tl_shear_add_field(const tl_model *m, uint32_t contact, tl_shear *sum);
/* After points have been given other areas, stresses as they were, which makes `now` of `before`. Area that
 * comes brings no shear, and area that goes takes its own. Where the area has grown, the shear force is brought
 * down to what it was. The springs never have more energy than before; what they have less is heat. */
void tl_shear_resized(tl_model *m, uint32_t contact, const tl_shear *before, const tl_shear *now);
/* Notes as heat what the springs have lost, and half of the work in the last step's motion of the forces that
 * are less. For the ledger has the mean of the forces at both ends of a step work, and those of its beginning
 * were still whole. */
void tl_shear_release(tl_model *m, uint32_t contact, const tl_shear *before, const tl_shear *now);

/* Column of the energy that shear holds beyond its springs, J, under a law; none: TL_NO_ROW. */
static inline uint32_t tl_shear_kept_column(const tl_model *m, uint32_t law)
{
    uint32_t column = law == TL_NO_ROW ? TL_NO_ROW : m->joint_laws[law].energy;
    return column < m->detect->points.state_columns ? column : TL_NO_ROW;
}
/* The sum of it over the points of a contact. */
double tl_shear_kept(const tl_model *m, uint32_t contact);
/* Gives new points, whose state is 0, that sum: those of a patch by their areas, in a field contact the point
 * of shear. Without points it is heat. */
void tl_shear_keep(tl_model *m, uint32_t contact, double energy);

#endif
