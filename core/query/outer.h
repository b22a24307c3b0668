/* outer.h - the parts of faces that lie on no other block, and integrals over them (outer.c). */
#ifndef TL_QUERY_OUTER_H
#define TL_QUERY_OUTER_H

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

/* Measures the outer part of a face of the block in a row, after a tl_detect_refresh. Its area is 0 where all of the face
 * but for roundings lies on others. */
tl_status tl_outer_measure(tl_model *m, uint32_t row, uint32_t face, tl_outer_face *out);
/* Centroid of it, relative to the origin. */
tl_vec3 tl_outer_centroid(const tl_outer_face *face);

#endif
