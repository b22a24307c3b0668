/* sliver.c - blocks so small or thin that they make the time step short, by the rates that the step goes by: a remark
 * on them, and limits for a filter (model/slivers.c).
 *
 * Of bodies that could all be joined the largest stays. */
#include "cycle/sliver.h"

#include "base/groups.h"
#include "contact/sides.h"
#include "model/body_shape.h"
#include "model/regroup.h"

#include <stdio.h>
#include <stdlib.h>
#include <talus/number.h>

/* Tolerance: how many times longer a step the rest must allow. */
#define SHORTENS 3.0

/* What the rule takes of a body, as a rate: the step goes with 1 / sqrt of it. 0: the body does not count. `counted`,
 * [bodies], are the rates of their contacts. */
static double rule_rate(const tl_model *m, uint32_t body, const double *counted)
{
    if (!tl_body_counts(m, body))
        return 0;
    return tl_rates_points(m) ? counted[body] : 1 / m->bodies.mass[body];
}

tl_row_value tl_sliver_fastest(const tl_model *m, const double *counted)
{
    tl_row_value out = {0, TL_NO_ROW};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double rate = rule_rate(m, body, counted);
        if (rate > out.value)
            out = (tl_row_value){rate, body};
    }
    return out;
}

/* Marks the largest of the bodies that could be joined to each other over their faces. `of` and `largest`, [bodies],
 * are for its use. */
static void mark_largest(const tl_model *m, uint32_t *of, uint32_t *largest, unsigned char *stays)
{
    const tl_contacts *c = &m->detect->contacts;
    const uint32_t bodies = (uint32_t)m->bodies.table.rows;
    for (uint32_t body = 0; body < bodies; body++)
        of[body] = largest[body] = body;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        const tl_sides on = tl_contact_bodies(m, i);
        if (c->point_count[i] && c->kind[i] == TL_FACET_PATCH && tl_bodies_may_join(&m->bodies, on.a, on.b) &&
            tl_body_is_visible(m, on.a) && tl_body_is_visible(m, on.b))
            tl_put_together(of, on.a, on.b);
    }
    for (uint32_t body = 0; body < bodies; body++) {
        uint32_t *best = &largest[tl_first_of(of, body)];
        if (tl_body_volume(m, body) > tl_body_volume(m, *best))
            *best = body;
    }
    for (uint32_t body = 0; body < bodies; body++)
        stays[body] = largest[tl_first_of(of, body)] == body;
}

tl_status tl_sliver_limits_choose(tl_model *m, const double *counted, tl_sliver_limits *out)
{
    const size_t bodies = m->bodies.table.rows;
    double *rate = malloc((bodies + 1) * sizeof *rate);
    uint32_t *of = malloc((bodies + 1) * sizeof *of), *largest = malloc((bodies + 1) * sizeof *largest);
    unsigned char *stays = malloc(bodies + 1);
    tl_status status = TL_OK;
    if (rate && of && largest && stays) {
        for (uint32_t body = 0; body < bodies; body++)
            rate[body] = rule_rate(m, body, counted);
        mark_largest(m, of, largest, stays);
        status = tl_slivers_choose(m, rate, stays, out);
    } else {
        status = tl_fail_memory(&m->error);
    }
    free(rate);
    free(of);
    free(largest);
    free(stays);
    return status;
}

static void say(tl_model *m, uint32_t body, const tl_sliver_limits *by)
{
    tl_body_shape shape;
    char others[40] = "", volume[60] = "", aspect[60] = "";
    if (by->count > 1)
        snprintf(others, sizeof others, " and %zu more", by->count - 1);
    if (!isnan(by->volume))
        tl_text_print(volume, sizeof volume, "volume = %.4g, ", by->volume);
    if (!isnan(by->aspect))
        tl_text_print(aspect, sizeof aspect, "aspect = %.4g, ", by->aspect);
    if (!tl_body_shape_of(m, body, &shape))
        return;
    tl_model_say(m,
                 "time step: block %u%s (volume %.3g m3, aspect %.3g) make%s it %.3g times smaller than the rest of "
                 "the blocks allow; %s%s%s%s joins such slivers, %.2g %% of the rock, to their neighbours",
                 m->bodies.id[body], others, tl_body_volume(m, body), shape.aspect, by->count > 1 ? "" : "s", by->gain,
                 tl_words(m, "model:filter{ ", "tl_model_filter() with "), volume, aspect,
                 tl_words(m, "action = \"join\" }", "action = TL_FILTER_JOIN"), 100 * by->share);
}

void tl_sliver_remark(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (c->sliver_structure == 1 + m->structure || c->all_held)
        return;
    c->sliver_structure = 1 + m->structure;
    const tl_row_value first = tl_sliver_fastest(m, c->rate);
    if (first.row == TL_NO_ROW || m->bodies.id[first.row] == c->sliver)
        return;
    tl_sliver_limits by;
    if (tl_sliver_limits_choose(m, c->rate, &by) != TL_OK || by.gain < SHORTENS)
        return;
    say(m, first.row, &by);
    c->sliver = m->bodies.id[first.row];
}
