/* tangent.h - how the forces of an element change with small motions of its bodies. */
#ifndef TL_ELEMENT_TANGENT_H
#define TL_ELEMENT_TANGENT_H

#include "element/elements.h"

/* Of the element in a row. Motion 6 i + k is that of body i along axis k, m. Motion 6 i + 3 + k is its turn about axis
 * k through the centroid, rad. Axes are the model's. */
typedef struct tl_element_tangent {
    uint32_t *body; /* rows of the rigid bodies that can move and carry nodes, by the first node on each */
    uint32_t count;
    double *k;     /* [6 count][6 count]: what resists motion i when motion j is 1, N or N m; symmetric */
    bool internal; /* no node bears anything else when all move together */
} tl_element_tangent;

/* Fills *t, which holds memory of an earlier call or is 0. Forces are asked for on copies, so nothing changes. The
 * motion takes no time, as in model:relax: dashpots bear nothing. What yields has the stiffness by which it unloads.
 * TL_E_MEMORY, TL_E_NUMERIC, or what update() of the kind returns. */
tl_status tl_element_tangent_find(tl_model *m, uint32_t row, tl_element_tangent *t);
void tl_element_tangent_free(tl_element_tangent *t);

#endif
