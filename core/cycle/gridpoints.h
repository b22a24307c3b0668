/* gridpoints.h - gridpoints of zones in a step: their forces, motion and rest. */
#ifndef TL_CYCLE_GRIDPOINTS_H
#define TL_CYCLE_GRIDPOINTS_H

#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* Contributors: zones act on gridpoints, and segments on these and on bodies. */
extern const tl_contributor tl_zones_act, tl_segments_act;

/* The longest stable step by the zones, squared and over 4, s2; INFINITY: there are none that may move. With mass
 * scaling the shortest that no gridpoint needs more mass for. */
double tl_gridpoints_least(tl_model *m);
/* Each gridpoint adds what its zones do, its weight and its load; to the sums of this step. */
void tl_gridpoints_gather(tl_model *m);
/* The damping plugin, on gridpoints. */
void tl_gridpoints_damp(tl_model *m, double dt, double *const *state);
/* In a relaxation: takes velocities back by alpha, 1/s. */
void tl_gridpoints_brake(tl_model *m, double alpha);
/* Refuses a step of dt that would turn a zone inside out. */
tl_status tl_gridpoints_check(tl_model *m, double dt);
/* Velocities and places one step on. */
void tl_gridpoints_move(tl_model *m, double dt);
/* The first body with a mesh that moves by more than a ratio allows at rest, or TL_NO_ROW. */
uint32_t tl_gridpoints_moving(const tl_model *m, double ratio);

#endif
