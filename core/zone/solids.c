/* solids.c - the solids of a model: materials of zones, by their names. */
#include "zone/solids.h"

#include "base/params.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t tl_solid_find(const tl_model *m, const char *name)
{
    const size_t count = m->zones ? m->zones->solid_count : 0;
    for (size_t k = 0; k < count; k++)
        if (strcmp(m->zones->solid[k].name, name) == 0)
            return (uint32_t)k;
    return TL_NO_ROW;
}

static void solid_clear(tl_solid *s)
{
    const tl_solid_ops *ops = s->kind ? s->kind->ops : NULL;
    if (ops && ops->destroy && s->self && s->self != s->params) {
        tl_enter(s->kind, "destroy");
        ops->destroy(s->self);
        tl_leave();
    }
    free(s->params);
    free(s->name);
    *s = (tl_solid){.name = NULL};
}

void tl_solids_free(struct tl_zones *z)
{
    for (size_t k = 0; k < z->solid_count; k++)
        solid_clear(&z->solid[k]);
    free(z->solid);
}

/* Columns that a state takes. */
static uint32_t columns_of(const tl_state *state)
{
    return state->kind == TL_STATE_TENSOR ? 6 : state->kind == TL_STATE_AXIS ? 3 : 1;
}

static void note_columns(tl_solid *s)
{
    const char *state = (const char *)s->kind->states;
    for (uint32_t k = 0; k < s->kind->state_count; k++, state += s->kind->state_stride) {
        const uint32_t count = columns_of((const tl_state *)(const void *)state);
        s->columns += count;
        s->turns = s->turns || count > 1;
    }
}

/* Its moduli must be bounds that a step can go by. */
static tl_status ask_moduli(tl_solid *s, const char *context, tl_error *error)
{
    const tl_solid_ops *ops = s->kind->ops;
    tl_enter(s->kind, "moduli");
    ops->moduli(s->self, &s->constrained, &s->shear);
    tl_leave();
    if (s->constrained > 0 && s->shear >= 0 && isfinite(s->constrained) && s->constrained >= 4.0 / 3 * s->shear)
        return TL_OK;
    return tl_fail(error, TL_E_PLUGIN,
                   "%s of plugin '%s': its moduli() gives K + 4 G / 3 = %g Pa and G = %g Pa; the first must be above 0 "
                   "and at least 4 / 3 of the second",
                   context, tl_plugin_id(s->kind), s->constrained, s->shear);
}

/* A solid of its parameters: those not given stay, with `from`. */
static tl_status make(const char *name, const tl_kind *kind, const tl_args *args, const tl_solid *from, tl_error *error,
                      tl_solid *out)
{
    const tl_solid_ops *ops = kind->ops;
    char context[TL_ERROR_TEXT / 2];
    *out = (tl_solid){.name = strdup(name), .kind = kind, .params = calloc(1, kind->params_size + 1)};
    if (!out->name || !out->params) {
        solid_clear(out);
        return tl_fail_memory(error);
    }
    if (from)
        memcpy(out->params, from->params, kind->params_size);
    snprintf(context, sizeof context, "solid '%.80s', of kind '%.40s'", name, kind->name);
    tl_status status = tl_args_read(kind->params, kind->param_count, kind->param_stride, args, from != NULL,
                                    out->params, context, error);
    if (status == TL_OK)
        status = tl_args_proportion(kind->params, kind->param_count, kind->param_stride, args, context, error);
    if (status == TL_OK && ops->create) {
        tl_report report = {.size = sizeof report};
        tl_enter(kind, "create");
        status = ops->create(out->params, &out->self, &report);
        tl_leave();
        if (status != TL_OK)
            tl_fail(error, status, "%s of plugin '%s': %s", context, tl_plugin_id(kind),
                    tl_report_text(&report, status));
    } else if (status == TL_OK) {
        out->self = out->params;
    }
    if (status == TL_OK)
        status = ask_moduli(out, context, error);
    if (status != TL_OK)
        solid_clear(out);
    else
        note_columns(out);
    return status;
}

bool tl_solid_columns(struct tl_zones *z, const tl_solid *solid)
{
    tl_zone_table *t = &z->zones;
    tl_column more[TL_SOLID_COLUMNS];
    uint32_t count = 0;
    for (uint32_t k = t->state_columns; k < solid->columns; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(t, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    if (count > 0 && !tl_table_widen(&t->table, more, count))
        return false;
    t->state_columns += count;
    return true;
}

tl_status tl_solid_set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args)
{
    struct tl_zones *z = m->zones;
    const uint32_t known = tl_solid_find(m, name);
    const tl_solid *from = known != TL_NO_ROW ? &z->solid[known] : NULL;
    tl_solid made;
    tl_status status = make(name, kind ? kind : from->kind, args, kind ? NULL : from, &m->error, &made);
    if (status != TL_OK)
        return status;
    bool enough = tl_grow(&z->solid, &z->solid_capacity, z->solid_count + 1, sizeof *z->solid);
    if (!enough || !tl_solid_columns(z, &made)) {
        solid_clear(&made);
        return tl_fail_memory(&m->error);
    }
    if (known != TL_NO_ROW)
        solid_clear(&z->solid[known]);
    z->solid[known != TL_NO_ROW ? known : z->solid_count++] = made;
    z->version++;
    return TL_OK;
}
