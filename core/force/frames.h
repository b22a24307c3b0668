/* frames.h - what is the same for all points of a contact, a contact in each lane: where it is, and how it moves. */
#ifndef TL_FORCE_FRAMES_H
#define TL_FORCE_FRAMES_H

#include "base/lanes.h"
#include "model/model.h"
#include "narrow/facet.h"

/* One contact in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_lanes9 to; /* from A's frame to the model's axes */
    tl_lanes3 n, plane;
    double offset[TL_LANES]; /* tl_facing */
    tl_lanes3 last;          /* normal in the last step */
    /* the motion of B against A in the last step at an arm from A's centroid: way + m arm; the mean spin of
     * both, as axis times the tangent of half its angle */
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
void tl_frames_put(tl_frames *f, const tl_frame_rows *rows, bool field);

#endif
