/* facet.h - facets and contact points, as the geometry of a pair gives them. */
#ifndef TL_NARROW_FACET_H
#define TL_NARROW_FACET_H

#include "narrow/view.h"

typedef enum tl_facet_kind {
    TL_FACET_PATCH, /* face on face */
    TL_FACET_FIELD, /* all else: the points are at the centre of the pressure */
    TL_FACET_KINDS
} tl_facet_kind;

/* What the contact points of a contact have in common: their normal, and the way to compute their gaps and places. A
 * step reads the doubles as one row. */
typedef struct tl_facet {
    tl_vec3 na, nb; /* outward normals of the faces, own frames; of a field its normal in A's */
    double offset;  /* sum of those of both faces, own frames; of a field its overlap */
    tl_vec3 last;   /* normal when last followed, model's axes */
    /* of a patch: the share of B's motion against A that its points go along with. It is 0 where its edges are A's, 1
     * where they are B's. And where B was in A's frame when its points were laid */
    double ride;
    tl_pair_pose laid;
    uint32_t kind;
    uint16_t ia, ib; /* faces */
} tl_facet;

static inline bool tl_facet_is_patch(const tl_facet *facet)
{
    return facet->kind == TL_FACET_PATCH;
}

static inline bool tl_facet_is_field(const tl_facet *facet)
{
    return facet->kind == TL_FACET_FIELD;
}

/* The points of a field contact, both at the centre of its pressure. The first carries the force and the shear, the
 * second the torsion. */
enum { TL_FIELD_SHEAR, TL_FIELD_TORSION, TL_FIELD_POINTS };

/* Doubles at the head of a facet that a step reads; even, for it reads them in pairs. */
#define TL_FACET_ROW 24
/* The same of a field contact. */
#define TL_FIELD_ROW 10

/* A contact point as the geometry gives it, in A's frame. */
typedef struct tl_contact_point {
    tl_vec3 p;
    double area;
    uint32_t key; /* of the features that made it */
} tl_contact_point;

/* The contact points of one patch, as columns: see tl_contact_point. */
typedef struct tl_patch_points {
    double *p[3], *area;
    uint32_t *key;
    size_t count, capacity;
    double gap;  /* the smallest, at a corner */
    double ride; /* see tl_facet */
} tl_patch_points;

#endif
