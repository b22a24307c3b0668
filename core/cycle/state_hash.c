/* state_hash.c - a digest of the mechanical state: places, velocities, forces and histories, shapes, laws,
 * damping and settings. Left out is what asking may change (contact ids) and what only saves work
 * (cached axes, the broad phase), for the results do not depend on it beyond the caches' margins. What follows from
 * the rest and lies in a row with it (a pose's matrix) does no harm. */
#include "cycle/cycle_room.h"

#include "base/hash.h"

#include <string.h>

static void hash_table(tl_hash *hash, const tl_table *table)
{
    for (size_t i = 0; i < table->column_count; i++)
        if (table->columns[i].flags & TL_COLUMN_STATE)
            tl_hash_bytes(hash, tl_table_data(table, i), table->rows * table->columns[i].size);
}

static void hash_row(tl_hash *hash, const tl_table *table, size_t row)
{
    for (size_t i = 0; i < table->column_count; i++) {
        size_t size = table->columns[i].size;
        if (table->columns[i].flags & TL_COLUMN_STATE)
            tl_hash_bytes(hash, (const char *)tl_table_data(table, i) + row * size, size);
    }
}

/* In the order of their blocks: which row and lane a contact has depends on when it was made. */
static void hash_contacts(tl_hash *hash, const tl_model *m)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    for (uint32_t block = 0; block < m->blocks.table.rows; block++)
        for (uint32_t e = d->by_block_start[block]; e < d->by_block_start[block + 1]; e++) {
            uint32_t contact = d->by_block[e];
            if (c->a[contact] != block)
                continue; /* it comes with its other block */
            tl_hash_word(hash, (uint64_t)m->blocks.id[block] << 32 | m->blocks.id[c->b[contact]]);
            hash_row(hash, &c->table, contact);
            for (uint32_t k = 0; k < c->point_count[contact]; k++)
                hash_row(hash, &d->points.table, tl_point_row(c, contact, k));
        }
}

static void hash_shape(tl_hash *hash, const tl_poly *p)
{
    tl_hash_bytes(hash, p->vertex, p->vertex_count * sizeof *p->vertex);
    tl_hash_bytes(hash, p->plane, p->face_count * sizeof *p->plane);
    tl_hash_bytes(hash, p->tag, p->face_count * sizeof *p->tag);
    tl_hash_bytes(hash, p->loop, p->start[p->face_count] * sizeof *p->loop);
}

static void hash_damping(tl_hash *hash, const tl_model *m)
{
    const tl_damping_ops *ops = m->damping->ops;
    const tl_bodies *b = &m->bodies;
    tl_hash_bytes(hash, m->damping_params, m->damping->params_size);
    tl_hash_bytes(hash, m->damping_state, m->damping->state_count * sizeof *m->damping_state);
    if (!ops->before)
        return;
    tl_hash_bytes(hash, b->force_before, b->table.rows * sizeof *b->force_before);
    tl_hash_bytes(hash, b->moment_before, b->table.rows * sizeof *b->moment_before);
}

tl_status tl_state_hash(tl_model *m, char text[33])
{
    tl_status status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    tl_hash hash = tl_hash_start();
    const double clock[] = {m->time,
                            m->dt,
                            m->origin.x,
                            m->origin.y,
                            m->origin.z,
                            m->config.gravity.x,
                            m->config.gravity.y,
                            m->config.gravity.z};
    tl_hash_bytes(&hash, clock, sizeof clock);
    tl_hash_word(&hash, (uint64_t)m->cycles);
    hash_table(&hash, &m->blocks.table);
    hash_table(&hash, &m->bodies.table);
    for (size_t row = 0; row < m->blocks.table.rows; row++)
        hash_shape(&hash, m->blocks.shape[row]);
    hash_contacts(&hash, m);
    for (size_t i = 0; i < m->material_count; i++) {
        tl_hash_word(&hash, (uint64_t)m->materials[i].tag.joint << 32 | m->materials[i].tag.plane);
        tl_hash_bytes(&hash, m->materials[i].kind->name, strlen(m->materials[i].kind->name));
        tl_hash_bytes(&hash, m->materials[i].params, m->materials[i].kind->params_size);
    }
    const double settings[] = {tl_timestep_fraction(m), m->timestep.rule, m->area.fraction,
                               m->config.rotation, m->mass_scaling};
    tl_hash_bytes(&hash, settings, sizeof settings);
    if (m->damping)
        hash_damping(&hash, m);
    tl_hash_text(&hash, text);
    return TL_OK;
}
