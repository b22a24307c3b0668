/* solve.h - many steps. */
#ifndef TL_CYCLE_SOLVE_H
#define TL_CYCLE_SOLVE_H

#include "cycle/cycle_data.h"

/* Watches for steady failure. */
typedef struct tl_watch tl_watch;
/* After each step; gives the id of the block that fails steadily, or 0. */

#endif
