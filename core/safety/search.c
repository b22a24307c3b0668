/* search.c - the factor of safety of a model: the largest factor by which its strengths may be divided.
 *
 * Factors are those of a grid, from (1 + resolution)^k with the last one `to`. So trials do not depend on the order in
 * which they are made, nor on how many processes make them. The search begins about the least factor of the keyblocks,
 * or about 1, with a bracket of a few per cent (safety/bracket.c). */
#include "base/clock.h"
#include "base/error.h"
#include "model/scope.h"
#include "safety/narrow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/talus.h>

/* Cost only: half the width of the first bracket, over its middle. */
#define BRACKET 0.03

typedef struct search {
    tl_trials trials;
    tl_safety_result *result;
    double *grid; /* [last + 1] */
    size_t last, capacity;
    tl_fall loose;      /* whatever the strengths */
    tl_bracket bracket; /* on the grid */
    tl_fall fall;       /* at the least factor that fails; where none does, at the largest that holds */
} search;

static const char *const mode_names[] = {[TL_SAFETY_HOLDS] = "holds",
                                         [TL_SAFETY_SLIDES] = "slides",
                                         [TL_SAFETY_TURNS] = "turns",
                                         [TL_SAFETY_FALLS] = "falls",
                                         [TL_SAFETY_YIELDS] = "yields"};

const char *tl_safety_mode_name(tl_safety_mode mode)
{
    return (unsigned)mode <= TL_SAFETY_YIELDS ? mode_names[mode] : "?";
}

/* ---------------------------------------------------------------- keyblocks -------------- */

/* The parameter of a law of that name, or `none`. */
static double value_of(const tl_law *law, const char *name, double none)
{
    for (uint32_t i = 0; i < law->kind->param_count; i++) {
        const tl_param *p = &law->kind->params[i];
        double value;
        if (p->type != TL_PARAM_REAL || strcmp(p->name, name) != 0)
            continue;
        memcpy(&value, (const char *)law->params + p->offset, sizeof value);
        return value;
    }
    return none;
}

/* The strengths that keyblocks have by the laws of a model, with what their names are in. 0: laws do not say. */
static size_t read_strengths(tl_model *m, tl_joint_strength *list, char (*names)[TL_SCOPE_TEXT])
{
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        const double friction = value_of(law, "friction", NAN);
        if (law->scope.names > 0 || law->scope.pairs || !(friction < 90))
            return 0;
        tl_text_print(names[i], sizeof names[i], "%s", tl_pattern_name(m, law->scope.tag));
        list[i] = (tl_joint_strength){names[i], friction, value_of(law, "cohesion", 0)};
    }
    return m->joint_law_count;
}

/* The least factor of the keyblocks, where the laws say what they need. */
static tl_status ask_keyblocks(search *s)
{
    tl_model *copy = s->trials.base;
    const size_t laws = s->trials.asked->joint_law_count;
    tl_joint_strength *list = calloc(laws + 1, sizeof *list);
    char(*names)[TL_SCOPE_TEXT] = calloc(laws + 1, sizeof *names);
    tl_keyblock_query query = tl_keyblock_query_default();
    tl_keyblocks found;
    if (!list || !names) {
        free(list);
        free(names);
        return tl_fail_memory(&s->trials.asked->error);
    }
    query.strength = list;
    query.count = read_strengths(s->trials.asked, list, names);
    if (query.count > 0 && tl_model_keyblocks(copy, &query, &found) == TL_OK) {
        for (size_t i = 0; i < found.count; i++)
            if (!(found.blocks[i].safety >= s->result->keyblock_factor)) {
                s->result->keyblock_factor = found.blocks[i].safety;
                s->result->keyblock = found.blocks[i].block;
            }
        tl_keyblocks_free(&found);
    }
    free(list);
    free(names);
    return TL_OK;
}

/* ---------------------------------------------------------------- search ----------------- */

static tl_status list_trial(search *s, const tl_safety_trial *trial)
{
    tl_safety_result *r = s->result;
    if (!tl_grow(&r->trials, &s->capacity, r->trial_count + 1, sizeof *r->trials))
        return tl_fail_memory(&s->trials.asked->error);
    r->trials[r->trial_count++] = *trial;
    return TL_OK;
}

/* Keeps what fails at the least factor that does. */
static tl_status take_trial(void *user, const tl_safety_trial *trial, tl_fall *fall)
{
    search *s = user;
    if (trial->holds && s->bracket.fails <= (int64_t)s->last) {
        tl_fall_free(fall);
    } else {
        tl_fall_free(&s->fall);
        s->fall = *fall;
    }
    return list_trial(s, trial);
}

static int64_t clamped(const search *s, int64_t at)
{
    return at < 0 ? 0 : at > (int64_t)s->last ? (int64_t)s->last : at;
}

static bool make_grid(search *s)
{
    const tl_safety *o = &s->trials.options;
    size_t count = 2;
    for (double f = o->from; f < o->to; f *= 1 + o->resolution)
        count++;
    s->grid = malloc(count * sizeof *s->grid);
    if (!s->grid)
        return false;
    for (double f = o->from; f < o->to; f *= 1 + o->resolution)
        s->grid[s->last++] = f;
    s->grid[s->last] = o->to;
    return true;
}

/* The place on the grid nearest to a factor. */
static int64_t place_of(const search *s, double factor)
{
    int64_t at = 0;
    while (at < (int64_t)s->last && s->grid[at] < factor)
        at++;
    return at;
}

static double factor_at(const void *user, int64_t at)
{
    const search *s = user;
    return s->grid[at];
}

/* Makes trials until neighbours on the grid hold and fail. */
static tl_status narrow(search *s)
{
    const double key = s->result->keyblock_factor;
    const int64_t middle = place_of(s, key > 0 && isfinite(key) ? key : 1);
    const int64_t width = 1 + (int64_t)(BRACKET / s->trials.options.resolution);
    const int64_t last = (int64_t)s->last;
    s->bracket = (tl_bracket){.last = last,
                              .holds = -1,
                              .fails = last + 1,
                              .first = clamped(s, middle - width),
                              .second = clamped(s, middle + width),
                              .width = width};
    return tl_narrow(&s->trials, &s->bracket, factor_at, take_trial, s);
}

/* ---------------------------------------------------------------- result ----------------- */

/* Lists what was small and failed: in the first copy, and at the factor that is told. */
static tl_status take_small(search *s)
{
    tl_safety_blocks *small = &s->result->small;
    const tl_fall *from[] = {&s->loose, &s->fall};
    size_t capacity = 0;
    for (size_t k = 0; k < 2; k++) {
        if (!tl_grow(&small->ids, &capacity, small->count + from[k]->small_count, sizeof *small->ids))
            return tl_fail_memory(&s->trials.asked->error);
        if (from[k]->small_count > 0)
            memcpy(small->ids + small->count, from[k]->small, from[k]->small_count * sizeof *small->ids);
        small->count += from[k]->small_count;
    }
    return TL_OK;
}

static void take_fall(tl_safety_result *r, tl_fall *fall)
{
    r->failing = (tl_safety_blocks){fall->ids, fall->count};
    r->volume = fall->volume;
    r->direction[0] = fall->way.x;
    r->direction[1] = fall->way.y;
    r->direction[2] = fall->way.z;
    r->mode = (int32_t)fall->mode;
    fall->ids = NULL;
}

static void tell(const search *s)
{
    static const char *const goes[] = {"", "slide", "turn", "fall", "yield"};
    tl_safety_result *r = s->result;
    char what[160] = "";
    if (r->failing.count > 0)
        tl_text_print(what, sizeof what, "%zu block%s of %.3g m3 %s%s towards (%.2g, %.2g, %.2g)", r->failing.count,
                      r->failing.count == 1 ? "" : "s", r->volume, goes[r->mode], r->failing.count == 1 ? "s" : "",
                      r->direction[0], r->direction[1], r->direction[2]);
    if (isinf(r->factor))
        tl_text_print(r->message, sizeof r->message, "it holds at %.4g, the largest factor asked for", r->lower);
    else if (r->factor == 0)
        tl_text_print(r->message, sizeof r->message, "no strength holds it: %s", what);
    else if (r->lower == 0)
        tl_text_print(r->message, sizeof r->message, "it fails at %.4g, the least factor asked for: %s", r->upper,
                      what);
    else
        tl_text_print(r->message, sizeof r->message, "factor of safety %.4g (holds at %.4g, fails at %.4g): %s",
                      r->factor, r->lower, r->upper, what);
}

static void finish(search *s, bool never)
{
    tl_safety_result *r = s->result;
    const int64_t last = (int64_t)s->last;
    r->lower = !never && s->bracket.holds >= 0 ? s->grid[s->bracket.holds] : 0;
    r->upper = never ? s->trials.options.from : s->bracket.fails <= last ? s->grid[s->bracket.fails] : INFINITY;
    r->factor = never ? 0 : isinf(r->upper) ? INFINITY : r->lower > 0 ? sqrt(r->lower * r->upper) : r->upper;
    if (never || s->bracket.fails <= last)
        take_fall(r, never ? &s->loose : &s->fall);
    r->undecided = (int32_t)s->trials.undecided;
    r->cycles = s->trials.cycles;
    r->wall = tl_clock() - s->trials.began;
    tell(s);
}

void tl_safety_free(tl_safety_result *result)
{
    free(result->failing.ids);
    free(result->small.ids);
    free(result->trials);
    *result = (tl_safety_result){.factor = NAN};
}

tl_status tl_model_factor_of_safety(tl_model *m, const tl_safety *given, tl_safety_result *result)
{
    search s = {.result = result, .fall = {.ids = NULL}};
    *result = (tl_safety_result){.keyblock_factor = NAN};
    tl_status status = tl_trials_begin(&s.trials, "factor_of_safety", m, given, &s.loose);
    if (status == TL_OK)
        status = ask_keyblocks(&s);
    if (status == TL_OK && !make_grid(&s))
        status = tl_fail_memory(&m->error);
    const bool never = s.loose.count > 0;
    if (status == TL_OK && !never)
        status = narrow(&s);
    if (status == TL_OK)
        status = take_small(&s);
    if (status == TL_OK)
        finish(&s, never);
    else
        tl_safety_free(result);
    tl_fall_free(&s.fall);
    tl_fall_free(&s.loose);
    tl_trials_end(&s.trials);
    free(s.grid);
    return status;
}
