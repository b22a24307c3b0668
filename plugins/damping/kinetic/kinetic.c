/* kinetic.c - damping "kinetic": nothing is braked until the unbalanced forces of all bodies, together, work against
 * the motion. Then every body is stopped.
 *
 *     sum (F.v + M.w) < 0:   v = w = 0 before the kick
 *
 * The kinetic energy of the whole has then just been at its peak, and the model near an equilibrium. From there it
 * starts again, towards the next. No coefficient has to fit the model's lowest frequency: a vibration comes to rest
 * after a quarter of its period, the lowest too. What slides or falls gains speed until then, and loses it with the
 * rest.
 *
 * Source: the kinetic damping of dynamic relaxation, P. A. Cundall, "Explicit finite-difference methods in
 * geomechanics" (1976), and M. R. Barnes, "Form-finding and analysis of prestressed nets and membranes", Computers and
 * Structures 30 (1988) 685-695. There the kinetic energy is watched; its rate, the power of the forces, tells the peak
 * a step sooner and under mass scaling, too.
 *
 * Velocities are stopped by the viscous coefficient 2 / dt, with which (23) leaves nothing of them, whatever the
 * inertia, and takes half of the kick. So the half step after a stop is that of a motion that begins. */
#include <talus/kit.h>
#include <talus/version.h>

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "alpha", "1/s", "2 / dt in a step that stops all bodies, else 0"),
};

/* Once a step. */
static tl_status begin(const void *self, const tl_damping_totals *totals, double *const *state, tl_report *report)
{
    (void)self;
    (void)report;
    *state[0] = totals->power < 0 ? 2 / totals->dt : 0;
    return TL_OK;
}

static const tl_damping_ops ops = {.size = sizeof ops,
                                   .begin = begin,
                                   .update = tl_update_alpha_state,
                                   .step_factor = tl_step_factor_one,
                                   .never_fails = true};

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "kinetic",
            .doc = "Stops all bodies whenever the kinetic energy of the model has been at its peak; the "
                   "fastest way to an equilibrium of many blocks.",
            TL_KIND_STATES(state_table));

/* Hosts give the power of the forces since minor version 5. */
TL_PLUGIN_SINCE(5, kind, .id = "talus.kinetic", .version = TALUS_VERSION, .doc = "Kinetic damping.",
                .licence = "BSD-3-Clause");
