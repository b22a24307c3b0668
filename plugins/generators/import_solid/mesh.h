/* mesh.h - the surface in a file: read (read.c), closed and divided into solids (mesh.c), and
 * checked solid by solid (solid.c). */
#ifndef IMPORT_SOLID_MESH_H
#define IMPORT_SOLID_MESH_H

#include <stdbool.h>
#include <talus/plugin.h>

/* Coordinates beyond this, in the units of the file, are taken for a fault of it. */
#define LARGEST_COORDINATE 1e30
/* Most corners of all faces together: indices have 32 bits. */
#define MOST_CORNERS 0x7fffffffu
#define NONE UINT32_MAX

/* What is found of a face. */
typedef struct mesh_face {
    tl_vec3 normal;
    double longest, height; /* longest edge; area over that */
    uint32_t solid;         /* number of its solid, from 0 in the order of first faces */
} mesh_face;

/* Faces are polygons, counter-clockwise from outside; the corners of face f are
 * corner[start[f]] .. corner[start[f + 1] - 1], indices into vertex. Half-edge h runs from corner[h] to the
 * next corner of its face. */
typedef struct mesh {
    const tl_host *host;
    const char *file;
    tl_vec3 *vertex;
    size_t vertices, vertex_capacity;
    uint32_t *corner;
    size_t corners, corner_capacity;
    uint32_t *start;
    size_t faces, face_capacity;
    double reach; /* largest coordinate */
    /* after mesh_close */
    uint32_t *face_of; /* [corners] */
    uint32_t *mate;    /* [corners] the half-edge that runs the other way on the solid's next face */
    mesh_face *face;   /* [faces] */
    size_t solids;
} mesh;

/* Refuses the file, with a sentence that goes on behind its name. */
#define MESH_FAULT(m, text, ...) (m)->host->fail((m)->host, TL_E_GEOMETRY, "file '%.200s'" text, (m)->file, __VA_ARGS__)

/* Adds a vertex; an unusable coordinate is refused with the place (a line or triangle) it stands at. */
tl_status mesh_add_vertex(mesh *m, tl_vec3 at, const char *place, size_t number);
/* Adds a face of `count` corners. */
tl_status mesh_add_face(mesh *m, const uint32_t *corner, size_t count);
tl_status mesh_no_memory(const mesh *m);
void mesh_free(mesh *m);

/* Reads m->file, an STL or OBJ as its name ends. */
tl_status mesh_read(mesh *m);

/* Makes one vertex of those at one place, pairs the half-edges and numbers the solids. Refuses faces
 * without area or not flat, open edges, and faces turned against their neighbours. */
tl_status mesh_close(mesh *m);
/* The half-edge after h in its face. */
uint32_t mesh_next(const mesh *m, uint32_t h);

/* Creates a block of each solid, scaled and then moved; refuses those that are turned inside out, hollow
 * of volume or not convex. */
tl_status solids_create(const mesh *m, double scale, tl_vec3 translate, double density, const char *group);

#endif
