/* polyhedron.h - convex polyhedra.
 *
 * A polyhedron is closed and convex. Its faces are convex polygons given counter-clockwise from outside. Each has the
 * plane it was made with (never refitted) and the tag of the joint that made it (joint 0: none). But for seams it is
 * immutable once made and lives in one allocation.
 *
 * Lengths: `size` of a polyhedron is the diagonal of its bounds; tolerances are relative to it. */
#ifndef TL_GEOMETRY_POLYHEDRON_H
#define TL_GEOMETRY_POLYHEDRON_H

#include <stdbool.h>
#include <talus/types.h>

/* Tolerance: a face whose vertices are all closer to a plane than this times the size lies on it. A block small in its
 * model knows planes to fewer digits than its own vertices: this leaves it six orders. */
#define TL_POLY_ON 1e-9
/* Tolerance: a face bent by less than this times the size is one face: points are given by coordinates of six
 * digits. */
#define TL_POLY_FLAT 1e-6
/* Tolerance: the corners of a face miss its plane by less than this times its size: so far off are those of meshes. */
#define TL_POLY_BENT 2e-4
/* Tolerance: sine of 0.025 degrees, half of what flush faces may tilt. A facet of a face may tilt its plane by less, so
 * that two blocks lie flush on each other by such faces. */
#define TL_POLY_TILT 4.3633e-4
/* Limit: a cut that would leave a side thinner than this times the size is refused. */
#define TL_POLY_THIN 1e-5
/* Most vertices and most faces of one polyhedron. */
#define TL_POLY_MAX_VERTICES 4096
#define TL_POLY_MAX_FACES 4096

enum { TL_COVERED = 1, TL_SEAM };

/* Edge from vertex a to b in the loop of face `left`; in that of face `right` it runs from b to a. */
typedef struct tl_edge {
    uint16_t a, b, left, right;
} tl_edge;

typedef struct tl_poly {
    uint32_t vertex_count, face_count, edge_count;
    uint32_t plane_count; /* of the faces, and of outer faces of other parts (seam.c) */
    bool seams;           /* some face is covered */
    double size;          /* diagonal of the bounds */
    /* [plane_count] Outward unit normal and offset of the faces. Behind them are those of outer faces of other parts
     * that may be nearer to some point of this part than its own. All of the part lies behind them. */
    tl_plane *plane;
    tl_tag *tag;     /* [face_count] */
    uint16_t *start; /* [face_count + 1] into loop */
    tl_edge *edge;   /* [edge_count], a < b never assumed */
    uint16_t *loop;  /* [2 edge_count] vertex indices */
    /* [face_count] TL_COVERED: the face lies on other parts of its body (seam.c); TL_SEAM: as all do that it lies on.
     * Zeros that all single polyhedra share, or, where `seams`, an allocation of its own. */
    const uint8_t *covered;
    tl_vec3 vertex[]; /* [vertex_count] */
} tl_poly;

/* The place after place h in the loop of a face. */
static inline uint32_t tl_poly_after(const tl_poly *p, uint32_t face, uint32_t h)
{
    return h + 1 < p->start[face + 1] ? h + 1u : p->start[face];
}

static inline uint32_t tl_poly_face_size(const tl_poly *p, uint32_t face)
{
    return p->start[face + 1] - p->start[face];
}

#endif
