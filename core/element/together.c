/* together.c - what the elements of one call do together, on the main thread.
 *
 * The kind sees all elements of a set with their present places, and changes states. A step does so before forces are
 * found, when its number is divisible by what `every` says. */
#include "element/together.h"

#include "base/error.h"
#include "base/inside.h"
#include "element/carry.h"
#include "model/law_time.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdlib.h>

static bool acts(const tl_element_set *set)
{
    return tl_element_ops_of(set)->together != NULL;
}

static bool is_due(const tl_model *m, const tl_element_set *set)
{
    const tl_element_ops *ops = tl_element_ops_of(set);
    const uint32_t every = !acts(set) ? 0 : ops->every ? ops->every(set->self) : 1;
    return every > 0 && m->cycles % every == 0;
}

bool tl_elements_together_due(const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    bool due = false;
    for (size_t k = 0; e && k < e->set_count && !due; k++)
        due = is_due(m, &e->set[k]);
    return due;
}

/* Where nodes are, and where their elements begin. */
static void fill(tl_model *m, uint32_t begin, uint32_t end, double *column[6], uint32_t *start)
{
    const tl_element_table *t = &m->elements->table;
    const uint32_t first = t->node_begin[begin], last = t->node_begin[end - 1] + t->node_count[end - 1];
    for (uint32_t row = begin; row < end; row++)
        start[row - begin] = t->node_begin[row] - first;
    start[end - begin] = last - first;
    for (uint32_t row = first; row < last; row++) {
        const tl_vec3 u = tl_node_moved(m, row), n = tl_node_normal(m, row);
        const double value[] = {u.x, u.y, u.z, n.x, n.y, n.z};
        for (int k = 0; k < 6; k++)
            column[k][row - first] = value[k];
    }
}

/* The first element whose states are not finite, counted from `begin`; `count`: there is none. */
static uint32_t find_odd(const tl_element_batch *b, const tl_kind *kind)
{
    for (uint32_t e = 0; e < b->count; e++) {
        double sum = 0;
        for (uint32_t k = 0, at[2] = {0, 0}; k < kind->state_count; k++) {
            const bool whole = kind->states[k].kind == TL_STATE_WHOLE;
            const uint32_t column = at[whole]++;
            for (uint32_t i = b->start[e]; !whole && i < b->start[e + 1]; i++)
                sum += 0 * b->state[column][i];
            sum += whole ? 0 * b->element_state[column][e] : 0;
        }
        if (!isfinite(sum))
            return e;
    }
    return b->count;
}

static tl_status call(tl_model *m, const tl_element_set *set, const tl_element_batch *batch, uint32_t begin)
{
    tl_report report = {.size = sizeof report};
    tl_enter(set->kind, "together");
    tl_status status = tl_element_ops_of(set)->together(set->self, batch, &report);
    tl_leave();
    if (status != TL_OK)
        return tl_fail(&m->error, status, "element '%s' of plugin '%s': %s", set->kind->name, tl_plugin_id(set->kind),
                       tl_report_text(&report, status));
    const uint32_t odd = find_odd(batch, set->kind);
    return odd == batch->count ? TL_OK
                               : tl_fail(&m->error, TL_E_NUMERIC,
                                         "element %u, '%s' of plugin '%s': together() gives a state that is not finite",
                                         m->elements->table.id[begin + odd], set->kind->name, tl_plugin_id(set->kind));
}

/* Asks the kind of the elements in rows that follow each other. */
static tl_status ask(tl_model *m, uint32_t begin, uint32_t end)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    const tl_node_table *n = &e->nodes;
    const size_t first = t->node_begin[begin];
    const size_t nodes = t->node_begin[end - 1] + (size_t)t->node_count[end - 1] - first;
    double *own = malloc(6 * nodes * sizeof *own), *column[6], *state[TL_ELEMENT_COLUMNS], *whole[TL_ELEMENT_COLUMNS];
    uint32_t *start = malloc((end - begin + (size_t)1) * sizeof *start);
    tl_status status = own && start ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        for (int k = 0; k < 6; k++)
            column[k] = own + (size_t)k * nodes;
        for (uint32_t k = 0; k < n->state_columns; k++)
            state[k] = n->state[k] + first;
        for (uint32_t k = 0; k < t->state_columns; k++)
            whole[k] = t->state[k] + begin;
        fill(m, begin, end, column, start);
        tl_element_batch batch = {.size = sizeof batch,
                                  .count = end - begin,
                                  .dt = tl_law_time(m, m->dt),
                                  .time = m->time,
                                  .origin = m->origin,
                                  .start = start,
                                  .weight = n->weight + first,
                                  .state = state,
                                  .element_state = whole,
                                  .flags = t->flags + begin};
        for (int k = 0; k < 3; k++) {
            batch.rest[k] = n->rest[k] + first;
            batch.u[k] = column[k];
            batch.normal[k] = column[3 + k];
        }
        status = call(m, &e->set[t->set[begin]], &batch, begin);
    }
    free(own);
    free(start);
    return status;
}

tl_status tl_elements_together(tl_model *m, size_t first, bool due)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    tl_status status = TL_OK;
    for (size_t row = first, end; row < t->table.rows && status == TL_OK; row = end) {
        const tl_element_set *set = &e->set[t->set[row]];
        for (end = row + 1; end < t->table.rows && t->set[end] == t->set[row];)
            end++;
        if (acts(set) && (!due || is_due(m, set)))
            status = ask(m, (uint32_t)row, (uint32_t)end);
    }
    return status;
}
