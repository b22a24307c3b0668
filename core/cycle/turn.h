/* turn.h - how a body moves in a step: kicks of its velocity, (23) of Hart, Cundall and Lemos (1988), finite turns, and
 * its free rotation.
 *
 * `series` is a constant where these functions are called. With it they are straight-line arithmetic that the compiler
 * can put into SIMD lanes, for half angles below TL_SERIES_HALF_ANGLE. Without it they use trigonometry. */
#ifndef TL_CYCLE_TURN_H
#define TL_CYCLE_TURN_H

#include "base/inline.h"
#include "base/series.h"

#include <math.h>
#include <stdbool.h>
#include <talus/vmath.h>

/* A velocity, or an angular momentum, after a kick of `span` s: v <- (D1 v + per F) D2, D1 = 1 - alpha span / 2,
 * D2 = 1 / (1 + alpha span / 2). `per`: the span over the inertia that the force F meets. */
TL_INLINE tl_vec3 tl_kick(tl_vec3 v, tl_vec3 force, double per, double alpha, double span)
{
    double d1 = 1 - 0.5 * alpha * span, d2 = 1 / (1 + 0.5 * alpha * span);
    return tl_v3_scale(d2, tl_v3_madd(tl_v3_scale(d1, v), per, force));
}

/* Cosine and sine of half an angle. */
typedef struct tl_half_turn {
    double c, s;
} tl_half_turn;

TL_INLINE double tl_cos_series(double h2)
{
    return 1 - h2 * (1. / 2 - h2 * (1. / 24 - h2 * (1. / 720 - h2 * (1. / 40320))));
}

/* sin(h) / h */
TL_INLINE double tl_sinc_series(double h2)
{
    return 1 - h2 * (1. / 6 - h2 * (1. / 120 - h2 * (1. / 5040 - h2 * (1. / 362880))));
}

/* From half the angle. */
TL_INLINE tl_half_turn tl_half_turn_of(double h, bool series)
{
    if (series) {
        double h2 = h * h;
        return (tl_half_turn){tl_cos_series(h2), h * tl_sinc_series(h2)};
    }
    return (tl_half_turn){tl_cos(h), tl_sin(h)};
}

/* The quaternion of a turn: along `rotation`, by its length. */
TL_INLINE tl_quat tl_turn_by(tl_vec3 rotation)
{
    double h2 = 0.25 * tl_v3_norm2(rotation), c, s; /* s: sin(h) / h */
    if (h2 < TL_SERIES_HALF_ANGLE * TL_SERIES_HALF_ANGLE) {
        c = tl_cos_series(h2);
        s = tl_sinc_series(h2);
    } else {
        double h = sqrt(h2);
        c = tl_cos(h);
        s = tl_sin(h) / h;
    }
    return (tl_quat){c, 0.5 * s * rotation.x, 0.5 * s * rotation.y, 0.5 * s * rotation.z};
}

/* The one turn a quaternion makes: axis times angle, the inverse of tl_turn_by. */
TL_INLINE tl_vec3 tl_turn_of(tl_quat q, bool series)
{
    double s2 = q.x * q.x + q.y * q.y + q.z * q.z, k; /* k: angle / sine of its half */
    if (series) {
        k = 2 * (1 + s2 * (1. / 6 + s2 * (3. / 40 + s2 * (5. / 112 + s2 * (35. / 1152 + s2 * (63. / 2816))))));
    } else {
        double s = sqrt(s2);
        k = s > 0 ? 2 * tl_atan2(s, q.w) / s : 2;
    }
    return tl_v3(k * q.x, k * q.y, k * q.z);
}

/* A quaternion that is a unit but for rounding, made one: a step of Newton's, so 1 stays 1. */
TL_INLINE tl_quat tl_q_trim(tl_quat q)
{
    double s = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (tl_quat){s * q.w, s * q.x, s * q.y, s * q.z};
}

/* What a body's free rotation does in a step: all in principal axes. */
typedef struct tl_free_turn {
    tl_quat made;     /* from the attitude before to the one after, in the one before */
    tl_vec3 momentum; /* angular momentum in the attitude after */
    double reach;     /* no half angle, of a part or the whole, has a larger square */
} tl_free_turn;

/* The vector's components p and q turned against the angle: seen from axes that turn with it. */
TL_INLINE void tl_turn_back(tl_half_turn t, double *p, double *q)
{
    double sine = 2 * t.s * t.c, versine = 2 * t.s * t.s;
    double a = *p, b = *q;
    *p = a - versine * a + sine * b;
    *q = b - versine * b - sine * a;
}

/* The free rotation for a time `dt`, split into turns about the principal axes x, y, z, y, x (Dullweber,
 * Leimkuhler and McLachlan 1997). `l`: angular momentum, `per`: 1 / moments of inertia. */
TL_INLINE tl_free_turn tl_turn_freely(tl_vec3 l, tl_vec3 per, double dt, bool series)
{
    double quarter = 0.25 * dt;
    double h1 = quarter * per.x * l.x;
    tl_half_turn a = tl_half_turn_of(h1, series);
    tl_turn_back(a, &l.y, &l.z);
    double h2 = quarter * per.y * l.y;
    tl_half_turn b = tl_half_turn_of(h2, series);
    tl_turn_back(b, &l.z, &l.x);
    double h3 = 2 * quarter * per.z * l.z;
    tl_half_turn c = tl_half_turn_of(h3, series);
    tl_turn_back(c, &l.x, &l.y);
    double h4 = quarter * per.y * l.y;
    tl_half_turn d = tl_half_turn_of(h4, series);
    tl_turn_back(d, &l.z, &l.x);
    double h5 = quarter * per.x * l.x;
    tl_half_turn e = tl_half_turn_of(h5, series);
    tl_turn_back(e, &l.y, &l.z);
    /* the product of the five, each with one component besides w */
    tl_quat q = {a.c * b.c, a.s * b.c, a.c * b.s, a.s * b.s};
    q = (tl_quat){q.w * c.c - q.z * c.s, q.x * c.c + q.y * c.s, q.y * c.c - q.x * c.s, q.z * c.c + q.w * c.s};
    q = (tl_quat){q.w * d.c - q.y * d.s, q.x * d.c - q.z * d.s, q.y * d.c + q.w * d.s, q.z * d.c + q.x * d.s};
    q = (tl_quat){q.w * e.c - q.x * e.s, q.x * e.c + q.w * e.s, q.y * e.c + q.z * e.s, q.z * e.c - q.y * e.s};
    return (tl_free_turn){q, l, 2 * (h1 * h1 + h2 * h2 + h3 * h3 + h4 * h4 + h5 * h5)};
}

#endif
