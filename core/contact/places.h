/* places.h - contacts one by one: where their facets and points are. */
#ifndef TL_CONTACT_PLACES_H
#define TL_CONTACT_PLACES_H

#include "contact/facing.h"
#include "contact/layout.h"
#include "model/model.h"

/* Arms, normals and closures of a contact's points in the present place, from lane 0 on. */
void tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* Arm of one point, from A's body's centroid. */
tl_vec3 tl_contact_point_arm(const tl_model *m, uint32_t contact, size_t k);
/* Places of a contact's points, relative to the model's origin, and the gaps of the walls there: [point_count] each. */
void tl_contact_point_places(const tl_model *m, uint32_t contact, tl_vec3 *place, double *gap);
/* The same as tl_contact_places for a contact whose points are new: forces turn from here. */
void tl_contact_begin(tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* The motion of B against A in the last step: at an arm from A's centroid, `way` + `turn` x arm. */
typedef struct tl_contact_motion {
    tl_vec3 way, turn;
} tl_contact_motion;

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t contact);
/* How far, at most, points of a patch have been carried apart by their blocks since they were laid, and how far along the faces new ones
 * of the same keys lie from where they have gone: squares, in A's frame. */
typedef struct tl_contact_run {
    const tl_facet *laid;
    tl_facing_place by_b;
    double way2, run2;
} tl_contact_run;

tl_contact_run tl_contact_run_to(const tl_facet *laid, const tl_pair_pose *now);
void tl_contact_run_add(tl_contact_run *run, tl_vec3 old, tl_vec3 now);
/* Whether points have run along their polygon, farther than their blocks have moved: what they carry belongs to the places where they
 * have been. `near`: a distance that makes no difference. */
static inline bool tl_contact_has_run(const tl_contact_run *run, double near)
{
    return run->run2 > run->way2 && run->run2 > near * near;
}
/* Area-weighted normal and point (coordinates relative to the origin), and the smallest gap. */
void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point,
                        double *gap);

#endif
