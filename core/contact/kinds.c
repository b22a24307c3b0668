/* kinds.c - patches and field contacts: where they are, what they bear, and what is kept and shown of them. */
#include "contact/kinds.h"

#include "base/columns.h"
#include "contact/lean.h"
#include "contact/pair_view.h"
#include "narrow/region.h"

#include <math.h>

/* ---------------------------------------------------------------- patches ---------------- */

static tl_facing patch_facing(const tl_facet *f, const tl_body_frames *at)
{
    return tl_facing_patch(tl_m3_mul(at->ra, f->na), tl_m3_mul(at->rb, f->nb), at->d, f->offset, f->ride);
}

static tl_facing_place patch_place(const tl_facet *f, const tl_body_frames *at)
{
    return tl_facing_ride(at->ra, at->rb, at->d, &f->laid.turn, f->laid.shift, f->ride);
}

static uint32_t patch_areas(uint32_t points)
{
    return points;
}

/* As the points were laid: what blocks have moved since would count for one side only. */
static tl_spread patch_bounds(const tl_model *m, uint32_t c, bool of_b)
{
    const tl_points_table *p = &m->detect->points;
    const tl_vec3 centre = of_b ? m->detect->contacts.facet[c].laid.shift : tl_v3(0, 0, 0);
    tl_spread out = {0, 0};
    for (uint32_t k = 0; k < m->detect->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, c, k);
        out.sum += p->area[i];
        out.r2 += p->area[i] * tl_v3_norm2(tl_v3_sub(tl_columns_get(p->p, i), centre));
    }
    return out;
}

/* A patch, whose area counts before it touches, has besides its overlap the gap at which it is born: with that, blocks
 * that come faster may press on by other faces. */
static double patch_pressed(const tl_model *m, uint32_t c, double law, tl_vec3 *arm)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t count = contacts->point_count[c];
    tl_vec3 mean = {0, 0, 0};
    for (uint32_t k = 0; k < count; k++)
        mean = tl_v3_madd(mean, 1.0 / count, tl_columns_get(m->detect->points.p, tl_point_row(contacts, c, k)));
    const tl_sides s = tl_contact_sides(m, c);
    const tl_body_frames frames = {tl_side_rotation(m, s.a), tl_side_rotation(m, s.b), tl_sides_apart(m, s)};
    const tl_facing_place place = patch_place(&contacts->facet[c], &frames);
    *arm = tl_v3_add(tl_m3_mul(&place.to, mean), place.at);
    double size = tl_contact_size(m, c);
    return tl_v3_norm(contacts->force[c]) / (law * contacts->area[c]) + TL_CONTACT_TOLERANCE * size;
}

static bool patch_show(tl_model *m, uint32_t c, const tl_pair_view *view, tl_narrow_scratch *scratch,
                       tl_surface *surface)
{
    (void)scratch;
    const tl_facet *f = &m->detect->contacts.facet[c];
    return tl_surface_add_patch(view, f->ia, f->ib, surface);
}

static bool patch_sound(const tl_detect *d, uint32_t c, uint32_t faces_a, uint32_t faces_b)
{
    return d->contacts.facet[c].ia < faces_a && d->contacts.facet[c].ib < faces_b;
}

/* How its points ride. */
static void patch_hash(tl_hash *hash, const tl_detect *d, uint32_t c)
{
    const tl_facet *f = &d->contacts.facet[c];
    tl_hash_numbers(hash, &f->ride, 1);
    tl_hash_numbers(hash, &f->laid.turn.m[0][0], 9);
    tl_hash_numbers(hash, &f->laid.shift.x, 3);
}

const tl_kind_place tl_patch_place = {.facing = patch_facing,
                                      .place = patch_place,
                                      .areas = patch_areas,
                                      .bounds = patch_bounds,
                                      .pressed = patch_pressed,
                                      .show = patch_show,
                                      .sound = patch_sound,
                                      .hash = patch_hash};

/* ---------------------------------------------------------------- field contacts --------- */

/* Tolerance: stiffness of a corner that is pressed in twice as deep, over what it is. */
#define TWICE_AS_DEEP 4

static tl_facing field_facing(const tl_facet *f, const tl_body_frames *at)
{
    return tl_facing_field(tl_m3_mul(at->ra, f->na), f->offset);
}

static tl_facing_place field_place(const tl_facet *f, const tl_body_frames *at)
{
    (void)f;
    return (tl_facing_place){*at->ra, {0, 0, 0}};
}

/* Both its points lie at the centre of pressure, with all of its area. */
static uint32_t field_areas(uint32_t points)
{
    return points ? 1 : 0;
}

static tl_spread field_bounds(const tl_model *m, uint32_t c, bool of_b)
{
    const tl_press *press = &m->detect->press[m->detect->contacts.press[c]].press;
    const tl_sides s = tl_contact_sides(m, c);
    tl_vec3 centre = {0, 0, 0};
    if (of_b)
        centre = tl_m3_tmul(tl_side_rotation(m, s.a), tl_sides_apart(m, s));
    double r2 = tl_v3_norm2(tl_v3_sub(press->point, centre)) + press->radius * press->radius;
    double stiffness = TWICE_AS_DEEP * press->stiffness;
    return (tl_spread){stiffness, stiffness * r2};
}

static double field_pressed(const tl_model *m, uint32_t c, double law, tl_vec3 *arm)
{
    (void)law;
    const tl_press *press = &m->detect->press[m->detect->contacts.press[c]].press;
    *arm = tl_side_arm(m, tl_contact_sides(m, c).a, press->point);
    return press->overlap;
}

static bool field_show(tl_model *m, uint32_t c, const tl_pair_view *view, tl_narrow_scratch *scratch,
                       tl_surface *surface)
{
    tl_region region;
    tl_press_query query = {.view = view, .region = &region};
    const tl_press_row *row = tl_press_row_of(m, c);
    double reach = 0; /* how far apart blocks with moved faces may be */
    if (row && (row->shift != 0 || row->leans)) {
        query.shift = row->shift;
        query.shifted = row->shifted;
        query.lean = row->leans ? row->lean : NULL;
        reach = tl_lean_reach(row->shift, query.lean, view->a->plane[row->shifted.a].normal, view->size);
    }
    return tl_region_find(view, reach, scratch, &region) && tl_surface_add_field(&query, surface);
}

static bool field_sound(const tl_detect *d, uint32_t c, uint32_t faces_a, uint32_t faces_b)
{
    (void)faces_a, (void)faces_b;
    return d->contacts.point_count[c] == TL_FIELD_POINTS && d->contacts.press[c] != TL_NO_ROW;
}

/* Where it has stayed, since when, and whether it goes by slopes from there. */
static void field_hash(tl_hash *hash, const tl_detect *d, uint32_t c)
{
    if (d->contacts.point_count[c] == 0 || d->contacts.press[c] == TL_NO_ROW)
        return;
    const tl_press_row *row = &d->press[d->contacts.press[c]];
    tl_hash_numbers(hash, &row->place.turn.m[0][0], 9);
    tl_hash_numbers(hash, &row->place.shift.x, 3);
    tl_hash_word(hash, (uint64_t)row->since);
    tl_hash_word(hash, row->by_slope);
}

const tl_kind_place tl_field_place = {.facing = field_facing,
                                      .place = field_place,
                                      .areas = field_areas,
                                      .bounds = field_bounds,
                                      .quick = true,
                                      .pressed = field_pressed,
                                      .show = field_show,
                                      .sound = field_sound,
                                      .hash = field_hash};
