/* params.c - random deviations of the planes of a joint set, each a pure function of model seed, set,
 * plane and quantity.
 *
 * Normal: Box and Muller's transform of two uniform numbers, drawn again while it falls beyond the limit
 * (at 3 standard deviations that is one in 370). Fisher (Proc. R. Soc. Lond. A 217 (1953) 295-305): with
 * density proportional to exp(k cos t) on the sphere,
 *
 *     1 - cos t = -ln(1 - u (1 - exp(-2 k))) / k,   azimuth = 360 deg v,   u, v uniform in [0, 1). */
#include "draw.h"

#include <talus/vmath.h>

/* After so many draws beyond the limit the number is taken as the mean: with limit >= 1 that has a
 * chance of 1e-32. */
#define MOST_ATTEMPTS 64

static double draw_one(const draws *d, int64_t index, uint32_t draw)
{
    return d->host->random(d->host, d->joint, d->first + index, draw);
}

double draw_even(const draws *d, int64_t index, uint32_t kind)
{
    return 2 * draw_one(d, index, kind) - 1;
}

double draw_normal(const draws *d, int64_t index, uint32_t kind, double limit)
{
    for (uint32_t attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        uint32_t draw = kind + 2 * DRAW_KINDS * attempt;
        double u = draw_one(d, index, draw), v = draw_one(d, index, draw + DRAW_KINDS);
        /* 1 - u is in (0, 1], so the logarithm is finite */
        double z = sqrt(-2 * tl_log1p(-u)) * tl_cos_degrees(360 * v);
        if (fabs(z) < limit)
            return z;
    }
    return 0;
}

tl_vec3 draw_fisher(const draws *d, int64_t index, tl_vec3 mean, double k)
{
    double u = draw_one(d, index, DRAW_DIP), azimuth = 360 * draw_one(d, index, DRAW_DIRECTION);
    double drop = fmin(-tl_log1p(u * tl_expm1(-2 * k)) / k, 2);
    double sine = sqrt(drop * (2 - drop));
    tl_vec3 e = tl_v3_perpendicular(mean), f = tl_v3_cross(mean, e);
    tl_vec3 side = tl_v3_madd(tl_v3_scale(tl_cos_degrees(azimuth), e), tl_sin_degrees(azimuth), f);
    return tl_v3_unit(tl_v3_madd(tl_v3_scale(1 - drop, mean), sine, side));
}
