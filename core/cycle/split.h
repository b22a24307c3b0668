/* split.h - parts of a body that cuts have split since the last step go on as the whole does. */
#ifndef TL_CYCLE_SPLIT_H
#define TL_CYCLE_SPLIT_H

#include "cycle/cycle_data.h"
#include "force/bear.h"
#include "model/loads.h"
#include "model/model.h"

/* Before the gather; false: out of memory. */
bool tl_split_prepare(tl_model *m);
/* After the gather: gives the parts the forces that let them do so, and their new faces the tractions that bring these. */
tl_status tl_split_hold(tl_model *m, double dt);
/* Before the move: corrects the velocities of the parts for arms that turn. */
void tl_split_turn(tl_model *m);
/* The step is done. */
void tl_split_end(tl_model *m);
void tl_split_free(struct tl_cycle *c);

/* A body that is a part of one that was split. */
typedef struct tl_split_part {
    uint32_t body;
    uint32_t listed;   /* place before parts were put in the order of wholes */
    bool goes;         /* it goes on as the whole does */
    uint32_t whole;    /* first part of those that new contacts hold together */
    double mass, area; /* as forces meet it; of its new faces */
    double size;       /* radius */
    tl_mat3 inertia;   /* axes of the model */
    tl_vec3 place;
    tl_wrench outer;            /* forces that act on it but for those of the new faces */
    tl_wrench wanted;           /* what lets it go on as the whole */
    tl_vec3 turn_v, turn_w;     /* what is to be added to its velocities: see find_turn */
    tl_wrench way, step, image; /* of the solver: small motions, and their forces */
    tl_wrench lacks, preconditioned;
} tl_split_part;

/* A contact point between two parts: the motion of A against B makes a traction on B. */
typedef struct tl_split_point {
    uint32_t a, b; /* parts */
    double area;
    tl_vec3 arm_a, arm_b, n; /* from the parts' centroids; A to B */
    double normal, shear;    /* stiffness now, 0 or 1: of tractions that the law bears */
} tl_split_point;

typedef struct tl_split_contact {
    uint32_t row, a, b; /* row of the contact; parts */
    size_t first;       /* of its points */
} tl_split_contact;

/* Parts that new contacts hold together. start: tractions before; given: those asked for; borne: what the laws make of them. */
typedef struct tl_split_system {
    const tl_model *m;
    tl_split_part *parts;
    tl_split_contact *contacts;
    tl_split_point *points; /* `a` and `b` count from the system's first part */
    tl_traction *start, *given, *borne, *best;
    size_t part_count, contact_count, point_count;
    double stored; /* energy of the springs, J */
} tl_split_system;

/* Sets `borne` to what the laws bear of `given`, and what their springs hold; false: a law failed. */
/* Finds tractions that the laws bear and that bring what the parts lack, or come as near to it as they can; false: a law failed. */

#endif
