/* map.c - a factor of safety for every block: the factor goes up, and what fails goes before it goes on.
 *
 * From one failure to the next the largest factor of the grid that holds is looked for by steps that double, and then
 * halve: a trial that holds holds at any lower factor. What fails at the least factor that does gets that factor, and
 * is deleted, or held where it was, in the last trial that holds. The rest comes to rest again with high strengths, and
 * the same factor is tried once more: what then fails was held by what has gone. */
#include "base/clock.h"
#include "base/error.h"
#include "cycle/meshes.h"
#include "safety/narrow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

/* Limit: factors of a grid. */
#define MOST_FACTORS 100000

typedef struct mapping {
    tl_trials trials;
    tl_safety_map *map;
    int64_t last; /* of the grid */
    size_t point_capacity, gone;
    double volume; /* of what has gone */
    tl_fall fall;  /* at the least factor that fails */
} mapping;

static double factor_at(const void *user, int64_t at)
{
    const mapping *p = user;
    const tl_safety *o = &p->trials.options;
    return at < p->last ? o->from + (double)at * o->step : o->to;
}

/* Lists the blocks that can move. */
static tl_status list_blocks(mapping *p, const tl_model *m)
{
    tl_safety_map *map = p->map;
    const size_t rows = m->blocks.table.rows;
    map->ids = malloc((rows + 1) * sizeof *map->ids);
    map->factor = malloc((rows + 1) * sizeof *map->factor);
    if (!map->ids || !map->factor)
        return tl_fail_memory(&p->trials.asked->error);
    for (uint32_t row = 0; row < rows; row++)
        if (tl_body_is_free(m, m->blocks.body[row])) {
            map->ids[map->count] = m->blocks.id[row];
            map->factor[map->count++] = INFINITY;
        }
    return TL_OK;
}

/* Notes what fails at a factor. */
static tl_status note(mapping *p, double factor, const tl_fall *fall)
{
    tl_safety_map *map = p->map;
    for (size_t i = 0; i < fall->count; i++)
        for (size_t k = 0; k < map->count; k++)
            if (map->ids[k] == fall->ids[i])
                map->factor[k] = factor;
    p->gone += fall->count;
    p->volume += fall->volume;
    tl_safety_point *last = map->point_count ? &map->curve[map->point_count - 1] : NULL;
    if (!last || last->factor != factor) {
        if (!tl_grow(&map->curve, &p->point_capacity, map->point_count + 1, sizeof *map->curve))
            return tl_fail_memory(&p->trials.asked->error);
        last = &map->curve[map->point_count++];
    }
    *last = (tl_safety_point){factor, p->volume, p->gone};
    return TL_OK;
}

/* Takes what fails out of the copy, and brings the rest to rest; as long as something falls then, it goes as well.
 * false: nothing is free any more. */
static tl_status take_out(mapping *p, double factor, tl_fall *fall, bool *left)
{
    tl_model *base = tl_trials_go_on(&p->trials);
    tl_status status = TL_OK;
    *left = true;
    while (status == TL_OK && fall->count > 0 && *left) {
        status = note(p, factor, fall);
        if (status == TL_OK) {
            status = p->trials.options.hold ? tl_blocks_fix(base, fall->ids, fall->count, TL_FIX_ALL)
                                            : tl_blocks_delete(base, fall->ids, fall->count);
            if (status != TL_OK)
                status = tl_fail(&p->trials.asked->error, status, "%s: %s", p->trials.what, tl_model_error(base)->text);
        }
        tl_fall_free(fall);
        *left = p->gone < p->map->count;
        if (status == TL_OK && *left)
            status = tl_trials_rest(&p->trials, fall);
    }
    tl_fall_free(fall);
    return status;
}

/* Keeps what fails at the least factor that does. */
static tl_status take_trial(void *user, const tl_safety_trial *trial, tl_fall *fall)
{
    mapping *p = user;
    if (trial->holds) {
        tl_fall_free(fall);
    } else {
        tl_fall_free(&p->fall);
        p->fall = *fall;
    }
    return TL_OK;
}

/* Finds the least factor from `at` on that fails; `*at` is beyond the last when all hold. */
static tl_status next_failure(mapping *p, int64_t *at)
{
    tl_bracket b = {.lowest = *at,
                    .last = p->last,
                    .holds = *at - 1,
                    .fails = p->last + 1,
                    .first = *at,
                    .second = *at,
                    .width = 1};
    tl_fall_free(&p->fall);
    const tl_status status = tl_narrow(&p->trials, &b, factor_at, take_trial, p);
    *at = b.fails;
    return status;
}

void tl_safety_map_free(tl_safety_map *map)
{
    free(map->ids);
    free(map->factor);
    free(map->curve);
    *map = (tl_safety_map){.ids = NULL};
}

static tl_status go_up(mapping *p)
{
    const tl_safety *o = &p->trials.options;
    bool left = true;
    tl_status status = TL_OK;
    p->last = (int64_t)ceil((o->to - o->from) / o->step * (1 - 1e-12)); /* Constant: rounding of the quotient */
    if (p->fall.count > 0)
        status = take_out(p, 0, &p->fall, &left);
    for (int64_t at = 0; status == TL_OK && left && at <= p->last;) {
        status = next_failure(p, &at);
        if (status == TL_OK && at <= p->last)
            status = take_out(p, factor_at(p, at), &p->fall, &left);
    }
    return status;
}

tl_status tl_model_safety_map(tl_model *m, const tl_safety *given, tl_safety_map *map)
{
    mapping p = {.map = map};
    *map = (tl_safety_map){.ids = NULL};
    tl_status status = tl_trials_begin(&p.trials, "safety_map", m, given, &p.fall);
    const tl_safety *o = &p.trials.options;
    if (status == TL_OK && (o->to - o->from) / o->step > MOST_FACTORS)
        status = tl_fail(&m->error, TL_E_ARGUMENT, "safety_map: step = %g makes more than %d factors from %g to %g",
                         o->step, MOST_FACTORS, o->from, o->to);
    if (status == TL_OK)
        status = list_blocks(&p, m);
    if (status == TL_OK)
        status = go_up(&p);
    map->undecided = (int32_t)p.trials.undecided;
    map->cycles = p.trials.cycles;
    map->wall = tl_clock() - p.trials.began;
    if (status != TL_OK)
        tl_safety_map_free(map);
    tl_fall_free(&p.fall);
    tl_trials_end(&p.trials);
    return status;
}
