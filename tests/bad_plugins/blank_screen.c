/* blank_screen.c - a screen with nothing wrong that shows nothing. */
#include "plain_screen.h"

PLAIN_SCREEN("blank_screen", take, .params_size = 0);
