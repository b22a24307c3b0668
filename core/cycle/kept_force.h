/* kept_force.h - field contacts that come under another law keep their normal force (kept_force.c). */
#ifndef TL_CYCLE_KEPT_FORCE_H
#define TL_CYCLE_KEPT_FORCE_H

#include "model/model.h"

/* Whether there is memory for the next function. Nothing changes. */
bool tl_may_keep_field_force(tl_model *m, uint32_t contact);
/* Moves the faces of a field contact so that the law that its joint has now gives the force of the last step. false: out of
 * memory. */
bool tl_keep_field_force(tl_model *m, uint32_t contact);

#endif
