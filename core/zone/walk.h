/* walk.h - the entries of zones. */
#ifndef TL_ZONE_WALK_H
#define TL_ZONE_WALK_H

#include "base/walk.h"
#include "zone/zones.h"

/* Visits what the zones of a model keep, but for the solids. */
void tl_zones_walk(struct tl_zones *z, const tl_walk *walk);

#endif
