/* share.c - from the patch of two flush faces to the field of the blocks:
 *
 *     w = 1 - (1 - S(sin tilt)) (1 - S(q)) S(G_p / G_f),    q = (4 G_p)^(3/2) / V_p^2 - shift (4 G_p)^(1/2) / V_p
 *
 * with the smoothstep S. q is the overlap of the patch as it is, without the shift of moved faces, over the root of its area. Where the
 * patch has not nearly the energy of the field, other faces press: beside a seam it may be a sliver of next to nothing. */
#include "narrow/share.h"

#include "narrow/flush.h"

#include <math.h>
#include <talus/vmath.h>

/* Energy of the patch over that of the field up to which there is no patch, and from which on there is all of it. Patches have nearly
 * that of their field, or more where springs are at corners. */
#define SLIVER 0.1
#define WHOLE 0.5

/* Smoothstep from 0 at `low` to 1 at `high`, and its slope. */
static double step(double x, double low, double high, double *slope)
{
    double t = fmin(1, fmax(0, (x - low) / (high - low)));
    *slope = 6 * t * (1 - t) / (high - low);
    return t * t * (3 - 2 * t);
}

/* Less where the patch is a sliver. */
static void take_slivers(const tl_field_sums *patch, const tl_field_sums *field, tl_patch_share *to)
{
    double ratio = patch->energy / field->energy, slope, share = to->share;
    double part = step(ratio, SLIVER, WHOLE, &slope);
    if (ratio >= WHOLE)
        return;
    double by = share * slope / field->energy;
    tl_vec3 push = tl_v3_sub(tl_v3_scale(ratio, field->force), patch->force);
    tl_vec3 turn = tl_v3_sub(tl_v3_scale(ratio, field->moment), patch->moment);
    to->share *= part;
    to->push = tl_v3_madd(tl_v3_scale(part, to->push), by, push);
    to->turn = tl_v3_madd(tl_v3_scale(part, to->turn), by, turn);
}

tl_patch_share tl_patch_share_of(const tl_vec3 *na, const tl_vec3 *nb, bool corners, double shift,
                                 const tl_field_sums *patch, const tl_field_sums *field)
{
    const tl_flush_limits limits = tl_flush_limits_of(corners);
    tl_vec3 hinge = tl_v3_cross(*na, *nb);
    double sine = tl_v3_norm(hinge), g = patch->energy, v = patch->volume, by_tilt, by_q;
    double whole = 8 * g * sqrt(g) / (v * v), moved = 2 * shift * sqrt(g) / v;
    double tilted = step(sine, limits.tilt, limits.field_tilt, &by_tilt);
    double deep = step(whole - moved, limits.depth, limits.field_depth, &by_q);
    tl_patch_share out = {.share = (1 - tilted) * (1 - deep)};
    double scale = (1 - tilted) * by_q * whole, less = (1 - tilted) * by_q * moved;
    double by_g = 1.5 * scale / g - 0.5 * less / g, by_v = 2 * scale / v - less / v;
    double couple = sine > 0 ? -(1 - deep) * by_tilt * tl_v3_dot(*na, *nb) / sine : 0;
    out.push = tl_v3_madd(tl_v3_scale(by_g, patch->force), -by_v, patch->swept);
    out.turn = tl_v3_madd(tl_v3_scale(by_g, patch->moment), -by_v, patch->swept_moment);
    out.turn = tl_v3_madd(out.turn, couple, hinge);
    take_slivers(patch, field, &out);
    return out;
}
