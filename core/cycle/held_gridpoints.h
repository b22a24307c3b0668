/* held_gridpoints.h - gridpoints that follow drives, are held along any direction, or are pushed at the surface. */
#ifndef TL_CYCLE_HELD_GRIDPOINTS_H
#define TL_CYCLE_HELD_GRIDPOINTS_H

#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* After drives have been evaluated: where one makes gridpoints jump, the next steps can be undone. */
void tl_gridpoints_expect(tl_model *m);
/* Gives the gridpoints that are driven their velocities for a step of dt. */
void tl_gridpoints_follow_drives(tl_model *m, double dt);

/* How a gridpoint was moved, as if nothing but axes held it and nothing resisted. */
typedef struct tl_point_moved {
    tl_vec3 v0;                       /* velocity before, m/s */
    double mass, alpha;               /* as the step moves it, kg; of the damping, 1/s */
    double kick, drift, until, after; /* s: of the step, and half of the one before and of this one */
} tl_point_moved;

/* Whether some gridpoint has to be mended. */
bool tl_gridpoints_mend(const tl_model *m);
/* Mends velocity and place of one, and books what pushes it at the surface, holds it along directions and resists. */
void tl_gridpoint_mend(const tl_model *m, size_t row, const tl_point_moved *by, size_t lane,
                       double book[TL_BOOK_COUNT][TL_LANES]);

#endif
