/* manifold.h - what touches: a patch of two flush faces, a field contact, or nothing. */
#ifndef TL_NARROW_MANIFOLD_H
#define TL_NARROW_MANIFOLD_H

#include "narrow/press.h"

/* What is known of the contact of a pair before it is looked at. */
typedef struct tl_manifold_before {
    bool holds;       /* bonds hold its faces: they stay a patch, up to the tilt `most_tilt` */
    double most_tilt; /* as a sine */
    double born_tilt; /* the same of a part of a patch that bore a force; 0: it is none */
    bool calm;        /* a field contact that hardly moves: only that becomes a patch */
    tl_facet_kind kind;
    tl_face_pair faces; /* of a patch */
    double over;        /* gap across which its faces press, m; INFINITY where they hold */
    double reach;       /* gap of the blocks across which faces that are moved may press, m */
    double shift;       /* see tl_press_query */
    tl_face_pair shifted;
    bool leans; /* they do, so */
    tl_plane lean[2];
    double opened;
} tl_manifold_before;

/* Cost only: way that a list of faces holds for, over the size. */
#define TL_LIST_MARGIN 0.01

/* Facet and points of a pair that has been placed, into scratch->manifold. The region was found with a margin of
 * TL_LIST_MARGIN times the size. false: out of memory. */
bool tl_manifold_find(const tl_pair_view *view, const tl_region *region, const tl_touch_rule *rule,
                      const tl_manifold_before *before, tl_narrow_scratch *scratch);
/* What the press of a field contact is found for. */
tl_press_query tl_manifold_query(const tl_pair_view *view, const tl_region *region, const tl_touch_rule *rule,
                                 const tl_manifold_before *before);
/* A field contact of a press, and of two flush faces, into scratch->manifold. false: out of memory. */
bool tl_manifold_press(const tl_press *press, const tl_press_extra *extra, tl_face_pair faces,
                       tl_narrow_scratch *scratch);
/* The faces that touch along a direction from A to B, and the joint of these. */
tl_face_pair tl_touching_faces(const tl_pair_view *view, tl_vec3 n);
tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n);

#endif
