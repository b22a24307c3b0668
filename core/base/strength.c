/* strength.c - parameters with their strengths divided by a factor of safety F.
 *
 *     TL_PARAM_STRENGTH           s / F
 *     TL_PARAM_STRENGTH_ANGLE     atan(tan(angle) / F); 90 stays 90
 *     TL_PARAM_STRENGTH_DIVISOR   s F
 *     TL_PARAM_STRENGTH_ENERGY    s / F^2
 *
 * Values stay within the range of their row and the sizes that properties may have, so that a table that a kind takes
 * stays one. Angles that are equal stay equal, and the larger one stays the larger.
 *
 * Source: Matsui and San, Soils and Foundations 32 (1992) 59-70; Griffiths and Lane, Geotechnique 49 (1999)
 * 387-403. */
#include "base/strength.h"

#include "base/params.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/vmath.h>

/* Constant: degrees in a radian. */
#define DEGREES (180 / 3.14159265358979323846)

#define STRENGTHS (TL_PARAM_STRENGTH | TL_PARAM_STRENGTH_ANGLE | TL_PARAM_STRENGTH_DIVISOR | TL_PARAM_STRENGTH_ENERGY)

static bool is_strength(const tl_param *p)
{
    const bool table = p->type == TL_PARAM_POINTS && (p->flags & TL_PARAM_FLAT);
    return (p->flags & STRENGTHS) && (p->type == TL_PARAM_REAL || table);
}

bool tl_kind_has_strength(const tl_kind *kind)
{
    bool some = false;
    for (uint32_t i = 0; i < kind->param_count && !some; i++) {
        const tl_param p = tl_param_row(kind->params, i, kind->param_stride);
        some = is_strength(&p);
    }
    return some;
}

/* The value nearest to `x` that a row takes. */
static double within(const tl_param *p, double x)
{
    const double size = fabs(x);
    if (size > 0)
        x = copysign(fmin(fmax(size, TL_LEAST_PROPERTY), TL_MOST_PROPERTY), x);
    if (!tl_param_ranged(p))
        return x;
    if (x >= p->max)
        x = p->flags & TL_PARAM_MAX_OPEN ? nextafter(p->max, p->min) : p->max;
    if (x <= p->min)
        x = p->flags & TL_PARAM_MIN_OPEN ? nextafter(p->min, p->max) : p->min;
    return x;
}

static double divided(const tl_param *p, double x, double factor)
{
    if (factor == 1 || ((p->flags & TL_PARAM_STRENGTH_ANGLE) && x >= 90))
        return x;
    if (p->flags & TL_PARAM_STRENGTH_ANGLE)
        x = DEGREES * tl_atan2(tl_sin_degrees(x), factor * tl_cos_degrees(x));
    else if (p->flags & TL_PARAM_STRENGTH_DIVISOR)
        x *= factor;
    else
        x /= p->flags & TL_PARAM_STRENGTH_ENERGY ? factor * factor : factor;
    return within(p, x);
}

static tl_points points_of(const tl_param *p, const void *params)
{
    tl_points points = {NULL, 0};
    if (p->type == TL_PARAM_POINTS)
        memcpy(&points, (const char *)params + p->offset, sizeof points);
    return points;
}

/* Bytes for the values of a kind with the rows of its tables behind them. */
static size_t bytes_of(const tl_kind *kind, const void *params)
{
    size_t bytes = sizeof(tl_value);
    for (uint32_t i = 0; i < kind->param_count; i++) {
        const tl_param p = tl_param_row(kind->params, i, kind->param_stride);
        bytes += sizeof(tl_value) + points_of(&p, params).count * sizeof(tl_vec3);
    }
    return bytes;
}

bool tl_strengths_divide(const tl_kind *kind, const void *params, double factor, tl_args *args, void **held)
{
    tl_value *values = malloc(bytes_of(kind, params));
    *held = values;
    *args = (tl_args){values, 0};
    if (!values)
        return false;
    tl_vec3 *rows = (tl_vec3 *)(void *)(values + kind->param_count + 1);
    for (uint32_t i = 0; i < kind->param_count; i++) {
        const tl_param p = tl_param_row(kind->params, i, kind->param_stride);
        const tl_points points = points_of(&p, params);
        double value = NAN;
        if (!is_strength(&p))
            continue;
        if (p.type == TL_PARAM_REAL)
            memcpy(&value, (const char *)params + p.offset, sizeof value);
        if (!isnan(value)) {
            values[args->count++] = tl_arg_number(p.name, divided(&p, value, factor));
        } else if (points.count > 0) {
            for (size_t k = 0; k < points.count; k++)
                rows[k] = tl_v3(points.at[k].x, divided(&p, points.at[k].y, factor), points.at[k].z);
            values[args->count] = tl_arg_numbers(p.name, &rows->x, points.count);
            values[args->count++].type = TL_VALUE_FLAT;
            rows += points.count;
        }
    }
    return true;
}
