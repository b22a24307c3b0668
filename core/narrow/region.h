/* region.h - which faces of two blocks bound what they have in common, and along which face they overlap the least. */
#ifndef TL_NARROW_REGION_H
#define TL_NARROW_REGION_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* Faces of two blocks near what they have in common. Among the listed faces of a part are planes of faces of other
 * parts, whose numbers begin with its face_count (seam.c). */
typedef struct tl_region {
    /* the listed faces of A, of B, the borders of A and of B: faces on other parts, the seams behind the others */
    uint32_t a, b, border_a, border_b;
    const uint16_t *face; /* their numbers, one after the other; in the thread's scratch */
    tl_field_mesh *mesh;  /* what is known of the field at another place; NULL: nobody keeps it */
    tl_field_mesh *flat;  /* the same of the patch of its flush faces, in their order in that; NULL as well */
    /* the face along whose normal the blocks are farthest apart, or overlap the least: min over B - max over A */
    double gap;
    tl_vec3 n;               /* its normal, A to B, in A's frame */
    double gap_with_borders; /* the same with the faces on seams: what the parts have in common is no thicker */
    /* two nearly antiparallel faces along which they overlap the least; 0 and 0 when `flush` is false */
    bool flush;
    uint16_t flush_a, flush_b;
    /* how many listed faces of A, and of B, have nearly their direction: the first ones, them among these */
    uint32_t blunt_a, blunt_b;
    double flush_gap;
    double flush_lead; /* by how much all other pairs that face each other overlap more */
    double blunt_lead; /* the same of those among the first */
} tl_region;

/* Fills the region of a pair that has been placed. Faces that stay away from the other block while the pair moves by
 * `margin` are not listed. With a border all real faces are that may be the nearest to some point. false: out of
 * memory. */
bool tl_region_find(const tl_pair_view *view, double margin, tl_narrow_scratch *scratch, tl_region *region);
/* How low each block lies over the planes of the other, in the thread's scratch until another pair is looked at. */
typedef struct tl_region_lows {
    const double *b_over_a, *a_over_b; /* by the plane's number, m */
    double gap;                        /* of the region */
    tl_vec3 n;
} tl_region_lows;

/* The gap of the region of a pair that has been placed, alone: it takes a fifth of the time. false: out of memory. */
bool tl_region_gap(const tl_pair_view *view, tl_narrow_scratch *scratch, tl_region_lows *out);
/* Chooses the flush faces of a region anew, when the pair has moved. */
void tl_region_choose_flush(const tl_pair_view *view, tl_region *region);
/* Whether the faces marked in `bounding` are all that bound the common volume. The corners of one block that lie in
 * the other tell it. The pair has moved by less than its margin. */
bool tl_region_corners_agree(const tl_pair_view *view, const tl_region *region);
/* Sine of the angle between two faces, one of A and one of B. */
double tl_region_tilt(const tl_pair_view *view, uint32_t face_a, uint32_t face_b);

#endif
