/* kinds.h - laws, damping and solids: of which plugin, with which parameters and states, by their names. */
#ifndef TL_STATE_KINDS_H
#define TL_STATE_KINDS_H

#include "state/part.h"

/* TL_E_NOT_FOUND: a plugin is not loaded; TL_E_STATE: it is there in another version. */
extern const tl_state_part tl_laws_part;
extern const tl_state_part tl_damping_part;
extern const tl_state_part tl_solids_part, tl_elements_part;

#endif
