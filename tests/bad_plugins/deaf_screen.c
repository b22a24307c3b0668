/* deaf_screen.c - a screen without `take`. */
#include "plain_screen.h"

PLAIN_SCREEN("deaf_screen", NULL, .params_size = 0);
