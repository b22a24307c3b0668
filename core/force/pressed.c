/* pressed.c - the energy of what presses, as a law tells it. */
#include "force/pressed.h"

#include "base/inside.h"
#include "contact/detection.h"

#include <math.h>
#include <string.h>

/* Of a closure: how far from it energies are taken for a force that is not told. */
#define NEAR (1.0 / 1024)

/* Asks for energies; the law may tell forces, too. Without that the first stays what it was. */
static void ask(const tl_law *law, const tl_law_batch *batch, double *energy)
{
    tl_enter(law->kind, "pressed");
    ((const tl_law_ops *)law->kind->ops)->pressed(law->self, batch, energy);
    tl_leave();
}

/* Points from a row on, with rows of `state` and forces to be filled. */
static tl_law_batch batch_of(const tl_model *m, size_t first, size_t count,
                             const tl_point_lanes *lanes, double *state[TL_STATE_COLUMNS],
                             double *force)
{
    const tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : lanes->zero;
    return (tl_law_batch){.size = sizeof(tl_law_batch),
                          .count = (uint32_t)count,
                          .area = p->area + first,
                          .f_n0 = p->f_n0 ? p->f_n0 + first : lanes->zero,
                          .f_n = force,
                          .state = state,
                          .flags = p->flags + first};
}

void tl_law_energies(const tl_model *m, const tl_law *law, size_t first, size_t count,
                     const tl_point_lanes *lanes, const double *closure, double *energy)
{
    double *state[TL_STATE_COLUMNS], force[TL_PRESSED_ROWS];
    tl_law_batch batch = batch_of(m, first, count, lanes, state, force);
    batch.closure = closure;
    ask(law, &batch, energy);
}

/* Asks at the closures u - lift, and for forces that are not told at those of a little less and more. */
static void press(const tl_law *law, tl_law_batch *batch, const double *u, const double *lift,
                  double *energy, double *force)
{
    double closure[TL_PRESSED_ROWS], other[2][TL_PRESSED_ROWS];
    const size_t count = batch->count;
    batch->closure = closure;
    batch->f_n = force;
    for (size_t i = 0; i < count; i++)
        closure[i] = u[i] - lift[i];
    force[0] = NAN;
    ask(law, batch, energy);
    if (!isnan(force[0]))
        return;
    for (int side = 0; side < 2; side++) {
        for (size_t i = 0; i < count; i++)
            closure[i] = (side ? 1 + NEAR : 1 - NEAR) * u[i] - lift[i];
        ask(law, batch, other[side]);
    }
    for (size_t i = 0; i < count; i++)
        force[i] = u[i] > 0 ? (other[1][i] - other[0][i]) / (2 * NEAR * u[i]) : 0;
}

void tl_law_press(const tl_model *m, const tl_law *law, size_t first, size_t count,
                  const tl_point_lanes *lanes, const double *u, const double *lift, double *energy,
                  double *force)
{
    double *state[TL_STATE_COLUMNS];
    tl_law_batch batch = batch_of(m, first, count, lanes, state, force);
    press(law, &batch, u, lift, energy, force);
}

void tl_law_press_alone(const tl_law *law, double area, const double state[TL_STATE_COLUMNS],
                        const double u[], size_t count, double energy[], double stress[])
{
    const tl_law_ops *ops = law->kind->ops;
    _Alignas(TL_ALIGN) double areas[TL_LANES], zero[TL_LANES] = {0}, at[TL_LANES] = {0};
    _Alignas(TL_ALIGN) double states[TL_STATE_COLUMNS][TL_LANES], hold[TL_LANES];
    _Alignas(TL_ALIGN) double lift[TL_LANES] = {0}, told[TL_LANES], force[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
    double *state_at[TL_STATE_COLUMNS];
    for (uint32_t l = 0; l < TL_LANES; l++) {
        areas[l] = area;
        flags[l] = TL_POINT_APART;
        at[l] = l < count ? u[l] : 0;
    }
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++) {
        state_at[k] = states[k];
        for (uint32_t l = 0; l < TL_LANES; l++)
            states[k][l] = state[k];
    }
    tl_law_batch batch = {.size = sizeof batch,
                          .count = TL_LANES,
                          .area = areas,
                          .f_n0 = zero,
                          .state = state_at,
                          .flags = flags};
    if (ops->across_gap) {
        tl_enter(law->kind, "across_gap");
        ops->across_gap(law->self, &batch, lift, hold);
        tl_leave();
    }
    press(law, &batch, at, lift, told, force);
    for (size_t l = 0; l < count; l++) {
        energy[l] = told[l] / area;
        stress[l] = force[l] / area;
    }
}

/* Energies of points of 1 m2 without history that are pressed in by up to 1 m. */
static void find_curve(const tl_law *law, double energy[TL_LANES])
{
    static _Alignas(TL_ALIGN) const double zeros[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t none[TL_LANES] = {0};
    _Alignas(TL_ALIGN) double area[TL_LANES], closure[TL_LANES], force[TL_LANES];
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
                                .f_n = force,
                                .state = state,
                                .flags = none};
    ask(law, &batch, energy);
}

bool tl_law_same_curve(const tl_law *one, const tl_law *other)
{
    _Alignas(TL_ALIGN) double a[TL_LANES], b[TL_LANES];
    find_curve(one, a);
    find_curve(other, b);
    return memcmp(a, b, sizeof a) == 0;
}
