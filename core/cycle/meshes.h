/* meshes.h - the mesh of a deformable body as a whole. */
#ifndef TL_CYCLE_MESHES_H
#define TL_CYCLE_MESHES_H

#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* What acts on a mesh, and how it moves. */
typedef struct tl_mesh_whole {
    tl_vec3 force;    /* sum of the unbalanced forces, N */
    tl_vec3 moment;   /* of these about the centroid, N m */
    tl_vec3 velocity; /* mean by mass, m/s */
    tl_vec3 turn;     /* of the momentum about the centroid, rad/s */
    double borne;     /* sum of the sizes of what contacts, and what holds gridpoints, do to it, N */
    double weight;    /* with its loads, N */
    double power;     /* of the unbalanced forces, W */
    double speed;     /* root of the mean square by mass, m/s */
} tl_mesh_whole;

tl_mesh_whole tl_mesh_whole_of(const tl_model *m, const tl_body_mesh *mesh);
/* The mesh of a body; NULL: it is rigid. */
const tl_body_mesh *tl_mesh_of_body(const tl_model *m, uint32_t body);
/* Whether a body can move: a rigid one by itself, a deformable one by some gridpoint. */
bool tl_body_is_free(const tl_model *m, uint32_t body);
/* Speed of a body that is free, m/s: of its centroid, or the root of the mean square of its gridpoints'. */
double tl_body_speed(const tl_model *m, uint32_t body);
/* In a relaxation: finds how meshes move (settle.c). */
void tl_meshes_judge(tl_model *m);
/* The first body with a mesh whose kinetic energy is not below that share of what it stores, or TL_NO_ROW. */
uint32_t tl_mesh_moving(const tl_model *m, double share);
/* Share of the zones of a mesh that yield now. */
double tl_mesh_yielding(const tl_model *m, const tl_body_mesh *mesh);
/* How far a gridpoint has moved against its body, which turns and moves as a whole, m. */
tl_vec3 tl_gridpoint_strained(const tl_model *m, const tl_body_mesh *mesh, size_t row);

#endif
