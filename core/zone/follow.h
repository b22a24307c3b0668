/* follow.h - meshes follow their bodies: when rows move, and when bodies go. */
#ifndef TL_ZONE_FOLLOW_H
#define TL_ZONE_FOLLOW_H

#include "zone/zones.h"

/* Finds the rows of the bodies of all meshes anew where rows have moved, and takes out the meshes of bodies that have
 * gone. There are zones, and rows are tidy. */
void tl_zones_follow(tl_model *m);

#endif
