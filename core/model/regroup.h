/* regroup.h - bodies made anew of blocks, whole or not at all. */
#ifndef TL_MODEL_REGROUP_H
#define TL_MODEL_REGROUP_H

#include "model/model.h"

/* The rows of blocks and bodies as they were before a change that may fail half-way. */
typedef struct tl_aside {
    tl_blocks blocks;
    tl_bodies bodies;
    tl_id next_id;
    uint64_t structure, constraints;
} tl_aside;

/* Sets copies aside; false when out of memory. Until the change is settled shapes of the rows must not be freed, and
 * drives are kept though no body follows them. */
bool tl_rows_set_aside(tl_model *m, tl_aside *aside);
/* Forgets them when the change is made, else takes them back: the model is as it was. */
void tl_rows_settle(tl_model *m, tl_aside *aside, bool changed);

/* Makes the bodies anew: blocks of the same group[row] (the row of the group's lowest block) are one
 * body. Bodies that stay as they are are not touched; others get the mass, momentum and angular
 * momentum of their parts. TL_E_MEMORY leaves the model as it was. */
tl_status tl_bodies_regroup(tl_model *m, const uint32_t *group);
/* Whether two bodies may become one unasked: nothing but their own weight and contacts tells them apart. */
static inline bool tl_bodies_may_join(const tl_bodies *b, uint32_t one, uint32_t other)
{
    return one != other && !b->mesh[one] && !b->mesh[other] && b->fixed[one] == b->fixed[other] && !b->drive[one] &&
           !b->drive[other] && !tl_body_loaded(b, one) && !tl_body_loaded(b, other);
}
/* group[row] of the bodies as they are. */
void tl_bodies_groups(const tl_model *m, uint32_t *group);
/* A block's inertia about its centroid, in the axes of the model. */
tl_sym3 tl_block_inertia(const tl_model *m, uint32_t row);
tl_vec3 tl_block_velocity(const tl_model *m, uint32_t row);

#endif
