/* set.c - a kind of element with its parameters. */
#include "element/set.h"

#include "base/inside.h"
#include "base/kind_states.h"
#include "base/params.h"
#include "plugin/loader.h"

#include <stdlib.h>
#include <string.h>

/* The text of parameter k; NULL: it is none. */
static char **text_of(const tl_kind *kind, uint32_t k, void *params)
{
    const tl_param *p = &kind->params[k];
    return p->type == TL_PARAM_STRING ? (char **)(void *)((char *)params + p->offset) : NULL;
}

/* Likewise the list of points. */
static tl_points *points_of(const tl_kind *kind, uint32_t k, void *params)
{
    const tl_param *p = &kind->params[k];
    return p->type == TL_PARAM_POINTS ? (tl_points *)(void *)((char *)params + p->offset) : NULL;
}

static bool keep_points(tl_points *points)
{
    const size_t bytes = points->count * sizeof *points->at;
    tl_vec3 *own = points->count ? malloc(bytes) : NULL;
    const bool enough = own || points->count == 0;
    if (own)
        memcpy(own, points->at, bytes);
    *points = (tl_points){own, enough ? points->count : 0};
    return enough;
}

/* Takes copies of texts and lists, which are the caller's so far. false: out of memory; the rest is NULL then. */
static bool keep_lists(const tl_kind *kind, void *params)
{
    bool enough = true;
    for (uint32_t k = 0; k < kind->param_count; k++) {
        char **text = text_of(kind, k, params);
        tl_points *points = points_of(kind, k, params);
        if (points && !enough)
            *points = (tl_points){NULL, 0};
        else if (points)
            enough = keep_points(points);
        if (!text || !*text)
            continue;
        *text = enough ? strdup(*text) : NULL;
        enough = *text != NULL;
    }
    return enough;
}

static void free_params(const tl_kind *kind, void *params)
{
    for (uint32_t k = 0; k < kind->param_count; k++) {
        const tl_points *points = points_of(kind, k, params);
        if (text_of(kind, k, params))
            free(*text_of(kind, k, params));
        if (points)
            free((void *)(uintptr_t)points->at);
    }
    free(params);
}

static tl_status create(tl_element_set *set, const char *context, tl_error *error)
{
    const tl_element_ops *ops = tl_element_ops_of(set);
    tl_report report = {.size = sizeof report};
    void *self = set->params;
    if (ops->create) {
        tl_enter(set->kind, "create");
        const tl_status status = ops->create(set->params, &self, &report);
        tl_leave();
        if (status != TL_OK)
            return tl_fail(error, status, "%s of plugin '%s': %s", context, tl_plugin_id(set->kind),
                           tl_report_text(&report, status));
    }
    set->self = self;
    return TL_OK;
}

tl_status tl_element_set_make(const tl_kind *kind, const tl_args *args, const tl_element_set *from, const char *context,
                              tl_error *error, tl_element_set *out)
{
    *out = (tl_element_set){.kind = kind};
    void *params = calloc(1, kind->params_size + 1);
    if (!params)
        return tl_fail_memory(error);
    if (from)
        memcpy(params, from->params, kind->params_size);
    tl_status status =
        tl_args_read(kind->params, kind->param_count, kind->param_stride, args, from != NULL, params, context, error);
    if (status == TL_OK)
        status = tl_args_proportion(kind->params, kind->param_count, kind->param_stride, args, context, error);
    if (status != TL_OK) {
        free(params); /* its lists are not its own yet */
        return status;
    }
    out->params = params;
    if (from) {
        out->group = from->group;
        out->structure = from->structure;
    }
    status = keep_lists(kind, params) ? create(out, context, error) : tl_fail_memory(error);
    if (status != TL_OK)
        tl_element_set_clear(out);
    return status;
}

void tl_element_set_hash(const tl_element_set *set, tl_hash *hash)
{
    for (uint32_t k = 0; k < set->kind->param_count; k++) {
        const tl_param *p = &set->kind->params[k];
        const char *at = (const char *)set->params + p->offset;
        char *const *text = text_of(set->kind, k, set->params);
        const tl_points *points = points_of(set->kind, k, set->params);
        if (points)
            tl_hash_bytes(hash, points->count ? (const void *)points->at : "", points->count * sizeof *points->at);
        else if (!text)
            tl_hash_bytes(hash, at, tl_param_bytes(p->type));
        else
            tl_hash_bytes(hash, *text ? *text : "", *text ? strlen(*text) : 0);
    }
}

void tl_element_set_clear(tl_element_set *set)
{
    if (set->self && tl_element_ops_of(set)->destroy) {
        tl_enter(set->kind, "destroy");
        tl_element_ops_of(set)->destroy(set->self);
        tl_leave();
    }
    if (set->params)
        free_params(set->kind, set->params);
    *set = (tl_element_set){.kind = NULL};
}

uint32_t tl_element_columns(const tl_kind *kind, bool whole)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < kind->state_count; k++)
        count += (tl_kind_state(kind, k)->kind == TL_STATE_WHOLE) == whole;
    return count;
}

bool tl_element_column(const tl_kind *kind, const char *name, uint32_t *column, bool *whole)
{
    uint32_t at[2] = {0, 0};
    for (uint32_t k = 0; k < kind->state_count; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        *whole = state->kind == TL_STATE_WHOLE;
        *column = at[*whole]++;
        if (strcmp(state->name, name) == 0)
            return true;
    }
    return false;
}

bool tl_elements_hold_states(struct tl_elements *e, uint32_t of_nodes, uint32_t of_whole)
{
    tl_column more[TL_ELEMENT_COLUMNS];
    uint32_t count = 0;
    tl_node_table *n = &e->nodes;
    for (uint32_t k = n->state_columns; k < of_nodes; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(n, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    if (count > 0 && !tl_table_widen(&n->table, more, count))
        return false;
    n->state_columns += count;
    tl_element_table *t = &e->table;
    count = 0;
    for (uint32_t k = t->state_columns; k < of_whole; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(t, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    if (count > 0 && !tl_table_widen(&t->table, more, count))
        return false;
    t->state_columns += count;
    return true;
}

/* Gives a table columns, of zeros, unless it has them. */
static bool hold(tl_table *table, const tl_column *columns, size_t count)
{
    bool there = false;
    for (size_t i = 0; i < table->column_count; i++)
        there = there || table->columns[i].offset == columns[0].offset;
    return there || tl_table_widen(table, columns, count);
}

/* The same with what other columns have. */
static void fill(double *const to[3], double *const from[3], size_t rows)
{
    for (int k = 0; k < 3 && rows > 0; k++)
        memcpy(to[k], from[k], rows * sizeof *to[k]);
}

bool tl_nodes_hold_base(tl_node_table *n)
{
    const tl_column columns[] = {TL_COLUMN_NEW(n, base[0], 0), TL_COLUMN_NEW(n, base[1], 0),
                                 TL_COLUMN_NEW(n, base[2], 0)};
    const bool had = n->base[0];
    if (!hold(&n->table, columns, 3))
        return false;
    if (!had)
        fill(n->base, n->local, n->table.rows);
    return true;
}

bool tl_nodes_hold_from(tl_node_table *n)
{
    const tl_column columns[] = {TL_COLUMN_NEW(n, from[0], 0), TL_COLUMN_NEW(n, from[1], 0),
                                 TL_COLUMN_NEW(n, from[2], 0)};
    return hold(&n->table, columns, 3);
}

bool tl_nodes_hold_normals(tl_node_table *n, bool turned)
{
    const tl_column outward[] = {TL_COLUMN_NEW(n, outward[0], 0), TL_COLUMN_NEW(n, outward[1], 0),
                                 TL_COLUMN_NEW(n, outward[2], 0)};
    const tl_column normal[] = {TL_COLUMN_NEW(n, normal[0], 0), TL_COLUMN_NEW(n, normal[1], 0),
                                TL_COLUMN_NEW(n, normal[2], 0)};
    const bool had = n->normal[0];
    if (!hold(&n->table, outward, 3) || (turned && !hold(&n->table, normal, 3)))
        return false;
    if (turned && !had)
        fill(n->normal, n->outward, n->table.rows);
    return true;
}

bool tl_nodes_hold_zones(tl_node_table *n)
{
    const tl_column columns[] = {TL_COLUMN_NEW(n, point, 0), TL_COLUMN_NEW(n, share, 0)};
    return hold(&n->table, columns, 2);
}

bool tl_nodes_hold_damping(tl_node_table *n)
{
    return TL_COLUMN_NEED(&n->table, n, c, 0);
}
