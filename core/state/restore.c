/* restore.c - a model from a file that save.c has written. Whatever the file holds, nothing but a whole model or a
 * sentence comes of it. What it says is put into fresh rows and looked at before anything uses it. */
#include "state/restore.h"

#include "base/entries.h"
#include "base/params.h"
#include "base/walk.h"
#include "contact/contacts.h"
#include "contact/index.h"
#include "contact/sound.h"
#include "contact/store.h"
#include "cycle/cycle_data.h"
#include "cycle/prepare.h"
#include "detect/kinds.h"
#include "element/set.h"
#include "element/sound.h"
#include "element/walk.h"
#include "geometry/seam.h"
#include "model/joints.h"
#include "model/loads.h"
#include "model/rows.h"
#include "model/seats.h"
#include "model/walk.h"
#include "segment/carriers.h"
#include "segment/lay.h"
#include "segment/sound.h"
#include "segment/uses.h"
#include "segment/walk.h"
#include "state/drives.h"
#include "state/parts.h"
#include "zone/columns.h"
#include "zone/follow.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/outer.h"
#include "zone/sound.h"
#include "zone/walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/text.h>

/* Entries on their way from an archive. */
typedef struct reader {
    const tl_archive *archive;
    char name[TL_COLUMN_CHUNK]; /* of the entry at hand, or the first that did not fit */
    bool bad, lacked;           /* one did not fit; for want of memory */
} reader;

/* ---------------------------------------------------------------- entries ---------------- */

static bool read_list(reader *r, const tl_entry *e)
{
    const tl_chunk *chunk = tl_archive_find(r->archive, r->name);
    if (!chunk || chunk->size != e->size || chunk->items > SIZE_MAX / e->size)
        return false;
    size_t items = (size_t)chunk->items;
    void *list = items ? malloc(items * e->size) : NULL;
    r->lacked = items && !list;
    bool read = !r->lacked && tl_archive_get(r->archive, r->name, list, e->size, items);
    if (!read) {
        free(list);
        return false;
    }
    tl_entry_put_list(e, list, items);
    return true;
}

/* Whether the archive has all columns of a table, each with so many rows: before there is memory for them. */
static bool has_columns(const reader *r, const tl_table *table, uint64_t rows)
{
    for (size_t k = 0; k < table->column_count; k++) {
        char full[TL_CHUNK_NAME];
        tl_column_chunk(r->name, table, k, full);
        if (!(table->columns[k].flags & TL_COLUMN_OWNED) &&
            !tl_archive_has(r->archive, full, table->columns[k].size, (size_t)rows))
            return false;
    }
    return true;
}

static bool read_table(reader *r, tl_table *table)
{
    char full[TL_CHUNK_NAME];
    uint64_t rows;
    snprintf(full, sizeof full, "%.80s.rows", r->name);
    if (!tl_archive_get(r->archive, full, &rows, sizeof rows, 1) || rows > UINT32_MAX || !has_columns(r, table, rows))
        return false;
    r->lacked = !tl_table_resize(table, (size_t)rows);
    for (size_t k = 0; k < table->column_count && !r->lacked; k++) {
        const tl_column *column = &table->columns[k];
        tl_column_chunk(r->name, table, k, full);
        if (!(column->flags & TL_COLUMN_OWNED) &&
            !tl_archive_get(r->archive, full, tl_table_data(table, k), column->size, table->rows))
            return false;
    }
    return !r->lacked;
}

static void read_entry(void *user, const tl_entry *e)
{
    reader *r = user;
    bool read;
    if (r->bad || (e->keep != TL_KEEP_STATE && e->keep != TL_KEEP_CACHE))
        return;
    tl_entry_name(e, r->name);
    if (e->form == TL_ENTRY_TABLE)
        read = read_table(r, e->at);
    else if (e->form == TL_ENTRY_LIST)
        read = read_list(r, e);
    else
        read =
            tl_archive_get(r->archive, r->name, e->at, e->size, 1) && (e->form != TL_ENTRY_FLAG || tl_is_flag(e->at));
    r->bad = !read;
}

static tl_status told(const reader *r, tl_model *m)
{
    if (!r->bad)
        return TL_OK;
    return r->lacked ? tl_fail_memory(&m->error)
                     : tl_archive_bad(r->archive, &m->error, "'%s' is missing or does not fit", r->name);
}

static tl_status unsound(const tl_archive *a, tl_model *m, const char *what)
{
    return what ? tl_archive_bad(a, &m->error, "%s", what) : TL_OK;
}

/* ---------------------------------------------------------------- what is read fits -------
 *
 * Whether the rows of a model that were read from a file fit together. Numbers of rows are those of rows that are
 * there, choices are choices, bools are bools, and places are places. */

/* Tolerance: by so much the square of a quaternion's length may be off 1. The sum of the sizes of a rotation's nine
 * numbers may exceed 3 sqrt 3 by as much. A rotation that the program has made is off by its roundings, some 1e-15. */
#define TURN_SLACK 0.01
#define MOST_MATRIX (5.2 + TURN_SLACK)

/* Changes that a model may have counted; no run comes near, and sums of such numbers do not overflow. */
#define MOST_CHANGES (UINT64_MAX / 8)

/* Cycles that a model may have run; further ones do not overflow. */
#define MOST_CYCLES (INT64_MAX / 8)

/* Bits of `said`: one for each remark. */
#define ALL_REMARKS ((2u << TL_REMARK_MOVED) - 1)

/* Whether a member holds what its parameter allows. Whole numbers of 64 bits, and texts, are not looked at. */
static bool param_is_sound(const tl_param *param, const void *member)
{
    double number[3];
    int32_t choice;
    const size_t bytes = tl_param_bytes(param->type);
    switch (param->type) {
    case TL_PARAM_BOOL: memcpy(&choice, member, bytes); return choice == 0 || choice == 1;
    case TL_PARAM_ENUM:
        memcpy(&choice, member, bytes);
        for (int32_t k = 0; param->choices[k]; k++)
            if (k == choice)
                return true;
        return false;
    case TL_PARAM_REAL:
    case TL_PARAM_VEC3:
        memcpy(number, member, bytes);
        for (size_t k = 0; k < bytes / sizeof *number; k++)
            if (!tl_param_in_range(param, number[k]) && !(param->flags & TL_PARAM_OPTIONAL && isnan(number[k])))
                return false;
        return true;
    default: return true;
    }
}

/* Settings are what the tables of parameters allow. */
static bool struct_is_sound(const tl_model *m, tl_settings of)
{
    for (size_t i = 0; i < of.count; i++) {
        const void *at = tl_setting_at(m, &of, i);
        if (at && !param_is_sound(&of.params[i], at))
            return false;
    }
    return true;
}

static bool settings_are_sound(const tl_model *m)
{
    return struct_is_sound(m, tl_config_settings()) && struct_is_sound(m, tl_timestep_settings()) &&
           tl_v3_finite(m->gravity_before) &&
           (!m->loads_changed || m->bodies.load_before || m->bodies.table.rows == 0) && tl_v3_finite(m->origin) &&
           isfinite(m->time) && isfinite(m->dt) && m->dt >= 0 && memchr(m->stage, 0, sizeof m->stage) &&
           tl_text_is_clean(m->stage) && m->cycles >= 0 && m->cycles <= MOST_CYCLES && m->gone == 0 &&
           (m->said & ~ALL_REMARKS) == 0 && !(m->added_dt <= 0) && !(m->added_most < 0) && m->still >= 0 &&
           m->still < 1 && m->structure <= MOST_CHANGES && m->constraints <= MOST_CHANGES && m->laws <= MOST_CHANGES;
}

static bool rule_is_sound(const tl_min_area_rule *rule)
{
    return rule->fraction >= 0 && isfinite(rule->fraction) &&
           (isnan(rule->absolute) || (rule->absolute >= 0 && isfinite(rule->absolute)));
}

/* What names joints: rules of minimum areas, and cuts that were refused. */
static bool joints_are_sound(const tl_model *m)
{
    bool sound = rule_is_sound(&m->min_area);
    for (size_t i = 0; i < m->joint_min_area_count && sound; i++)
        sound = m->joint_min_areas[i].tag.joint <= m->joint_count && rule_is_sound(&m->joint_min_areas[i].rule);
    for (size_t i = 0; i < m->record.listed && sound; i++)
        sound = m->record.list[i].joint.joint <= m->joint_count;
    return sound && m->record.listed <= TL_REFUSED_LISTED;
}

static bool measure_is_sound(double x)
{
    return x >= TL_LEAST_MEASURE && x <= TL_MOST_MEASURE;
}

static bool is_place(tl_vec3 x)
{
    return tl_v3_finite(x) && tl_v3_norm(x) <= TL_FARTHEST;
}

static bool matrix_is_sound(const tl_mat3 *r)
{
    double sum = 0;
    for (int k = 0; k < 9; k++)
        sum += fabs(r->m[k / 3][k % 3]);
    return sum < MOST_MATRIX;
}

/* What blocks that were cut have left, and what parts of faces are to get. */
static bool edits_are_sound(const tl_model *m)
{
    for (size_t i = 0; i < m->cut_part_count; i++) {
        const tl_cut_part *h = &m->cut_parts[i];
        if (h->id >= m->next_id || h->root == TL_NO_ID || h->root >= h->id || (i && h->id <= h[-1].id) ||
            !matrix_is_sound(&h->r) || !is_place(h->place))
            return false;
    }
    for (size_t i = 0; i < m->split_count; i++) {
        const tl_split *s = &m->splits[i];
        if (s->block == TL_NO_ID || s->block >= m->next_id || s->whole == TL_NO_ID || s->whole >= m->next_id ||
            (i && s->block <= s[-1].block))
            return false;
    }
    for (size_t i = 0; i < m->cut_out_count; i++)
        if (m->cut_out[i].block >= m->next_id || m->cut_out[i].whole >= m->next_id)
            return false;
    for (size_t i = 0; i < m->face_load_count; i++) {
        const tl_face_load *f = &m->face_loads[i];
        if (f->block == TL_NO_ID || f->block >= m->next_id || !tl_v3_finite(f->force) || !tl_v3_finite(f->moment) ||
            (i && f->block < f[-1].block))
            return false;
    }
    return true;
}

static bool is_turn(tl_quat q)
{
    double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    return fabs(norm2 - 1) < TURN_SLACK;
}

static bool base_is_sound(tl_base base)
{
    return tl_v3_finite(base.shift) && is_turn(base.turn);
}

static bool block_is_sound(const tl_model *m, uint32_t row, size_t groups)
{
    const tl_blocks *b = &m->blocks;
    tl_id least = row ? b->id[row - 1] + 1 : 1;
    return b->id[row] >= least && b->id[row] < m->next_id && b->body[row] < m->bodies.table.rows &&
           b->changed[row] <= m->structure && b->group[row] < groups && b->density[row] > 0 &&
           isfinite(b->density[row]) && measure_is_sound(b->volume[row]) && b->size[row] == tl_cbrt(b->volume[row]) &&
           b->mean_face[row] > 0 && isfinite(b->mean_face[row]) && b->hidden[row] <= 1 && b->stays[row] == 1 &&
           (!b->local || tl_v3_finite(b->local[row])) && base_is_sound(tl_block_base(m, row)) &&
           base_is_sound(tl_block_made(m, row));
}

/* Velocities and forces are any numbers: those of a model that overflows are saved as well, and the next step tells
 * it. */
static bool body_is_sound(const tl_model *m, uint32_t row, size_t drives)
{
    const tl_bodies *b = &m->bodies;
    const tl_pose *p = &b->pose[row];
    tl_id least = row ? b->id[row - 1] + 1 : 1;
    bool placed =
        is_place(p->x_ref) && is_place(p->u) && matrix_is_sound(&p->r) && is_turn(b->q[row]) && is_turn(b->axes[row]);
    tl_vec3 i = b->moments[row];
    bool heavy = measure_is_sound(b->mass[row]) && measure_is_sound(i.x) && measure_is_sound(i.y) &&
                 measure_is_sound(i.z) && measure_is_sound(b->round[row]) && b->radius[row] > 0 &&
                 isfinite(b->radius[row]);
    return b->id[row] >= least && placed && heavy && !(b->odometer[row] < 0) && b->fixed[row] <= TL_FIX_ALL &&
           b->drive[row] <= drives &&
           (!b->load ||
            (tl_v3_finite(b->load[row].force) && tl_v3_finite(b->load[row].moment) && tl_v3_finite(b->load[row].arm)));
}

/* Whether every body is that of the block of its id, the lowest of its blocks. */
static bool members_are_sound(const tl_model *m)
{
    uint32_t next = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        uint32_t body = m->blocks.body[row];
        if (body > next)
            return false;
        if (body == next && m->blocks.id[row] != m->bodies.id[next++])
            return false;
    }
    return next == m->bodies.table.rows;
}

/* What is wrong with settings, blocks and bodies, before there are polyhedra; NULL: nothing. */
static const char *rows_unsound(const tl_model *m, size_t groups, size_t drives)
{
    if (m->blocks.table.rows >= TL_NO_ROW || m->bodies.table.rows > m->blocks.table.rows)
        return "it has too many rows";
    if (!settings_are_sound(m) || !joints_are_sound(m))
        return "a setting has an impossible value";
    if (!edits_are_sound(m))
        return "what was edited has an impossible value";
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        if (!block_is_sound(m, row, groups))
            return "a block has an impossible value";
    for (uint32_t row = 0; row < m->bodies.table.rows; row++)
        if (!body_is_sound(m, row, drives))
            return "a body has an impossible value";
    return members_are_sound(m) ? NULL : "blocks do not fit their bodies";
}

/* ---------------------------------------------------------------- rows ------------------- */

/* Columns that few models have. */
static bool hold_columns(tl_model *m, const tl_archive *a)
{
    tl_table *blocks = &m->blocks.table, *bodies = &m->bodies.table;
    bool held = true;
    if (tl_archive_find(a, "blocks.local"))
        held = held && TL_COLUMN_NEED(blocks, &m->blocks, local, 0);
    if (tl_archive_find(a, "blocks.base"))
        held = held && tl_blocks_hold_base(m);
    if (tl_archive_find(a, "blocks.made"))
        held = held && tl_blocks_hold_made(m);
    if (tl_archive_find(a, "bodies.load_before"))
        held = held && TL_COLUMN_NEED(bodies, &m->bodies, load_before, 0);
    if (tl_archive_find(a, "bodies.load"))
        held = held && tl_bodies_hold_loads(&m->bodies);
    if (tl_archive_find(a, "bodies.fall"))
        held = held && TL_COLUMN_NEED(bodies, &m->bodies, fall, TL_COLUMN_STEP);
    if (tl_archive_find(a, "bodies.going"))
        held = held && TL_COLUMN_NEED(bodies, &m->bodies, going, TL_COLUMN_STEP);
    if (tl_archive_find(a, "bodies.force_before"))
        held = held && TL_COLUMN_NEED(bodies, &m->bodies, moment_before, TL_COLUMN_STEP) &&
               TL_COLUMN_NEED(bodies, &m->bodies, force_before, TL_COLUMN_STEP);
    return held;
}

/* Takes one name: TL_E_ARGUMENT when it is there already. */
typedef tl_status take_name(tl_model *m, const char *name);

static tl_status take_names(tl_model *m, const char *all, size_t bytes, take_name *take)
{
    tl_status status = TL_OK;
    for (size_t at = 0; at < bytes && status == TL_OK; at += strlen(all + at) + 1)
        status = tl_text_is_utf8(all + at) ? take(m, all + at) : TL_E_ARGUMENT;
    return status;
}

static tl_status read_names(tl_model *m, const tl_archive *a, const char *chunk_name, take_name *take)
{
    const tl_chunk *chunk = tl_archive_find(a, chunk_name);
    size_t bytes = chunk && chunk->size == 1 && chunk->items < SIZE_MAX ? (size_t)chunk->items : 0;
    char *all = malloc(bytes + 1);
    if (!all)
        return tl_fail_memory(&m->error);
    bool read = chunk && tl_archive_get(a, chunk_name, all, 1, bytes) && (bytes == 0 || all[bytes - 1] == '\0');
    tl_status status = read ? take_names(m, all, bytes, take) : TL_E_ARGUMENT;
    free(all);
    if (status == TL_E_MEMORY)
        return tl_fail_memory(&m->error);
    return status == TL_OK ? TL_OK : tl_archive_bad(a, &m->error, "'%s' is missing or does not fit", chunk_name);
}

static tl_status take_group(tl_model *m, const char *name)
{
    size_t before = m->group_count;
    uint32_t group = tl_group_intern(m, name);
    return group == UINT32_MAX ? TL_E_MEMORY : group == before ? TL_OK : TL_E_ARGUMENT;
}

static tl_status take_joint(tl_model *m, const char *name)
{
    size_t before = m->joint_count;
    uint32_t joint = tl_joint_intern(m, name);
    return joint == 0 ? TL_E_MEMORY : joint == before + 1 ? TL_OK : TL_E_ARGUMENT;
}

static tl_status read_planes(tl_model *m, const tl_archive *a)
{
    uint32_t *planes = malloc((m->joint_count + 1) * sizeof *planes);
    if (!planes)
        return tl_fail_memory(&m->error);
    bool read = tl_archive_get(a, "joints.planes", planes, sizeof *planes, m->joint_count);
    for (size_t i = 0; i < m->joint_count && read; i++)
        m->joints[i].planes = planes[i];
    free(planes);
    return read ? TL_OK : tl_archive_bad(a, &m->error, "'joints.planes' does not fit the joints");
}

/* Planes that parts of bodies have of each other follow from their shapes. */
static tl_status share_planes(tl_model *m)
{
    tl_poly **parts = malloc((m->blocks.table.rows + 1) * sizeof *parts);
    tl_status status = parts ? TL_OK : tl_fail_memory(&m->error);
    for (uint32_t body = 0; body < m->bodies.table.rows && status == TL_OK; body++) {
        const uint32_t *members = &m->members[m->bodies.member_start[body]];
        uint32_t count = m->bodies.member_count[body];
        for (uint32_t k = 0; k < count; k++)
            parts[k] = m->blocks.shape[members[k]];
        status = tl_poly_share_planes(parts, count, &m->error);
    }
    free(parts);
    return status;
}

/* The lists that follow from the rows. */
static tl_status derive_rows(tl_model *m)
{
    const uint64_t structure = m->structure;
    if (!tl_rows_reserve(m, m->blocks.table.rows))
        return tl_fail_memory(&m->error);
    tl_rows_refresh(m);
    m->structure = structure;
    return share_planes(m);
}

static tl_status read_rows(tl_model *m, const tl_archive *a)
{
    reader r = {.archive = a};
    if (!hold_columns(m, a))
        return tl_fail_memory(&m->error);
    tl_model_walk(m, &(tl_walk){read_entry, &r});
    tl_status status = told(&r, m);
    if (status == TL_OK && m->loads_changed && m->bodies.table.rows == 0 && !tl_bodies_hold_loads(&m->bodies))
        status = tl_fail_memory(&m->error); /* files have no columns without rows */
    if (status == TL_OK)
        status = read_names(m, a, "groups", take_group);
    if (status == TL_OK)
        status = read_names(m, a, "joints.names", take_joint);
    if (status == TL_OK)
        status = read_planes(m, a);
    if (status == TL_OK)
        status = unsound(a, m, rows_unsound(m, m->group_count, tl_archive_items(a, "drives")));
    return status;
}

/* ---------------------------------------------------------------- step ------------------- */

static bool is_row(uint32_t row, size_t rows)
{
    return row < rows || row == TL_NO_ROW;
}

/* Forgets what is known of rows that have gone since it was found, as it will be found again before it is used. */
static void forget_stale(const tl_model *m, struct tl_cycle *c)
{
    size_t bodies = m->bodies.table.rows;
    if (!is_row(c->sums.worst, bodies))
        c->sums.worst = TL_NO_ROW;
    if (!is_row(c->added.worst, bodies))
        c->added.worst = TL_NO_ROW;
    if (!is_row(c->step_bounds.lightest, bodies))
        c->step_bounds.version = 0;
    if (!is_row(c->stiffness_rates.body, bodies))
        c->stiffness_rates.version = 0;
    uint32_t held = 0;
    for (size_t body = 0; body < bodies; body++) {
        uint32_t *row = &c->reaction_of[body], listed = m->bodies.fixed[body] ? held++ : TL_NO_ROW;
        bool there = *row == TL_NO_ROW || *row < c->reaction_capacity;
        if (*row != listed || !there)
            c->reactions_for = 0; /* list them anew */
        if (!there)
            *row = TL_NO_ROW;
    }
}

/* The same of what the phases of a step keep; what is known there of rows that have gone is forgotten. */
static const char *cycle_unsound(const tl_model *m, struct tl_cycle *c)
{
    forget_stale(m, c);
    bool sound = c->dt >= 0 && isfinite(c->dt) && tl_is_flag(&c->ledger.started);
    for (size_t k = 0; k < TL_MOST_CONTRIBUTORS; k++)
        sound = sound && memchr(c->ledger.term[k].name, '\0', TL_TERM_NAME);
    return sound ? NULL : "what a step keeps has an impossible value";
}

/* ---------------------------------------------------------------- the rest --------------- */

/* Makes the columns of contact points that laws and initial forces have. */
static tl_status hold_points(tl_model *m, tl_detect *d, const tl_archive *a)
{
    uint32_t columns;
    bool initial;
    if (!tl_archive_get(a, "detect.points.state_columns", &columns, sizeof columns, 1) || columns > TL_STATE_COLUMNS ||
        !tl_archive_get(a, "detect.points.initial", &initial, sizeof initial, 1) || !tl_is_flag(&initial))
        return tl_archive_bad(a, &m->error, "'detect.points' is missing or does not fit");
    bool held = tl_detect_hold_states(d, columns) && (!initial || tl_detect_hold_initial(d)) &&
                (!tl_archive_find(a, "detect.contacts.heat") || tl_detect_hold_carriers(d));
    return held ? TL_OK : tl_fail_memory(&m->error);
}

/* Columns of states that the laws need. */
static uint32_t states_needed(const tl_model *m)
{
    uint32_t most = 0;
    for (size_t i = 0; i < m->joint_law_count; i++)
        most = m->joint_laws[i].columns > most ? m->joint_laws[i].columns : most;
    return most;
}

static tl_status read_detection(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "detect.structure"))
        return TL_OK;
    tl_detect *d = tl_detect_make((unsigned)m->config.threads, tl_contact_kinds, TL_FACET_KINDS);
    if (!d)
        return tl_fail_memory(&m->error);
    m->detect = d;
    m->detect_destroy = tl_detect_destroy;
    tl_status status = hold_points(m, d, a);
    if (status != TL_OK)
        return status;
    uint32_t columns = d->points.state_columns;
    bool initial = d->points.initial;
    reader r = {.archive = a};
    tl_detect_walk(d, &(tl_walk){read_entry, &r});
    status = told(&r, m);
    if (status != TL_OK)
        return status;
    d->points.state_columns = columns;
    d->points.initial = initial;
    unsigned char *used = calloc(d->press_count + 1, 1);
    if (!used)
        return tl_fail_memory(&m->error);
    const char *bad = columns < states_needed(m) ? "states of the laws are missing" : tl_detect_unsound(m, d, used);
    free(used);
    if (bad)
        return unsound(a, m, bad);
    tl_contacts_unlist(d);
    bool edited = d->structure != m->structure; /* all is listed anew before it is next used */
    return tl_detect_make_lanes(d, &d->layout) && (edited || tl_contacts_index(m)) ? TL_OK : tl_fail_memory(&m->error);
}

/* Makes the columns that few meshes have. */
static bool hold_gridpoints(tl_gridpoints *p, const tl_archive *a)
{
    const bool load = tl_archive_find(a, "zones.points.load[k]"), damped = tl_archive_find(a, "zones.points.alpha");
    const bool before = tl_archive_find(a, "zones.points.force_before[k]");
    const bool pushed = tl_archive_find(a, "zones.points.pushed[k]"),
               quiet = tl_archive_find(a, "zones.points.quiet[k]");
    const bool held = tl_archive_find(a, "zones.points.held[d][k]"), drive = tl_archive_find(a, "zones.points.drive");
    return (!load || tl_gridpoints_hold_loads(p)) && (!damped || tl_gridpoints_hold_damping(p, before)) &&
           (!pushed || tl_gridpoints_hold_pushed(p)) && (!quiet || tl_gridpoints_hold_quiet(p)) &&
           (!held || tl_gridpoints_hold_directions(p)) && (!drive || tl_gridpoints_hold_drives(p));
}

/* Whether gridpoints follow drives that there are. */
static bool drives_fit(const struct tl_zones *z, size_t drives)
{
    bool fit = true;
    for (size_t row = 0; z->points.drive && row < z->points.table.rows; row++)
        fit = fit && z->points.drive[row] <= drives;
    for (size_t k = 0; k < z->outer_count; k++)
        fit = fit && z->outer[k].drive <= drives;
    return fit;
}

static tl_status read_zones(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "zones.points.rows"))
        return TL_OK;
    tl_status status = tl_zones_begin(m);
    if (status != TL_OK)
        return status;
    struct tl_zones *z = m->zones;
    if (!hold_gridpoints(&z->points, a))
        return tl_fail_memory(&m->error);
    const uint32_t columns = z->zones.state_columns; /* that the solids need */
    reader r = {.archive = a};
    tl_zones_walk(z, &(tl_walk){read_entry, &r});
    status = told(&r, m);
    if (status != TL_OK)
        return status;
    z->zones.state_columns = columns;
    const char *bad = tl_zones_unsound(m, z);
    if (!bad && !drives_fit(z, tl_archive_items(a, "drives")))
        bad = "a gridpoint follows no drive";
    if (bad)
        return unsound(a, m, bad);
    const bool enough = tl_grow(&z->slot, &z->slot_capacity, z->listed_count, sizeof *z->slot) && tl_zones_index(z, 0);
    z->followed = m->structure - 1; /* as if rows had moved */
    if (enough)
        tl_zones_follow(m);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

static tl_status read_segments(tl_model *m, const tl_archive *a)
{
    if (!m->zones || !tl_archive_find(a, "segments.table.rows"))
        return TL_OK;
    uint32_t saved; /* fewer than the laws need where one was set since the segments were laid */
    if (!tl_archive_get(a, "segments.points.state_columns", &saved, sizeof saved, 1) || saved > TL_STATE_COLUMNS)
        return tl_archive_bad(a, &m->error, "'segments.points' is missing or does not fit");
    if (!tl_segments_begin(m) || !tl_segments_hold_states(m->segments, saved))
        return tl_fail_memory(&m->error);
    if (tl_archive_find(a, "segments.points.f_n0") && !tl_segments_hold_initial(m->segments))
        return tl_fail_memory(&m->error);
    const uint32_t columns = m->segments->points.state_columns;
    reader r = {.archive = a};
    tl_segments_walk(m->segments, &(tl_walk){read_entry, &r});
    tl_status status = told(&r, m);
    if (status != TL_OK)
        return status;
    m->segments->points.state_columns = columns;
    const char *bad = tl_segments_unsound(m, m->segments);
    if (bad)
        return unsound(a, m, bad);
    return tl_segments_index(m) ? TL_OK : tl_fail_memory(&m->error);
}

/* Makes the columns that few nodes need. */
static bool hold_nodes(tl_node_table *n, const tl_archive *a)
{
    const bool moved = tl_archive_find(a, "elements.nodes.from[0]"), zones = tl_archive_find(a, "elements.nodes.share");
    const bool faces = tl_archive_find(a, "elements.nodes.outward[0]"), damped = tl_archive_find(a, "elements.nodes.c");
    const bool turned = tl_archive_find(a, "elements.nodes.normal[0]");
    const bool based = tl_archive_find(a, "elements.nodes.base[0]");
    return (!based || tl_nodes_hold_base(n)) && (!moved || tl_nodes_hold_from(n)) &&
           (!faces || tl_nodes_hold_normals(n, turned)) && (!zones || tl_nodes_hold_zones(n)) &&
           (!damped || tl_nodes_hold_damping(n));
}

static tl_status read_elements(tl_model *m, const tl_archive *a)
{
    if (!m->elements)
        return TL_OK;
    struct tl_elements *e = m->elements;
    uint32_t nodes, whole; /* columns: also those of kinds whose elements have gone */
    if (!tl_archive_get(a, "elements.nodes.state_columns", &nodes, sizeof nodes, 1) || nodes > TL_ELEMENT_COLUMNS ||
        !tl_archive_get(a, "elements.table.state_columns", &whole, sizeof whole, 1) || whole > TL_ELEMENT_COLUMNS)
        return tl_archive_bad(a, &m->error, "'elements' is missing or does not fit");
    if (!tl_elements_hold_states(e, nodes, whole) || !hold_nodes(&e->nodes, a))
        return tl_fail_memory(&m->error);
    const uint32_t had[2] = {e->nodes.state_columns, e->table.state_columns};
    reader r = {.archive = a};
    tl_elements_walk(e, &(tl_walk){read_entry, &r});
    const tl_status status = told(&r, m);
    if (status == TL_OK && (had[0] != e->nodes.state_columns || had[1] != e->table.state_columns))
        return unsound(a, m, "states of elements are missing");
    return status == TL_OK ? unsound(a, m, tl_elements_unsound(m)) : status;
}

static tl_status read_cycle(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "cycle.rows"))
        return TL_OK;
    tl_status status = tl_cycle_prepare(m);
    if (status != TL_OK)
        return status;
    size_t rows = m->cycle->table.rows;
    reader r = {.archive = a};
    tl_cycle_walk(m->cycle, &(tl_walk){read_entry, &r});
    status = told(&r, m);
    if (status != TL_OK)
        return status;
    if (m->cycle->table.rows != rows)
        return unsound(a, m, "what a step keeps does not fit the bodies");
    return unsound(a, m, cycle_unsound(m, m->cycle));
}

/* The shapes of seated pairs follow from the blocks and the list of pairs, which has been read. */
static tl_status read_seats(tl_model *m, const tl_archive *a)
{
    if (!tl_seats_sound(m))
        return unsound(a, m, "seated pairs do not fit their blocks");
    return tl_seats_follow(m) ? TL_OK : tl_fail_memory(&m->error);
}

static tl_status fill(tl_model *m, const tl_archive *a, const tl_drives_again *again)
{
    tl_status status = read_rows(m, a);
    for (const tl_state_part *const *part = tl_state_parts; *part && status == TL_OK; part++)
        status = (*part)->restore(m, a);
    if (status == TL_OK)
        status = derive_rows(m);
    if (status == TL_OK)
        status = read_seats(m, a);
    if (status == TL_OK)
        status = read_detection(m, a);
    if (status == TL_OK)
        status = read_zones(m, a);
    if (status == TL_OK)
        status = read_segments(m, a);
    if (status == TL_OK)
        status = read_elements(m, a);
    if (status == TL_OK)
        status = unsound(a, m, tl_carriers_unsound(m));
    if (status == TL_OK) /* gridpoints may follow them */
        status = tl_drives_restore(m, a, again);
    return status == TL_OK ? read_cycle(m, a) : status;
}

tl_status tl_model_restore_archive(const tl_archive *a, int64_t threads, tl_drive_again_fn again, void *user,
                                   tl_model **model, tl_error *error)
{
    tl_model *m;
    *model = NULL;
    tl_model_config config = tl_model_config_default();
    config.threads = threads;
    tl_status status = tl_model_create(&config, &m, error);
    if (status != TL_OK)
        return status;
    status = fill(m, a, &(tl_drives_again){again, user});
    if (status != TL_OK) {
        *error = m->error;
        tl_model_destroy(m);
        return status;
    }
    *model = m;
    return TL_OK;
}

tl_status tl_model_restore(const char *path, int64_t threads, tl_drive_again_fn again, void *user, tl_model **model,
                           tl_error *error)
{
    tl_archive a;
    *model = NULL;
    tl_status status = tl_archive_open(&a, path, error);
    if (status != TL_OK)
        return status;
    status = tl_model_restore_archive(&a, threads, again, user, model, error);
    tl_archive_close(&a);
    return status;
}

tl_status tl_model_of_bytes(unsigned char **bytes, size_t length, tl_model **model, tl_error *error)
{
    tl_archive a;
    *model = NULL;
    tl_status status = tl_archive_of_bytes(&a, "a copy in memory", *bytes, length, error);
    *bytes = NULL;
    if (status != TL_OK)
        return status;
    status = tl_model_restore_archive(&a, 1, NULL, NULL, model, error);
    tl_archive_close(&a);
    return status;
}
