/* axis.h - the axis of a pair: the common plane's normal, exact (axis.c). */
#ifndef TL_NARROW_AXIS_H
#define TL_NARROW_AXIS_H

#include "narrow/narrow.h"
#include "narrow/view.h"

typedef enum tl_axis_kind { TL_AXIS_FACE_A, TL_AXIS_FACE_B, TL_AXIS_EDGES } tl_axis_kind;

/* The separating or least penetrating axis of a pair. */
typedef struct tl_axis {
    uint32_t kind;   /* tl_axis_kind */
    uint16_t ia, ib; /* face of A or of B, or edge of A and edge of B */
    tl_vec3 n;       /* unit, A to B, in A's frame */
    double s;        /* min over B - max over A of n . x: the gap, negative when overlapping */
    double second;   /* the next best axis's s; for an s of INFINITY how far the pair may run */
} tl_axis;

/* The features it belongs to: all that a contact keeps of its axis. */
typedef struct tl_axis_features {
    uint16_t kind, ia, ib;
} tl_axis_features;

static inline tl_axis_features tl_features_of(const tl_axis *axis)
{
    return (tl_axis_features){(uint16_t)axis->kind, axis->ia, axis->ib};
}

/* An axis of these features that has no place yet. */
static inline tl_axis tl_axis_of(tl_axis_features f)
{
    return (tl_axis){.kind = f.kind, .ia = f.ia, .ib = f.ib, .s = -INFINITY, .second = -INFINITY};
}

/* Fills vertex_b and normal_b of the view. */
bool tl_pair_place(tl_pair_view *view, tl_narrow *room);
/* Fills them for one face of B only. */
bool tl_pair_place_face(tl_pair_view *view, uint32_t face, tl_narrow *room);
/* The exact common plane's axis. That of the features of `previous` (or NULL) is preferred when nearly as good. s is
 * INFINITY where parts of joined bodies do not press on each other, whatever their walls do. */
tl_axis tl_axis_search(const tl_pair_view *view, tl_narrow *room, const tl_axis_features *previous);
/* How far a pair whose axis parts it may run before it is searched again. */
double tl_axis_wait(const tl_axis *axis, double size);
/* n and s of an axis's features in the present place, whether or not they still define it; false for edges that are
 * parallel. */
bool tl_axis_place(const tl_pair_view *view, tl_axis *axis);
/* The same; false when the features no longer define it. */
bool tl_axis_follow(const tl_pair_view *view, tl_axis *axis);
/* Unit direction perpendicular to both edges, within `outward`'s half-space; false when parallel. */
bool tl_edge_normal(tl_vec3 edge_a, tl_vec3 edge_b, tl_vec3 outward, tl_vec3 *n);

#endif
