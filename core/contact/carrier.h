/* carrier.h - what bears one side of a contact with a deformable block.
 *
 * The place of the contact keeps to the material of the zone behind it, and turns with that zone. So the shape of the
 * block is carried there as if it were rigid, by the pose of its carrier. */
#ifndef TL_CONTACT_CARRIER_H
#define TL_CONTACT_CARRIER_H

#include "model/model.h"

typedef struct tl_carrier {
    tl_pose pose;
    tl_quat q;
    tl_vec3 v, w; /* of the last motion */
    double odometer;
    uint32_t point[4]; /* numbers of the corners of the zone in its mesh */
    double weight[4];  /* of them at the place */
    tl_vec3 at;        /* the place in the carrier's frame, m */
    tl_mat3 begun;     /* its rotation when it began, */
    tl_mat3 edges;     /* and the inverse of the edges of the zone then */
    uint32_t on;       /* 0: the side is not carried */
    uint32_t unused;
} tl_carrier;

/* The rows of sides that are carried have this bit; below it, twice the row of the contact and the side. */
#define TL_CARRIED 0x80000000u

#endif
