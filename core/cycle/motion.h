/* motion.h - the law of motion. */
#ifndef TL_CYCLE_MOTION_H
#define TL_CYCLE_MOTION_H

#include "cycle/cycle_data.h"

/* Velocities, places and rotations one step on. */
void tl_move(tl_model *m, double dt);

#endif
