/* places.h - contacts one by one: where their facets and points are (places.c). */
#ifndef TL_CONTACT_PLACES_H
#define TL_CONTACT_PLACES_H

#include "contact/facing.h"
#include "contact/layout.h"
#include "model/model.h"

/* Two bodies as a contact sees them: axes of the model, A's centroid as zero. */
typedef struct tl_sight {
    const tl_mat3 *ra, *rb;
    tl_vec3 d; /* from A's centroid to B's */
    tl_poly *const *shapes;
    uint32_t a, b; /* rows of the blocks */
} tl_sight;

tl_sight tl_sight_of(const tl_model *m, uint32_t contact);
tl_facing tl_facing_of(const tl_facet *f, const tl_sight *s);

/* Arms, normals and closures of a contact's points in the present place, from lane 0 on. */
void tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* The same for a contact whose points are new: forces turn from here. */
void tl_contact_begin(tl_model *m, uint32_t contact, const tl_point_lanes *lanes);
/* Area-weighted normal and point (coordinates relative to the origin), and the smallest gap. */
void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point,
                        double *gap);
/* Normal of a point that leans so when its contact was last followed; 0 when it never was. */
tl_vec3 tl_facet_last_normal(const tl_facet *facet, tl_lean lean);

#endif
