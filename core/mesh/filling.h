/* filling.h - what readers of the formats of meshes fill in. */
#ifndef TL_MESH_FILLING_H
#define TL_MESH_FILLING_H

#include "mesh/mesh.h"
#include "mesh/text.h"

#include <math.h>

/* By which a region is known: numbers of its group, and of its entity or block. */
typedef struct tl_mesh_key {
    double group, part; /* -INFINITY: none is told */
} tl_mesh_key;
#define TL_MESH_NO_KEY ((tl_mesh_key){-INFINITY, -INFINITY})

/* A name that the file gives to a group. */
typedef struct tl_mesh_name {
    double group;
    char *text;
} tl_mesh_name;

typedef struct tl_mesh_reading {
    tl_mesh_text text;
    tl_mesh *mesh;
    tl_mesh_key *key; /* [zone_count] */
    size_t key_room;
    tl_mesh_name *name;
    size_t name_count, name_room;
} tl_mesh_reading;

/* Adds a tetrahedron of four points; TL_E_MEMORY. */
tl_status tl_mesh_add(tl_mesh_reading *reading, const uint32_t corner[4], uint32_t number, uint32_t line,
                      tl_mesh_key key);
/* Room for that many points. */
tl_status tl_mesh_hold_points(tl_mesh_reading *reading, size_t count);
/* Names a group, of `length` bytes. */
tl_status tl_mesh_name_group(tl_mesh_reading *reading, double group, const char *text, size_t length);

#endif
