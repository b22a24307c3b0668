/* carriers.h - zones bear contacts that are no segments: edges, corners, faces askew. */
#ifndef TL_SEGMENT_CARRIERS_H
#define TL_SEGMENT_CARRIERS_H

#include "zone/zones.h"

/* Lets zones bear the sides of contacts of deformable blocks that have begun, or have run out of their zone. false: out
 * of memory. */
bool tl_carriers_begin(tl_model *m);
/* Moves them with their zones, after a motion of dt. */
void tl_carriers_follow(tl_model *m, double dt);
/* Adds what their contacts do to the gridpoints, and how stiff these hold them, N/m. */
void tl_carriers_push(tl_model *m);
void tl_carriers_stiffen(tl_model *m);
/* Adds the damping of their contacts, by row, to that of the gridpoints. */
void tl_carriers_damp(tl_model *m, const tl_wrench *damping);
/* What is wrong with carriers that were read from a file; NULL: nothing. */
const char *tl_carriers_unsound(const tl_model *m);

#endif
