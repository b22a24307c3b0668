/* boundary.h - the outer faces of a model by side, plane, box or direction; holding their blocks and loading them. */
#ifndef TL_EDIT_BOUNDARY_H
#define TL_EDIT_BOUNDARY_H

#include "model/model.h"

/* Integrals over a plane area in its own coordinates u, v. */
typedef struct tl_area_sums {
    double a, u, v, uu, uv, vv; /* of 1, u, v, u u, u v, v v */
} tl_area_sums;

/* The outer part of a face. A point of its plane is at o + u t1 + v t2. */
typedef struct tl_outer_face {
    uint32_t row, face;
    tl_vec3 normal, o, t1, t2; /* axes of the model; o relative to its origin */
    tl_area_sums sums;
} tl_outer_face;

#endif
