/* loads.h - loads and prescribed motions of bodies, and what tractions on faces put on blocks. */
#ifndef TL_MODEL_LOADS_H
#define TL_MODEL_LOADS_H

#include "model/model.h"

/* What the load of a body does. */
static inline tl_wrench tl_load_wrench(const tl_bodies *b, uint32_t body)
{
    tl_body_load load = tl_load_of(b, body);
    tl_vec3 arm = tl_m3_mul(&b->pose[body].r, load.arm);
    return (tl_wrench){load.force, tl_v3_add(load.moment, tl_v3_cross(arm, load.force))};
}

/* Whether it was another in the last step, in which the body was what it is. */
static inline bool tl_load_changed(const tl_model *m, uint32_t body)
{
    if (!m->loads_changed || isnan(m->bodies.load_before[body].force.x))
        return false;
    tl_wrench now = tl_load_wrench(&m->bodies, body), before = m->bodies.load_before[body];
    return !tl_v3_is_zero(tl_v3_sub(now.force, before.force)) || !tl_v3_is_zero(tl_v3_sub(now.moment, before.moment));
}

/* A step has been made: what gravity and loads are now is what they were in it. */
static inline void tl_loads_stepped(tl_model *m)
{
    m->gravity_before = tl_v3(0, 0, 0);
    m->gravity_changed = m->loads_changed = false;
}

/* Evaluates all drives at time t; false when a user's function ends the run. */
bool tl_drives_evaluate(tl_model *m, double t);
/* Makes a drive that nothing follows yet, and gives its number, from 1; 0: out of memory. It is ended, and its number
 * used again, unless something follows it before the next one is made. */
uint32_t tl_drive_new(tl_model *m, const tl_drive *drive);
/* Whether a drive has a gradient of velocity. */
bool tl_drive_has_gradient(const tl_drive *drive);
/* Whether a drive follows records, and lets it go of those. */
bool tl_drive_has_record(const tl_drive *drive);
void tl_drive_let_records_go(tl_drive *drive);
/* Lets a body follow a drive, in the place of any other and of what held it. */
void tl_drive_follow(tl_model *m, uint32_t body, uint32_t index);
/* Lets a body go from its drive. */
void tl_drive_leave(tl_model *m, uint32_t body);
/* The motion of a body begins anew, as it is set or was held: its load before does not count. */
void tl_load_begins_anew(tl_model *m, uint32_t body);
/* Holds the columns of loads. A model that has loads has what they were before, too. false: out of memory. */
bool tl_bodies_hold_loads(tl_bodies *b);
/* Counts the bodies of each drive again, after a driven body has fallen into several. */
void tl_drives_recount(tl_model *m);
/* Keeps the drives in use though no body follows them; or no longer, and ends those that none follows any more. */
void tl_drives_hold(tl_model *m, bool hold);

/* Limit: faster motion, m/s or rad/s, is not set, driven or parted. Momentum and angular momentum stay finite, and no
 * step is so short that a model could run with it. */
#define TL_FASTEST 1e50
/* TL_E_ARGUMENT with a sentence, after the name of a verb, unless both are finite and no component is above that. */
tl_status tl_check_motion(tl_error *error, const char *verb, tl_vec3 velocity, tl_vec3 angular_velocity);

/* A mass with its centroid, relative to the origin, and its inertia about it. */
typedef struct tl_lump {
    double mass;
    tl_vec3 place;
    tl_sym3 inertia;
} tl_lump;

/* A face of a block as a plate whose mass is its area. */
tl_lump tl_face_plate(const tl_model *m, uint32_t row, uint32_t face);

/* Replaces the model's list by one that it then owns: sorted by block and face, those of one face added. */
void tl_face_loads_set(tl_model *m, tl_face_load *list, size_t count, size_t capacity);
#endif
