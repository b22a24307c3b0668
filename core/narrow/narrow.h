/* narrow.h - what the geometry of a pair works in, and the rule of the point share. */
#ifndef TL_NARROW_NARROW_H
#define TL_NARROW_NARROW_H

#include "narrow/facet.h"

/* Per-thread room for the narrow phase. */
typedef struct tl_narrow {
    tl_vec3 *vertex_b, *normal_b;
    double *dots;
    struct tl_share_point *share; /* share_points.h */
    size_t vertex_room, normal_room, dot_room, share_room;
    struct tl_polygon *polygon; /* patch.c */
    tl_patch_points patch;
    tl_manifold manifold;
    bool failed;              /* out of memory, in a phase that cannot say so */
    bool reframed;            /* the places of old points are in frames that are no more */
    bool deep;                /* met a contact whose blocks overlap too deeply: overlap.c */
    struct tl_old_point *old; /* transfer.c */
    double *value;
    size_t old_room;
} tl_narrow;

/* How the point share of a pair is measured. */
typedef struct tl_share_rule {
    double minimum;     /* area, m2 */
    bool unconditional; /* also for edges of parallel faces */
    bool corners;       /* points of patches at corners only */
    double reach;       /* patches with every gap beyond this are left out */
} tl_share_rule;

#endif
