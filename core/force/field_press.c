/* field_press.c - normal force, moment and energy of a field contact.
 *
 * A law that is linear has the energy 2 kn G; another one tells its energy per area, or only its force. What slip opens
 * in a step moves the faces in the next one; until then it presses on beside the field.
 *
 * Between flush faces that overlap by u the integral of d^n over K is that of (u / 2)^(n + 1) 2 / (n + 1) over their
 * area. So the integrals of d^0 .. d^3 are moments of an overlap,
 *
 *     I_1 = V,  I_2 = 4 G,  I_3 = 12 int d^2 dV,  I_4 = 32 int d^3 dV,    I_n = int u^n dA
 *
 * of any field. At the two closures of these (closures.c) the law tells the energy per area Phi and the stress Phi'.
 * The cubic p_0 + p_1 u + p_2 u^2 + p_3 u^3 of Phi / u meets both. The energy is
 *
 *     U = sum p_k I_(k+1)
 *
 * which is exact for stresses up to u^3, as in the cells of a patch, and 2 kn G for a linear one. What the moments
 * change of the closures changes nothing of U: that is what makes them those of Gauss. So U has the slopes p_k by
 * I_(k+1). A minimum area A_m makes it larger by (1 + (A_m / A_e)^2)^(1/2), A_e = V^2 / (4 G). */
#include "force/field_press.h"

#include "base/columns.h"
#include "base/inside.h"
#include "contact/across_gap.h"
#include "contact/detection.h"
#include "contact/sides.h"
#include "force/closures.h"
#include "force/follow.h"

#include <math.h>
#include <string.h>

/* What the normal springs of a field contact make: force on B and moment about A's centroid, in A's frame, the energy,
 * and that of the law's springs, which counts for nothing. */
typedef struct field_press {
    tl_vec3 force, moment;
    double energy, springs;
    double whole;                                 /* the force of which these are slopes */
    double by_energy, by_powers[TL_PRESS_POWERS]; /* change of the energy with those of the press */
} field_press;

/* What a law tells that is not linear. Stress and energy are per area, at the two closures `at` of the press. Of both
 * points: what presses them, J, what slip has opened of it in this step, and the closure of their walls. */
typedef struct told_press {
    double at[2], stress[2], energy[2];
    double springs[TL_FIELD_POINTS], rise[TL_FIELD_POINTS], closure[TL_FIELD_POINTS];
} told_press;

/* ---------------------------------------------------------------- energies that laws tell ---
 *
 * The energy of what presses, as a law tells it. */

/* Tolerance: share of a closure: how far from it energies are taken for a force that is not told. */
#define NEAR (1.0 / 1024)

/* Asks for energies; the law may tell forces, too. Without that the first stays what it was. */
static void ask(const tl_law *law, const tl_law_batch *batch, double *energy)
{
    tl_enter(law->kind, "pressed");
    ((const tl_law_ops *)law->kind->ops)->pressed(law->self, batch, energy);
    tl_leave();
}

/* Points from a row on, with rows of `state` and forces to be filled. */
static tl_law_batch batch_of(const tl_model *m, size_t first, size_t count, const tl_point_lanes *lanes,
                             double *state[TL_STATE_COLUMNS], double *force)
{
    const tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : lanes->zero;
    return (tl_law_batch){.size = sizeof(tl_law_batch),
                          .count = (uint32_t)count,
                          .area = p->area + first,
                          .f_n0 = p->f_n0 ? p->f_n0 + first : lanes->zero,
                          .f_n = force,
                          .state = state,
                          .flags = p->flags + first};
}

/* Energies, J, of `count` points from row `first` at the closures given, by a law that tells them: tl_law_presses. */
static void law_energies(const tl_model *m, const tl_law *law, size_t first, size_t count, const tl_point_lanes *lanes,
                         const double *closure, double *energy)
{
    double *state[TL_STATE_COLUMNS], force[TL_PRESSED_ROWS];
    tl_law_batch batch = batch_of(m, first, count, lanes, state, force);
    batch.closure = closure;
    ask(law, &batch, energy);
}

/* Asks at the closures u - lift, and for forces that the law does not give at those of a little less and more. */
static void press(const tl_law *law, tl_law_batch *batch, const double *u, const double *lift, double *energy,
                  double *force)
{
    double closure[TL_PRESSED_ROWS], other[2][TL_PRESSED_ROWS];
    const size_t count = batch->count;
    batch->closure = closure;
    batch->f_n = force;
    for (size_t i = 0; i < count; i++)
        closure[i] = u[i] - lift[i];
    force[0] = NAN;
    ask(law, batch, energy);
    if (!isnan(force[0]))
        return;
    for (int side = 0; side < 2; side++) {
        for (size_t i = 0; i < count; i++)
            closure[i] = (side ? 1 + NEAR : 1 - NEAR) * u[i] - lift[i];
        ask(law, batch, other[side]);
    }
    for (size_t i = 0; i < count; i++)
        force[i] = u[i] > 0 ? (other[1][i] - other[0][i]) / (2 * NEAR * u[i]) : 0;
}

void tl_law_press(const tl_model *m, const tl_law *law, size_t first, size_t count, const tl_point_lanes *lanes,
                  const double *u, const double *lift, double *energy, double *force)
{
    double *state[TL_STATE_COLUMNS];
    tl_law_batch batch = batch_of(m, first, count, lanes, state, force);
    press(law, &batch, u, lift, energy, force);
}

void tl_law_press_alone(const tl_law *law, double area, const double state[TL_STATE_COLUMNS], const double u[],
                        size_t count, double energy[], double stress[])
{
    const tl_law_ops *ops = law->kind->ops;
    _Alignas(TL_ALIGN) double areas[TL_LANES], zero[TL_LANES] = {0}, at[TL_LANES] = {0};
    _Alignas(TL_ALIGN) double states[TL_STATE_COLUMNS][TL_LANES], hold[TL_LANES];
    _Alignas(TL_ALIGN) double lift[TL_LANES] = {0}, told[TL_LANES], force[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
    double *state_at[TL_STATE_COLUMNS];
    for (uint32_t l = 0; l < TL_LANES; l++) {
        areas[l] = area;
        flags[l] = TL_POINT_APART;
        at[l] = l < count ? u[l] : 0;
    }
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++) {
        state_at[k] = states[k];
        for (uint32_t l = 0; l < TL_LANES; l++)
            states[k][l] = state[k];
    }
    tl_law_batch batch = {
        .size = sizeof batch, .count = TL_LANES, .area = areas, .f_n0 = zero, .state = state_at, .flags = flags};
    if (ops->across_gap) {
        tl_enter(law->kind, "across_gap");
        ops->across_gap(law->self, &batch, lift, hold);
        tl_leave();
    }
    press(law, &batch, at, lift, told, force);
    for (size_t l = 0; l < count; l++) {
        energy[l] = told[l] / area;
        stress[l] = force[l] / area;
    }
}

/* ---------------------------------------------------------------- presses ----------------- */

/* What slip pays for moving two faces apart as in the last step: as if all of the law's force were on them. */
static double pays_for_lift(const tl_press_row *row, double whole)
{
    return whole * row->opened * (1 - 0.5 * row->opened / row->press.overlap);
}

/* Tolerance: lift of the last step over the overlap from which the differences of forces that it has made are known
 * better than 1e-7. */
#define LIFT_KNOWN 1e-8

/* With an energy 2 kn G. What slip opens in this step presses as what it opened in the last, or as at the centre. */
static field_press press_linearly(const tl_press_row *row, double kn, double area, double f_n, double same)
{
    const tl_press *press = &row->press;
    double by = 2 * kn, size = tl_v3_norm(press->force), whole = by * size, spring = kn * area;
    double lifted = (f_n - whole) + (same - whole);
    tl_vec3 more = tl_v3_scale(lifted, press->normal), turn = tl_v3_cross(press->point, more);
    bool known = row->opened > LIFT_KNOWN * press->overlap && row->opened < press->overlap;
    if (press->lifted != 0 && known) {
        double share = by * press->lifted / pays_for_lift(row, whole);
        double again = by * lifted / (spring * row->opened * share);
        more = tl_v3_scale(again, row->extra.lifted_force);
        turn = tl_v3_scale(again, row->extra.lifted_moment);
    }
    return (field_press){.force = tl_v3_madd(more, by, press->force),
                         .moment = tl_v3_madd(turn, by, press->moment),
                         .energy = by * press->energy,
                         .springs = spring > 0 ? whole * whole / spring : 0,
                         .whole = whole,
                         .by_energy = by};
}

/* Tolerance: a closure over the other one below which it is none: moments of next to nothing may be roundings. */
#define LEAST_CLOSURE 1e-6

/* Closures of a press at which a law is asked that is not linear. */
static void find_closures(const tl_press_row *row, double closure[2])
{
    const tl_field_power *powers = row->extra.powers;
    const double moment[] = {powers[TL_PRESS_VOLUME].whole, 4 * row->press.energy, 12 * powers[TL_PRESS_SQUARE].whole,
                             32 * powers[TL_PRESS_CUBE].whole};
    tl_two_closures(moment, closure);
    closure[0] = fmax(closure[0], LEAST_CLOSURE * closure[1]);
}

/* Rows of the points of a SIMD group of field contacts. */
enum { FIELD_ROWS = TL_FIELD_POINTS * TL_LANES };

/* Energies and stresses per area at the two closures of each press, one for each point, before slip opens more. */
static void find_curves(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                        const double lift[FIELD_ROWS], told_press by[TL_LANES])
{
    const double *area = m->detect->points.area + group->start;
    double u[FIELD_ROWS] = {0}, energy[FIELD_ROWS], force[FIELD_ROWS];
    for (size_t l = 0; l < TL_LANES; l++) {
        if (group->contact[l] == TL_NO_ROW || !(area[l] > 0))
            continue;
        find_closures(tl_press_row_of(m, group->contact[l]), by[l].at);
        for (size_t k = 0; k < TL_FIELD_POINTS; k++)
            u[k * TL_LANES + l] = by[l].at[k];
    }
    tl_law_press(m, law, group->start, FIELD_ROWS, t, u, lift, energy, force);
    for (size_t i = 0; i < FIELD_ROWS; i++) {
        double per = area[i] > 0 ? 1 / area[i] : 0;
        by[i % TL_LANES].energy[i / TL_LANES] = per * energy[i];
        by[i % TL_LANES].stress[i / TL_LANES] = per * force[i];
    }
}

/* Asks a law of the field contacts of a SIMD group, whose first point is in lane `lane`. */
static void press_ask(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                      size_t lane, told_press by[TL_LANES])
{
    double closure[FIELD_ROWS], lift[FIELD_ROWS], hold[FIELD_ROWS];
    double energy[FIELD_ROWS], before[FIELD_ROWS];
    bool opens = false;
    memset(by, 0, TL_LANES * sizeof *by);
    memcpy(closure, t->closure + lane, sizeof closure);
    law_energies(m, law, group->start, FIELD_ROWS, t, closure, energy);
    tl_points_across_gap(law, &m->detect->points, group->start, FIELD_ROWS, lift, hold);
    find_curves(m, law, group, t, lift, by);
    for (size_t i = 0; i < FIELD_ROWS; i++) {
        uint32_t c = group->contact[i % TL_LANES];
        const tl_press_row *row = c == TL_NO_ROW ? NULL : tl_press_row_of(m, c);
        double opened = row ? lift[i] - row->opening[i / TL_LANES] : 0;
        by[i % TL_LANES].closure[i / TL_LANES] = closure[i] + lift[i];
        closure[i] -= opened;
        opens = opens || opened != 0;
    }
    memcpy(before, energy, sizeof before);
    if (opens)
        law_energies(m, law, group->start, FIELD_ROWS, t, closure, before);
    for (size_t i = 0; i < FIELD_ROWS; i++) {
        by[i % TL_LANES].springs[i / TL_LANES] = energy[i];
        by[i % TL_LANES].rise[i / TL_LANES] = energy[i] - before[i];
    }
}

/* The energy of the field, and its slopes by G and the powers. */
static double find_slopes(const tl_press_row *row, double area, const told_press *by, field_press *out)
{
    const tl_field_power *powers = row->extra.powers;
    double g = row->press.energy, v = powers[TL_PRESS_VOLUME].whole, p[4];
    tl_energy_cubic(by->at, by->energy, by->stress, p);
    double own = 0.25 * v * v / g, more = area / own;
    double all =
        p[0] * v + 4 * p[1] * g + 12 * p[2] * powers[TL_PRESS_SQUARE].whole + 32 * p[3] * powers[TL_PRESS_CUBE].whole;
    double stretch = all * (more - 1 / more);
    out->by_energy = more * 4 * p[1] + stretch / g;
    out->by_powers[TL_PRESS_VOLUME] = more * p[0] - 2 * stretch / v;
    out->by_powers[TL_PRESS_SQUARE] = more * 12 * p[2];
    out->by_powers[TL_PRESS_CUBE] = more * 32 * p[3];
    return more * all;
}

/* Adds what slip opens in this step at the overlap 4 G / V of the area: it adds to the force by m = F o / U of an
 * energy U ~ o^m of the closure o, dF = (F - U / o) dU / U. Gives that. */
static double add_rise(const tl_press_row *row, double area, const double f_n[TL_FIELD_POINTS], const told_press *by,
                       field_press *out)
{
    double g = row->press.energy, v = row->extra.powers[TL_PRESS_VOLUME].whole;
    double own = 0.25 * v * v / g, more[TL_FIELD_POINTS] = {0}, rise = 0;
    for (int k = 0; k < TL_FIELD_POINTS; k++) {
        double energy = by->springs[k];
        rise += by->rise[k];
        more[k] = energy > 0 ? (f_n[k] - energy / by->closure[k]) * by->rise[k] / energy : 0;
    }
    double all = more[0] + more[1], stretch = rise * (own / area) * (own / area);
    out->by_energy += all * 4 / v - stretch / g;
    out->by_powers[TL_PRESS_VOLUME] += 2 * stretch / v - all * 4 * g / (v * v);
    out->energy += rise;
    return more[TL_FIELD_TORSION];
}

/* By the energy that a law tells; f_n and `same` are its forces on the two points. */
static field_press press_by_law(const tl_press_row *row, double area, double f_n, double same, const told_press *by)
{
    const double forces[TL_FIELD_POINTS] = {f_n, same};
    field_press out = {.springs = by->springs[0] + by->springs[1]};
    const tl_press *press = &row->press;
    const tl_field_power *powers = row->extra.powers;
    out.energy = find_slopes(row, area, by, &out);
    out.whole = f_n + add_rise(row, area, forces, by, &out);
    out.force = tl_v3_scale(out.by_energy, press->force);
    out.moment = tl_v3_scale(out.by_energy, press->moment);
    for (int k = 0; k < TL_PRESS_POWERS; k++) {
        out.force = tl_v3_madd(out.force, out.by_powers[k], powers[k].force);
        out.moment = tl_v3_madd(out.moment, out.by_powers[k], powers[k].moment);
    }
    return out;
}

/* By the force that a law gives which does not tell of its energy. */
static field_press press_by_force(const tl_press *press, double kn, double area, double f_n, double same)
{
    double by = f_n / tl_v3_norm(press->force);
    return (field_press){.force = tl_v3_scale(by, press->force),
                         .moment = tl_v3_scale(by, press->moment),
                         .energy = by * press->energy,
                         .whole = f_n,
                         .by_energy = by,
                         .springs = (f_n * f_n + same * same) / (2 * kn * area)};
}

double tl_press_force(const tl_law *law, const tl_press_row *row, const double state[TL_STATE_COLUMNS])
{
    told_press by = {.at = {0}};
    if (!(row->press.area > 0))
        return 0;
    if (!tl_law_presses(law))
        return 2 * law->kn * tl_v3_norm(row->press.force);
    find_closures(row, by.at);
    tl_law_press_alone(law, row->press.area, state, by.at, 2, by.energy, by.stress);
    return tl_v3_norm(press_by_law(row, row->press.area, 0, 0, &by).force);
}

/* What the field has not got of what slip paid for moving two faces apart, where other faces press, too: heat, J. It is
 * a share of the mean of what slip paid in the step before and would pay here: the lift began there. */
static double lost_lift(const tl_press_row *row, const field_press *by)
{
    double pays = pays_for_lift(row, by->whole);
    double gets = by->by_energy * row->press.lifted;
    for (int k = 0; k < TL_PRESS_POWERS; k++)
        gets += by->by_powers[k] * row->extra.lifted_powers[k];
    return pays != 0 ? 0.5 * (row->paid + pays) * (1 - gets / pays) : 0;
}

/* ---------------------------------------------------------------- SIMD groups ------------ */

/* Of the field contacts of a SIMD group. The first point carries the normal force, the point of torsion the same again.
 * What the springs of the law hold pressed is not what the field holds: see tl_press. */
static void sum_fields(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                       size_t lane, const tl_arms *arms, tl_group_sums *out)
{
    (void)arms;
    const tl_detect *d = m->detect;
    const tl_contacts *contacts = &d->contacts;
    const tl_points_table *p = &d->points;
    const size_t torsion = TL_FIELD_TORSION * TL_LANES;
    const bool tells = tl_law_presses(law), linear = tl_law_is_linear(law);
    told_press pressed[TL_LANES];
    memset(out, 0, sizeof *out);
    if (tells)
        press_ask(m, law, group, t, lane, pressed);
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        size_t i = group->start + l, k = lane + l;
        double area = p->area[i];
        if (c == TL_NO_ROW || !(area > 0))
            continue;
        const tl_press_row *row = &d->press[contacts->press[c]];
        const tl_press *press = &row->press;
        const tl_mat3 *turn = tl_side_rotation(m, tl_contact_sides(m, c).a);
        double f_n = p->f_n[i], same = p->f_n[i + torsion];
        tl_vec3 x = tl_columns_get(t->arm, k), n = tl_columns_get(t->normal, k);
        tl_vec3 shear = tl_columns_get(p->f_s, i);
        tl_vec3 twist = tl_columns_get(p->f_s, i + torsion);
        const field_press by = linear  ? press_linearly(row, law->kn, area, f_n, same)
                               : tells ? press_by_law(row, area, f_n, same, &pressed[l])
                                       : press_by_force(press, law->kn, area, f_n, same);
        tl_vec3 force = tl_v3_add(shear, tl_m3_mul(turn, by.force));
        tl_vec3 moment = tl_v3_add(tl_v3_cross(x, shear), tl_m3_mul(turn, by.moment));
        moment = tl_v3_madd(moment, press->radius, twist);
        double spare = law->ks > 0 ? 0.5 * (row->spare[0] + row->spare[1]) / law->ks : 0;
        for (int axis = 0; axis < 3; axis++) {
            out->force[axis][l] = (&force.x)[axis];
            out->moment[axis][l] = (&moment.x)[axis];
        }
        out->stored[l] = t->stored[k] + t->stored[k + torsion] - by.springs + by.energy + spare;
        out->dissipated[l] = t->dissipated[k] + t->dissipated[k + torsion];
        if (press->lifted != 0)
            out->dissipated[l] += lost_lift(row, &by);
        out->odd[l] = 0 * (force.x + force.y + force.z + moment.x + moment.y + moment.z);
        if (fabs(tl_v3_dot(shear, n)) > TL_OUT_OF_PLANE * tl_v3_norm(force))
            out->odd[l] += 1;
    }
}

static void follow_fields(tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                          uint32_t tangents, tl_arms *arms)
{
    tl_simd_group_follow(m, group, true, t, lane, tangents, arms);
}

/* The first point carries the normal force and the shear, the other one the torsion. */
static void damp_fields(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                        const tl_arms *arms, tl_group_sums *out)
{
    (void)arms;
    memset(out, 0, sizeof *out);
    for (size_t l = 0; l < TL_LANES; l++) {
        const uint32_t c = group->contact[l];
        const size_t k = lane + l, torsion = k + TL_FIELD_TORSION * TL_LANES;
        if (c == TL_NO_ROW || !(m->detect->points.area[group->start + l] > 0))
            continue;
        const tl_vec3 shear = tl_v3(t->before[1][k], t->before[2][k], t->before[3][k]);
        const tl_vec3 twist = tl_v3(t->before[1][torsion], t->before[2][torsion], t->before[3][torsion]);
        const tl_vec3 force = tl_v3_madd(shear, t->before[0][k], tl_columns_get(t->normal, k));
        const tl_vec3 moment =
            tl_v3_madd(tl_v3_cross(tl_columns_get(t->arm, k), force), tl_press_row_of(m, c)->press.radius, twist);
        for (int axis = 0; axis < 3; axis++) {
            out->force[axis][l] = (&force.x)[axis];
            out->moment[axis][l] = (&moment.x)[axis];
        }
    }
}

const tl_kind_force tl_field_force = {.follow = follow_fields, .sum = sum_fields, .damp = damp_fields};
