/* verbs.c - what can be done to a set of blocks. A stale id or a bad value fails the whole call before
 * anything is changed. */
#include "geometry/make.h"
#include "model/joints.h"
#include "model/loads.h"
#include "model/model.h"
#include "model/options.h"
#include "model/regroup.h"
#include "model/rows.h"

#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>

tl_status tl_blocks_hide(tl_model *m, const tl_id *ids, size_t count, bool hidden)
{
    tl_status status = tl_blocks_check(m, ids, count);
    if (status != TL_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        m->blocks.hidden[tl_block_row_quiet(m, ids[i])] = hidden;
    return TL_OK;
}

/* Whether some of the blocks are parts of bodies of several. */
static bool some_joined(const tl_model *m, const tl_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (m->bodies.member_count[m->blocks.body[tl_block_row_quiet(m, ids[i])]] > 1)
            return true;
    return false;
}

/* Deletes a block that has no part in a body of several. Its row goes with others. */
static void delete_block(tl_model *m, tl_id id)
{
    uint32_t row = tl_block_row_quiet(m, id);
    if (row == TL_NO_ROW) /* named twice */
        return;
    m->record.deleted += m->blocks.volume[row];
    tl_extremes_drop(m, row);
    tl_drive_leave(m, m->blocks.body[row]);
    tl_poly_free(m->blocks.shape[row]);
    m->blocks.shape[row] = NULL;
    m->blocks.stays[row] = false;
    m->gone++;
}

tl_status tl_blocks_delete(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = tl_model_may_change(m, "delete blocks");
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    if (status == TL_OK && some_joined(m, ids, count)) {
        tl_rows_tidy(m);
        status = tl_bodies_fall_apart(m, ids, count);
    }
    for (size_t i = 0; i < count && status == TL_OK; i++)
        delete_block(m, ids[i]);
    return status;
}

/* In what way a body is held, and the motion that holding it may end. */
typedef struct constraint {
    uint8_t fixed;
    uint32_t drive;
    tl_vec3 v, w;
} constraint;

static constraint constraint_of(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    return (constraint){b->fixed[body], b->drive[body], b->v[body], b->w[body]};
}

static bool has_constraint(const tl_model *m, uint32_t body, constraint before)
{
    constraint now = constraint_of(m, body);
    double faster = tl_v3_norm2(tl_v3_sub(now.v, before.v)) + tl_v3_norm2(tl_v3_sub(now.w, before.w));
    return now.fixed == before.fixed && now.drive == before.drive && faster == 0;
}

static void fix_body(tl_model *m, uint32_t body, unsigned what)
{
    tl_vec3 *v = &m->bodies.v[body];
    m->bodies.fixed[body] = (uint8_t)(m->bodies.fixed[body] | (what & TL_FIX_ALL));
    v->x = what & TL_FIX_X ? 0 : v->x;
    v->y = what & TL_FIX_Y ? 0 : v->y;
    v->z = what & TL_FIX_Z ? 0 : v->z;
    if (what & TL_FIX_ROTATION)
        m->bodies.w[body] = tl_v3(0, 0, 0);
}

static void free_body(tl_model *m, uint32_t body, unsigned what)
{
    if (m->bodies.fixed[body] & what)
        tl_load_begins_anew(m, body);
    m->bodies.fixed[body] = (uint8_t)(m->bodies.fixed[body] & ~what);
}

/* Lets the bodies of blocks go from their drives, and changes in what way they are held. */
static tl_status change_fixing(tl_model *m, const tl_id *ids, size_t count, const char *verb,
                               void (*change)(tl_model *, uint32_t, unsigned), unsigned what)
{
    tl_status status = tl_model_may_set(m, verb);
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    bool changed = false;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        constraint before = constraint_of(m, body);
        tl_drive_leave(m, body);
        change(m, body, what);
        changed = changed || !has_constraint(m, body, before);
    }
    m->constraints += changed;
    return status;
}

tl_status tl_blocks_fix(tl_model *m, const tl_id *ids, size_t count, unsigned what)
{
    return change_fixing(m, ids, count, "fix blocks", fix_body, what);
}

tl_status tl_blocks_free(tl_model *m, const tl_id *ids, size_t count)
{
    return change_fixing(m, ids, count, "free blocks", free_body, TL_FIX_ALL);
}

static void displacement_from_now(tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    m->blocks.base[row] = (tl_base){m->bodies.pose[body].u, m->bodies.q[body]};
}

tl_status tl_blocks_reset_displacement(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = tl_blocks_check(m, ids, count);
    if (status != TL_OK)
        return status;
    if (count && !tl_blocks_hold_base(m))
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        displacement_from_now(m, tl_block_row_quiet(m, ids[i]));
    return TL_OK;
}

tl_status tl_model_stage(tl_model *m, const char *name)
{
    tl_rows_tidy(m);
    if (strlen(name) > TL_STAGE_NAME || !tl_text_is_clean(name))
        return tl_fail(&m->error, TL_E_ARGUMENT, "stage: the name '%s' must be one line of UTF-8 of at most %d bytes",
                       tl_text_is_utf8(name) ? name : "...", TL_STAGE_NAME);
    const size_t rows = m->blocks.table.rows;
    if (rows && !tl_blocks_hold_base(m))
        return tl_fail_memory(&m->error);
    for (uint32_t row = 0; row < rows; row++)
        displacement_from_now(m, row);
    tl_text_print(m->stage, sizeof m->stage, "%s", name);
    return TL_OK;
}

static bool given(tl_vec3 v)
{
    return !(isnan(v.x) && isnan(v.y) && isnan(v.z));
}

static tl_status check_set(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *set)
{
    if (!isnan(set->density) && !(set->density > 0 && isfinite(set->density)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "set: density = %g kg/m3 must be > 0", set->density);
    for (size_t i = 0; i < count && !isnan(set->density); i++) {
        tl_status status = tl_check_measures(&m->error, m->blocks.shape[tl_block_row_quiet(m, ids[i])], set->density);
        if (status != TL_OK)
            return tl_error_prefix(&m->error, "set: density = %g kg/m3, block %u: ", set->density, ids[i]);
    }
    if (set->group && !tl_text_is_utf8(set->group))
        return tl_fail(&m->error, TL_E_ARGUMENT, "set: group = '%s' is not a text in UTF-8", set->group);
    const tl_vec3 none = {0, 0, 0};
    return tl_check_motion(&m->error, "set", given(set->velocity) ? set->velocity : none,
                           given(set->angular_velocity) ? set->angular_velocity : none);
}

/* Blocks of one body that are given a velocity: their mass, and its first moment about the body's centroid. */
typedef struct moved_parts {
    double mass;
    tl_vec3 moment;
} moved_parts;

/* Gives the bodies of the blocks their motion. What gets the velocity is the common centroid of those of its blocks
 * that are listed: of one block its own. `moved`: [bodies], zeros, or NULL when all bodies are of one block. */
static void set_motion(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *set, moved_parts *moved)
{
    tl_bodies *b = &m->bodies;
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = m->blocks.body[row];
        if (given(set->velocity) && moved) {
            double mass = m->blocks.density[row] * m->blocks.volume[row];
            tl_vec3 arm = tl_m3_mul(&b->pose[body].r, tl_block_local(m, row));
            moved[body].mass += mass;
            moved[body].moment = tl_v3_madd(moved[body].moment, mass, arm);
        }
        if (given(set->angular_velocity))
            b->w[body] = set->angular_velocity;
        if (given(set->velocity) || given(set->angular_velocity))
            tl_load_begins_anew(m, body);
    }
    for (size_t i = 0; i < count && given(set->velocity); i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        b->v[body] = set->velocity;
        if (moved && b->member_count[body] > 1)
            b->v[body] = tl_v3_sub(set->velocity,
                                   tl_v3_cross(b->w[body], tl_v3_scale(1 / moved[body].mass, moved[body].moment)));
    }
}

tl_status tl_blocks_set(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *values)
{
    tl_block_set read;
    const tl_block_set *set = &read;
    tl_status status = TL_OPTIONS_READ(tl_block_set, values, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set properties of blocks");
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    if (status == TL_OK)
        status = check_set(m, ids, count, set);
    if (status != TL_OK)
        return status;
    uint32_t group = 0;
    if (set->group && (group = tl_group_intern(m, set->group)) == UINT32_MAX)
        return tl_fail_memory(&m->error);
    tl_aside aside;
    bool joined = some_joined(m, ids, count), mends = !isnan(set->density) && joined;
    moved_parts *moved = joined ? calloc(m->bodies.table.rows, sizeof *moved) : NULL;
    if ((joined && !moved) || (mends && !tl_rows_set_aside(m, &aside))) {
        free(moved);
        return tl_fail_memory(&m->error);
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = m->blocks.body[row];
        if (set->group)
            m->blocks.group[row] = group;
        if (!isnan(set->density)) {
            m->blocks.density[row] = set->density;
            if (m->bodies.member_count[body] == 1)
                tl_body_measure(m, body);
        }
    }
    set_motion(m, ids, count, set, moved);
    free(moved);
    m->constraints++;
    if (!mends)
        return TL_OK;
    status = tl_bodies_mend(m); /* a body of several blocks has another centroid now */
    tl_rows_settle(m, &aside, status == TL_OK);
    return status;
}
