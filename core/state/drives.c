/* drives.c - drives of a copied or restored model. What a function of a script does is the script's: it is asked for
 * again. */

#include "state/drives.h"

#include "model/loads.h"
#include "model/record.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is kept of all drives; NULL when out of memory. */
static tl_drive_kept *keep_all(const tl_model *m)
{
    tl_drive_kept *all = calloc(m->drive_count + 1, sizeof *all);
    for (size_t i = 0; all && i < m->drive_count; i++) {
        const tl_drive_record *record = &m->drives[i];
        const tl_drive *drive = &record->drive;
        all[i].velocity = drive->velocity;
        all[i].angular_velocity = drive->angular_velocity;
        all[i].velocity_now = record->velocity;
        all[i].angular_velocity_now = record->angular_velocity;
        all[i].velocity_asked = drive->velocity_at != NULL;
        all[i].angular_velocity_asked = drive->angular_velocity_at != NULL;
    }
    return all;
}

/* Whether gridpoints of a mesh follow a drive, or conditions on its surface name it. */
static bool has_driven(const struct tl_zones *z, const tl_body_mesh *mesh, size_t index)
{
    for (uint32_t row = mesh->point_begin; z->points.drive && row < mesh->point_end; row++)
        if (z->points.drive[row] == index)
            return true;
    for (size_t k = 0; k < z->outer_count; k++)
        if (z->outer[k].drive == index && z->outer[k].part >= mesh->part_begin && z->outer[k].part < mesh->part_end)
            return true;
    return false;
}

/* The lowest block that a drive, counted from 1, moves, and how many bodies. */
static tl_drive_asked asked_of(const tl_model *m, size_t index)
{
    tl_drive_asked asked = {.block = TL_NO_ID};
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.drive[body] != index)
            continue;
        if (asked.bodies++ == 0)
            asked.block = m->bodies.id[body];
    }
    for (size_t k = 0; m->zones && k < m->zones->mesh_count; k++) {
        const tl_body_mesh *mesh = &m->zones->mesh[k];
        if (m->bodies.drive[mesh->row] == index || !has_driven(m->zones, mesh, index))
            continue;
        if (asked.bodies == 0 || mesh->body < asked.block)
            asked.block = mesh->body;
        asked.bodies++;
    }
    return asked;
}

/* Asks for the functions of a drive that had some. */
static tl_status ask(tl_model *m, size_t index, const tl_drive_kept *kept, const tl_drive_record *from,
                     const tl_drives_again *again, tl_drive *drive)
{
    tl_drive_asked asked = asked_of(m, index);
    asked.velocity = kept->velocity_asked;
    asked.angular_velocity = kept->angular_velocity_asked;
    asked.from = from ? &from[index - 1].drive : NULL;
    tl_drive given = tl_drive_default();
    bool found = again->fn && again->fn(again->user, &asked, &given);
    drive->velocity_at = given.velocity_at;
    drive->angular_velocity_at = given.angular_velocity_at;
    drive->user = given.user;
    drive->release = given.release;
    if (found && !given.velocity_at == !asked.velocity && !given.angular_velocity_at == !asked.angular_velocity)
        return TL_OK;
    return tl_fail(
        &m->error, TL_E_STATE, "block %llu%s is driven by a function for its %s%s%s, which has to be given again",
        (unsigned long long)asked.block, asked.bodies > 1 ? " with others" : "", asked.velocity ? "velocity" : "",
        asked.velocity && asked.angular_velocity ? " and its " : "", asked.angular_velocity ? "angular_velocity" : "");
}

/* Of a copy: the same records, which it holds, too. */
static void share_records(tl_drive *drive, const tl_drive *from)
{
    for (int k = 0; k < 3; k++)
        drive->record[k] = tl_record_hold(from->record[k]);
    drive->record_begin = from->record_begin;
}

static void put_gradient(tl_drive *drive, const double gradient[3][3], tl_vec3 at)
{
    memcpy(drive->gradient, gradient, sizeof drive->gradient);
    drive->at = at;
}

/* `from` has the drives of the original, of a copy; of a file it is NULL. */
static tl_status make(tl_model *m, const tl_drive_kept *kept, size_t count, const tl_drive_record *from,
                      const tl_drives_again *again)
{
    if (count == 0)
        return TL_OK;
    m->drives = calloc(count, sizeof *m->drives);
    if (!m->drives)
        return tl_fail_memory(&m->error);
    m->drive_count = count;
    tl_drives_recount(m);
    for (size_t i = 0; i < count; i++) {
        tl_drive_record *record = &m->drives[i];
        if (record->bodies == 0)
            continue;
        record->drive = tl_drive_default();
        record->drive.velocity = kept[i].velocity;
        record->drive.angular_velocity = kept[i].angular_velocity;
        if (from)
            share_records(&record->drive, &from[i].drive);
        if (from)
            put_gradient(&record->drive, (const double(*)[3])from[i].drive.gradient, from[i].drive.at);
        record->velocity = kept[i].velocity_now;
        record->angular_velocity = kept[i].angular_velocity_now;
        if (!kept[i].velocity_asked && !kept[i].angular_velocity_asked)
            continue;
        tl_status status = ask(m, i + 1, &kept[i], from, again, &record->drive);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

static void save_gradients(const tl_model *m, tl_archive_writer *w)
{
    bool some = false;
    for (size_t i = 0; i < m->drive_count; i++)
        some = some || (m->drives[i].bodies > 0 && tl_drive_has_gradient(&m->drives[i].drive));
    if (!some)
        return;
    tl_gradient_kept *kept = calloc(m->drive_count, sizeof *kept);
    for (size_t i = 0; kept && i < m->drive_count; i++) {
        memcpy(kept[i].gradient, m->drives[i].drive.gradient, sizeof kept[i].gradient);
        kept[i].at = m->drives[i].drive.at;
    }
    if (kept)
        tl_archive_put(w, "drive_gradients", kept, sizeof *kept, m->drive_count);
    w->lost = w->lost || !kept;
    free(kept);
}

static tl_status restore_gradients(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "drive_gradients"))
        return TL_OK;
    tl_gradient_kept *kept = malloc((m->drive_count + 1) * sizeof *kept);
    if (!kept)
        return tl_fail_memory(&m->error);
    bool read = tl_archive_get(a, "drive_gradients", kept, sizeof *kept, m->drive_count);
    for (size_t i = 0; read && i < m->drive_count; i++) {
        read = tl_v3_finite(kept[i].at);
        for (int k = 0; k < 9; k++)
            read = read && isfinite(kept[i].gradient[k / 3][k % 3]);
        put_gradient(&m->drives[i].drive, (const double(*)[3])kept[i].gradient, kept[i].at);
    }
    free(kept);
    return read ? TL_OK : tl_archive_bad(a, &m->error, "'drive_gradients' does not fit");
}

/* ---------------------------------------------------------------- records ----------------- */

/* A record is saved once, whatever follows it: its number is its place among those of all drives. */
typedef struct record_list {
    const tl_record **record;
    size_t count;
} record_list;

static uint32_t number_of(record_list *all, const tl_record *record)
{
    size_t k = 0;
    while (k < all->count && all->record[k] != record)
        k++;
    if (k == all->count)
        all->record[all->count++] = record;
    return (uint32_t)k + 1;
}

static void save_samples(const record_list *all, tl_archive_writer *w)
{
    tl_record_head *heads = calloc(all->count + 1, sizeof *heads);
    size_t count = 0;
    for (size_t i = 0; heads && i < all->count; i++) {
        const tl_record *r = all->record[i];
        heads[i] = (tl_record_head){r->dt, r->interval[0].velocity, r->count};
        count += r->count;
    }
    double(*samples)[2] = calloc(count + 1, sizeof *samples);
    size_t at = 0;
    for (size_t i = 0; samples && i < all->count; i++)
        for (size_t k = 0; k < all->record[i]->count; k++, at++) {
            samples[at][0] = all->record[i]->interval[k].from;
            samples[at][1] = all->record[i]->interval[k].to;
        }
    if (heads && samples) {
        tl_archive_put(w, "record_heads", heads, sizeof *heads, all->count);
        tl_archive_put(w, "record_samples", samples, sizeof *samples, count);
    }
    w->lost = w->lost || !heads || !samples;
    free(heads);
    free(samples);
}

static void save_records(const tl_model *m, tl_archive_writer *w)
{
    record_list all = {calloc(3 * m->drive_count + 1, sizeof *all.record), 0};
    tl_records_kept *kept = calloc(m->drive_count + 1, sizeof *kept);
    for (size_t i = 0; all.record && kept && i < m->drive_count; i++) {
        const tl_drive *drive = &m->drives[i].drive;
        kept[i].begin = drive->record_begin;
        for (int k = 0; k < 3; k++)
            kept[i].number[k] = m->drives[i].bodies > 0 && drive->record[k] ? number_of(&all, drive->record[k]) : 0;
    }
    w->lost = w->lost || !all.record || !kept;
    if (all.record && kept && all.count > 0) {
        tl_archive_put(w, "drive_records", kept, sizeof *kept, m->drive_count);
        save_samples(&all, w);
    }
    free(kept);
    free(all.record);
}

/* Makes the records of a file. false: they do not fit, or there is no memory. */
static bool make_records(const tl_archive *a, const tl_record_head *heads, size_t count, tl_record **out)
{
    const size_t items = tl_archive_items(a, "record_samples");
    double(*samples)[2] = malloc((items + 1) * sizeof *samples);
    bool fit = samples && tl_archive_get(a, "record_samples", samples, sizeof *samples, items);
    size_t at = 0;
    for (size_t i = 0; fit && i < count; i++) {
        const tl_record_head *h = &heads[i];
        fit = h->dt > 0 && isfinite(h->dt) && isfinite(h->velocity) && h->count > 0 && h->count <= items - at &&
              (out[i] = tl_record_new(h->dt, (size_t)h->count));
        for (size_t k = 0; fit && k < h->count; k++, at++) {
            out[i]->interval[k].from = samples[at][0];
            out[i]->interval[k].to = samples[at][1];
        }
        if (!fit)
            break;
        out[i]->interval[0].velocity = h->velocity;
        tl_record_integrate(out[i]);
        fit = tl_record_is_finite(out[i]);
    }
    free(samples);
    return fit && at == items;
}

static tl_status restore_records(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "drive_records"))
        return TL_OK;
    const size_t count = tl_archive_items(a, "record_heads");
    tl_records_kept *kept = calloc(m->drive_count + 1, sizeof *kept);
    tl_record_head *heads = calloc(count + 1, sizeof *heads);
    tl_record **record = calloc(count + 1, sizeof *record);
    bool fit = kept && heads && record && tl_archive_get(a, "drive_records", kept, sizeof *kept, m->drive_count) &&
               tl_archive_get(a, "record_heads", heads, sizeof *heads, count) && make_records(a, heads, count, record);
    for (size_t i = 0; fit && i < m->drive_count; i++) {
        m->drives[i].drive.record_begin = kept[i].begin;
        fit = isfinite(kept[i].begin);
        for (int k = 0; fit && k < 3; k++) {
            fit = kept[i].number[k] <= count;
            const bool used = fit && kept[i].number[k] > 0 && m->drives[i].bodies > 0;
            m->drives[i].drive.record[k] = used ? tl_record_hold(record[kept[i].number[k] - 1]) : NULL;
        }
    }
    for (size_t i = 0; record && i < count; i++)
        tl_record_let_go(record[i]);
    free(record);
    free(heads);
    free(kept);
    return fit ? TL_OK : tl_archive_bad(a, &m->error, "records of motion do not fit");
}

void tl_drives_save(const tl_model *m, tl_archive_writer *w)
{
    save_gradients(m, w);
    save_records(m, w);
    tl_drive_kept *kept = keep_all(m);
    if (kept)
        tl_archive_put(w, "drives", kept, sizeof *kept, m->drive_count);
    w->lost = w->lost || !kept;
    free(kept);
}

tl_status tl_drives_restore(tl_model *m, const tl_archive *a, const tl_drives_again *again)
{
    const size_t count = tl_archive_items(a, "drives");
    tl_drive_kept *kept = malloc((count + 1) * sizeof *kept);
    if (!kept)
        return tl_fail_memory(&m->error);
    bool read = tl_archive_get(a, "drives", kept, sizeof *kept, count);
    for (size_t i = 0; i < count && read; i++)
        read = tl_v3_finite(kept[i].velocity) && tl_v3_finite(kept[i].angular_velocity) &&
               tl_v3_finite(kept[i].velocity_now) && tl_v3_finite(kept[i].angular_velocity_now);
    tl_status status =
        read ? make(m, kept, count, NULL, again) : tl_archive_bad(a, &m->error, "'drives' is missing or does not fit");
    free(kept);
    if (status == TL_OK)
        status = restore_gradients(m, a);
    if (status == TL_OK)
        status = restore_records(m, a);
    if (status == TL_E_STATE)
        tl_error_prefix(&m->error, "cannot restore '%.200s': ", a->path);
    return status;
}

tl_status tl_drives_copy(tl_model *to, const tl_model *from, const tl_drives_again *again)
{
    tl_drive_kept *kept = keep_all(from);
    if (!kept)
        return tl_fail_memory(&to->error);
    tl_status status = make(to, kept, from->drive_count, from->drives, again);
    free(kept);
    return status;
}
