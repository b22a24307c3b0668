/* filter.c - slivers: bodies below the user's limits, which are reported, deleted, or joined. A body of
 * several parts is measured as the one body that it is (body_shape.c). Limits may be left to model/slivers.c.
 *
 * Joining is the merge of a discontinuum: the sliver becomes one rigid body with the neighbour it shares the largest
 * face with. Its mass and shape stay exact, the face between the two no longer moves, and its small mass no longer
 * rules the time step. A union of two convex blocks is in general not convex, and moving vertices would open gaps
 * elsewhere. Neighbours that are slivers themselves are taken only when there is no other. A body that is held or
 * driven differently is never joined to.
 *
 * Bodies of which a block is hidden are left alone. */

#include "base/groups.h"
#include "cycle/sliver.h"
#include "cycle/timestep.h"
#include "model/body_shape.h"
#include "model/options.h"
#include "model/regroup.h"
#include "model/rows.h"
#include "query/touching.h"

#include <stdlib.h>

typedef struct filter {
    tl_model *model;
    const tl_filter *limits;
    unsigned char *bad; /* [bodies] */
    double *shared;     /* [bodies] area that the body in hand shares with each, m2 */
    uint32_t *near;     /* [bodies] those with which it shares some */
    uint32_t *group;    /* [blocks] towards the lowest row of what it is joined to */
    tl_touches touches;
} filter;

/* What is wrong with a body; false when out of memory. */
static bool measure(const filter *f, uint32_t body, tl_sliver *out)
{
    const tl_filter *limits = f->limits;
    tl_body_shape shape;
    if (!tl_body_shape_of(f->model, body, &shape))
        return false;
    *out = (tl_sliver){.block = f->model->bodies.id[body],
                       .volume = tl_body_volume(f->model, body),
                       .edge = shape.edge,
                       .aspect = shape.aspect};
    out->small = !isnan(limits->volume) && out->volume < limits->volume;
    out->short_edge = !isnan(limits->edge) && out->edge < limits->edge;
    out->thin = !isnan(limits->aspect) && out->aspect > limits->aspect;
    return true;
}

/* Lists the slivers in the order of their ids, and marks them. */
static bool find_bad(filter *f, tl_filter_result *result)
{
    const size_t bodies = f->model->bodies.table.rows;
    result->slivers = malloc((bodies + 1) * sizeof *result->slivers);
    for (uint32_t body = 0; body < bodies && result->slivers; body++) {
        tl_sliver *sliver = &result->slivers[result->count];
        f->bad[body] = 0;
        if (!tl_body_is_visible(f->model, body))
            continue;
        if (!measure(f, body, sliver))
            return false;
        f->bad[body] = sliver->small || sliver->short_edge || sliver->thin;
        result->count += f->bad[body];
        result->volume += f->bad[body] ? sliver->volume : 0;
    }
    return result->slivers != NULL;
}

/* ---------------------------------------------------------------- joining ---------------- */

/* Lists the bodies that a body touches, with the area that it shares with each; gives how many. */
static size_t list_near(filter *f, uint32_t body)
{
    const tl_model *m = f->model;
    size_t count = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (size_t i = f->touches.start[row]; i < f->touches.start[row + 1]; i++) {
            const uint32_t other = m->blocks.body[f->touches.at[i].other];
            if (!(f->touches.at[i].area > 0))
                continue;
            if (!(f->shared[other] > 0))
                f->near[count++] = other;
            f->shared[other] += f->touches.at[i].area;
        }
    }
    return count;
}

/* Whether it is better to join to a body than to another one: by the area that is shared, then the older. */
static bool is_better(const filter *f, uint32_t body, uint32_t than)
{
    if (than == TL_NO_ROW || f->shared[body] != f->shared[than])
        return than == TL_NO_ROW || f->shared[body] > f->shared[than];
    return body < than;
}

/* The body to join to, a sound one or, with `any`, a sliver; or TL_NO_ROW. */
static uint32_t find_partner(filter *f, uint32_t body, bool any)
{
    uint32_t partner = TL_NO_ROW;
    const size_t count = list_near(f, body);
    for (size_t i = 0; i < count; i++)
        if (tl_bodies_may_join(&f->model->bodies, body, f->near[i]) && tl_body_is_visible(f->model, f->near[i]) &&
            (any || !f->bad[f->near[i]]) && is_better(f, f->near[i], partner))
            partner = f->near[i];
    for (size_t i = 0; i < count; i++)
        f->shared[f->near[i]] = 0;
    return partner;
}

/* Joins the slivers that have a partner and are not joined yet; gives how many. Those that have one are sound from
 * then on. */
static size_t join_some(filter *f, tl_filter_result *result, bool any)
{
    const tl_model *m = f->model;
    size_t joined = 0;
    for (size_t i = 0; i < result->count; i++) {
        tl_sliver *sliver = &result->slivers[i];
        const uint32_t row = tl_block_row_quiet(m, sliver->block), body = m->blocks.body[row];
        const uint32_t partner = sliver->joined_to ? TL_NO_ROW : find_partner(f, body, any);
        if (partner == TL_NO_ROW)
            continue;
        tl_put_together(f->group, row, m->members[m->bodies.member_start[partner]]);
        sliver->joined_to = m->bodies.id[partner];
        joined++;
    }
    for (size_t i = 0; i < result->count; i++)
        if (result->slivers[i].joined_to)
            f->bad[m->blocks.body[tl_block_row_quiet(m, result->slivers[i].block)]] = 0;
    result->joined += joined;
    return joined;
}

/* Those beside sound bodies first, then those beside these, and so on; slivers that nothing sound is beside become one
 * with each other. */
static tl_status join_round(filter *f, tl_filter_result *result)
{
    tl_model *m = f->model;
    size_t blocks = m->blocks.table.rows;
    tl_touches_free(&f->touches);
    tl_status status = tl_touches_find(m, &f->touches);
    if (status != TL_OK)
        return status;
    tl_bodies_groups(m, f->group);
    while (join_some(f, result, false))
        ;
    join_some(f, result, true);
    for (uint32_t row = 0; row < blocks; row++)
        f->group[row] = tl_first_of(f->group, row);
    return result->joined ? tl_bodies_regroup(m, f->group) : TL_OK;
}

/* What is still a sliver as it has been joined to something small is joined on. The result is that of the first round;
 * where there is no memory for another one it stands. */
static tl_status join(filter *f, tl_filter_result *result)
{
    tl_status status = join_round(f, result);
    for (size_t joined = result->joined; joined && status == TL_OK;) {
        tl_filter_result more = {0};
        joined = find_bad(f, &more) && more.count && join_round(f, &more) == TL_OK ? more.joined : 0;
        free(more.slivers);
    }
    return status;
}

static tl_status delete (filter *f, tl_filter_result *result)
{
    tl_model *m = f->model;
    size_t count = 0;
    tl_id *ids = malloc((m->blocks.table.rows + 1) * sizeof *ids);
    if (!ids)
        return tl_fail_memory(&m->error);
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        if (f->bad[m->blocks.body[row]])
            ids[count++] = m->blocks.id[row];
    tl_status status = tl_blocks_delete(m, ids, count);
    free(ids);
    if (status == TL_OK)
        result->deleted = result->count;
    return status;
}

/* ---------------------------------------------------------------- what is asked for ------ */

static tl_status read_limits(tl_model *m, const tl_filter *given, tl_filter *limits)
{
    const tl_status status = TL_OPTIONS_READ(tl_filter, given, limits, &m->error);
    if (status != TL_OK)
        return status;
    const bool some = !isnan(limits->volume) || !isnan(limits->edge) || !isnan(limits->aspect);
    if (limits->automatic && some)
        return tl_fail(&m->error, TL_E_ARGUMENT, "filter: give limits, or %s, not both",
                       tl_words(m, "auto = true, which chooses them", "automatic, which chooses them"));
    if (!limits->automatic && !some)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "filter: give a limit: the smallest volume, the shortest edge or the worst aspect; or %s",
                       tl_words(m, "auto = true", "automatic"));
    return limits->action == TL_FILTER_REPORT ? TL_OK : tl_model_may_change(m, "filter blocks");
}

static tl_status act(filter *f, tl_filter_result *result)
{
    if (!find_bad(f, result))
        return tl_fail_memory(&f->model->error);
    if (f->limits->action == TL_FILTER_DELETE)
        return delete (f, result);
    return f->limits->action == TL_FILTER_JOIN ? join(f, result) : TL_OK;
}

/* Finds the slivers and does with them what is asked for. */
static tl_status run(tl_model *m, const tl_filter *limits, tl_filter_result *result)
{
    const size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    filter f = {.model = m,
                .limits = limits,
                .bad = calloc(bodies + 1, sizeof *f.bad),
                .shared = calloc(bodies + 1, sizeof *f.shared),
                .near = malloc((bodies + 1) * sizeof *f.near),
                .group = malloc((blocks + 1) * sizeof *f.group)};
    const bool enough = f.bad && f.shared && f.near && f.group;
    const tl_status status = enough ? act(&f, result) : tl_fail_memory(&m->error);
    free(f.bad);
    free(f.shared);
    free(f.near);
    free(f.group);
    tl_touches_free(&f.touches);
    return status;
}

/* The rates that the step goes by, [bodies], to be freed; NULL: there are none, for some contact has no law. */
static tl_status find_rates(tl_model *m, double **rate)
{
    tl_timestep_report report;
    *rate = NULL;
    tl_status status = tl_model_timestep_report(m, &report);
    if (status != TL_OK && status != TL_E_MEMORY) {
        m->error = (tl_error){0};
        return TL_OK;
    }
    const size_t bodies = m->bodies.table.rows;
    double *found = malloc((bodies + 1) * sizeof *found), *turn_rate = malloc((bodies + 1) * sizeof *turn_rate);
    if (status == TL_OK && (!found || !turn_rate))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK) {
        tl_rates_try(m, 0, found, turn_rate);
        *rate = found;
    } else {
        free(found);
    }
    free(turn_rate);
    return status;
}

/* Limits that make the step longer, by its rates or, as long as there are none, by shapes. */
static tl_status choose_limits(tl_model *m, tl_sliver_limits *out)
{
    double *rate;
    tl_status status = find_rates(m, &rate);
    if (status == TL_OK)
        status = rate ? tl_sliver_limits_choose(m, rate, out) : tl_slivers_by_shape(m, out);
    free(rate);
    return status;
}

/* How many times longer the step has become than it was by the highest rate, or NaN. */
static double gain_over(tl_model *m, double highest)
{
    double *rate, now = 0;
    if (find_rates(m, &rate) == TL_OK && rate)
        now = tl_sliver_fastest(m, rate).value;
    free(rate);
    return now > 0 ? sqrt(highest / now) : NAN;
}

/* The same with limits that are chosen for the time step. */
static tl_status run_automatic(tl_model *m, tl_filter limits, tl_filter_result *result)
{
    tl_sliver_limits by;
    tl_status status = choose_limits(m, &by);
    if (status != TL_OK)
        return status;
    limits.volume = by.volume;
    limits.aspect = by.aspect;
    status = run(m, &limits, result);
    /* Not all that is beyond the limits can be joined, and what is joined changes its rate. */
    const bool changed = status == TL_OK && limits.action != TL_FILTER_REPORT && !by.by_shape;
    const double gain = changed ? gain_over(m, by.fastest) : NAN;
    result->gain = gain > 0 ? gain : by.gain;
    return status;
}

/* Says that blocks with zones are joined to none, where slivers have been left for it, or none were chosen. */
static void say_zoned(tl_model *m, const tl_filter *limits, const tl_filter_result *r)
{
    size_t zoned = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        zoned += m->bodies.mesh[body] && tl_body_is_visible(m, body);
    const bool leaves = r->joined < r->count || (limits->automatic && r->count == 0);
    if (limits->action == TL_FILTER_JOIN && zoned > 0 && leaves)
        tl_model_say(
            m,
            "filter: joined %zu of %zu slivers: blocks that have zones, %zu of the visible ones, are joined to "
            "none; filter before blocks are made deformable",
            r->joined, r->count, zoned);
}

tl_status tl_model_filter(tl_model *m, const tl_filter *given, tl_filter_result *wanted)
{
    tl_filter_result unread, *const result = wanted ? wanted : &unread;
    tl_filter limits;
    *result = (tl_filter_result){.gain = NAN};
    tl_status status = read_limits(m, given, &limits);
    if (status != TL_OK)
        return status;
    tl_rows_tidy(m);
    status = limits.automatic ? run_automatic(m, limits, result) : run(m, &limits, result);
    if (status == TL_OK)
        say_zoned(m, &limits, result);
    if (status != TL_OK || !wanted) {
        free(result->slivers);
        *result = (tl_filter_result){.gain = NAN};
    }
    return status;
}
