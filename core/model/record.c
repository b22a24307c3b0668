/* record.c - records of ground motion: made of samples, integrated, and asked.
 *
 * Within an interval of dt the acceleration goes linearly from a to b. At the time s after its begin
 *
 *     v = v_0 + a s + (b - a) s^2 / (2 dt),    u = u_0 + v_0 s + a s^2 / 2 + (b - a) s^3 / (6 dt)
 *
 * Samples of velocity are linear in between, so a = b there. */
#include "model/record.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/number.h>

/* Constant: pi, and standard gravity, m/s2. */
#define PI 3.14159265358979323846
#define GRAVITY 9.80665

/* ---------------------------------------------------------------- life ------------------- */

tl_record *tl_record_new(double dt, size_t count)
{
    tl_record *r = calloc(1, sizeof *r);
    tl_record_interval *intervals = calloc(count + 1, sizeof *intervals);
    if (!r || !intervals) {
        free(r);
        free(intervals);
        return NULL;
    }
    *r = (tl_record){dt, count, intervals, 1};
    return r;
}

tl_record *tl_record_hold(const tl_record *record)
{
    tl_record *r = (tl_record *)(uintptr_t)record;
    if (r)
        r->holders++;
    return r;
}

void tl_record_let_go(tl_record *record)
{
    if (!record || --record->holders > 0)
        return;
    free(record->interval);
    free(record);
}

void tl_record_integrate(tl_record *r)
{
    for (size_t i = 0; i < r->count; i++) {
        const tl_record_interval *at = &r->interval[i];
        r->interval[i + 1].velocity = at->velocity + 0.5 * (at->from + at->to) * r->dt;
        r->interval[i + 1].displacement =
            at->displacement + (at->velocity + (at->from / 3 + at->to / 6) * r->dt) * r->dt;
    }
}

/* ---------------------------------------------------------------- corrections ------------- */

/* A filter of second order: y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2. */
typedef struct biquad {
    double b[3], a[2];
} biquad;

/* Butterworth by the bilinear transform, low-pass or high-pass at `f` Hz. */
static biquad butterworth(double f, double dt, bool high)
{
    const double k = tl_tan(PI * f * dt), root = 1.41421356237309504880, norm = 1 / (1 + root * k + k * k);
    const double gain = high ? norm : k * k * norm;
    return (biquad){{gain, high ? -2 * gain : 2 * gain, gain}, {2 * (k * k - 1) * norm, (1 - root * k + k * k) * norm}};
}

/* Runs it over samples `step` apart, from rest. */
static void run_filter(const biquad *by, double *first, size_t count, int step)
{
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    for (double *at = first; count > 0; count--, at += step) {
        const double x = *at, y = by->b[0] * x + by->b[1] * x1 + by->b[2] * x2 - by->a[0] * y1 - by->a[1] * y2;
        x2 = x1;
        x1 = x;
        y2 = y1;
        y1 = *at = y;
    }
}

static void filter_band(double *samples, size_t count, const tl_record_options *o)
{
    for (int k = 0; k < 2; k++) {
        if (!(o->band[k] > 0))
            continue;
        const biquad by = butterworth(o->band[k], o->dt, k == 0);
        run_filter(&by, samples, count, 1);
        run_filter(&by, samples + count - 1, count, -1);
    }
}

/* The coefficients of the velocity's best fit b1 t + b2 t^2 at the samples. */
static void fit_parabola(const tl_record *r, double b[2])
{
    double t2 = 0, t3 = 0, t4 = 0, vt = 0, vt2 = 0;
    for (size_t i = 0; i <= r->count; i++) {
        const double t = (double)i / (double)r->count, v = r->interval[i].velocity;
        t2 += t * t;
        t3 += t * t * t;
        t4 += t * t * t * t;
        vt += v * t;
        vt2 += v * t * t;
    }
    const double det = t2 * t4 - t3 * t3, length = r->dt * (double)r->count;
    b[0] = det > 0 ? (vt * t4 - vt2 * t3) / det / length : 0;
    b[1] = det > 0 ? (vt2 * t2 - vt * t3) / det / (length * length) : 0;
}

static void take_off(tl_record *r, const tl_record_options *o)
{
    double b[2] = {0, 0};
    if (o->baseline == TL_BASELINE_MEAN)
        b[0] = (r->interval[r->count].velocity - r->interval[0].velocity) / (r->dt * (double)r->count);
    else if (o->baseline == TL_BASELINE_PARABOLA)
        fit_parabola(r, b);
    for (size_t i = 0; i < r->count; i++) {
        double from = (double)i * r->dt, to = (double)(i + 1) * r->dt;
        if (o->quantity == TL_RECORD_VELOCITY)
            from = to = 0.5 * (from + to);
        r->interval[i].from -= b[0] + 2 * b[1] * from;
        r->interval[i].to -= b[0] + 2 * b[1] * to;
    }
    tl_record_integrate(r);
}

/* ---------------------------------------------------------------- making ------------------ */

static tl_status check_options(const tl_record_options *o, tl_error *error)
{
    if (!(o->dt > 0) || isinf(o->dt))
        return tl_fail(error, TL_E_ARGUMENT, "record: dt = %g s must be finite and > 0: give the time between samples",
                       o->dt);
    if (!isfinite(o->scale))
        return tl_fail(error, TL_E_ARGUMENT, "record: scale = %g must be finite", o->scale);
    const bool moves = o->quantity == TL_RECORD_VELOCITY;
    if (o->unit != TL_RECORD_UNIT_OWN && (o->unit >= TL_RECORD_UNIT_M_S) != moves)
        return tl_fail(error, TL_E_ARGUMENT, "record: the unit is that of %s, and quantity = \"%s\": give both alike",
                       moves ? "accelerations" : "velocities", moves ? "velocity" : "acceleration");
    const double half = 0.5 / o->dt, low = o->band[0], high = o->band[1];
    const bool filters = low != 0 || high != 0;
    if (filters && !(low >= 0 && high > low && high < half))
        return tl_fail(error, TL_E_ARGUMENT, "record: band = {%g, %g} Hz must be 0 <= low < high < 1 / (2 dt) = %g Hz",
                       low, high, half);
    return TL_OK;
}

static tl_status check_samples(const double *samples, size_t count, tl_error *error)
{
    if (count < 2 || count > TL_RECORD_MOST)
        return tl_fail(error, TL_E_ARGUMENT, "record: %zu samples are outside 2 to %d", count, TL_RECORD_MOST);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(samples[i]))
            return tl_fail(error, TL_E_ARGUMENT, "record: sample %zu is %g, which must be a finite number", i + 1,
                           samples[i]);
    return TL_OK;
}

static void put_samples(tl_record *r, const double *x, const tl_record_options *o)
{
    const bool moves = o->quantity == TL_RECORD_VELOCITY;
    for (size_t i = 0; i < r->count; i++) {
        const double slope = (x[i + 1] - x[i]) / r->dt;
        r->interval[i].from = moves ? slope : x[i];
        r->interval[i].to = moves ? slope : x[i + 1];
    }
    r->interval[0].velocity = moves ? x[0] : 0;
    tl_record_integrate(r);
    if (o->baseline != TL_BASELINE_NONE)
        take_off(r, o);
}

bool tl_record_is_finite(const tl_record *r)
{
    double sum = 0;
    for (size_t i = 0; i <= r->count; i++)
        sum += 0 * (r->interval[i].velocity + r->interval[i].displacement + r->interval[i].from + r->interval[i].to);
    return sum == 0;
}

tl_status tl_record_make(const double *samples, size_t count, const tl_record_options *options, tl_record **record,
                         tl_error *error)
{
    *record = NULL;
    tl_status status = check_options(options, error);
    if (status == TL_OK)
        status = check_samples(samples, count, error);
    if (status != TL_OK)
        return status;
    tl_record *r = tl_record_new(options->dt, count - 1);
    double *x = malloc(count * sizeof *x);
    if (!r || !x) {
        tl_record_let_go(r);
        free(x);
        return tl_fail_memory(error);
    }
    static const double units[] = {1, 1, GRAVITY, 0.01, 1, 0.01};
    const double factor = options->scale * units[options->unit];
    for (size_t i = 0; i < count; i++)
        x[i] = factor * samples[i];
    filter_band(x, count, options);
    put_samples(r, x, options);
    free(x);
    if (!tl_record_is_finite(r)) {
        tl_record_let_go(r);
        return tl_fail(error, TL_E_NUMERIC, "record: its motion leaves the range of numbers: look at unit and scale");
    }
    *record = r;
    return TL_OK;
}

/* ---------------------------------------------------------------- asking ------------------ */

double tl_record_dt(const tl_record *record)
{
    return record->dt;
}

size_t tl_record_count(const tl_record *record)
{
    return record->count + 1;
}

/* The interval of a time, and the time since its begin. */
static const tl_record_interval *interval_at(const tl_record *r, double t, double *since)
{
    const double number = t > 0 ? floor(t / r->dt) : 0;
    const size_t i = number < (double)r->count ? (size_t)number : r->count;
    *since = t > 0 ? t - (double)i * r->dt : 0;
    return &r->interval[i];
}

double tl_record_acceleration(const tl_record *record, double t)
{
    double s;
    const tl_record_interval *at = interval_at(record, t, &s);
    return t < 0 ? 0 : at->from + (at->to - at->from) * (s / record->dt);
}

double tl_record_velocity(const tl_record *record, double t)
{
    double s;
    const tl_record_interval *at = interval_at(record, t, &s);
    return at->velocity + (at->from + 0.5 * (at->to - at->from) * (s / record->dt)) * s;
}

double tl_record_displacement(const tl_record *record, double t)
{
    double s;
    const tl_record_interval *at = interval_at(record, t, &s);
    return at->displacement + (at->velocity + (0.5 * at->from + (at->to - at->from) * (s / record->dt) / 6) * s) * s;
}

double tl_record_peak(const tl_record *record)
{
    double most = 0;
    for (size_t i = 0; i < record->count; i++)
        most = fmax(most, fmax(fabs(record->interval[i].from), fabs(record->interval[i].to)));
    return most;
}

double tl_record_peak_velocity(const tl_record *record)
{
    double most = 0;
    for (size_t i = 0; i <= record->count; i++)
        most = fmax(most, fabs(record->interval[i].velocity));
    return most;
}

double tl_record_arias(const tl_record *record)
{
    double sum = 0;
    for (size_t i = 0; i < record->count; i++) {
        const double a = record->interval[i].from, b = record->interval[i].to;
        sum += (a * a + a * b + b * b) / 3 * record->dt;
    }
    return 0.5 * PI / GRAVITY * sum;
}

/* ---------------------------------------------------------------- spectrum ---------------- */

/* u'' + 2 z w u' + w^2 u = -(a + s t): the particular solution is p + q t. The rest decays from what is left of u and
 * u'. */
typedef struct oscillator {
    double w, z, damped, decay, sine, cosine, dt;
} oscillator;

static oscillator oscillator_of(double period, double damping, double dt)
{
    const double w = 2 * PI / period, damped = w * sqrt(1 - damping * damping);
    return (oscillator){w, damping, damped, 1 + tl_expm1(-damping * w * dt), tl_sin(damped * dt), tl_cos(damped * dt),
                        dt};
}

static void oscillate(const oscillator *o, double a, double b, double *u, double *v)
{
    const double s = (b - a) / o->dt, w2 = o->w * o->w;
    const double q = -s / w2, p = -(a + 2 * o->z * o->w * q) / w2;
    const double u0 = *u - p, v0 = *v - q, c = (v0 + o->z * o->w * u0) / o->damped;
    *u = o->decay * (u0 * o->cosine + c * o->sine) + p + q * o->dt;
    *v = o->decay * ((o->damped * c - o->z * o->w * u0) * o->cosine - (o->damped * u0 + o->z * o->w * c) * o->sine) + q;
}

/* Cost only: parts of a period that an interval is cut into at least, so that the largest |u| is met. */
#define PARTS 20

/* Also of what goes on for a period after the record. */
static double largest_of(const tl_record *r, double period, double damping)
{
    const size_t parts = (size_t)fmin(1e6, 1 + floor(PARTS * r->dt / period));
    const oscillator o = oscillator_of(period, damping, r->dt / (double)parts);
    double u = 0, v = 0, most = 0;
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < parts; k++) {
            const double a = r->interval[i].from, by = (r->interval[i].to - a) / (double)parts;
            oscillate(&o, a + (double)k * by, a + (double)(k + 1) * by, &u, &v);
            most = fmax(most, fabs(u));
        }
    const oscillator after = oscillator_of(period, damping, period / PARTS);
    for (size_t k = 0; k < PARTS; k++) {
        oscillate(&after, 0, 0, &u, &v);
        most = fmax(most, fabs(u));
    }
    return o.w * o.w * most;
}

tl_status tl_record_spectrum(const tl_record *record, double damping, const double *periods, size_t count, double *out,
                             tl_error *error)
{
    if (!(damping >= 0 && damping < 1))
        return tl_fail(error, TL_E_ARGUMENT, "spectrum: damping = %g is outside [0, 1)", damping);
    for (size_t i = 0; i < count; i++)
        if (!(periods[i] > 0) || isinf(periods[i]))
            return tl_fail(error, TL_E_ARGUMENT, "spectrum: period %zu = %g s must be finite and > 0", i + 1,
                           periods[i]);
    for (size_t i = 0; i < count; i++)
        out[i] = largest_of(record, periods[i], damping);
    return TL_OK;
}
