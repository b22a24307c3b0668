/* stored.c - water that is stored in wet joints: none comes or goes but through heads and drains.
 *
 * A joint has the void C = w A and holds the water V, m3 at pressure 0. Its surplus is X = V - C. It is one of three:
 *
 *     full      X = C p / K,     p >= 0        K: bulk modulus of the water
 *     partly    -C < X < 0,      p = 0         the void that is left has to be filled before p can rise
 *     empty     X = -C           p < 0         it passes on what it gets, as in steady flow, and bears no pressure
 *
 * So V grows with the potential phi in each of them, and never falls below 0. With the flow q to a side, m3/s,
 *
 *     dX/dt + dC/dt + sum of q = 0
 *
 * for the time since the last call, with the conductances of now and dC/dt the same all the while. That time has parts
 * of h. An implicit step of h has one solution: q grows with phi, as X does. It is found by active sets (Hintermueller,
 * Ito and Kunisch 2002). First no joint is taken for empty. Those that are full and those that are partly so are told
 * apart until none changes, and potentials fall from try to try. Then those with V < 0 become empty, and so on.
 * Potentials fall further, so joints that are empty stay so. A step begins with what was empty before. If that does
 * not stand, it begins with none.
 *
 * Of each part one step gives phi(h), and two of h/2 give phi(h/2, h/2). Both are stable for any h. Where each joint
 * stays what it is
 *
 *     2 phi(h/2, h/2) - phi(h)
 *
 * is of second order (Richardson 1911); else what two steps give counts. Where the two differ too much the part is
 * halved. What flows is that of the mean potential of the part, phi(h/2) + phi(h/2, h/2) - phi(h), or the mean of two
 * steps. The water of a joint changes by this flow, so volumes balance to rounding, whatever the error of phi. */
#include "solve.h"

/* Tolerance: largest difference of the potentials by one implicit step and by two of half of it, over the largest
 * difference of potentials that there is; of a joint that is not full, of its water over its void.
 * Test: lua/test_stored_flow. */
#define STEP_ERROR 1e-4
/* Limit: the time since the last call over its shortest part. */
#define MOST_PARTS 1048576.0
/* Tolerance: a joint becomes another only where its pressure over the difference of potentials, or its water over its
 * void, is beyond the limit by this: what iterations leave over. Test: property/flow_properties. */
#define BEYOND 1e-10
/* Limit: tries by which it is found which joints are full and empty. Where they do not do the part is halved. */
#define MOST_TRIES 100

/* A joint at some time. */
typedef struct moment {
    double *x, *surplus; /* Pa, m3 */
    unsigned char *is;   /* FLOW_FULL ... */
} moment;

enum { BEGUN, ONE, HALF, TWO, MOMENTS };

typedef struct story {
    flow_net *n;
    moment at[MOMENTS]; /* when a part began, after one step, and after half of two and both */
    double *store;      /* C / K, m3/Pa; 0: it takes no part */
    double *space;      /* C of now, m3 */
    double *swell;      /* dC/dt, m3/s */
    double *out;        /* m3/s */
    double *numbers;
    unsigned char *kinds;
    double range; /* Pa, largest difference of potentials */
} story;

static bool takes_part(const story *s, size_t e)
{
    return s->space[e] > 0;
}

/* C of a joint, `left` s before now. */
static double space_at(const story *s, size_t e, double left)
{
    return s->space[e] - s->swell[e] * left;
}

/* ---------------------------------------------------------------- an implicit step ------- */

/* Solves for the potentials at the end of a step of h, which is `left` s before now, by what joints are taken for. */
static bool solve_for(story *s, const moment *from, moment *to, double h, double left)
{
    flow_net *n = s->n;
    for (size_t e = 0; e < n->cells; e++) {
        const double store = takes_part(s, e) && to->is[e] == FLOW_FULL ? s->store[e] / h : 0;
        const double water = from->surplus[e] + space_at(s, e, left + h);
        const double held = to->is[e] == FLOW_FULL ? from->surplus[e] + s->store[e] * n->level[e] - h * s->swell[e]
                            : water > BEYOND * s->space[e] ? water
                                                           : 0;
        const bool given = !takes_part(s, e) || to->is[e] == FLOW_PARTLY;
        n->x[e] = to->is[e] == FLOW_PARTLY && takes_part(s, e) ? n->level[e] : to->x[e];
        n->extra[e] = n->leak[e] + store;
        n->diagonal[e] = given ? 0 : n->linked[e] + store;
        n->r[e] = given ? 0 : n->source[e] + held / h;
    }
    if (!flow_iterate(n))
        return false;
    memcpy(to->x, n->x, n->cells * sizeof *n->x);
    return true;
}

/* Tells full joints from those that are partly full. false: none has changed. */
static bool sort_full(story *s, moment *to)
{
    const flow_net *n = s->n;
    bool changed = false;
    for (size_t e = 0; e < n->cells; e++) {
        if (!takes_part(s, e) || to->is[e] == FLOW_EMPTY)
            continue;
        const bool full = to->is[e] == FLOW_FULL ? to->x[e] - n->level[e] >= -BEYOND * s->range
                                                 : to->surplus[e] > BEYOND * s->space[e];
        changed = changed || full != (to->is[e] == FLOW_FULL);
        to->is[e] = full ? FLOW_FULL : FLOW_PARTLY;
    }
    return changed;
}

/* Finds joints that have no water. false: none has changed. */
static bool sort_empty(story *s, moment *to, double left)
{
    bool changed = false;
    for (size_t e = 0; e < s->n->cells; e++)
        if (takes_part(s, e) && to->is[e] == FLOW_PARTLY &&
            to->surplus[e] + space_at(s, e, left) < -BEYOND * s->space[e]) {
            to->is[e] = FLOW_EMPTY;
            changed = true;
        }
    return changed;
}

/* Whether some joint that was taken for empty has water: then none is taken for empty any more. */
static bool refill(story *s, moment *to)
{
    const flow_net *n = s->n;
    bool wrong = false;
    for (size_t e = 0; e < n->cells && !wrong; e++)
        wrong = takes_part(s, e) && to->is[e] == FLOW_EMPTY && to->x[e] - n->level[e] > BEYOND * s->range;
    for (size_t e = 0; e < n->cells && wrong; e++)
        to->is[e] = to->is[e] == FLOW_EMPTY ? FLOW_PARTLY : to->is[e];
    return wrong;
}

/* What joints hold after h of the flow at the potentials x. */
static void pour(story *s, const moment *from, const double *x, double h, double *surplus)
{
    flow_out(s->n, x, s->out);
    for (size_t e = 0; e < s->n->cells; e++)
        surplus[e] = takes_part(s, e) ? from->surplus[e] - h * (s->out[e] + s->swell[e]) : 0;
}

/* An implicit step of h, whose end is `left` s before now. `settled` becomes false where it is not known in the end
 * what joints are. false: the equations do not converge. */
static bool take_step(story *s, const moment *from, moment *to, double h, double left, bool *settled)
{
    bool warm = true;
    memcpy(to->x, from->x, s->n->cells * sizeof *to->x);
    memcpy(to->is, from->is, s->n->cells);
    for (int i = 0; i < MOST_TRIES; i++) {
        if (!solve_for(s, from, to, h, left))
            return false;
        pour(s, from, to->x, h, to->surplus);
        if (sort_full(s, to) || sort_empty(s, to, left))
            continue;
        if (!warm || !refill(s, to))
            return true;
        warm = false;
    }
    *settled = false;
    return true;
}

/* ---------------------------------------------------------------- parts of time ---------- */

/* Largest difference of the potentials of joints, heads and drains. */
static double range_of(const story *s, const double *x)
{
    const flow_net *n = s->n;
    double least = INFINITY, most = -INFINITY;
    for (size_t e = 0; e < n->cells; e++) {
        least = takes_part(s, e) ? fmin(least, x[e]) : least;
        most = takes_part(s, e) ? fmax(most, x[e]) : most;
    }
    for (size_t c = 0; c < n->crossings; c++) {
        least = n->head[c] ? fmin(least, n->given[c]) : least;
        most = n->head[c] ? fmax(most, n->given[c]) : most;
    }
    for (size_t k = 0; k < n->hits; k++) {
        least = fmin(least, n->drain[k].phi);
        most = fmax(most, n->drain[k].phi);
    }
    return fmax(0, most - least);
}

/* Whether a joint stays what it is all the while. */
static bool stays(const story *s, size_t e)
{
    const unsigned char is = s->at[BEGUN].is[e];
    return s->at[ONE].is[e] == is && s->at[HALF].is[e] == is && s->at[TWO].is[e] == is;
}

/* Goes on by a part of h, which ends `left` s before now. The error is in units of what is allowed; `smooth`: no joint
 * changes. */
static bool try_part(story *s, double h, double left, double *error, bool *smooth)
{
    const flow_net *n = s->n;
    const moment *a = &s->at[BEGUN], *one = &s->at[ONE], *two = &s->at[TWO];
    bool settled = true;
    if (!take_step(s, a, &s->at[ONE], h, left, &settled) ||
        !take_step(s, a, &s->at[HALF], 0.5 * h, left + 0.5 * h, &settled) ||
        !take_step(s, &s->at[HALF], &s->at[TWO], 0.5 * h, left, &settled))
        return false;
    double change = range_of(s, two->x), size = 0, off = 0, water = 0;
    *smooth = true;
    for (size_t e = 0; e < n->cells; e++) {
        if (!takes_part(s, e))
            continue;
        *smooth = *smooth && stays(s, e);
        change = fmax(change, fabs(two->x[e] - a->x[e]));
        size = fmax(size, fabs(two->x[e]));
        if (stays(s, e) && two->is[e] != FLOW_PARTLY)
            off = fmax(off, fabs(two->x[e] - one->x[e]));
        else
            water = fmax(water, fabs(two->surplus[e] - one->surplus[e]) / s->space[e]);
    }
    *error = settled ? fmax(off / (STEP_ERROR * change + FLOW_CONVERGED * size), water / STEP_ERROR) : INFINITY;
    return true;
}

/* Takes over what a part of h has come to. */
static void keep_part(story *s, double h, double left, bool smooth)
{
    flow_net *n = s->n;
    moment *a = &s->at[BEGUN];
    const moment *one = &s->at[ONE], *half = &s->at[HALF], *two = &s->at[TWO];
    for (size_t e = 0; e < n->cells && smooth; e++)
        smooth = !takes_part(s, e) || 2 * two->surplus[e] - one->surplus[e] + space_at(s, e, left) >= 0 ||
                 two->is[e] == FLOW_EMPTY;
    for (size_t e = 0; e < n->cells; e++) {
        if (!takes_part(s, e))
            continue;
        const double mean = 0.5 * (half->x[e] + two->x[e]);
        a->x[e] = two->x[e] + (smooth ? two->x[e] - one->x[e] : 0);
        a->is[e] = two->is[e];
        n->x[e] = mean + (smooth ? mean - one->x[e] : 0);
        n->mean[e] += h / n->step * n->x[e];
    }
    pour(s, a, n->x, h, a->surplus);
    for (size_t e = 0; e < n->cells; e++) /* what is not full bears nothing */
        if (takes_part(s, e) && a->surplus[e] < -BEYOND * s->space[e])
            a->x[e] = fmin(a->x[e], n->level[e]);
}

static tl_status follow(story *s)
{
    flow_net *n = s->n;
    double left = n->step, h = n->step, error;
    bool smooth;
    while (left > 0) {
        h = fmin(h, left);
        const double after = h < left ? left - h : 0;
        s->range = range_of(s, s->at[BEGUN].x);
        if (!try_part(s, h, after, &error, &smooth))
            return TL_E_NUMERIC;
        if (error > 1 && h > n->step / MOST_PARTS) {
            h *= 0.5;
            continue;
        }
        keep_part(s, h, after, smooth);
        left = after;
        h *= error < 0.25 ? 2 : 1;
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- states ----------------- */

void flow_count_water(flow_net *n)
{
    double *const water = n->b->element_state[FLOW_WATER], *const space = n->b->element_state[FLOW_VOID];
    for (size_t e = 0; e < n->cells; e++) {
        if (!flow_is_wet(n, e) || n->closed[e] || (space[e] > 0 && n->b->element_state[FLOW_TIME][e] >= 0))
            continue;
        const double now = n->width[e] * n->b->element_state[FLOW_AREA][e];
        const double full = 1 + fmax(0, n->x[e] - n->level[e]) / n->p->bulk;
        water[e] = now * (space[e] > 0 ? water[e] / space[e] : full);
        space[e] = now;
    }
}

/* Makes room. false: out of memory. */
static bool begin(story *s)
{
    const size_t cells = s->n->cells;
    s->numbers = calloc((4 + 2 * (size_t)MOMENTS) * cells + 1, sizeof *s->numbers);
    s->kinds = calloc(MOMENTS * cells + 1, 1);
    if (!s->numbers || !s->kinds)
        return false;
    s->store = s->numbers;
    s->space = s->store + cells;
    s->swell = s->space + cells;
    s->out = s->swell + cells;
    for (size_t k = 0; k < MOMENTS; k++)
        s->at[k] = (moment){s->out + (1 + 2 * k) * cells, s->out + (2 + 2 * k) * cells, s->kinds + k * cells};
    return true;
}

tl_status flow_follow(flow_net *n)
{
    story s = {.n = n};
    double *const water = n->b->element_state[FLOW_WATER], *const space = n->b->element_state[FLOW_VOID];
    moment *a = &s.at[BEGUN];
    tl_status status = begin(&s) ? TL_OK : TL_E_MEMORY;
    for (size_t e = 0; status == TL_OK && e < n->cells; e++) {
        a->x[e] = n->x[e];
        if (!flow_is_wet(n, e) || n->closed[e])
            continue;
        s.space[e] = n->width[e] * n->b->element_state[FLOW_AREA][e];
        s.store[e] = s.space[e] / n->p->bulk;
        s.swell[e] = (s.space[e] - space[e]) / n->step;
        a->surplus[e] = water[e] - space[e];
        a->is[e] = a->surplus[e] >= 0 ? FLOW_FULL : a->surplus[e] > -space[e] ? FLOW_PARTLY : FLOW_EMPTY;
    }
    if (status == TL_OK)
        status = follow(&s);
    for (size_t e = 0; status == TL_OK && e < n->cells; e++) {
        n->x[e] = a->x[e];
        n->mean[e] = takes_part(&s, e) ? n->mean[e] : n->x[e];
        if (!takes_part(&s, e))
            continue;
        space[e] = s.space[e];
        water[e] = s.space[e] + a->surplus[e];
    }
    free(s.numbers);
    free(s.kinds);
    return status;
}
