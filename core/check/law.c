/* law.c - the conformance check of contact laws.
 *
 * With each set of parameters 64 points of random areas and directions go through random motions: closing and opening,
 * shear that sticks and shear that slips. Every step is computed as a whole, in parts, point by point and turned in
 * space; from the place it leads to, the points are moved a little for the stiffness, and not at all. A state is given
 * another value, that of another point, and a parameter another one of its range: the result must be another one to the
 * bit, with some set of parameters, at some point of some step. The normal force is looked at in law_normal.c, work and
 * energies on longer paths in law_paths.c. Forces are compared relative to those that the point has, or had on
 * average. Strengths that are marked are divided in law_strength.c. */
#include "check/law.h"

#include "check/law_normal.h"
#include "check/law_paths.h"
#include "check/law_strength.h"

#include <math.h>
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

#define RULE(number, name, doc) [number] = {name, doc},
static const tl_check_rule rules[] = {TL_LAW_RULES(RULE){NULL, NULL}};
#undef RULE

/* ---------------------------------------------------------------- a law to try ----------- */

typedef tl_law_trial trial;

static uint64_t key_of(const trial *t, uint64_t step, uint64_t point)
{
    return tl_key(tl_key(tl_key(1988, (uint64_t)t->c->set), step), point);
}

/* How many columns a state has. */
static uint32_t width_of(const tl_kind *kind, uint32_t state)
{
    return kind->states[state].kind == TL_STATE_TANGENT ? 3 : 1;
}

/* The axis that the normal of a point is, for a few: zeros in two components of it, and of its shear; -1 of the
 * others. */
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
        int axis = axis_of(i);
        tl_law_begin(&t->law, p, i, area, axis < 0 ? tl_check_direction(tl_key(key, 3)) : unit(axis));
        p->c[TL_AT_F_N0][i] = i % 8 % 7 % 2 ? 0 : area * t->law.stress * tl_check_between(tl_key(key, 2), 0, 1);
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
        tl_vec3 normal = tl_check_vec(in->c[TL_AT_NORMAL], i);
        bool rests = step == 0 || tl_uniform(tl_key(key, 1)) < 0.2;
        double soft = step < GENTLE ? 0.02 : 1;
        double size = soft * tl_check_scale(tl_key(key, 2), -1, 1.5);
        double to = t->law.closure * soft * tl_check_between(tl_key(key, 3), step < GENTLE ? 0.1 : -0.4, 1);
        double closure = rests ? in->c[TL_AT_CLOSURE][i] : to;
        double before = in->c[TL_AT_CLOSURE][i] - in->c[TL_AT_APART][i];
        bool partly = i % 5 == 2 && closure + gaps.lift[i] > 0.1 * t->law.closure;
        double apart = partly ? 0.3 * t->law.closure * tl_uniform(tl_key(key, 6)) : 0;
        apart = partly && rests ? in->c[TL_AT_APART][i] : apart;
        in->c[TL_AT_CLOSURE][i] = closure;
        in->c[TL_AT_APART][i] = apart;
        in->c[TL_AT_EDGE][i] =
            tl_law_edge(closure, apart, gaps.lift[i], i % 3 ? 0.05 * t->law.closure * tl_uniform(tl_key(key, 5)) : 0);
        in->c[TL_AT_DU_N][i] = before - (closure - apart);
        double way = rests ? 0 : size * t->law.slide;
        tl_vec3 slide = axis_of(i) < 0 ? tl_law_tangent(tl_key(key, 4), normal, way)
                                       : tl_v3_scale(tl_uniform(key) < 0.5 ? way : -way, unit(axis_of(i) + 1));
        tl_check_put(in->c[TL_AT_DU_S], i, slide);
    }
}

/* ---------------------------------------------------------------- what a call gave ------- */

/* Whether two calls gave the point the same, to the bit. */
static bool same(const tl_check_points *a, const tl_check_points *b, size_t i, bool energies)
{
    for (int k = TL_AT_F_N; k < TL_AT_COUNT; k++)
        if ((energies || (k != TL_AT_STORED && k != TL_AT_DISSIPATED)) &&
            memcmp(&a->c[k][i], &b->c[k][i], sizeof a->c[k][i]) != 0)
            return false;
    return a->flags[i] == b->flags[i];
}

static void compare_bits(trial *t, int check, const tl_check_points *other, bool energies, const char *how)
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        if (!same(&t->out, other, i, energies)) {
            tl_vec3 a = tl_check_vec(t->out.c[TL_AT_F_S], i), b = tl_check_vec(other->c[TL_AT_F_S], i);
            tl_check_note(t->c, check,
                          "f_n = %.17g N, |f_s| = %.17g N, flags %u in a batch of 64 points; %.17g, %.17g, %u %s",
                          t->out.c[TL_AT_F_N][i], tl_v3_norm(a), t->out.flags[i], other->c[TL_AT_F_N][i], tl_v3_norm(b),
                          other->flags[i], how);
            return;
        }
}

/* Calls the law on some points and notes what every call must keep to; false when it failed. `call`: what is asked. */
static bool call_some(trial *t, const tl_check_points *in, tl_check_points *out, const size_t *order, size_t begin,
                      size_t count, tl_check_call call)
{
    tl_law_call(&t->law, in, out, order, begin, count, &call);
    if (call.overwrote)
        tl_check_note(t->c, TL_LAW_WRITES, "update() writes to %s", call.overwrote);
    if (call.padding)
        tl_check_note(t->c, TL_LAW_PADDING, "a lane of no area has a force or an energy");
    if (call.status != TL_OK)
        tl_check_note(t->c, TL_LAW_RUNS, "update() fails%s: %s",
                      t->law.ops->never_fails ? ", though never_fails is set" : "",
                      tl_report_text(&call.report, call.status));
    return call.status == TL_OK;
}

/* The same with all points, in one batch. */
static bool call_all(trial *t, const tl_check_points *in, tl_check_points *out, tl_check_call call)
{
    *out = *in;
    return call_some(t, in, out, NULL, 0, TL_CHECK_POINTS, call);
}

static bool call_law(trial *t, const tl_check_points *in, tl_check_points *out)
{
    return call_all(t, in, out, (tl_check_call){0});
}

/* The step in batches of so many points, in turn. */
static bool call_in_parts(trial *t, tl_check_points *out, const size_t *order, const size_t *parts, size_t most)
{
    size_t begin = 0;
    for (size_t k = 0; begin < TL_CHECK_POINTS; begin += parts[k++ % most])
        if (!call_some(t, &t->in, out, order, begin, parts[k % most], (tl_check_call){0}))
            return false;
    return true;
}

/* The step as a whole, again, point by point, in parts of another order, without energies. */
static bool compare_batches(trial *t, int step)
{
    static const size_t one[] = {1}, parts[] = {8, 3, 40, 13};
    tl_check_points other = t->in;
    size_t order[TL_CHECK_POINTS], twice[TL_CHECK_LANES];
    for (size_t i = 0; i < TL_CHECK_LANES; i++)
        twice[i] = (i + i / TL_CHECK_POINTS * 5) % TL_CHECK_POINTS;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) /* a step that 64 has no factor of */
        order[i] = (i * 37 + (size_t)step) % TL_CHECK_POINTS;
    if (!call_law(t, &t->in, &t->out))
        return false;
    if (call_in_parts(t, &other, NULL, one, 1))
        compare_bits(t, TL_LAW_ALONE, &other, true, "alone");
    if (call_in_parts(t, &other, order, parts, sizeof parts / sizeof *parts))
        compare_bits(t, TL_LAW_SPLIT, &other, true, "in batches of 8, 3, 40 and 13 in another order");
    if (call_some(t, &t->in, &other, twice, 0, TL_CHECK_LANES, (tl_check_call){0}))
        compare_bits(t, TL_LAW_SPLIT, &other, true, "in the second half of a batch of 136");
    if (call_all(t, &t->in, &other, (tl_check_call){.no_energies = true}))
        compare_bits(t, TL_LAW_ENERGIES, &other, false, "without energies");
    if (call_law(t, &t->in, &other))
        compare_bits(t, TL_LAW_REPEATS, &other, true, "when called again");
    return true;
}

static void check_numbers(trial *t)
{
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 n = tl_check_vec(t->out.c[TL_AT_NORMAL], i), f = tl_check_vec(t->out.c[TL_AT_F_S], i);
        for (int k = TL_AT_F_N; k < TL_AT_COUNT; k++)
            if (!isfinite(t->out.c[k][i]))
                tl_check_note(t->c, TL_LAW_FINITE, "%s is %g at a closure of %g m, dt = %g s",
                              k < TL_AT_STORED  ? "a force"
                              : k < TL_AT_STATE ? "an energy"
                                                : "a state",
                              t->out.c[k][i], t->in.c[TL_AT_CLOSURE][i], t->in.dt);
        double along = fabs(tl_v3_dot(n, f));
        if (along > ROUNDING * (t->scale[i] + tl_v3_norm(f)))
            tl_check_note(t->c, TL_LAW_PLANE, "|f_s| = %g N has %g N along the normal", tl_v3_norm(f), along);
    }
}

static bool is_stateless(const tl_check_law *law)
{
    return law->ops->stateless && law->ops->stateless(law->self);
}

static void check_states(trial *t)
{
    bool stateless = is_stateless(&t->law);
    for (uint32_t k = 0; k < t->law.columns; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
            if (t->out.c[TL_AT_STATE + k][i] == t->in.c[TL_AT_STATE + k][i])
                continue;
            t->seen.written |= 1u << k;
            if (stateless)
                tl_check_note(t->c, TL_LAW_STATES, "state column %u is written, though stateless() is 1", k + 1);
        }
}

/* ---------------------------------------------------------------- other steps ------------ */

/* Rotation of all vectors: by 1 rad or so about some axis. */
static void turn_points(const trial *t, tl_mat3 r, tl_check_points *p)
{
    static const int vectors[] = {TL_AT_NORMAL, TL_AT_DU_S, TL_AT_F_S};
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
            tl_check_put(p->c[vectors[k]], i, tl_m3_mul(&r, tl_check_vec(p->c[vectors[k]], i)));
        for (uint32_t k = 0; k < t->law.columns; k++)
            if (t->law.tangent[k])
                tl_check_put(p->c[TL_AT_STATE + (int)k], i, tl_m3_mul(&r, tl_check_vec(p->c[TL_AT_STATE + (int)k], i)));
    }
}

/* What a column is: an energy, or the name of its state. */
static const char *column_name(const tl_kind *kind, uint32_t column)
{
    if (column < TL_AT_STATE)
        return column == TL_AT_STORED ? "stored" : "dissipated";
    uint32_t first = TL_AT_STATE, i = 0;
    while (first + width_of(kind, i) <= column)
        first += width_of(kind, i++);
    return kind->states[i].name;
}

/* Energies and states of turned points: those of tangents are turned as well. */
static void check_turned_columns(trial *t, const tl_check_points *out, const tl_check_points *expected)
{
    for (uint32_t k = TL_AT_STORED; k < TL_AT_STATE + t->law.columns; k++) {
        const bool vector = k >= TL_AT_STATE && t->law.tangent[k - TL_AT_STATE];
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
                          k < TL_AT_STATE ? "the energy" : "the state", column_name(t->law.kind, k), error, most);
        k = last;
    }
}

static void check_turned(trial *t, int step)
{
    tl_vec3 axis = tl_check_direction(key_of(t, (uint64_t)step, 77));
    tl_mat3 r = tl_q_matrix((tl_quat){0.6, 0.8 * axis.x, 0.8 * axis.y, 0.8 * axis.z});
    tl_check_points in = t->in, out, expected = t->out;
    turn_points(t, r, &in);
    if (!call_law(t, &in, &out))
        return;
    turn_points(t, r, &expected);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(out.c[TL_AT_F_S], i), b = tl_check_vec(expected.c[TL_AT_F_S], i);
        double error = fmax(tl_v3_norm(tl_v3_sub(a, b)), fabs(out.c[TL_AT_F_N][i] - expected.c[TL_AT_F_N][i]));
        if (error > 1e3 * ROUNDING * (t->scale[i] + tl_v3_norm(b)))
            tl_check_note(t->c, TL_LAW_TURNED, "the forces of a turned point differ by %g N of %g N", error,
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
        tl_check_put(rest.c[TL_AT_DU_S], i, tl_v3(0, 0, 0));
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
        rest.dt = 0;
        if (!call_law(t, &rest, &out))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            all &= settled[i] = same(&rest, &out, i, false);
        if (all)
            break;
        rest = out;
    }
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        double heat = out.c[TL_AT_DISSIPATED][i];
        if (!settled[i])
            tl_check_note(t->c, TL_LAW_STILL,
                          "a point never comes to rest: its forces, states or flags change in each step "
                          "without motion and time, f_n from %.17g to %.17g N",
                          rest.c[TL_AT_F_N][i], out.c[TL_AT_F_N][i]);
        if (heat != 0)
            tl_check_note(t->c, TL_LAW_HEAT, "dissipated = %g J in a step without motion and time", heat);
        if (out.flags[i] & TL_POINT_SLIPPING)
            tl_check_note(t->c, TL_LAW_FLAGS, "a point is flagged as slipping in a step without motion and time");
    }
}

static void check_still(trial *t)
{
    tl_check_points rest = rest_of(t), out;
    rest.dt = 0;
    if (!call_law(t, &rest, &out))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 a = tl_check_vec(rest.c[TL_AT_F_S], i), b = tl_check_vec(out.c[TL_AT_F_S], i);
        double before = rest.c[TL_AT_F_N][i], after = out.c[TL_AT_F_N][i];
        double error = fmax(fabs(before - after), tl_v3_norm(tl_v3_sub(a, b)));
        if (error > ROUNDING * (t->scale[i] + tl_v3_norm(a)))
            tl_check_note(t->c, TL_LAW_STILL, "f_n goes from %g to %g N and f_s by %g N, without any motion", before,
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
            tl_vec3 n = tl_check_vec(rest.c[TL_AT_NORMAL], i);
            tl_check_put(rest.c[TL_AT_DU_S], i, tl_law_tangent(key, n, SMALL * t->law.slide));
        } else {
            rest.c[TL_AT_CLOSURE][i] += move;
            rest.c[TL_AT_EDGE][i] += move;
            rest.c[TL_AT_DU_N][i] = -move;
        }
    }
    if (!call_law(t, &rest, &out))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 slide = tl_check_vec(rest.c[TL_AT_DU_S], i);
        tl_vec3 change = tl_v3_sub(tl_check_vec(out.c[TL_AT_F_S], i), tl_check_vec(rest.c[TL_AT_F_S], i));
        double area = rest.c[TL_AT_AREA][i], closing = -rest.c[TL_AT_DU_N][i];
        double moved = along ? tl_v3_norm(slide) : fabs(closing);
        double rise = along ? -tl_v3_dot(change, slide) / (moved > 0 ? moved : 1)
                            : (out.c[TL_AT_F_N][i] - rest.c[TL_AT_F_N][i]) * (closing < 0 ? -1 : 1);
        double bound = along ? t->law.ks : t->law.kn;
        /* what falls: friction does at any rate, and a bond, which breaks or softens in the part that is apart; walls
         * that meet are where the closure says */
        bool falls =
            along ? tl_v3_norm(tl_check_vec(out.c[TL_AT_F_S], i)) < tl_v3_norm(tl_check_vec(rest.c[TL_AT_F_S], i))
                  : rest.c[TL_AT_APART][i] > 0;
        uint32_t changed = out.flags[i] ^ rest.flags[i];
        if (falls || changed & (TL_POINT_OPEN | TL_POINT_FAILED | TL_POINT_APART))
            continue;
        if (rise > bound * area * moved * (1 + SLACK) + ROUNDING * t->scale[i])
            tl_check_note(t->c, TL_LAW_STIFFNESS, "%s = %g Pa/m, but stiffness() says %g Pa/m", along ? "ks" : "kn",
                          rise / (area * moved), bound);
    }
}

/* ---------------------------------------------------------------- what goes with the area ---
 *
 * A point of twice the area, with the same stresses, carries twice the force and twice the energy. */

/* Tolerance: relative error that rounding may come to. Test: unit/test_check. */
#define ERROR 1e-8

/* How a column goes with the area. */
static double power_of(const trial *t, int column)
{
    if (column >= TL_AT_STATE)
        return t->law.extensive[column - TL_AT_STATE] ? 2 : 1;
    bool goes = column == TL_AT_AREA || column == TL_AT_F_N0 || column >= TL_AT_F_N;
    return goes ? 2 : 1;
}

/* Points whose states begin anew, where they do so when areas change; and their twins of twice the area. */
static void make_twins(const trial *t, tl_check_points *one, tl_check_points *two)
{
    const int last = TL_AT_STATE + (int)t->law.columns;
    *one = t->in;
    for (int k = TL_AT_STATE; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS && t->law.resets[k - TL_AT_STATE]; i++)
            one->c[k][i] = t->law.initial[k - TL_AT_STATE];
    *two = *one;
    for (int k = 0; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            two->c[k][i] *= power_of(t, k);
}

static void compare(trial *t, int column, size_t i, double one, double is)
{
    bool force = column < TL_AT_STORED, energy = column < TL_AT_STATE;
    double expected = power_of(t, column) * one;
    double scale = force ? t->scale[i] : energy ? t->scale[i] * t->law.closure : fabs(one);
    if (fabs(is - expected) > ERROR * (scale + fabs(expected)))
        tl_check_note(t->c, TL_LAW_AREA, "with twice the area and the same stresses %s is %g, not %g",
                      force    ? "a force"
                      : energy ? "an energy"
                               : "a state",
                      is, expected);
}

/* What goes with the area. */
static void check_area(trial *t)
{
    tl_check_points one, two, out_one, out_two;
    if (tl_check_failed(t->c, TL_LAW_AREA))
        return;
    make_twins(t, &one, &two);
    if (!call_law(t, &one, &out_one) || !call_law(t, &two, &out_two))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        for (int k = TL_AT_F_N; k < TL_AT_STATE + (int)t->law.columns; k++)
            if (k < TL_AT_STATE || !t->law.resets[k - TL_AT_STATE])
                compare(t, k, i, out_one.c[k][i], out_two.c[k][i]);
}

/* ---------------------------------------------------------------- what depends on what --- */

static void check_reads(trial *t)
{
    static const struct {
        uint32_t what;
        const char *text;
    } places[] = {{TL_OTHER_STATES, "a state that it does not declare"},
                  {TL_OTHER_BEHIND, "what lies behind the batch"},
                  {TL_OTHER_ENERGIES, "what the columns of energies held before, which are to be written"}};
    if (tl_check_failed(t->c, TL_LAW_READS))
        return;
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        tl_check_points out;
        if (!call_all(t, &t->in, &out, (tl_check_call){.other = places[k].what}))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            if (!same(&t->out, &out, i, true))
                tl_check_note(t->c, TL_LAW_READS, "what update() gives depends on %s", places[k].text);
    }
}

/* Where the next point's value of a state takes the place of each point's: what depends on it. */
static void see_state(trial *t, uint32_t first, uint32_t width)
{
    const uint32_t bits = ((1u << width) - 1) << first;
    tl_check_points in = t->in, out, a, b;
    tl_check_gaps gaps, others;
    bool moved[TL_CHECK_POINTS];
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        moved[i] = false;
        for (uint32_t k = first; k < first + width; k++) {
            const double *state = t->in.c[TL_AT_STATE + k];
            in.c[TL_AT_STATE + k][i] = width > 1 ? -0.5 * state[i] : state[(i + 1) % TL_CHECK_POINTS];
            moved[i] |= in.c[TL_AT_STATE + k][i] != state[i];
        }
    }
    if (!call_law(t, &in, &out))
        return;
    tl_law_gaps(&t->law, &t->in, &gaps);
    tl_law_gaps(&t->law, &in, &others);
    a = t->out;
    b = out;
    for (uint32_t k = first; k < first + width; k++) /* all but the state itself */
        memcpy(a.c[TL_AT_STATE + k], b.c[TL_AT_STATE + k], sizeof a.c[0]);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        if (!moved[i])
            continue;
        bool gap = gaps.lift[i] != others.lift[i] || gaps.hold[i] != others.hold[i];
        if (gap || !same(&a, &b, i, true))
            t->seen.read |= bits;
        if (!same(&t->out, &out, i, true))
            t->seen.kept |= bits;
    }
}

static void see_states(trial *t)
{
    uint32_t first = 0;
    if (is_stateless(&t->law))
        return;
    for (uint32_t i = 0; i < t->c->kind->state_count; i++) {
        uint32_t width = width_of(t->c->kind, i);
        if (!(t->seen.read >> first & 1))
            see_state(t, first, width);
        first += width;
    }
}

static void see_params(trial *t, tl_check_law varied[], const bool open[])
{
    for (uint32_t k = 0; k < t->c->kind->param_count && k < TL_CHECK_PARAMS; k++) {
        if (!open[k] || t->seen.matters[k])
            continue;
        tl_check_points out;
        tl_check_gaps gaps, others;
        tl_status status = tl_law_call_all(&varied[k], &t->in, &out);
        tl_law_gaps(&t->law, &t->out, &gaps);
        tl_law_gaps(&varied[k], &t->out, &others);
        bool other = status != TL_OK || memcmp(&gaps, &others, sizeof gaps) != 0;
        for (size_t i = 0; i < TL_CHECK_POINTS && !other; i++)
            other = !same(&t->out, &out, i, true);
        t->seen.matters[k] |= other;
    }
}

static void tell_unseen(tl_checker *c, const tl_check_seen *seen)
{
    const tl_kind *kind = c->kind;
    uint32_t column = 0;
    c->params_text[0] = '\0';
    for (uint32_t i = 0; i < kind->state_count; i++) {
        const tl_state *state = &kind->states[i];
        uint32_t width = width_of(kind, i), bits = (1u << width) - 1;
        if (!(seen->written >> column & bits))
            tl_check_note(c, TL_LAW_STATES,
                          "state '%s' is declared and was never written, with any of %d sets of parameters",
                          state->name, TL_CHECK_SETS);
        else if (!(seen->kept >> column & bits) && state->transfer != TL_TRANSFER_RESET)
            tl_check_note(c, TL_LAW_STATES,
                          "state '%s' is written and never read: nothing depends on what it was. Where that is meant, "
                          "declare it as TL_TRANSFER_RESET",
                          state->name);
        else if (!(seen->read >> column & bits) && state->transfer != TL_TRANSFER_RESET)
            tl_check_note(c, TL_LAW_STATES,
                          "state '%s' is written, but no force, energy, flag or other state depends on "
                          "it. Where that is meant, declare it as TL_TRANSFER_RESET",
                          state->name);
        column += width;
    }
    for (uint32_t k = 0; k < kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!seen->matters[k] && tl_check_asked(c, k))
            tl_check_note(c, TL_LAW_PARAMETERS,
                          "parameter '%s' has no effect: another value gives the same forces, energies, states and "
                          "stiffness with all of %d sets of parameters",
                          kind->params[k].name, TL_CHECK_SETS);
    if (seen->heats && !seen->slips)
        tl_check_note(c, TL_LAW_FLAGS, "shear is turned to heat, but no point is ever flagged as slipping");
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
        check_states(t);
        check_reads(t);
        check_area(t);
        see_states(t);
        see_params(t, varied, open);
        check_turned(t, step);
        check_still(t);
        check_stiffness(t, step, false);
        check_stiffness(t, step, true);
        t->now = t->out;
    }
    tl_law_check_paths(t);
}

/* Columns of the declared states. */
static void read_states(tl_check_law *law)
{
    for (uint32_t i = 0; i < law->kind->state_count; i++) {
        const tl_state *state = &law->kind->states[i];
        law->tangent[law->columns] = state->kind == TL_STATE_TANGENT;
        for (uint32_t k = 0; k < width_of(law->kind, i) && law->columns < TL_STATE_COLUMNS; k++) {
            law->extensive[law->columns] =
                state->transfer == TL_TRANSFER_SPLIT || state->transfer == TL_TRANSFER_ENERGY;
            law->resets[law->columns] = state->transfer == TL_TRANSFER_RESET;
            law->initial[law->columns++] = state->initial;
        }
    }
}

/* Makes the law with parameters of the kind's struct; not TL_OK when the law refuses them. */
static tl_status open_law(tl_checker *c, void *params, tl_check_law *law)
{
    const tl_law_ops *ops = c->kind->ops;
    *law = (tl_check_law){.kind = c->kind, .ops = ops};
    read_states(law);
    tl_status status = tl_check_create(c, ops->create, params, &law->self);
    if (status != TL_OK)
        return status;
    law->kn = law->ks = NAN;
    ops->stiffness(law->self, &law->kn, &law->ks);
    if (!(law->kn >= 0 && law->ks >= 0 && isfinite(law->kn) && isfinite(law->ks)))
        tl_check_note(c, TL_LAW_STIFFNESS, "stiffness() says kn = %g, ks = %g Pa/m: both must be finite and >= 0",
                      law->kn, law->ks);
    law->stress = tl_check_scale(tl_key(88, (uint64_t)c->set), 4, 6.5);
    double soft = law->kn > 0 && isfinite(law->kn) ? law->kn : 1e9;
    law->closure = law->stress / soft;
    law->slide = law->ks > 0 && isfinite(law->ks) ? law->stress / law->ks : law->closure;
    return TL_OK;
}

static void close_law(tl_check_law *law)
{
    if (law->ops->destroy)
        law->ops->destroy(law->self);
}

/* Laws that each have one parameter changed, of those whose effect has not been seen; and a trial with them. */
static tl_status try_varied(trial *t)
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
        if (t->seen.matters[k])
            continue;
        params[k] = malloc(c->kind->params_size + 1);
        if (!params[k])
            status = tl_fail_memory(c->error);
        else if (tl_check_params(c, c->set, (int)k, params[k], &held[k]) == TL_OK)
            open[k] = open_law(c, params[k], &varied[k]) == TL_OK;
        if (open[k] && (varied[k].kn != t->law.kn || varied[k].ks != t->law.ks))
            t->seen.matters[k] = true;
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

static tl_status try_set(tl_checker *c, void *params, void *user)
{
    trial *t = user;
    tl_status status = open_law(c, params, &t->law);
    if (status != TL_OK)
        return status;
    if (!tl_check_failed(c, TL_LAW_STIFFNESS) || isfinite(t->law.kn + t->law.ks))
        status = try_varied(t);
    if (status == TL_OK && !tl_check_failed(c, TL_LAW_RUNS) && !tl_check_failed(c, TL_LAW_STIFFNESS))
        status = tl_law_check_strengths(c, &t->law, params, open_law, close_law, &t->seen);
    close_law(&t->law);
    return status;
}

static tl_status check_kind(tl_checker *c)
{
    trial *t = calloc(1, sizeof *t);
    if (!t)
        return tl_fail_memory(c->error);
    t->c = c;
    tl_status status = tl_check_sets(c, try_set, t);
    if (status == TL_OK && !tl_check_failed(c, TL_LAW_RUNS))
        tell_unseen(c, &t->seen);
    if (status == TL_OK)
        tl_law_tell_strengths(c, &t->seen);
    free(t);
    return status;
}

const tl_check_type tl_check_laws = {rules, check_kind};
