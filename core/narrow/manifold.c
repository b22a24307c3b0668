/* manifold.c - what touches: from a pair's axis to facets with contact points.
 *
 * Every pair of faces that look at each other along the axis makes a patch (patch.c), weighted by
 * their tilt: fully up to TL_TILT_FULL, fading to nothing at TL_TILT_NONE. Where the patches' area falls
 * short of the minimum area (1 % of the smaller block's mean face, Hart, Cundall and Lemos 1988), or has been
 * lost by tilt, the rest is the *point share*: the vertices, or the edges, that the axis rests on. Blocks that meet in
 * an edge or a corner with their faces parallel get none, or eight blocks meeting in a corner would
 * have stiffness where they have no area; an absolute minimum area set by the user holds for them too
 * (crease.c). */
#include "narrow/manifold.h"

#include "base/random.h"
#include "narrow/crease.h"
#include "narrow/patch.h"
#include "narrow/room.h"
#include "narrow/share.h"

#include <stdlib.h>
#include <string.h>

/* What faces may turn, degrees, before the axis is searched again at the latest (AXIS_MOST in update.c). */
#define TURN_MOST 3.0
/* Tilt of two faces below which their edges get no point share, and from which all of it: degrees.
 * Far above the rotations of blocks in a loaded assembly, below what is seen as an edge contact. */
#define FLUSH_NONE 0.5
#define FLUSH_FULL 1.5
/* Overlap, relative to the size, up to which flush faces get none whatever their area, and from which they count as any
 * others: blocks that sink in so deep have next to no area in common to hold them. */
#define SHALLOW_FULL 0.005
#define SHALLOW_NONE 0.02
/* How near the minimum area, as a part of it, patches lack a little more than the difference: so what they lack has no
 * kink, at which the couples that go with it would jump. */
#define ENOUGH 0.5
/* Part of the minimum area below which vertices and edges have none, and from which on what is due to them: of next to
 * nothing many points would have to be looked after in every step. */
#define SLIGHT_NONE 0.1
#define SLIGHT_FULL 0.5
/* Normals whose cosines with the axis differ by less are equally near to it. */
#define SAME_COSINE 1e-9

/* ---------------------------------------------------------------- patches ---------------- */

/* Distances of a face's corners from a plane: the least and the largest. */
static void spread(const tl_poly *p, uint32_t face, const tl_vec3 *vertex, tl_vec3 n, double offset,
                   double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (uint32_t i = p->start[face]; i < p->start[face + 1]; i++) {
        double h = tl_v3_dot(n, vertex[p->loop[i]]) - offset;
        *low = fmin(*low, h);
        *high = fmax(*high, h);
    }
}

/* Two nearly parallel faces that lie nearly in one plane, be it side by side. Of blocks that rest on
 * each other elsewhere, faces can be parallel without having to do with each other. */
static bool level(const tl_pair_view *view, uint32_t fa, uint32_t fb, double near)
{
    tl_vec3 nb = view->normal_b[fb];
    double offset_b = view->b->plane[fb].offset + tl_v3_dot(nb, view->shift), low, high;
    spread(view->a, fa, view->a->vertex, nb, offset_b, &low, &high);
    if (low > near || high < -near)
        return false;
    spread(view->b, fb, view->vertex_b, view->a->plane[fa].normal, view->a->plane[fa].offset, &low,
           &high);
    return low <= near && high >= -near;
}

/* How far from each other features of touching blocks may lie and still meet. */
static double reach_of(const tl_pair_view *view, const tl_axis *axis)
{
    return TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size + 2 * fabs(axis->s);
}

/* How flush two faces are, by the sine of the angle between them: 1 parallel, 0 tilted. */
static double flushness(double sine)
{
    return tl_fade(sine, FLUSH_NONE, FLUSH_FULL);
}

/* Something that depends on the tilt of faces, and the couple on B that goes with it: its derivative
 * against B's turn, per radian; of a share, over its value. */
typedef struct tilted {
    double value;
    tl_vec3 swing;
} tilted;

/* All patches of a pair. */
typedef struct patches {
    tilted area;
    tilted faded; /* sum of each one's area times its weight, once more than the area has it */
    tilted
        flush; /* how flush the most parallel faces are that meet, by area or side by side: 1 .. 0 */
} patches;

/* Angle with the axis up to which a face looks along it, and its patches count in full, and from which they do not at all:
 * degrees. Blocks may rest on a patch whose axis is that of edges beside it. */
#define LOOK_FULL 15.0
#define LOOK_NONE 25.0
/* Cosines of the latter, and of TURN_MOST more: faces that look along the axis, and that will soon. */
#define FACING 0.90630778703664994
#define SOON 0.88294759285892699

/* The faces of B that look at A, into the list; how many will soon or do. */
static uint32_t list_looking(const tl_pair_view *view, tl_vec3 n, uint16_t *list, uint32_t *count)
{
    uint32_t soon = 0;
    *count = 0;
    for (uint32_t j = 0; j < view->b->face_count; j++) {
        double towards = -tl_v3_dot(view->normal_b[j], n);
        if (towards < SOON)
            continue;
        soon++;
        if (towards >= FACING && !view->b->covered[j])
            list[(*count)++] = (uint16_t)j;
    }
    return soon;
}

/* 1 for small overlaps, 0 for deep ones; smooth. */
static double shallow(double overlap)
{
    double x = fmin(1, fmax(0, (SHALLOW_NONE - overlap) / (SHALLOW_NONE - SHALLOW_FULL)));
    return x * x * (3 - 2 * x);
}

/* How near the last facet, a patch, is to touching: 1 when it does, 0 at the reach, smooth between. Its gap is the
 * smallest at a corner. */
static double closeness(const tl_pair_view *view, const tl_manifold *m, double reach)
{
    const tl_facet *f = &m->facets[m->facet_count - 1];
    tl_vec3 nb = view->normal_b[f->ib], rise = tl_v3_add(f->na, nb);
    double offset = f->offset + tl_v3_dot(nb, view->shift), gap = INFINITY;
    for (size_t i = f->begin; i < f->begin + (size_t)f->count; i++)
        gap = fmin(gap, tl_v3_dot(rise, m->points[i].p) - offset);
    double x = fmin(1, fmax(0, 1 - gap / reach));
    return x * x * (3 - 2 * x);
}

/* How far a face of this outward normal looks along a direction: 1 along it, 0 aside. */
static double looking(tl_vec3 normal, tl_vec3 direction)
{
    return tl_fade(tl_v3_norm(tl_v3_cross(normal, direction)), LOOK_FULL, LOOK_NONE);
}

/* The patch of two faces, and how flush they are. */
static void add_face_pair(const tl_pair_view *view, tl_vec3 n, uint32_t i, uint32_t j, double near,
                          const tl_share_rule *rule, tl_narrow *room, patches *sum)
{
    tl_manifold *m = &room->manifold;
    tl_vec3 hinge = tl_v3_cross(view->a->plane[i].normal, view->normal_b[j]);
    double sine = tl_v3_norm(hinge), area = 0; /* B turning about the hinge lessens the tilt */
    double weight = tl_fade(sine, TL_TILT_FULL, TL_TILT_NONE);
    if (!(weight > 0))
        return;
    double look = looking(view->a->plane[i].normal, n) * looking(view->normal_b[j], n);
    tl_vec3 swing =
        tl_v3_scale(tl_fade_slope(sine, TL_TILT_FULL, TL_TILT_NONE) / weight, tl_v3_unit(hinge));
    if (look > 0 && tl_manifold_reserve_facets(m, m->facet_count + 2))
        area = tl_patch_add(view, i, j, weight * look, swing, rule, room);
    if (area > 0) {
        /* one that does not touch yet must not take the share from what does */
        double close = closeness(view, m, rule->reach);
        m->brief = m->brief || close < 1;
        area *= close;
        sum->area.value += area;
        sum->area.swing = tl_v3_madd(sum->area.swing, area, swing);
        sum->faded.value += area * weight;
        sum->faded.swing = tl_v3_madd(sum->faded.swing, 2 * area * weight, swing);
    }
    double parallel = flushness(sine) * look;
    if (parallel > sum->flush.value && (area > 0 || level(view, i, j, near)))
        sum->flush =
            (tilted){parallel, tl_v3_scale(look * tl_fade_slope(sine, FLUSH_NONE, FLUSH_FULL),
                                           tl_v3_unit(hinge))};
}

static patches add_patches(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                           tl_narrow *room)
{
    const double near = reach_of(view, axis);
    void *scratch = room->dots; /* has room for more than the faces */
    uint16_t *list = scratch;
    uint32_t looking_a = 0, count;
    uint32_t looking_b = list_looking(view, axis->n, list, &count);
    patches sum = {0};
    for (uint32_t i = 0; i < view->a->face_count; i++) {
        tl_vec3 na = view->a->plane[i].normal;
        double towards = tl_v3_dot(na, axis->n);
        if (towards < SOON)
            continue;
        looking_a++;
        if (view->a->covered[i] || towards < FACING)
            continue;
        for (uint32_t k = 0; k < count; k++)
            if (tl_v3_dot(na, view->normal_b[list[k]]) < 0)
                add_face_pair(view, axis->n, i, list[k], near, rule, room, &sum);
    }
    room->manifold.lone = looking_a == 1 && looking_b == 1;
    return sum;
}

/* ---------------------------------------------------------------- all of it -------------- */

/* Scales the areas of the points from `begin` on to the sum `area`. */
static void scale_share(tl_manifold *m, size_t begin, double area)
{
    double sum = 0;
    for (size_t i = begin; i < m->point_count; i++)
        sum += m->points[i].area;
    for (size_t i = begin; i < m->point_count; i++)
        m->points[i].area *= area / sum;
}

/* Part of the minimum area that patches make unnecessary: what they have kept of theirs in spite of their tilt, on average,
 * times the part of the minimum that they would be without it. Each counts for the average as much as it has area,
 * so that it comes in with none of it. */
static tilted held_by(const patches *p, double minimum)
{
    tilted area = p->area, faded = p->faded;
    if (!(area.value > 0))
        return (tilted){0};
    double kept = faded.value / area.value, large = area.value / (kept * minimum);
    /* min(1, large), a parabola within ENOUGH of 1 */
    double x = fmin(2 * ENOUGH, fmax(0, large - (1 - ENOUGH))), slope = 1 - x / (2 * ENOUGH);
    double part = fmin(large, 1 + ENOUGH) - x * x / (4 * ENOUGH);
    tl_vec3 swing = tl_v3_scale(kept * (2 * slope * large - part), area.swing);
    swing = tl_v3_madd(swing, part - slope * large, faded.swing);
    return (tilted){kept * part, tl_v3_scale(1 / area.value, swing)};
}

/* A share of the minimum area where slight ones are left out; with its couple. */
static tilted noticed(tilted share, double minimum)
{
    double part = share.value / minimum, width = SLIGHT_FULL - SLIGHT_NONE;
    double x = fmin(1, fmax(0, (part - SLIGHT_NONE) / width));
    if (!(x > 0))
        return (tilted){0};
    double fade = x * x * (3 - 2 * x), slope = 6 * x * (1 - x) / width;
    return (tilted){share.value * fade, tl_v3_scale(1 + part * slope / fade, share.swing)};
}

void tl_manifold_build(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                       tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    m->facet_count = m->point_count = 0;
    m->failed = m->brief = false;
    patches sum = add_patches(view, axis, rule, room);
    m->patch_area = sum.area.value;
    tilted held = held_by(&sum, rule->minimum);
    tilted share = {rule->minimum * (1 - held.value),
                    tl_v3_scale(-1 / (1 - held.value), held.swing)};
    if (!rule->unconditional) {
        double beside = shallow(-axis->s / view->size);
        share.value *= 1 - beside * sum.flush.value;
        share.swing =
            tl_v3_madd(share.swing, -beside / (1 - beside * sum.flush.value), sum.flush.swing);
        share = noticed(share, rule->minimum);
    }
    if (m->failed || !(share.value > 0) || axis->s > rule->reach ||
        !tl_manifold_reserve_facets(m, m->facet_count + 3))
        return;
    size_t begin = m->point_count;
    double crease =
        rule->unconditional ? tl_crease_add(view, reach_of(view, axis), flushness, m) : 0;
    if (crease > 0) {
        scale_share(m, begin, crease * share.value);
        share.value *= 1 - crease;
        begin = m->point_count;
    }
    if (!(share.value > 0))
        return;
    tl_share_add(view, axis, share.swing, room);
    scale_share(m, begin, share.value);
}

bool tl_manifold_renew(const tl_pair_view *view, uint32_t fa, uint32_t fb,
                       const tl_share_rule *rule, tl_narrow *room)
{
    tl_manifold *m = &room->manifold;
    double sine2 = tl_v3_norm2(tl_v3_cross(view->a->plane[fa].normal, view->normal_b[fb]));
    if (rule->unconditional || sine2 > TL_FLUSH_TILT2)
        return false;
    m->failed = false;
    return tl_patch_lay(view, fa, fb, 1, rule, room) > 0;
}

/* ---------------------------------------------------------------- joint ------------------ */

/* The face whose outward normal is nearest a direction, among those that reach to within `slack` of the
 * block's end in that direction, and the cosine between them. A face can be nearer still and lie
 * elsewhere. */
static uint32_t touching_face(const tl_poly *p, const tl_vec3 *vertex, const tl_vec3 *normals,
                              size_t stride, tl_vec3 direction, double slack, double *cosine)
{
    double end = -INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        end = fmax(end, tl_v3_dot(direction, vertex[i]));
    uint32_t best = 0;
    *cosine = -2;
    for (uint32_t i = 0; i < p->face_count; i++) {
        tl_vec3 n = *(const tl_vec3 *)(const void *)((const char *)normals + i * stride);
        double c = tl_v3_dot(n, direction);
        if (c <= *cosine || p->covered[i])
            continue;
        bool touches = false;
        for (uint32_t k = p->start[i]; k < p->start[i + 1] && !touches; k++)
            touches = tl_v3_dot(direction, vertex[p->loop[k]]) >= end - slack;
        if (touches) {
            *cosine = c;
            best = i;
        }
    }
    return best;
}

static bool has_joint(const tl_poly *p)
{
    for (uint32_t i = 0; i < p->face_count; i++)
        if (p->tag[i].joint)
            return true;
    return false;
}

tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n)
{
    if (!has_joint(view->a) && !has_joint(view->b))
        return (tl_tag){0, 0};
    double ca, cb, slack = TL_CONTACT_TOLERANCE * view->size;
    uint32_t fa = touching_face(view->a, view->a->vertex, &view->a->plane[0].normal,
                                sizeof(tl_plane), n, slack, &ca);
    uint32_t fb = touching_face(view->b, view->vertex_b, view->normal_b, sizeof(tl_vec3),
                                tl_v3_neg(n), slack, &cb);
    tl_tag a = view->a->tag[fa], b = view->b->tag[fb];
    if (a.joint == 0 || b.joint == 0)
        return a.joint == 0 ? b : a;
    if (ca > cb + SAME_COSINE)
        return a;
    if (cb > ca + SAME_COSINE)
        return b;
    return a.joint < b.joint || (a.joint == b.joint && a.plane <= b.plane) ? a : b;
}
