/* transfer.c - new contact points in the place of old ones, when the contact polygon has changed.
 *
 * Each new point takes over the stresses of the old point of the same key, or else those of the plane
 * fitted through the old points: the nearest one's would wear a stress that varies over the face down
 * while corners come and go. A law's states are those of the same key or the nearest.
 * Then the fields are corrected. Total initial normal force and both its moments follow the area. What comes into contact
 * brings no shear, and what goes takes its own with it: where the area shrinks total shear force follows it, where it grows
 * the force stays; so does the shear's moment about the normal, with the second moment of the area. Where the area
 * and its centroid stay the same, all are kept exactly, unless that took stresses beyond those there were. Moments are
 * taken about the centroids of the areas, so a uniform stress stays uniform when the area changes. The shear springs
 * never have more energy than before; what they have less is heat. */
#include "contact/transfer.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/detection.h"
#include "contact/estate.h"
#include "contact/places.h"
#include "contact/points.h"
#include "contact/shear.h"
#include "contact/stress_plane.h"
#include "narrow/point2.h"
#include "narrow/view.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

typedef tl_old_point old_point;

/* Makes room for `count` old points and as many values. */
static bool reserve(tl_narrow_scratch *scratch, size_t count)
{
    if (count <= scratch->old_capacity)
        return true;
    old_point *old = realloc(scratch->old, 2 * count * sizeof *old);
    if (old)
        scratch->old = old;
    double *value = realloc(scratch->value, 2 * count * sizeof *value);
    if (value)
        scratch->value = value;
    if (!old || !value)
        return false;
    scratch->old_capacity = 2 * count;
    return true;
}

/* Old points have gone along with A, in whose frame they are. */
static void read_old(const tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                     const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    tl_contact_places(m, c, lanes);
    for (size_t k = 0; k < contacts->point_count[c]; k++)
        scratch->old[k] = tl_point_as_old(p, contacts, c, k, tl_columns_get(lanes->arm, k));
}

/* What new points take over from. */
typedef struct old_source {
    const old_point *points;
    size_t count;
    bool keys;   /* the same features have the same keys */
    bool states; /* are of the contact's law */
} old_source;

/* The old point of the same key, or the nearest. */
static const old_point *match(const old_source *from, uint32_t key, tl_vec3 arm)
{
    const old_point *old = from->points, *best = &old[0];
    for (size_t k = 0; k < from->count; k++) {
        if (from->keys && old[k].key == key)
            return &old[k];
        if (tl_v3_norm2(tl_v3_sub(old[k].arm, arm)) < tl_v3_norm2(tl_v3_sub(best->arm, arm)))
            best = &old[k];
    }
    return best;
}

/* Totals of a set of points: area, its centroid, and of a field and of shear over it. */
typedef struct totals {
    double area;
    tl_vec3 centre, normal;
    tl_vec3 shear;  /* force */
    double torsion; /* moment of the shear about the normal through the centre */
    double polar;   /* second moment of area about it */
    double energy;  /* of the shear springs, times 2 ks */
    tl_vec3 moment; /* of the shear, about A's centroid */
} totals;

static void add_area(totals *t, double area, tl_vec3 arm, tl_vec3 normal)
{
    t->area += area;
    t->centre = tl_v3_madd(t->centre, area, arm);
    t->normal = tl_v3_madd(t->normal, area, normal);
}

static void close_area(totals *t)
{
    if (t->area > 0)
        t->centre = tl_v3_scale(1 / t->area, t->centre);
    t->normal = tl_v3_unit(t->normal);
}

/* Adds what a point of known centre and normal adds besides. */
static void add_shear(totals *t, double area, tl_vec3 arm, tl_vec3 f)
{
    tl_vec3 across = tl_v3_cross(t->normal, tl_v3_sub(arm, t->centre));
    t->shear = tl_v3_add(t->shear, f);
    t->torsion += tl_v3_dot(across, f);
    t->polar += area * tl_v3_norm2(across);
    t->energy += area > 0 ? tl_v3_norm2(f) / area : 0;
    t->moment = tl_v3_add(t->moment, tl_v3_cross(arm, f));
}

/* The same of all points of a contact, anew. */
static void sum_shear(const tl_points_table *p, const tl_point_lanes *lanes, size_t begin,
                      size_t count, totals *t)
{
    t->shear = t->moment = tl_v3(0, 0, 0);
    t->torsion = t->polar = t->energy = 0;
    for (size_t k = 0; k < count; k++) {
        size_t i = begin + k * TL_LANES;
        add_shear(t, p->area[i], tl_columns_get(lanes->arm, k), tl_columns_get(p->f_s, i));
    }
}

/* `value`, but at most so large that times `reach` it makes `largest`. */
static double bounded(double value, double reach, double largest)
{
    return fabs(value) * reach > largest ? copysign(largest / reach, value) : value;
}

/* How far points reach out from their centre. */
static double reach_of(const tl_point_lanes *lanes, size_t count, const totals *now)
{
    double reach = 0;
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), now->centre);
        reach = fmax(reach, tl_v3_norm(tl_v3_cross(now->normal, arm)));
    }
    return reach;
}

/* A point's shear force becomes `keep` times what it is and a uniform traction and a twist: in its own plane, for
 * normals lean by a little. */
static void add_traction(tl_points_table *p, const tl_point_lanes *lanes, size_t begin,
                         size_t count, const totals *now, double keep, tl_vec3 traction,
                         double twist)
{
    for (size_t k = 0; k < count; k++) {
        size_t i = begin + k * TL_LANES;
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), now->centre);
        tl_vec3 stress = tl_v3_madd(traction, twist, tl_v3_cross(now->normal, arm));
        tl_vec3 f = tl_v3_scale(keep, tl_columns_get(p->f_s, i));
        tl_vec3 own = tl_columns_get(lanes->normal, k);
        f = tl_v3_madd(f, p->area[i], stress);
        tl_columns_put(p->f_s, i, tl_v3_madd(f, -tl_v3_dot(f, own), own));
    }
}

/* Brings the energy of the shear springs down to `most`. Of all stresses of the same force and torsion a uniform traction
 * with a twist has the least energy, and what else there is has an energy of its own: that is made less. */
static void limit_energy(tl_points_table *p, const tl_point_lanes *lanes, size_t begin,
                         size_t count, totals *now, double most, double reach, double place)
{
    sum_shear(p, lanes, begin, count, now);
    if (!(now->energy > most))
        return;
    double twist = reach > place ? now->torsion / now->polar : 0;
    double least = tl_v3_norm2(now->shear) / now->area + twist * twist * now->polar;
    double rest = now->energy - least, keep = sqrt(fmax(0, most - least) / fmax(rest, DBL_MIN));
    keep = fmin(keep, 1);
    add_traction(p, lanes, begin, count, now, keep, tl_v3_scale((1 - keep) / now->area, now->shear),
                 (1 - keep) * twist);
    sum_shear(p, lanes, begin, count, now);
    if (now->energy > most) { /* a torsion too large for it, which a bounded twist has left */
        add_traction(p, lanes, begin, count, now, sqrt(most / now->energy), tl_v3(0, 0, 0), 0);
        sum_shear(p, lanes, begin, count, now);
    }
}

/* Adds a uniform traction and a twist so that shear force and torsion become `want`'s, and sees that there is no more
 * energy than there was. The twist adds no more than `largest`, a stress: points with hardly an area would need any
 * stress to make up for the torsion, and keep it when their areas grow. Points within `place` of their centre are in one
 * place, which no twist can turn: their arms are rounding. */
static void correct_shear(tl_points_table *p, const tl_point_lanes *lanes, size_t begin,
                          size_t count, totals *now, const totals *want, double largest,
                          double place)
{
    sum_shear(p, lanes, begin, count, now);
    tl_vec3 n = now->normal, force = tl_v3_sub(want->shear, now->shear);
    double reach = reach_of(lanes, count, now);
    force = tl_v3_madd(force, -tl_v3_dot(force, n), n);
    double twist =
        reach > place ? bounded((want->torsion - now->torsion) / now->polar, reach, largest) : 0;
    add_traction(p, lanes, begin, count, now, 1, tl_v3_scale(1 / now->area, force), twist);
    limit_energy(p, lanes, begin, count, now, want->energy, reach, place);
}

/* Integral of a field over the points' areas, and its moments along two directions. */
typedef struct moments {
    double sum, along1, along2;
} moments;

/* Adds a linear correction to a field (one value a point) so that its sum and moments become
 * `want`; its slopes add no more than `largest`, for the reason given at correct_shear. */
static void correct_field(const tl_points_table *p, const tl_point_lanes *lanes, double *value,
                          size_t begin, size_t count, const totals *now, moments want,
                          double largest, double place)
{
    tl_vec3 t1 = tl_v3_perpendicular(now->normal), t2 = tl_v3_cross(now->normal, t1);
    double i11 = 0, i12 = 0, i22 = 0, reach = 0;
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), now->centre);
        reach = fmax(reach, tl_v3_norm(arm));
        double a = p->area[begin + k * TL_LANES], x = tl_v3_dot(arm, t1), y = tl_v3_dot(arm, t2);
        want.sum -= a * value[k];
        want.along1 -= a * value[k] * x;
        want.along2 -= a * value[k] * y;
        i11 += a * x * x;
        i12 += a * x * y;
        i22 += a * y * y;
    }
    double det = tl_points_span(i11, i12, i22, now->area, place), g1 = 0, g2 = 0;
    if (det > 0) {
        g1 = bounded((want.along1 * i22 - want.along2 * i12) / det, reach, largest);
        g2 = bounded((want.along2 * i11 - want.along1 * i12) / det, reach, largest);
    }
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), now->centre);
        value[k] += want.sum / now->area + g1 * tl_v3_dot(arm, t1) + g2 * tl_v3_dot(arm, t2);
    }
}

static moments field_moments(const old_point *old, size_t count, int field, const totals *t,
                             tl_vec3 normal)
{
    tl_vec3 t1 = tl_v3_perpendicular(normal), t2 = tl_v3_cross(normal, t1);
    moments out = {0, 0, 0};
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(old[k].arm, t->centre);
        double v = old[k].area * tl_old_scalar(&old[k], field);
        out.sum += v;
        out.along1 += v * tl_v3_dot(arm, t1);
        out.along2 += v * tl_v3_dot(arm, t2);
    }
    return out;
}

/* Writes the points of the manifold, with what they take over from the old ones. */
static void write_points(tl_model *m, uint32_t c, const tl_manifold *g, const old_source *from,
                         const tl_stress_plane *fit, const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    uint32_t law = contacts->law[c];
    const tl_kind *kind = law == TL_NO_ROW ? NULL : m->joint_laws[law].kind;
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        const tl_contact_point *point = &g->points[k];
        tl_columns_put(p->p, i, point->p);
        p->area[i] = point->area;
        p->key[i] = point->key;
        p->f_n[i] = 0;
        if (p->f_n0)
            p->f_n0[i] = p->reference[i] = 0;
        for (int s = 0; s < 3; s++)
            p->f_s[s][i] = 0;
        p->flags[i] = 0;
        tl_point_initial_state(p, i, kind);
    }
    /* positions and normals in the present place */
    tl_contact_begin(m, c, lanes);
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    for (size_t k = 0; k < g->point_count && from->count == 0; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->flags[i] = lanes->closure[k] < -TL_STILL * size ? TL_POINT_APART : 0;
    }
    for (size_t k = 0; k < g->point_count && from->count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 arm = tl_columns_get(lanes->arm, k);
        const old_point *o = match(from, p->key[i], arm);
        double value[TL_STRESS_COUNT];
        if (from->keys && o->key == p->key[i])
            tl_stress_values(o, value);
        else
            tl_stress_at(fit, arm, o, !from->keys, value);
        tl_vec3 n = tl_columns_get(lanes->normal, k);
        tl_vec3 shear = {value[TL_STRESS_SHEAR], value[TL_STRESS_SHEAR + 1],
                         value[TL_STRESS_SHEAR + 2]};
        tl_vec3 f = tl_v3_scale(p->area[i], tl_v3_turn(shear, o->normal, n));
        f = tl_v3_madd(f, -tl_v3_dot(f, n), n);
        p->f_s[0][i] = f.x;
        p->f_s[1][i] = f.y;
        p->f_s[2][i] = f.z;
        p->f_n[i] = value[TL_STRESS_NORMAL] * p->area[i];
        if (p->f_n0) {
            p->f_n0[i] = value[TL_STRESS_SCALARS + TL_SCALAR_N0] * p->area[i];
            p->reference[i] = value[TL_STRESS_SCALARS + TL_SCALAR_REFERENCE];
        }
        p->flags[i] = from->states ? o->flags : 0;
        if (from->states)
            tl_point_take_state(p, i, kind, o->state, o->area);
        if (from->states)
            tl_point_turn_states(p, i, kind, o->normal, n);
    }
}

/* Totals of the old points. */
static totals old_totals(const old_point *old, size_t count)
{
    totals t = {0};
    for (size_t k = 0; k < count; k++)
        add_area(&t, old[k].area, old[k].arm, old[k].normal);
    close_area(&t);
    for (size_t k = 0; k < count; k++)
        add_shear(&t, old[k].area, old[k].arm, tl_v3_scale(old[k].area, old[k].shear));
    return t;
}

/* Distance within which points are one. */
static double place_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return TL_MERGE * fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
}

static tl_stress_plane plane_of(const old_point *old, size_t count, const totals *t, double place)
{
    return tl_stress_plane_of(old, count, t->area, t->centre, t->normal, place);
}

/* Where the area has become more than that of an estate, of which nothing is known, it carries no more than there was. */
static void limit_to_estate(tl_model *m, uint32_t c, const totals *before)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    double area = 0;
    for (size_t k = 0; k < contacts->point_count[c]; k++)
        area += p->area[tl_point_row(contacts, c, k)];
    double keep = before->area < area ? before->area / area : 1;
    for (size_t k = 0; keep < 1 && k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->f_n[i] *= keep;
        if (p->f_n0)
            p->f_n0[i] *= keep;
        for (int s = 0; s < 3; s++)
            p->f_s[s][i] *= keep;
    }
}

/* What slip has opened at points of other places than the law's states are of is not what it has opened there: the references make up
 * for it, so that what was between the points of the whole is between the walls. */
static void refer_to_openings(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    double opening[TL_LANES];
    if (!p->reference || !tl_contact_opens(m, c))
        return;
    for (size_t first = 0; first < contacts->point_count[c]; first += TL_LANES) {
        tl_contact_point_openings(m, c, first, opening);
        for (size_t l = 0; l < TL_LANES && first + l < contacts->point_count[c]; l++)
            p->reference[tl_point_row(contacts, c, first + l)] += opening[l];
    }
}

/* A contact that was made for parts of a block takes its share over of what that of the whole carried: the stresses at its own
 * points. */
static void take_share(tl_model *m, uint32_t c, const tl_estate *estate, const tl_narrow_scratch *s,
                       const tl_point_lanes *lanes)
{
    const old_source from = {
        .points = s->old, .count = estate->count, .states = tl_estate_is_of_law(m, estate, c)};
    totals before = old_totals(s->old, estate->count);
    tl_stress_plane fit = {.made = false};
    if (before.area > 0 && !estate->reframed)
        fit = plane_of(s->old, estate->count, &before, place_of(m, c));
    write_points(m, c, &s->manifold, &from, &fit, lanes);
    refer_to_openings(m, c);
    tl_shear_keep(m, c, tl_estate_kept(m, estate, c));
    limit_to_estate(m, c, &before);
}

/* What the shear of new points is to be: what comes into contact brings none, what goes takes its own with it; a
 * twist goes with the second moment of area as traction does with the area. */
static totals shear_wanted(const totals *before, const totals *now)
{
    double area = fmin(1, now->area / before->area);
    double polar = before->polar > 0 ? fmin(1, now->polar / before->polar) : 1;
    return (totals){.shear =
                        tl_v3_scale(area, tl_v3_turn(before->shear, before->normal, now->normal)),
                    .torsion = polar * before->torsion,
                    .energy = before->energy};
}

/* Corrects the scalar fields so that their integrals and moments follow the area. */
static void correct_fields(tl_model *m, uint32_t c, size_t old_count, tl_narrow_scratch *scratch,
                           const tl_point_lanes *lanes, const totals *before, const totals *now,
                           double place)
{
    tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    size_t begin = contacts->point_start[c], count = contacts->point_count[c];
    double *value = scratch->value, follow = now->area / before->area;
    for (int field = 0; field < TL_SCALAR_COUNT && p->f_n0; field++) {
        moments keep = field_moments(scratch->old, old_count, field, before, now->normal);
        double largest = 0;
        for (size_t k = 0; k < old_count && !scratch->reframed; k++)
            largest = fmax(largest, fabs(tl_old_scalar(&scratch->old[k], field)));
        keep.sum *= follow;
        keep.along1 *= follow;
        keep.along2 *= follow;
        for (size_t k = 0; k < count; k++) {
            size_t i = tl_point_row(contacts, c, k);
            value[k] = field == TL_SCALAR_REFERENCE ? p->reference[i] : p->f_n0[i] / p->area[i];
        }
        correct_field(p, lanes, value, begin, count, now, keep, largest, place);
        for (size_t k = 0; k < count; k++) {
            size_t i = tl_point_row(contacts, c, k);
            if (field == TL_SCALAR_REFERENCE)
                p->reference[i] = value[k];
            else
                p->f_n0[i] = value[k] * p->area[i];
        }
    }
}

/* Notes what has become of the shear. */
static void release(tl_model *m, uint32_t c, const totals *before, const totals *now, bool reframed)
{
    tl_shear old = {.energy = before->energy, .force = before->shear, .moment = before->moment};
    tl_shear fresh = {.energy = now->energy, .force = now->shear, .moment = now->moment};
    if (reframed) /* the last step's motion was that of other bodies */
        fresh.force = old.force, fresh.moment = old.moment;
    tl_shear_release(m, c, &old, &fresh);
}

/* The points of a new contact. */
static bool begin_points(tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_estate *estate =
        tl_estate_on(m, contacts->a[c], contacts->b[c], &scratch->manifold.facet);
    if (estate && !reserve(scratch, estate->count))
        return false;
    contacts->facet[c] = scratch->manifold.facet;
    contacts->point_count[c] = (uint16_t)scratch->manifold.point_count;
    for (size_t k = contacts->point_count[c]; k < contacts->point_capacity[c]; k++)
        tl_point_clear(&m->detect->points, tl_point_row(contacts, c, k));
    if (estate) {
        for (size_t k = 0; k < estate->count; k++)
            scratch->old[k] = tl_estate_point(m, estate, c, k);
        take_share(m, c, estate, scratch, lanes);
        return true;
    }
    const old_source from = {.count = 0};
    write_points(m, c, &scratch->manifold, &from, NULL, lanes);
    return true;
}

bool tl_contact_transfer(tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    const tl_manifold *g = &scratch->manifold;
    size_t begin = contacts->point_start[c], old_count = contacts->point_count[c];
    if (old_count == 0)
        return begin_points(m, c, scratch, lanes);
    if (!reserve(scratch, old_count > g->point_count ? old_count : g->point_count))
        return false;
    read_old(m, c, scratch, lanes);
    const old_point *old = scratch->old;
    totals before = old_totals(old, old_count), now = {0};
    double kept = tl_shear_kept(m, c);

    contacts->facet[c] = g->facet;
    contacts->point_count[c] = (uint16_t)g->point_count;
    for (size_t k = g->point_count; k < contacts->point_capacity[c]; k++)
        tl_point_clear(p, tl_point_row(contacts, c, k));
    double place = place_of(m, c);
    tl_stress_plane fit = {.made = false};
    if (before.area > 0 && !scratch->reframed)
        fit = plane_of(old, old_count, &before, place);
    const old_source from = {.points = old, .count = old_count, .keys = true, .states = true};
    write_points(m, c, g, &from, &fit, lanes);
    tl_shear_keep(m, c, kept);
    if (g->point_count == 0 || !(before.area > 0)) {
        release(m, c, &before, &now, scratch->reframed);
        return true;
    }

    for (size_t k = 0; k < g->point_count; k++)
        add_area(&now, p->area[tl_point_row(contacts, c, k)], tl_columns_get(lanes->arm, k),
                 tl_columns_get(lanes->normal, k));
    close_area(&now);
    sum_shear(p, lanes, begin, g->point_count, &now); /* for its second moment */
    totals want = shear_wanted(&before, &now);
    double largest = 0;
    for (size_t k = 0; k < old_count && !scratch->reframed; k++)
        largest = fmax(largest, tl_v3_norm(old[k].shear));
    correct_shear(p, lanes, begin, g->point_count, &now, &want, largest, place);
    release(m, c, &before, &now, scratch->reframed);
    correct_fields(m, c, old_count, scratch, lanes, &before, &now, place);
    return true;
}
