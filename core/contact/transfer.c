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
#include "contact/detection.h"
#include "contact/places.h"
#include "contact/points.h"
#include "contact/shear.h"
#include "narrow/point2.h"
#include "narrow/view.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Fields that are scalars per point: initial normal stress, reference overlap. */
enum { FIELD_N0, FIELD_REFERENCE, FIELD_COUNT };

struct tl_old_point {
    tl_vec3 arm, normal, shear; /* shear stress */
    double area, f_n;           /* f_n: normal stress */
    double field[FIELD_COUNT];
    double state[TL_STATE_COLUMNS];
    uint32_t key, flags;
};

typedef struct tl_old_point old_point;

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
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        double per_area = p->area[i] > 0 ? 1 / p->area[i] : 0;
        old_point *o = &scratch->old[k];
        o->arm = tl_columns_get(lanes->arm, k);
        o->normal = contacts->facet[c].last;
        o->shear = tl_v3_scale(per_area, tl_columns_get(p->f_s, i));
        o->area = p->area[i];
        o->f_n = per_area * p->f_n[i];
        o->field[FIELD_N0] = p->f_n0 ? per_area * p->f_n0[i] : 0;
        o->field[FIELD_REFERENCE] = p->f_n0 ? p->reference[i] : 0;
        for (uint32_t s = 0; s < p->state_columns; s++)
            o->state[s] = p->state[s][i];
        o->key = p->key[i];
        o->flags = p->flags[i];
    }
}

/* The old point of the same key, or the nearest. */
static const old_point *match(const old_point *old, size_t count, uint32_t key, tl_vec3 arm)
{
    const old_point *best = &old[0];
    for (size_t k = 0; k < count; k++) {
        if (old[k].key == key)
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

/* Whether points span a plane, by the second moments of their areas about their centre: det of the moments, or 0 when
 * they lie within about `place` of a line through it, where slopes would be quotients of rounding. */
static double spanned(double i11, double i12, double i22, double area, double place)
{
    double sum = i11 + i22, det = i11 * i22 - i12 * i12;
    return det > area * place * place * sum ? det : 0;
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
    double det = spanned(i11, i12, i22, now->area, place), g1 = 0, g2 = 0;
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
        double v = old[k].area * old[k].field[field];
        out.sum += v;
        out.along1 += v * tl_v3_dot(arm, t1);
        out.along2 += v * tl_v3_dot(arm, t2);
    }
    return out;
}

/* ---------------------------------------------------------------- stress between points -- */

/* What is fitted: shear stress, normal stress, and the scalar fields. */
enum { FIT_SHEAR, FIT_NORMAL = 3, FIT_FIELDS, FIT_COUNT = FIT_FIELDS + FIELD_COUNT };

/* Area-weighted plane through the old points' stresses, and their range, which bounds it. */
typedef struct plane_fit {
    bool made; /* false: the old points lie on a line */
    tl_vec3 centre, t1, t2;
    double mean[FIT_COUNT], along1[FIT_COUNT], along2[FIT_COUNT], low[FIT_COUNT], high[FIT_COUNT];
    double
        spread; /* largest deviation of a shear stress from the mean: bounds of components would hang on the axes */
} plane_fit;

/* How far the shear stress among some values is from the mean. */
static double shear_off(const plane_fit *fit, const double *value)
{
    double x = value[FIT_SHEAR] - fit->mean[FIT_SHEAR];
    double y = value[FIT_SHEAR + 1] - fit->mean[FIT_SHEAR + 1];
    double z = value[FIT_SHEAR + 2] - fit->mean[FIT_SHEAR + 2];
    return sqrt(x * x + y * y + z * z);
}

static void fit_values(const old_point *o, double *value)
{
    value[FIT_SHEAR] = o->shear.x;
    value[FIT_SHEAR + 1] = o->shear.y;
    value[FIT_SHEAR + 2] = o->shear.z;
    value[FIT_NORMAL] = o->f_n;
    for (int k = 0; k < FIELD_COUNT; k++)
        value[FIT_FIELDS + k] = o->field[k];
}

static plane_fit fit_plane(const old_point *old, size_t count, const totals *t, double place)
{
    plane_fit fit = {.centre = t->centre, .t1 = tl_v3_perpendicular(t->normal)};
    fit.t2 = tl_v3_cross(t->normal, fit.t1);
    double i11 = 0, i12 = 0, i22 = 0, value[FIT_COUNT];
    for (int k = 0; k < FIT_COUNT; k++) {
        fit.low[k] = INFINITY;
        fit.high[k] = -INFINITY;
    }
    for (size_t i = 0; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(old[i].arm, t->centre);
        double a = old[i].area / t->area, x = tl_v3_dot(arm, fit.t1), y = tl_v3_dot(arm, fit.t2);
        i11 += a * x * x;
        i12 += a * x * y;
        i22 += a * y * y;
        fit_values(&old[i], value);
        for (int k = 0; k < FIT_COUNT; k++) {
            fit.mean[k] += a * value[k];
            fit.along1[k] += a * value[k] * x;
            fit.along2[k] += a * value[k] * y;
            fit.low[k] = fmin(fit.low[k], value[k]);
            fit.high[k] = fmax(fit.high[k], value[k]);
        }
    }
    for (size_t i = 0; i < count; i++) {
        fit_values(&old[i], value);
        fit.spread = fmax(fit.spread, shear_off(&fit, value));
    }
    double det = spanned(i11, i12, i22, 1, place);
    fit.made = det > 0;
    for (int k = 0; k < FIT_COUNT && fit.made; k++) {
        double m1 = fit.along1[k], m2 = fit.along2[k];
        fit.along1[k] = (m1 * i22 - m2 * i12) / det;
        fit.along2[k] = (m2 * i11 - m1 * i12) / det;
    }
    return fit;
}

/* The old stresses at a place between the old points; those of `o` when there is no fit. */
static void fitted(const plane_fit *fit, tl_vec3 arm, const old_point *o, double *value)
{
    fit_values(o, value);
    if (!fit->made)
        return;
    tl_vec3 d = tl_v3_sub(arm, fit->centre);
    double x = tl_v3_dot(d, fit->t1), y = tl_v3_dot(d, fit->t2);
    for (int k = 0; k < FIT_COUNT; k++) {
        value[k] = fit->mean[k] + x * fit->along1[k] + y * fit->along2[k];
        if (k >= FIT_NORMAL)
            value[k] = fmin(fit->high[k], fmax(fit->low[k], value[k]));
    }
    double off = shear_off(fit, value), part = off > fit->spread ? fit->spread / off : 1;
    for (int k = FIT_SHEAR; k < FIT_NORMAL; k++)
        value[k] = fit->mean[k] + part * (value[k] - fit->mean[k]);
}

/* Writes the points of the manifold, with what they take over from the old ones. */
static void write_points(tl_model *m, uint32_t c, const tl_manifold *g, const old_point *old,
                         size_t old_count, const plane_fit *fit, const tl_point_lanes *lanes)
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
    for (size_t k = 0; k < g->point_count && old_count == 0; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->flags[i] = lanes->closure[k] < -TL_STILL * size ? TL_POINT_APART : 0;
    }
    for (size_t k = 0; k < g->point_count && old_count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 arm = tl_columns_get(lanes->arm, k);
        const old_point *o = match(old, old_count, p->key[i], arm);
        double value[FIT_COUNT];
        if (o->key == p->key[i])
            fit_values(o, value);
        else
            fitted(fit, arm, o, value);
        tl_vec3 n = tl_columns_get(lanes->normal, k);
        tl_vec3 shear = {value[FIT_SHEAR], value[FIT_SHEAR + 1], value[FIT_SHEAR + 2]};
        tl_vec3 f = tl_v3_scale(p->area[i], tl_v3_turn(shear, o->normal, n));
        f = tl_v3_madd(f, -tl_v3_dot(f, n), n);
        p->f_s[0][i] = f.x;
        p->f_s[1][i] = f.y;
        p->f_s[2][i] = f.z;
        p->f_n[i] = value[FIT_NORMAL] * p->area[i];
        if (p->f_n0) {
            p->f_n0[i] = value[FIT_FIELDS + FIELD_N0] * p->area[i];
            p->reference[i] = value[FIT_FIELDS + FIELD_REFERENCE];
        }
        p->flags[i] = o->flags;
        tl_point_take_state(p, i, kind, o->state, o->area);
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
    for (int field = 0; field < FIELD_COUNT && p->f_n0; field++) {
        moments keep = field_moments(scratch->old, old_count, field, before, now->normal);
        double largest = 0;
        for (size_t k = 0; k < old_count && !scratch->reframed; k++)
            largest = fmax(largest, fabs(scratch->old[k].field[field]));
        keep.sum *= follow;
        keep.along1 *= follow;
        keep.along2 *= follow;
        for (size_t k = 0; k < count; k++) {
            size_t i = tl_point_row(contacts, c, k);
            value[k] = field == FIELD_REFERENCE ? p->reference[i] : p->f_n0[i] / p->area[i];
        }
        correct_field(p, lanes, value, begin, count, now, keep, largest, place);
        for (size_t k = 0; k < count; k++) {
            size_t i = tl_point_row(contacts, c, k);
            if (field == FIELD_REFERENCE)
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

bool tl_contact_transfer(tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    const tl_manifold *g = &scratch->manifold;
    size_t begin = contacts->point_start[c], old_count = contacts->point_count[c];
    if (!reserve(scratch, old_count > g->point_count ? old_count : g->point_count))
        return false;
    read_old(m, c, scratch, lanes);
    const old_point *old = scratch->old;
    totals before = old_totals(old, old_count), now = {0};

    contacts->facet[c] = g->facet;
    contacts->point_count[c] = (uint16_t)g->point_count;
    for (size_t k = g->point_count; k < contacts->point_capacity[c]; k++)
        tl_point_clear(p, tl_point_row(contacts, c, k));
    double place = TL_MERGE * fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    plane_fit fit = {.made = false};
    if (before.area > 0 && !scratch->reframed)
        fit = fit_plane(old, old_count, &before, place);
    write_points(m, c, g, old, old_count, &fit, lanes);
    if (old_count == 0 || g->point_count == 0 || !(before.area > 0)) {
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
