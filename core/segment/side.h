/* side.h - normals of sides of segments, and what couples do to them. */
#ifndef TL_SEGMENT_SIDE_H
#define TL_SEGMENT_SIDE_H

#include "segment/segments.h"

/* A side in the present place: its outward normal, and of a triangle the slopes of the weights, 1/m. */
typedef struct tl_side_now {
    bool rigid;
    tl_vec3 slope[3], normal;
} tl_side_now;

/* `normal`: of a rigid side, in the body's frame. */
tl_side_now tl_side_now_of(const tl_model *m, const tl_segment_side *side, tl_vec3 normal);
/* Adds a couple to what a side gets: forces on the corners, or a body's force and moment. */
void tl_side_turn(const tl_side_now *s, tl_vec3 couple, double sum[9]);

#endif
