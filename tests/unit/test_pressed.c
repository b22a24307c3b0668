/* test_pressed.c - energies and forces of what presses, as a law tells them: the forces, too, or only the energies. */
#include "check.h"

#include "force/field_press.h"

#include <math.h>

/* Stress and energy per area at u: a hyperbola with its pole at 1 mm, beside a spring. */
static double stress_at(double u)
{
    return 1e8 * u + 1e9 * u / (1 - 1e3 * u);
}

static double energy_at(double u)
{
    return 0.5e8 * u * u + 1e9 * 1e-6 * (-log1p(-1e3 * u) - 1e3 * u);
}

static void tell_energy(const void *self, const tl_law_batch *batch, double *energy)
{
    (void)self;
    for (uint32_t i = 0; i < batch->count; i++) {
        double u = batch->closure[i] + batch->state[0][i];
        energy[i] = u > 0 ? batch->area[i] * energy_at(u) : 0;
    }
}

static void tell_both(const void *self, const tl_law_batch *batch, double *energy)
{
    tell_energy(self, batch, energy);
    for (uint32_t i = 0; i < batch->count; i++) {
        double u = batch->closure[i] + batch->state[0][i];
        batch->f_n[i] = u > 0 ? batch->area[i] * stress_at(u) : 0;
    }
}

static void lift_of(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    (void)self;
    for (uint32_t i = 0; i < batch->count; i++) {
        lift[i] = batch->state[0][i];
        hold[i] = 0;
    }
}

/* The largest relative errors of energies and of stresses over a sweep of closures. */
static void try_law(const tl_law_ops *ops, double *energy_off, double *stress_off)
{
    const tl_kind kind = {.size = sizeof kind, .name = "pole", .ops = ops};
    const tl_law law = {.kind = &kind};
    const double state[TL_STATE_COLUMNS] = {2e-4}; /* how far slip has opened it */
    *energy_off = *stress_off = 0;
    for (int k = 0; k < 50; k++) {
        const double u[2] = {1e-6 * pow(900, k / 49.), 5e-4};
        double energy[2], stress[2];
        tl_law_press_alone(&law, 2.5, state, u, 2, energy, stress);
        for (int i = 0; i < 2; i++) {
            *energy_off = fmax(*energy_off, fabs(energy[i] / energy_at(u[i]) - 1));
            *stress_off = fmax(*stress_off, fabs(stress[i] / stress_at(u[i]) - 1));
        }
    }
}

TEST(a_law_that_tells_forces_is_taken_at_its_word)
{
    const tl_law_ops ops = {.size = sizeof ops, .across_gap = lift_of, .pressed = tell_both};
    double energy, stress;
    try_law(&ops, &energy, &stress);
    CHECK(energy < 1e-9);
    CHECK(stress < 1e-12);
}

/* Two energies beside a closure: the slope is wrong by a third of (u / 1024)^2 over the square of the way to the pole. */
TEST(forces_that_are_not_told_are_slopes_of_energies)
{
    const tl_law_ops ops = {.size = sizeof ops, .across_gap = lift_of, .pressed = tell_energy};
    double energy, stress;
    try_law(&ops, &energy, &stress);
    CHECK(energy < 1e-9);
    CHECK(stress < 1e-4);
    CHECK(stress > 1e-7); /* so it was that way */
}

TEST_MAIN(RUN(a_law_that_tells_forces_is_taken_at_its_word), RUN(forces_that_are_not_told_are_slopes_of_energies))
