/* solve.h - many steps. */
#ifndef TL_CYCLE_SOLVE_H
#define TL_CYCLE_SOLVE_H

#include "model/model.h"

/* Runs until a limit is met: tl_model_solve, whatever the steps are like. */
tl_status tl_solve_run(tl_model *m, const tl_solve *solve, tl_solve_result *result);

#endif
