/* field_sums.h - the planes of two blocks that a pressure field is integrated between (field.h), and what is
 * integrated. */
#ifndef TL_NARROW_FIELD_SUMS_H
#define TL_NARROW_FIELD_SUMS_H

#include <talus/plugin.h>

/* Faces of which it can be kept that they bounded K. */
#define TL_FIELD_KNOWN 64

/* Corners, polygons and their sides that a mesh has room for; corners of one block in the other. */
#define TL_MESH_CORNERS 64
#define TL_MESH_POLYGONS 48
#define TL_MESH_SIDES 192
#define TL_MESH_INNER 8
#define TL_MESH_VERTICES 24
/* The number of d = 0 among planes. */
#define TL_MESH_ZERO TL_FIELD_KNOWN

/* Corners of one block that lie in the other: three faces each that meet there. */
typedef struct tl_mesh_inner {
    uint32_t count; /* TL_MESH_INNER + 1: more than there is room for */
    uint8_t face[TL_MESH_INNER][3];
} tl_mesh_inner;

/* Corners of one block in which more than three of the planes meet: a bit for each of these, and three that meet there
 * at the sharpest, the first one a face's if there is one. Others can meet in the same place. */
typedef struct tl_mesh_vertices {
    uint32_t count;
    uint64_t planes[TL_MESH_VERTICES];
    uint8_t three[TL_MESH_VERTICES][3];
} tl_mesh_vertices;

/* Faces that may pass by the point in which the others of a block meet: field.h. */
#define TL_APEX_STRAYS 2

/* The apex of some faces of a block: up to three of them hold it, and some pass by. */
typedef struct tl_apex_faces {
    bool known;
    uint8_t holds, strays, held[3], stray[TL_APEX_STRAYS];
} tl_apex_faces;

/* What is known of the field of two blocks at some place: the faces that bounded K, and its polygons. At a corner the
 * same d belongs to four planes, of which d = 0 may be one. field_mesh.c */
typedef struct tl_field_mesh {
    uint64_t bounding;         /* a bit for each face that bounded K; 0: not known */
    tl_vec3 origin;            /* a point near K, about which its faces are to be given */
    uint8_t corners, polygons; /* 0: not known */
    tl_apex_faces apex[2];     /* of A and of B */
    uint8_t plane[4][TL_MESH_CORNERS];
    uint8_t own[TL_MESH_POLYGONS][2]; /* the polygon's two planes */
    uint8_t sides[TL_MESH_POLYGONS];
    uint8_t loop[TL_MESH_SIDES]; /* its corners, one polygon after the other */
} tl_field_mesh;

/* Corners of a mesh with those that fill up the last lanes. */
static inline uint32_t tl_mesh_lanes(const tl_field_mesh *mesh)
{
    return (mesh->corners + TL_LANES - 1) / TL_LANES * TL_LANES;
}

/* How force and moment of a field change: by B's ways along the axes, and then by its turns about them through the
 * origin. */
typedef struct tl_field_slope {
    tl_vec3 force[6], moment[6];
    bool known;
} tl_field_slope;

/* Planes behind the last one that are read, whatever they are: for planes are read several at a time. */
enum { TL_FIELD_SPARE = 3 };

/* The planes that bound K, in this order: faces of A, faces of B, borders of A, borders of B. Others may be among
 * them. Of blocks that overlap a face may be left out that lies wholly outside one face of the other block. With a
 * border all faces are needed, for beyond it the nearest need not bound K. Of blocks that are apart the faces left may
 * still enclose something: the deepest point is then not in both blocks. */
typedef struct tl_field_faces {
    uint32_t a, b, border_a, border_b; /* how many of each */
    uint32_t seam_a, seam_b;           /* so many borders, the last of A's and of B's, are seams to other parts */
    double *n[3], *c;                  /* [all of them and TL_FIELD_SPARE] */
    /* What is known of another place; NULL: nobody keeps it. It is of use for up to TL_FIELD_KNOWN planes. The bits
     * must be of all faces that bounded K. They must be forgotten when a corner of one block lies in the other, and on
     * or beyond a face that is not among them. The function leaves what it finds here. */
    tl_field_mesh *mesh;
    const tl_mesh_inner *inner;       /* corners of one block in the other, for a new mesh; NULL: make none */
    const tl_mesh_vertices *vertices; /* for a new mesh with all polygons; NULL: no corner has more than three planes */
    bool seamed;           /* the nearest face need not bound K: there are borders, or faces of other parts */
    bool energy_only;      /* the volume is not wanted, nor found where it costs more */
    bool powers;           /* int d^2 dV and int d^3 dV are wanted, too */
    tl_field_slope *slope; /* to be found by the mesh, where there are no borders; NULL: not wanted */
} tl_field_faces;

static inline tl_vec3 tl_field_normal(const tl_field_faces *f, uint32_t face)
{
    return (tl_vec3){f->n[0][face], f->n[1][face], f->n[2][face]};
}

/* An integral over K, and minus its gradient, borders included. */
typedef struct tl_field_power {
    double whole;
    tl_vec3 force, moment;
} tl_field_power;

/* Powers of d beyond those of the volume and of the energy: d^2 and d^3. */
enum { TL_FIELD_POWERS = 2 };

/* Integrals over S and K, moments about the origin. Those marked * include the borders. */
typedef struct tl_field_sums {
    double energy, volume;       /* of K: G and its volume (see energy_only); m^4, m^3 */
    tl_vec3 force, moment;       /* * -dG: int d n dS, int d x cross n dS; on B; m^3, m^4 */
    tl_vec3 swept, swept_moment; /* * -dV of the volume of K: int n dS, int x cross n dS; m^2, m^3 */
    /* int d n dS over the seams: what passes from one part of a body to the next, and into `force` of both */
    tl_vec3 through, through_moment;
    tl_vec3 area;     /* int n dS; m^2 */
    double pressure;  /* int d dS; m^3 */
    tl_vec3 pressed;  /* int d x dS; m^4 */
    double extent;    /* int dS; m^2 */
    tl_vec3 first;    /* int x dS; m^3 */
    double second;    /* int x . x dS; m^4 */
    double stiffness; /* int 2 / |n_a - n_b| dS: times kn that against motion along n; m^2 */
    double deepest;   /* largest d on S; m */
    tl_vec3 deepest_at;
    /* int d^2 dV, m^5, and int d^3 dV, m^6, if wanted; with what passes through seams */
    tl_field_power powers[TL_FIELD_POWERS];
} tl_field_sums;

/* Tolerance: roundings of the largest offset within which two faces that look the same way are one plane. */
#define TL_FIELD_ONE_PLANE (16 * 2.220446049250313e-16)
/* Tolerance: length of n_a - n_b below which two faces look so much the same way that what is between them bears
 * nothing. It counts no more in the stiffness. */
#define TL_FIELD_SAME_WAY 0.5

#endif
