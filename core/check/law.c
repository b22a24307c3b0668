/* law.c - the conformance check of contact laws.
 *
 * With each set of parameters 64 points of random areas and directions go through random motions: closing and opening,
 * shear that sticks and shear that slips. Every step is computed as a whole, in parts, point by point and turned in space;
 * from the place it leads to, the points are moved a little for the stiffness, and not at all. The normal force is looked at in
 * law_normal.c, work and energies on longer paths in law_energy.c. Forces are compared relative to those that the point has, or had on average. */
#include "check/law.h"

#include "check/checker.h"
#include "check/law_energy.h"
#include "check/law_normal.h"
#include "check/law_reads.h"
#include "check/law_steps.h"
#include "check/law_trial.h"
#include "check/params.h"
#include "check/points.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Steps of the random motion. */
#define STEPS 24
/* Of these the first, in which no bond breaks and little slips. */
#define GENTLE 4
/* Tolerance: share by which a stiffness may be exceeded: that of differences of forces, of which six digits are
 * left. */
#define SLACK 1e-6

#define ROUNDING TL_CHECK_ROUNDING
/* Steps without motion in which a point comes to rest, to the bit. */
#define SETTLES 8
/* Tolerance: share of the motion by which points are moved for the stiffness. */
#define SMALL (1. / 16)

const tl_check_rule tl_check_law_rules[] = {
    [TL_LAW_RUNS] = {"runs", "update() returns TL_OK, always when never_fails is set"},
    [TL_LAW_REPEATS] = {"repeats", "the same call gives the same bits"},
    [TL_LAW_ALONE] = {"one by one", "a point alone gets the bits that it gets in a batch"},
    [TL_LAW_SPLIT] = {"split", "batches of other sizes and orders give the same bits"},
    [TL_LAW_ENERGIES] = {"energies", "forces do not depend on whether energies are asked for"},
    [TL_LAW_WRITES] = {"writes",
                       "nothing is written but forces, flags, energies and declared states"},
    [TL_LAW_READS] =
        {"reads", "nothing depends on states that are not declared, nor on what is to be written"},
    [TL_LAW_PADDING] = {"padding", "lanes of no area carry nothing"},
    [TL_LAW_FINITE] = {"finite", "forces, states and energies are finite numbers"},
    [TL_LAW_PLANE] = {"plane", "the shear force lies in the common plane"},
    [TL_LAW_STILL] = {"no motion", "without motion and time the forces stay as they are"},
    [TL_LAW_TURNED] = {"turned",
                       "a turned point gets the turned forces, the same energies and states"},
    [TL_LAW_AREA] = {"area", "twice the area carries twice the force and the energy"},
    [TL_LAW_STIFFNESS] = {"stiffness", "no point is stiffer than stiffness() says"},
    [TL_LAW_CYCLE] = {"closed cycle", "a closed path of motion gives no energy"},
    [TL_LAW_BALANCE] = {"balance", "the work on a path is stored or turned to heat"},
    [TL_LAW_HEAT] = {"heat", "dissipated is not negative, and 0 without motion"},
    [TL_LAW_STEPS] = {"steps", "shear in a few steps leads to the forces that it does in many"},
    [TL_LAW_STATES] =
        {"states",
         "each declared state is written and read, and none written while stateless() says "
         "so"},
    [TL_LAW_PARAMETERS] = {"parameters", "each parameter has an effect"},
    [TL_LAW_FLAGS] = {"flags",
                      "points that are open carry nothing, those that have failed stay so"},
    [TL_LAW_PULLS] = {"pulls",
                      "no normal force across a gap where pulls() and across_gap() say so"},
    [TL_LAW_PRESSES] =
        {"presses", "the normal force and what it stores are those that linear or pressed() tells"},
    {NULL, NULL},
};

/* ---------------------------------------------------------------- a law to try ----------- */

typedef tl_law_trial trial;

static uint64_t key_of(const trial *t, uint64_t step, uint64_t point)
{
    return tl_key(tl_key(tl_key(1988, (uint64_t)t->c->set), step), point);
}

/* A vector in the common plane. */
static tl_vec3 tangent(uint64_t key, tl_vec3 normal, double size)
{
    tl_vec3 any = tl_check_direction(key);
    return tl_v3_scale(size, tl_v3_sub(any, tl_v3_scale(tl_v3_dot(any, normal), normal)));
}

/* The axis that the normal of a point is, for a few: zeros in two components of it, and of its shear; -1 of the others. */
static int axis_of(size_t i)
{
    return i % 16 == 6 ? (int)(i / 16 % 3) : -1;
}

static tl_vec3 unit(int axis)
{
    return tl_v3(axis % 3 == 0, axis % 3 == 1, axis % 3 == 2);
}

static void begin_points(trial *t)
{
    tl_check_points *p = &t->now;
    memset(p, 0, sizeof *p);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = key_of(t, 0, i);
        double area = tl_check_scale(tl_key(key, 1), -2, 1);
        p->c[TL_AT_AREA][i] = area;
        p->c[TL_AT_F_N0][i] =
            i % 8 % 7 % 2 ? 0 : area * t->law.stress * tl_check_between(tl_key(key, 2), 0, 1);
        int axis = axis_of(i);
        tl_check_put(p, TL_AT_NORMAL, i,
                     axis < 0 ? tl_check_direction(tl_key(key, 3)) : unit(axis));
        for (uint32_t k = 0; k < t->law.of.columns; k++)
            p->c[TL_AT_STATE + k][i] = t->law.of.initial[k];
        if (i % 4 == 3) { /* made while the walls were apart */
            p->flags[i] = TL_POINT_APART;
            p->c[TL_AT_CLOSURE][i] = -t->law.closure;
        }
        t->unmet[i] = i % 4 == 3;
        t->scale[i] = area * t->law.stress;
    }
}

/* The next motion of all points, of which one in five rests; of one in five that press a part is apart. */
static void next_motion(trial *t, int step)
{
    tl_check_points *in = &t->in;
    tl_check_gaps gaps;
    *in = t->now;
    in->dt = step == 0 ? 0 : TL_CHECK_DT;
    tl_law_gaps(&t->law, &t->now, &gaps);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = key_of(t, (uint64_t)step + 1, i);
        tl_vec3 normal = tl_check_vec(in, TL_AT_NORMAL, i);
        bool rests = step == 0 || tl_uniform(tl_key(key, 1)) < 0.2;
        double soft = step < GENTLE ? 0.02 : 1;
        double size = soft * tl_check_scale(tl_key(key, 2), -1, 1.5);
        double to =
            t->law.closure * soft * tl_check_between(tl_key(key, 3), step < GENTLE ? 0.1 : -0.4, 1);
        double closure = rests ? in->c[TL_AT_CLOSURE][i] : to;
        double before = in->c[TL_AT_CLOSURE][i] - in->c[TL_AT_APART][i];
        bool partly = i % 5 == 2 && closure + gaps.lift[i] > 0.1 * t->law.closure;
        double apart = partly ? 0.3 * t->law.closure * tl_uniform(tl_key(key, 6)) : 0;
        apart = partly && rests ? in->c[TL_AT_APART][i] : apart;
        in->c[TL_AT_CLOSURE][i] = closure;
        in->c[TL_AT_APART][i] = apart;
        in->c[TL_AT_EDGE][i] =
            tl_law_edge(closure, apart, gaps.lift[i],
                        i % 3 ? 0.05 * t->law.closure * tl_uniform(tl_key(key, 5)) : 0);
        in->c[TL_AT_DU_N][i] = before - (closure - apart);
        double way = rests ? 0 : size * t->law.slide;
        tl_vec3 slide = axis_of(i) < 0
                            ? tangent(tl_key(key, 4), normal, way)
                            : tl_v3_scale(tl_uniform(key) < 0.5 ? way : -way, unit(axis_of(i) + 1));
        tl_check_put(in, TL_AT_DU_S, i, slide);
    }
}

/* ---------------------------------------------------------------- what a call gave ------- */

static void compare_bits(trial *t, int check, const tl_check_points *other, bool energies,
                         const char *how)
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        if (!tl_law_same(&t->out, other, i, energies)) {
            tl_vec3 a = tl_check_vec(&t->out, TL_AT_F_S, i), b = tl_check_vec(other, TL_AT_F_S, i);
            tl_check_note(
                t->c, check,
                "f_n = %.17g N, |f_s| = %.17g N, flags %u in a batch of 64 points; %.17g, "
                "%.17g, %u %s",
                t->out.c[TL_AT_F_N][i], tl_v3_norm(a), t->out.flags[i], other->c[TL_AT_F_N][i],
                tl_v3_norm(b), other->flags[i], how);
            return;
        }
}

static bool call_law(trial *t, const tl_check_points *in, tl_check_points *out, const size_t *order,
                     size_t begin, size_t count, bool energies)
{
    tl_check_call call = {.no_energies = !energies};
    return tl_law_call(t, in, out, order, begin, count, &call);
}

static bool call_in_parts(trial *t, tl_check_points *out, const size_t *order, const size_t *parts)
{
    size_t begin = 0;
    for (size_t k = 0; begin < TL_CHECK_POINTS; begin += parts[k++])
        if (!call_law(t, &t->in, out, order, begin, parts[k], true))
            return false;
    return true;
}

/* The step as a whole, again, point by point, in parts of another order, without energies. */
static bool compare_batches(trial *t, int step)
{
    static const size_t ones[TL_CHECK_POINTS] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    static const size_t parts[] = {8, 3, 40, 13};
    tl_check_points other = t->in;
    size_t order[TL_CHECK_POINTS], twice[TL_CHECK_LANES];
    for (size_t i = 0; i < TL_CHECK_LANES; i++)
        twice[i] = (i + i / TL_CHECK_POINTS * 5) % TL_CHECK_POINTS;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) /* a step that 64 has no factor of */
        order[i] = (i * 37 + (size_t)step) % TL_CHECK_POINTS;
    t->out = t->in;
    if (!call_law(t, &t->in, &t->out, NULL, 0, TL_CHECK_POINTS, true))
        return false;
    if (call_in_parts(t, &other, NULL, ones))
        compare_bits(t, TL_LAW_ALONE, &other, true, "alone");
    if (call_in_parts(t, &other, order, parts))
        compare_bits(t, TL_LAW_SPLIT, &other, true,
                     "in batches of 8, 3, 40 and 13 in another order");
    if (call_law(t, &t->in, &other, twice, 0, TL_CHECK_LANES, true))
        compare_bits(t, TL_LAW_SPLIT, &other, true, "in the second half of a batch of 136");
    if (call_law(t, &t->in, &other, NULL, 0, TL_CHECK_POINTS, false))
        compare_bits(t, TL_LAW_ENERGIES, &other, false, "without energies");
    if (call_law(t, &t->in, &other, NULL, 0, TL_CHECK_POINTS, true))
        compare_bits(t, TL_LAW_REPEATS, &other, true, "when called again");
    return true;
}

static void check_numbers(trial *t)
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 n = tl_check_vec(&t->out, TL_AT_NORMAL, i), f = tl_check_vec(&t->out, TL_AT_F_S, i);
        for (int k = TL_AT_F_N; k < TL_AT_COUNT; k++)
            if (!isfinite(t->out.c[k][i]))
                tl_check_note(t->c, TL_LAW_FINITE, "%s is %g at a closure of %g m, dt = %g s",
                              k < TL_AT_STORED  ? "a force"
                              : k < TL_AT_STATE ? "an energy"
                                                : "a state",
                              t->out.c[k][i], t->in.c[TL_AT_CLOSURE][i], t->in.dt);
        double along = fabs(tl_v3_dot(n, f));
        if (along > ROUNDING * (t->scale[i] + tl_v3_norm(f)))
            tl_check_note(t->c, TL_LAW_PLANE, "|f_s| = %g N has %g N along the normal",
                          tl_v3_norm(f), along);
    }
}

static void check_states(trial *t)
{
    const tl_law_ops *ops = t->law.of.ops;
    bool stateless = ops->stateless && ops->stateless(t->law.of.self);
    for (uint32_t k = 0; k < t->law.of.columns; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
            if (t->out.c[TL_AT_STATE + k][i] == t->in.c[TL_AT_STATE + k][i])
                continue;
            t->seen->written |= 1u << k;
            if (stateless)
                tl_check_note(t->c, TL_LAW_STATES,
                              "state column %u is written, though stateless() is 1", k + 1);
        }
}

/* ---------------------------------------------------------------- other steps ------------ */

/* Rotation of all vectors: by 1 rad or so about some axis. */
static void turn_points(const trial *t, tl_mat3 r, tl_check_points *p)
{
    static const int vectors[] = {TL_AT_NORMAL, TL_AT_DU_S, TL_AT_F_S};
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
            tl_check_put(p, vectors[k], i, tl_m3_mul(&r, tl_check_vec(p, vectors[k], i)));
        for (uint32_t k = 0; k < t->law.of.columns; k++)
            if (t->law.of.tangent[k])
                tl_check_put(p, TL_AT_STATE + (int)k, i,
                             tl_m3_mul(&r, tl_check_vec(p, TL_AT_STATE + (int)k, i)));
    }
}

/* What a column is: an energy, or the name of its state. */
static const char *column_name(const tl_kind *kind, uint32_t column)
{
    if (column < TL_AT_STATE)
        return column == TL_AT_STORED ? "stored" : "dissipated";
    uint32_t first = TL_AT_STATE, i = 0;
    while (first + (kind->states[i].kind == TL_STATE_TANGENT ? 3 : 1) <= column)
        first += kind->states[i++].kind == TL_STATE_TANGENT ? 3 : 1;
    return kind->states[i].name;
}

/* Energies and states of turned points: those of tangents are turned as well. */
static void check_turned_columns(trial *t, const tl_check_points *out,
                                 const tl_check_points *expected)
{
    for (uint32_t k = TL_AT_STORED; k < TL_AT_STATE + t->law.of.columns; k++) {
        const bool vector = k >= TL_AT_STATE && t->law.of.tangent[k - TL_AT_STATE];
        const uint32_t last = k + (vector ? 2 : 0);
        double most = 0, error = 0;
        for (uint32_t j = k; j <= last; j++)
            for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
                most = fmax(most, fabs(expected->c[j][i]));
                error = fmax(error, fabs(out->c[j][i] - expected->c[j][i]));
            }
        /* an opening may be what rounding of the slide leaves */
        if (error > 1e3 * ROUNDING * most && error > ROUNDING * t->law.slide)
            tl_check_note(t->c, TL_LAW_TURNED, "%s '%s' of a turned point differs by %g of %g",
                          k < TL_AT_STATE ? "the energy" : "the state",
                          column_name(t->law.of.kind, k), error, most);
        k = last;
    }
}

static void check_turned(trial *t, int step)
{
    tl_vec3 axis = tl_check_direction(key_of(t, (uint64_t)step, 77));
    tl_mat3 r = tl_q_matrix((tl_quat){0.6, 0.8 * axis.x, 0.8 * axis.y, 0.8 * axis.z});
    tl_check_points in = t->in, out, expected = t->out;
    turn_points(t, r, &in);
    out = in;
    if (!call_law(t, &in, &out, NULL, 0, TL_CHECK_POINTS, true))
        return;
    turn_points(t, r, &expected);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(&out, TL_AT_F_S, i), b = tl_check_vec(&expected, TL_AT_F_S, i);
        double error =
            fmax(tl_v3_norm(tl_v3_sub(a, b)), fabs(out.c[TL_AT_F_N][i] - expected.c[TL_AT_F_N][i]));
        if (error > 1e3 * ROUNDING * (t->scale[i] + tl_v3_norm(b)))
            tl_check_note(t->c, TL_LAW_TURNED,
                          "the forces of a turned point differ by %g N of %g N", error,
                          t->scale[i] + tl_v3_norm(b));
    }
    check_turned_columns(t, &out, &expected);
}

/* The points as the step has left them, at rest. */
static tl_check_points rest_of(const trial *t)
{
    tl_check_points rest = t->out;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        rest.c[TL_AT_DU_N][i] = 0;
        tl_check_put(&rest, TL_AT_DU_S, i, tl_v3(0, 0, 0));
    }
    return rest;
}

/* A point that rests comes to rest: the host does not ask for it again when nothing changes any more. */
static void check_settled(trial *t, const tl_check_points *rested)
{
    tl_check_points rest = *rested, out;
    bool settled[TL_CHECK_POINTS];
    for (int k = 0; k < SETTLES; k++) {
        bool all = true;
        out = rest;
        rest.dt = 0;
        if (!call_law(t, &rest, &out, NULL, 0, TL_CHECK_POINTS, true))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            all &= settled[i] = tl_law_same(&rest, &out, i, false);
        if (all)
            break;
        rest = out;
    }
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        double heat = out.c[TL_AT_DISSIPATED][i];
        if (!settled[i])
            tl_check_note(
                t->c, TL_LAW_STILL,
                "a point never comes to rest: its forces, states or flags change in each step "
                "without motion and time, f_n from %.17g to %.17g N",
                rest.c[TL_AT_F_N][i], out.c[TL_AT_F_N][i]);
        if (heat != 0)
            tl_check_note(t->c, TL_LAW_HEAT, "dissipated = %g J in a step without motion and time",
                          heat);
        if (out.flags[i] & TL_POINT_SLIPPING)
            tl_check_note(t->c, TL_LAW_FLAGS,
                          "a point is flagged as slipping in a step without motion "
                          "and time");
    }
}

static void check_still(trial *t)
{
    tl_check_points rest = rest_of(t), out = rest;
    rest.dt = 0;
    if (!call_law(t, &rest, &out, NULL, 0, TL_CHECK_POINTS, true))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(&rest, TL_AT_F_S, i), b = tl_check_vec(&out, TL_AT_F_S, i);
        double before = rest.c[TL_AT_F_N][i], after = out.c[TL_AT_F_N][i];
        double error = fmax(fabs(before - after), tl_v3_norm(tl_v3_sub(a, b)));
        if (error > ROUNDING * (t->scale[i] + tl_v3_norm(a)))
            tl_check_note(t->c, TL_LAW_STILL,
                          "f_n goes from %g to %g N and f_s by %g N, without any motion", before,
                          after, tl_v3_norm(tl_v3_sub(a, b)));
    }
    check_settled(t, &out);
}

/* Moves each point a little, across the joint or along it, and compares the rise of the force with the stiffness. What
 * falls is no matter: it does not shorten the time step. */
static void check_stiffness(trial *t, int step, bool along)
{
    tl_check_points rest = rest_of(t), out;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = key_of(t, (uint64_t)step, 1000 + i);
        double move = SMALL * t->law.closure * tl_check_between(key, -1, 1);
        if (along) {
            tl_vec3 n = tl_check_vec(&rest, TL_AT_NORMAL, i);
            tl_check_put(&rest, TL_AT_DU_S, i, tangent(key, n, SMALL * t->law.slide));
        } else {
            rest.c[TL_AT_CLOSURE][i] += move;
            rest.c[TL_AT_EDGE][i] += move;
            rest.c[TL_AT_DU_N][i] = -move;
        }
    }
    out = rest;
    if (!call_law(t, &rest, &out, NULL, 0, TL_CHECK_POINTS, true))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 slide = tl_check_vec(&rest, TL_AT_DU_S, i);
        tl_vec3 change =
            tl_v3_sub(tl_check_vec(&out, TL_AT_F_S, i), tl_check_vec(&rest, TL_AT_F_S, i));
        double area = rest.c[TL_AT_AREA][i], closing = -rest.c[TL_AT_DU_N][i];
        double moved = along ? tl_v3_norm(slide) : fabs(closing);
        double rise = along ? -tl_v3_dot(change, slide) / (moved > 0 ? moved : 1)
                            : (out.c[TL_AT_F_N][i] - rest.c[TL_AT_F_N][i]) * (closing < 0 ? -1 : 1);
        double bound = along ? t->law.ks : t->law.kn;
        /* what falls: friction does at any rate, and a bond, which breaks or softens in the part that is apart; walls that
         * meet are where the closure says */
        bool falls = along ? tl_v3_norm(tl_check_vec(&out, TL_AT_F_S, i)) <
                                 tl_v3_norm(tl_check_vec(&rest, TL_AT_F_S, i))
                           : rest.c[TL_AT_APART][i] > 0;
        uint32_t changed = out.flags[i] ^ rest.flags[i];
        if (falls || changed & (TL_POINT_OPEN | TL_POINT_FAILED | TL_POINT_APART))
            continue;
        if (rise > bound * area * moved * (1 + SLACK) + ROUNDING * t->scale[i])
            tl_check_note(t->c, TL_LAW_STIFFNESS, "%s = %g Pa/m, but stiffness() says %g Pa/m",
                          along ? "ks" : "kn", rise / (area * moved), bound);
    }
}

/* ---------------------------------------------------------------- what goes with the area ---
 *
 * A point of twice the area, with the same stresses, carries twice the force and twice the energy. */

/* Tolerance: relative error that rounding may come to. Test: unit/test_check. */
#define ERROR 1e-8

/* How a column goes with the area. */
static double power_of(const tl_law_trial *t, int column)
{
    if (column >= TL_AT_STATE)
        return t->law.of.extensive[column - TL_AT_STATE] ? 2 : 1;
    bool goes = column == TL_AT_AREA || column == TL_AT_F_N0 || column >= TL_AT_F_N;
    return goes ? 2 : 1;
}

/* Points whose states begin anew, where they do so when areas change; and their twins of twice the area. */
static void make_twins(const tl_law_trial *t, tl_check_points *one, tl_check_points *two)
{
    const int last = TL_AT_STATE + (int)t->law.of.columns;
    *one = t->in;
    for (int k = TL_AT_STATE; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS && t->law.of.resets[k - TL_AT_STATE]; i++)
            one->c[k][i] = t->law.of.initial[k - TL_AT_STATE];
    *two = *one;
    for (int k = 0; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            two->c[k][i] *= power_of(t, k);
}

static void compare(tl_law_trial *t, int column, size_t i, double one, double is)
{
    bool force = column < TL_AT_STORED, energy = column < TL_AT_STATE;
    double expected = power_of(t, column) * one;
    double scale = force ? t->scale[i] : energy ? t->scale[i] * t->law.closure : fabs(one);
    if (fabs(is - expected) > ERROR * (scale + fabs(expected)))
        tl_check_note(t->c, TL_LAW_AREA,
                      "with twice the area and the same stresses %s is %g, not %g",
                      force    ? "a force"
                      : energy ? "an energy"
                               : "a state",
                      is, expected);
}

/* What goes with the area. */
static void law_check_area(tl_law_trial *t)
{
    tl_check_points one, two, out_one, out_two;
    tl_check_call call = {0};
    if (tl_check_failed(t->c, TL_LAW_AREA))
        return;
    make_twins(t, &one, &two);
    out_one = one;
    out_two = two;
    if (!tl_law_call(t, &one, &out_one, NULL, 0, TL_CHECK_POINTS, &call) ||
        !tl_law_call(t, &two, &out_two, NULL, 0, TL_CHECK_POINTS, &call))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        for (int k = TL_AT_F_N; k < TL_AT_STATE + (int)t->law.of.columns; k++)
            if (k < TL_AT_STATE || !t->law.of.resets[k - TL_AT_STATE])
                compare(t, k, i, out_one.c[k][i], out_two.c[k][i]);
}

/* ---------------------------------------------------------------- all of it -------------- */

static void run_trial(trial *t, tl_check_law varied[], const bool open[])
{
    begin_points(t);
    for (int step = 0; step < STEPS; step++) {
        next_motion(t, step);
        if (!compare_batches(t, step))
            return;
        check_numbers(t);
        if (tl_check_failed(t->c, TL_LAW_FINITE))
            return;
        tl_law_check_normal(t, step);
        tl_law_check_flags(t);
        check_states(t);
        tl_law_check_reads(t);
        law_check_area(t);
        tl_law_see_states(t);
        tl_law_see_params(t, varied, open);
        check_turned(t, step);
        check_still(t);
        check_stiffness(t, step, false);
        check_stiffness(t, step, true);
        t->now = t->out;
    }
    tl_law_check_energy(t);
    tl_law_check_steps(t);
}

/* Columns of the declared states. */
static void read_states(const tl_kind *kind, tl_check_law_of *of)
{
    for (uint32_t i = 0; i < kind->state_count; i++) {
        const tl_state *state = &kind->states[i];
        bool turns = state->kind == TL_STATE_TANGENT;
        of->tangent[of->columns] = turns;
        for (int k = 0; k < (turns ? 3 : 1) && of->columns < TL_STATE_COLUMNS; k++) {
            of->extensive[of->columns] =
                state->transfer == TL_TRANSFER_SPLIT || state->transfer == TL_TRANSFER_ENERGY;
            of->resets[of->columns] = state->transfer == TL_TRANSFER_RESET;
            of->initial[of->columns++] = state->initial;
        }
    }
}

/* Makes the law with parameters of the kind's struct; not TL_OK when the law refuses them. */
static tl_status open_law(tl_checker *c, void *params, tl_check_law *law)
{
    const tl_law_ops *ops = c->kind->ops;
    tl_report report = {.size = sizeof report};
    *law = (tl_check_law){.of = {.kind = c->kind, .ops = ops, .self = params}};
    read_states(c->kind, &law->of);
    if (ops->create) {
        void *self = NULL;
        tl_status status = ops->create(params, &self, &report);
        if (status != TL_OK)
            return tl_fail(c->error, status, "'%s' cannot be tried: %s", c->kind->name,
                           tl_report_text(&report, status));
        law->of.self = self;
    }
    law->kn = law->ks = NAN;
    ops->stiffness(law->of.self, &law->kn, &law->ks);
    if (!(law->kn >= 0 && law->ks >= 0 && isfinite(law->kn) && isfinite(law->ks)))
        tl_check_note(c, TL_LAW_STIFFNESS,
                      "stiffness() says kn = %g, ks = %g Pa/m: both must be finite and >= 0",
                      law->kn, law->ks);
    law->stress = tl_check_scale(tl_key(88, (uint64_t)c->set), 4, 6.5);
    double soft = law->kn > 0 && isfinite(law->kn) ? law->kn : 1e9;
    law->closure = law->stress / soft;
    law->slide = law->ks > 0 && isfinite(law->ks) ? law->stress / law->ks : law->closure;
    return TL_OK;
}

static void close_law(tl_check_law *law)
{
    if (law->of.ops->destroy)
        law->of.ops->destroy((void *)(uintptr_t)law->of.self);
}

/* Laws that each have one parameter changed, of those whose effect has not been seen; and a trial with them. */
static tl_status try_set(trial *t, int set)
{
    tl_checker *c = t->c;
    const uint32_t count = c->kind->param_count;
    tl_check_law varied[TL_CHECK_PARAMS];
    void *params[TL_CHECK_PARAMS] = {NULL}, *held[TL_CHECK_PARAMS] = {NULL};
    bool open[TL_CHECK_PARAMS] = {false};
    char text[sizeof c->params_text];
    memcpy(text, c->params_text, sizeof text);
    tl_status status = TL_OK;
    for (uint32_t k = 0; k < count && k < TL_CHECK_PARAMS && status == TL_OK; k++) {
        if (t->seen->matters[k])
            continue;
        params[k] = malloc(c->kind->params_size + 1);
        if (!params[k])
            status = tl_fail_memory(c->error);
        else if (tl_check_varied(c, set, k, params[k], &held[k]) == TL_OK)
            open[k] = open_law(c, params[k], &varied[k]) == TL_OK;
        if (open[k] && (varied[k].kn != t->law.kn || varied[k].ks != t->law.ks))
            t->seen->matters[k] = true;
    }
    memcpy(c->params_text, text, sizeof text);
    if (status == TL_OK)
        run_trial(t, varied, open);
    for (uint32_t k = 0; k < TL_CHECK_PARAMS; k++) {
        if (open[k])
            close_law(&varied[k]);
        free(params[k]);
        free(held[k]);
    }
    return status;
}

tl_status tl_check_law_kind(tl_checker *c)
{
    trial *t = malloc(sizeof *t);
    void *params = malloc(c->kind->params_size + 1), *held;
    tl_check_seen seen = {0};
    int tried = 0, most = 20 * TL_CHECK_SETS; /* laws refuse some drawn sets */
    tl_status status = t && params ? TL_OK : tl_fail_memory(c->error);
    for (int set = 0; status == TL_OK && set < most && tried < TL_CHECK_SETS; set++) {
        tl_status read = tl_check_params(c, set, params, &held);
        if (read == TL_OK && (read = open_law(c, params, &t->law)) == TL_OK) {
            t->c = c;
            t->seen = &seen;
            if (!tl_check_failed(c, TL_LAW_STIFFNESS) || isfinite(t->law.kn + t->law.ks))
                status = try_set(t, set);
            close_law(&t->law);
            tried++;
        }
        free(held);
        if (set == 0 && c->args && c->args->count > 0 && status == TL_OK)
            status = read; /* given by the user: what is wrong with them is to be told */
    }
    if (status == TL_OK && tried == 0)
        status = TL_E_ARGUMENT; /* with the sentence of the last attempt */
    else if (status == TL_OK && !tl_check_failed(c, TL_LAW_RUNS))
        tl_law_tell_unseen(c, &seen);
    free(t);
    free(params);
    return status;
}
