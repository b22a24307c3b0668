/* facet.h - facets and contact points, as the geometry of a pair gives them. */
#ifndef TL_NARROW_FACET_H
#define TL_NARROW_FACET_H

#include "geometry/polyhedron.h"

#include <talus/vmath.h>

/* Half the sine of the tilt of two faces up to which all points of their patch have the bisector for their
 * normal: a share of the force that no result shows. */
#define TL_FLUSH 1e-5

typedef enum tl_facet_kind {
    TL_FACET_PATCH,  /* face on face */
    TL_FACET_FACE_A, /* vertices of B on a face of A */
    TL_FACET_FACE_B, /* vertices of A on a face of B */
    TL_FACET_EDGES   /* an edge of A across an edge of B */
} tl_facet_kind;

/* Largest couple per energy that is told apart, 1/rad. */
#define TL_MOST_SWING 1e30

/* Contact points that share a normal and a way to compute their gaps. Planes are kept here, for most facets
 * have them and every step asks; edges are looked up in the shapes. A step reads the doubles as one row. */
typedef struct tl_facet {
    tl_vec3 na, nb; /* outward normals of the faces, own frames; edges: na is n when made */
    double offset;  /* of the face, or the sum of those of both faces, own frames */
    tl_vec3 last,
        last_lean;  /* normal when last followed, and how points' normals differ, model's axes */
    float swing[3]; /* couple on B per energy stored in its points, A's frame, 1/rad */
    uint8_t kind;
    uint16_t ia, ib;       /* faces, or edges */
    uint16_t begin, count; /* of its points, within the contact */
} tl_facet;

static inline tl_vec3 tl_facet_swing(const tl_facet *f)
{
    return tl_v3(f->swing[0], f->swing[1], f->swing[2]);
}

static inline void tl_facet_set_swing(tl_facet *f, tl_vec3 swing)
{
    const double value[] = {swing.x, swing.y, swing.z};
    /* the energy it belongs to is next to nothing where it is beyond a float */
    for (int k = 0; k < 3; k++)
        f->swing[k] = (float)fmin(fmax(value[k], -TL_MOST_SWING), TL_MOST_SWING);
}

/* Doubles at the head of a facet that a step reads; even, for it reads them in pairs. */
#define TL_FACET_ROW 14

/* How the normal of a point of a patch differs from the mean of its faces' normals. With M = (nA - nB)/2, L = (nA +
 * nB)/2, which is perpendicular to it, it lies along M + face L + edge M x L. `face` is -1 for a vertex of A, which
 * stands on B's face, 1 for one of B; `edge` is not 0 where two edges cross. */
typedef struct tl_lean {
    float face, edge;
} tl_lean;

/* A contact point as the geometry gives it. `p` is fixed to A for patches, faces of B and edges, and
 * to B for faces of A. Patches: `lean` tells along which normal the gap opens. */
typedef struct tl_contact_point {
    tl_vec3 p;
    tl_lean lean;
    double area;
    uint32_t key;  /* of the features that made it */
    tl_vec3 swing; /* as a facet's: what its own area adds to it */
} tl_contact_point;

/* The contact points of one pair, as one geometric evaluation finds them. */
typedef struct tl_manifold {
    tl_facet *facets;
    tl_contact_point *points;
    size_t facet_count, facet_room, point_count, point_room;
    double patch_area;
    bool lone;   /* no faces look at each other but one of each, nor will they soon */
    bool brief;  /* some areas depend on a gap: they hold for a part of the motion others do */
    bool failed; /* out of memory */
} tl_manifold;

/* The contact points of one patch, as columns: see tl_contact_point. */
typedef struct tl_patch_points {
    double *p[3], *area;
    tl_lean *lean;
    uint32_t *key;
    size_t count, room;
} tl_patch_points;

#endif
