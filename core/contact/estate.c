/* estate.c - what a contact leaves to those of its blocks' parts when a block of it is cut.
 *
 * A part of a wall carries what it carried before: stresses, law states, an initial stress. So a contact that ends because a block of
 * it was cut leaves its points, and each contact between parts of the two blocks takes its share of them over when it is made,
 * in the same detection. What a part is of, its root, the model tells (tl_heir). */
#include "contact/estate.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/facing.h"
#include "contact/lean.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/presses.h"
#include "narrow/flush.h"

#include <float.h>
#include <stdlib.h>

/* Tolerance: normals of a part's face and of the whole's are off each other by rounding. */
#define SAME_FACE 1e-9

bool tl_estates_reserve(tl_detect *d, size_t estates, size_t points)
{
    return tl_fit(&d->estates, &d->estate_capacity, d->estate_count + estates,
                  sizeof *d->estates) &&
           tl_fit(&d->left_points, &d->left_capacity, d->left_count + points,
                  sizeof *d->left_points);
}

static bool is_field(const tl_detect *d, uint32_t c)
{
    return tl_facet_is_field(&d->contacts.facet[c]);
}

uint32_t tl_estate_size(const tl_detect *d, uint32_t c)
{
    uint32_t count = d->contacts.point_count[c];
    return is_field(d, c) && count ? 1 : count;
}

/* The springs of a field contact, and how far an initial stress has moved its face, as a patch has that. */
static void keep_field(tl_model *m, uint32_t c, tl_estate *estate, tl_old_point *point)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    const tl_press_row *row = tl_press_row_of(m, c);
    size_t torsion = tl_point_row(&d->contacts, c, TL_FIELD_TORSION);
    estate->torsion = row->press.radius * tl_v3_dot(point->normal, tl_columns_get(p->f_s, torsion));
    estate->energy = row->spare[0] + row->spare[1];
    for (size_t k = 0; k < TL_FIELD_POINTS; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        double area = p->area[i];
        estate->energy += area > 0 ? tl_v3_norm2(tl_columns_get(p->f_s, i)) / area : 0;
    }
    point->n0 = 0;
    point->reference = -row->shift;
}

/* Takes what slip has opened out of the references of a patch's points, and notes their closures. */
static void keep_closures(tl_model *m, uint32_t c, const tl_testator *a, const tl_testator *b,
                          tl_estate *estate)
{
    tl_old_point *points = &m->detect->left_points[estate->first];
    double offset = m->detect->contacts.facet[c].offset, opening[TL_LANES];
    for (size_t first = 0; first < estate->count; first += TL_LANES) {
        tl_contact_point_openings(m, c, first, opening);
        for (size_t l = 0; l < TL_LANES && first + l < estate->count; l++) {
            tl_old_point *p = &points[first + l];
            double overlap = offset - tl_v3_dot(estate->face[0], tl_v3_sub(p->arm, a->place)) -
                             tl_v3_dot(estate->face[1], tl_v3_sub(p->arm, b->place));
            p->closure = overlap - p->reference;
            p->reference -= opening[l];
        }
    }
}

/* The faces of a patch, or those of a field contact that are moved out, where they lie, and how far they are moved. */
static void keep_faces(tl_model *m, uint32_t c, const tl_testator *a, const tl_testator *b,
                       tl_estate *estate)
{
    const tl_facet *facet = &m->detect->contacts.facet[c];
    tl_vec3 na = facet->na, nb = facet->nb, first = m->detect->left_points[estate->first].arm;
    double offset = facet->offset;
    if (estate->field) {
        const tl_press_row *row = tl_press_row_of(m, c);
        na = row->shifted_at[0].normal;
        nb = row->shifted_at[1].normal;
        offset = row->shifted_at[0].offset + row->shifted_at[1].offset;
        estate->shift = row->shift;
    } else {
        estate->shift = tl_contact_mean_lift(m, c);
    }
    estate->face[0] = tl_m3_mul(a->r, na);
    estate->face[1] = tl_m3_mul(b->r, nb);
    estate->overlap = offset - tl_v3_dot(estate->face[0], tl_v3_sub(first, a->place)) -
                      tl_v3_dot(estate->face[1], tl_v3_sub(first, b->place));
}

void tl_estate_leave(tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    tl_press_row *row = tl_press_row_of(m, c);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++)
        tl_columns_put(d->points.f_s, tl_point_row(&d->contacts, c, k), tl_v3(0, 0, 0));
    if (row)
        row->spare[0] = row->spare[1] = 0;
    d->contacts.released[c] = 0;
}

void tl_estate_keep(tl_model *m, uint32_t c, const tl_testator *a, const tl_testator *b)
{
    tl_detect *d = m->detect;
    const tl_facet *facet = &d->contacts.facet[c];
    tl_estate *estate = &d->estates[d->estate_count++];
    *estate = (tl_estate){.a = a->id,
                          .b = b->id,
                          .law = d->contacts.law[c],
                          .count = tl_estate_size(d, c),
                          .first = d->left_count,
                          .field = is_field(d, c),
                          .holds_over_gap = d->contacts.holds_over_gap[c],
                          .pressed = !tl_v3_is_zero(d->contacts.force[c]),
                          .reframed = a->reframed};
    tl_facing_place to = {*a->r, {0, 0, 0}};
    if (!estate->field)
        to = tl_facing_ride(a->r, b->r, tl_v3_sub(b->place, a->place), &facet->laid.turn,
                            facet->laid.shift, facet->ride);
    for (size_t k = 0; k < estate->count; k++) {
        tl_vec3 p = tl_columns_get(d->points.p, tl_point_row(&d->contacts, c, k));
        tl_vec3 place = tl_v3_add(tl_v3_add(a->place, to.at), tl_m3_mul(&to.to, p));
        d->left_points[d->left_count++] = tl_point_as_old(&d->points, &d->contacts, c, k, place);
    }
    if (estate->field)
        keep_field(m, c, estate, &d->left_points[estate->first]);
    keep_faces(m, c, a, b, estate);
    if (!estate->field)
        keep_closures(m, c, a, b, estate);
}

static int compare(const void *x, const void *y)
{
    const tl_estate *p = x, *q = y;
    return tl_pair_order(p->a, p->b, q->a, q->b);
}

void tl_estates_sort(tl_detect *d)
{
    if (d->estate_count > 1)
        qsort(d->estates, d->estate_count, sizeof *d->estates, compare);
}

tl_estate *tl_estate_left(const tl_detect *d, tl_id a, tl_id b)
{
    tl_estate wanted = {.a = a, .b = b};
    return bsearch(&wanted, d->estates, d->estate_count, sizeof wanted, compare);
}

/* ---------------------------------------------------------------- taken over ------------- */

static tl_id root_of(const tl_model *m, uint32_t row)
{
    const tl_heir *heir = tl_heir_of(m, m->blocks.id[row]);
    return heir ? heir->root : m->blocks.id[row];
}

const tl_estate *tl_estate_of(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_detect *d = m->detect;
    if (d->estate_count == 0)
        return NULL;
    tl_id a = root_of(m, block_a), b = root_of(m, block_b);
    return tl_estate_left(d, a < b ? a : b, a < b ? b : a);
}

bool tl_estate_holds(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_estate *estate = tl_estate_of(m, block_a, block_b);
    return estate && estate->holds_over_gap && !estate->field;
}

double tl_estate_tilt(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_estate *estate = tl_estate_of(m, block_a, block_b);
    if (!estate || !estate->pressed || estate->field)
        return 0;
    uint32_t face_a, face_b;
    bool corners = tl_estate_faces(m, block_a, block_b, &face_a, &face_b) &&
                   tl_pair_at_corners(m, block_a, face_a, block_b, face_b);
    return tl_flush_limits_of(corners).field_tilt;
}

/* The face of a block with an outward normal; TL_NO_ROW: it has none. A convex block has one at the most. */
static uint32_t face_of(const tl_model *m, uint32_t block, tl_vec3 normal)
{
    const tl_poly *shape = m->blocks.shape[block];
    tl_vec3 n = tl_m3_tmul(&m->bodies.pose[m->blocks.body[block]].r, normal);
    for (uint32_t f = 0; f < shape->face_count; f++)
        if (tl_v3_norm2(tl_v3_sub(shape->plane[f].normal, n)) < SAME_FACE * SAME_FACE)
            return f;
    return TL_NO_ROW;
}

/* How far a face of a block lies beyond a place, along its normal. */
static double beyond(const tl_model *m, uint32_t block, uint32_t face, tl_vec3 place)
{
    const tl_plane *plane = &m->blocks.shape[block]->plane[face];
    uint32_t body = m->blocks.body[block];
    tl_vec3 arm = tl_v3_sub(place, tl_body_place(&m->bodies, body));
    return plane->offset - tl_v3_dot(plane->normal, tl_m3_tmul(&m->bodies.pose[body].r, arm));
}

/* Whether two faces that are parallel to those of an estate are parts of them. A face that a cut has made inside the whole lies behind
 * the whole's face, so it overlaps the other block's by less. */
static bool lie_in(const tl_model *m, const tl_estate *estate, uint32_t block_a, uint32_t face_a,
                   uint32_t block_b, uint32_t face_b)
{
    tl_vec3 first = m->detect->left_points[estate->first].arm;
    double overlap = beyond(m, block_a, face_a, first) + beyond(m, block_b, face_b, first);
    double size = fmin(m->blocks.size[block_a], m->blocks.size[block_b]);
    return fabs(overlap - estate->overlap) < TL_STILL * size;
}

bool tl_estate_faces(const tl_model *m, uint32_t block_a, uint32_t block_b, uint32_t *face_a,
                     uint32_t *face_b)
{
    const tl_estate *estate = tl_estate_of(m, block_a, block_b);
    if (!estate)
        return false;
    bool other_way = root_of(m, block_a) != estate->a;
    *face_a = face_of(m, block_a, estate->face[other_way]);
    *face_b = face_of(m, block_b, estate->face[!other_way]);
    return *face_a != TL_NO_ROW && *face_b != TL_NO_ROW &&
           lie_in(m, estate, block_a, *face_a, block_b, *face_b);
}

double tl_estate_shift(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces)
{
    const tl_estate *estate = tl_estate_of(m, block_a, block_b);
    uint32_t face_a, face_b;
    *faces = (tl_face_pair){0, 0};
    if (!estate || estate->shift == 0 || !tl_estate_faces(m, block_a, block_b, &face_a, &face_b))
        return 0;
    *faces = (tl_face_pair){(uint16_t)face_a, (uint16_t)face_b};
    return estate->shift;
}

const tl_estate *tl_estate_on(const tl_model *m, uint32_t block_a, uint32_t block_b,
                              const tl_facet *facet)
{
    const tl_estate *estate = tl_estate_of(m, block_a, block_b);
    uint32_t face_a, face_b;
    if (!estate || estate->field)
        return estate;
    bool same = tl_estate_faces(m, block_a, block_b, &face_a, &face_b) && face_a == facet->ia &&
                face_b == facet->ib;
    return same ? estate : NULL;
}

/* The same as the other block sees it. */
static void turn_round(const tl_kind *kind, tl_old_point *point)
{
    point->normal = tl_v3_neg(point->normal);
    point->shear = tl_v3_neg(point->shear);
    uint32_t column = 0;
    for (uint32_t k = 0; kind && k < kind->state_count; k++) {
        bool vector = tl_kind_state(kind, k)->kind == TL_STATE_TANGENT;
        for (uint32_t w = 0; w < (vector ? 3 : 1) && column < TL_STATE_COLUMNS; w++, column++)
            if (vector)
                point->state[column] = -point->state[column];
    }
}

static const tl_kind *kind_of(const tl_model *m, uint32_t law)
{
    return law == TL_NO_ROW ? NULL : m->joint_laws[law].kind;
}

bool tl_estate_is_of_law(const tl_model *m, const tl_estate *estate, uint32_t c)
{
    return kind_of(m, estate->law) == kind_of(m, m->detect->contacts.law[c]);
}

bool tl_estate_same_way(const tl_model *m, const tl_estate *estate, uint32_t c)
{
    return root_of(m, m->detect->contacts.a[c]) == estate->a;
}

double tl_estate_kept(const tl_model *m, const tl_estate *estate, uint32_t c)
{
    const tl_detect *d = m->detect;
    bool field = is_field(d, c);
    uint32_t column = tl_estate_is_of_law(m, estate, c) && estate->law != TL_NO_ROW
                          ? m->joint_laws[estate->law].energy
                          : TL_NO_ROW;
    double sum = 0, whole = 0, area = 0;
    if (column >= d->points.state_columns)
        return 0;
    for (size_t k = 0; k < estate->count; k++) {
        const tl_old_point *p = &d->left_points[estate->first + k];
        sum += p->state[column];
        whole += p->area;
    }
    for (size_t k = 0; k < (field ? 1 : d->contacts.point_count[c]); k++)
        area += d->points.area[tl_point_row(&d->contacts, c, k)];
    return whole > 0 ? sum * fmin(1, area / whole) : 0;
}

tl_old_point tl_estate_point(const tl_model *m, const tl_estate *estate, uint32_t c, size_t k)
{
    const tl_detect *d = m->detect;
    const tl_facet *facet = &d->contacts.facet[c];
    uint32_t a = d->contacts.a[c];
    tl_face_pair moved;
    tl_old_point out = d->left_points[estate->first + k];
    if (estate->field && out.reference != 0 &&
        (tl_estate_shift(m, a, d->contacts.b[c], &moved) == 0 || moved.a != facet->ia ||
         moved.b != facet->ib))
        out.reference = 0;
    out.arm = tl_v3_sub(out.arm, tl_body_place(&m->bodies, m->blocks.body[a]));
    if (root_of(m, a) != estate->a)
        turn_round(kind_of(m, estate->law), &out);
    return out;
}

/* ---------------------------------------------------------------- all parts -------------- */

static void add_shear(tl_heritage *sum, double area, tl_vec3 force)
{
    sum->area += area;
    sum->force = tl_v3_add(sum->force, force);
    sum->energy += area > 0 ? tl_v3_norm2(force) / area : 0;
}

static tl_heritage left_by(const tl_detect *d, const tl_estate *estate)
{
    tl_heritage sum = {.area = 0};
    for (size_t k = 0; k < estate->count; k++) {
        const tl_old_point *p = &d->left_points[estate->first + k];
        add_shear(&sum, p->area, tl_v3_scale(p->area, p->shear));
    }
    return sum;
}

static double area_left(const tl_detect *d, const tl_estate *estate)
{
    double area = 0;
    for (size_t k = 0; k < estate->count; k++)
        area += d->left_points[estate->first + k].area;
    return area;
}

/* Area of the whole's contact that a contact of parts has taken over from. */
static double area_taken(const tl_detect *d, const tl_estate *estate, uint32_t c)
{
    double area = 0;
    for (size_t k = 0; k < (is_field(d, c) ? 1 : d->contacts.point_count[c]); k++)
        area += d->points.area[tl_point_row(&d->contacts, c, k)];
    return fmin(area, area_left(d, estate));
}

static void scale_forces(tl_detect *d, uint32_t c, double by)
{
    tl_points_table *p = &d->points;
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        p->f_n[i] *= by;
        if (p->f_n0)
            p->f_n0[i] *= by;
        tl_columns_put(p->f_s, i, tl_v3_scale(by, tl_columns_get(p->f_s, i)));
    }
}

/* Parts that touch on patches where the whole touched on a smaller area have each taken over what was on all of it. They share it. */
static void share_out(tl_model *m)
{
    tl_detect *d = m->detect;
    const tl_contacts *contacts = &d->contacts;
    for (size_t i = 0; i < d->estate_count; i++)
        d->estates[i].taken = (tl_heritage){.area = 0};
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t c = 0; c < contacts->table.rows; c++) {
            const tl_estate *on =
                tl_estate_on(m, contacts->a[c], contacts->b[c], &contacts->facet[c]);
            if (!on || !on->field)
                continue;
            tl_heritage *taken = &d->estates[on - d->estates].taken;
            if (pass == 0)
                taken->area += area_taken(d, on, c);
            else if (taken->area > area_left(d, on))
                scale_forces(d, c, area_left(d, on) / taken->area);
        }
}

tl_estate *tl_estate_taken(const tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    const tl_contacts *contacts = &d->contacts;
    const tl_estate *estate = tl_estate_on(m, contacts->a[c], contacts->b[c], &contacts->facet[c]);
    return estate && !estate->field && !is_field(d, c) ? &d->estates[estate - d->estates] : NULL;
}

/* Adds what the patches of the parts carry. */
static void sum_taken(tl_model *m)
{
    tl_detect *d = m->detect;
    for (size_t i = 0; i < d->estate_count; i++)
        d->estates[i].taken = (tl_heritage){.area = 0};
    for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
        tl_estate *estate = tl_estate_taken(m, c);
        double sign = estate && root_of(m, d->contacts.a[c]) != estate->a ? -1 : 1;
        for (size_t k = 0; estate && k < d->contacts.point_count[c]; k++) {
            size_t i = tl_point_row(&d->contacts, c, k);
            add_shear(&estate->taken, d->points.area[i],
                      tl_v3_scale(sign, tl_columns_get(d->points.f_s, i)));
        }
    }
}

/* Adds a uniform traction to a patch, of which its share, in its plane, makes up for what the parts lack. */
static void add_lacking(tl_model *m, uint32_t c, const tl_estate *estate)
{
    const tl_detect *d = m->detect;
    tl_heritage whole = left_by(d, estate);
    const tl_heritage *taken = &estate->taken;
    double part = whole.area > 0 ? fmin(1, taken->area / whole.area) : 0;
    tl_vec3 lacks = tl_v3_sub(tl_v3_scale(part, whole.force), taken->force), n;
    if (root_of(m, d->contacts.a[c]) != estate->a)
        lacks = tl_v3_neg(lacks);
    n = d->contacts.facet[c].last;
    lacks = tl_v3_madd(lacks, -tl_v3_dot(lacks, n), n);
    for (size_t k = 0; taken->area > 0 && k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        tl_vec3 force = tl_columns_get(d->points.f_s, i);
        tl_columns_put(d->points.f_s, i, tl_v3_madd(force, d->points.area[i] / taken->area, lacks));
    }
}

/* Where the parts' springs have more energy than the whole's had, brings their stresses nearer to the mean: of one force a uniform stress
 * has the least. */
static void limit_energy(tl_model *m, uint32_t c, const tl_estate *estate)
{
    const tl_detect *d = m->detect;
    const tl_heritage whole = left_by(d, estate), *taken = &estate->taken;
    double most = whole.energy * (whole.area > 0 ? fmin(1, taken->area / whole.area) : 0);
    if (!(taken->energy > most))
        return;
    double least = tl_v3_norm2(taken->force) / taken->area;
    double keep = sqrt(fmax(0, most - least) / fmax(taken->energy - least, DBL_MIN));
    bool same_way = root_of(m, d->contacts.a[c]) == estate->a;
    tl_vec3 mean = tl_v3_scale((same_way ? 1 : -1) * (1 - keep) / taken->area, taken->force);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        tl_vec3 force = tl_v3_scale(keep, tl_columns_get(d->points.f_s, i));
        tl_columns_put(d->points.f_s, i, tl_v3_madd(force, d->points.area[i], mean));
    }
}

void tl_estates_sum(tl_model *m)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    for (uint32_t c = 0; m->detect->estate_count > 0 && c < contacts->table.rows; c++) {
        if (!tl_estate_of(m, contacts->a[c], contacts->b[c]))
            continue;
        tl_contact_places(m, c, lanes);
        tl_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
        for (size_t k = 0; k < contacts->point_count[c]; k++) {
            size_t i = tl_point_row(contacts, c, k);
            tl_vec3 f =
                tl_v3_madd(tl_columns_get(p->f_s, i), p->f_n[i], tl_columns_get(lanes->normal, k));
            force = tl_v3_add(force, f);
            moment = tl_v3_add(moment, tl_v3_cross(tl_columns_get(lanes->arm, k), f));
        }
        contacts->force[c] = force;
        contacts->moment[c] = moment;
    }
}

void tl_estates_balance(tl_model *m)
{
    const tl_detect *d = m->detect;
    if (d->estate_count == 0)
        return;
    void (*const correct[])(tl_model *, uint32_t, const tl_estate *) = {add_lacking, limit_energy};
    share_out(m);
    for (int step = 0; step < 2; step++) {
        sum_taken(m);
        for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
            const tl_estate *estate = tl_estate_taken(m, c);
            if (estate)
                correct[step](m, c, estate);
        }
    }
}

void tl_estates_end(tl_detect *d)
{
    free(d->estates);
    free(d->left_points);
    d->estates = NULL;
    d->left_points = NULL;
    d->estate_count = d->estate_capacity = d->left_count = d->left_capacity = 0;
}
