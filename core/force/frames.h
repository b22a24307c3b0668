/* frames.h - what is the same for all points of a contact, a contact in each lane: where it is, and how it moves. */
#ifndef TL_FORCE_FRAMES_H
#define TL_FORCE_FRAMES_H

#include "base/lanes.h"
#include "model/model.h"
#include "narrow/facet.h"

/* Of the contacts of a SIMD group: the force on B of a normal force of 1, and where the arms of the points of a patch begin, from
 * A's centroid. Those of a field contact begin there. */
typedef struct tl_arms {
    tl_lanes3 push, at;
} tl_arms;

/* One contact in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_lanes9 to; /* of points to their arms */
    tl_lanes3 n, plane;
    double offset[TL_LANES]; /* tl_facing */
    tl_lanes3 last;          /* normal in the last step */
    /* the motion of B against A in the last step at an arm: way + m arm; the spin of the
     * common plane, as axis times the tangent of half its angle: B's by the share by which points stay with A, A's by the rest */
    tl_lanes3 way, half;
    tl_lanes9 m;
    tl_lanes9 turn; /* how shear forces turn, from the last common plane into the present one */
} tl_frames;

/* The bodies of a contact and its facet for each lane. */
typedef struct tl_frame_rows {
    const double *a[TL_LANES], *b[TL_LANES]; /* tl_pose */
    const double *facet[TL_LANES];           /* tl_facet */
    double dt;                               /* of the last step */
} tl_frame_rows;

/* Brings patches, or field contacts, into their present place. */
void tl_frames_put(tl_frames *f, const tl_frame_rows *rows, bool field, tl_arms *arms);

#endif
