/* relax.c - a run to rest, by steps that are made for nothing else.
 *
 * While `relaxing` is set, damping, time step and masses of the steps are those of a relaxation (settle.c), whatever
 * the user has set: that stays and is not touched. Time stands still: functions of time keep their values. A save made
 * meanwhile holds both, and the next call goes on where it was. */
#include "base/columns.h"
#include "contact/body_contacts.h"
#include "cycle/cycle_data.h"
#include "cycle/meshes.h"
#include "cycle/prepare.h"
#include "cycle/settle.h"
#include "cycle/solve.h"
#include "model/options.h"
#include "model/rows.h"
#include "segment/segments.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* What to do with what is driven. */
static const char *stop_first(const tl_model *m)
{
    return tl_words(m, "stop it first, or use model:solve", "stop it first, or use tl_model_solve()");
}

/* Refuses gridpoints that are held and have a velocity. */
static tl_status check_driven_points(tl_model *m)
{
    const tl_gridpoints *p = m->zones ? &m->zones->points : NULL;
    for (uint32_t row = 0; p && row < p->table.rows; row++) {
        const tl_vec3 v = tl_columns_get(p->v, row);
        const double speed = tl_v3_norm(tl_v3_sub(v, tl_free_part(v, p->fixed[row])));
        const tl_body_mesh *mesh = &m->zones->mesh[p->mesh[row]];
        if (speed > 0)
            return tl_fail(&m->error, TL_E_STATE,
                           "relax: gridpoint %u of block %u is driven at %.3g m/s, so there is nothing to come to "
                           "rest: %s",
                           row - mesh->point_begin, mesh->body, speed, stop_first(m));
    }
    return TL_OK;
}

/* Refuses a model that something drives: there is no rest then. */
static tl_status check_driven(tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    if (!tl_drives_evaluate(m, m->time))
        return tl_fail(&m->error, TL_E_CANCELLED, "relax: a drive's function failed");
    for (uint32_t body = 0; body < b->table.rows; body++) {
        const tl_drive_record *drive = b->drive[body] ? &m->drives[b->drive[body] - 1] : NULL;
        const unsigned fixed = b->fixed[body];
        tl_vec3 v = drive ? drive->velocity : tl_v3_sub(b->v[body], tl_free_part(b->v[body], fixed));
        tl_vec3 w = drive ? drive->angular_velocity : fixed & TL_FIX_ROTATION ? b->w[body] : tl_v3(0, 0, 0);
        const double speed = tl_v3_norm(v), turn = tl_v3_norm(w);
        if (speed > 0 || turn > 0)
            return tl_fail(&m->error, TL_E_STATE,
                           "relax: block %u is driven at %.3g %s, so there is nothing to come to rest: %s", b->id[body],
                           speed > 0 ? speed : turn, speed > 0 ? "m/s" : "rad/s", stop_first(m));
    }
    return check_driven_points(m);
}

/* ---------------------------------------------------------------- what moved before ------- */

/* What a relaxation that makes no step gives back. */
typedef struct motion {
    tl_vec3 *v, *w; /* [bodies]; NULL: a relaxation that goes on */
    tl_vec3 *point; /* [gridpoints] */
    double dt, step;
} motion;

static size_t points_of(const tl_model *m)
{
    return m->zones ? m->zones->points.table.rows : 0;
}

static tl_status keep_motion(tl_model *m, motion *kept)
{
    const tl_bodies *b = &m->bodies;
    const size_t bodies = b->table.rows;
    kept->v = malloc((bodies + 1) * sizeof *kept->v);
    kept->w = malloc((bodies + 1) * sizeof *kept->w);
    kept->point = malloc((points_of(m) + 1) * sizeof *kept->point);
    if (!kept->v || !kept->w || !kept->point)
        return tl_fail_memory(&m->error);
    for (size_t row = 0; row < points_of(m); row++)
        kept->point[row] = tl_columns_get(m->zones->points.v, row);
    if (bodies > 0) {
        memcpy(kept->v, b->v, bodies * sizeof *kept->v);
        memcpy(kept->w, b->w, bodies * sizeof *kept->w);
    }
    kept->dt = m->dt;
    kept->step = m->cycle->dt;
    return TL_OK;
}

/* A relaxation that goes on is left as it was. */
static void give_back(tl_model *m, const motion *kept)
{
    const size_t bodies = m->bodies.table.rows;
    if (!kept->v)
        return;
    tl_settle_end(m);
    if (bodies > 0) {
        memcpy(m->bodies.v, kept->v, bodies * sizeof *kept->v);
        memcpy(m->bodies.w, kept->w, bodies * sizeof *kept->w);
    }
    for (size_t row = 0; row < points_of(m); row++)
        tl_columns_put(m->zones->points.v, row, kept->point[row]);
    m->dt = kept->dt;
    m->cycle->dt = kept->step;
}

static tl_status begin(tl_model *m, int64_t load_steps, motion *kept)
{
    if (m->running || m->reading)
        return tl_fail(&m->error, TL_E_STATE, "relax cannot be called from a function that a run has called");
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = check_driven(m);
    if (status != TL_OK)
        return status;
    if (!TL_COLUMN_NEED(&m->bodies.table, &m->bodies, fall, TL_COLUMN_STEP) ||
        ((tl_model_deforms(m) || m->cycle->slides_on) &&
         !TL_COLUMN_NEED(&m->bodies.table, &m->bodies, going, TL_COLUMN_STEP)))
        return tl_fail_memory(&m->error);
    const double share = m->cycle->settling.share;
    if (m->relaxing && share > 0 && share <= 1)
        return TL_OK; /* a save that was made meanwhile */
    status = keep_motion(m, kept);
    if (status != TL_OK)
        return status;
    tl_settle_end(m); /* from rest */
    tl_settle_begin(m, load_steps);
    return TL_OK;
}

/* ---------------------------------------------------------------- what the end means ----- */

/* Contacts and segments on a body that press, and those of them whose points all slip. */
typedef struct pressing {
    size_t all, slipping;
} pressing;

static void add_contacts(const tl_model *m, uint32_t body, pressing *sum)
{
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        const tl_sides on = tl_contact_bodies(m, i);
        if ((on.a != body && on.b != body) || !(tl_v3_norm2(c->force[i]) > 0))
            continue;
        bool slips = true;
        for (size_t k = 0; k < c->point_count[i]; k++)
            slips = slips && (m->detect->points.flags[tl_point_row(c, i, k)] & TL_POINT_SLIPPING);
        sum->all++;
        sum->slipping += slips;
    }
}

static void add_segments(const tl_model *m, uint32_t body, pressing *sum)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t row = 0; s && row < s->table.table.rows; row++) {
        const tl_segment *of = &s->table.of[row];
        if (!(s->table.bears[row] > 0) || !tl_segment_touches(m, of, body))
            continue;
        bool slips = true;
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
            slips = slips && (s->points.flags[tl_segment_point_row(row, k)] & TL_POINT_SLIPPING);
        sum->all++;
        sum->slipping += slips;
    }
}

/* Tolerance: share of the zones of a body that yield, from which on that is why it is slow. */
#define MANY_YIELD 0.1

/* What keeps the body of a block from rest. */
static const char *why_slow(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    pressing on = {0, 0};
    add_contacts(m, body, &on);
    add_segments(m, body, &on);
    const bool held = mesh && tl_mesh_whole_of(m, mesh).borne > 0;
    return on.all == 0 && !held                              ? "nothing bears it: it falls"
           : on.all > 0 && on.slipping == on.all             ? "it slides on all that bears it"
           : mesh && tl_mesh_yielding(m, mesh) >= MANY_YIELD ? "its zones yield"
           : on.slipping > 0                                 ? "it slides on some of what bears it"
                                                             : "what bears it is soft against what else there is";
}

static void tell_slow(const tl_model *m, const tl_relax *relax, tl_relax_result *r)
{
    const uint32_t row = tl_block_row_quiet(m, r->run.worst);
    const double of[] = {r->run.ratio, r->run.ratio_maximum, r->run.ratio_local}; /* by tl_ratio_measure */
    if (row == TL_NO_ROW)
        tl_text_print(r->message, sizeof r->message, "not at rest after %lld steps", (long long)r->run.cycles);
    else
        tl_text_print(r->message, sizeof r->message,
                      "neither at rest nor failing after %lld steps (ratio %.3g, asked for %.3g): block %u of %.3g m3 "
                      "is farthest from rest; %s",
                      (long long)r->run.cycles, of[relax->measure], relax->ratio, r->run.worst, m->blocks.volume[row],
                      why_slow(m, m->blocks.body[row]));
}

static void tell_failure(const tl_model *m, tl_relax_result *r)
{
    const struct tl_cycle *c = m->cycle;
    char strained[80] = "";
    if (c->fails_strained)
        tl_text_print(strained, sizeof strained, ", which is strained on and on at (%.4g, %.4g, %.4g)", c->fails_at.x,
                      c->fails_at.y, c->fails_at.z);
    tl_text_print(r->message, sizeof r->message,
                  "fails: %zu blocks of %.3g m3, block %u first%s, towards (%.2g, %.2g, %.2g)", r->failing, r->volume,
                  r->run.failing, strained, c->fails_way.x, c->fails_way.y, c->fails_way.z);
}

static void tell(tl_model *m, const tl_relax *relax, tl_relax_result *r)
{
    const struct tl_cycle *c = m->cycle;
    const tl_solve_reason reason = r->run.reason;
    if (reason == TL_SOLVE_FAILURE || reason == TL_SOLVE_OVERLAP) {
        r->failing = c->fails_count;
        r->volume = c->fails_volume;
        r->direction[0] = c->fails_way.x;
        r->direction[1] = c->fails_way.y;
        r->direction[2] = c->fails_way.z;
    }
    switch (reason) {
    case TL_SOLVE_REST:
        tl_text_print(r->message, sizeof r->message, "at rest after %lld steps", (long long)r->run.cycles);
        break;
    case TL_SOLVE_FAILURE: tell_failure(m, r); break;
    case TL_SOLVE_OVERLAP:
        tl_text_print(r->message, sizeof r->message, "blocks that were made overlapping push the model apart");
        break;
    case TL_SOLVE_CYCLES: tell_slow(m, relax, r); break;
    default: tl_text_print(r->message, sizeof r->message, "ended before it was at rest"); break;
    }
}

static tl_status run(tl_model *m, const tl_relax *relax, tl_relax_result *result)
{
    tl_solve solve = tl_solve_default();
    solve.measure = relax->measure;
    solve.stop_at_failure = relax->stop_at_failure;
    solve.every = relax->every;
    solve.each = relax->each;
    solve.progress = relax->progress;
    solve.stop = relax->stop;
    solve.user = relax->user;
    solve.between = relax->between;
    solve.ratio = relax->ratio;
    solve.max_cycles = relax->max_cycles;
    const tl_status status = tl_solve_run(m, &solve, &result->run);
    if (result->run.reason == TL_SOLVE_RATIO)
        result->run.reason = TL_SOLVE_REST;
    if (status == TL_OK)
        tell(m, relax, result);
    return status;
}

tl_status tl_model_relax(tl_model *m, const tl_relax *given, tl_relax_result *wanted)
{
    tl_relax relax;
    tl_relax_result unread, *const result = wanted ? wanted : &unread;
    tl_status status = TL_OPTIONS_READ(tl_relax, given, &relax, &m->error);
    if (status == TL_OK && !(relax.ratio > 0 && relax.ratio <= 1))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "relax: ratio = %g is outside (0, 1]", relax.ratio);
    if (status == TL_OK && !(relax.load_steps >= 1 && relax.load_steps <= 10000))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "relax: load_steps = %lld is outside [1, 10000]",
                         (long long)relax.load_steps);
    if (status == TL_OK)
        status = tl_check_choice(&m->error, "relax: measure", relax.measure, TL_RATIO_LOCAL);
    *result = (tl_relax_result){.run = {.reason = TL_SOLVE_CYCLES}};
    if (status != TL_OK)
        return status;
    motion kept = {.v = NULL};
    status = begin(m, relax.load_steps, &kept);
    if (status == TL_OK) {
        status = run(m, &relax, result);
        if (status != TL_OK && result->run.cycles == 0)
            give_back(m, &kept);
        else
            tl_settle_end(m);
    }
    free(kept.v);
    free(kept.w);
    free(kept.point);
    return status;
}

size_t tl_model_failing(const tl_model *m, tl_id *ids, size_t most)
{
    const size_t count = m->cycle ? m->cycle->fails_count : 0;
    for (size_t i = 0; i < count && i < most; i++)
        ids[i] = m->cycle->fails[i];
    return count;
}
