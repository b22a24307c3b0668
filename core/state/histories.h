/* histories.h - histories with all their samples. */
#ifndef TL_STATE_HISTORIES_H
#define TL_STATE_HISTORIES_H

#include "state/part.h"

extern const tl_state_part tl_histories_part;

#endif
