/* blend.c - from segments to field contacts, while faces tilt.
 *
 * Faces that lie flush meet by segments, blocks askew by a field contact. Between them one energy, with the smoothstep
 * S(x) = x^2 (3 - 2 x), x between the two limits:
 *
 *     U = w U_f + (1 - w) U_s,    w = S(sin tilt; 5, 10 degrees)
 *
 * Segments and the field contact both go by their laws as if they bore all. What acts is that share of it. The force is
 * the gradient of the whole, with a couple
 *
 *     M = -(U_f - U_s) dw/d(tilt)
 *
 * on the segments of the faces. The tilt is that between the means, by area, of the normals of both sides of the
 * segments. With the mean vector areas N_A, N_B and c = -N_A . N_B / (|N_A| |N_B|) its cosine,
 *
 *     dc/dN_A = -(n_B + c n_A) / |N_A|,    dc/dN_B = -(n_A + c n_B) / |N_B|
 *
 * so a segment of area A and normal n turns its side A by -(U_f - U_s) dw/dc A n x dc/dN_A. Of several pairs of faces of
 * two blocks that which is tilted the least decides. */
#include "segment/blend.h"

#include "contact/detection.h"
#include "segment/side.h"
#include "zone/grid.h"

#include <math.h>

/* Tolerance: sines of 5 and 10 degrees, between which the field contact takes over: zoned faces curve by some degrees
 * and lie flush all the same. Test: property/deform_contacts. */
#define LEAST_TILT 0.087155742747658174
#define MOST_TILT 0.17364817766693033
/* Tolerance: sine of 4.8 degrees, from which on there is a field contact: before it has a share. */
#define NEARLY 0.083677843332315490

/* ---------------------------------------------------------------- shares ----------------- */

/* How two faces are tilted: cosine, sine, and slopes of the cosine by their mean vector areas, 1/m2. */
typedef struct tilt {
    double cosine, sine;
    tl_vec3 slope[2];
} tilt;

static tilt tilt_of(const tl_model *m, const tl_meet *meet)
{
    const struct tl_segments *s = m->segments;
    tl_vec3 area[2] = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t row = meet->begin; row < meet->end; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet == TL_NO_ROW)
            continue;
        area[0] = tl_v3_madd(area[0], s->table.area[row], tl_side_now_of(m, &of->a, of->normal_a).normal);
        area[1] = tl_v3_madd(area[1], s->table.area[row], tl_side_now_of(m, &of->b, of->normal_b).normal);
    }
    const tl_vec3 na = tl_v3_unit(area[0]), nb = tl_v3_unit(area[1]);
    tilt out = {.cosine = -tl_v3_dot(na, nb), .sine = tl_v3_norm(tl_v3_cross(na, nb))};
    out.slope[0] = tl_v3_scale(-1 / tl_v3_norm(area[0]), tl_v3_madd(nb, out.cosine, na));
    out.slope[1] = tl_v3_scale(-1 / tl_v3_norm(area[1]), tl_v3_madd(na, out.cosine, nb));
    return out;
}

/* The share of a field contact, with its slopes by the mean vector areas. */
static void put_share(const tilt *by, tl_blend *to)
{
    const double x = fmin(fmax((by->sine - LEAST_TILT) / (MOST_TILT - LEAST_TILT), 0), 1);
    const double rise = 6 * x * (1 - x) / (MOST_TILT - LEAST_TILT); /* by the sine */
    to->share = x * x * (3 - 2 * x);
    for (int side = 0; side < 2; side++)
        to->slope[side] = tl_v3_scale(rise > 0 ? -rise * by->cosine / by->sine : 0, by->slope[side]);
}

/* The meets of two blocks: shares, or none. */
static tl_blend blend_of(const tl_model *m, uint32_t first, uint32_t end, bool *alone)
{
    const tl_meet *meet = m->segments->meet;
    tl_blend out = {.a = meet[first].a, .b = meet[first].b, .first = first, .end = end, .meet = TL_NO_ROW};
    tilt least = {.sine = INFINITY};
    out.contact = TL_NO_ROW;
    *alone = false;
    for (uint32_t k = first; k < end; k++)
        *alone = *alone || (meet[k].area > 0 && !meet[k].tilted);
    for (uint32_t k = first; k < end && !*alone; k++) {
        if (!(meet[k].area > 0))
            continue;
        const tilt by = tilt_of(m, &meet[k]);
        if (by.sine < least.sine) {
            least = by;
            out.meet = k;
        }
    }
    if (!*alone && out.meet != TL_NO_ROW)
        put_share(&least, &out);
    *alone = *alone || least.sine < NEARLY;
    return out;
}

bool tl_blends_find(tl_model *m)
{
    struct tl_segments *s = m->segments;
    bool changed = false;
    s->blend_count = 0;
    for (uint32_t first = 0, end; first < s->meet_count; first = end) {
        for (end = first;
             end < s->meet_count && s->meet[end].a == s->meet[first].a && s->meet[end].b == s->meet[first].b;)
            end++;
        bool alone;
        const tl_blend blend = blend_of(m, first, end, &alone);
        for (uint32_t k = first; k < end; k++) {
            changed = changed || s->meet[k].alone != alone;
            s->meet[k].alone = alone;
            s->meet[k].left = 1 - blend.share;
        }
        if (!alone && blend.meet != TL_NO_ROW)
            s->blend[s->blend_count++] = blend;
    }
    return changed;
}

/* ---------------------------------------------------------------- forces ----------------- */

/* The blend of two blocks, or NULL. */
static tl_blend *find_blend(const struct tl_segments *s, tl_id a, tl_id b)
{
    size_t low = 0, high = s->blend_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const tl_blend *at = &s->blend[middle];
        if (at->a < a || (at->a == a && at->b < b))
            low = middle + 1;
        else
            high = middle;
    }
    return low < s->blend_count && s->blend[low].a == a && s->blend[low].b == b ? &s->blend[low] : NULL;
}

void tl_blends_share(tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = 0; m->segments && c->share && i < c->table.rows; i++) {
        c->share[i] = 1;
        if (!tl_blocks_deform_either(m, c->a[i], c->b[i]))
            continue;
        const tl_id a = m->blocks.id[c->a[i]], b = m->blocks.id[c->b[i]];
        tl_blend *blend = find_blend(m->segments, a < b ? a : b, a < b ? b : a);
        if (blend) {
            blend->contact = i;
            c->share[i] = blend->share;
        } else if (tl_blocks_meet(m, c->a[i], c->b[i])) {
            c->share[i] = 0;
        }
    }
}

/* The energy that the segments of two blocks would store if they bore all. */
static double stored_by(const struct tl_segments *s, const tl_blend *blend)
{
    double sum = 0;
    for (uint32_t k = blend->first; k < blend->end; k++)
        for (uint32_t row = s->meet[k].begin; row < s->meet[k].end; row++)
            sum += s->table.of[row].meet != TL_NO_ROW ? s->table.stored[row] : 0;
    return sum;
}

static void scale_segment(struct tl_segments *s, uint32_t row, double by)
{
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 9; k++)
            s->table.push[side][k][row] *= by;
    s->table.bears[row] *= by;
    s->table.stored[row] *= by;
    s->table.heat[row] *= by;
}

/* Adds what the change of the share by the tilt does to the sides of a segment. `more`: of the field's energy, J. */
static void turn_segment(tl_model *m, uint32_t row, const tl_blend *blend, double more)
{
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    for (int side = 0; side < 2; side++) {
        const tl_side_now now = tl_side_now_of(m, side ? &of->b : &of->a, side ? of->normal_b : of->normal_a);
        double sum[9] = {0};
        tl_side_turn(&now, tl_v3_scale(-more * s->table.area[row], tl_v3_cross(now.normal, blend->slope[side])), sum);
        for (int k = 0; k < 9; k++)
            s->table.push[side][k][row] += sum[k];
    }
}

void tl_blends_apply(tl_model *m)
{
    struct tl_segments *s = m->segments;
    const tl_contacts *c = &m->detect->contacts;
    for (size_t i = 0; s && i < s->blend_count; i++) {
        const tl_blend *blend = &s->blend[i];
        const bool pressed = blend->contact != TL_NO_ROW && c->whole && c->point_count[blend->contact] > 0;
        const double more = (pressed ? c->whole[blend->contact] : 0) - stored_by(s, blend);
        for (uint32_t k = blend->first; k < blend->end; k++)
            for (uint32_t row = s->meet[k].begin; row < s->meet[k].end; row++)
                if (s->table.of[row].meet != TL_NO_ROW)
                    scale_segment(s, row, s->meet[k].left);
        const tl_meet *meet = &s->meet[blend->meet];
        for (uint32_t row = meet->begin; row < meet->end; row++)
            if (s->table.of[row].meet != TL_NO_ROW)
                turn_segment(m, row, blend, more);
    }
}
