/* pressed.c - the energy of what presses, as a law tells it. */
#include "force/pressed.h"

#include "base/inside.h"
#include "contact/detection.h"

void tl_law_energies(const tl_model *m, const tl_law *law, size_t first, size_t count,
                     const tl_point_lanes *lanes, const double *closure, double *energy)
{
    const tl_points_table *p = &m->detect->points;
    const tl_law_ops *ops = law->kind->ops;
    double *state[TL_STATE_COLUMNS];
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : lanes->zero;
    const tl_law_batch batch = {.size = sizeof batch,
                                .count = (uint32_t)count,
                                .area = p->area + first,
                                .closure = closure,
                                .f_n0 = p->f_n0 ? p->f_n0 + first : lanes->zero,
                                .state = state,
                                .flags = p->flags + first};
    tl_enter(law->kind, "pressed");
    ops->pressed(law->self, &batch, energy);
    tl_leave();
}
