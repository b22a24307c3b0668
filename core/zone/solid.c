/* solid.c - a solid and its properties. */
#include "zone/solid.h"

#include "base/inside.h"
#include "base/params.h"
#include "base/solid_columns.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The tables of a solid: where the k-th parameter is one, its rows in the params struct. */
static tl_points *table_of(const tl_kind *kind, uint32_t k, void *params)
{
    const tl_param *p = &kind->params[k];
    return p->type == TL_PARAM_POINTS ? (tl_points *)(void *)((char *)params + p->offset) : NULL;
}

/* A table goes from small to large. */
static tl_status check_rows(const tl_param *p, const tl_points *table, const char *context, tl_error *error)
{
    for (size_t k = 1; k < table->count; k++)
        if (!(table->at[k].x > table->at[k - 1].x))
            return tl_fail(error, TL_E_ARGUMENT,
                           "%s: %s, row %zu: its first number, %g, must be larger than that of the row before, %g",
                           context, p->name, k + 1, table->at[k].x, table->at[k - 1].x);
    return TL_OK;
}

/* Takes copies of the tables, which are the caller's so far. */
static tl_status keep_tables(tl_solid *solid, const char *context, tl_error *error)
{
    const tl_kind *kind = solid->kind;
    size_t count = 0;
    for (uint32_t k = 0; k < kind->param_count; k++) {
        const tl_points *table = table_of(kind, k, solid->params);
        tl_status status = table ? check_rows(&kind->params[k], table, context, error) : TL_OK;
        if (status != TL_OK)
            return status;
        count += table ? table->count : 0;
    }
    solid->rows = count ? malloc(count * sizeof *solid->rows) : NULL;
    if (count && !solid->rows)
        return tl_fail_memory(error);
    tl_vec3 *to = solid->rows;
    for (uint32_t k = 0; k < kind->param_count; k++) {
        tl_points *table = table_of(kind, k, solid->params);
        if (!table || table->count == 0)
            continue;
        memcpy(to, table->at, table->count * sizeof *to);
        table->at = to;
        to += table->count;
    }
    return TL_OK;
}

static tl_status create(tl_solid *solid, const char *context, tl_error *error)
{
    const tl_kind *kind = solid->kind;
    const tl_solid_ops *ops = kind->ops;
    tl_report report = {.size = sizeof report};
    void *self = solid->params;
    if (ops->create) {
        tl_enter(kind, "create");
        tl_status status = ops->create(solid->params, &self, &report);
        tl_leave();
        if (status != TL_OK)
            return tl_fail(error, status, "%s of plugin '%s': %s", context, tl_plugin_id(kind),
                           tl_report_text(&report, status));
    }
    solid->self = self;
    return TL_OK;
}

/* Moduli of which the time step follows. */
static tl_status ask_moduli(tl_solid *solid, const char *context, tl_error *error)
{
    const tl_solid_ops *ops = solid->kind->ops;
    tl_enter(solid->kind, "moduli");
    ops->moduli(solid->self, &solid->constrained, &solid->shear);
    tl_leave();
    if (solid->constrained > 0 && solid->shear > 0 && isfinite(solid->constrained) && isfinite(solid->shear))
        return TL_OK;
    return tl_fail(error, TL_E_PLUGIN,
                   "%s of plugin '%s': its moduli() gives %g Pa for K + 4 G / 3 and %g Pa for G; both must be finite "
                   "and above 0",
                   context, tl_plugin_id(solid->kind), solid->constrained, solid->shear);
}

tl_status tl_solid_make(const tl_kind *kind, const tl_args *args, const tl_solid *from, const char *context,
                        tl_error *error, tl_solid *out)
{
    *out = (tl_solid){.kind = kind, .params = calloc(1, kind->params_size + 1)};
    if (!out->params)
        return tl_fail_memory(error);
    if (from)
        memcpy(out->params, from->params, kind->params_size);
    tl_status status = tl_args_read(kind->params, kind->param_count, kind->param_stride, args, from != NULL,
                                    out->params, context, error);
    if (status == TL_OK)
        status = tl_args_proportion(kind->params, kind->param_count, kind->param_stride, args, context, error);
    if (status == TL_OK)
        status = keep_tables(out, context, error);
    if (status == TL_OK)
        status = create(out, context, error);
    if (status == TL_OK)
        status = ask_moduli(out, context, error);
    for (uint32_t k = 0; k < kind->state_count; k++)
        out->columns += tl_state_width(kind->states[k].kind);
    if (status != TL_OK)
        tl_solid_clear(out);
    return status;
}

void tl_solid_clear(tl_solid *solid)
{
    const tl_solid_ops *ops = solid->kind ? solid->kind->ops : NULL;
    if (solid->self && ops->destroy) {
        tl_enter(solid->kind, "destroy");
        ops->destroy(solid->self);
        tl_leave();
    }
    free(solid->rows);
    free(solid->params);
    *solid = (tl_solid){0};
}

/* Rows of one SIMD batch, for a solid that tells energy in an update alone. */
typedef struct lane_rows {
    _Alignas(TL_ALIGN) double none[TL_LANES]; /* strain */
    double one[TL_LANES], stress[6][TL_LANES], state[TL_SOLID_COLUMNS][TL_LANES], stored[TL_LANES], heat[TL_LANES];
    uint32_t flags[TL_LANES];
} lane_rows;

/* Asks for an update of rows from `at` on without strain. */
static void ask_update(const tl_solid *solid, uint32_t at, const double *const stress[6], double *const *state,
                       double *stored)
{
    lane_rows r = {.stored = {0}};
    double *columns[TL_SOLID_COLUMNS];
    tl_report report;
    tl_solid_batch batch = {.size = sizeof batch,
                            .count = TL_LANES,
                            .volume = r.one,
                            .extent = r.one,
                            .state = columns,
                            .flags = r.flags,
                            .stored = r.stored,
                            .dissipated = r.heat};
    for (size_t l = 0; l < TL_LANES; l++)
        r.one[l] = 1;
    for (int k = 0; k < 6; k++) {
        memcpy(r.stress[k], stress[k] + at, sizeof r.stress[k]);
        batch.stress[k] = r.stress[k];
        batch.strain[k] = r.none;
    }
    for (uint32_t k = 0; k < solid->columns; k++) {
        memcpy(r.state[k], state[k] + at, sizeof r.state[k]);
        columns[k] = r.state[k];
    }
    if (tl_solid_update(solid, &batch, &report) == TL_OK)
        memcpy(stored + at, r.stored, sizeof r.stored);
}

void tl_solid_energy(const tl_solid *solid, uint32_t count, const double *const stress[6], double *const *state,
                     double *stored)
{
    const tl_solid_ops *ops = solid->kind->ops;
    for (uint32_t at = 0; !ops->energy && at < count; at += TL_LANES)
        ask_update(solid, at, stress, state, stored);
    if (!ops->energy)
        return;
    tl_enter(solid->kind, "energy");
    ops->energy(solid->self, count, stress, state, stored);
    tl_leave();
}

tl_status tl_solid_update(const tl_solid *solid, const tl_solid_batch *batch, tl_report *report)
{
    const tl_solid_ops *ops = solid->kind->ops;
    report->size = sizeof *report; /* its text is as long as all else that a call of some zones writes */
    report->first_bad = 0;
    report->text[0] = '\0';
    tl_enter(solid->kind, "update");
    tl_status status = ops->update(solid->self, batch, report);
    tl_leave();
    return status;
}
