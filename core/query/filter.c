/* filter.c - slivers: blocks below the user's limits, which are reported, deleted, or joined.
 *
 * Joining is the merge of a discontinuum: the sliver becomes one rigid body with the neighbour it
 * shares the largest face with. Its mass and shape stay exact, the face between the two no longer
 * moves, and its small mass no longer rules the time step. (A union of two convex blocks is in
 * general not convex; moving vertices would open gaps elsewhere.) Neighbours that are slivers
 * themselves are taken only when there is no other. A body that is held or driven differently is
 * never joined to.
 *
 * A block is a sliver only when every block of its body is one: what hangs on a sound block has been
 * dealt with. Hidden blocks are left alone. */

#include "model/options.h"
#include "query/touching.h"

#include <stdlib.h>

typedef struct filter {
    tl_model *model;
    const tl_filter *limits;
    unsigned char *bad; /* [blocks] */
    uint32_t *group;    /* [blocks] towards the lowest row of what it is joined to */
    tl_touches touches;
} filter;

static bool is_given(double limit)
{
    return !isnan(limit);
}

static bool is_bad(const tl_filter *limits, tl_sliver *sliver)
{
    sliver->small = is_given(limits->volume) && sliver->volume < limits->volume;
    sliver->short_edge = is_given(limits->edge) && sliver->edge < limits->edge;
    sliver->thin = is_given(limits->aspect) && sliver->aspect > limits->aspect;
    return sliver->small || sliver->short_edge || sliver->thin;
}

static tl_sliver measure(const tl_model *m, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    return (tl_sliver){.block = m->blocks.id[row],
                       .volume = m->blocks.volume[row],
                       .edge = tl_poly_shortest_edge(shape),
                       .aspect = tl_poly_diameter(shape) / tl_poly_thickness(shape)};
}

/* Marks the visible blocks below the limits, but not those whose body has a sound block. */
static void find_bad(filter *f)
{
    const tl_model *m = f->model;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        tl_sliver sliver = measure(m, row);
        f->bad[row] = !m->blocks.hidden[row] && is_bad(f->limits, &sliver);
    }
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const uint32_t *rows = &m->members[m->bodies.member_start[body]];
        bool all = true;
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
            all = all && f->bad[rows[k]];
        for (uint32_t k = 0; k < m->bodies.member_count[body] && !all; k++)
            f->bad[rows[k]] = 0;
    }
}

/* Lists the slivers in the order of their ids. */
static bool list_bad(const filter *f, tl_filter_result *result)
{
    const tl_model *m = f->model;
    size_t count = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        count += f->bad[row];
    result->slivers = malloc((count + 1) * sizeof *result->slivers);
    if (!result->slivers)
        return false;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        if (!f->bad[row])
            continue;
        tl_sliver *sliver = &result->slivers[result->count++];
        *sliver = measure(m, row);
        is_bad(f->limits, sliver);
        result->volume += sliver->volume;
    }
    return true;
}

/* ---------------------------------------------------------------- joining ---------------- */

static uint32_t root(const uint32_t *group, uint32_t row)
{
    while (group[row] != row)
        row = group[row];
    return row;
}

/* Whether two bodies may become one: nothing but their own weight and contacts may tell them apart. */
static bool may_join(const tl_bodies *b, uint32_t body, uint32_t other)
{
    return b->fixed[body] == b->fixed[other] && !b->drive[body] && !b->drive[other] &&
           !tl_body_loaded(b, body) && !tl_body_loaded(b, other);
}

/* The row of the block to join to, or TL_NO_ROW: the one with the largest shared face among sound
 * blocks, else among slivers; of equals the oldest. */
static uint32_t find_partner(const filter *f, uint32_t row)
{
    const tl_model *m = f->model;
    uint32_t partner = TL_NO_ROW;
    double largest = 0;
    bool sound = false;
    for (size_t i = f->touches.start[row]; i < f->touches.start[row + 1]; i++) {
        const tl_touch *t = &f->touches.at[i];
        bool is_sound = !f->bad[t->other];
        bool better = is_sound != sound ? is_sound : t->area > largest;
        if (!better || !may_join(&m->bodies, m->blocks.body[row], m->blocks.body[t->other]))
            continue;
        partner = t->other;
        largest = t->area;
        sound = is_sound;
    }
    return partner;
}

static tl_status join(filter *f, tl_filter_result *result)
{
    tl_model *m = f->model;
    size_t blocks = m->blocks.table.rows;
    tl_status status = tl_touches_find(m, &f->touches);
    if (status != TL_OK)
        return status;
    tl_bodies_groups(m, f->group);
    for (size_t i = 0; i < result->count; i++) {
        uint32_t row = m->row_of[result->slivers[i].block], partner = find_partner(f, row);
        if (partner == TL_NO_ROW)
            continue;
        uint32_t a = root(f->group, row), b = root(f->group, partner);
        if (a < b)
            f->group[b] = a;
        else
            f->group[a] = b;
        result->slivers[i].joined_to = m->blocks.id[partner];
        result->joined++;
    }
    for (uint32_t row = 0; row < blocks; row++)
        f->group[row] = root(f->group, row);
    return result->joined ? tl_bodies_regroup(m, f->group) : TL_OK;
}

static tl_status delete (filter *f, tl_filter_result *result)
{
    tl_id *ids = malloc((result->count + 1) * sizeof *ids);
    if (!ids)
        return tl_fail_memory(&f->model->error);
    for (size_t i = 0; i < result->count; i++)
        ids[i] = result->slivers[i].block;
    tl_status status = tl_blocks_delete(f->model, ids, result->count);
    free(ids);
    if (status == TL_OK)
        result->deleted = result->count;
    return status;
}

tl_status tl_model_filter(tl_model *m, const tl_filter *given, tl_filter_result *wanted)
{
    tl_filter_result unread, *const result = wanted ? wanted : &unread;
    *result = (tl_filter_result){0};
    tl_filter read;
    const tl_filter *limits = &read;
    tl_status status = TL_OPTIONS_READ(tl_filter, given, &read, &m->error);
    if (status != TL_OK)
        return status;
    tl_rows_tidy(m);
    if (!is_given(limits->volume) && !is_given(limits->edge) && !is_given(limits->aspect))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "filter: give a limit: the smallest volume, the shortest edge or the worst "
                       "aspect");
    if (limits->action != TL_FILTER_REPORT)
        status = tl_model_may_change(m, "filter blocks");
    if (status != TL_OK)
        return status;
    size_t blocks = m->blocks.table.rows;
    filter f = {.model = m,
                .limits = limits,
                .bad = calloc(blocks + 1, sizeof *f.bad),
                .group = malloc((blocks + 1) * sizeof *f.group)};
    bool enough = f.bad && f.group;
    if (enough)
        find_bad(&f);
    if (!enough || !list_bad(&f, result))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK && limits->action == TL_FILTER_DELETE)
        status = delete (&f, result);
    else if (status == TL_OK && limits->action == TL_FILTER_JOIN)
        status = join(&f, result);
    free(f.bad);
    free(f.group);
    tl_touches_free(&f.touches);
    if (status != TL_OK || !wanted) {
        free(result->slivers);
        *result = (tl_filter_result){0};
    }
    return status;
}
