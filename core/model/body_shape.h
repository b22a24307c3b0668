/* body_shape.h - how small and how thin a body is. */
#ifndef TL_MODEL_BODY_SHAPE_H
#define TL_MODEL_BODY_SHAPE_H

#include "model/model.h"

/* Whether none of its parts is hidden. */
bool tl_body_is_visible(const tl_model *m, uint32_t body);

/* Of all parts of a body, m3; and the cube root of it, m. */
double tl_body_volume(const tl_model *m, uint32_t body);
double tl_body_size(const tl_model *m, uint32_t body);

/* Of a body of several parts: of their convex hull. One of thousands of corners counts as round, without edges. */
typedef struct tl_body_shape {
    double edge; /* the shortest, m */
    /* diameter over thickness: the largest distance of corners over the least extent along a face's normal */
    double aspect;
} tl_body_shape;

/* Of a body whose rows are tidy. false: out of memory. */
bool tl_body_shape_of(const tl_model *m, uint32_t body, tl_body_shape *out);

/* Least thickness that a block of volume V and surface S can have, m: a convex body holds a ball of radius V / S. */
static inline double tl_least_thickness(const tl_model *m, uint32_t row)
{
    const tl_blocks *b = &m->blocks;
    return 2 * b->volume[row] / (b->mean_face[row] * b->shape[row]->face_count);
}

/* The least of that of all parts, m. */
double tl_body_least_thickness(const tl_model *m, uint32_t body);

#endif
