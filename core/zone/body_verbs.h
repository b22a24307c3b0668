/* body_verbs.h - what verbs on blocks do to the gridpoints of deformable bodies. */
#ifndef TL_ZONE_BODY_VERBS_H
#define TL_ZONE_BODY_VERBS_H

#include "model/deformable.h"
#include "zone/zones.h"

extern const tl_zone_verbs tl_zone_body_verbs;

/* The mean velocity of a mesh, by mass, m/s. */
tl_vec3 tl_mesh_velocity(const tl_model *m, uint32_t mesh);
/* Adds the forces with which what holds the gridpoints of a mesh acts on them, N: a sum over all. */
void tl_mesh_reaction(const tl_model *m, uint32_t mesh, tl_vec3 *force);

#endif
