/* face_filter.h - which faces are meant by side, plane, box or direction. */
#ifndef TL_EDIT_FACE_FILTER_H
#define TL_EDIT_FACE_FILTER_H

#include "model/model.h"

#include <talus/boundary.h>

/* Which faces are meant, once the model's bounds are known. */
typedef struct tl_face_filter {
    const tl_boundary_where *where;
    bool plane, box, facing;
    tl_vec3 normal, at;  /* of the plane, relative to the origin */
    tl_bounds bounds;    /* of the box, likewise */
    tl_vec3 direction;   /* unit */
    double least_cosine; /* with it */
} tl_face_filter;

tl_status tl_face_filter_begin(tl_model *m, const tl_boundary_where *where, tl_face_filter *s);
/* Whether a face of a rigid block is where it is looked for; it may be no outer one. */
bool tl_face_is_there(const tl_model *m, const tl_face_filter *s, uint32_t row, uint32_t face);
/* The same of a triangle of the surface of a deformable block: places of its corners, relative to the origin. */
bool tl_triangle_is_there(const tl_model *m, const tl_face_filter *s, uint32_t row, const tl_vec3 corner[3]);
/* Whether one in the plane that is meant has its middle in the box, but reaches out of it. */
bool tl_triangle_reaches_out(const tl_model *m, const tl_face_filter *s, uint32_t row, const tl_vec3 corner[3]);

#endif
