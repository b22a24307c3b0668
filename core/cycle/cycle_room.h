/* cycle_room.h - the phases of a step, and what they keep between them. cycle.c puts them in order. */
#ifndef TL_CYCLE_CYCLE_ROOM_H
#define TL_CYCLE_CYCLE_ROOM_H

#include "detect/detect.h"

#include <pthread.h>

/* Rows a worker takes at a time. */
#define TL_BODY_CHUNK 256

/* Sums over the free bodies, made per chunk and added in chunk order. */
typedef struct tl_sums {
    double unbalanced;    /* sum of |unbalanced force| */
    double turning;       /* sum of |unbalanced moment| over the body's radius */
    double contact_force; /* sum over bodies of the sum of |contact forces| */
    double largest;       /* largest |unbalanced force| */
    double local;  /* largest |unbalanced force| over the body's own contact forces or weight */
    size_t bodies; /* that are free */
    double weight;
    double kinetic;    /* sum of (m v.v + w.I w) / 2 */
    double max_speed2; /* largest v.v */
} tl_sums;

/* Energy in the contact points of a page, and turned to heat in this step. */
typedef struct tl_page_energy {
    double stored, dissipated;
} tl_page_energy;

struct tl_cycle {
    tl_table table;
    /* per body, as the damping plugins see them */
    double *contact_force; /* sum of |contact forces| */
    double *velocity[3], *angular_velocity[3], *force[3], *moment[3];
    double *force_before[3], *moment_before[3];
    double *mass, *inertia;
    double *scale; /* of the inertia: 1 without mass scaling */
    double *damping_force[3], *damping_moment[3], *alpha;
    /* per body, for the energy ledger and for driven bodies */
    tl_vec3 *reaction_force, *reaction_moment; /* of the contacts alone */
    tl_vec3 *v_before, *spin_before;           /* velocity and angular momentum before the kick */
    tl_vec3 *moved_before, *turned_before;     /* velocities of the last step's motion */
    tl_quat *attitude;                         /* of the principal axes, at the forces' time */
    tl_sums *chunk_sums;
    size_t chunk_room;
    tl_sums sums;
    tl_page_energy *page_energy;
    size_t page_room;
    struct tl_ledger *chunk_ledger, *ledger; /* energy.c */
    double kinetic_before;                   /* of the last step, for its rate */
    double dt;                               /* the step in use */
    bool all_held;                           /* no body can move */
    uint64_t scaled_for; /* version of the contacts for which the inertia was scaled; 0: none */
    double scaled_step;  /* M/(2K) of the bodies after scaling */
    /* the first failure of a parallel phase, by chunk, and the point it came from */
    pthread_mutex_t failure_lock;
    tl_error failure;
    size_t failure_chunk, failure_point;
};

/* One step of the model; a failure leaves places and velocities as they were. */
tl_status tl_step(tl_model *m);

/* Times a phase that ends now and began when the one before ended, or with the step: profile.c. */
void tl_profile_step(tl_model *m);
void tl_profile_phase(tl_model *m, tl_phase phase);
static inline void tl_step_begins(tl_model *m)
{
    if (m->profiling)
        tl_profile_step(m);
}
static inline void tl_phase_ends(tl_model *m, tl_phase phase)
{
    if (m->profiling)
        tl_profile_phase(m, phase);
}

/* Makes room for the model's bodies. */
tl_status tl_cycle_prepare(tl_model *m);
/* Notes a failure in a parallel phase; that of the lowest chunk counts. */
void tl_cycle_failed(tl_model *m, size_t chunk, tl_status status, size_t point, const char *text);
/* Calls the laws on their runs of contact points and sums forces per contact. */
tl_status tl_laws_apply(tl_model *m);
/* Each body gathers its contacts in fixed order, and its weight; sums for the convergence measures. */
void tl_gather(tl_model *m);
/* An unbalanced force ratio of the last gather. */
double tl_unbalanced_ratio(const tl_model *m, tl_ratio_measure measure);
/* The same of the moments, each over its body's radius: a block that spins up is not in equilibrium. */
double tl_turning_ratio(const tl_model *m);

/* Watches for steady failure: watch.c. */
typedef struct tl_watch tl_watch;
tl_watch *tl_watch_begin(const tl_model *m);
/* After each step; gives the id of the block that fails steadily, or 0. */
tl_id tl_watch_step(tl_watch *watch, const tl_model *m);
void tl_watch_end(tl_watch *watch);
/* The step to take, s. */
tl_status tl_timestep_choose(tl_model *m, double *dt);
tl_status tl_damping_apply(tl_model *m, double dt);
/* Velocities, places and rotations one step on; false when a user's drive function ends the run (bodies then
 * go on as they were driven before). */
bool tl_move(tl_model *m, double dt);
/* The energy ledger: what the bodies had before the move, and the work done in it. */
tl_status tl_energy_prepare(tl_model *m, size_t chunks);
void tl_energy_before(tl_model *m);
void tl_energy_after(tl_model *m, double dt_before, double dt_after);
/* Angular momentum of a body, axes of the model. */
tl_vec3 tl_body_spin(const tl_model *m, uint32_t body);
/* Every contact has a law, or a sentence that names one that has not. */
tl_status tl_laws_check(tl_model *m);

#endif
