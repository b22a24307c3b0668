/* loads.c - what acts on bodies from outside: loads, and prescribed motion (drives). */
#include "model/face_loads.h"
#include "model/model.h"
#include "model/options.h"
#include "model/wrench.h"

#include <stdlib.h>
#include <string.h>

static tl_status check_blocks(tl_model *m, const tl_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (tl_block_row(m, ids[i]) == TL_NO_ROW)
            return m->error.status;
    return TL_OK;
}

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

tl_status tl_blocks_load(tl_model *m, const tl_id *ids, size_t count, const tl_load *given)
{
    tl_load read;
    const tl_load *load = &read;
    tl_status status = TL_OPTIONS_READ(tl_load, given, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "load blocks");
    if (status != TL_OK)
        return status;
    bool placed = !isnan(load->at.x);
    if (!tl_v3_finite(load->force) || !tl_v3_finite(load->moment) ||
        (placed && !tl_v3_finite(load->at)))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "load: force, moment and at must be finite numbers");
    status = check_blocks(m, ids, count);
    if (status != TL_OK)
        return status;
    if (count && (!tl_bodies_hold_loads(&m->bodies) || !tl_face_loads_forget(m, ids, count)))
        return tl_fail_memory(&m->error);
    if (count)
        note_loads(m);
    for (size_t i = 0; i < count; i++) {
        uint32_t body = m->blocks.body[m->row_of[ids[i]]];
        tl_vec3 from = tl_v3_sub(tl_v3_sub(load->at, m->origin), tl_body_place(&m->bodies, body));
        m->bodies.load[body] =
            (tl_body_load){load->force, load->moment,
                           placed ? tl_m3_tmul(&m->bodies.pose[body].r, from) : tl_v3(0, 0, 0)};
        if (m->bodies.fixed[body])
            tl_load_begins_anew(m, body);
    }
    m->constraints++; /* not as it was in the last step */
    return TL_OK;
}

void tl_loads_stepped(tl_model *m)
{
    m->gravity_before = tl_v3(0, 0, 0);
    m->gravity_changed = m->loads_changed = false;
}

/* ---------------------------------------------------------------- drives ----------------- */

static void release(tl_drive_record *record)
{
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
    m->bodies.fixed[body] = 0;
    tl_load_begins_anew(m, body);
    if (--m->drives[index - 1].bodies == 0 && !m->drives[index - 1].held)
        release(&m->drives[index - 1]);
}

void tl_drives_recount(tl_model *m)
{
    for (size_t i = 0; i < m->drive_count; i++)
        m->drives[i].bodies = 0;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.drive[body])
            m->drives[m->bodies.drive[body] - 1].bodies++;
}

void tl_drives_hold(tl_model *m)
{
    for (size_t i = 0; i < m->drive_count; i++)
        m->drives[i].held = m->drives[i].bodies > 0;
}

void tl_drives_settle(tl_model *m)
{
    tl_drives_recount(m);
    for (size_t i = 0; i < m->drive_count; i++) {
        bool held = m->drives[i].held;
        m->drives[i].held = false;
        if (held && m->drives[i].bodies == 0)
            release(&m->drives[i]);
    }
}

void tl_drives_clear(tl_model *m)
{
    for (size_t i = 0; i < m->drive_count; i++)
        if (m->drives[i].bodies)
            release(&m->drives[i]);
    free(m->drives);
    m->drives = NULL;
    m->drive_count = 0;
}

/* An unused record, or a new one; NULL when out of memory. */
static tl_drive_record *new_record(tl_model *m)
{
    for (size_t i = 0; i < m->drive_count; i++)
        if (m->drives[i].bodies == 0)
            return &m->drives[i];
    tl_drive_record *drives = realloc(m->drives, (m->drive_count + 1) * sizeof *drives);
    if (!drives)
        return NULL;
    m->drives = drives;
    m->drives[m->drive_count] = (tl_drive_record){0};
    return &m->drives[m->drive_count++];
}

tl_status tl_blocks_drive(tl_model *m, const tl_id *ids, size_t count, const tl_drive *given)
{
    tl_drive read;
    const tl_drive *drive = &read;
    tl_status status = TL_OPTIONS_READ(tl_drive, given, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "drive blocks");
    if (status != TL_OK)
        return status;
    status = tl_check_motion(&m->error, "drive", drive->velocity, drive->angular_velocity);
    if (status == TL_OK)
        status = check_blocks(m, ids, count);
    if (status != TL_OK)
        return status;
    if (count == 0) {
        if (drive->release)
            drive->release(drive->user);
        return TL_OK;
    }
    tl_drive_record *record = new_record(m);
    if (!record)
        return tl_fail_memory(&m->error);
    record->bodies = 1; /* held while bodies leave their old drives */
    record->drive = *drive;
    record->velocity = drive->velocity;
    record->angular_velocity = drive->angular_velocity;
    uint32_t index = (uint32_t)(record - m->drives) + 1;
    for (size_t i = 0; i < count; i++) {
        uint32_t body = m->blocks.body[m->row_of[ids[i]]];
        if (m->bodies.drive[body] == index)
            continue;
        tl_drive_leave(m, body);
        m->bodies.drive[body] = index;
        m->bodies.fixed[body] = TL_FIX_ALL;
        m->bodies.v[body] = drive->velocity;
        m->bodies.w[body] = drive->angular_velocity;
        record->bodies++;
    }
    record->bodies--;
    m->constraints++;
    return TL_OK;
}

static bool evaluate(tl_model *m, double t)
{
    for (size_t i = 0; i < m->drive_count; i++) {
        tl_drive_record *r = &m->drives[i];
        if (r->bodies == 0)
            continue;
        const tl_drive *d = &r->drive;
        if ((d->velocity_at && !d->velocity_at(d->user, t, &r->velocity)) ||
            (d->angular_velocity_at && !d->angular_velocity_at(d->user, t, &r->angular_velocity)))
            return false;
    }
    return true;
}

bool tl_drives_evaluate(tl_model *m, double t)
{
    m->running = m->driving = true;
    bool told = evaluate(m, t);
    m->running = m->driving = false;
    return told;
}
