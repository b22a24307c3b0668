/* walk.h - the entries of what the phases of a step keep. */
#ifndef TL_CYCLE_WALK_H
#define TL_CYCLE_WALK_H

#include "base/walk.h"
#include "cycle/cycle_data.h"

void tl_cycle_walk(struct tl_cycle *c, const tl_walk *walk);

#endif
