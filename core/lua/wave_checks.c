/* wave_checks.c - what may be amiss with waves that come in.
 *
 * The highest frequency of a record is that above which its velocities have a hundredth of their energy. Spectra of
 * stretches of 512 samples, which Hann's window fades in and out, are summed up. */
#include "lua/wave_checks.h"

#include "lua/fail.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/elements.h>
#include <talus/number.h>
#include <talus/vmath.h>

/* Limit: samples of a stretch of a record. */
#define STRETCH 512
/* Tolerance: part of the energy of velocities that is above the highest frequency that counts. Test:
 * lua/test_wave_checks. */
#define ABOVE 0.01
/* Limit: blocks that a wave needs. Quiet faces then send back less than 0.1 % of its energy. */
#define BLOCKS 10.0

/* ---------------------------------------------------------------- damping ---------------- */

/* When a wave of an element's parameter ends, s; -INFINITY: there is none. Its text is begin, dt and two numbers of
 * each sample. */
static double end_of(const char *text)
{
    const char *next = text;
    if (!text || !*text)
        return -INFINITY;
    const double begin = tl_number_read(text, &next), dt = tl_number_read(next + (*next == ' '), &next);
    double intervals = -1;
    for (; *next; next++)
        intervals += *next == ' ' && next[1] && next[1] != ' ' ? 0.5 : 0;
    return begin + dt * intervals;
}

static double last_wave(tl_model *model, tl_id element)
{
    static const char *const names[] = {"input_x", "input_y", "input_z"};
    tl_element_info info = {.kind = NULL};
    double last = -INFINITY;
    if (tl_element_get(model, element, &info) != TL_OK)
        return last;
    for (uint32_t k = 0; k < info.kind->param_count; k++)
        for (int i = 0; i < 3; i++) {
            const tl_param *p = &info.kind->params[k];
            const char *text;
            if (p->type != TL_PARAM_STRING || strcmp(p->name, names[i]) != 0)
                continue;
            memcpy(&text, (const char *)info.params + p->offset, sizeof text);
            last = fmax(last, end_of(text));
        }
    return last;
}

void tl_lua_waves_keep(lua_State *L, tl_model *model, const char *name)
{
    const tl_element_filter filter = {.size = sizeof filter};
    double last = -INFINITY;
    tl_id *ids = NULL;
    size_t count = 0;
    tl_lua_ok(L, model, tl_elements_select(model, &filter, &ids, &count));
    for (size_t i = 0; i < count; i++)
        last = fmax(last, last_wave(model, ids[i]));
    free(ids);
    if (last > tl_model_time(model))
        tl_lua_fail(L,
                    "damping: '%s' takes out vibrations of all frequencies, and a wave comes in until %f s: use "
                    "\"rayleigh\", \"dashpot\" or \"none\" until then",
                    name, last);
}

/* ---------------------------------------------------------------- remarks ---------------- */

void tl_lua_waves_step(lua_State *L, tl_model *model, const tl_record *const records[3])
{
    tl_timestep_report report;
    double least = INFINITY;
    for (int k = 0; k < 3; k++)
        least = records[k] ? fmin(least, tl_record_dt(records[k])) : least;
    if (tl_model_timestep_report(model, &report) != TL_OK || !(report.dt > least))
        return;
    char text[256];
    tl_text_print(text, sizeof text,
                  "boundary: the step, %.3g s, is longer than the %.3g s between samples of the wave that comes in: "
                  "part of it is left out",
                  report.dt, least);
    tl_lua_log(tl_lua_options_of(L), text);
}

/* Adds the spectrum of a stretch of velocities from sample `first` on. */
static void add_stretch(const tl_record *record, size_t first, const double wave[STRETCH], double power[])
{
    double v[STRETCH];
    for (size_t i = 0; i < STRETCH; i++) {
        const bool inside = first + i < tl_record_count(record);
        const double fade = 0.5 - 0.5 * wave[i];
        v[i] = inside ? fade * tl_record_velocity(record, (double)(first + i) * tl_record_dt(record)) : 0;
    }
    for (size_t k = 1; k <= STRETCH / 2; k++) {
        double c = 0, s = 0;
        for (size_t i = 0; i < STRETCH; i++) {
            const size_t at = i * k % STRETCH;
            c += v[i] * wave[at];
            s += v[i] * wave[(at + STRETCH * 3 / 4) % STRETCH]; /* the sine: a quarter later */
        }
        power[k] += c * c + s * s;
    }
}

/* The frequency above which there is ABOVE of the energy of its velocities, Hz. */
static double highest(const tl_record *record)
{
    double wave[STRETCH], power[STRETCH / 2 + 1] = {0}, all = 0, sum = 0;
    for (size_t i = 0; i < STRETCH; i++)
        wave[i] = tl_cos(2 * TL_PI * (double)i / STRETCH);
    for (size_t first = 0; first < tl_record_count(record); first += STRETCH / 2)
        add_stretch(record, first, wave, power);
    for (size_t k = 1; k <= STRETCH / 2; k++)
        all += power[k];
    size_t k = STRETCH / 2;
    for (; k > 1 && sum + power[k] <= ABOVE * all; k--)
        sum += power[k];
    return (double)k / (STRETCH * tl_record_dt(record));
}

void tl_lua_waves_blocks(lua_State *L, const tl_record *const records[3], const tl_lua_wave_face *faces, size_t count)
{
    double fewest = INFINITY, frequency = 0;
    const tl_lua_wave_face *worst = NULL;
    for (int k = 0; k < 3; k++) {
        const double hz = records[k] ? highest(records[k]) : 0;
        for (size_t i = 0; i < count && hz > 0; i++) {
            const tl_lua_wave_face *f = &faces[i];
            const double n = k == 0 ? f->normal.x : k == 1 ? f->normal.y : f->normal.z;
            const double blocks = (n * n > 0.5 ? f->along : f->across) / (hz * f->height);
            if (blocks < fewest) {
                fewest = blocks;
                frequency = hz;
                worst = f;
            }
        }
    }
    if (!(fewest < BLOCKS))
        return;
    char text[320];
    tl_text_print(text, sizeof text,
                  "boundary: %.2g blocks like block %u, %.3g m high, make up a wave of %.3g Hz, above which the record "
                  "has 1 %% of its energy: %g are needed, so make blocks smaller, or give the record a band",
                  fewest, worst->block, worst->height, frequency, BLOCKS);
    tl_lua_log(tl_lua_options_of(L), text);
}
