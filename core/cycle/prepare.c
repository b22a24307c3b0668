/* prepare.c - what the phases of a step keep between them: made, sized for the bodies, visited, and freed. */
#include "cycle/prepare.h"

#include "base/parallel.h"
#include "cycle/conjugate.h"
#include "cycle/contributors.h"
#include "cycle/secants.h"
#include "cycle/split.h"
#include "cycle/undo.h"
#include "model/rows.h"

#include <stdlib.h>

static void cycle_destroy(struct tl_cycle *cycle)
{
    pthread_mutex_destroy(&cycle->failure.lock);
    tl_table_free(&cycle->table);
    free(cycle->contact_damping);
    free(cycle->reaction);
    free(cycle->motion);
    free(cycle->swept);
    free(cycle->secant);
    free(cycle->conjugate);
    free(cycle->fails);
    free(cycle->link);
    free(cycle->leap);
    free(cycle->gathered);
    free(cycle->booked);
    free(cycle->heat);
    free(cycle->stored);
    tl_undo_free(cycle->undo);
    tl_split_free(cycle);
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
    TL_COLUMN(t, c, turn_rate, 0);
    TL_COLUMN(t, c, inertia, 0);
}

tl_status tl_cycle_prepare(tl_model *m)
{
    tl_rows_tidy(m);
    if (!m->cycle) {
        if (!(m->cycle = calloc(1, sizeof *m->cycle)))
            return tl_fail_memory(&m->error);
        m->cycle_destroy = cycle_destroy;
        pthread_mutex_init(&m->cycle->failure.lock, NULL);
        add_columns(m->cycle);
        tl_contributors_begin(m->cycle);
    }
    tl_contributors_list(m);
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows, threads = tl_pool_threads(m->pool);
    /* whole lanes: the damping plugins' loops run to a multiple of TL_LANES */
    size_t rows = (bodies + TL_LANES - 1) / TL_LANES * TL_LANES;
    bool enough = tl_fit(&c->gathered, &c->gathered_capacity, threads, sizeof *c->gathered) &&
                  tl_fit(&c->booked, &c->booked_capacity, threads, sizeof *c->booked) &&
                  tl_fit(&c->heat, &c->heat_capacity, threads, sizeof *c->heat) &&
                  tl_fit(&c->stored, &c->stored_capacity, threads, sizeof *c->stored) &&
                  tl_table_resize(&c->table, rows);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

bool tl_model_moves(const tl_model *m)
{
    if (!m->cycle->all_held)
        return true;
    for (size_t i = 0; i < m->bodies.table.rows; i++)
        if (m->bodies.drive[i] || tl_v3_norm2(m->bodies.v[i]) > 0 || tl_v3_norm2(m->bodies.w[i]) > 0)
            return true;
    return false;
}

/* ---------------------------------------------------------------- entries ---------------- */

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "cycle.", c, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "cycle.", c, member)
#define LIST(keep, member, count, capacity, bytes)                                                                     \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "cycle.", c, member, (count), (capacity), offsetof(tl_memory, bytes))

void tl_cycle_walk(struct tl_cycle *c, const tl_walk *walk)
{
    tl_walk_table(walk, TL_KEEP_CACHE, "cycle", &c->table, offsetof(tl_memory, step));
    LIST(CACHE, reaction, &c->reaction_capacity, &c->reaction_capacity, step);
    VALUE(CACHE, reactions_for);
    VALUE(CACHE, sums);
    VALUE(STATE, kinetic_before);
    VALUE(STATE, dt);
    VALUE(CACHE, step_bounds.version);
    VALUE(CACHE, step_bounds.constraints);
    VALUE(CACHE, step_bounds.rotation);
    FLAG(CACHE, step_bounds.points);
    VALUE(CACHE, step_bounds.least_mass);
    VALUE(CACHE, step_bounds.lightest);
    FLAG(CACHE, all_held);
    VALUE(CACHE, stiffness_rates);
    VALUE(CACHE, sliver_structure);
    VALUE(CACHE, sliver);
    VALUE(CACHE, contacts);
    VALUE(STATE, mass_scale);
    VALUE(STATE, added);
    VALUE(STATE, added_block);
    VALUE(CACHE, told_share);
    FLAG(STATE, adds);
    FLAG(CACHE, long_step);
    FLAG(CACHE, fast);
    VALUE(CACHE, failing);
    VALUE(CACHE, rest_ratio);
    VALUE(STATE, ledger);
    VALUE(STATE, settling);
    LIST(CACHE, fails, &c->fails_count, &c->fails_capacity, step);
    VALUE(CACHE, fails_volume);
    VALUE(CACHE, fails_way);
    FLAG(CACHE, fails_strained);
    VALUE(CACHE, fails_at);
    LIST(STATE, secant, &c->secant_count, &c->secant_capacity, step);
    LIST(STATE, conjugate, &c->conjugate_count, &c->conjugate_capacity, step);
    LIST(SCRATCH, contact_damping, &c->contact_damping_capacity, &c->contact_damping_capacity, step);
    LIST(SCRATCH, link, &c->link_count, &c->link_capacity, step);
    LIST(SCRATCH, leap, &c->leap_capacity, &c->leap_capacity, step);
    LIST(SCRATCH, gathered, &c->gathered_capacity, &c->gathered_capacity, step);
    LIST(SCRATCH, booked, &c->booked_capacity, &c->booked_capacity, step);
    LIST(SCRATCH, heat, &c->heat_capacity, &c->heat_capacity, step);
    LIST(SCRATCH, stored, &c->stored_capacity, &c->stored_capacity, step);
    LIST(SCRATCH, motion, &c->motion_capacity, &c->motion_capacity, step);
    LIST(SCRATCH, swept, &c->swept_capacity, &c->swept_capacity, step);
}
