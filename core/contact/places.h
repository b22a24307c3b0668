/* places.h - contacts one by one: where their facets and points are. */
#ifndef TL_CONTACT_PLACES_H
#define TL_CONTACT_PLACES_H

#include "contact/facing.h"
#include "contact/layout.h"
#include "model/model.h"

/* Arms, normals and closures of a contact's points in the present place, from lane 0 on. Returns the normal. */
tl_vec3 tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* Arm of one point, from A's body's centroid. */
tl_vec3 tl_contact_point_arm(const tl_model *m, uint32_t contact, size_t k);
/* Places of a contact's points, relative to the model's origin, and the gaps of the walls there: [point_count] each. */
void tl_contact_point_places(const tl_model *m, uint32_t contact, tl_vec3 *place, double *gap);
/* The motion of B against A in the last step: at an arm from A's centroid, `way` + `turn` x arm. */
typedef struct tl_contact_motion {
    tl_vec3 way, turn;
} tl_contact_motion;

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t contact);
/* The same about the place where A's centroid was before it: for a force and a moment about that. */
tl_contact_motion tl_contact_moved_from(const tl_model *m, uint32_t contact);
/* Where points of A's frame are in the present place. */
tl_facing_place tl_contact_place(const tl_model *m, uint32_t contact);
/* Area-weighted normal and point (coordinates relative to the origin), and the smallest gap. */
void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point, double *gap);

#endif
