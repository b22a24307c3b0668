/* loads.c - what acts on bodies from outside: loads, prescribed motion (drives), and what holds them. */
#include "model/loads.h"

#include "model/deformable.h"
#include "model/inertia.h"
#include "model/options.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- tractions on faces ----- */

tl_lump tl_face_plate(const tl_model *m, uint32_t row, uint32_t face)
{
    const tl_poly *p = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row], first = p->start[face];
    const tl_mat3 *r = &m->bodies.pose[body].r;
    tl_vec3 at = tl_m3_mul(r, p->vertex[p->loop[first]]);
    tl_lump out = {.mass = 0};
    double square[6] = {0}; /* of places from the first corner */
    for (uint32_t i = first + 1; i + 1 < p->start[face + 1]; i++) {
        tl_vec3 e = tl_v3_sub(tl_m3_mul(r, p->vertex[p->loop[i]]), at);
        tl_vec3 f = tl_v3_sub(tl_m3_mul(r, p->vertex[p->loop[i + 1]]), at);
        double third = tl_v3_norm(tl_v3_cross(e, f)) / 6;
        const tl_vec3 middle[3] = {tl_v3_scale(0.5, e), tl_v3_scale(0.5, tl_v3_add(e, f)), tl_v3_scale(0.5, f)};
        for (int k = 0; k < 3; k++) {
            tl_vec3 x = middle[k];
            const double products[] = {x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.y * x.z, x.z * x.x};
            out.mass += third;
            out.place = tl_v3_madd(out.place, third, x);
            for (int j = 0; j < 6; j++)
                square[j] += third * products[j];
        }
    }
    if (out.mass > 0)
        out.place = tl_v3_scale(1 / out.mass, out.place);
    tl_vec3 c = out.place;
    const double own[] = {c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.y * c.z, c.z * c.x};
    for (int j = 0; j < 6; j++)
        square[j] -= out.mass * own[j];
    out.inertia = (tl_sym3){
        square[1] + square[2], square[2] + square[0], square[0] + square[1], -square[3], -square[4], -square[5]};
    out.place = tl_v3_add(tl_body_place(&m->bodies, body), tl_v3_add(at, c));
    return out;
}

/* ---------------------------------------------------------------- the list --------------- */

static int compare(const void *x, const void *y)
{
    const tl_face_load *p = x, *q = y;
    return p->block != q->block ? (p->block > q->block) - (p->block < q->block)
                                : (p->face > q->face) - (p->face < q->face);
}

void tl_face_loads_set(tl_model *m, tl_face_load *list, size_t count, size_t capacity)
{
    size_t kept = 0;
    if (count > 1)
        qsort(list, count, sizeof *list, compare);
    for (size_t i = 0; i < count; i++) {
        tl_face_load *last = kept ? &list[kept - 1] : NULL;
        if (tl_block_row_quiet(m, list[i].block) == TL_NO_ROW)
            continue;
        if (last && compare(last, &list[i]) == 0) {
            last->force = tl_v3_add(last->force, list[i].force);
            last->moment = tl_v3_add(last->moment, list[i].moment);
        } else {
            list[kept++] = list[i];
        }
    }
    if (list != m->face_loads)
        free(m->face_loads);
    m->face_loads = list;
    m->face_load_count = kept;
    m->face_load_capacity = capacity;
}

/* Forgets those of the bodies of blocks; false when out of memory (nothing changed). */
static bool face_loads_forget(tl_model *m, const tl_id *ids, size_t count)
{
    size_t kept = 0;
    if (m->face_load_count == 0)
        return true;
    uint8_t *meant = calloc(m->bodies.table.rows + 1, sizeof *meant);
    if (!meant)
        return false;
    for (size_t i = 0; i < count; i++)
        meant[m->blocks.body[tl_block_row_quiet(m, ids[i])]] = 1;
    for (size_t i = 0; i < m->face_load_count; i++) {
        uint32_t row = tl_block_row_quiet(m, m->face_loads[i].block);
        if (row != TL_NO_ROW && !meant[m->blocks.body[row]])
            m->face_loads[kept++] = m->face_loads[i];
    }
    m->face_load_count = kept;
    free(meant);
    return true;
}

/* ---------------------------------------------------------------- loads ------------------- */

bool tl_bodies_hold_loads(tl_bodies *b)
{
    return TL_COLUMN_NEED(&b->table, b, load_before, 0) && TL_COLUMN_NEED(&b->table, b, load, 0);
}

/* Notes the loads of the last step, before the first of them is set anew. */
static void note_loads(tl_model *m)
{
    if (!(m->dt > 0) || m->loads_changed)
        return;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        m->bodies.load_before[body] = tl_load_wrench(&m->bodies, body);
    m->loads_changed = true;
}

void tl_load_begins_anew(tl_model *m, uint32_t body)
{
    if (!m->bodies.load_before || !(m->dt > 0))
        return;
    note_loads(m);
    m->bodies.load_before[body].force = tl_v3(NAN, NAN, NAN);
}

/* Whether all blocks live, and deformable ones can take the load; makes room in these. */
static tl_status check_loaded(tl_model *m, const tl_id *ids, size_t count, const tl_load *load)
{
    tl_status status = tl_blocks_check(m, ids, count);
    bool some = false;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        const uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        const bool zoned = m->bodies.mesh[body];
        some = some || zoned;
        if (zoned)
            status = m->zone_verbs->check_load(m, body, load);
    }
    return status == TL_OK && some && !m->zone_verbs->hold_loads(m) ? tl_fail_memory(&m->error) : status;
}

tl_status tl_blocks_load(tl_model *m, const tl_id *ids, size_t count, const tl_load *given)
{
    tl_load load;
    tl_status status = TL_OPTIONS_READ(tl_load, given, &load, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "load blocks");
    if (status != TL_OK)
        return status;
    bool placed = !isnan(load.at.x);
    if (!tl_v3_finite(load.force) || !tl_v3_finite(load.moment) || (placed && !tl_v3_finite(load.at)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "load: force, moment and at must be finite numbers");
    status = check_loaded(m, ids, count, &load);
    if (status != TL_OK)
        return status;
    if (count && (!tl_bodies_hold_loads(&m->bodies) || !face_loads_forget(m, ids, count)))
        return tl_fail_memory(&m->error);
    if (count)
        note_loads(m);
    for (size_t i = 0; i < count; i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        if (m->bodies.mesh[body]) {
            m->zone_verbs->load(m, body, &load);
            continue;
        }
        tl_vec3 from = tl_v3_sub(tl_v3_sub(load.at, m->origin), tl_body_place(&m->bodies, body));
        m->bodies.load[body] = (tl_body_load){load.force, load.moment,
                                              placed ? tl_m3_tmul(&m->bodies.pose[body].r, from) : tl_v3(0, 0, 0)};
        if (m->bodies.fixed[body])
            tl_load_begins_anew(m, body);
    }
    m->constraints++; /* not as it was in the last step */
    return TL_OK;
}

/* ---------------------------------------------------------------- motions that users set --- */

static bool is_motion(tl_vec3 v)
{
    return fabs(v.x) <= TL_FASTEST && fabs(v.y) <= TL_FASTEST && fabs(v.z) <= TL_FASTEST;
}

static tl_status bad_motion(tl_error *error, const char *verb, const char *name, tl_vec3 v, const char *unit)
{
    return tl_fail(error, TL_E_ARGUMENT,
                   "%s: %s = {%g, %g, %g} %s must be three finite numbers of at most %g: no model can run with more",
                   verb, name, v.x, v.y, v.z, unit, TL_FASTEST);
}

tl_status tl_check_motion(tl_error *error, const char *verb, tl_vec3 velocity, tl_vec3 angular_velocity)
{
    if (!is_motion(velocity))
        return bad_motion(error, verb, "velocity", velocity, "m/s");
    if (!is_motion(angular_velocity))
        return bad_motion(error, verb, "angular_velocity", angular_velocity, "rad/s");
    return TL_OK;
}

/* ---------------------------------------------------------------- drives ----------------- */

static void hold_records(const tl_drive *drive)
{
    for (int k = 0; k < 3; k++)
        tl_record_hold(drive->record[k]);
}

void tl_drive_let_records_go(tl_drive *drive)
{
    for (int k = 0; k < 3; k++) {
        tl_record_let_go((tl_record *)(uintptr_t)drive->record[k]);
        drive->record[k] = NULL;
    }
}

bool tl_drive_has_record(const tl_drive *drive)
{
    return drive->record[0] || drive->record[1] || drive->record[2];
}

static void release(tl_drive_record *record)
{
    tl_drive_let_records_go(&record->drive);
    if (record->drive.release)
        record->drive.release(record->drive.user);
    *record = (tl_drive_record){0};
}

void tl_drive_leave(tl_model *m, uint32_t body)
{
    uint32_t index = m->bodies.drive[body];
    if (index == 0)
        return;
    m->bodies.drive[body] = 0;
    if (--m->drives[index - 1].bodies == 0 && !m->drives[index - 1].held)
        release(&m->drives[index - 1]);
    if (m->bodies.mesh[body]) {
        m->zone_verbs->free(m, body);
        return;
    }
    m->bodies.fixed[body] = 0;
    tl_load_begins_anew(m, body);
}

void tl_drives_recount(tl_model *m)
{
    for (size_t i = 0; i < m->drive_count; i++)
        m->drives[i].bodies = 0;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.drive[body])
            m->drives[m->bodies.drive[body] - 1].bodies++;
    if (m->zone_verbs)
        m->zone_verbs->count_drives(m);
}

void tl_drives_hold(tl_model *m, bool hold)
{
    if (hold) {
        for (size_t i = 0; i < m->drive_count; i++)
            m->drives[i].held = m->drives[i].bodies > 0;
        return;
    }
    tl_drives_recount(m);
    for (size_t i = 0; i < m->drive_count; i++) {
        bool held = m->drives[i].held;
        m->drives[i].held = false;
        if (held && m->drives[i].bodies == 0)
            release(&m->drives[i]);
    }
}

uint32_t tl_drive_new(tl_model *m, const tl_drive *drive)
{
    size_t i = 0;
    while (i < m->drive_count && m->drives[i].bodies > 0)
        i++;
    if (i == m->drive_count) {
        tl_drive_record *drives = realloc(m->drives, (m->drive_count + 1) * sizeof *drives);
        if (!drives)
            return 0;
        m->drives = drives;
        m->drives[m->drive_count++] = (tl_drive_record){0};
    }
    release(&m->drives[i]); /* that of gridpoints that have gone, or none */
    m->drives[i].drive = *drive;
    m->drives[i].drive.record_begin = m->time;
    hold_records(drive);
    m->drives[i].velocity = drive->velocity;
    m->drives[i].angular_velocity = drive->angular_velocity;
    return (uint32_t)i + 1;
}

void tl_drive_follow(tl_model *m, uint32_t body, uint32_t index)
{
    tl_drive_record *record = &m->drives[index - 1];
    if (m->bodies.drive[body] == index)
        return;
    record->bodies++; /* held while the body leaves its old drive */
    tl_drive_leave(m, body);
    m->bodies.drive[body] = index;
    if (m->bodies.mesh[body]) {
        m->zone_verbs->free(m, body);
        m->zone_verbs->fix(m, body, TL_FIX_ALL);
        m->zone_verbs->move(m, body, record->drive.velocity, record->drive.angular_velocity);
        return;
    }
    m->bodies.fixed[body] = TL_FIX_ALL;
    m->bodies.v[body] = record->drive.velocity;
    m->bodies.w[body] = record->drive.angular_velocity;
}

bool tl_drive_has_gradient(const tl_drive *drive)
{
    bool some = false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            some = some || drive->gradient[i][j] != 0;
    return some;
}

tl_status tl_blocks_drive(tl_model *m, const tl_id *ids, size_t count, const tl_drive *given)
{
    tl_drive drive;
    tl_status status = TL_OPTIONS_READ(tl_drive, given, &drive, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "drive blocks");
    if (status != TL_OK)
        return status;
    status = tl_check_motion(&m->error, "drive", drive.velocity, drive.angular_velocity);
    if (status == TL_OK && tl_drive_has_gradient(&drive))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "drive: a gradient of velocity drives gridpoints, not blocks");
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    if (status != TL_OK)
        return status;
    if (count == 0) {
        if (drive.release)
            drive.release(drive.user);
        return TL_OK;
    }
    const uint32_t index = tl_drive_new(m, &drive);
    if (!index)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        tl_drive_follow(m, m->blocks.body[tl_block_row_quiet(m, ids[i])], index);
    m->constraints++;
    return TL_OK;
}

/* The constant velocity with that of the records at a time of the model. */
static tl_vec3 recorded_velocity(const tl_drive *drive, double t)
{
    tl_vec3 v = drive->velocity;
    for (int k = 0; k < 3; k++)
        (&v.x)[k] += drive->record[k] ? tl_record_velocity(drive->record[k], t - drive->record_begin) : 0;
    return v;
}

bool tl_drives_evaluate(tl_model *m, double t)
{
    bool known = true;
    m->running = m->driving = true;
    for (size_t i = 0; i < m->drive_count && known; i++) {
        tl_drive_record *r = &m->drives[i];
        const tl_drive *d = &r->drive;
        if (r->bodies > 0 && tl_drive_has_record(d))
            r->velocity = recorded_velocity(d, t);
        if (r->bodies > 0 && d->velocity_at)
            known = d->velocity_at(d->user, t, &r->velocity);
        if (r->bodies > 0 && d->angular_velocity_at && known)
            known = d->angular_velocity_at(d->user, t, &r->angular_velocity);
    }
    m->running = m->driving = false;
    return known;
}

/* ---------------------------------------------------------------- what is held ----------- */

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
    if (m->bodies.mesh[body]) {
        m->zone_verbs->fix(m, body, what);
        return;
    }
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
    if (m->bodies.mesh[body]) {
        m->zone_verbs->free(m, body);
        return;
    }
    if (m->bodies.fixed[body] & what)
        tl_load_begins_anew(m, body);
    m->bodies.fixed[body] = (uint8_t)(m->bodies.fixed[body] & ~what);
}

/* Refuses to hold the rotation of deformable bodies, but with all the rest. */
static tl_status check_rotation(tl_model *m, const tl_id *ids, size_t count, unsigned what)
{
    if (!(what & TL_FIX_ROTATION) || what == TL_FIX_ALL)
        return TL_OK;
    return tl_blocks_check_rigid(m, ids, count, "fix rotations",
                                 "it has no rotation to hold: fix some of its gridpoints, or all of the block");
}

/* Lets the bodies of blocks go from their drives, and changes in what way they are held. */
static tl_status change_fixing(tl_model *m, const tl_id *ids, size_t count, const char *verb,
                               void (*change)(tl_model *, uint32_t, unsigned), unsigned what)
{
    tl_status status = tl_model_may_set(m, verb);
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    if (status == TL_OK && change == fix_body)
        status = check_rotation(m, ids, count, what);
    bool changed = false;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        constraint before = constraint_of(m, body);
        tl_drive_leave(m, body);
        change(m, body, what);
        changed = changed || m->bodies.mesh[body] || !has_constraint(m, body, before);
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
