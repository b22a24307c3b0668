/* life.c - the tables of elements come and go. */
#include "element/life.h"

#include "element/memory.h"
#include "element/set.h"

#include <stdlib.h>
#include <string.h>

static void add_columns(struct tl_elements *e)
{
    tl_element_table *t = &e->table;
    tl_table_init(&t->table, t);
    TL_COLUMN(&t->table, t, id, TL_COLUMN_STATE);
    TL_COLUMN(&t->table, t, set, 0);
    TL_COLUMN(&t->table, t, node_begin, 0);
    TL_COLUMN(&t->table, t, node_count, TL_COLUMN_STATE);
    TL_COLUMN(&t->table, t, flags, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&t->table, t, key, TL_COLUMN_STATE);
    TL_COLUMN(&t->table, t, stored, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&t->table, t, lost, TL_COLUMN_STEP);
    TL_COLUMN(&t->table, t, given, TL_COLUMN_STEP);

    tl_node_table *n = &e->nodes;
    tl_table_init(&n->table, n);
    TL_COLUMN(&n->table, n, block, TL_COLUMN_STATE);
    for (int k = 0; k < 3; k++) {
        TL_COLUMN(&n->table, n, rest[k], TL_COLUMN_STATE);
        TL_COLUMN(&n->table, n, local[k], TL_COLUMN_STATE);
        TL_COLUMN(&n->table, n, u[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
        TL_COLUMN(&n->table, n, force[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    }
    TL_COLUMN(&n->table, n, weight, TL_COLUMN_STATE);
    TL_COLUMN(&n->table, n, body, 0);
    TL_COLUMN(&n->table, n, k, 0);

    tl_steady_table *s = &e->steady;
    tl_table_init(&s->table, s);
    TL_COLUMN(&s->table, s, held, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, force, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, moment, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, magnitude, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, acts, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, turns, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, at, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, turn, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, from, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, odometer, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&s->table, s, given, TL_COLUMN_STEP);
}

bool tl_elements_begin(tl_model *m)
{
    if (m->elements)
        return true;
    m->elements = calloc(1, sizeof *m->elements);
    if (!m->elements)
        return false;
    m->elements_destroy = tl_elements_free;
    m->elements->next_id = 1;
    m->elements->version = 1;
    m->elements->asked = 1;
    add_columns(m->elements);
    return true;
}

void tl_elements_free(struct tl_elements *e)
{
    for (size_t k = 0; k < e->set_count; k++)
        tl_element_set_clear(&e->set[k]);
    tl_table_free(&e->table.table);
    tl_table_free(&e->nodes.table);
    tl_table_free(&e->steady.table);
    tl_elements_forget(e);
    void *const owned[] = {e->set, e->chunk, e->use, e->use_start, e->steady_start, e->carried};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(e);
}

uint32_t tl_element_row(const tl_model *m, tl_id id)
{
    const tl_element_table *t = m->elements ? &m->elements->table : NULL;
    uint32_t low = 0, high = t ? (uint32_t)t->table.rows : 0;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (t->id[middle] < id)
            low = middle + 1;
        else
            high = middle;
    }
    return t && low < t->table.rows && t->id[low] == id ? low : TL_NO_ROW;
}

/* Numbers the sets that stay: those that have elements, and those that had none before. */
static void number_sets(struct tl_elements *e, const unsigned char *keep)
{
    const tl_element_table *t = &e->table;
    uint32_t kept = 0;
    for (size_t k = 0; k < e->set_count; k++)
        e->set[k].number = 0;
    for (size_t row = 0; row < t->table.rows; row++) /* 1: it had some; 2: some stay */
        e->set[t->set[row]].number |= keep[row] ? 2 : 1;
    for (size_t k = 0; k < e->set_count; k++)
        e->set[k].number = e->set[k].number == 1 ? TL_NO_ROW : kept++;
}

/* Takes out the sets that have no number, and gives elements the numbers of the others. */
static void keep_sets(struct tl_elements *e)
{
    tl_element_table *t = &e->table;
    uint32_t kept = 0;
    for (size_t row = 0; row < t->table.rows; row++)
        t->set[row] = e->set[t->set[row]].number;
    for (size_t k = 0; k < e->set_count; k++)
        if (e->set[k].number == TL_NO_ROW)
            tl_element_set_clear(&e->set[k]);
        else
            e->set[kept++] = e->set[k];
    e->set_count = kept;
}

void tl_elements_keep(struct tl_elements *e, const unsigned char *keep, bool sets)
{
    tl_element_table *t = &e->table;
    uint32_t kept = 0;
    if (sets)
        number_sets(e, keep);
    for (size_t row = 0; row < t->table.rows; row++) {
        const uint32_t begin = t->node_begin[row];
        t->node_begin[row] = kept;
        for (uint32_t k = 0; keep[row] && k < t->node_count[row]; k++, kept++)
            if (kept != begin + k)
                tl_table_move(&e->nodes.table, kept, begin + k);
    }
    e->nodes.table.rows = kept;
    tl_table_keep(&t->table, keep);
    if (sets)
        keep_sets(e);
    e->version++;
}
