/* pressed.c - the energy of what presses, as a law tells it. */
#include "force/pressed.h"

#include "base/inside.h"
#include "contact/detection.h"

#include <string.h>

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

/* Energies of points of 1 m2 without history that are pressed in by up to 1 m. */
static void find_curve(const tl_law *law, double energy[TL_LANES])
{
    static _Alignas(TL_ALIGN) const double zeros[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t none[TL_LANES] = {0};
    _Alignas(TL_ALIGN) double area[TL_LANES], closure[TL_LANES];
    double *state[TL_STATE_COLUMNS];
    for (size_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = (double *)(uintptr_t)zeros;
    for (size_t k = 0; k < TL_LANES; k++) {
        area[k] = 1;
        closure[k] = k > 0 ? 0.05 * closure[k - 1] : 1;
    }
    const tl_law_batch batch = {.size = sizeof batch,
                                .count = TL_LANES,
                                .area = area,
                                .closure = closure,
                                .f_n0 = zeros,
                                .state = state,
                                .flags = none};
    tl_enter(law->kind, "pressed");
    ((const tl_law_ops *)law->kind->ops)->pressed(law->self, &batch, energy);
    tl_leave();
}

bool tl_law_same_curve(const tl_law *one, const tl_law *other)
{
    _Alignas(TL_ALIGN) double a[TL_LANES], b[TL_LANES];
    find_curve(one, a);
    find_curve(other, b);
    return memcmp(a, b, sizeof a) == 0;
}
