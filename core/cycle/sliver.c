/* sliver.c - a remark on blocks so small or thin that they alone make the time step short.
 *
 * The step goes with 1 / sqrt(rate) of the body that controls it. Where all but a few bodies allow one that is several
 * times longer, and the shape of the body is the reason, not a stiff law or a light rock, the user is told of the block
 * and of the filter that finds it. */
#include "cycle/rates.h"

#include <stdio.h>

/* How many times longer a step the rest must allow. */
#define SHORTENS 3.0
/* How many times as small or as thin as the rest a sliver is. */
#define SLIMMER 2.0
/* Share of the bodies that are not the rest; one at least. */
#define FEW 0.01

/* What the rule takes of a body, as a rate: the step goes with 1 / sqrt of it. 0: the body does not count. */
static double rule_rate(const tl_model *m, uint32_t body)
{
    if (!tl_body_counts(m, body))
        return 0;
    return tl_rates_points(m) ? m->cycle->rate[body] : 1 / m->bodies.mass[body];
}

/* The body of the highest rate, that of the highest one SHORTENS^2 times below it or lower, and how many are between. */
typedef struct ranking {
    tl_row_value first, rest;
    size_t few, all;
} ranking;

static ranking rank_bodies(const tl_model *m)
{
    ranking out = {.first = {0, TL_NO_ROW}, .rest = {0, TL_NO_ROW}};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double rate = rule_rate(m, body);
        if (rate > out.first.value)
            out.first = (tl_row_value){rate, body};
    }
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double rate = rule_rate(m, body);
        out.all += rate > 0;
        if (rate * (SHORTENS * SHORTENS) > out.first.value)
            out.few++;
        else if (rate > out.rest.value)
            out.rest = (tl_row_value){rate, body};
    }
    return out;
}

/* What a filter looks at: a body is taken when all its blocks are beyond a limit. */
typedef struct body_shape {
    double volume;     /* of the largest block, m3 */
    double aspect;     /* of the stoutest */
    double all_volume; /* of all blocks */
} body_shape;

static body_shape shape_of(const tl_model *m, uint32_t body)
{
    body_shape out = {0, INFINITY, 0};
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        const tl_poly *shape = m->blocks.shape[row];
        out.volume = fmax(out.volume, m->blocks.volume[row]);
        out.aspect = fmin(out.aspect, tl_poly_diameter(shape) / tl_poly_thickness(shape));
        out.all_volume += m->blocks.volume[row];
    }
    return out;
}

/* The part of a rate that is the shape's: without law and density. */
static double shape_rate(const tl_model *m, tl_row_value of, const body_shape *shape)
{
    double law = tl_rates_points(m) ? tl_rate_law(m, of.row) : 1;
    return of.value / law * (m->bodies.mass[of.row] / shape->all_volume);
}

/* How many times as small, by the cube root of the volume, and as thin a sliver is as the rest. */
typedef struct slimness {
    double small, thin;
} slimness;

static slimness compare(const body_shape *sliver, const body_shape *rest)
{
    return (slimness){tl_cbrt(rest->volume / sliver->volume), sliver->aspect / rest->aspect};
}

static void say(tl_model *m, const ranking *r, const body_shape *sliver, const body_shape *rest)
{
    /* the filter that tells the two apart best, with a limit half-way between them */
    slimness slim = compare(sliver, rest);
    bool by_volume = slim.small > slim.thin;
    double limit =
        by_volume ? sqrt(sliver->volume) * sqrt(rest->volume) : sqrt(sliver->aspect * rest->aspect);
    char others[40] = "";
    if (r->few > 1)
        snprintf(others, sizeof others, " and %zu more", r->few - 1);
    tl_model_say(m,
                 "time step: block %u%s (volume %.3g m3, aspect %.3g) make%s it %.3g times smaller "
                 "than the rest of the blocks allow; model:filter{ %s = %.4g, action = \"join\" } "
                 "joins such slivers to their neighbours",
                 m->bodies.id[r->first.row], others, sliver->volume, sliver->aspect,
                 r->few > 1 ? "" : "s", sqrt(r->first.value / r->rest.value),
                 by_volume ? "volume" : "aspect", limit);
}

void tl_sliver_remark(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (c->sliver_structure == 1 + m->structure || c->all_held)
        return;
    c->sliver_structure = 1 + m->structure;
    ranking r = rank_bodies(m);
    if (r.rest.row == TL_NO_ROW || (double)r.few > fmax(1, FEW * (double)r.all))
        return;
    body_shape sliver = shape_of(m, r.first.row), rest = shape_of(m, r.rest.row);
    slimness slim = compare(&sliver, &rest);
    if (shape_rate(m, r.first, &sliver) < SHORTENS * SHORTENS * shape_rate(m, r.rest, &rest) ||
        fmax(slim.small, slim.thin) < SLIMMER)
        return;
    tl_id block = m->bodies.id[r.first.row];
    if (block != c->sliver)
        say(m, &r, &sliver, &rest);
    c->sliver = block;
}
