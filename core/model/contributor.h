/* contributor.h - what acts on the bodies in a step beside gravity and loads: their contacts, first of all.
 *
 * A step asks each contributor for the same things, phase by phase, in the order of the model's list. A new one is a
 * file with such a struct, and a line in the list of cycle/contributors.c. */
#ifndef TL_MODEL_CONTRIBUTOR_H
#define TL_MODEL_CONTRIBUTOR_H

#include "base/table.h"
#include "model/model.h"

/* What acts on a body: force, moment about its centroid, and the sum of the magnitudes of the forces. */
typedef struct tl_acting {
    tl_vec3 force, moment;
    double magnitude;
} tl_acting;

/* A sum, and its second moment about a body's centroid. */
typedef struct tl_spread {
    double sum, r2;
} tl_spread;

/* What holds a body. */
typedef struct tl_holding {
    tl_spread stiffness; /* N/m and N m */
    tl_spread undamped;  /* what of it the damping of contacts leaves alone */
    tl_spread damping;   /* N s/m and N m s */
    double law;          /* the stiffest joint law of its contacts, Pa/m; 0: none */
    bool presses;        /* something may be pressed in further as the body goes on */
} tl_holding;

/* Energy, J: held by springs and strains; turned to heat, and brought in from outside, in this step. */
typedef struct tl_energies {
    double stored, heat, given;
} tl_energies;

/* Tables of a contributor whose columns a step overwrites. */
#define TL_CONTRIBUTOR_TABLES 3

/* Functions that are NULL add nothing. Those of a body are called on any thread. */
typedef struct tl_contributor {
    const char *name; /* of its term in the ledger of energy, too: at most 15 bytes */
    /* Makes room for the step. Nothing has changed when it fails. */
    tl_status (*prepare)(tl_model *m);
    /* Finds the forces at the present places. When it fails the step is undone. */
    tl_status (*apply)(tl_model *m);
    /* Adds what acts on some bodies to on[0 .. end - begin). */
    void (*gather)(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on);
    /* Stiffness that holds a body where it is, N/m: forces and energies are compared with it at rest. */
    double (*stiffness)(const tl_model *m, uint32_t body);
    /* Adds what holds a body, for the time step. `points`: the stiffness is asked for as well. */
    void (*hold)(const tl_model *m, uint32_t body, bool points, tl_holding *sum);
    /* Likewise a bound of it that is found faster; NULL: it is no dearer to know. */
    void (*hold_most)(const tl_model *m, uint32_t body, tl_holding *sum);
    /* Highest speed at which something that holds a body is pressed in, over how far it is, 1/s. */
    double (*approach)(const tl_model *m, uint32_t body);
    /* Its energies with the forces that `apply` found: asked for once a step, after the bodies have moved. */
    tl_energies (*energies)(tl_model *m);
    /* The tables whose columns TL_COLUMN_STEP `apply` overwrites, and how many they are. They are kept whole before it
     * and put back after a failure, unless the contributor keeps rows of them itself (tl_undo_rows): then `put_back`
     * does that. */
    size_t (*tables)(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES]);
    void (*put_back)(tl_model *m);
    /* Whether `apply` may fail in any step. */
    bool (*may_fail)(const tl_model *m);
} tl_contributor;

/* The contributors of a model; NULL ends them. */
typedef const tl_contributor *const *tl_contributors;

/* Most contributors of a model. */
#define TL_MOST_CONTRIBUTORS 5

#endif
