/* timestep.h - the stable time step. */
#ifndef TL_CYCLE_TIMESTEP_H
#define TL_CYCLE_TIMESTEP_H

#include "base/parallel.h"
#include "cycle/cycle_data.h"

/* The step to take, s; 0 when nothing moves and nothing says how long it may be. */
tl_status tl_timestep_choose(tl_model *m, double *dt);
/* FRAC of (27): the user's, or that of the rule. */
double tl_timestep_fraction(const tl_model *m);
/* The highest rate, with mass scaling the lowest, all looked at anew and nothing kept. Of a body whose rate is below
 * `known` a bound no higher than that will do: 0 where all count. */
tl_row_value tl_rates_anew(tl_model *m, double known);
/* The rates that the next step will keep, for the contacts as they are, of all bodies. Those kept now stay. Notes that
 * bodies have been rated in m->detect, which is a copy that is thrown away. */
void tl_rates_try(tl_model *m, double known, double *rate, double *turn_rate);
/* Whether the step follows from rates that were kept, which are then part of the model's state. *known: for rates that
 * are tried. */
bool tl_rates_are_state(const tl_model *m, double *known);

#endif
