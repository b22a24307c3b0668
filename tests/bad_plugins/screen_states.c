/* screen_states.c - a screen that declares a state. */
#include "plain_screen.h"

static const tl_state states[] = {TL_STATE(TL_STATE_SCALAR, "brightness", "", "of the picture")};

PLAIN_SCREEN("screen_states", take, TL_KIND_STATES(states));
