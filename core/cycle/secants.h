/* secants.h - the stiffness of contacts as their last motions tell it, and the motion to equilibrium that follows. */
#ifndef TL_CYCLE_SECANTS_H
#define TL_CYCLE_SECANTS_H

#include "cycle/cycle_data.h"

/* A motion of B against A, and what changes of the force on B by it: three of a way or force, three of a turn or
 * moment about the contact's place. */
typedef struct tl_secant {
    int64_t born;              /* of the contact, */
    uint32_t a, b;             /* and its blocks: of another one nothing is known, */
    uint32_t kind;             /* nor of one whose points are of another kind */
    double root[6][6];         /* of the stiffness: K = root root^T */
    double force[6];           /* after the last step */
    double arm_a[3], arm_b[3]; /* from the bodies' centroids to the contact's place */
} tl_secant;

/* A contact in a leap. */
typedef struct tl_leap_link {
    uint32_t a, b; /* rows of bodies; of one that has no stiffness both are the same */
    tl_vec3 arm_a, arm_b;
    double k[6][TL_LANES]; /* rows of six, and zeros */
} tl_leap_link;

/* A body in a leap: a way and a turn, or a force and a moment, each. */
typedef struct tl_leap_body {
    double block[6][6]; /* its own part of the stiffness: the inverse of its Cholesky factor */
    double hold[6];     /* what is added to the diagonal of the stiffness */
    double motion[6], force[6], preconditioned[6], way[6], image[6];
} tl_leap_body;

/* Room for the present contacts and bodies; false: out of memory. */
bool tl_secants_prepare(tl_model *m);
/* Begins with the stiffness that the laws say, for all contacts. */
void tl_secants_begin(tl_model *m);
/* Takes in what the last step has shown. */
void tl_secants_follow(tl_model *m);
/* Finds the motion, in `motion` of the bodies, that brings equilibrium by the secants. `hold` times inertia over dt^2
 * is added to the stiffness. */
void tl_leap_find(tl_model *m, double dt, double hold);

#endif
