/* pass.h - zones follow their gridpoints: strain, stress, forces. */
#ifndef TL_ZONE_PASS_H
#define TL_ZONE_PASS_H

#include "base/parallel.h"
#include "zone/zones.h"

/* Gives the zones of all parcels the stresses that belong to the last motion of their gridpoints, of dt. Sums their
 * forces in the slots. A failure names the parcel as chunk and the row of the zone as point. */
void tl_zones_pass(tl_model *m, double dt, tl_failure *failure);

#endif
