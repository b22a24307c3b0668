/* frames.h - what is the same for all points of a facet, a facet in each lane: where it is, and how it moves. */
#ifndef TL_DETECT_FRAMES_H
#define TL_DETECT_FRAMES_H

#include "base/lanes.h"
#include "detect/facing.h"

/* One facet in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_facet *facet[TL_LANES]; /* NULL: none */
    tl_lanes9 to;              /* from the frame of its points ... */
    tl_lanes3 from;            /* ... and that frame's origin */
    tl_lanes3 n, mean, lean, plane;
    double mean2[TL_LANES], l2[TL_LANES], offset[TL_LANES]; /* tl_facing */
    tl_lanes3 last, last_lean;                              /* of the facet */
    /* the motion of B against A in the last step at an arm from A's centroid: way + m arm; the mean spin of
     * both, as axis times the tangent of half its angle */
    tl_lanes3 way, half;
    tl_lanes9 m;
    double carry[TL_LANES]; /* half; 0 for points placed after that motion */
    /* flush patches: how their common plane turns (tl_turn_into) */
    tl_lanes3 turn;
    double scale[TL_LANES], turns[TL_LANES];
    uint32_t end[TL_LANES]; /* slot behind its points */
} tl_frames;

/* The way of a body against another, at their centroids, in the last step. */
static inline tl_vec3 tl_way_between(const tl_model *m, uint32_t from, uint32_t body)
{
    return tl_v3_scale(m->dt, tl_v3_sub(m->bodies.v_moved[body], m->bodies.v_moved[from]));
}

/* Puts a facet of a contact into lane l. */
void tl_frames_put(tl_frames *f, size_t l, const tl_model *m, uint32_t contact,
                   const tl_facet *facet);

/* A patch for each lane: its row, its bodies' turns and rotations, and how far these are apart. */
typedef struct tl_patch_rows {
    const double *a[TL_LANES], *b[TL_LANES], *ra[TL_LANES], *rb[TL_LANES], *facet[TL_LANES];
    tl_lanes3 d, way; /* of B against A in the last step */
} tl_patch_rows;

/* Brings a patch in each lane into its present place; false when none is or was tilted. */
bool tl_frames_put_patches(tl_frames *f, const tl_patch_rows *rows);

#endif
