/* life.c - a model is made and destroyed. */
#include "base/parallel.h"
#include "geometry/make.h"
#include "model/loads.h"
#include "model/model.h"
#include "model/notes.h"
#include "model/options.h"
#include "model/scope.h"
#include "model/seats.h"

#include <stdlib.h>

static void blocks_init(tl_blocks *b)
{
    tl_table *t = &b->table;
    tl_table_init(t, b);
    TL_COLUMN(t, b, id, TL_COLUMN_STATE);
    TL_COLUMN(t, b, body, TL_COLUMN_STATE);
    TL_COLUMN(t, b, shape, TL_COLUMN_OWNED);
    TL_COLUMN(t, b, group, 0);
    TL_COLUMN(t, b, density, TL_COLUMN_STATE);
    TL_COLUMN(t, b, volume, TL_COLUMN_STATE);
    TL_COLUMN(t, b, size, 0);
    TL_COLUMN(t, b, mean_face, 0);
    TL_COLUMN(t, b, lineage, TL_COLUMN_STATE);
    TL_COLUMN(t, b, hidden, TL_COLUMN_STATE);
    TL_COLUMN(t, b, stays, 0);
    TL_COLUMN(t, b, changed, 0);
}

static void bodies_init(tl_bodies *b)
{
    tl_table *t = &b->table;
    tl_table_init(t, b);
    TL_COLUMN(t, b, id, TL_COLUMN_STATE);
    TL_COLUMN(t, b, member_start, 0);
    TL_COLUMN(t, b, member_count, 0);
    TL_COLUMN(t, b, pose, TL_COLUMN_STATE);
    TL_COLUMN(t, b, q, TL_COLUMN_STATE);
    TL_COLUMN(t, b, v, TL_COLUMN_STATE);
    TL_COLUMN(t, b, w, TL_COLUMN_STATE);
    TL_COLUMN(t, b, mass, TL_COLUMN_STATE);
    TL_COLUMN(t, b, moments, TL_COLUMN_STATE);
    TL_COLUMN(t, b, axes, TL_COLUMN_STATE);
    TL_COLUMN(t, b, round, 0);
    TL_COLUMN(t, b, radius, 0);
    TL_COLUMN(t, b, fixed, TL_COLUMN_STATE);
    TL_COLUMN(t, b, mesh, 0);
    TL_COLUMN(t, b, force, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(t, b, moment, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(t, b, drive, 0);
    TL_COLUMN(t, b, odometer, 0);
    TL_COLUMN(t, b, face_rate, 0);
    TL_COLUMN(t, b, face_turn, 0);
}

tl_status tl_model_create(const tl_model_config *given, tl_model **model, tl_error *error)
{
    *model = NULL;
    tl_model_config config;
    tl_status status = TL_OPTIONS_READ(tl_model_config, given, &config, error);
    if (status != TL_OK)
        return status;
    if (config.threads < 1 || config.threads > TL_MAX_THREADS)
        return tl_fail(error, TL_E_ARGUMENT, "model: threads = %lld is outside [1, %d]", (long long)config.threads,
                       TL_MAX_THREADS);
    if (!tl_v3_finite(config.gravity))
        return tl_fail(error, TL_E_ARGUMENT, "model: gravity must be three finite numbers");
    status = tl_check_choice(error, "model: rotation", config.rotation, TL_ROTATION_PAPER);
    if (status == TL_OK)
        status = tl_check_choice(error, "model: contact_points", config.contact_points, TL_POINTS_CORNERS);
    if (status != TL_OK)
        return status;
    tl_model *m = calloc(1, sizeof *m);
    tl_pool *pool = tl_pool_create((unsigned)config.threads);
    if (!m || !pool) {
        free(m);
        tl_pool_destroy(pool);
        return tl_fail_memory(error);
    }
    m->config = config;
    m->pool = pool;
    m->next_id = 1;
    m->min_area = (tl_min_area_rule){TL_AREA_FRACTION, NAN};
    m->timestep = tl_timestep_default();
    m->added_dt = m->added_most = NAN;
    atomic_init(&m->interrupted, false);
    blocks_init(&m->blocks);
    bodies_init(&m->bodies);
    *model = m;
    return TL_OK;
}

void tl_model_destroy(tl_model *m)
{
    if (!m)
        return;
    if (m->detect)
        m->detect_destroy(m->detect);
    if (m->stepped)
        m->detect_destroy(m->stepped);
    if (m->cycle)
        m->cycle_destroy(m->cycle);
    if (m->zones)
        m->zones_destroy(m->zones);
    if (m->segments)
        m->segments_destroy(m->segments);
    if (m->elements)
        m->elements_destroy(m->elements);
    if (m->outputs)
        m->outputs_destroy(m->outputs);
    for (size_t i = 0; i < m->blocks.table.rows; i++)
        tl_poly_free(m->blocks.shape[i]);
    tl_table_free(&m->blocks.table);
    tl_table_free(&m->bodies.table);
    for (size_t i = 0; i < m->group_count; i++)
        free(m->groups[i]);
    free(m->group_index.slot);
    for (size_t i = 0; i < m->joint_count; i++)
        free(m->joints[i].name);
    for (size_t i = 0; i < m->joint_law_count; i++)
        tl_law_clear(&m->joint_laws[i]);
    tl_damping_clear(m);
    for (size_t i = 0; i < m->drive_count; i++) {
        tl_drive_let_records_go(&m->drives[i].drive);
        if (m->drives[i].drive.release)
            m->drives[i].drive.release(m->drives[i].drive.user);
    }
    free(m->drives);
    tl_notes_free(m->notes);
    while (m->history_count > 0)
        tl_history_end(m, m->history_count - 1);
    free(m->histories);
    free(m->record.list);
    free(m->cut_parts);
    free(m->cut_out);
    free(m->splits);
    free(m->face_loads);
    tl_seats_free(&m->seats);
    free(m->groups);
    free(m->joints);
    free(m->joint_laws);
    free(m->joint_min_areas);
    free(m->members);
    tl_pool_destroy(m->pool);
    free(m);
}
