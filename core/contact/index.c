/* index.c - the contacts of each block, and contacts by their blocks.
 *
 * The contacts of block X are by_block[by_block_start[X] .. by_block_start[X + 1]), ascending by partner, which is the
 * order in which a body adds their forces. Where rows have changed or contacts have gone, all are listed anew; those
 * that are new are put in between the others, for in a large model some are born in most steps. */
#include "contact/index.h"

#include <stdlib.h>
#include <string.h>

/* A contact of a block. */
typedef struct entry {
    uint32_t block, partner, contact;
} entry;

static int compare_entries(const void *x, const void *y)
{
    const entry *p = x, *q = y;
    if (p->block != q->block)
        return p->block < q->block ? -1 : 1;
    return (p->partner > q->partner) - (p->partner < q->partner);
}

/* The pairs are sorted, so every block meets its lower partners before its higher ones, each in order. */
static void list_all(tl_detect *d, size_t blocks)
{
    memset(d->by_block_start, 0, (blocks + 2) * sizeof *d->by_block_start);
    uint32_t *start = d->by_block_start + 1; /* filling moves each start to its end */
    for (size_t c = 0; c < d->contacts.table.rows; c++) {
        start[d->contacts.a[c] + 1]++;
        start[d->contacts.b[c] + 1]++;
    }
    for (size_t row = 0; row < blocks; row++)
        start[row + 1] += start[row];
    for (size_t i = 0; i < d->pair_count; i++) {
        const tl_pair *p = &d->pairs[i];
        if (tl_pair_is_apart(p))
            continue;
        d->by_block[start[p->a]++] = p->contact;
        d->by_block[start[p->b]++] = p->contact;
    }
}

/* Puts sorted entries in between those that are listed: from the last one on, what lies behind it moves up. */
static void put_entries(tl_detect *d, size_t blocks, const entry *list, size_t count)
{
    uint32_t *start = d->by_block_start, *by_block = d->by_block;
    size_t end = start[blocks];
    for (size_t k = count; k-- > 0;) {
        const entry *e = &list[k];
        size_t at = start[e->block + 1] < end ? start[e->block + 1] : end;
        while (at > start[e->block] && tl_contact_partner(&d->contacts, by_block[at - 1], e->block) > e->partner)
            at--;
        memmove(&by_block[at + k + 1], &by_block[at], (end - at) * sizeof *by_block);
        by_block[at + k] = e->contact;
        end = at;
    }
    size_t before = 0;
    for (size_t row = list[0].block + 1u; row <= blocks; row++) {
        while (before < count && list[before].block < row)
            before++;
        start[row] += (uint32_t)before;
    }
}

/* Lists the contacts from d->indexed on; false when out of memory. */
static bool list_new(tl_detect *d, size_t blocks)
{
    const tl_contacts *c = &d->contacts;
    size_t count = 0;
    if (d->indexed == c->table.rows)
        return true;
    entry *list = malloc(2 * (c->table.rows - d->indexed) * sizeof *list);
    if (!list)
        return false;
    for (uint32_t row = d->indexed; row < c->table.rows; row++) {
        list[count++] = (entry){c->a[row], c->b[row], row};
        list[count++] = (entry){c->b[row], c->a[row], row};
    }
    qsort(list, count, sizeof *list, compare_entries);
    put_entries(d, blocks, list, count);
    free(list);
    return true;
}

void tl_contacts_unlist(tl_detect *d)
{
    d->indexed = TL_NO_ROW;
}

bool tl_contacts_index(tl_model *m)
{
    tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    size_t blocks = m->blocks.table.rows;
    if (!tl_fit(&d->by_block_start, &d->by_start_capacity, blocks + 2, sizeof *d->by_block_start) ||
        !tl_fit(&d->by_block, &d->by_block_capacity, 2 * c->table.capacity + 1, sizeof *d->by_block))
        return false;
    if (d->indexed == TL_NO_ROW)
        list_all(d, blocks);
    else if (!list_new(d, blocks))
        return false;
    d->indexed = (uint32_t)c->table.rows;
    d->any_without_rows = false;
    for (size_t row = 0; row < c->table.rows; row++)
        d->any_without_rows = d->any_without_rows || c->point_capacity[row] == 0;
    return true;
}

/* ---------------------------------------------------------------- by name ---------------- */

uint32_t tl_contact_row(const tl_model *m, tl_id a, tl_id b)
{
    const tl_detect *d = m->detect;
    const uint32_t block = tl_block_row_quiet(m, a), partner = tl_block_row_quiet(m, b);
    if (block == TL_NO_ROW || partner == TL_NO_ROW)
        return TL_NO_ROW;
    size_t low = d->by_block_start[block], end = d->by_block_start[block + 1], high = end;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (tl_contact_partner(&d->contacts, d->by_block[middle], block) < partner)
            low = middle + 1;
        else
            high = middle;
    }
    const bool found = low < end && tl_contact_partner(&d->contacts, d->by_block[low], block) == partner;
    return found ? d->by_block[low] : TL_NO_ROW;
}
