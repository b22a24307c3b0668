/* slivers.c - bodies that make the time step short by being small or thin, and a filter that takes enough of them.
 *
 * The step goes with 1 / sqrt(rate) of the body that controls it. The bodies are sorted by how small and how thin they
 * are, into cells between limits of volume and aspect. A filter takes those beyond its limits, and the highest rate of
 * those that it leaves tells by how much longer the step would be. Of the filters that take little of the rock, the one
 * is chosen that takes least and gains nearly the most. Where no shape is the reason, but a stiff law or a light rock,
 * no filter gains anything. */
#include "model/slivers.h"

#include "geometry/measure.h"
#include "model/body_shape.h"

#include <stdlib.h>
#include <talus/number.h>

/* Tolerance: the largest share of the rock, by volume, that may be called slivers. */
#define LITTLE 0.05
/* Tolerance: share of the largest gain that suffices; and 1 over the least gain. */
#define ENOUGH 0.5

/* Tolerance: aspect above which a block counts as a sliver for the summary of a cut. */
#define THIN 50.0
/* Tolerance: share of the mean volume of blocks below which a block counts as a sliver for the summary of a cut. */
#define TINY 1e-3

bool tl_is_sliver(const tl_poly *shape, double volume, double mean)
{
    if (volume < TINY * mean)
        return true;
    /* What is thin has little volume for its size, since a convex body's is below thickness times diameter squared. */
    return THIN * volume < shape->size * shape->size * shape->size &&
           tl_poly_diameter(shape) > THIN * tl_poly_thickness(shape);
}

/* Limits, the widest first: shares of the mean volume of a body, and aspects. */
static const double part[] = {0.01, 3e-3, 1e-3, 1e-4, 1e-5};
static const double thinness[] = {10, 20, 30, 50, 100};
enum { PARTS = sizeof part / sizeof *part, ASPECTS = sizeof thinness / sizeof *thinness };

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

static double fastest(const double *rate, size_t bodies)
{
    double highest = 0;
    for (size_t body = 0; body < bodies; body++)
        highest = fmax(highest, rate[body]);
    return highest;
}

/* Whether any filter could gain, without a look at shapes: bodies of rates far below the highest are nearly all the
 * rock. */
static bool may_gain(const tl_model *m, const double *rate, double highest)
{
    double whole = 0, slow = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const double volume = rate[body] > 0 ? tl_body_volume(m, body) : 0;
        whole += volume;
        slow += rate[body] < highest * (ENOUGH * ENOUGH) ? volume : 0;
    }
    return slow >= (1 - LITTLE) * whole && slow > 0;
}

/* Puts a body into its cell; one that stays is beyond no limit. false when out of memory. */
static bool sort_body(const tl_model *m, sorting *s, uint32_t body, double rate, bool stays)
{
    int small = 0, thin = 0;
    tl_body_shape shape;
    if (!tl_body_shape_of(m, body, &shape))
        return false;
    const heap one = {rate, tl_body_volume(m, body), 1};
    while (!stays && small < PARTS && one.volume < s->volume[small])
        small++;
    while (!stays && thin < ASPECTS && shape.aspect > thinness[thin])
        thin++;
    add(&s->cell[small][thin], &one);
    add(&s->all, &one);
    return true;
}

/* false when out of memory. */
static bool sort_bodies(const tl_model *m, const double *rate, const unsigned char *stays, sorting *s)
{
    const uint32_t bodies = (uint32_t)m->bodies.table.rows;
    double whole = 0, count = 0;
    *s = (sorting){.all = {0}};
    for (uint32_t body = 0; body < bodies; body++) {
        whole += rate[body] > 0 ? tl_body_volume(m, body) : 0;
        count += rate[body] > 0;
    }
    for (int k = 0; k < PARTS; k++)
        s->volume[k] = rounded(part[k] * whole / count);
    for (uint32_t body = 0; body < bodies; body++)
        if (rate[body] > 0 && !sort_body(m, s, body, rate[body], stays[body] || !tl_body_is_visible(m, body)))
            return false;
    return true;
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

/* The filter that takes least and gains enough of what one that takes little can; without limits when none does. What
 * is hidden stays. */
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
                else if (left.rate * (ENOUGH * ENOUGH) <= least && left.rate <= (ENOUGH * ENOUGH) * s->all.rate &&
                         (best.left.rate * (ENOUGH * ENOUGH) > least || left.volume > best.left.volume))
                    best = (choice){small, thin, left};
            }
    return best;
}

tl_status tl_slivers_choose(tl_model *m, const double *rate, const unsigned char *stays, tl_sliver_limits *out)
{
    const double highest = fastest(rate, m->bodies.table.rows);
    *out = (tl_sliver_limits){.volume = NAN, .aspect = NAN, .gain = 1, .fastest = highest};
    sorting s;
    if (!may_gain(m, rate, highest))
        return TL_OK;
    if (!sort_bodies(m, rate, stays, &s))
        return tl_fail_memory(&m->error);
    const choice by = choose(&s);
    if (by.small)
        out->volume = s.volume[by.small - 1];
    if (by.thin)
        out->aspect = thinness[by.thin - 1];
    out->count = s.all.count - by.left.count;
    out->share = 1 - by.left.volume / s.all.volume;
    out->gain = sqrt(s.all.rate / by.left.rate);
    return TL_OK;
}

/* ---------------------------------------------------------------- by shapes -------------- */

static double surface_of(const tl_poly *shape)
{
    double area = 0;
    for (uint32_t face = 0; face < shape->face_count; face++)
        area += tl_poly_face_area(shape, face);
    return area;
}

/* Area over volume of each body that can move or, where none can, of any; 0 of others. Marks the largest. */
static void rate_shapes(const tl_model *m, double *rate, unsigned char *stays)
{
    const uint32_t bodies = (uint32_t)m->bodies.table.rows;
    bool all_held = true;
    uint32_t largest = 0;
    for (uint32_t body = 0; body < bodies; body++)
        all_held = all_held && m->bodies.fixed[body] == TL_FIX_ALL;
    for (uint32_t body = 0; body < bodies; body++) {
        double area = 0;
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
            area += surface_of(m->blocks.shape[tl_body_blocks(m, body)[k]]);
        rate[body] = all_held || m->bodies.fixed[body] != TL_FIX_ALL ? area / tl_body_volume(m, body) : 0;
        stays[body] = 0;
        if (rate[body] > 0 && (!(rate[largest] > 0) || tl_body_volume(m, body) > tl_body_volume(m, largest)))
            largest = body;
    }
    stays[largest] = 1;
}

tl_status tl_slivers_by_shape(tl_model *m, tl_sliver_limits *out)
{
    const size_t bodies = m->bodies.table.rows;
    double *rate = malloc((bodies + 1) * sizeof *rate);
    unsigned char *stays = malloc(bodies + 1);
    tl_status status = TL_OK;
    if (rate && stays) {
        rate_shapes(m, rate, stays);
        status = tl_slivers_choose(m, rate, stays, out);
        out->by_shape = true;
    } else {
        status = tl_fail_memory(&m->error);
    }
    free(rate);
    free(stays);
    return status;
}
