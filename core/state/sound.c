/* sound.c - whether the rows of a model that were read from a file fit together: numbers of rows are those of rows that are
 * there, choices are choices, bools are bools, and places are places. */
#include "state/sound.h"

#include "base/walk.h"

/* The square of a quaternion's length, and the sum of the sizes of a rotation's nine numbers (at most 3 sqrt 3), may be off by so
 * much: a rotation that the program has made is off by its roundings, some 1e-15. */
#define TURN_SLACK 0.01
#define MOST_MATRIX (5.2 + TURN_SLACK)

/* Changes that a model may have counted; no run comes near, and sums of such numbers do not overflow. */
#define MOST_CHANGES (UINT64_MAX / 8)

/* Cycles that a model may have run; further ones do not overflow. */
#define MOST_CYCLES (INT64_MAX / 8)

/* Contacts that a model may have had. */
#define MOST_CONTACTS (UINT32_MAX / 2)

/* Bits of `said`: one for each remark. */
#define ALL_REMARKS ((2u << TL_REMARK_UNDECIDED) - 1)

static bool settings_are_sound(const tl_model *m)
{
    const tl_model_config *c = &m->config;
    const tl_timestep *t = &m->timestep;
    bool steps = (isnan(t->fraction) || (t->fraction > 0 && t->fraction <= 1)) &&
                 (t->rule == TL_TIMESTEP_BODY || t->rule == TL_TIMESTEP_PAPER) &&
                 (isnan(t->dt) || (t->dt > 0 && isfinite(t->dt)));
    return tl_v3_finite(c->gravity) && tl_v3_finite(m->gravity_before) &&
           (!m->loads_changed || m->bodies.load_before) && c->rotation >= TL_ROTATION_EXACT &&
           c->rotation <= TL_ROTATION_PAPER && c->reuse_geometry >= 0 && c->reuse_geometry <= 1 &&
           c->contact_points >= 0 && c->contact_points <= TL_POINTS_CORNERS && steps &&
           tl_v3_finite(m->origin) && isfinite(m->time) && isfinite(m->dt) && m->dt >= 0 &&
           memchr(m->stage, 0, sizeof m->stage) && tl_text_is_clean(m->stage) && m->cycles >= 0 &&
           m->cycles <= MOST_CYCLES && m->gone == 0 && (m->said & ~ALL_REMARKS) == 0 &&
           !(m->added_dt <= 0) && !(m->added_most < 0) && m->structure <= MOST_CHANGES &&
           m->constraints <= MOST_CHANGES && m->laws <= MOST_CHANGES;
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
        sound = m->joint_min_areas[i].tag.joint <= m->joint_count &&
                rule_is_sound(&m->joint_min_areas[i].rule);
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

/* What blocks that were cut have left, what parts of faces are to get, and the ids by which contacts were asked for. */
static bool edits_are_sound(const tl_model *m)
{
    for (size_t i = 0; i < m->heir_count; i++) {
        const tl_heir *h = &m->heirs[i];
        if (h->id >= m->next_id || h->root == TL_NO_ID || h->root >= h->id ||
            (i && h->id <= h[-1].id) || !matrix_is_sound(&h->r) || !is_place(h->place))
            return false;
    }
    for (size_t i = 0; i < m->split_count; i++) {
        const tl_split *s = &m->splits[i];
        if (s->block == TL_NO_ID || s->block >= m->next_id || s->whole == TL_NO_ID ||
            s->whole >= m->next_id || (i && s->block <= s[-1].block))
            return false;
    }
    for (size_t i = 0; i < m->face_load_count; i++) {
        const tl_face_load *f = &m->face_loads[i];
        if (f->block == TL_NO_ID || f->block >= m->next_id || !tl_v3_finite(f->force) ||
            !tl_v3_finite(f->moment) || (i && f->block < f[-1].block))
            return false;
    }
    if (m->next_contact > MOST_CONTACTS)
        return false;
    for (size_t i = 0; i < m->asked_count; i++) {
        const tl_asked_id *q = &m->asked_ids[i];
        if (q->contact == 0 || q->contact > m->next_contact || q->a >= q->b ||
            (i && (q->a < q[-1].a || (q->a == q[-1].a && q->b <= q[-1].b))))
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
           isfinite(b->density[row]) && measure_is_sound(b->volume[row]) &&
           b->size[row] == tl_cbrt(b->volume[row]) && b->mean_face[row] > 0 &&
           isfinite(b->mean_face[row]) && b->hidden[row] <= 1 && b->stays[row] == 1 &&
           (!b->local || tl_v3_finite(b->local[row])) && base_is_sound(tl_block_base(m, row)) &&
           base_is_sound(tl_block_made(m, row));
}

/* Velocities and forces are any numbers: those of a model that overflows are saved as well, and the next step tells it. */
static bool body_is_sound(const tl_model *m, uint32_t row, size_t drives)
{
    const tl_bodies *b = &m->bodies;
    const tl_pose *p = &b->pose[row];
    tl_id least = row ? b->id[row - 1] + 1 : 1;
    bool placed = is_place(p->x_ref) && is_place(p->u) && matrix_is_sound(&p->r) &&
                  is_turn(b->q[row]) && is_turn(b->axes[row]);
    tl_vec3 i = b->moments[row];
    bool heavy = measure_is_sound(b->mass[row]) && measure_is_sound(i.x) && measure_is_sound(i.y) &&
                 measure_is_sound(i.z) && measure_is_sound(b->round[row]) && b->radius[row] > 0 &&
                 isfinite(b->radius[row]);
    return b->id[row] >= least && placed && heavy && !(b->odometer[row] < 0) &&
           b->fixed[row] <= TL_FIX_ALL && b->drive[row] <= drives &&
           (!b->load || (tl_v3_finite(b->load[row].force) && tl_v3_finite(b->load[row].moment) &&
                         tl_v3_finite(b->load[row].arm)));
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

const char *tl_rows_unsound(const tl_model *m, size_t groups, size_t drives)
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

const char *tl_cycle_unsound(const tl_model *m, struct tl_cycle *c)
{
    forget_stale(m, c);
    bool sound = c->dt >= 0 && isfinite(c->dt) && c->ledger && tl_ledger_is_sound(c->ledger);
    return sound ? NULL : "what a step keeps has an impossible value";
}
