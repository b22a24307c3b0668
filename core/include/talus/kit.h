/* kit.h - what contact laws, dampings, generators and solids have in common, for whoever writes one.
 *
 * A plugin can do without: everything here is made of what plugin.h declares. Functions over columns take `lanes`
 * points from `begin` on; a loop with a constant number of them is vectorised best. */
#ifndef TALUS_KIT_H
#define TALUS_KIT_H

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/number.h>
#include <talus/plugin.h>
#include <talus/vmath.h>

/* rad */
#define TL_DEGREE (3.14159265358979323846 / 180)

/* Before a function that a loop over columns calls: it becomes part of the loop, in each of the forms that
 * TL_VECTORIZED makes of it. */
#if defined(__GNUC__)
#define TL_IN_LOOP static inline __attribute__((always_inline))
#else
#define TL_IN_LOOP static inline
#endif

/* Before a loop whose passes do not depend on each other. Compilers know of it with -fopenmp-simd. */
#if defined(__cplusplus)
#define TL_EACH_ALONE
#else
#define TL_EACH_ALONE _Pragma("omp simd")
#endif
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#endif

/* ---------------------------------------------------------------- parameters ------------- */

/* Rows of the table of parameters of a struct `owner`: reals of the unit `unit`. The sentence follows, and what else a
 * tl_param has.
 *
 *     TL_PARAM_POSITIVE(params, distance, "m", "slip over which the friction falls", .alias = "dc"),
 *
 * > 0, and must be given. */
#define TL_PARAM_POSITIVE(owner, member, unit, ...)                                                                    \
    TL_PARAM(TL_PARAM_REAL, owner, member, unit, __VA_ARGS__, .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN,          \
             .min = 0, .max = INFINITY)
/* > 0, and NaN where it is not given. */
#define TL_PARAM_POSITIVE_OR_NONE(owner, member, unit, ...)                                                            \
    TL_PARAM(TL_PARAM_REAL, owner, member, unit, __VA_ARGS__, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN,          \
             .min = 0, .max = INFINITY)
/* >= 0, and 0 where it is not given. */
#define TL_PARAM_NOT_NEGATIVE(owner, member, unit, ...)                                                                \
    TL_PARAM(TL_PARAM_REAL, owner, member, unit, __VA_ARGS__, .min = 0, .max = INFINITY)
/* An angle in [0, 90) deg. `more`: TL_PARAM_REQUIRED or the like, or 0. */
#define TL_PARAM_ANGLE(owner, member, more, ...)                                                                       \
    TL_PARAM(TL_PARAM_REAL, owner, member, "deg", __VA_ARGS__, .flags = TL_PARAM_MAX_OPEN | (more), .min = 0, .max = 90)
/* An angle of friction in [0, 90] deg, a strength. That of 90 has the tangent 1.6e16: nothing slips while it is
 * pressed. */
#define TL_PARAM_FRICTION(owner, member, more, ...)                                                                    \
    TL_PARAM(TL_PARAM_REAL, owner, member, "deg", __VA_ARGS__, .flags = TL_PARAM_STRENGTH_ANGLE | (more), .min = 0,    \
             .max = 90)
/* A strength, >= 0, and 0 where it is not given. */
#define TL_PARAM_STRONG(owner, member, unit, ...)                                                                      \
    TL_PARAM(TL_PARAM_REAL, owner, member, unit, __VA_ARGS__, .flags = TL_PARAM_STRENGTH, .min = 0, .max = INFINITY)

/* ---------------------------------------------------------------- create ----------------- */

/* Puts a sentence into the report of a `create` that refuses its parameters, and gives TL_E_ARGUMENT. */
static inline TL_PRINTF(2, 3) tl_status tl_refuse(tl_report *report, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(report->text, sizeof report->text, format, arguments);
    va_end(arguments);
    return TL_E_ARGUMENT;
}

/* The end of a `create`: *self is a copy of `size` bytes, which C's `free` destroys. */
static inline tl_status tl_keep(const void *made, size_t size, void **self, tl_report *report)
{
    void *copy = malloc(size);
    if (!copy) {
        snprintf(report->text, sizeof report->text, "out of memory");
        return TL_E_MEMORY;
    }
    memcpy(copy, made, size);
    *self = copy;
    return TL_OK;
}

/* A list that grows: `items`, or where they have moved to, with room for `needed` of `each` bytes. NULL without memory,
 * and then they are where they were. */
static inline void *tl_grown(void *items, size_t *capacity, size_t needed, size_t each)
{
    if (needed <= *capacity)
        return items;
    size_t more = *capacity ? 2 * *capacity : 64;
    more = more < needed ? needed : more;
    void *moved = realloc(items, more * each);
    *capacity = moved ? more : *capacity;
    return moved;
}

/* ---------------------------------------------------------------- joint laws ------------- */

/* A row of the table of parameters of a struct `owner`: a stiffness, > 0. `more`: TL_PARAM_REQUIRED or
 * TL_PARAM_OPTIONAL. */
#define TL_PARAM_STIFF(owner, member, unit, more, ...)                                                                 \
    TL_PARAM(TL_PARAM_REAL, owner, member, unit, __VA_ARGS__,                                                          \
             .flags = TL_PARAM_STIFFNESS | TL_PARAM_MIN_OPEN | (more), .min = 0, .max = INFINITY)
/* Rows for the members kn and ks. */
#define TL_PARAM_KN(owner) TL_PARAM_STIFF(owner, kn, "Pa/m", TL_PARAM_REQUIRED, "normal stiffness of the joint")
#define TL_PARAM_KS(owner) TL_PARAM_STIFF(owner, ks, "Pa/m", TL_PARAM_REQUIRED, "shear stiffness of the joint")

/* Defines `stiffness`, for which the members kn_ and ks_ of the struct `type` are the bounds. */
#define TL_LAW_STIFFNESS(type, kn_, ks_)                                                                               \
    static void stiffness(const void *self, double *kn, double *ks)                                                    \
    {                                                                                                                  \
        *kn = ((const type *)self)->kn_;                                                                               \
        *ks = ((const type *)self)->ks_;                                                                               \
    }                                                                                                                  \
    _Static_assert(sizeof(type) > 0, "a struct")

/* `pulls` of a law whose parameters do not change the answer. */
static inline uint32_t tl_pulls_any(const void *self)
{
    (void)self;
    return TL_PULL_ANY;
}

static inline uint32_t tl_pulls_bonded(const void *self)
{
    (void)self;
    return TL_PULL_BONDED;
}

static inline uint32_t tl_pulls_none(const void *self)
{
    (void)self;
    return TL_PULL_NONE;
}

/* For `across_gap`: the lift of points with linear springs kn whose slip has opened the joint by `opening`, m (NULL: it
 * never does). */
TL_IN_LOOP void tl_law_lift(const tl_law_batch *batch, double kn, const double *opening, double *lift)
{
    for (uint32_t i = 0; i < batch->count; i++) {
        double spring = kn * batch->area[i];
        lift[i] = (opening ? opening[i] : 0) + batch->f_n0[i] / (spring > 0 ? spring : 1);
    }
}

/* For `across_gap`: points that do not pull. */
TL_IN_LOOP void tl_law_hold_none(const tl_law_batch *batch, double *hold)
{
    for (uint32_t i = 0; i < batch->count; i++)
        hold[i] = 0;
}

/* Operations of a law that has made itself with tl_keep: `create`, `update`, `stiffness` and what is given. */
#define TL_LAW_OPS(...)                                                                                                \
    {                                                                                                                  \
        .size = sizeof(tl_law_ops), .create = create, .update = update, .stiffness = stiffness, .destroy = free,       \
        __VA_ARGS__                                                                                                    \
    }

/* Columns of a batch from one point on. */
typedef struct tl_law_columns {
    const double *area, *closure, *f_n0, *du_n, *du_x, *du_y, *du_z;
    double *f_n, *f_x, *f_y, *f_z;
} tl_law_columns;

TL_IN_LOOP tl_law_columns tl_law_columns_from(const tl_law_batch *batch, uint32_t begin)
{
    tl_law_columns c;
    c.area = batch->area + begin;
    c.closure = batch->closure + begin;
    c.f_n0 = batch->f_n0 + begin;
    c.du_n = batch->du_n + begin;
    c.du_x = batch->du_s[0] + begin;
    c.du_y = batch->du_s[1] + begin;
    c.du_z = batch->du_s[2] + begin;
    c.f_n = batch->f_n + begin;
    c.f_x = batch->f_s[0] + begin;
    c.f_y = batch->f_s[1] + begin;
    c.f_z = batch->f_s[2] + begin;
    return c;
}

/* Reading and writing columns. Macros, not functions: what `omp simd` says of a loop holds, for clang, of accesses that
 * stand in the loop itself. */

/* Shear force of a point, N, on block B. */
#define TL_SHEAR_AT(c, i) tl_v3((c).f_x[i], (c).f_y[i], (c).f_z[i])
/* Motion of the step along the joint, m. */
#define TL_SLIDE_AT(c, i) tl_v3((c).du_x[i], (c).du_y[i], (c).du_z[i])
/* The same after the motion of the step, if nothing slips: f_s - spring du_s, eq. (7). `spring`: ks A, N/m. */
#define TL_TRIAL_AT(c, i, spring)                                                                                      \
    tl_v3((c).f_x[i] - (spring) * (c).du_x[i], (c).f_y[i] - (spring) * (c).du_y[i], (c).f_z[i] - (spring) * (c).du_z[i])
/* Puts `scale` times a force into the columns. */
#define TL_PUT_SHEAR(c, i, scale, force)                                                                               \
    ((c).f_x[i] = (scale) * (force).x, (c).f_y[i] = (scale) * (force).y, (c).f_z[i] = (scale) * (force).z)

/* Lanes worked on at a time by a law that notes much of each, and a number of each of them: both stay in the nearest
 * cache. */
#define TL_LAW_STRIDE 64u
typedef double tl_law_scratch[TL_LAW_STRIDE];
/* Tolerance: scaling a force down to its limit leaves it within 2 roundings of it. Without this margin a point at rest
 * would be scaled down by a rounding in every step. */
#define TL_LAW_ROUNDING 1e-15

/* The largest shear force, N, that does not slip at that limit. */
#define TL_LAW_MOST(limit) ((limit) * (1 + TL_LAW_ROUNDING))

/* The factor that brings a shear force `trial` down to its limit; 1 where it does not slip. */
TL_IN_LOOP double tl_law_scale(double trial, double limit)
{
    double most = TL_LAW_MOST(limit), beyond = trial > most ? trial : 1;
    return trial > most ? limit / beyond : 1;
}

/* Slip opens a joint by `tangent` times its length, and not beyond the opening `most`, m. */
typedef struct tl_law_dilation {
    double tangent, most;
} tl_law_dilation;

/* Of an angle, deg, that ends after a slip of the length `limit`, m; NaN: it never does. */
static inline tl_law_dilation tl_law_dilation_of(double angle, double limit)
{
    double tangent = tl_tan(angle * TL_DEGREE);
    return (tl_law_dilation){tangent, isnan(limit) ? INFINITY : tangent * limit};
}

/* By how much the slip of a step opens a joint of linear springs, m. The slip adds to the pressure and so to the
 * strength: it is (trial - strength) / (ks A + kn A tangent(dilation) tangent(friction)). `before`: normal force, N, at
 * the beginning of the step; `total`: at its end without slip, negative where the walls part. Slip keeps walls closed
 * that part no faster than it lifts them. No other walls that part are lifted. `friction`: its tangent; `opened`: so
 * far, m. */
TL_IN_LOOP double tl_law_lift_of_slip(tl_law_dilation by, double trial, double strength, double before, double total,
                                      double spring_n, double spring_s, double friction, double opened)
{
    double yield = spring_s + spring_n * by.tangent * friction;
    double grown = by.tangent * (trial - strength) / (yield > 0 ? yield : 1);
    double headroom = by.most > opened ? by.most - opened : 0;
    grown = grown < headroom ? grown : headroom;
    double left = before > 0 ? total + spring_n * grown : total;
    grown = left < 0 ? 0 : grown;
    return trial > TL_LAW_MOST(strength) ? grown : 0;
}

/* Work of slip, J, of a spring that would be at the force `trial`, of size `size`, and is brought down to `limit`: the
 * mean of the forces before (`along`: their product with the trial) and after, times the slip. `spring`: ks A. */
TL_IN_LOOP double tl_law_slip_work(double along, double size, double limit, double spring)
{
    double mean = 0.5 * (along / size + limit);
    return mean * ((size - limit) / (spring > 0 ? spring : 1));
}

/* Heat of slip, J: that work less what it `pays` for opening the joint; 0 where nothing slips or there is no spring. */
TL_IN_LOOP double tl_law_slip_heat(double along, double trial, double limit, double spring, double pays)
{
    double most = TL_LAW_MOST(limit);
    double work = tl_law_slip_work(along, trial > most ? trial : 1, limit, spring);
    work = (trial > most ? work : 0) - pays;
    work = work > 0 ? work : 0;
    return spring > 0 ? work : 0;
}

/* What slip pays, J, for opening a joint by `lift`, where that stores `rise`. The walls' motion of the step brings the
 * normal force from `before` to `from`. It is booked with the mean of the forces of its ends, lift and all: half of it
 * is met by the joint as it was. For a linear spring this is the mean of the normal forces before the step and after
 * it, times the lift. */
TL_IN_LOOP double tl_law_lift_work(double rise, double before, double from, double lift)
{
    return rise + 0.5 * (before - from) * lift;
}

/* Heat, J, of a tensile spring that is let go in this step, where it would pull with the force `gone`: what it held
 * before, and the work of half its force: the walls' motion du_n of the step is booked with the mean of the forces
 * of its ends. With stretches x0 and x1 before and after, spring x0^2 / 2 + spring x0 (x1 - x0) / 2 = spring x0 x1 / 2.
 * `spring`: kn A. */
TL_IN_LOOP double tl_law_snap_work(double gone, double spring, double du_n)
{
    double held = gone - spring * du_n;
    return 0.5 * gone * (held > 0 ? held : 0) / (spring > 0 ? spring : 1);
}

/* Puts flags that were noted as numbers into the batch. A law notes them so because a loop over columns of two widths
 * is not vectorised for every machine. */
TL_IN_LOOP void tl_law_put_flags(const tl_law_batch *batch, uint32_t begin, uint32_t lanes, const double *mark)
{
    uint32_t *flags = batch->flags + begin;
    TL_EACH_ALONE
    for (uint32_t i = 0; i < lanes; i++)
        flags[i] = (uint32_t)(int32_t)mark[i];
}

/* Puts the elastic energy, J, of linear springs kn and ks into the batch, if it is asked for; 0 for a lane of no area.
 * It is that of a law without tension: where one part of a point presses and another pulls, with the forces P and Q,
 * the springs hold more. That is (P^2 + Q^2) / (2 kn A), by P Q / (kn A) more. */
TL_IN_LOOP void tl_law_store_energy(const tl_law_batch *batch, uint32_t begin, uint32_t lanes, double kn, double ks)
{
    if (!batch->stored)
        return;
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *stored = batch->stored + begin;
    const double half_n = 0.5 / kn, half_s = 0.5 / ks;
    TL_EACH_ALONE
    for (uint32_t i = 0; i < lanes; i++) {
        double inverse = c.area[i] > 0 ? 1 / (c.area[i] > 0 ? c.area[i] : 1) : 0;
        double shear2 = tl_v3_norm2(TL_SHEAR_AT(c, i));
        stored[i] = (half_n * c.f_n[i] * c.f_n[i] + half_s * shear2) * inverse;
    }
}

/* ---------------------------------------------------------------- dampings --------------- */

/* Operations of a damping that never fails: `update` and what is given. */
#define TL_DAMPING_OPS(...)                                                                                            \
    {                                                                                                                  \
        .size = sizeof(tl_damping_ops), .update = update, .never_fails = 1, __VA_ARGS__                                \
    }

/* `step_factor` of a damping that leaves the stable time step as it is. */
static inline double tl_step_factor_one(const void *self)
{
    (void)self;
    return 1;
}

/* `update` of a viscous damping whose coefficient, the same for all bodies, is its first state. */
static inline tl_status tl_update_alpha_state(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)self;
    (void)report;
    double alpha = *batch->state[0];
    for (uint32_t i = 0; i < batch->count; i++)
        batch->alpha[i] = alpha;
    return TL_OK;
}

/* ---------------------------------------------------------------- generators ------------- */

/* Rows of the table of parameters of a struct `owner` with the members density and group, of "block" or "blocks". */
#define TL_PARAMS_ROCK(owner, made)                                                                                    \
    TL_PARAM_POSITIVE(owner, density, "kg/m3", "density of the " made),                                                \
        TL_PARAM(TL_PARAM_STRING, owner, group, "", "group of the " made, .def_text = "rock")

/* A tl_kind, as TL_KIND, of a generator that is the function `generate_`. */
#define TL_GENERATOR_KIND(generate_, ...)                                                                              \
    TL_KIND(TL_KIND_GENERATOR, ((const tl_generator_ops){.size = sizeof(tl_generator_ops), .generate = generate_}),    \
            __VA_ARGS__)

/* Bytes of a file that are read at once, at least. */
#define TL_FILE_PART ((size_t)64 << 10)

/* Reads a whole file of at most `most` bytes: *count bytes, and a zero byte after them. Free *bytes, after a failure
 * too. */
static inline tl_status tl_file_bytes(const tl_host *host, const char *file, size_t most, char **bytes, size_t *count)
{
    tl_status status = TL_OK;
    size_t capacity = 0;
    *bytes = NULL;
    *count = 0;
    FILE *stream = fopen(file, "rb");
    if (!stream)
        return host->fail(host, TL_E_IO, "file '%.200s' cannot be opened: %s", file, strerror(errno));
    while (status == TL_OK && !feof(stream)) {
        char *more = (char *)tl_grown(*bytes, &capacity, *count + TL_FILE_PART, 1);
        if (!more) {
            status = host->fail(host, TL_E_MEMORY, "file '%.200s': out of memory", file);
            break;
        }
        *bytes = more;
        *count += fread(more + *count, 1, capacity - 1 - *count, stream);
        if (ferror(stream))
            status = host->fail(host, TL_E_IO, "file '%.200s' cannot be read: %s", file, strerror(errno));
        else if (*count > most)
            status = host->fail(host, TL_E_IO, "file '%.200s' is larger than %zu bytes; divide it", file, most);
    }
    fclose(stream);
    if (status == TL_OK)
        (*bytes)[*count] = '\0';
    return status;
}

/* ---------------------------------------------------------------- plane polygons --------- */

typedef struct tl_flat {
    double x, y;
} tl_flat;

/* Twice the area of the triangle oab; negative when it is clockwise. */
static inline double tl_flat_cross(tl_flat o, tl_flat a, tl_flat b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

static inline double tl_flat_apart(tl_flat a, tl_flat b)
{
    return sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

/* Height of the triangle abc over its longest side; negative when it is clockwise. */
static inline double tl_flat_height(tl_flat a, tl_flat b, tl_flat c)
{
    double longest = fmax(tl_flat_apart(a, b), fmax(tl_flat_apart(b, c), tl_flat_apart(c, a)));
    return longest > 0 ? tl_flat_cross(a, b, c) / longest : 0;
}

/* Distance of p from the segment ab. */
static inline double tl_flat_off_segment(tl_flat a, tl_flat b, tl_flat p)
{
    double x = b.x - a.x, y = b.y - a.y, length2 = x * x + y * y;
    double t = length2 > 0 ? (x * (p.x - a.x) + y * (p.y - a.y)) / length2 : 0;
    t = fmin(1, fmax(0, t));
    return tl_flat_apart((tl_flat){a.x + t * x, a.y + t * y}, p);
}

static inline int tl_flat_segments_meet(tl_flat a, tl_flat b, tl_flat c, tl_flat d, double near)
{
    if (fmin(a.x, b.x) > fmax(c.x, d.x) + near || fmin(c.x, d.x) > fmax(a.x, b.x) + near ||
        fmin(a.y, b.y) > fmax(c.y, d.y) + near || fmin(c.y, d.y) > fmax(a.y, b.y) + near)
        return 0;
    if ((tl_flat_cross(a, b, c) > 0) != (tl_flat_cross(a, b, d) > 0) &&
        (tl_flat_cross(c, d, a) > 0) != (tl_flat_cross(c, d, b) > 0))
        return 1;
    return tl_flat_off_segment(a, b, c) <= near || tl_flat_off_segment(a, b, d) <= near ||
           tl_flat_off_segment(c, d, a) <= near || tl_flat_off_segment(c, d, b) <= near;
}

/* Whether two edges of a polygon of n corners come as close as `near` without sharing a corner, or fold back on each
 * other. They are the first such, and begin at the corners *one and *other. */
static inline int tl_polygon_crosses(const tl_flat *at, size_t n, double near, size_t *one, size_t *other)
{
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            tl_flat a = at[i], b = at[(i + 1) % n], c = at[j], d = at[(j + 1) % n];
            int meet;
            /* neighbours share a corner; the far ends must keep off the other edge */
            if (j == i + 1)
                meet = tl_flat_off_segment(c, d, a) <= near || tl_flat_off_segment(a, b, d) <= near;
            else if (i == 0 && j == n - 1)
                meet = tl_flat_off_segment(c, d, b) <= near || tl_flat_off_segment(a, b, c) <= near;
            else
                meet = tl_flat_segments_meet(a, b, c, d, near);
            if (meet) {
                *one = i;
                *other = j;
                return 1;
            }
        }
    return 0;
}

/* An ear of a polygon whose corners are at[corner[0]], at[corner[1]], ..., counter-clockwise: a place in `corner` where
 * it turns left, by a height of more than `near`. No other corner is in its triangle with its neighbours. Where there
 * is none, *height is at most `near`, and the place that of the flattest corner. */
static inline size_t tl_polygon_ear(const tl_flat *at, const size_t *corner, size_t count, double near, double *height)
{
    size_t flattest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        size_t i = corner[(k + count - 1) % count], j = corner[k], l = corner[(k + 1) % count];
        tl_flat a = at[i], b = at[j], c = at[l];
        double high = tl_flat_height(a, b, c);
        int ear = high > near;
        for (size_t q = 0; q < count && ear; q++) {
            size_t o = corner[q];
            ear = o == i || o == j || o == l || tl_flat_cross(a, b, at[o]) < 0 || tl_flat_cross(b, c, at[o]) < 0 ||
                  tl_flat_cross(c, a, at[o]) < 0;
        }
        if (ear) {
            *height = high;
            return k;
        }
        if (fabs(high) < least) {
            least = fabs(high);
            flattest = k;
        }
    }
    *height = 0;
    return flattest;
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#endif
