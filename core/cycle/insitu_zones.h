/* insitu_zones.h - initial stress in deformable blocks. */
#ifndef TL_CYCLE_INSITU_ZONES_H
#define TL_CYCLE_INSITU_ZONES_H

#include "model/model.h"

/* Makes room for it. false: out of memory, and nothing has changed. */
bool tl_insitu_zones_prepare(tl_model *m);
/* Puts it on zones and segments, which have been found: of blocks whose rows are `chosen`, or with NULL of all. */
void tl_insitu_zones(tl_model *m, const tl_insitu *insitu, const uint8_t *chosen);
/* A block in which the mean stress of a zone is tension, of more than a share of the largest mean stress; or
 * TL_NO_ID. */
tl_id tl_insitu_pulls(const tl_model *m, double share);

#endif
