/* solids.h - from the faces of a file to closed solids with plane faces, and to blocks.
 *
 * An object is welded, closed, turned outward and divided into its shells (weld.c, between.c). Faces of a shell in
 * one plane become one side (sides.c). Sides of two solids at one place get one plane (shared.c). Vertices are moved
 * into the planes of their sides (plane.c). Then each solid becomes a block (create.c). Refused ones are listed
 * (report.c). */
#ifndef IMPORT_SOLID_SOLIDS_H
#define IMPORT_SOLID_SOLIDS_H

#include "soup.h"

#include <talus/vmath.h>

typedef struct plane {
    tl_vec3 normal; /* outward, of unit length */
    double offset;  /* normal . x on the plane */
    uint32_t group; /* sides that share a plane name one of them, their own where they share none */
} plane;

/* A closed surface. Its vertices, faces and planes are those from its first ones to those of the next solid. */
typedef struct solid {
    uint32_t object, shell; /* shell of the object, from 0 */
    uint32_t vertex, face, plane;
    bool reflex; /* it bends inward at an edge, with these ends */
    tl_vec3 reflex_at[2];
    double move;                 /* farthest that a vertex was moved to make faces plane */
    double off;                  /* by how much a corner misses its plane after that */
    uint32_t made_plane, shared; /* sides */
    uint32_t parts;              /* convex blocks of it */
    bool refused;
} solid;

/* What was done to an object. */
typedef struct done {
    uint32_t welded, collapsed, between, turned, merged, shells;
    bool inside_out;
} done;

typedef struct refusal {
    uint32_t object;
    char *reason;
    double needs; /* the least `flat` that would take it; 0: none would */
} refusal;

typedef struct solids {
    const tl_host *host;
    soup soup;
    double weld, flat;
    const char *weld_from, *flat_from; /* where these are from */
    bool split, skip;
    double density;
    const char *group;
    tl_vec3 *vertex;
    size_t vertices, vertex_capacity;
    uint32_t *corner; /* of the faces: indices from the solid's first vertex */
    size_t corners, corner_capacity;
    uint32_t *start, *side; /* of a face: its first corner; its plane, from the solid's first one */
    size_t faces, start_capacity, side_capacity;
    plane *plane;
    size_t planes, plane_capacity;
    solid *solid;
    size_t solids, solid_capacity;
    done *done; /* [objects] */
    refusal *refusal;
    size_t refusals, refusal_capacity;
    size_t made_plane, shared; /* sides */
    double largest_move;
    uint32_t moved_most; /* solid */
} solids;

/* The last of a solid's vertices, faces and planes, plus one. */
uint32_t solid_vertices(const solids *s, size_t i);
uint32_t solid_faces(const solids *s, size_t i);
uint32_t solid_planes(const solids *s, size_t i);

/* ---------------------------------------------------------------- weld.c ----------------- */

/* A face of an object: a run of half-edges. */
typedef struct shell_face {
    uint32_t first, count; /* half-edges */
    uint32_t shell, side;
    uint32_t part; /* faces of one part close a surface by the file's numbers of their vertices; 0: those of none */
    tl_vec3 area;  /* twice the vector area */
    double longest;
} shell_face;

/* The object at hand, with its own vertices. Half-edge h runs from corner[h] to that of mesh_next. */
typedef struct mesh {
    tl_vec3 *vertex;
    size_t vertices;
    uint32_t *corner, *face_of, *mate;
    size_t corners;
    shell_face *face;
    size_t faces, shells;
    /* scratch, and room */
    uint32_t *local; /* [vertices of the soup] */
    uint32_t *cell, *next, *root;
    uint32_t *part; /* [faces of the object in the soup] */
    void *sides;
    size_t vertex_room, corner_room, face_room, cell_room;
} mesh;

uint32_t mesh_next(const mesh *m, uint32_t h);
void mesh_free(mesh *m);
/* Welds and closes an object into m, or refuses it: *taken is false then. */
tl_status mesh_close(solids *s, uint32_t object, mesh *m, bool *taken);

/* Makes room for so many corners. */
bool mesh_room(mesh *m, size_t corners);

/* Makes vertices that lie within `weld` of edges of one face corners of it (between.c). `open` has such edges'
 * half-edges, in their order. Tells how many corners it has made; false for want of memory. */
bool mesh_take_between(mesh *m, const uint32_t *open, size_t count, double weld, uint32_t *takes);

/* Adds the shells of the closed object as solids (sides.c). */
tl_status sides_add(solids *s, uint32_t object, mesh *m);

/* ---------------------------------------------------------------- plane.c ---------------- */

/* Sums over points, about the first of them. */
typedef struct cloud {
    tl_vec3 zero, sum;
    double count, xx, yy, zz, xy, yz, zx;
} cloud;

void cloud_add(cloud *c, tl_vec3 at);
void cloud_join(cloud *c, const cloud *other);
/* The plane of least squares, with its normal to the side of `toward`. */
plane cloud_plane(const cloud *c, tl_vec3 toward);
/* Distance of a point above a plane. */
double plane_above(const plane *p, tl_vec3 at);
/* Moves vertices into the planes of their sides. */
tl_status planes_make(solids *s);

/* ---------------------------------------------------------------- shared.c, create.c ----- */

/* Gives one plane to sides of two solids at one place. */
tl_status shared_find(solids *s);
tl_status blocks_create(solids *s);

/* ---------------------------------------------------------------- report.c --------------- */

/* The name of an object: 'stone_17', or its number; 'stone_17 (2)' where that comes again; of one of several shells
 * with its number. */
#define NAME_TEXT 100
const char *object_name(const solids *s, uint32_t object, uint32_t shell, char *text);
/* Lists a refused object, of which the text goes on behind its name. */
TL_PRINTF(4, 5) tl_status refuse_object(solids *s, uint32_t object, double needs, const char *format, ...);
/* Fails with the first reasons where objects were refused and are not to be left out. */
tl_status refusals_check(const solids *s);
/* Notes what was done to each object, and says it in a line. */
tl_status report_write(solids *s, size_t blocks);

#endif
