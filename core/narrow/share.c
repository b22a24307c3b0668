/* share.c - the share of a patch in what two blocks press with.
 *
 * From the patch of two flush faces to the field of the blocks:
 *
 *     w = 1 - (1 - S(sin tilt)) (1 - S(q)) S(G_p / G_f),    q = (4 G_p)^(3/2) / V_p^2 - shift (4 G_p)^(1/2) / V_p
 *
 * with the smoothstep S. q is the overlap of the patch as it is, without the shift of moved faces, over the root of
 * its area. Where the patch has not nearly the energy of the field, other faces press. Beside a seam it may be a
 * sliver of next to nothing.
 *
 * Springs at corners have sums in the place of integrals, and V_p = sum A_k o_k has a kink where a corner parts. So
 * would the energy. Of them q is, with J = 1/12 sum A_k o_k^3 and the same value under an even overlap,
 *
 *     q = (12 J)^2 / (4 G_p)^(5/2) - shift 12 J / (4 G_p)^(3/2) */
#include "narrow/share.h"

#include "narrow/flush.h"

#include <math.h>
#include <talus/vmath.h>

/* Tolerance: energy of the patch over that of the field up to which there is no patch, and from which on there is all
 * of it. Patches have nearly that of their field, or more where springs are at corners. */
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

/* The overlap of a patch over the root of its area: in all, and what the shift of its faces is of it. And how both go
 * with the logarithms of G_p and of another integral, V_p or J. */
typedef struct patch_depth {
    double whole, moved, other; /* the other integral */
    double whole_by[2], moved_by[2];
    tl_vec3 force, moment; /* minus the gradient of the other integral */
} patch_depth;

static patch_depth depth_of(bool corners, double shift, const tl_field_sums *patch)
{
    const double g = patch->energy, v = patch->volume, root = sqrt(g);
    const tl_field_power *j = &patch->powers[0];
    if (corners)
        return (patch_depth){.whole = 4.5 * j->whole * j->whole / (g * g * root),
                             .moved = 1.5 * shift * j->whole / (g * root),
                             .other = j->whole,
                             .whole_by = {-2.5, 2},
                             .moved_by = {-1.5, 1},
                             .force = j->force,
                             .moment = j->moment};
    return (patch_depth){.whole = 8 * g * root / (v * v),
                         .moved = 2 * shift * root / v,
                         .other = v,
                         .whole_by = {1.5, -2},
                         .moved_by = {0.5, -1},
                         .force = patch->swept,
                         .moment = patch->swept_moment};
}

tl_patch_share tl_patch_share_of(const tl_vec3 *na, const tl_vec3 *nb, bool corners, double shift,
                                 const tl_field_sums *patch, const tl_field_sums *field)
{
    const tl_flush_limits limits = tl_flush_limits_of(corners);
    const patch_depth q = depth_of(corners, shift, patch);
    tl_vec3 hinge = tl_v3_cross(*na, *nb);
    double sine = tl_v3_norm(hinge), by_tilt, by_q;
    double tilted = step(sine, limits.tilt, limits.field_tilt, &by_tilt);
    double deep = step(q.whole - q.moved, limits.depth, limits.field_depth, &by_q);
    tl_patch_share out = {.share = (1 - tilted) * (1 - deep)};
    double scale = (1 - tilted) * by_q * q.whole, less = (1 - tilted) * by_q * q.moved;
    double by_g = (q.whole_by[0] * scale - q.moved_by[0] * less) / patch->energy;
    double by_other = (q.whole_by[1] * scale - q.moved_by[1] * less) / q.other;
    double couple = sine > 0 ? -(1 - deep) * by_tilt * tl_v3_dot(*na, *nb) / sine : 0;
    out.push = tl_v3_madd(tl_v3_scale(by_g, patch->force), by_other, q.force);
    out.turn = tl_v3_madd(tl_v3_scale(by_g, patch->moment), by_other, q.moment);
    out.turn = tl_v3_madd(out.turn, couple, hinge);
    take_slivers(patch, field, &out);
    return out;
}
