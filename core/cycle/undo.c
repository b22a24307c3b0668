/* undo.c - a step that a law or the damping fails is undone.
 *
 * Laws work on the columns of points in place. By the time one of them fails others have added the step's motion to
 * their shear forces. The same step made again would add it twice. So what laws and gather overwrite is kept, tile by
 * tile on the way, in steps in which something can fail:
 *
 *   - a plugin does not say that it never fails;
 *   - numbers are so large that a force may not be finite;
 *   - something was set by hand since the last step;
 *   - a body came near the limit of motion, or blocks may pass each other;
 *   - a given time step is not stable.
 *
 * Other steps of the laws and dampings that come with the program cost nothing more. Detection and the choice of the
 * step need no undoing, for made again in the same places they change nothing. The move cannot fail. */
#include "cycle/undo.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Cost only: steps after which the memory of a step that was kept once is given back. An edit is often followed by
 * others, and new memory costs more than the copies. */
#define FORGET_AFTER 64

/* The columns of a table that a step overwrites (TL_COLUMN_STEP), one after the other, each of the table's capacity. */
typedef struct shadow {
    char *memory;
    size_t capacity;  /* bytes */
    uint64_t columns; /* of the table, a bit each */
} shadow;

_Static_assert(TL_TABLE_COLUMNS <= 64, "each column has a bit");

/* Most tables of contributors. */
#define TABLES (TL_MOST_CONTRIBUTORS * TL_CONTRIBUTOR_TABLES)

struct tl_undo {
    bool keeps;       /* in this step */
    bool gathered;    /* bodies have been kept, too */
    bool lost;        /* a step failed and was not kept */
    bool once;        /* only because something was set by hand, a body is fast or the step is long */
    uint64_t version; /* of bodies and laws, in the last step that was made */
    int64_t kept_at;  /* steps made when a step was kept last */
    double dt;        /* that the user had fixed then; NAN: none */
    tl_vec3 gravity;  /* then */
    shadow bodies, loads;
    tl_table *table[TABLES]; /* of contributors, in their order, those of the step that was kept last */
    size_t table_count;
    shadow contributor[TABLES];
    tl_reaction *reaction;
    size_t reaction_capacity;
    tl_sums sums;
    double damping_state[TL_STATE_COLUMNS];
};

/* ---------------------------------------------------------------- shadows ---------------- */

static bool shadow_reserve(shadow *s, const tl_table *table)
{
    size_t row = 0;
    s->columns = 0;
    for (size_t i = 0; i < table->column_count; i++)
        if (table->columns[i].flags & TL_COLUMN_STEP) {
            s->columns |= (uint64_t)1 << i;
            row += table->columns[i].size;
        }
    return tl_fit(&s->memory, &s->capacity, row * table->capacity, 1);
}

static void shadow_free(shadow *s)
{
    free(s->memory);
    *s = (shadow){.memory = NULL};
}

/* Copies what is here to what is kept, or back. */
static void copy(void *here, void *kept, size_t bytes, bool back)
{
    if (bytes > 0)
        memcpy(back ? here : kept, back ? kept : here, bytes);
}

/* Copies rows of the table to its shadow, or back. */
static void shadow_copy(const shadow *s, const tl_table *table, size_t first, size_t count, bool back)
{
    char *kept = s->memory;
    for (uint64_t left = count ? s->columns : 0; left; left &= left - 1) {
        const tl_column *column = &table->columns[__builtin_ctzll(left)];
        size_t begin = first * column->size;
        char *here;
        memcpy(&here, (const char *)table->owner + column->offset, sizeof here);
        copy(here + begin, kept + begin, count * column->size, back);
        kept += table->capacity * column->size;
    }
}

/* ---------------------------------------------------------------- what is kept ----------- */

/* The shadow of a contributor's table: one that it named when room was made in this step. */
static shadow *shadow_of(struct tl_undo *u, const tl_table *table)
{
    size_t k = 0;
    while (k < u->table_count && u->table[k] != table)
        k++;
    assert(u->keeps && k < u->table_count);
    return &u->contributor[k];
}

void tl_undo_rows(tl_model *m, const tl_table *table, size_t first, size_t count, bool back)
{
    shadow_copy(shadow_of(m->cycle->undo, table), table, first, count, back);
}

/* Of the tables of those who do not keep rows of them themselves, or back of all. */
static void copy_contributors(tl_model *m, bool back)
{
    for (tl_contributors with = m->cycle->contributor; *with; with++) {
        tl_table *table[TL_CONTRIBUTOR_TABLES];
        size_t count = (*with)->tables ? (*with)->tables(m, table) : 0;
        if (!(*with)->put_back)
            for (size_t k = 0; k < count; k++)
                tl_undo_rows(m, table[k], 0, table[k]->rows, back);
        else if (back)
            (*with)->put_back(m);
    }
}

/* Makes room for their shadows. false: out of memory. */
static bool reserve_contributors(tl_model *m)
{
    struct tl_undo *u = m->cycle->undo;
    size_t all = 0;
    bool enough = true;
    for (tl_contributors with = m->cycle->contributor; *with; with++) {
        tl_table **table = &u->table[all];
        size_t count = (*with)->tables ? (*with)->tables(m, table) : 0;
        for (size_t k = 0; k < count; k++)
            enough = enough && shadow_reserve(&u->contributor[all + k], table[k]);
        all += count;
    }
    u->table_count = all;
    return enough;
}

/* Of the bodies, and of the sums over them. */
static void copy_bodies(tl_model *m, bool back)
{
    struct tl_cycle *c = m->cycle;
    struct tl_undo *u = c->undo;
    size_t held = 0, states = m->damping ? m->damping->state_count : 0;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        held += c->reaction_of[body] != TL_NO_ROW;
    shadow_copy(&u->bodies, &m->bodies.table, 0, m->bodies.table.rows, back);
    shadow_copy(&u->loads, &c->table, 0, c->table.rows, back);
    copy(c->reaction, u->reaction, held * sizeof *c->reaction, back);
    copy(m->damping_state, u->damping_state, states * sizeof *m->damping_state, back);
    copy(&c->sums, &u->sums, sizeof c->sums, back);
}

void tl_undo_keep_bodies(tl_model *m)
{
    struct tl_undo *u = m->cycle->undo;
    if (u->keeps)
        copy_bodies(m, false);
    u->gathered = true;
}

/* ---------------------------------------------------------------- steps ------------------ */

static uint64_t version_of(const tl_model *m)
{
    return 1 + m->structure + m->constraints + m->laws;
}

bool tl_set_by_hand(const tl_model *m)
{
    const struct tl_undo *u = m->cycle->undo;
    const tl_vec3 g = m->config.gravity;
    return !u || u->version != version_of(m) || !(u->dt == m->timestep.dt || (isnan(u->dt) && isnan(m->timestep.dt))) ||
           tl_v3_norm2(tl_v3_sub(u->gravity, g)) > 0;
}

bool tl_undo_keeps(const tl_model *m)
{
    return m->cycle->undo->keeps;
}

static bool contributors_may_fail(const tl_model *m)
{
    bool may = false;
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        may = may || ((*with)->may_fail && (*with)->may_fail(m));
    return may;
}

/* Whether contributors or damping may fail in any step. */
static bool may_fail(const tl_model *m)
{
    const tl_sums *last = &m->cycle->sums;
    bool tame = last->contact_force < TL_UNDO_TAME && last->max_speed2 < TL_UNDO_TAME &&
                tl_v3_norm2(m->config.gravity) < TL_UNDO_TAME;
    bool sure = !m->damping || m->relaxing || ((const tl_damping_ops *)m->damping->ops)->never_fails;
    return !tame || !sure || contributors_may_fail(m);
}

/* Gives back the memory in which steps are kept. */
static void forget(struct tl_undo *u)
{
    shadow_free(&u->bodies);
    shadow_free(&u->loads);
    for (size_t i = 0; i < TABLES; i++)
        shadow_free(&u->contributor[i]);
    free(u->reaction);
    u->reaction = NULL;
    u->reaction_capacity = 0;
}

tl_status tl_undo_begin(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (!c->undo && !(c->undo = calloc(1, sizeof *c->undo)))
        return tl_fail_memory(&m->error);
    if (c->undo->lost)
        return tl_fail(&m->error, TL_E_STATE,
                       "cycle %lld failed and could not be taken back, for a law or damping that says it never fails "
                       "did: make the model anew, or restore it, with a plugin that does not set never_fails",
                       (long long)m->cycles + 1);
    c->undo->keeps = c->undo->gathered = false;
    return TL_OK;
}

tl_status tl_undo_reserve(tl_model *m)
{
    struct tl_undo *u = m->cycle->undo;
    u->once = !may_fail(m);
    if (u->once && !m->cycle->fast && !m->cycle->long_step && !m->cycle->may_pass && !tl_set_by_hand(m))
        return TL_OK;
    u->keeps = reserve_contributors(m) && shadow_reserve(&u->bodies, &m->bodies.table) &&
               shadow_reserve(&u->loads, &m->cycle->table) &&
               tl_fit(&u->reaction, &u->reaction_capacity, m->cycle->reaction_capacity, sizeof *u->reaction);
    if (!u->keeps)
        return tl_fail_memory(&m->error);
    copy_contributors(m, false);
    return TL_OK;
}

void tl_undo_step(tl_model *m)
{
    struct tl_undo *u = m->cycle->undo;
    if (!u->keeps) {
        u->lost = true;
        return;
    }
    copy_contributors(m, true);
    if (u->gathered)
        copy_bodies(m, true);
}

void tl_undo_end(tl_model *m)
{
    struct tl_undo *u = m->cycle->undo;
    u->version = version_of(m);
    u->dt = m->timestep.dt;
    u->gravity = m->config.gravity;
    if (u->keeps)
        u->kept_at = m->cycles;
    if (u->once && m->cycles - u->kept_at >= FORGET_AFTER)
        forget(u);
}

void tl_undo_by_hand(tl_model *m)
{
    if (m->cycle && m->cycle->undo)
        m->cycle->undo->version = 0;
}

bool tl_undo_lost(const struct tl_cycle *c)
{
    return c->undo && c->undo->lost;
}

size_t tl_undo_bytes(const struct tl_cycle *c)
{
    const struct tl_undo *u = c->undo;
    if (!u)
        return 0;
    size_t bytes = sizeof *u + u->bodies.capacity + u->loads.capacity + u->reaction_capacity * sizeof *u->reaction;
    for (size_t i = 0; i < TABLES; i++)
        bytes += u->contributor[i].capacity;
    return bytes;
}

void tl_undo_free(struct tl_undo *u)
{
    if (u)
        forget(u);
    free(u);
}
