/* zone_edges.c - the points of zones on the edges of a block.
 *
 * An edge of length l has n = max(1, round(l / h)) equal parts. Where h is a function of place, these are parts of
 * equal
 *
 *     integral of 1 / h over the length
 *
 * which is taken at SAMPLES places, so n is that of the whole, rounded. Points depend on the edge alone, and are
 * counted from the corner with the lower key. */
#include "geometry/zone_edges.h"

#include "base/random.h"

#include <talus/vmath.h>

/* Cost only: places of an edge at which a function of place is asked. */
#define SAMPLES 64
/* Limit: parts of an edge. */
#define MOST_PARTS 100000

/* An edge from the corner with the lower key to the other. */
typedef struct span {
    uint32_t low, high;
    double length;
    double sum[SAMPLES + 1]; /* of 1 / h up to each of equal parts */
} span;

static span span_of(const tl_zone_points *p, uint32_t edge)
{
    const tl_edge *e = &p->poly->edge[edge];
    const bool forward = tl_zone_corner_key(p, e->a) < tl_zone_corner_key(p, e->b);
    span s = {.low = forward ? e->a : e->b, .high = forward ? e->b : e->a};
    s.length = tl_v3_norm(tl_v3_sub(p->poly->vertex[s.high], p->poly->vertex[s.low]));
    return s;
}

static tl_vec3 between(const tl_vec3 *x, const span *s, double t)
{
    return tl_v3_madd(x[s->low], t, tl_v3_sub(x[s->high], x[s->low]));
}

static tl_status sum_up(const tl_zone_points *p, span *s, tl_error *error)
{
    s->sum[0] = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const tl_vec3 place = between(p->poly->vertex, s, (i + 0.5) / SAMPLES);
        const double size = tl_zoning_size(p->zoning, place);
        const tl_status status = tl_zone_size_check(size, place, error);
        if (status)
            return status;
        s->sum[i + 1] = s->sum[i] + s->length / (SAMPLES * size);
    }
    return TL_OK;
}

/* The share of the length up to which the integral is a share of the whole. */
static double share_at(const span *s, double part)
{
    const double sought = part * s->sum[SAMPLES];
    int i = 0;
    while (i + 1 < SAMPLES && s->sum[i + 1] < sought)
        i++;
    return (i + (sought - s->sum[i]) / (s->sum[i + 1] - s->sum[i])) / SAMPLES;
}

static tl_status lay_one(tl_zone_points *p, uint32_t edge, tl_error *error)
{
    span s = span_of(p, edge);
    const bool graded = p->zoning->size != NULL;
    if (graded) {
        const tl_status status = sum_up(p, &s, error);
        if (status)
            return status;
    }
    const double wanted = graded ? s.sum[SAMPLES] : s.length / p->zoning->edge;
    if (!(wanted < MOST_PARTS))
        return tl_fail(error, TL_E_ARGUMENT, "an edge of %g would have %.3g zones: at most %d; make zones larger",
                       s.length, wanted, MOST_PARTS);
    const uint32_t parts = wanted < 1.5 ? 1 : (uint32_t)floor(wanted + 0.5);
    const uint64_t key = tl_key(tl_mix64(tl_zone_corner_key(p, s.low)), tl_zone_corner_key(p, s.high));
    double before = 0, shortest = 1;
    for (uint32_t k = 1; k <= parts; k++) {
        const double even = (double)k / parts, t = graded && k < parts ? share_at(&s, even) : even;
        shortest = fmin(shortest, t - before);
        before = t;
        if (k == parts)
            break;
        const tl_vec3 real = between(p->poly->vertex, &s, t), place = between(p->place, &s, t);
        const double size = tl_zoning_size(p->zoning, real);
        if (!tl_zone_points_add_outer(p, place, real, (tl_point2){t, 0}, size, tl_key(key, k)))
            return tl_fail_memory(error);
    }
    p->edge_part[edge] = shortest * s.length;
    p->shortest = fmin(p->shortest, p->edge_part[edge]);
    return TL_OK;
}

tl_status tl_zone_edges_lay(tl_zone_points *p, tl_error *error)
{
    p->shortest = INFINITY;
    for (uint32_t e = 0; e < p->poly->edge_count; e++) {
        p->edge_start[e] = p->count;
        const tl_status status = lay_one(p, e, error);
        if (status)
            return status;
    }
    p->edge_start[p->poly->edge_count] = p->edge_end = p->count;
    return TL_OK;
}
