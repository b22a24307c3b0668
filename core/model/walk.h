/* walk.h - the entries of a model. */
#ifndef TL_MODEL_WALK_H
#define TL_MODEL_WALK_H

#include "base/walk.h"
#include "model/model.h"

/* Visits what a model keeps itself. Not among it are things with owners of their own: the polyhedra, names of groups and joints,
 * laws, damping and drives. */
void tl_model_walk(tl_model *m, const tl_walk *walk);

#endif
