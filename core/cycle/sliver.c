/* sliver.c - a remark on blocks so small or thin that they make the time step short, with a filter that suffices.
 *
 * The step goes with 1 / sqrt(rate) of the body that controls it. The bodies are sorted by how small and how thin they
 * are, into cells between limits of volume and aspect. A filter takes those beyond its limits, and the highest rate of
 * those that it leaves tells by how much longer the step would be. Of the filters that take little of the rock, the one
 * is told that takes least and gains nearly the most. Where no shape is the reason, but a stiff law or a light rock, no
 * filter gains anything, and nothing is said. Of bodies that could all be joined the largest stays. */
#include "cycle/sliver.h"

#include "base/groups.h"
#include "contact/sides.h"
#include "model/body_shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <talus/number.h>
#include <talus/text.h>

/* Tolerance: how many times longer a step the rest must allow. */
#define SHORTENS 3.0
/* Tolerance: the largest share of the rock, by volume, that may be called slivers. */
#define LITTLE 0.05
/* Tolerance: share of the largest gain that suffices. */
#define ENOUGH 0.5

/* Limits, the widest first: shares of the mean volume of a body, and aspects. */
static const double part[] = {0.01, 3e-3, 1e-3, 1e-4, 1e-5};
static const double thinness[] = {10, 20, 30, 50, 100};
enum { PARTS = sizeof part / sizeof *part, ASPECTS = sizeof thinness / sizeof *thinness };

/* What the rule takes of a body, as a rate: the step goes with 1 / sqrt of it. 0: the body does not count. */
static double rule_rate(const tl_model *m, uint32_t body)
{
    if (!tl_body_counts(m, body))
        return 0;
    return tl_rates_points(m) ? m->cycle->rate[body] : 1 / m->bodies.mass[body];
}

static tl_row_value fastest(const tl_model *m)
{
    tl_row_value out = {0, TL_NO_ROW};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double rate = rule_rate(m, body);
        if (rate > out.value)
            out = (tl_row_value){rate, body};
    }
    return out;
}

/* Some bodies: their highest rate, volume and number. */
typedef struct heap {
    double rate, volume;
    size_t count;
} heap;

/* Bodies by how many limits of volume, and of aspect, they are beyond. */
typedef struct sorting {
    double volume[PARTS]; /* the limits, m3 */
    heap cell[PARTS + 1][ASPECTS + 1];
    heap all;
} sorting;

static void add(heap *to, const heap *more)
{
    to->rate = fmax(to->rate, more->rate);
    to->volume += more->volume;
    to->count += more->count;
}

/* A number of one digit. */
static double rounded(double x)
{
    char text[32];
    tl_text_print(text, sizeof text, "%.0e", x);
    return tl_number_read(text, NULL);
}

/* Of the bodies that could be joined to each other over their faces the largest: largest[tl_first_of(of, body)]. */
static void find_largest(const tl_model *m, const double *volume, uint32_t *of, uint32_t *largest)
{
    const tl_contacts *c = &m->detect->contacts;
    const uint32_t bodies = (uint32_t)m->bodies.table.rows;
    for (uint32_t body = 0; body < bodies; body++)
        of[body] = largest[body] = body;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        const tl_sides on = tl_contact_bodies(m, i);
        if (c->point_count[i] && c->kind[i] == TL_FACET_PATCH && tl_bodies_may_join(&m->bodies, on.a, on.b))
            tl_put_together(of, on.a, on.b);
    }
    for (uint32_t body = 0; body < bodies; body++) {
        uint32_t *best = &largest[tl_first_of(of, body)];
        if (volume[body] > volume[*best])
            *best = body;
    }
}

/* A body of a volume, m3; one that stays is beyond no limit. false when out of memory. */
static bool sort_body(const tl_model *m, sorting *s, uint32_t body, double volume, bool stays)
{
    const double rate = rule_rate(m, body);
    int small = 0, thin = 0;
    tl_body_shape shape;
    if (!(rate > 0))
        return true;
    if (!tl_body_shape_of(m, body, &shape))
        return false;
    while (!stays && small < PARTS && volume < s->volume[small])
        small++;
    while (!stays && thin < ASPECTS && shape.aspect > thinness[thin])
        thin++;
    const heap one = {rate, volume, 1};
    add(&s->cell[small][thin], &one);
    add(&s->all, &one);
    return true;
}

/* false when out of memory. */
static bool sort_bodies(const tl_model *m, sorting *s)
{
    const uint32_t bodies = (uint32_t)m->bodies.table.rows;
    double whole = 0, count = 0, *volume = malloc((bodies + 1) * sizeof *volume);
    uint32_t *of = malloc((bodies + 1) * sizeof *of);
    uint32_t *largest = malloc((bodies + 1) * sizeof *largest);
    bool enough = volume && of && largest;
    *s = (sorting){.all = {0}};
    for (uint32_t body = 0; body < bodies && enough; body++) {
        volume[body] = tl_body_volume(m, body);
        whole += tl_body_counts(m, body) ? volume[body] : 0;
        count += tl_body_counts(m, body);
    }
    for (int k = 0; k < PARTS; k++)
        s->volume[k] = rounded(part[k] * whole / count);
    if (enough)
        find_largest(m, volume, of, largest);
    for (uint32_t body = 0; body < bodies && enough; body++)
        enough = sort_body(m, s, body, volume[body], largest[tl_first_of(of, body)] == body);
    free(volume);
    free(of);
    free(largest);
    return enough;
}

/* Limits by their numbers, 0: none; and what a filter of them leaves. */
typedef struct choice {
    int small, thin;
    heap left;
} choice;

static heap left_by(const sorting *s, int small, int thin)
{
    heap left = {0, 0, 0};
    for (int i = 0; i < (small ? small : PARTS + 1); i++)
        for (int k = 0; k < (thin ? thin : ASPECTS + 1); k++)
            add(&left, &s->cell[i][k]);
    return left;
}

/* The filter that takes least and gains enough of what one that takes little can; without limits when none does. */
static choice choose(const sorting *s)
{
    choice best = {0, 0, s->all};
    double least = s->all.rate;
    for (int pass = 0; pass < 2; pass++)
        for (int small = 0; small <= PARTS; small++)
            for (int thin = 0; thin <= ASPECTS; thin++) {
                const heap left = left_by(s, small, thin);
                if (left.count == 0 || left.volume < (1 - LITTLE) * s->all.volume)
                    continue;
                if (pass == 0)
                    least = fmin(least, left.rate);
                else if (left.rate * (ENOUGH * ENOUGH) <= least &&
                         (best.left.rate * (ENOUGH * ENOUGH) > least || left.volume > best.left.volume))
                    best = (choice){small, thin, left};
            }
    return best;
}

static void say(tl_model *m, uint32_t body, const sorting *s, const choice *by)
{
    tl_body_shape shape;
    const size_t taken = s->all.count - by->left.count;
    char others[40] = "", volume[60] = "", aspect[60] = "";
    if (taken > 1)
        snprintf(others, sizeof others, " and %zu more", taken - 1);
    if (by->small)
        tl_text_print(volume, sizeof volume, "volume = %.4g, ", s->volume[by->small - 1]);
    if (by->thin)
        tl_text_print(aspect, sizeof aspect, "aspect = %.4g, ", thinness[by->thin - 1]);
    if (!tl_body_shape_of(m, body, &shape))
        return;
    tl_model_say(m,
                 "time step: block %u%s (volume %.3g m3, aspect %.3g) make%s it %.3g times smaller than the rest of "
                 "the blocks allow; %s%s%s%s joins such slivers, %.2g %% of the rock, to their neighbours",
                 m->bodies.id[body], others, tl_body_volume(m, body), shape.aspect, taken > 1 ? "" : "s",
                 sqrt(s->all.rate / by->left.rate), tl_words(m, "model:filter{ ", "tl_model_filter() with "), volume,
                 aspect, tl_words(m, "action = \"join\" }", "action = TL_FILTER_JOIN"),
                 100 * (1 - by->left.volume / s->all.volume));
}

void tl_sliver_remark(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (c->sliver_structure == 1 + m->structure || c->all_held)
        return;
    c->sliver_structure = 1 + m->structure;
    const tl_row_value first = fastest(m);
    if (first.row == TL_NO_ROW || m->bodies.id[first.row] == c->sliver)
        return;
    sorting s;
    if (!sort_bodies(m, &s))
        return;
    const choice by = choose(&s);
    if (s.all.rate < SHORTENS * SHORTENS * by.left.rate)
        return;
    say(m, first.row, &s, &by);
    c->sliver = m->bodies.id[first.row];
}
