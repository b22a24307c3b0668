/* joint_laws.c - a law and its properties, for a joint. */
#include "force/joint_laws.h"

#include "base/inside.h"
#include "base/params.h"
#include "contact/contacts.h"
#include "model/joints.h"
#include "model/law_time.h"
#include "model/scope.h"
#include "plugin/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Forces over smaller ones would not be finite. */
static bool is_stiffness(double k)
{
    return k == 0 || (k >= TL_LEAST_MEASURE && isfinite(k));
}

/* A law and its properties from what `out` has: those not given stay, with `keep`. */
static tl_status make(tl_law *out, const tl_args *args, bool keep, const char *context, tl_error *error)
{
    const tl_kind *kind = out->kind;
    const tl_law_ops *ops = kind->ops;
    tl_report report = {.size = sizeof report};
    tl_status status =
        tl_args_read(kind->params, kind->param_count, kind->param_stride, args, keep, out->params, context, error);
    if (status == TL_OK)
        status = tl_args_proportion(kind->params, kind->param_count, kind->param_stride, args, context, error);
    out->self = out->params;
    if (status == TL_OK && ops->create) {
        tl_enter(kind, "create");
        status = ops->create(out->params, &out->self, &report);
        tl_leave();
        if (status != TL_OK)
            tl_fail(error, status, "%s of plugin '%s': %s", context, tl_plugin_id(kind),
                    tl_report_text(&report, status));
    }
    if (status != TL_OK) {
        free(out->params);
        *out = (tl_law){0};
        return status;
    }
    tl_enter(kind, "stiffness");
    ops->stiffness(out->self, &out->kn, &out->ks);
    tl_leave();
    if (!is_stiffness(out->kn) || !is_stiffness(out->ks)) {
        tl_fail(error, TL_E_PLUGIN,
                "%s of plugin '%s': its stiffness() gives kn = %g and ks = %g Pa/m; both must be "
                "finite and 0 or at least %g",
                context, tl_plugin_id(kind), out->kn, out->ks, TL_LEAST_MEASURE);
        tl_law_clear(out);
        return TL_E_PLUGIN;
    }
    tl_state_columns at = {0};
    out->energy = TL_NO_ROW;
    while (tl_state_next(kind, UINT32_MAX, &at)) {
        out->tangents |= at.count == 3 ? 1u << at.begin : 0;
        out->splits = out->splits || at.state->transfer == TL_TRANSFER_SPLIT;
        if (at.state->transfer == TL_TRANSFER_ENERGY)
            out->energy = at.begin;
    }
    tl_enter(kind, "stateless");
    out->columns = ops->stateless && ops->stateless(out->self) ? 0 : at.begin;
    tl_leave();
    tl_enter(kind, "pulls");
    out->pulls = ops->pulls ? ops->pulls(out->self) : TL_PULL_ANY;
    tl_leave();
    return TL_OK;
}

tl_status tl_law_make(const tl_kind *kind, const tl_args *args, const char *context, tl_error *error, tl_law *out)
{
    *out = (tl_law){.kind = kind, .params = calloc(1, kind->params_size + 1)};
    return out->params ? make(out, args, false, context, error) : tl_fail_memory(error);
}

tl_status tl_law_make_for(tl_model *m, const tl_scope *scope, const tl_kind *kind, const tl_args *args,
                          const tl_law *from, tl_law *out)
{
    char of[TL_SCOPE_TEXT], context[TL_SCOPE_TEXT + 60];
    *out = (tl_law){.kind = kind, .params = calloc(1, kind->params_size + 1)};
    if (!out->params)
        return tl_fail_memory(&m->error);
    if (from)
        memcpy(out->params, from->params, kind->params_size);
    tl_text_print(context, sizeof context, "%s, law '%.40s'", tl_scope_text(m, scope, of), kind->name);
    tl_status status = make(out, args, from != NULL, context, &m->error);
    if (status == TL_OK)
        out->scope = *scope;
    return status;
}

tl_law_batch tl_lanes_batch(const tl_model *m, const tl_point_lanes *l, size_t count)
{
    return (tl_law_batch){.size = sizeof(tl_law_batch),
                          .count = (uint32_t)count,
                          .dt = tl_law_time(m, m->dt),
                          .closure = l->closure,
                          .normal = {l->normal[0], l->normal[1], l->normal[2]},
                          .du_n = l->du_n,
                          .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
                          .f_n = l->before[0],
                          .f_s = {l->before[1], l->before[2], l->before[3]},
                          .state = &l->before[4],
                          .flags = l->flags_before,
                          .stored = l->stored,
                          .dissipated = l->dissipated};
}

tl_status tl_law_update(const tl_law *law, const tl_law_batch *batch, tl_report *report)
{
    const tl_law_ops *ops = law->kind->ops;
    *report = (tl_report){.size = sizeof *report};
    tl_enter(law->kind, "update");
    tl_status status = ops->update(law->self, batch, report);
    tl_leave();
    return status;
}
