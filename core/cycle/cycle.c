/* cycle.c - one step, top to bottom.
 *
 * Explicit central differences (Hart, Cundall and Lemos 1988, 18-26). Positions, and so gaps and forces,
 * live at whole steps, velocities half-way between. A step turns positions into contact forces, forces
 * into velocities, velocities into positions:
 *
 *     detect   which blocks touch, where, how far they overlap            core/detect
 *     step     how long it may be                                         timestep.c
 *     drives   what driven bodies are told for the middle of the step     model/loads.c
 *     laws     contact forces, by the joints' law plugins                 force/laws.c
 *     gather   each body adds its contacts in a fixed order, its weight   gather.c
 *     damping  a damping plugin's forces and coefficients                 damping.c
 *     limits   no body would move out of all proportion                   limits.c
 *     move     velocities and places one step on, work done on bodies     motion.c
 *     energy   the balance of the work                                    energy.c
 *
 * The functions of drives are a user's, and the step has been chosen for the model as it is: what a step depends on
 * cannot be changed in them (tl_model_may_set).
 *
 * Everything computed in parallel is either a pure function of one contact or one body, or an exact sum (base/exact.h).
 * So the bits do not depend on the number of threads. */
#include "cycle/cycle.h"

#include "contact/contacts.h"
#include "contact/detection.h"
#include "cycle/damping.h"
#include "cycle/energy.h"
#include "cycle/gather.h"
#include "cycle/held_gridpoints.h"
#include "cycle/limits.h"
#include "cycle/motion.h"
#include "cycle/prepare.h"
#include "cycle/profile.h"
#include "cycle/remarks.h"
#include "cycle/settle.h"
#include "cycle/shape_limit.h"
#include "cycle/split.h"
#include "cycle/timestep.h"
#include "cycle/undo.h"
#include "cycle/zone_forces.h"
#include "cycle/zone_limits.h"
#include "detect/asked.h"
#include "detect/detect.h"
#include "detect/overlap.h"
#include "element/follow.h"
#include "force/laws.h"
#include "model/loads.h"
#include "segment/carriers.h"
#include "segment/meets.h"

/* What acts on bodies makes room for the step, or finds, with `apply`, its forces at the present places. */
static tl_status ask_contributors(tl_model *m, bool apply)
{
    tl_status status = TL_OK;
    for (tl_contributors with = m->cycle->contributor; *with && status == TL_OK; with++) {
        if (apply && *with == &tl_zones_act) /* segments come after it */
            tl_phase_ends(m, TL_PHASE_LAWS);
        tl_status (*ask)(tl_model *) = apply ? (*with)->apply : (*with)->prepare;
        status = ask ? ask(m) : TL_OK;
    }
    return status;
}

/* The step to take, before anything is changed by it. */
static tl_status prepare(tl_model *m, double *dt, bool *driven)
{
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_undo_begin(m);
    if (status == TL_OK) {
        tl_segments_forget_asked(m);
        status = tl_detect_update(m);
    }
    if (status == TL_OK)
        status = tl_segments_find(m);
    if (status == TL_OK)
        status = tl_elements_ready(m);
    if (status == TL_OK && !tl_carriers_begin(m))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_overlaps_check(m);
    if (status == TL_OK)
        status = tl_shapes_check(m);
    tl_phase_ends(m, TL_PHASE_DETECT);
    if (status == TL_OK)
        status = tl_laws_check(m);
    if (status == TL_OK)
        status = tl_timestep_choose(m, dt);
    tl_phase_ends(m, TL_PHASE_TIMESTEP);
    if (status == TL_OK && !(tl_gather_prepare(m) && tl_split_prepare(m) && tl_settle_prepare(m)))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = ask_contributors(m, false);
    /* false when a user's function ends the run: bodies then go on as they were driven before */
    *driven = status != TL_OK || tl_drives_evaluate(m, m->relaxing ? m->time : m->time + 0.5 * *dt);
    if (status == TL_OK)
        tl_gridpoints_expect(m);
    if (status == TL_OK)
        status = tl_motion_check(m, *dt, true);
    return status == TL_OK ? tl_undo_reserve(m) : status;
}

/* What gravity and loads do in a step of dt: the mean over its kick. */
static void begin_loads(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    tl_vec3 now = tl_v3_scale(tl_loads_share(m), m->config.gravity);
    c->share_before = m->dt + dt > 0 ? m->dt / (m->dt + dt) : 0;
    bool changed = m->gravity_changed && !tl_v3_is_zero(tl_v3_sub(now, m->gravity_before));
    c->gravity = changed ? tl_acting_mean(c, now, m->gravity_before) : now;
}

/* Forces on the bodies: undone when a law or the damping fails, or a body would move too far. */
static tl_status apply_forces(tl_model *m, double dt)
{
    tl_status status = ask_contributors(m, true);
    tl_phase_ends(m, tl_model_deforms(m) ? TL_PHASE_ZONES : TL_PHASE_LAWS);
    if (status == TL_OK) {
        tl_undo_keep_bodies(m);
        begin_loads(m, dt);
        tl_gather(m);
        status = tl_split_hold(m, dt);
        tl_phase_ends(m, TL_PHASE_GATHER);
        if (status == TL_OK)
            status = m->relaxing ? tl_settle(m, dt) : tl_damping_apply(m, dt);
        if (status == TL_OK)
            status = tl_motion_check(m, dt, false);
        if (status == TL_OK)
            status = tl_zones_check(m, dt);
        tl_phase_ends(m, TL_PHASE_DAMPING);
    }
    if (status != TL_OK)
        tl_undo_step(m);
    return status;
}

tl_status tl_step(tl_model *m)
{
    double dt, in_use = m->cycle ? m->cycle->dt : 0;
    bool driven;
    tl_step_begins(m);
    tl_status status = prepare(m, &dt, &driven);
    if (status == TL_OK)
        status = apply_forces(m, dt);
    if (status != TL_OK) {
        if (m->cycle)
            m->cycle->dt = in_use;
        tl_asked_step_failed(m);
        return status;
    }
    if (m->cycles == 0)
        tl_remark_overlaps(m);
    tl_held_followed(m);
    tl_split_turn(m);
    tl_move(m, dt);
    tl_phase_ends(m, TL_PHASE_MOVE);
    tl_energy_close(m);
    tl_phase_ends(m, TL_PHASE_ENERGY);
    tl_undo_end(m);
    tl_split_free(m->cycle);
    m->split_count = 0; /* the parts go on by themselves */
    tl_loads_stepped(m);
    m->detect->stepped = m->detect->stepped || m->detect->contacts.table.rows > 0;
    /* velocities are half a step behind the places, but not when all is held and still: as before the first step */
    m->dt = tl_model_moves(m) ? dt : 0;
    m->time += m->relaxing ? 0 : dt;
    m->cycles++;
    if (m->relaxing)
        tl_settle_loads(m);
    tl_remark_closure(m);
    if (!driven) /* the step is whole: bodies went on as they were driven before */
        return tl_fail(&m->error, TL_E_CANCELLED, "cycle %lld: a drive's function failed", (long long)m->cycles);
    return TL_OK;
}
