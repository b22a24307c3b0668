/* frames.h - what is the same for all points of a facet, a facet in each lane: where it is, and how it moves. */
#ifndef TL_FORCE_FRAMES_H
#define TL_FORCE_FRAMES_H

#include "base/lanes.h"
#include "model/model.h"
#include "narrow/facet.h"

/* One facet in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_facet *facet[TL_LANES]; /* NULL: none */
    tl_lanes9 to;              /* from the frame of its points ... */
    tl_lanes3 from;            /* ... and that frame's origin */
    tl_lanes3 n, mean, lean, plane;
    double mean2[TL_LANES], l2[TL_LANES], offset[TL_LANES]; /* tl_facing */
    /* the motion of B against A in the last step at an arm from A's centroid: way + m arm; the mean spin of
     * both, as axis times the tangent of half its angle */
    tl_lanes3 way, half;
    tl_lanes9 m;
    /* how shear forces turn: with the bisector, and where the facet is flush and was, into the common plane */
    tl_lanes9 turn;
    /* Of tilted facets: mean x lean; the mean, the lean and their product before, turned so; squares of the first two. */
    tl_lanes3 across, was, was_lean, was_across;
    double was2[TL_LANES], was_l2[TL_LANES];
    double tilted[TL_LANES]; /* 1 where the facet is or was, else 0 */
    /* Half, by which points go along with the motion, and 0 for those placed after it; the same over l2. */
    double carry[TL_LANES], slide[TL_LANES];
    uint32_t end[TL_LANES]; /* slot behind its points */
} tl_frames;

/* Puts a facet of a contact into lane l. */
void tl_frames_put(tl_frames *f, size_t l, const tl_model *m, uint32_t contact,
                   const tl_facet *facet, double carry);

/* The bodies of a contact for each lane. */
typedef struct tl_body_rows {
    const double *a[TL_LANES], *b[TL_LANES]; /* tl_pose */
    double dt;                               /* of the last step */
} tl_body_rows;

/* A patch for each lane. */
typedef struct tl_patch_rows {
    tl_body_rows bodies;
    const double *facet[TL_LANES];
    double carry[TL_LANES]; /* of points of tilted facets: see tl_frames */
} tl_patch_rows;

/* Brings a patch in each lane into its present place; false when none is or was tilted. */
bool tl_frames_put_patches(tl_frames *f, const tl_patch_rows *rows);

/* A facet of any kind for each lane. */
typedef struct tl_facet_rows {
    tl_lanes9 ra, rb; /* of the bodies */
    tl_lanes3 d;
    const double *facet[TL_LANES];
    double carry[TL_LANES]; /* see tl_frames */
    double kind[TL_LANES];  /* tl_facet_kind */
    tl_lanes3 swing;
    /* edges: where they begin, in the frames of their bodies, and from there to their ends; what follows */
    tl_lanes3 from_a, along_a, from_b, along_b, edge_n;
    double edge_offset[TL_LANES];
    bool new_edges; /* of which that has not been worked out */
} tl_facet_rows;

/* Brings the bodies of a rank into its lanes, which have no facets yet. */
void tl_frames_put_bodies(tl_frames *f, tl_facet_rows *facets, const tl_body_rows *bodies);
/* Brings the facets into their present place. */
void tl_frames_put_facets(tl_frames *f, tl_facet_rows *rows);
/* The couples on B per energy, model's axes, of points of these slots, from the turns of A and the facets' swings. */
void tl_frames_put_couples(double *const couple[3], size_t begin, size_t end, const tl_lanes9 *ra,
                           const tl_lanes3 *swing);

#endif
