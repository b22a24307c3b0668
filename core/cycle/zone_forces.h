/* zone_forces.h - zones act on gridpoints, and segments on these and on bodies: contributors of a step. */
#ifndef TL_CYCLE_ZONE_FORCES_H
#define TL_CYCLE_ZONE_FORCES_H

#include "model/contributor.h"

extern const tl_contributor tl_zones_act, tl_segments_act;

#endif
