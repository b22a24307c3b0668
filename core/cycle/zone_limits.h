/* zone_limits.h - no step turns a zone inside out. */
#ifndef TL_CYCLE_ZONE_LIMITS_H
#define TL_CYCLE_ZONE_LIMITS_H

#include "model/model.h"

/* Whether zones have strained so fast that one may be turned inside out. Then the step is kept. */
bool tl_zones_are_fast(const tl_model *m);
/* Fails when the next motion, of dt, would turn a zone inside out. Nothing has moved yet. */
tl_status tl_zones_check(tl_model *m, double dt);
/* A zone that fails: which solid and block, before what the failure says. */
tl_status tl_zones_failed(tl_model *m, tl_status status);

#endif
