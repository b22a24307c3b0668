/* insitu_zones.h - initial stress in deformable blocks. */
#ifndef TL_CYCLE_INSITU_ZONES_H
#define TL_CYCLE_INSITU_ZONES_H

#include "model/model.h"

/* Makes room for it. false: out of memory, and nothing has changed. */
bool tl_insitu_zones_prepare(tl_model *m);
/* Puts it on zones and segments, which have been found. */
void tl_insitu_zones(tl_model *m, const tl_insitu *insitu);

#endif
