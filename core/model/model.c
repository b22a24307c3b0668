/* model.c - settings of a model, and the way from ids to rows. */
#include "model/model.h"

#include "base/inside.h"
#include "model/options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>

void tl_damping_clear(tl_model *m)
{
    const tl_damping_ops *ops = m->damping ? m->damping->ops : NULL;
    if (ops && ops->destroy && m->damping_self != m->damping_params) {
        tl_enter(m->damping, "destroy");
        ops->destroy(m->damping_self);
        tl_leave();
    }
    free(m->damping_params);
    free(m->damping_state);
    m->damping = NULL;
    m->damping_params = m->damping_self = NULL;
    m->damping_state = NULL;
}

const tl_error *tl_model_error(const tl_model *m)
{
    return &m->error;
}

void tl_model_speak_lua(tl_model *m, int lua)
{
    m->speaks_lua = lua != 0;
}

void tl_model_log(tl_model *m, tl_log_fn log, void *user)
{
    m->log = log;
    m->log_user = user;
}

void tl_model_say(tl_model *m, const char *format, ...)
{
    char text[TL_ERROR_TEXT];
    va_list args;
    va_start(args, format);
    tl_text_vprint(text, sizeof text, format, args);
    va_end(args);
    tl_text_clean(text, sizeof text);
    if (m->log)
        m->log(m->log_user, text);
    else
        fprintf(stderr, "talus: %s\n", text);
}

bool tl_model_says(tl_model *m, tl_remark remark)
{
    bool first = !(m->said & 1u << remark);
    m->said |= 1u << remark;
    return first;
}

tl_status tl_model_may_change(tl_model *m, const char *what)
{
    if (m->running || m->reading)
        return tl_fail(&m->error, TL_E_STATE,
                       "cannot %s while the model is running: end the run with a stop function and do it after", what);
    return TL_OK;
}

void tl_model_only_read(tl_model *m, bool on)
{
    m->reading = on;
}

tl_status tl_model_may_set(tl_model *m, const char *what)
{
    if (m->reading)
        return tl_fail(&m->error, TL_E_STATE,
                       "cannot %s from the function of a history or of a field, which may read the model only: do it "
                       "between two runs, or in on_progress",
                       what);
    if (m->driving)
        return tl_fail(&m->error, TL_E_STATE,
                       "cannot %s from a drive's function, which is called in the middle of a step: do it between two "
                       "runs, or in solve's on_progress",
                       what);
    return TL_OK;
}

void tl_model_settings_get(const tl_model *m, tl_model_config *config, size_t size)
{
    uint32_t own = (uint32_t)size;
    memset(config, 0, size);
    memcpy(config, &m->config, size < sizeof m->config ? size : sizeof m->config);
    memcpy(config, &own, sizeof own);
}

tl_status tl_model_set_gravity(tl_model *m, tl_vec3 gravity)
{
    tl_status status = tl_model_may_set(m, "set gravity");
    if (status != TL_OK)
        return status;
    if (!tl_v3_finite(gravity))
        return tl_fail(&m->error, TL_E_ARGUMENT, "gravity = {%g, %g, %g} must be three finite numbers", gravity.x,
                       gravity.y, gravity.z);
    if (m->dt > 0 && !m->gravity_changed) {
        m->gravity_before = m->config.gravity;
        m->gravity_changed = true;
    }
    m->config.gravity = gravity;
    m->remarked = 0;
    if (gravity.z > sqrt(gravity.x * gravity.x + gravity.y * gravity.y) && tl_model_says(m, TL_REMARK_GRAVITY))
        tl_model_say(m,
                     "gravity = {%g, %g, %g} points upward, for z is up: blocks will fall to the sky; give {%g, %g, "
                     "%g} for weight",
                     gravity.x, gravity.y, gravity.z, gravity.x, gravity.y, -gravity.z);
    return TL_OK;
}

tl_status tl_model_set_rotation(tl_model *m, tl_rotation_rule rule)
{
    tl_status status = tl_model_may_set(m, "set rotation");
    if (status == TL_OK)
        status = tl_check_choice(&m->error, "rotation", (int)rule, TL_ROTATION_PAPER);
    if (status != TL_OK)
        return status;
    m->config.rotation = (int32_t)rule;
    return TL_OK;
}

tl_status tl_model_set_reuse_geometry(tl_model *m, bool reuse)
{
    tl_status status = tl_model_may_set(m, "set reuse_geometry");
    if (status != TL_OK)
        return status;
    m->config.reuse_geometry = reuse;
    m->constraints++; /* areas that were reused will be others */
    return TL_OK;
}

tl_status tl_model_set_contact_points(tl_model *m, tl_contact_points where)
{
    tl_status status = tl_model_may_set(m, "set contact_points");
    if (status == TL_OK)
        status = tl_check_choice(&m->error, "contact_points", (int)where, TL_POINTS_CORNERS);
    if (status != TL_OK)
        return status;
    m->config.contact_points = (int32_t)where;
    m->laws++;
    m->rules++; /* contacts are made anew */
    return TL_OK;
}

double tl_model_time(const tl_model *m)
{
    return m->time;
}

int64_t tl_model_cycles(const tl_model *m)
{
    return m->cycles;
}

void tl_model_interrupt(tl_model *m)
{
    atomic_store(&m->interrupted, true);
}

void tl_model_interrupt_if(tl_model *m, bool (*asked)(void))
{
    m->interrupt_asked = asked;
}

/* ---------------------------------------------------------------- rows ------------------- */

/* Of records that begin with an id. */
static int compare_ids(const void *x, const void *y)
{
    const tl_id *p = x, *q = y;
    return (*p > *q) - (*p < *q);
}

const tl_cut_part *tl_cut_part_of(const tl_model *m, tl_id id)
{
    return m->cut_part_count ? bsearch(&id, m->cut_parts, m->cut_part_count, sizeof *m->cut_parts, compare_ids) : NULL;
}

tl_id tl_split_of(const tl_model *m, tl_id block)
{
    const tl_split *split =
        m->split_count ? bsearch(&block, m->splits, m->split_count, sizeof *split, compare_ids) : NULL;
    return split ? split->whole : TL_NO_ID;
}

/* Ids ascend with the rows. */
uint32_t tl_block_row_quiet(const tl_model *m, tl_id id)
{
    const tl_blocks *b = &m->blocks;
    uint32_t row = 0, end = (uint32_t)b->table.rows;
    if (end == 0 || id < b->id[0] || id > b->id[end - 1])
        return TL_NO_ROW;
    if (b->id[end - 1] - b->id[0] == end - 1) { /* none is missing */
        row = id - b->id[0];
    } else {
        while (end - row > 1) {
            uint32_t middle = row + (end - row) / 2;
            *(b->id[middle] <= id ? &row : &end) = middle;
        }
    }
    return b->id[row] == id && (m->gone == 0 || b->stays[row]) ? row : TL_NO_ROW;
}

uint32_t tl_block_row(tl_model *m, tl_id id)
{
    uint32_t row = tl_block_row_quiet(m, id);
    if (row == TL_NO_ROW)
        tl_fail(&m->error, TL_E_STALE, "block %u %s", id,
                id != TL_NO_ID && id < m->next_id ? "no longer exists: it was cut or deleted" : "does not exist");
    return row;
}

tl_status tl_blocks_check(tl_model *m, const tl_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (tl_block_row(m, ids[i]) == TL_NO_ROW)
            return m->error.status;
    return TL_OK;
}

tl_status tl_blocks_check_rigid(tl_model *m, const tl_id *ids, size_t count, const char *verb, const char *instead)
{
    tl_status status = tl_blocks_check(m, ids, count);
    for (size_t i = 0; status == TL_OK && i < count; i++)
        if (tl_block_deforms(m, tl_block_row_quiet(m, ids[i])))
            status = tl_fail(&m->error, TL_E_STATE, "cannot %s: block %u is deformable; %s", verb, ids[i], instead);
    return status;
}

tl_status tl_block_check(tl_model *m, tl_id block)
{
    return tl_block_row(m, block) == TL_NO_ROW ? m->error.status : TL_OK;
}

size_t tl_block_count(const tl_model *m)
{
    return m->blocks.table.rows - m->gone;
}

tl_vec3 tl_block_centroid(const tl_model *m, uint32_t row)
{
    return tl_model_point(m, m->blocks.body[row], tl_block_local(m, row));
}

static const tl_base no_base = {{0, 0, 0}, {1, 0, 0, 0}};

bool tl_blocks_hold_base(tl_model *m)
{
    tl_blocks *b = &m->blocks;
    const bool there = b->base, enough = TL_COLUMN_NEED(&b->table, b, base, 0);
    for (size_t row = 0; row < b->table.rows && enough && !there; row++)
        b->base[row] = no_base;
    return enough;
}

bool tl_blocks_hold_made(tl_model *m)
{
    tl_blocks *b = &m->blocks;
    const bool there = b->made, enough = TL_COLUMN_NEED(&b->table, b, made, 0);
    for (size_t row = 0; row < b->table.rows && enough && !there; row++)
        b->made[row] = no_base;
    return enough;
}

tl_base tl_block_base(const tl_model *m, uint32_t row)
{
    return m->blocks.base ? m->blocks.base[row] : no_base;
}

tl_base tl_block_made(const tl_model *m, uint32_t row)
{
    return m->blocks.made ? m->blocks.made[row] : no_base;
}

tl_vec3 tl_block_point_moved(const tl_model *m, uint32_t row, const tl_base *from, tl_vec3 local)
{
    const uint32_t body = m->blocks.body[row];
    const tl_vec3 turned = tl_v3_sub(tl_m3_mul(&m->bodies.pose[body].r, local), local);
    const tl_vec3 moved = tl_v3_add(m->bodies.pose[body].u, turned);
    const tl_mat3 turn = tl_q_matrix(from->turn);
    const tl_vec3 before = tl_v3_sub(tl_m3_mul(&turn, local), local);
    return tl_v3_sub(moved, tl_v3_add(from->shift, before));
}

tl_vec3 tl_block_point_displacement(const tl_model *m, uint32_t row, tl_vec3 local)
{
    const tl_base from = tl_block_base(m, row);
    return tl_block_point_moved(m, row, &from, local);
}

tl_vec3 tl_block_displacement(const tl_model *m, uint32_t row)
{
    return tl_block_point_displacement(m, row, tl_block_local(m, row));
}

tl_status tl_model_go_on(tl_model *m)
{
    if (tl_model_interrupted(m))
        return tl_fail(&m->error, TL_E_CANCELLED, "%s", tl_status_text(TL_E_CANCELLED));
    return TL_OK;
}
