/* cycle.c - one step, top to bottom.
 *
 * Explicit central differences (Hart, Cundall and Lemos 1988, 18-26). Positions, and so gaps and forces,
 * live at whole steps, velocities half-way between. A step turns positions into contact forces, forces
 * into velocities, velocities into positions:
 *
 *     detect   which blocks touch, where, how far they overlap            core/detect
 *     step     how long it may be                                         timestep.c
 *     drives   what driven bodies are told for the middle of the step     model/loads.c
 *     laws     contact forces, by the joints' law plugins                 laws.c
 *     gather   each body adds its contacts in a fixed order, its weight   gather.c
 *     damping  a damping plugin's forces and coefficients                 damping.c
 *     limits   no body would move out of all proportion                   limits.c
 *     move     velocities and places one step on, work done on bodies     motion.c
 *     energy   the balance of the work                                    energy.c
 *
 * The functions of drives are a user's, and the step has been chosen for the model as it is: what a step depends on cannot
 * be changed in them (tl_model_may_set).
 *
 * Everything computed in parallel is either a pure function of one contact or one body, or a sum made
 * in fixed chunks, so the bits do not depend on the number of threads. */
#include "cycle/cycle_room.h"

#include "contact/held.h"
#include "detect/detect.h"
#include "detect/overlap.h"

#include <stdlib.h>

static void cycle_destroy(struct tl_cycle *cycle)
{
    pthread_mutex_destroy(&cycle->failure_lock);
    tl_table_free(&cycle->table);
    free(cycle->reaction);
    free(cycle->chunk_sums);
    free(cycle->rank_energy);
    free(cycle->chunk_ledger);
    free(cycle->ledger);
    tl_undo_free(cycle->undo);
    free(cycle);
}

static void add_columns(struct tl_cycle *c)
{
    tl_table *t = &c->table;
    tl_table_init(t, c);
    TL_COLUMN(t, c, contact_force, TL_COLUMN_STEP);
    for (int k = 0; k < 3; k++) {
        TL_COLUMN(t, c, damping_force[k], 0);
        TL_COLUMN(t, c, damping_moment[k], 0);
    }
    TL_COLUMN(t, c, reaction_of, 0);
    TL_COLUMN(t, c, alpha, 0);
    TL_COLUMN(t, c, rate, 0);
    TL_COLUMN(t, c, face_rate, 0);
}

tl_status tl_cycle_prepare(tl_model *m)
{
    if (!m->cycle) {
        if (!(m->cycle = calloc(1, sizeof *m->cycle)))
            return tl_fail_memory(&m->error);
        m->cycle_destroy = cycle_destroy;
        pthread_mutex_init(&m->cycle->failure_lock, NULL);
        add_columns(m->cycle);
    }
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows, chunks = bodies / TL_BODY_CHUNK + 1;
    if (chunks > c->chunk_room) {
        tl_sums *sums = realloc(c->chunk_sums, chunks * sizeof *sums);
        if (!sums)
            return tl_fail_memory(&m->error);
        c->chunk_sums = sums;
        tl_status status = tl_energy_prepare(m, chunks);
        if (status != TL_OK)
            return status;
        c->chunk_room = chunks;
    }
    /* whole lanes: the damping plugins' loops run to a multiple of TL_LANES */
    return tl_table_resize(&c->table, (bodies + TL_LANES - 1) / TL_LANES * TL_LANES)
               ? TL_OK
               : tl_fail_memory(&m->error);
}

bool tl_model_moves(const tl_model *m)
{
    if (!m->cycle->all_held)
        return true;
    for (size_t i = 0; i < m->bodies.table.rows; i++)
        if (m->bodies.drive[i] || tl_v3_norm2(m->bodies.v[i]) > 0 ||
            tl_v3_norm2(m->bodies.w[i]) > 0)
            return true;
    return false;
}

/* The step to take, before anything is changed by it. */
static tl_status prepare(tl_model *m, double *dt, bool *driven)
{
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_undo_begin(m);
    if (status == TL_OK)
        status = tl_detect_update(m);
    if (status == TL_OK)
        status = tl_overlaps_check(m);
    tl_phase_ends(m, TL_PHASE_DETECT);
    if (status == TL_OK)
        status = tl_laws_check(m);
    if (status == TL_OK)
        status = tl_timestep_choose(m, dt);
    tl_phase_ends(m, TL_PHASE_TIMESTEP);
    if (status == TL_OK && !tl_gather_prepare(m))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_laws_prepare(m);
    /* false when a user's function ends the run: bodies then go on as they were driven before */
    *driven = status != TL_OK || tl_drives_evaluate(m, m->time + 0.5 * *dt);
    if (status == TL_OK)
        status = tl_motion_check_held(m, *dt);
    return status == TL_OK ? tl_undo_reserve(m) : status;
}

/* Forces on the bodies: undone when a law or the damping fails, or a body would move too far. */
static tl_status apply_forces(tl_model *m, double dt)
{
    tl_status status = tl_laws_apply(m);
    tl_phase_ends(m, TL_PHASE_LAWS);
    if (status == TL_OK) {
        tl_undo_keep_bodies(m);
        tl_gather(m);
        tl_phase_ends(m, TL_PHASE_GATHER);
        status = tl_damping_apply(m, dt);
        if (status == TL_OK)
            status = tl_motion_check(m, dt);
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
        return status;
    }
    tl_held_followed(m);
    tl_move(m, dt);
    tl_phase_ends(m, TL_PHASE_MOVE);
    tl_energy_close(m);
    tl_phase_ends(m, TL_PHASE_ENERGY);
    tl_undo_end(m);
    /* velocities are half a step behind the places, but not when all is held and still, as if the model had not begun */
    m->dt = tl_model_moves(m) ? dt : 0;
    m->time += dt;
    m->cycles++;
    if (!driven) /* the step is whole: bodies went on as they were driven before */
        return tl_fail(&m->error, TL_E_CANCELLED, "cycle %lld: a drive's function failed",
                       (long long)m->cycles);
    return TL_OK;
}
