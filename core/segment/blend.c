/* blend.c - from segments to field contacts, while faces tilt.
 *
 * Faces that lie flush meet by segments, blocks askew by a field contact. Between them one energy, with the smoothstep
 * S(x) = x^2 (3 - 2 x), x between the two limits. Of the field U_f, and of the segments U_k of each pair of faces,
 *
 *     U = w U_f + sum l_k U_k,    l_k = f_k S(r; 0.1, 0.5),    w = prod (1 - l_k)
 *     f_k = 1 - S(sin tilt; 5, 10 degrees),    r = sum f_k U_k / U_f
 *
 * so faces that bear much less than the field are none. Segments and the field contact go by their laws as if they bore
 * all. What acts is the gradient of the whole. With S' = dS/dr, E_k = U_k - U_f prod_(j != k) (1 - l_j) and
 * G = S' sum E_k f_k
 *
 *     forces of segments, and their heat, count by  l_k + G f_k / U_f,
 *     those of the field contact by                 w - G r / U_f.
 *
 * Heat may come at once, as where slip lets go what an area that went has left to the shear springs. So with the heat
 * q_k and q_f of the step what counts is the whole difference, U(U_k + q_k, U_f + q_f) - U(U_k, U_f).
 *
 * The tilt turns the segments of the faces, too: by the couple M = -(E_k S + G U_k / U_f) df_k/d(tilt). It is that
 * between the means, by area, of the normals of both sides of the segments. Let N_A and N_B be the mean vector areas.
 * With the cosine of the tilt c = -N_A . N_B / (|N_A| |N_B|)
 *
 *     dc/dN_A = -(n_B + c n_A) / |N_A|,    dc/dN_B = -(n_A + c n_B) / |N_B|
 *
 * so a segment of area A and normal n turns its side A by -(E_k S + G U_k / U_f) df_k/dc A n x dc/dN_A. */
#include "segment/blend.h"

#include "contact/detection.h"
#include "contact/index.h"
#include "segment/side.h"
#include "zone/grid.h"

#include <math.h>

/* Tolerance: sines of 5 and 10 degrees, between which the field contact takes over: zoned faces curve by some degrees
 * and lie flush all the same. Test: property/deform_properties. */
#define LEAST_TILT 0.087155742747658174
#define MOST_TILT 0.17364817766693033
/* Tolerance: sine of 4.8 degrees, from which on there is a field contact: before it has a share. */
#define NEARLY 0.083677843332315490

/* Tolerance: share of the smaller face from which on flush faces bear all: of others the field may have more. */
#define MOST_OF 0.5

/* Limit: pairs of faces of two blocks that take part. Convex blocks have three or so within 12 degrees. */
#define MOST_BLENDED 16

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

/* What the tilt of two faces leaves them. */
static void put_tilt(const tilt *by, tl_meet *to)
{
    const double x = fmin(fmax((by->sine - LEAST_TILT) / (MOST_TILT - LEAST_TILT), 0), 1);
    const double rise = 6 * x * (1 - x) / (MOST_TILT - LEAST_TILT); /* by the sine */
    to->flat = 1 - x * x * (3 - 2 * x);
    to->steep = rise > 0 ? rise * by->cosine / by->sine : 0;
    to->by[0] = by->slope[0];
    to->by[1] = by->slope[1];
}

/* The meets of two blocks: whether they meet by segments alone. */
static bool tilt_meets(tl_model *m, uint32_t first, uint32_t end)
{
    tl_meet *meet = m->segments->meet;
    bool alone = false;
    for (uint32_t k = first; k < end; k++) {
        tilt by = {.cosine = 1};
        if (meet[k].tilted && meet[k].area > 0)
            by = tilt_of(m, &meet[k]);
        put_tilt(&by, &meet[k]);
        alone = alone || (by.sine < NEARLY && meet[k].area > MOST_OF * meet[k].size);
    }
    return alone;
}

/* Notes when the two blocks of some meets have met: when their contact began, if they have one. */
static void put_born(tl_model *m, uint32_t first, uint32_t end, bool touch)
{
    tl_meet *meet = m->segments->meet;
    int64_t born = -1;
    for (uint32_t k = first; k < end; k++)
        born = meet[k].born > born ? meet[k].born : born;
    if (touch && born < 0) {
        const uint32_t contact = tl_contact_row(m, meet[first].a, meet[first].b);
        born = contact == TL_NO_ROW ? m->cycles : m->detect->contacts.born[contact];
    }
    for (uint32_t k = first; k < end; k++)
        meet[k].born = touch ? born : -1;
}

bool tl_blends_find(tl_model *m)
{
    struct tl_segments *s = m->segments;
    bool changed = false;
    s->blend_count = 0;
    s->blend_stored = s->blend_heat = 0;
    for (uint32_t first = 0, end; first < s->meet_count; first = end) {
        const tl_id a = s->meet[first].a, b = s->meet[first].b;
        for (end = first; end < s->meet_count && s->meet[end].a == a && s->meet[end].b == b;)
            end++;
        const bool alone = tilt_meets(m, first, end);
        double area = 0;
        for (uint32_t k = first; k < end; k++) {
            changed = changed || s->meet[k].alone != alone;
            s->meet[k].alone = alone;
            area += s->meet[k].area;
        }
        put_born(m, first, end, area > 0);
        if (area > 0)
            s->blend[s->blend_count++] = (tl_blend){a, b, first, end, TL_NO_ROW};
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
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = 0; m->segments && c->share && i < c->table.rows; i++) {
        c->share[i] = 1;
        c->heat[i] = 0; /* of one without a law or room for points it stays so */
        if (!tl_blocks_deform_either(m, c->a[i], c->b[i]))
            continue;
        const tl_id a = m->blocks.id[c->a[i]], b = m->blocks.id[c->b[i]];
        tl_blend *blend = find_blend(m->segments, a < b ? a : b, a < b ? b : a);
        if (blend) {
            blend->contact = i;
            c->born[i] = m->segments->meet[blend->first].born; /* it goes on as the same contact */
        }
        if (tl_blocks_meet(m, c->a[i], c->b[i]))
            c->share[i] = 0;
    }
}

/* The energy that the segments of a meet would store if they bore all, and their heat of the step. */
static void sum_rows(const struct tl_segments *s, const tl_meet *meet, double *stored, double *heat)
{
    *stored = *heat = 0;
    for (uint32_t row = meet->begin; row < meet->end; row++)
        if (s->table.of[row].meet != TL_NO_ROW) {
            *stored += s->table.stored[row];
            *heat += s->table.heat[row];
        }
}

/* Lets so much of a segment's forces and energy act. */
static void scale_segment(struct tl_segments *s, uint32_t row, double forces, double energy)
{
    for (int side = 0; side < 2; side++)
        for (int corner = 0; corner < 3; corner++)
            for (int k = 0; k < 4; k++)
                s->table.push[row].of[side][corner][k] *= forces;
    s->table.bears[row] *= forces;
    s->table.stored[row] *= energy;
    s->table.heat[row] *= forces;
}

/* Adds what the change of its share by the tilt does to the sides of a segment. `more`: that of the energy, J, by the
 * cosine. */
static void turn_segment(tl_model *m, uint32_t row, const tl_meet *meet, double more)
{
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    for (int side = 0; side < 2; side++) {
        const tl_side_now now = tl_side_now_of(m, side ? &of->b : &of->a, side ? of->normal_b : of->normal_a);
        double sum[9] = {0};
        tl_side_turn(&now, tl_v3_scale(-more * s->table.area[row], tl_v3_cross(now.normal, meet->by[side])), sum);
        for (int corner = 0; corner < 3; corner++) {
            double *to = s->table.push[row].of[side][corner];
            for (int k = 0; k < 3; k++)
                to[k] += sum[3 * corner + k];
            to[3] = tl_v3_norm(tl_v3(to[0], to[1], to[2]));
        }
    }
}

/* Tolerance: energy of the segments of two faces over that of the field below which they are none, and from which on
 * they are all: as of patches (narrow/share.c). */
#define LEAST_PART 0.1
#define MOST_PART 0.5

/* The meets of two blocks: their energies, their heat of the step, and how much of them counts. */
typedef struct parts {
    uint32_t count;
    double energy[MOST_BLENDED], heat[MOST_BLENDED], share[MOST_BLENDED];
    double field, ratio, step, slope; /* U_f, r, S and S' */
} parts;

/* Finds how much of each counts, by their energies. */
static void find_shares(const struct tl_segments *s, const tl_blend *blend, parts *of)
{
    double sum = 0;
    of->ratio = of->slope = 0;
    of->step = 1;
    for (uint32_t k = 0; k < of->count; k++)
        sum += s->meet[blend->first + k].flat * of->energy[k];
    if (of->field > 0) {
        of->ratio = sum / of->field;
        const double x = fmin(fmax((of->ratio - LEAST_PART) / (MOST_PART - LEAST_PART), 0), 1);
        of->step = x * x * (3 - 2 * x);
        of->slope = 6 * x * (1 - x) / (MOST_PART - LEAST_PART);
    }
    for (uint32_t k = 0; k < of->count; k++)
        of->share[k] = s->meet[blend->first + k].area > 0 ? s->meet[blend->first + k].flat * of->step : 0;
}

static parts parts_of(const struct tl_segments *s, const tl_blend *blend, double field)
{
    parts out = {.count = blend->end - blend->first, .field = field};
    out.count = out.count < MOST_BLENDED ? out.count : MOST_BLENDED;
    for (uint32_t k = 0; k < out.count; k++)
        sum_rows(s, &s->meet[blend->first + k], &out.energy[k], &out.heat[k]);
    find_shares(s, blend, &out);
    return out;
}

/* What the meets leave to the field, but for one of them, or TL_NO_ROW. */
static double rest_of(const parts *of, uint32_t without)
{
    double rest = 1;
    for (uint32_t k = 0; k < of->count; k++)
        rest *= k != without ? 1 - of->share[k] : 1;
    return rest;
}

/* The energy of all of it. */
static double whole_of(const parts *of)
{
    double sum = of->field * rest_of(of, TL_NO_ROW);
    for (uint32_t k = 0; k < of->count; k++)
        sum += of->share[k] * of->energy[k];
    return sum;
}

/* The heat of a step in which the field contact has made some. */
static double heat_of(const struct tl_segments *s, const tl_blend *blend, const parts *now, double by_field)
{
    parts before = *now;
    before.field += by_field;
    for (uint32_t k = 0; k < now->count; k++)
        before.energy[k] += before.heat[k];
    find_shares(s, blend, &before);
    return whole_of(&before) - whole_of(now);
}

static void apply_blend(tl_model *m, const tl_blend *blend)
{
    struct tl_segments *s = m->segments;
    const tl_contacts *c = &m->detect->contacts;
    const uint32_t i = blend->contact;
    const bool alone = s->meet[blend->first].alone;
    if (alone && i == TL_NO_ROW && blend->end == blend->first + 1) { /* as most */
        s->meet[blend->first].counts = 1;
        return;
    }
    const bool pressed = i != TL_NO_ROW && !alone && c->point_count[i] > 0 && c->law[i] != TL_NO_ROW;
    const parts of = parts_of(s, blend, pressed ? c->stored[i] : 0);
    const double rest = alone ? 0 : rest_of(&of, TL_NO_ROW), per = of.field > 0 ? 1 / of.field : 0;
    double more[MOST_BLENDED], grows = 0, counted = 0;
    for (uint32_t k = 0; k < of.count; k++) {
        more[k] = of.energy[k] - (alone ? 0 : of.field * rest_of(&of, k));
        grows += of.slope * more[k] * s->meet[blend->first + k].flat;
    }
    for (uint32_t k = 0; k < of.count; k++) {
        tl_meet *meet = &s->meet[blend->first + k];
        const double forces = of.share[k] + per * grows * meet->flat;
        const double turns = meet->steep * (more[k] * of.step + per * grows * of.energy[k]);
        meet->counts = forces;
        counted += forces * of.heat[k];
        for (uint32_t row = meet->begin; row < meet->end; row++) {
            if (s->table.of[row].meet == TL_NO_ROW)
                continue;
            scale_segment(s, row, forces, of.share[k]);
            if (turns != 0)
                turn_segment(m, row, meet, turns);
        }
    }
    if (i == TL_NO_ROW)
        return;
    const double by_field = rest - per * grows * of.ratio;
    c->share[i] = rest;
    c->force[i] = tl_v3_scale(by_field, c->force[i]);
    c->moment[i] = tl_v3_scale(by_field, c->moment[i]);
    if (c->point_capacity[i] > 0 && c->law[i] != TL_NO_ROW) /* else it is not counted (cycle/contact_forces.c) */
        s->blend_stored += (1 - rest) * c->stored[i];
    const bool both = of.field > 0 && of.field + c->heat[i] > 0;
    s->blend_heat += c->heat[i] + (both ? counted - heat_of(s, blend, &of, c->heat[i]) : -by_field * c->heat[i]);
}

void tl_blends_apply(tl_model *m)
{
    struct tl_segments *s = m->segments;
    s->blend_stored = s->blend_heat = 0;
    for (size_t i = 0; i < s->blend_count; i++)
        apply_blend(m, &s->blend[i]);
}
