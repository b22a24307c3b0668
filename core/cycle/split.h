/* split.h - parts of a body that cuts have split since the last step go on as the whole does. */
#ifndef TL_CYCLE_SPLIT_H
#define TL_CYCLE_SPLIT_H

#include "cycle/cycle_data.h"
#include "force/bear.h"
#include "model/loads.h"
#include "model/model.h"

/* Before the gather; false: out of memory. */
bool tl_split_prepare(tl_model *m);
/* After the gather: gives the parts the forces for that, and their new faces the tractions that bring these. */
tl_status tl_split_hold(tl_model *m, double dt);
/* Before the move: corrects the velocities of the parts for arms that turn. */
void tl_split_turn(tl_model *m);
/* Forgets the parts: the step is done. */
void tl_split_free(struct tl_cycle *c);

#endif
