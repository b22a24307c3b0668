/* walk.h - the entries of a model. */
#ifndef TL_MODEL_WALK_H
#define TL_MODEL_WALK_H

#include "base/walk.h"
#include "model/model.h"

/* The parameters of a function that a model keeps in a struct of its own: they are settings. */
typedef struct tl_settings {
    const char *prefix; /* of their names in a file: "model.config." */
    const tl_param *params;
    size_t count;
    size_t offset; /* of the struct in the model */
} tl_settings;

/* Of talus.model, and of model:timestep. */
tl_settings tl_config_settings(void);
tl_settings tl_timestep_settings(void);
/* Where a model has setting i; NULL: it is no state. */
void *tl_setting_at(const tl_model *m, const tl_settings *of, size_t i);

/* Visits what a model keeps itself. Not among it are things with owners of their own: the polyhedra, names of groups
 * and joints, laws, damping and drives. */
void tl_model_walk(tl_model *m, const tl_walk *walk);

#endif
