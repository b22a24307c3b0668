/* deformable.h - what verbs on blocks do to the gridpoints of deformable bodies. The module zone gives a model these
 * functions with its first mesh; they call for no module above the model. */
#ifndef TL_MODEL_DEFORMABLE_H
#define TL_MODEL_DEFORMABLE_H

#include "model/model.h"

/* Each but the first acts on a body that has a mesh. None fails but those that tell. */
typedef struct tl_zone_verbs {
    /* Lets meshes follow rows that have moved. */
    void (*follow)(tl_model *m);
    /* Whether a load can be put on a body. */
    tl_status (*check_load)(tl_model *m, uint32_t body, const tl_load *load);
    /* Makes room for loads. false: out of memory. */
    bool (*hold_loads)(tl_model *m);
    /* Puts it on, in the place of all loads on its gridpoints. */
    void (*load)(tl_model *m, uint32_t body, const tl_load *load);
    /* Holds components of all gridpoints (TL_FIX_X, _Y, _Z), which then stand still along them. */
    void (*fix)(tl_model *m, uint32_t body, unsigned what);
    /* Lets all gridpoints go from what holds and drives them. */
    void (*free)(tl_model *m, uint32_t body);
    /* Whether all gridpoints are held in every component. */
    bool (*is_held)(const tl_model *m, uint32_t body);
    /* Gives all gridpoints the velocity and, about their mean by mass, the angular velocity; NaN: the one is that of
     * the mean, the other 0. */
    void (*move)(tl_model *m, uint32_t body, tl_vec3 velocity, tl_vec3 angular_velocity);
    /* Adds to each drive what follows it in meshes. */
    void (*count_drives)(tl_model *m);
    /* Gives the zones of blocks another solid, by its name. Nothing has changed when it fails. */
    tl_status (*resolid)(tl_model *m, const tl_id *blocks, size_t count, const char *solid);
} tl_zone_verbs;

/* Whether a body is held in every component: of a deformable one, all its gridpoints. */
static inline bool tl_body_is_held(const tl_model *m, uint32_t body)
{
    return m->bodies.mesh[body] ? m->zone_verbs->is_held(m, body) : m->bodies.fixed[body] == TL_FIX_ALL;
}

#endif
