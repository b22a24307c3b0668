/* gridpoints.h - gridpoints of zones in a step: their forces, motion and rest. */
#ifndef TL_CYCLE_GRIDPOINTS_H
#define TL_CYCLE_GRIDPOINTS_H

#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* The longest stable step by the zones, squared and over 4, s2; INFINITY: there are none that may move. With mass
 * scaling the shortest that no gridpoint needs more mass for. */
double tl_gridpoints_least(tl_model *m);
/* Each gridpoint adds what its zones do, its weight and its load; to the sums of this step. */
void tl_gridpoints_gather(tl_model *m);
/* In a relaxation, with a kick of that span, s: velocities are lost, by `lost`, 1/s, where all stop. Else meshes lose
 * those beside their motion as a whole, each when its forces work against them. */
void tl_gridpoints_brake(tl_model *m, bool stop, double lost, double kick);
/* Velocities of components that are free end. Their last motion strains zones all the same. */
void tl_gridpoints_stop(tl_model *m);
/* The velocity with which a gridpoint goes through the next step, of dt. */
tl_vec3 tl_gridpoint_to_come(const tl_model *m, size_t row, double dt);
/* Velocities and places one step on. */
void tl_gridpoints_move(tl_model *m, double dt);

#endif
