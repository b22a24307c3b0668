/* inside.c - see inside.h. */
#include "base/inside.h"

_Thread_local tl_inside tl_inside_plugin = {NULL, NULL, NULL};
