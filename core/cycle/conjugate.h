/* conjugate.h - leaps of many bodies: along ways that are conjugate to each other. */
#ifndef TL_CYCLE_CONJUGATE_H
#define TL_CYCLE_CONJUGATE_H

#include "cycle/cycle_data.h"

/* A body in such leaps: three of a way or force, three of a turn or moment, each. */
typedef struct tl_conjugate {
    tl_vec3 force, moment;          /* unbalanced, before the last leap */
    tl_vec3 way, turn;              /* along which it went */
    tl_vec3 way_force, turn_moment; /* by which that makes the unbalanced ones less */
    tl_vec3 move, spin;             /* that the force and moment left give the inertia */
} tl_conjugate;

/* Room for the present bodies; false: out of memory. */
bool tl_conjugate_prepare(tl_model *m);
/* The next leap is the first one: nothing is known of any way. */
void tl_conjugate_begin(tl_model *m);
/* Finds the motion of the next leap, in `motion` of the bodies. */
void tl_conjugate_find(tl_model *m, double dt);

#endif
