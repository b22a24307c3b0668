/* settling.h - how a relaxation goes: settle.c. */
#ifndef TL_CYCLE_SETTLING_H
#define TL_CYCLE_SETTLING_H

#include <stdint.h>
#include <talus/types.h>

typedef struct tl_settling {
    double share;      /* of gravity and loads that acts */
    int64_t part;      /* of those in which they come on, from 1, */
    int64_t parts;     /* how many these are, */
    int64_t came;      /* and after which step the last one did */
    int64_t stops;     /* steps left with kinetic stops only, before leaps are tried */
    int64_t stop_span; /* that there will be the next time */
    int64_t leaps;     /* left of those that are being made */
    int64_t leap_span; /* that there will be the next time */
    int64_t idle;      /* leaps in a row that brought the model no nearer to rest */
    double carried;    /* way of bodies in leaps over their radius, the largest of each */
    double hold;       /* of a leap: inertia over dt^2 times this is added to the stiffness */
    double momentum;   /* share of the motion of the last leap that the next one takes along */
    double length;     /* of the last leap of many bodies along its way, s2: conjugate.c; 0: there was none, */
    double made_up;    /* and along the way before */
    double power;      /* unbalanced forces at the beginning of the leap times its motion, J */
    double expected;   /* fall of the energy in it, J */
    double goal;       /* sum of unbalanced forces below which leaps have brought it nearer, N */
    int32_t leapt;     /* the last step was a leap, 1 or 0, */
    int32_t limited;   /* that was made shorter */
    int32_t calm;      /* the model as a whole is near rest: loose bodies go their own way */
    int32_t gained;    /* leaps of this spell have brought it nearer to rest */
} tl_settling;

/* How a body goes on from stop to stop, while some block is deformable. */
typedef struct tl_going {
    tl_vec3 from;          /* displacement at the last stop, m */
    tl_vec3 way;           /* gone from the stop before to it, m */
    double speed, fastest; /* before it, and before all stops of these ways, m/s */
    int32_t ways;          /* in a row in one direction */
    int32_t on;            /* went on where all others stopped, 1 or 0 */
} tl_going;

#endif
