/* fracture.h - planes of finite extent, and which sections of blocks they reach. */
#ifndef TL_GENERATE_FRACTURE_H
#define TL_GENERATE_FRACTURE_H

#include "generate/staging.h"

/* A plane, a disc of it or a convex polygon in it, in user coordinates. */
typedef struct tl_fracture {
    tl_vec3 normal, point; /* of unit length; on the plane, the centre of the disc or the middle of the polygon */
    double radius;         /* of the disc, or of the ball about `point` that holds the polygon; INFINITY: neither */
    const tl_vec3 *corner; /* [corner_count] of the polygon, in order around it */
    size_t corner_count;   /* 0: a plane or disc */
} tl_fracture;

static inline tl_fracture tl_fracture_disc(tl_vec3 normal, tl_vec3 point, double radius)
{
    return (tl_fracture){normal, point, radius, NULL, 0};
}

/* A convex polygon of finite corners, which are not copied. TL_E_GEOMETRY with a sentence for one that is none. */
tl_status tl_fracture_polygon(const tl_vec3 *corner, size_t count, tl_fracture *made, tl_error *error);
/* Whether a fracture reaches into a face that lies in its plane. The shape is in the frame of a body, or with `body`
 * TL_NO_ROW relative to the model's origin. */
bool tl_fracture_reaches(const tl_model *m, const tl_fracture *fracture, uint32_t body, const tl_poly *p,
                         uint32_t face);

#endif
