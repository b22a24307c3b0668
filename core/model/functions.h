/* functions.h - defaults of the kernel's functions that other sources know, too. */
#ifndef TL_MODEL_FUNCTIONS_H
#define TL_MODEL_FUNCTIONS_H

/* Default: minimum area of field contacts, as a share of the smaller block's mean face area: none. Hart, Cundall and
 * Lemos (1988) have 1 % of a face. */
#define TL_AREA_FRACTION 0.0
/* Default: FRAC of (27), by the rule: one contact counts (Hart, Cundall and Lemos 1988), or all of a body. */
#define TL_PAPER_FRACTION 0.1
#define TL_BODY_FRACTION 0.5
#define TL_BALANCE_FRACTION 1.0
/* Default: error of the energy balance that the rule balance allows. */
#define TL_BALANCE_ERROR 1e-4

/* Default: share of the mass that may be added for a longer step: what slides or falls is then as much slower at the
 * most. Test: lua/test_mass_added. */
#define TL_MOST_ADDED 0.05

/* Flag of a parameter of talus.model or model:timestep: results do not depend on it, so that it is no state of a
 * model. */
#define TL_PARAM_PASSING (1u << 16)

#endif
