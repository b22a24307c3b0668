/* store.c - the detection as a whole: made, copied, let go of, given columns and lanes, and its entries. */
#include "contact/store.h"

#include "base/entries.h"
#include "contact/index.h"

#include <stdlib.h>

/* Lanes a thread has at least, so that most contacts can grow without a new layout; and not a power of two, or rows of
 * all columns would lie in the same few lines of the nearest cache. */
#define LEAST_LANES 656

static void init_contacts(tl_contacts *c, tl_points_table *p)
{
    tl_table *t = &c->table;
    tl_table_init(t, c);
    TL_COLUMN(t, c, born, 0);
    TL_COLUMN(t, c, a, 0);
    TL_COLUMN(t, c, b, 0);
    TL_COLUMN(t, c, pair, 0);
    TL_COLUMN(t, c, tag, TL_COLUMN_STATE);
    TL_COLUMN(t, c, law, 0);
    TL_COLUMN(t, c, facet, TL_COLUMN_STEP);
    TL_COLUMN(t, c, kind, 0);
    TL_COLUMN(t, c, press, 0);
    TL_COLUMN(t, c, faces_valid_to, 0);
    TL_COLUMN(t, c, points_valid_to, 0);
    TL_COLUMN(t, c, spot, 0);
    TL_COLUMN(t, c, point_start, 0);
    TL_COLUMN(t, c, point_count, TL_COLUMN_STATE);
    TL_COLUMN(t, c, point_capacity, 0);
    TL_COLUMN(t, c, area, 0);
    TL_COLUMN(t, c, released, TL_COLUMN_STEP);
    TL_COLUMN(t, c, stored, TL_COLUMN_STEP);
    TL_COLUMN(t, c, handed_over, TL_COLUMN_STEP);
    TL_COLUMN(t, c, force, TL_COLUMN_STEP);
    TL_COLUMN(t, c, moment, TL_COLUMN_STEP);
    TL_COLUMN(t, c, holds_over_gap, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(t, c, new_points, TL_COLUMN_STEP);
    TL_COLUMN(t, c, pending, 0);
    TL_COLUMN(t, c, deep, 0);
    TL_COLUMN(t, c, held, 0);

    t = &p->table;
    tl_table_init(t, p);
    for (int k = 0; k < 3; k++)
        TL_COLUMN(t, p, p[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(t, p, key, 0);
    TL_COLUMN(t, p, area, TL_COLUMN_STATE);
    TL_COLUMN(t, p, f_n, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(t, p, flags, TL_COLUMN_STATE | TL_COLUMN_STEP);
    for (int k = 0; k < 3; k++)
        TL_COLUMN(t, p, f_s[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    p->state_columns = 0;
}

static void init_lanes(tl_point_lanes *l)
{
    tl_table *t = &l->table;
    tl_table_init(t, l);
    for (int k = 0; k < 3; k++) {
        TL_COLUMN(t, l, arm[k], 0);
        TL_COLUMN(t, l, normal[k], 0);
        TL_COLUMN(t, l, du_s[k], 0);
    }
    TL_COLUMN(t, l, closure, 0);
    TL_COLUMN(t, l, edge, 0);
    TL_COLUMN(t, l, apart, 0);
    TL_COLUMN(t, l, lift, 0);
    TL_COLUMN(t, l, hold, 0);
    TL_COLUMN(t, l, cell, 0);
    TL_COLUMN(t, l, du_n, 0);
    TL_COLUMN(t, l, stored, 0);
    TL_COLUMN(t, l, dissipated, 0);
    TL_COLUMN(t, l, zero, 0);
    for (int k = 0; k < 4 + TL_STATE_COLUMNS; k++)
        TL_COLUMN(t, l, before[k], 0);
    TL_COLUMN(t, l, flags_before, 0);
}

tl_detect *tl_detect_make(unsigned threads, const tl_contact_kind *const *kinds, uint32_t count)
{
    tl_detect *d = calloc(1, sizeof *d);
    if (!d)
        return NULL;
    d->kinds = kinds;
    d->kind_count = count;
    d->threads = threads;
    d->narrow = calloc(threads, sizeof *d->narrow);
    d->lanes = calloc(threads, sizeof *d->lanes);
    d->births = calloc(threads, sizeof *d->births);
    init_contacts(&d->contacts, &d->points);
    init_contacts(&d->spare, &d->spare_points);
    if (!d->narrow || !d->lanes || !d->births) {
        tl_detect_destroy(d);
        return NULL;
    }
    for (unsigned i = 0; i < threads; i++)
        init_lanes(&d->lanes[i]);
    d->narrow[0].deep = true; /* contacts that are copied or read into it may be marked: overlap.c */
    tl_contacts_unlist(d);
    return d;
}

void tl_cut_contacts_end(tl_detect *d)
{
    free(d->cut_contacts);
    free(d->cut_points);
    d->cut_contacts = NULL;
    d->cut_points = NULL;
    d->cut_count = d->cut_capacity = d->cut_point_count = d->cut_point_capacity = 0;
}

void tl_births_end(tl_detect *d)
{
    for (unsigned i = 0; d->births && i < d->threads; i++) {
        free(d->births[i].list);
        d->births[i] = (tl_births){.list = NULL};
    }
}

void tl_detect_destroy(tl_detect *d)
{
    tl_table_free(&d->contacts.table);
    tl_table_free(&d->spare.table);
    tl_table_free(&d->points.table);
    tl_table_free(&d->spare_points.table);
    for (unsigned i = 0; d->narrow && i < d->threads; i++)
        tl_narrow_scratch_free(&d->narrow[i]);
    for (unsigned i = 0; d->lanes && i < d->threads; i++)
        tl_table_free(&d->lanes[i].table);
    tl_births_end(d);
    free(d->births);
    free(d->narrow);
    free(d->lanes);
    free(d->press);
    free(d->pairs);
    free(d->chunks);
    free(d->odometer_0);
    free(d->known_blocks);
    tl_layout_free(&d->layout);
    free(d->path);
    free(d->touched);
    free(d->idle);
    free(d->by_block);
    free(d->by_block_start);
    tl_cut_contacts_end(d);
    free(d);
}

static bool hold_initial(tl_points_table *p)
{
    if (p->initial)
        return true;
    const tl_column columns[] = {TL_COLUMN_NEW(p, reference, TL_COLUMN_STEP), TL_COLUMN_NEW(p, f_n0, TL_COLUMN_STEP)};
    p->initial = tl_table_widen(&p->table, columns, 2);
    return p->initial;
}

/* Makes sure that one table of points has that many state columns; false when out of memory (nothing changed). */
static bool hold_states(tl_points_table *p, uint32_t columns)
{
    tl_column more[TL_STATE_COLUMNS];
    uint32_t count = 0;
    for (uint32_t k = p->state_columns; k < columns; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(p, state[k], TL_COLUMN_STEP);
    if (count && !tl_table_widen(&p->table, more, count))
        return false;
    p->state_columns += count;
    return true;
}

/* The spare table, in which nothing is kept, gets the columns of the other: with no rows that cannot fail. */
bool tl_detect_hold_initial(tl_detect *d)
{
    if (!hold_initial(&d->points))
        return false;
    tl_table_free(&d->spare_points.table);
    return hold_initial(&d->spare_points);
}

bool tl_detect_hold_states(tl_detect *d, uint32_t columns)
{
    if (!hold_states(&d->points, columns))
        return false;
    tl_table_free(&d->spare_points.table);
    return hold_states(&d->spare_points, columns);
}

static bool hold_carriers(tl_contacts *c)
{
    const tl_column columns[] = {TL_COLUMN_NEW(c, carrier[0], 0), TL_COLUMN_NEW(c, carrier[1], 0),
                                 TL_COLUMN_NEW(c, share, 0), TL_COLUMN_NEW(c, heat, 0)};
    for (size_t k = 0; k < c->table.column_count; k++)
        if (c->table.columns[k].offset == columns[0].offset)
            return true;
    return tl_table_widen(&c->table, columns, sizeof columns / sizeof *columns);
}

bool tl_detect_hold_carriers(tl_detect *d)
{
    if (d->contacts.heat)
        return true;
    if (!hold_carriers(&d->contacts))
        return false;
    tl_table_free(&d->spare.table);
    return hold_carriers(&d->spare);
}

/* Gives the threads' lanes room for `capacity` points; false when out of memory. */
static bool hold_lanes(tl_detect *d, size_t capacity)
{
    for (unsigned i = 0; i < d->threads; i++)
        if (!tl_table_resize(&d->lanes[i].table, capacity))
            return false;
    return true;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

bool tl_detect_make_lanes(tl_detect *d, const tl_layout *layout)
{
    size_t capacity = LEAST_LANES;
    for (size_t r = 0; r < layout->span_count; r++)
        for (size_t i = layout->spans[r].group_begin; i < layout->spans[r].group_end; i++)
            capacity = larger(capacity, (size_t)layout->groups[i].slots * TL_LANES);
    if (!hold_lanes(d, capacity))
        return false;
    d->lane_capacity = larger(capacity, d->lane_capacity);
    return true;
}

/* ---------------------------------------------------------------- entries ---------------- */

#define VALUE(keep, member) TL_WALK_VALUE(walk, TL_KEEP_##keep, "detect.", d, member)
#define FLAG(keep, member) TL_WALK_FLAG(walk, TL_KEEP_##keep, "detect.", d, member)
#define LIST(keep, member, count, capacity, bytes)                                                                     \
    TL_WALK_LIST(walk, TL_KEEP_##keep, "detect.", d, member, &d->count, &d->capacity, offsetof(tl_memory, bytes))
#define TABLE(keep, member, bytes)                                                                                     \
    tl_walk_table(walk, TL_KEEP_##keep, "detect." #member, &d->member.table, offsetof(tl_memory, bytes))

/* Pairs, and how far blocks have moved since they were listed. */
static void walk_pairs(tl_detect *d, const tl_walk *walk)
{
    LIST(CACHE, pairs, pair_count, pair_capacity, pairs);
    LIST(CACHE, chunks, chunk_capacity, chunk_capacity, pairs);
    FLAG(CACHE, listed);
    VALUE(CACHE, lists);
    VALUE(CACHE, reach);
    VALUE(CACHE, balance_left);
    LIST(CACHE, odometer_0, odometer_capacity, odometer_capacity, broad);
    LIST(CACHE, known_blocks, known_block_count, known_block_capacity, broad);
    LIST(CACHE, path, path_capacity, path_capacity, broad);
    VALUE(CACHE, longest_path);
    LIST(CACHE, touched, touched_capacity, touched_capacity, broad);
    FLAG(CACHE, any_touched);
    LIST(CACHE, idle, idle_capacity, idle_capacity, broad);
    FLAG(CACHE, any_idle);
}

static void walk_contacts(tl_detect *d, const tl_walk *walk)
{
    FLAG(STATE, stepped);
    FLAG(CACHE, rows_changed);
    FLAG(CACHE, any_without_rows);
    TABLE(STATE, contacts, contacts);
    VALUE(STATE, points.state_columns);
    FLAG(STATE, points.initial);
    TABLE(STATE, points, points);
    LIST(STATE, press, press_count, press_capacity, facets);
    VALUE(CACHE, press_free);
    LIST(STATE, cut_contacts, cut_count, cut_capacity, other);
    LIST(STATE, cut_points, cut_point_count, cut_point_capacity, other);
    VALUE(STATE, parted);
    VALUE(CACHE, laid_at);
    VALUE(CACHE, spare_share);
    LIST(CACHE, layout.spans, layout.span_count, layout.span_capacity, other);
    VALUE(CACHE, layout.laid_rows);
    VALUE(CACHE, layout.added_at);
    LIST(CACHE, layout.groups, layout.group_capacity, layout.group_capacity, index);
    TABLE(SCRATCH, spare, spare);
    TABLE(SCRATCH, spare_points, spare);
    LIST(DERIVED, by_block, by_block_capacity, by_block_capacity, index);
    LIST(DERIVED, by_block_start, by_start_capacity, by_start_capacity, index);
    VALUE(DERIVED, indexed);
}

void tl_detect_walk(tl_detect *d, const tl_walk *walk)
{
    VALUE(CACHE, structure);
    VALUE(CACHE, laws);
    VALUE(CACHE, rules);
    VALUE(CACHE, constraints);
    VALUE(CACHE, contact_points);
    walk_pairs(d, walk);
    walk_contacts(d, walk);
}

/* ---------------------------------------------------------------- copies ------------------
 *
 * A second detection in the same state as the first. Its own lists are made with the room that is in use only, and grow
 * when they have to. */

tl_detect *tl_detect_copy(const tl_detect *from)
{
    tl_detect *d = tl_detect_make(from->threads, from->kinds, from->kind_count);
    if (!d)
        return NULL;
    tl_entries entries = {.count = 0};
    tl_detect_walk((tl_detect *)(uintptr_t)from, &(tl_walk){tl_entries_note, &entries});
    tl_entries_copy copy = {.from = &entries};
    tl_detect_walk(d, &(tl_walk){tl_entries_take, &copy});
    d->spare_points.state_columns = d->points.state_columns; /* it has the same columns */
    d->spare_points.initial = d->points.initial;
    d->lane_capacity = from->lane_capacity;
    if (!copy.failed && hold_lanes(d, d->lane_capacity))
        return d;
    tl_detect_destroy(d);
    return NULL;
}
