/* damping.c - the damping plugin: chosen by name, called on batches of bodies.
 *
 * The plugin's states are numbers of the model, kept here and given to it. Where it asks for them, so are the forces of
 * the step before: a change of damping begins with those of the last step. gather.c sums the kinetic energy. */
#include "cycle/damping.h"

#include "base/parallel.h"
#include "base/params.h"
#include "contact/contacts.h"
#include "cycle/contact_beta.h"
#include "cycle/contact_forces.h"
#include "cycle/gridpoint.h"
#include "cycle/undo.h"
#include "plugin/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Gridpoints that a thread takes at a time: a multiple of TL_LANES. */
#define POINT_CHUNK 256

/* Forces of the last step are those before the next. */
static void note_forces(tl_bodies *b, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++) {
        b->force_before[i] = b->force[i];
        b->moment_before[i] = b->moment[i];
    }
}

/* A plugin's beta must be one that the step can follow. */
static tl_status check_contact(tl_model *m, const tl_kind *kind, const void *self)
{
    const tl_damping_ops *ops = kind->ops;
    double beta = 0;
    if (ops->contact)
        ops->contact(self, &beta);
    if (beta >= 0 && isfinite(beta))
        return TL_OK;
    return tl_fail(&m->error, TL_E_PLUGIN, "damping '%.40s' gives contacts beta = %g s, which must be finite and >= 0",
                   kind->name, beta);
}

tl_status tl_damping_make(tl_model *m, const tl_kind *kind, const tl_args *args, const void *from)
{
    const tl_damping_ops *ops = kind->ops;
    void *params = calloc(1, kind->params_size + 1), *self = params;
    double *state = calloc(kind->state_count + 1u, sizeof *state);
    tl_bodies *b = &m->bodies;
    bool enough = params && state;
    if (enough && ops->before)
        enough = TL_COLUMN_NEED(&b->table, b, moment_before, TL_COLUMN_STEP) &&
                 TL_COLUMN_NEED(&b->table, b, force_before, TL_COLUMN_STEP);
    if (!enough) {
        free(params);
        free(state);
        return tl_fail_memory(&m->error);
    }
    if (from)
        memcpy(params, from, kind->params_size);
    char context[64];
    snprintf(context, sizeof context, "damping '%.40s'", kind->name);
    tl_report report = {.size = sizeof report};
    tl_status status = tl_args_read(kind->params, kind->param_count, kind->param_stride, args, from != NULL, params,
                                    context, &m->error);
    if (status == TL_OK)
        status = tl_args_proportion(kind->params, kind->param_count, kind->param_stride, args, context, &m->error);
    if (status == TL_OK && ops->create) {
        tl_enter(kind, "create");
        status = ops->create(params, &self, &report);
        tl_leave();
        if (status != TL_OK)
            tl_fail(&m->error, status, "%s of plugin '%s': %s", context, tl_plugin_id(kind),
                    tl_report_text(&report, status));
    }
    if (status == TL_OK && (status = check_contact(m, kind, self)) != TL_OK && ops->destroy)
        ops->destroy(self);
    if (status != TL_OK) {
        free(params);
        free(state);
        return status;
    }
    for (uint32_t k = 0; k < kind->state_count; k++)
        state[k] = tl_kind_state(kind, k)->initial;
    tl_damping_clear(m);
    m->damping = kind;
    m->damping_params = params;
    m->damping_self = self;
    m->damping_state = state;
    return TL_OK;
}

tl_status tl_model_damping(tl_model *m, const char *damping, const tl_args *args)
{
    tl_status status = tl_model_may_set(m, "set damping");
    if (status != TL_OK)
        return status;
    const tl_kind *kind = tl_plugin_find(TL_KIND_DAMPING, damping);
    if (!kind)
        return tl_kind_unknown(&m->error, TL_KIND_DAMPING, damping);
    const tl_damping_ops *ops = kind->ops;
    const double beta = tl_contact_beta(m);
    status = tl_damping_make(m, kind, args, NULL);
    if (status != TL_OK)
        return status;
    if (tl_contact_beta(m) != beta)
        tl_contact_beta_changes(m);
    if (ops->before)
        note_forces(&m->bodies, 0, m->bodies.table.rows);
    if (m->cycle)
        m->cycle->dt = 0; /* the stable step depends on the damping */
    tl_undo_by_hand(m);
    return TL_OK;
}

typedef struct damping_job {
    tl_model *m;
    double dt;
    double **state;
} damping_job;

/* Bodies as a damping plugin sees them: columns, whole lanes. */
typedef struct body_columns {
    _Alignas(TL_ALIGN) double velocity[3][TL_BODY_CHUNK];
    double angular_velocity[3][TL_BODY_CHUNK];
    double force[3][TL_BODY_CHUNK], moment[3][TL_BODY_CHUNK];
    double force_before[3][TL_BODY_CHUNK], moment_before[3][TL_BODY_CHUNK];
    double mass[TL_BODY_CHUNK], inertia[TL_BODY_CHUNK];
    double moving_mass[TL_BODY_CHUNK], moving_inertia[TL_BODY_CHUNK]; /* only where they are not the body's own */
} body_columns;

TL_INLINE double mean_of(tl_vec3 moments)
{
    return (moments.x + moments.y + moments.z) / 3;
}

/* The vectors of `count` bodies from `first` on as columns; 0 beyond them, up to `lanes`. */
TL_INLINE void put(double (*restrict columns)[TL_BODY_CHUNK], const tl_vec3 *restrict first, size_t count, size_t lanes)
{
    for (size_t i = 0; i < count; i++) {
        columns[0][i] = first[i].x;
        columns[1][i] = first[i].y;
        columns[2][i] = first[i].z;
    }
    for (size_t i = count; i < lanes; i++)
        columns[0][i] = columns[1][i] = columns[2][i] = 0;
}

TL_VECTORIZED static void fill_columns(body_columns *s, const tl_bodies *b, size_t begin, size_t count, size_t lanes)
{
    put(s->velocity, b->v + begin, count, lanes);
    put(s->angular_velocity, b->w + begin, count, lanes);
    put(s->force, b->force + begin, count, lanes);
    put(s->moment, b->moment + begin, count, lanes);
    for (size_t i = 0; i < count; i++) {
        s->mass[i] = b->mass[begin + i];
        s->inertia[i] = mean_of(b->moments[begin + i]);
    }
    for (size_t i = count; i < lanes; i++)
        s->mass[i] = s->inertia[i] = 1;
}

/* Whether the step moves a body by another mass or other moments than its own. */
static bool moves_by_others(const tl_model *m)
{
    return tl_inertia_scaled(m->cycle) || m->config.rotation == TL_ROTATION_PAPER;
}

static void fill_moving(body_columns *s, const tl_model *m, size_t begin, size_t count, size_t lanes)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t body = (uint32_t)(begin + i);
        s->moving_mass[i] = s->mass[i] * tl_inertia_scale(m->cycle, body);
        s->moving_inertia[i] = mean_of(tl_moments_of(m, body)) * tl_turn_scale(m->cycle, body);
    }
    for (size_t i = count; i < lanes; i++)
        s->moving_mass[i] = s->moving_inertia[i] = 1;
}

/* What the damping gave must be numbers: one that is not would spread over the model. */
static void check_numbers(tl_model *m, size_t begin, size_t end, size_t chunk)
{
    struct tl_cycle *c = m->cycle;
    for (size_t body = begin; body < end; body++) {
        double sum = c->alpha[body];
        for (int k = 0; k < 3; k++)
            sum += fabs(c->damping_force[k][body]) + fabs(c->damping_moment[k][body]);
        if (isfinite(sum))
            continue;
        char text[120];
        snprintf(text, sizeof text, "what it gives block %u is no finite number (a force, a moment or alpha)",
                 m->bodies.id[body]);
        tl_failure_note(&c->failure, chunk, TL_E_NUMERIC, body, text);
        return;
    }
}

static bool call_plugin(tl_model *m, const tl_damping_batch *batch, size_t chunk)
{
    const tl_damping_ops *ops = m->damping->ops;
    tl_report report = {.size = sizeof report};
    tl_enter(m->damping, "update");
    const tl_status status = ops->update(m->damping_self, batch, &report);
    tl_leave();
    if (status != TL_OK)
        tl_failure_note(&m->cycle->failure, chunk, status, 0, tl_report_text(&report, status));
    return status == TL_OK;
}

static void damp_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const damping_job *job = user;
    tl_model *m = job->m;
    struct tl_cycle *c = m->cycle;
    tl_bodies *b = &m->bodies;
    const tl_damping_ops *ops = m->damping->ops;
    size_t last = end < b->table.rows ? end : b->table.rows;
    body_columns s;
    fill_columns(&s, b, begin, last - begin, end - begin);
    if (ops->before) {
        put(s.force_before, b->force_before + begin, last - begin, end - begin);
        put(s.moment_before, b->moment_before + begin, last - begin, end - begin);
    }
    const bool others = moves_by_others(m);
    if (others)
        fill_moving(&s, m, begin, last - begin, end - begin);
    tl_damping_batch batch = {.size = sizeof batch,
                              .count = (uint32_t)(end - begin),
                              .dt = job->dt,
                              .mass = s.mass,
                              .inertia = s.inertia,
                              .alpha = c->alpha + begin,
                              .state = job->state,
                              .moving_mass = others ? s.moving_mass : s.mass,
                              .moving_inertia = others ? s.moving_inertia : s.inertia};
    memset(batch.alpha, 0, (end - begin) * sizeof *batch.alpha);
    for (int k = 0; k < 3; k++) {
        batch.velocity[k] = s.velocity[k];
        batch.angular_velocity[k] = s.angular_velocity[k];
        batch.force[k] = s.force[k];
        batch.moment[k] = s.moment[k];
        batch.force_before[k] = ops->before ? s.force_before[k] : NULL;
        batch.moment_before[k] = ops->before ? s.moment_before[k] : NULL;
        batch.damping_force[k] = c->damping_force[k] + begin;
        batch.damping_moment[k] = c->damping_moment[k] + begin;
        memset(batch.damping_force[k], 0, (end - begin) * sizeof *batch.damping_force[k]);
        memset(batch.damping_moment[k], 0, (end - begin) * sizeof *batch.damping_moment[k]);
    }
    if (call_plugin(m, &batch, chunk))
        check_numbers(m, begin, last, chunk);
    if (ops->before)
        note_forces(b, begin, last);
}

/* Gridpoints have neither moment nor turn. */
static void damp_points(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const damping_job *job = user;
    tl_gridpoints *p = &job->m->zones->points;
    double none[POINT_CHUNK] = {0}, one[POINT_CHUNK], scaled[POINT_CHUNK], out[3][POINT_CHUNK] = {{0}};
    const bool scales = tl_inertia_scaled(job->m->cycle);
    for (size_t i = 0; i < end - begin; i++) {
        one[i] = 1;
        scaled[i] = p->mass[begin + i] * tl_gridpoint_scale(job->m, begin + i);
        p->alpha[begin + i] = 0;
    }
    tl_damping_batch batch = {.size = sizeof batch,
                              .count = (uint32_t)(end - begin),
                              .dt = job->dt,
                              .mass = p->mass + begin,
                              .inertia = one,
                              .alpha = p->alpha + begin,
                              .state = job->state,
                              .moving_mass = scales ? scaled : p->mass + begin,
                              .moving_inertia = one};
    for (int k = 0; k < 3; k++) {
        batch.velocity[k] = p->v[k] + begin;
        batch.angular_velocity[k] = batch.moment[k] = none;
        batch.force[k] = p->force[k] + begin;
        batch.force_before[k] = p->force_before[k] ? p->force_before[k] + begin : NULL;
        batch.moment_before[k] = none;
        batch.damping_force[k] = p->damping[k] + begin;
        batch.damping_moment[k] = out[k];
        memset(batch.damping_force[k], 0, (end - begin) * sizeof *batch.damping_force[k]);
    }
    call_plugin(job->m, &batch, chunk);
    for (int k = 0; k < 3 && p->force_before[k]; k++)
        memcpy(p->force_before[k] + begin, p->force[k] + begin, (end - begin) * sizeof *p->force[k]);
}

static tl_status check_states(const tl_model *m, tl_error *error)
{
    for (uint32_t k = 0; k < m->damping->state_count && k < TL_STATE_COLUMNS; k++)
        if (!isfinite(m->damping_state[k]))
            return tl_fail(error, TL_E_NUMERIC, "its state '%s' is no finite number",
                           tl_kind_state(m->damping, k)->name);
    return TL_OK;
}

tl_status tl_damping_apply(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    double kinetic = c->sums.kinetic;
    tl_damping_totals totals = {.size = sizeof totals,
                                .dt = dt,
                                .kinetic = kinetic,
                                .kinetic_rate = dt > 0 ? (kinetic - c->kinetic_before) / dt : 0,
                                .power_unit = 2 * c->sums.damped,
                                .power = c->sums.power};
    if (!m->damping || !(dt > 0)) /* a step of 0: nothing moves */
        return TL_OK;
    const tl_damping_ops *ops = m->damping->ops;
    double *state[TL_STATE_COLUMNS];
    for (uint32_t k = 0; k < m->damping->state_count && k < TL_STATE_COLUMNS; k++)
        state[k] = &m->damping_state[k];
    tl_report report = {.size = sizeof report};
    tl_enter(m->damping, "begin");
    tl_status status = ops->begin ? ops->begin(m->damping_self, &totals, state, &report) : TL_OK;
    tl_leave();
    if (status == TL_OK) {
        damping_job job = {m, dt, state};
        tl_parallel_for(m->pool, c->table.rows, TL_BODY_CHUNK, damp_range, &job);
        if (tl_model_deforms(m))
            tl_parallel_for(m->pool, m->zones->points.table.rows, POINT_CHUNK, damp_points, &job);
        status = c->failure.error.status;
        if (status == TL_OK)
            tl_contacts_damp(m);
        if (status == TL_OK)
            status = check_states(m, &c->failure.error);
    } else {
        tl_fail(&c->failure.error, status, "%s", tl_report_text(&report, status));
    }
    if (status == TL_OK)
        return TL_OK;
    c->failure.error.status = TL_OK;
    return tl_fail(&m->error, status, "cycle %lld, damping '%s' of plugin '%s': %s", (long long)m->cycles + 1,
                   m->damping->name, tl_plugin_id(m->damping), c->failure.error.text);
}
