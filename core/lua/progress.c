/* progress.c - how a run or a generator goes: one line on a terminal that is written anew, in a log a line now and then.
 *
 * It goes to standard error, and asks nothing that could make the kernel compute: a run gives the same bits with it and
 * without. So dt is the mean step since the last line. Limit: the time that is left is guessed from the trend so far. */
#include "progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <talus/elementary.h>
#include <talus/number.h>
#include <unistd.h>

/* Seconds between two lines on a terminal and in a log, unless TALUS_PROGRESS says. */
#define TERMINAL_PERIOD 0.1
#define LOG_PERIOD 5.0
/* Counting contacts takes at most this share of the time. */
#define COUNTING 0.02
/* Widest line of a log. */
#define LOG_COLUMNS 160
/* A trend of the logarithm of the ratio that is less than this in the time looked at is none. */
#define TREND 0.1

/* The period that the environment asks for, s, or NaN. */
static double read_period(lua_State *L)
{
    const char *text = getenv("TALUS_PROGRESS");
    if (!text || !text[0])
        return NAN;
    const char *end;
    double period = tl_number_read(text, &end);
    if (end == text || *end || !(period >= 0) || !isfinite(period))
        tl_lua_fail(L, "the environment's TALUS_PROGRESS = '%s' is not a number of seconds >= 0",
                    text);
    return period;
}

void tl_lua_progress_begin(lua_State *L, tl_lua_progress *p, const tl_model *model)
{
    *p = (tl_lua_progress){.on = !tl_lua_options_of(L)->quiet};
    if (!p->on)
        return;
    p->terminal = isatty(STDERR_FILENO) == 1;
    double period = read_period(L);
    p->period = !isnan(period) ? period : p->terminal ? TERMINAL_PERIOD : LOG_PERIOD;
    p->began = p->shown = tl_lua_clock();
    p->first_cycle = p->shown_cycle = tl_model_cycles(model);
    p->first_time = p->shown_time = tl_model_time(model);
}

void tl_lua_progress_clear(tl_lua_progress *p)
{
    if (p->drawn)
        fputs("\r\033[K", stderr);
    p->drawn = false;
}

/* ---------------------------------------------------------------- a line ----------------- */

/* Parts of a line in their order; where there is no room for all, those of the lowest rank are left out. */
enum { PARTS = 12, PART_TEXT = 48 };

typedef struct line {
    char part[PARTS][PART_TEXT];
    int rank[PARTS]; /* 0: the most important */
    int count;
} line;

static void add(line *l, int rank, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(l->part[l->count], PART_TEXT, format, arguments);
    va_end(arguments);
    l->rank[l->count++] = rank;
}

static int columns(const tl_lua_progress *p)
{
    struct winsize size;
    if (!p->terminal)
        return LOG_COLUMNS;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2)
        return 79;
    return size.ws_col - 1 < LOG_COLUMNS ? size.ws_col - 1 : LOG_COLUMNS;
}

static size_t length_of(const line *l, int least)
{
    size_t length = 0;
    for (int i = 0; i < l->count; i++)
        if (l->rank[i] <= least)
            length += (length ? 2 : 0) + strlen(l->part[i]);
    return length;
}

static void write_line(tl_lua_progress *p, const line *l)
{
    char text[PARTS * (PART_TEXT + 2)] = "";
    int width = columns(p), least = PARTS;
    while (least > 0 && length_of(l, least) > (size_t)width)
        least--;
    for (int i = 0; i < l->count; i++)
        if (l->rank[i] <= least) {
            strcat(text, text[0] ? "  " : "");
            strcat(text, l->part[i]);
        }
    fprintf(stderr, p->terminal ? "\r\033[K%.*s" : "talus: %.*s\n", width, text);
    fflush(stderr);
    p->drawn = p->terminal;
    p->shown = tl_lua_clock();
}

static void add_time_left(line *l, double seconds)
{
    static const struct {
        double below, unit;
        const char *format;
    } units[] = {{100, 1, "%.0f s left"},
                 {6000, 60, "%.0f min left"},
                 {172800, 3600, "%.1f h left"},
                 {1e9, 86400, "%.1f days left"}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (seconds < units[i].below) {
            add(l, 1, units[i].format, seconds / units[i].unit);
            return;
        }
}

/* ---------------------------------------------------------------- the trend -------------- */

static double logarithm(double x)
{
    const double ln_2 = 0.6931471805599453;
    int exponent;
    double mantissa = frexp(x, &exponent);
    return exponent * ln_2 + tl_log1p(mantissa - 1);
}

/* Keeps the ratio; of many, fewer and fewer. */
static void keep_ratio(tl_lua_progress *p, double at, double ratio)
{
    if (!(ratio > 0) || !isfinite(ratio))
        return;
    if (p->kept == TL_LUA_TREND) {
        p->kept /= 2;
        for (int i = 0; i < p->kept; i++) {
            p->at[i] = p->at[2 * i + 1];
            p->log_ratio[i] = p->log_ratio[2 * i + 1];
        }
    }
    p->at[p->kept] = at;
    p->log_ratio[p->kept++] = logarithm(ratio);
}

typedef struct trend {
    double slope;  /* of the logarithm of the ratio, 1/s */
    double value;  /* that the line through them has now */
    double change; /* in the time looked at */
} trend;

/* The line through the later half of the ratios. */
static trend trend_of(const tl_lua_progress *p)
{
    int first = p->kept / 2, n = p->kept - first;
    double x = 0, y = 0, xx = 0, xy = 0;
    for (int i = first; i < p->kept; i++) {
        x += p->at[i] / n;
        y += p->log_ratio[i] / n;
    }
    for (int i = first; i < p->kept; i++) {
        xx += (p->at[i] - x) * (p->at[i] - x);
        xy += (p->at[i] - x) * (p->log_ratio[i] - y);
    }
    if (n < 4 || !(xx > 0))
        return (trend){NAN, NAN, NAN};
    double slope = xy / xx, last = p->at[p->kept - 1];
    return (trend){slope, y + slope * (last - x), slope * (last - p->at[first])};
}

/* ---------------------------------------------------------------- a run ------------------ */

/* The ratio that may end the run. */
static double ratio_of(const tl_solve_result *r)
{
    switch (r->measure) {
    case TL_RATIO_AVERAGE: return r->ratio;
    case TL_RATIO_MAXIMUM: return r->ratio_maximum;
    default: return r->ratio_local;
    }
}

/* The share of the run that is done by its limits of steps and of time. */
static double share_done(const tl_lua_progress *p, const tl_solve *limits,
                         const tl_solve_result *result)
{
    double share = limits->max_cycles > 0 ? (double)result->cycles / (double)limits->max_cycles : 1;
    if (limits->max_time > 0)
        share = fmax(share, (result->time - p->first_time) / limits->max_time);
    return fmin(share, 1);
}

static void add_goal(line *l, tl_lua_progress *p, const tl_solve *limits,
                     const tl_solve_result *result, double t)
{
    double ratio = ratio_of(result), share = share_done(p, limits, result);
    double left = share > 0 ? (t - p->began) * (1 - share) / share : INFINITY;
    keep_ratio(p, t - p->began, ratio);
    if (!(limits->ratio > 0)) {
        add(l, 0, "%.0f %%", floor(100 * share));
        add_time_left(l, left);
        return;
    }
    trend now_is = trend_of(p);
    const char *word = isnan(now_is.change)     ? ""
                       : now_is.change < -TREND ? " falling"
                       : now_is.change > TREND  ? " rising"
                                                : " steady";
    add(l, 0, "ratio %.1e%s (to %.0e)", ratio, word, limits->ratio);
    if (limits->max_time > 0)
        add(l, 2, "%.0f %% of the time", floor(100 * share));
    if (now_is.change < -TREND)
        add_time_left(
            l, fmin(left, fmax(0, (logarithm(limits->ratio) - now_is.value) / now_is.slope)));
}

static void count_contacts(tl_lua_progress *p, const tl_model *model, double t)
{
    if (p->period > 0 && t < p->next_count)
        return;
    p->counts = tl_model_contact_counts(model);
    double after = tl_lua_clock();
    p->next_count = after + (after - t) / COUNTING;
}

void tl_lua_progress_run(tl_lua_progress *p, const tl_model *model, const tl_solve *limits,
                         const tl_solve_result *result)
{
    if (!p->on)
        return;
    double t = tl_lua_clock(), time = tl_model_time(model);
    int64_t cycle = tl_model_cycles(model), steps = cycle - p->shown_cycle;
    if (t - p->shown < p->period || steps == 0)
        return;
    count_contacts(p, model, t);
    line l = {.count = 0};
    add_goal(&l, p, limits, result, t);
    add(&l, 8, "cycle %lld", (long long)cycle);
    add(&l, 3, "t %.4g s", time);
    add(&l, 9, "dt %.2g s", (time - p->shown_time) / (double)steps);
    add(&l, 4, "v %.1e m/s", result->max_velocity);
    add(&l, 5, "%zu sliding", p->counts.slipping);
    add(&l, 6, "%zu open", p->counts.open);
    if (t > p->began)
        add(&l, 7, "%.*f/s", (double)result->cycles < 10 * (t - p->began) ? 1 : 0,
            (double)result->cycles / (t - p->began));
    write_line(p, &l);
    p->shown_cycle = cycle;
    p->shown_time = time;
}

/* ---------------------------------------------------------------- a generator ------------ */

void tl_lua_progress_generate(void *user, const tl_generate_progress *done)
{
    tl_lua_progress *p = user;
    double t = p->on ? tl_lua_clock() : 0;
    if (!p->on || t - p->shown < p->period)
        return;
    line l = {.count = 0};
    add(&l, 0, "%s", done->generator);
    if (done->share > 0)
        add(&l, 0, "%.0f %%", floor(100 * fmin(done->share, 1)));
    if (done->entries > 1)
        add(&l, 2, "entry %zu of %zu", done->entry, done->entries);
    add(&l, 3, "%zu cuts", done->cuts);
    add(&l, 2, "%zu blocks", done->blocks);
    if (done->share > 0 && done->share <= 1)
        add_time_left(&l, (t - p->began) * (1 - done->share) / done->share);
    write_line(p, &l);
}
