/* side.h - the sides of segments in the present place, how they move, and what forces and couples do to them. */
#ifndef TL_SEGMENT_SIDE_H
#define TL_SEGMENT_SIDE_H

#include "segment/segments.h"

/* A side now: places of its corners and their motion in the last step, or a rigid body's; its outward normal. */
typedef struct tl_side_now {
    bool rigid;
    uint32_t body;
    tl_vec3 x[3], d[3];
    tl_vec3 slope[3]; /* of the weights, 1/m */
    tl_vec3 shift;    /* of a rigid side: of its centroid in the last step, m */
    tl_mat3 back;     /* and what a point has moved beside that, on its arm */
    tl_vec3 normal, turn;
} tl_side_now;

/* `normal`: of a rigid side, in the body's frame. */
tl_side_now tl_side_now_of(const tl_model *m, const tl_segment_side *side, tl_vec3 normal);
/* Where a point of the side is. */
tl_vec3 tl_side_now_place(const tl_model *m, const tl_side_now *s, tl_vec3 at);
/* How a point of the side has moved that lies `off` it, at a place. */
tl_vec3 tl_side_now_motion(const tl_model *m, const tl_side_now *s, tl_vec3 at, tl_vec3 off, tl_vec3 place);
/* Adds a couple, or the force of a point, to what a side gets: forces on the corners, or a body's force and moment. */
void tl_side_turn(const tl_side_now *s, tl_vec3 couple, double sum[9]);
void tl_side_push(const tl_model *m, const tl_segment_side *side, tl_vec3 at, tl_vec3 force, double sum[9]);

#endif
