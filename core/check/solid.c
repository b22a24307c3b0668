/* solid.c - the conformance check of solids.
 *
 * With each set of parameters 64 zones of random sizes and stresses go through random strains, small and large. Every
 * step is computed as a whole, in parts, zone by zone and turned in space; from the place it leads to, the zones are
 * strained a little for the moduli, and not at all. Work and energies are compared over a closed path of small strains,
 * there and back. A state is given another value, and a parameter another one of its range: the result must be another
 * one to the bit, with some set of parameters, for some zone of some step. Stresses are compared relative to those that
 * the zone has, or had on average. */
#include "check/solid.h"

#include "base/inside.h"
#include "base/solid_columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ZONES TL_CHECK_POINTS
/* Zones behind the batch that nobody may write to. */
#define GUARD TL_LANES
#define MOST (2 * ZONES + TL_LANES + GUARD)
/* Columns of a batch, and of states that are nobody's. */
#define COLUMNS (TL_ZONE_AT_COUNT + TL_SOLID_COLUMNS)
/* Steps of the random strains; of these the first, which are small. */
#define STEPS 24
#define GENTLE 4
/* Steps of a side of the closed path. */
#define SIDE 64
/* Constant: s, of a step. */
#define DT 1e-4
/* Tolerance: relative error of stresses that rounding explains, as a law's. Test: unit/test_check. */
#define ROUNDING 1e-11
/* Tolerance: change without strain, of a stress relative to the stresses, of a state to 1 and itself: axes are made of
 * unit length anew. Test: unit/test_check. */
#define UNCHANGED 1e-12
/* Tolerance: share by which a modulus may be exceeded: that of differences of stresses. */
#define SLACK 1e-6
/* Tolerance: work of a path in 192 steps that is neither stored nor heat, relative to its size: it falls with the step.
 * Test: unit/test_check. */
#define LOST 0.05
/* Tolerance: the same of zones that stay elastic: rounding. */
#define LOST_ELASTIC 1e-9

#define SOLID_RULES(RULE)                                                                                              \
    RULE(RUNS, "runs", "update() returns TL_OK, always when never_fails is set")                                       \
    RULE(REPEATS, "repeats", "the same call gives the same bits")                                                      \
    RULE(ALONE, "one by one", "a zone alone gets the bits that it gets in a batch")                                    \
    RULE(SPLIT, "split", "batches of other sizes and orders give the same bits")                                       \
    RULE(ENERGIES, "energies", "stresses do not depend on whether energies are asked for")                             \
    RULE(WRITES, "writes", "nothing is written but stresses, flags, energies and declared states")                     \
    RULE(READS, "reads", "nothing depends on states that are not declared, nor on what is to be written")              \
    RULE(FINITE, "finite", "stresses, states and energies are finite numbers")                                         \
    RULE(STILL, "no strain", "without strain stresses stay, unless a state changes; without time, too, no state does") \
    RULE(TURNED, "turned", "a turned zone gets the turned stresses, the same energies and states")                     \
    RULE(MODULI, "moduli", "stresses of a zone that stays elastic rise with its strain, as moduli() says at the most") \
    RULE(CYCLE, "closed cycle", "a closed path of small strains that stays elastic gives no energy")                   \
    RULE(BALANCE, "balance", "the work on a path is stored or turned to heat")                                         \
    RULE(HEAT, "heat", "dissipated is not negative, and 0 where nothing yields")                                       \
    RULE(STORED, "stored", "energy() tells what update() tells as stored")                                             \
    RULE(FLAGS, "flags", "what has yielded is flagged as yielded in the past ever after")                              \
    RULE(STATES, "states", "each declared state is written and read")                                                  \
    RULE(PARAMETERS, "parameters", "each parameter has an effect")
#define RULE_NUMBER(number, name, doc) number,
enum { SOLID_RULES(RULE_NUMBER) };
#define RULE_ROW(number, name, doc) [number] = {name, doc},
static const tl_check_rule rules[] = {SOLID_RULES(RULE_ROW){NULL, NULL}};

/* Flags of this step, and of the past. */
#define NOW (TL_ZONE_SHEAR | TL_ZONE_TENSION | TL_ZONE_JOINT)
#define PAST (TL_ZONE_SHEAR_PAST | TL_ZONE_TENSION_PAST | TL_ZONE_JOINT_PAST)

typedef struct zones {
    double c[TL_ZONE_AT_COUNT][ZONES];
    uint32_t flags[ZONES];
} zones;

typedef struct buffer {
    _Alignas(TL_ALIGN) double c[COLUMNS][MOST];
    _Alignas(TL_ALIGN) uint32_t flags[MOST];
} buffer;

typedef struct trial {
    tl_checker *c;
    const tl_solid_ops *ops;
    void *self;
    uint32_t columns;
    bool has_axis;
    double initial[TL_SOLID_COLUMNS];
    double constrained, shear; /* Pa, of moduli() */
    double stress;             /* Pa, of which the strains are */
    zones now, in, out;
    double scale[ZONES];    /* Pa, of a zone's stresses */
    bool other, no_energy;  /* what is nobody's holds other numbers than usually; energies are not asked for */
    bool stands;            /* no time passes */
    uint32_t written, read; /* bit k: state column k has been */
    bool matters[TL_CHECK_PARAMS];
} trial;

static uint64_t key_of(const trial *t, uint64_t step, uint64_t zone)
{
    return tl_key(tl_key(tl_key(2006, (uint64_t)t->c->set), step), zone);
}

static void get6(const zones *z, int column, size_t i, double out[6])
{
    for (int k = 0; k < 6; k++)
        out[k] = z->c[column + k][i];
}

static void put6(zones *z, int column, size_t i, const double in[6])
{
    for (int k = 0; k < 6; k++)
        z->c[column + k][i] = in[k];
}

static double size6(const double s[6])
{
    return sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/* A random tensor of the size 1. */
static void any6(uint64_t key, double out[6])
{
    for (int k = 0; k < 6; k++)
        out[k] = tl_check_between(tl_key(key, (uint64_t)k), -1, 1);
    double size = size6(out);
    for (int k = 0; k < 6; k++)
        out[k] /= size > 0 ? size : 1;
}

/* ---------------------------------------------------------------- zones ------------------ */

static void begin_zones(trial *t)
{
    zones *z = &t->now;
    memset(z, 0, sizeof *z);
    t->stress = tl_check_scale(key_of(t, 0, ZONES), 4, 7);
    for (size_t i = 0; i < ZONES; i++) {
        uint64_t key = key_of(t, 0, i);
        double s[6], mean = -t->stress * tl_check_between(tl_key(key, 7), 0, 2);
        z->c[TL_ZONE_AT_VOLUME][i] = tl_check_scale(tl_key(key, 1), -3, 3);
        z->c[TL_ZONE_AT_EXTENT][i] = tl_check_scale(tl_key(key, 2), -1, 1);
        any6(tl_key(key, 3), s);
        for (int k = 0; k < 6; k++)
            s[k] = i % 8 == 5 ? 0 : 0.3 * t->stress * s[k] + (k < 3 ? mean : 0);
        put6(z, TL_ZONE_AT_STRESS, i, s);
        for (uint32_t k = 0; k < t->columns; k++)
            z->c[TL_ZONE_AT_STATE + k][i] = t->initial[k];
        t->scale[i] = t->stress;
    }
}

/* The next strain of all zones, of which one in five has none. */
static void next_strain(trial *t, int step)
{
    t->in = t->now;
    for (size_t i = 0; i < ZONES; i++) {
        uint64_t key = key_of(t, (uint64_t)step + 1, i);
        bool rests = step == 0 || tl_uniform(tl_key(key, 8)) < 0.2;
        double d[6], size = (step < GENTLE ? 0.02 : 1) * tl_check_scale(tl_key(key, 9), -1.5, 0.7);
        any6(key, d);
        for (int k = 0; k < 6; k++) /* some along the axes */
            d[k] = rests || (i % 16 == 6 && k != (int)(i / 16)) ? 0 : size * t->stress / t->constrained * d[k];
        put6(&t->in, TL_ZONE_AT_STRAIN, i, d);
    }
}

/* ---------------------------------------------------------------- one call --------------- */

/* How many entries of columns are filled and looked at, for a batch of so many padded zones. Of a whole batch all that
 * there are. */
static size_t end_of(size_t padded)
{
    return padded < ZONES ? padded + GUARD : MOST;
}

static void fill(const trial *t, const zones *in, const tl_check_batch *of, buffer *b)
{
    for (int k = 0; k < COLUMNS; k++) {
        const int state = k - TL_ZONE_AT_STATE;
        const bool own = state < (int)t->columns && k != TL_ZONE_AT_STORED && k != TL_ZONE_AT_DISSIPATED;
        const double padding = state >= 0 && own ? t->initial[state] : k == TL_ZONE_AT_EXTENT ? 1 : 0;
        tl_check_fill(of, b->c[k], own ? in->c[k] : NULL, padding, tl_check_nobodys(k, t->other));
    }
    for (size_t l = 0; l < of->end; l++)
        b->flags[l] = l < of->count ? in->flags[tl_check_entry(of, l)] : 0;
}

/* Sees to it that nothing has been written that is not the solid's. */
static void check_writes(trial *t, const buffer *now, const buffer *before, size_t padded)
{
    const size_t end = end_of(padded);
    for (int k = 0; k < COLUMNS; k++) {
        bool states = k >= TL_ZONE_AT_STATE + (int)t->columns, given = k < TL_ZONE_AT_STRESS;
        size_t from = states || given ? 0 : padded;
        if (memcmp(now->c[k] + from, before->c[k] + from, (end - from) * sizeof now->c[k][0]) != 0)
            tl_check_note(t->c, WRITES, "update() writes to %s",
                          given    ? "a column of what it is given"
                          : states ? "a state that the solid does not declare"
                                   : "what lies behind the batch");
    }
    if (memcmp(now->flags + padded, before->flags + padded, (end - padded) * sizeof now->flags[0]) != 0)
        tl_check_note(t->c, WRITES, "update() writes to flags behind the batch");
}

/* Calls the solid on some zones, as the host would. */
static bool call_some(trial *t, const zones *in, zones *out, const size_t *order, size_t begin, size_t count)
{
    buffer now, before;
    double *state[2 * TL_SOLID_COLUMNS];
    size_t padded = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    const tl_check_batch of = {order, begin, count, padded, end_of(padded)};
    fill(t, in, &of, &now);
    for (int k = 0; k < COLUMNS; k++)
        memcpy(before.c[k], now.c[k], of.end * sizeof now.c[k][0]);
    memcpy(before.flags, now.flags, of.end * sizeof now.flags[0]);
    tl_solid_batch batch = tl_solid_batch_of(now.c[0], MOST, now.flags, state, 2 * TL_SOLID_COLUMNS);
    batch.count = (uint32_t)padded;
    batch.dt = t->stands ? 0 : DT;
    if (t->no_energy)
        batch.stored = batch.dissipated = NULL;
    tl_report report = {.size = sizeof report};
    tl_enter(t->c->kind, "update");
    tl_status status = t->ops->update(t->self, &batch, &report);
    tl_leave();
    if (status != TL_OK)
        tl_check_note(t->c, RUNS, "update() fails%s: %s", t->ops->never_fails ? ", though never_fails is set" : "",
                      tl_report_text(&report, status));
    check_writes(t, &now, &before, padded);
    for (size_t l = 0; l < count; l++) {
        const size_t i = tl_check_entry(&of, l);
        for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STATE + (int)t->columns; k++)
            out->c[k][i] = now.c[k][l];
        out->flags[i] = now.flags[l];
    }
    return status == TL_OK;
}

/* The same on all zones, in one batch. */
static bool call_all(trial *t, const zones *in, zones *out)
{
    *out = *in;
    return call_some(t, in, out, NULL, 0, ZONES);
}

static bool call_parts(trial *t, zones *out, const size_t *order, const size_t *parts, size_t most)
{
    size_t begin = 0;
    for (size_t k = 0; begin < ZONES; begin += parts[k++ % most])
        if (!call_some(t, &t->in, out, order, begin, parts[k % most]))
            return false;
    return true;
}

/* Whether two calls gave the zone the same, to the bit. */
static bool same(const trial *t, const zones *a, const zones *b, size_t i, bool energies)
{
    for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STATE + (int)t->columns; k++)
        if ((energies || (k != TL_ZONE_AT_STORED && k != TL_ZONE_AT_DISSIPATED)) &&
            memcmp(&a->c[k][i], &b->c[k][i], sizeof a->c[k][i]) != 0)
            return false;
    return a->flags[i] == b->flags[i];
}

/* What a solid gives in a column. */
static const char *column_name(const trial *t, int column)
{
    static const char *const names[] = {"stress xx", "stress yy", "stress zz", "stress xy",
                                        "stress yz", "stress zx", "stored",    "dissipated"};
    int at = TL_ZONE_AT_STATE;
    if (column < at)
        return names[column - TL_ZONE_AT_STRESS];
    for (uint32_t k = 0; k < t->c->kind->state_count; k++) {
        at += (int)tl_state_width(t->c->kind->states[k].kind);
        if (column < at)
            return t->c->kind->states[k].name;
    }
    return "flags";
}

/* Tells the first thing that two calls gave a zone otherwise. */
static void compare(trial *t, int check, const zones *other, bool energies, const char *how)
{
    for (size_t i = 0; i < ZONES; i++) {
        if (same(t, &t->out, other, i, energies))
            continue;
        const int end = TL_ZONE_AT_STATE + (int)t->columns;
        int k = TL_ZONE_AT_STRESS;
        while (k < end && ((!energies && (k == TL_ZONE_AT_STORED || k == TL_ZONE_AT_DISSIPATED)) ||
                           memcmp(&t->out.c[k][i], &other->c[k][i], sizeof(double)) == 0))
            k++;
        const double is = k < end ? t->out.c[k][i] : t->out.flags[i], was = k < end ? other->c[k][i] : other->flags[i];
        tl_check_note(t->c, check, "%s is %.17g in a batch of 64 zones, and %.17g %s", column_name(t, k), is, was, how);
        return;
    }
}

/* The step as a whole, again, zone by zone, in parts of another order, without energies. */
static bool compare_batches(trial *t, int step)
{
    static const size_t one[] = {1}, parts[] = {8, 3, 40, 13};
    zones other = t->in;
    size_t order[ZONES], twice[2 * ZONES + TL_LANES];
    for (size_t i = 0; i < 2 * ZONES + TL_LANES; i++)
        twice[i] = (i + i / ZONES * 5) % ZONES;
    for (size_t i = 0; i < ZONES; i++)
        order[i] = (i * 37 + (size_t)step) % ZONES;
    if (!call_all(t, &t->in, &t->out))
        return false;
    if (call_parts(t, &other, NULL, one, 1))
        compare(t, ALONE, &other, true, "alone");
    if (call_parts(t, &other, order, parts, sizeof parts / sizeof *parts))
        compare(t, SPLIT, &other, true, "in batches of 8, 3, 40 and 13 in another order");
    if (call_some(t, &t->in, &other, twice, 0, 2 * ZONES + TL_LANES))
        compare(t, SPLIT, &other, true, "in the second half of a batch of 136");
    if (call_all(t, &t->in, &other))
        compare(t, REPEATS, &other, true, "when called again");
    t->no_energy = true;
    if (call_all(t, &t->in, &other))
        compare(t, ENERGIES, &other, false, "without energies");
    t->no_energy = false;
    t->other = true;
    if (call_all(t, &t->in, &other))
        compare(t, READS, &other, true, "with other numbers in what is nobody's");
    t->other = false;
    return true;
}

/* ---------------------------------------------------------------- what a step gives ------ */

static void check_numbers(trial *t)
{
    for (size_t i = 0; i < ZONES; i++) {
        double heat = t->out.c[TL_ZONE_AT_DISSIPATED][i];
        uint32_t was = t->in.flags[i], is = t->out.flags[i], past = was & PAST;
        past |= (was & (TL_ZONE_SHEAR | TL_ZONE_TENSION)) << 2 | (was & TL_ZONE_JOINT) << 1;
        for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STATE + (int)t->columns; k++)
            if (!isfinite(t->out.c[k][i]))
                tl_check_note(t->c, FINITE, "%s is %g",
                              k < TL_ZONE_AT_STORED  ? "a stress"
                              : k < TL_ZONE_AT_STATE ? "an energy"
                                                     : "a state",
                              t->out.c[k][i]);
        if (!(heat >= 0))
            tl_check_note(t->c, HEAT, "dissipated = %g J/m3", heat);
        if (heat > ROUNDING * t->scale[i] * t->scale[i] / t->shear && !(is & NOW))
            tl_check_note(t->c, HEAT, "dissipated = %g J/m3 in a zone whose flags, %u, tell of no yielding", heat, is);
        if ((is & past) != past)
            tl_check_note(t->c, FLAGS, "a zone with the flags %u has %u a step later, where %u must be among them", was,
                          is, past);
        for (uint32_t k = 0; k < t->columns; k++)
            if (memcmp(&t->out.c[TL_ZONE_AT_STATE + k][i], &t->in.c[TL_ZONE_AT_STATE + k][i], sizeof(double)) != 0)
                t->written |= 1u << k;
    }
}

/* The largest difference of stresses of a zone. */
static double apart(const zones *a, const zones *b, size_t i)
{
    double most = 0;
    for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STORED; k++)
        most = fmax(most, fabs(a->c[k][i] - b->c[k][i]));
    return most;
}

static bool states_differ(const trial *t, const zones *a, const zones *b, size_t i)
{
    for (uint32_t k = 0; k < t->columns; k++)
        if (memcmp(&a->c[TL_ZONE_AT_STATE + k][i], &b->c[TL_ZONE_AT_STATE + k][i], sizeof(double)) != 0)
            return true;
    return false;
}

static void clear_strains(zones *z)
{
    for (int k = 0; k < 6; k++)
        memset(z->c[TL_ZONE_AT_STRAIN + k], 0, sizeof z->c[0]);
}

static bool states_move(const trial *t, const zones *a, const zones *b, size_t i)
{
    for (int k = TL_ZONE_AT_STATE; k < TL_ZONE_AT_STATE + (int)t->columns; k++)
        if (fabs(b->c[k][i] - a->c[k][i]) > UNCHANGED * (1 + fabs(a->c[k][i])))
            return true;
    return false;
}

/* From the end of a step, one without strain, and one without time as well. */
static void check_still(trial *t)
{
    zones in = t->out, out;
    clear_strains(&in);
    t->stands = true;
    const bool stood = call_all(t, &in, &out);
    t->stands = false;
    for (size_t i = 0; stood && i < ZONES; i++)
        if (!(out.flags[i] & NOW) && states_move(t, &in, &out, i))
            tl_check_note(t->c, STILL,
                          "without strain and time (dt = 0) a state of a zone that does not yield changes: it would "
                          "depend on how many steps are made");
    if (!stood || !call_all(t, &in, &out))
        return;
    for (size_t i = 0; i < ZONES; i++) {
        double off = apart(&in, &out, i);
        if (off > UNCHANGED * t->scale[i] && !states_differ(t, &in, &out, i))
            tl_check_note(t->c, STILL, "without strain the stress changes by %g Pa, of some %g, and no state does", off,
                          t->scale[i]);
    }
}

/* A tensor in the axes that a rotation leads to. */
static void turn6(const tl_mat3 *r, const double in[6], double out[6])
{
    tl_sym3 s = tl_s3_turn((tl_sym3){in[0], in[1], in[2], in[3], in[4], in[5]}, r);
    const double parts[6] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
    memcpy(out, parts, sizeof parts);
}

/* Turns all that is a direction or a tensor. */
static void turn_zone(const trial *t, const tl_mat3 *r, zones *z, size_t i)
{
    double s[6];
    int column = TL_ZONE_AT_STATE;
    for (int k = TL_ZONE_AT_STRAIN; k < TL_ZONE_AT_STORED; k += 6) {
        get6(z, k, i, s);
        turn6(r, s, s);
        put6(z, k, i, s);
    }
    for (uint32_t k = 0; k < t->c->kind->state_count; k++) {
        const uint32_t kind = t->c->kind->states[k].kind;
        if (kind == TL_STATE_AXIS)
            tl_check_put(z->c[column], i, tl_m3_mul(r, tl_check_vec(z->c[column], i)));
        if (kind == TL_STATE_TENSOR) {
            get6(z, column, i, s);
            turn6(r, s, s);
            put6(z, column, i, s);
        }
        column += (int)tl_state_width(kind);
    }
}

static void check_turned(trial *t, int step)
{
    zones in = t->in, wanted = t->out, out;
    if (t->has_axis && step == 0) /* the parameters' axis does not turn */
        return;
    for (size_t i = 0; i < ZONES; i++) {
        uint64_t key = tl_key(key_of(t, (uint64_t)step, i), 77);
        tl_vec3 axis = tl_check_direction(key);
        double half = tl_check_between(tl_key(key, 1), 0, 3.1);
        tl_vec3 v = tl_v3_scale(tl_sin(half), axis);
        tl_mat3 r = tl_q_matrix(tl_q_unit((tl_quat){tl_cos(half), v.x, v.y, v.z}));
        turn_zone(t, &r, &in, i);
        turn_zone(t, &r, &wanted, i);
    }
    if (!call_all(t, &in, &out))
        return;
    for (size_t i = 0; i < ZONES; i++) {
        double off = apart(&wanted, &out, i), strain[6];
        get6(&in, TL_ZONE_AT_STRAIN, i, strain);
        double scale = t->scale[i] + t->constrained * size6(strain), energy = scale * scale / t->shear;
        if (off > 1e3 * ROUNDING * scale)
            tl_check_note(t->c, TURNED, "the stress of a turned zone is off the turned one by %g Pa, of some %g", off,
                          scale);
        for (int k = TL_ZONE_AT_STORED; k <= TL_ZONE_AT_DISSIPATED; k++)
            if (fabs(wanted.c[k][i] - out.c[k][i]) > 1e3 * ROUNDING * energy)
                tl_check_note(t->c, TURNED, "%s is %g J/m3, and %g of the turned zone",
                              k == TL_ZONE_AT_STORED ? "stored" : "dissipated", wanted.c[k][i], out.c[k][i]);
    }
}

/* From the end of a step, a little stretching n n along a line, and a little shear (n m + m n) / 2 of two. What the
 * stress has of it, n.s.n and n.s.m, is the modulus times its size. */
static void check_moduli(trial *t, int step)
{
    for (int shear = 0; shear < 2; shear++) {
        zones rest = t->out, in, a, b;
        double part[ZONES][6];
        clear_strains(&rest);
        in = rest;
        for (size_t i = 0; i < ZONES; i++) {
            uint64_t key = tl_key(key_of(t, (uint64_t)step, i), 99);
            tl_vec3 n = tl_check_direction(key), m = n;
            if (shear)
                m = tl_v3_perpendicular(n);
            const double p[6] = {n.x * m.x,
                                 n.y * m.y,
                                 n.z * m.z,
                                 0.5 * (n.x * m.y + n.y * m.x),
                                 0.5 * (n.y * m.z + n.z * m.y),
                                 0.5 * (n.z * m.x + n.x * m.z)};
            double d[6];
            for (int k = 0; k < 6; k++) {
                part[i][k] = p[k];
                d[k] = p[k] * 1e-4 * t->scale[i] / t->constrained;
            }
            put6(&in, TL_ZONE_AT_STRAIN, i, d);
        }
        if (!call_all(t, &rest, &a) || !call_all(t, &in, &b))
            return;
        for (size_t i = 0; i < ZONES; i++) {
            double strain = 1e-4 * t->scale[i] / t->constrained, stress = 0;
            for (int k = 0; k < 6; k++)
                stress +=
                    (k < 3 ? 1 : 2) * part[i][k] * (b.c[TL_ZONE_AT_STRESS + k][i] - a.c[TL_ZONE_AT_STRESS + k][i]);
            double stiff = stress / strain, most = shear ? t->shear : t->constrained;
            const char *which = shear ? "shear" : "constrained";
            if ((a.flags[i] | b.flags[i]) & NOW)
                continue;
            if (stiff > most * (1 + SLACK))
                tl_check_note(t->c, MODULI, "a zone has the %s modulus %g Pa, but moduli() says %g", which, stiff,
                              most);
            if (stiff < -most * SLACK)
                tl_check_note(t->c, MODULI,
                              "a zone has the %s modulus %g Pa: its stress falls where the strain grows; both are "
                              "positive in tension",
                              which, stiff);
        }
    }
}

static void check_stored(trial *t)
{
    double told[ZONES];
    const double *stress[6];
    double *state[TL_SOLID_COLUMNS];
    zones z = t->out;
    if (!t->ops->energy)
        return;
    for (int k = 0; k < 6; k++)
        stress[k] = z.c[TL_ZONE_AT_STRESS + k];
    for (int k = 0; k < TL_SOLID_COLUMNS; k++)
        state[k] = z.c[TL_ZONE_AT_STATE + k];
    tl_enter(t->c->kind, "energy");
    t->ops->energy(t->self, ZONES, stress, state, told);
    tl_leave();
    for (size_t i = 0; i < ZONES; i++)
        if (fabs(told[i] - z.c[TL_ZONE_AT_STORED][i]) > ROUNDING * t->scale[i] * t->scale[i] / t->shear)
            tl_check_note(t->c, STORED, "energy() tells %g J/m3, which is %g more than update() has told", told[i],
                          told[i] - z.c[TL_ZONE_AT_STORED][i]);
}

/* ---------------------------------------------------------------- paths ------------------ */

/* What came of a path, for each zone, J/m3. */
typedef struct ledger {
    double work[ZONES], heat[ZONES], began[ZONES], size[ZONES];
    bool yielded[ZONES];
} ledger;

/* Walks a triangle of strains in small steps, from the present place, and back to where it began. */
static bool walk(trial *t, zones *z, double reach, ledger *l)
{
    zones next;
    memset(l, 0, sizeof *l);
    clear_strains(z);
    if (!call_all(t, z, &next))
        return false;
    *z = next;
    memcpy(l->began, z->c[TL_ZONE_AT_STORED], sizeof l->began);
    for (int step = 0; step < 3 * SIDE; step++) {
        for (size_t i = 0; i < ZONES; i++) {
            double a[6], b[6], d[6];
            any6(tl_key(key_of(t, 50, i), 1), a);
            any6(tl_key(key_of(t, 50, i), 2), b);
            for (int k = 0; k < 6; k++) {
                double sides[3] = {a[k], b[k], -(a[k] + b[k])};
                d[k] = reach * t->scale[i] / t->constrained / SIDE * sides[step / SIDE];
            }
            put6(z, TL_ZONE_AT_STRAIN, i, d);
        }
        if (!call_all(t, z, &next))
            return false;
        for (size_t i = 0; i < ZONES; i++) {
            double work = 0;
            for (int k = 0; k < 6; k++)
                work += (k < 3 ? 0.5 : 1) * z->c[TL_ZONE_AT_STRAIN + k][i] *
                        (z->c[TL_ZONE_AT_STRESS + k][i] + next.c[TL_ZONE_AT_STRESS + k][i]);
            l->work[i] += work;
            l->size[i] += fabs(work);
            l->heat[i] += next.c[TL_ZONE_AT_DISSIPATED][i];
            l->yielded[i] |= (next.flags[i] & NOW) != 0;
        }
        *z = next;
    }
    return true;
}

static void check_paths(trial *t)
{
    static const double reaches[] = {0.01, 3};
    for (size_t n = 0; n < sizeof reaches / sizeof *reaches; n++) {
        zones z = t->out;
        ledger l;
        if (!walk(t, &z, reaches[n], &l))
            return;
        for (size_t i = 0; i < ZONES; i++) {
            double stored = z.c[TL_ZONE_AT_STORED][i] - l.began[i], off = l.work[i] - stored - l.heat[i];
            double size = l.size[i] + l.heat[i] + fabs(stored);
            double floor = LOST_ELASTIC * (size + t->scale[i] * t->scale[i] / t->shear * reaches[n]);
            if (!l.yielded[i] && fabs(l.work[i]) > floor)
                tl_check_note(t->c, CYCLE,
                              "a closed path of strains gives %g J/m3, of %g, in a zone that stays elastic", -l.work[i],
                              l.size[i]);
            if (fabs(off) > (l.yielded[i] ? LOST * size : 0) + floor)
                tl_check_note(t->c, BALANCE,
                              "of the work of %g J/m3 on a path, %g is stored and %g heat: %g is neither, of %g",
                              l.work[i], stored, l.heat[i], off, size);
        }
    }
}

/* ---------------------------------------------------------------- states, parameters ----- */

/* Whether something that a solid gives for the zones differs from what it has given. The state column `except` does not
 * count. */
static bool gives_other(trial *t, const zones *in, int except)
{
    zones out;
    if (!call_all(t, in, &out))
        return false;
    for (size_t i = 0; i < ZONES; i++) {
        if (out.flags[i] != t->out.flags[i])
            return true;
        for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STATE + (int)t->columns; k++)
            if (k != except && memcmp(&out.c[k][i], &t->out.c[k][i], sizeof out.c[k][i]) != 0)
                return true;
    }
    return false;
}

static void see_states(trial *t)
{
    for (uint32_t k = 0; k < t->columns; k++) {
        zones in = t->in;
        int column = TL_ZONE_AT_STATE + (int)k;
        if (t->read >> k & 1)
            continue;
        for (size_t i = 0; i < ZONES; i++)
            in.c[column][i] = 1.5 * in.c[column][i] + 0.25;
        t->read |= gives_other(t, &in, column) ? 1u << k : 0;
    }
}

/* The same step of a solid with another value of one parameter. */
static void see_param(trial *t, uint32_t k, void *params)
{
    void *held = NULL, *own = t->self;
    char text[sizeof t->c->params_text];
    memcpy(text, t->c->params_text, sizeof text);
    if (tl_check_params(t->c, t->c->set, (int)k, params, &held) == TL_OK &&
        tl_check_create(t->c, t->ops->create, params, &t->self) == TL_OK) {
        t->matters[k] = gives_other(t, &t->in, TL_CHECK_NONE);
        if (t->ops->destroy)
            t->ops->destroy(t->self);
    }
    t->self = own;
    memcpy(t->c->params_text, text, sizeof text);
    free(held);
}

static void see_params(trial *t)
{
    void *params = malloc(t->c->kind->params_size + 1);
    for (uint32_t k = 0; params && k < t->c->kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!t->matters[k])
            see_param(t, k, params);
    free(params);
}

/* ---------------------------------------------------------------- all of it -------------- */

static void run_trial(trial *t)
{
    begin_zones(t);
    for (int step = 0; step < STEPS; step++) {
        next_strain(t, step);
        if (!compare_batches(t, step))
            return;
        for (size_t i = 0; i < ZONES; i++) {
            double s[6];
            get6(&t->out, TL_ZONE_AT_STRESS, i, s);
            t->scale[i] = fmax(0.5 * (t->scale[i] + size6(s)), t->scale[i] * 0.9);
        }
        check_numbers(t);
        check_turned(t, step);
        check_still(t);
        check_moduli(t, step);
        check_stored(t);
        if (step % 8 == 3)
            check_paths(t);
        see_states(t);
        see_params(t);
        t->now = t->out;
    }
}

static void tell_unseen(const trial *t)
{
    tl_checker *c = t->c;
    uint32_t column = 0;
    c->params_text[0] = '\0';
    for (uint32_t k = 0; k < c->kind->state_count; k++) {
        const tl_state *state = &c->kind->states[k];
        uint32_t width = tl_state_width(state->kind), bits = ((1u << width) - 1) << column;
        if (!(t->written & bits))
            tl_check_note(c, STATES, "state '%s' is declared and was never written", state->name);
        else if (!(t->read & bits))
            tl_check_note(c, STATES, "state '%s' is written and never read: nothing depends on it", state->name);
        column += width;
    }
    for (uint32_t k = 0; k < c->kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!t->matters[k] && tl_check_asked(c, k))
            tl_check_note(c, PARAMETERS,
                          "parameter '%s' has no effect: another value gives the same stresses and states with all of "
                          "%d sets of parameters",
                          c->kind->params[k].name, TL_CHECK_SETS);
}

static tl_status try_set(tl_checker *c, void *params, void *user)
{
    trial *t = user;
    tl_status status = tl_check_create(c, t->ops->create, params, &t->self);
    if (status != TL_OK)
        return status;
    tl_enter(c->kind, "moduli");
    t->ops->moduli(t->self, &t->constrained, &t->shear);
    tl_leave();
    bool fits = t->constrained > 0 && t->shear > 0 && isfinite(t->constrained) && isfinite(t->shear);
    if (!fits)
        tl_check_note(c, MODULI, "moduli() gives %g and %g Pa, which must be finite and above 0", t->constrained,
                      t->shear);
    else
        run_trial(t);
    if (t->ops->destroy)
        t->ops->destroy(t->self);
    return TL_OK;
}

static tl_status check_kind(tl_checker *c)
{
    trial *t = calloc(1, sizeof *t);
    if (!t)
        return tl_fail_memory(c->error);
    t->c = c;
    t->ops = c->kind->ops;
    for (uint32_t k = 0; k < c->kind->state_count; k++) {
        const tl_state *state = &c->kind->states[k];
        t->has_axis = t->has_axis || state->kind == TL_STATE_AXIS;
        for (uint32_t width = tl_state_width(state->kind); width > 0; width--)
            t->initial[t->columns++] = state->initial;
    }
    tl_status status = tl_check_sets(c, try_set, t);
    if (status == TL_OK && !tl_check_failed(c, RUNS))
        tell_unseen(t);
    free(t);
    return status;
}

const tl_check_type tl_check_solids = {rules, check_kind};
