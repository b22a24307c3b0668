/* zone_mesh.h - what is asked of the zones of a block, and what they are.
 *
 * A block is divided into tetrahedra, its zones. Their corners are points: first the corners of the block as it numbers
 * them, then points on its edges, on its faces, and inside. */
#ifndef TL_GEOMETRY_ZONE_MESH_H
#define TL_GEOMETRY_ZONE_MESH_H

#include "geometry/polyhedron.h"

/* The wanted edge of zones at a place, in the coordinates of the block's vertices. Positive. */
typedef double (*tl_zone_size_fn)(const void *user, tl_vec3 place);

/* Faces that are given in parts: those of a block that is joined to others (joined_faces.c). The parts of a face lie in
 * one plane, and zones end at the edges between them. */
typedef struct tl_zone_parts {
    uint32_t corner_count;   /* of the polyhedron's vertices, those that are corners of the block: they come first */
    const uint32_t *face_of; /* [faces of the polyhedron] the face of the block that each is a part of, ascending */
    double shortest;         /* edge of all the joined blocks: their weights are alike */
} tl_zone_parts;

typedef struct tl_shape_zoning {
    double edge;          /* the wanted edge h of zones; larger than the block: corners and centroid alone */
    tl_zone_size_fn size; /* or a function of place. NULL: `edge` everywhere */
    const void *user;     /* of it */
    /* [vertex_count] Numbers by which choices go among corners that lengths and angles do not tell apart; NULL: those
     * of the block. Another block with the same polygon gets the same triangles when the keys of the polygon's corners
     * are in the same order. Every key is there once. */
    const uint64_t *corner_key;
    /* [faces of the block] Not 0: points on the face may be moved by the repair, for no other zones lie on it. NULL:
     * none. */
    const uint8_t *face_free;
    const tl_zone_parts *parts; /* NULL: no face is given in parts */
} tl_shape_zoning;

static inline double tl_zoning_size(const tl_shape_zoning *z, tl_vec3 place)
{
    return z->size ? z->size(z->user, place) : z->edge;
}

/* No face: the triangle is that of a joined block as well. */
#define TL_ZONE_BETWEEN UINT32_MAX

/* A triangle of the surface, counter-clockwise from outside, and the face of the block that it lies in. */
typedef struct tl_zone_triangle {
    uint32_t corner[3];
    uint32_t face;
} tl_zone_triangle;

typedef struct tl_zone_mesh {
    uint32_t point_count, zone_count, triangle_count;
    /* Points before these numbers are the block's corners, on its edges, on its faces. The rest are inside. */
    uint32_t corner_end, edge_end, face_end;
    tl_vec3 *point;             /* [point_count] in the coordinates of the block's vertices */
    uint32_t (*zone)[4];        /* [zone_count] (b - a) . ((c - a) x (d - a)) > 0 */
    uint32_t (*beside)[4];      /* [zone_count] the zone opposite each corner; UINT32_MAX: none */
    tl_zone_triangle *triangle; /* [triangle_count] by face */
    double volume;
    double least_altitude; /* the smallest of all zones, over their largest triangles */
    double least_share;    /* the smallest altitude over the wanted edge there */
    uint32_t worst;        /* the zone that has it */
} tl_zone_mesh;

#endif
