/* together.c - what the elements of one call do together, on the main thread.
 *
 * The kind sees all elements of a set with their present places, and changes states. A step does so before forces are
 * found, when its number is divisible by what `every` says. */
#include "element/together.h"

#include "base/columns.h"
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

/* The elements of a set, one after the other: their rows may lie apart. */
typedef struct gathered {
    const uint32_t *row;
    uint32_t count;
    size_t nodes;
    double *numbers;
    uint32_t *start, *flags;
    double *rest[3], *u[3], *normal[3], *weight, *state[TL_ELEMENT_COLUMNS], *whole[TL_ELEMENT_COLUMNS];
} gathered;

static void gathered_free(gathered *g)
{
    free(g->numbers);
    free(g->start);
    free(g->flags);
}

static bool gathered_begin(const struct tl_elements *e, const uint32_t *row, uint32_t count, gathered *g)
{
    const uint32_t states = e->nodes.state_columns, wholes = e->table.state_columns;
    *g = (gathered){.row = row, .count = count};
    for (uint32_t k = 0; k < count; k++)
        g->nodes += e->table.node_count[row[k]];
    g->numbers = malloc(((10 + (size_t)states) * g->nodes + (size_t)wholes * count + 1) * sizeof *g->numbers);
    g->start = malloc((count + (size_t)1) * sizeof *g->start);
    g->flags = malloc((count + (size_t)1) * sizeof *g->flags);
    if (!g->numbers || !g->start || !g->flags)
        return false;
    double *next = g->numbers;
    double **column[10] = {&g->rest[0], &g->rest[1],   &g->rest[2],   &g->u[0],      &g->u[1],
                           &g->u[2],    &g->normal[0], &g->normal[1], &g->normal[2], &g->weight};
    for (int k = 0; k < 10; k++, next += g->nodes)
        *column[k] = next;
    for (uint32_t k = 0; k < states; k++, next += g->nodes)
        g->state[k] = next;
    for (uint32_t k = 0; k < wholes; k++, next += count)
        g->whole[k] = next;
    return true;
}

/* Where nodes are, and what they and their elements have. */
static void fill(tl_model *m, gathered *g)
{
    const tl_element_table *t = &m->elements->table;
    const tl_node_table *n = &m->elements->nodes;
    uint32_t to = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        const uint32_t element = g->row[i], first = t->node_begin[element];
        g->start[i] = to;
        g->flags[i] = t->flags[element];
        for (uint32_t k = 0; k < t->state_columns; k++)
            g->whole[k][i] = t->state[k][element];
        for (uint32_t row = first; row < first + t->node_count[element]; row++, to++) {
            tl_columns_put(g->rest, to, tl_columns_get(n->rest, row));
            tl_columns_put(g->u, to, tl_node_moved(m, row));
            tl_columns_put(g->normal, to, tl_node_normal(m, row));
            g->weight[to] = n->weight[row];
            for (uint32_t k = 0; k < n->state_columns; k++)
                g->state[k][to] = n->state[k][row];
        }
    }
    g->start[g->count] = to;
}

/* Gives elements the states and flags that the kind has left. */
static void give_back(struct tl_elements *e, const gathered *g)
{
    tl_element_table *t = &e->table;
    for (uint32_t i = 0; i < g->count; i++) {
        const uint32_t element = g->row[i], first = t->node_begin[element];
        t->flags[element] = g->flags[i];
        for (uint32_t k = 0; k < t->state_columns; k++)
            t->state[k][element] = g->whole[k][i];
        for (uint32_t row = first; row < first + t->node_count[element]; row++)
            for (uint32_t k = 0; k < e->nodes.state_columns; k++)
                e->nodes.state[k][row] = g->state[k][g->start[i] + row - first];
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

static tl_status call(tl_model *m, const tl_element_set *set, const tl_element_batch *batch, const uint32_t *row)
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
                                         m->elements->table.id[row[odd]], set->kind->name, tl_plugin_id(set->kind));
}

/* Asks the kind of a set, whose elements are in these rows. */
static tl_status ask(tl_model *m, const tl_element_set *set, const uint32_t *row, uint32_t count)
{
    gathered g;
    tl_status status = gathered_begin(m->elements, row, count, &g) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        fill(m, &g);
        tl_element_batch batch = {.size = sizeof batch,
                                  .count = count,
                                  .dt = tl_law_time(m, m->dt),
                                  .time = m->time,
                                  .origin = m->origin,
                                  .start = g.start,
                                  .weight = g.weight,
                                  .state = g.state,
                                  .element_state = g.whole,
                                  .flags = g.flags};
        for (int k = 0; k < 3; k++) {
            batch.rest[k] = g.rest[k];
            batch.u[k] = g.u[k];
            batch.normal[k] = g.normal[k];
        }
        status = call(m, set, &batch, row);
        if (status == TL_OK)
            give_back(m->elements, &g);
    }
    gathered_free(&g);
    return status;
}

tl_status tl_elements_together(tl_model *m, size_t first, bool due)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    uint32_t *row = NULL;
    tl_status status = TL_OK;
    for (size_t k = 0; k < e->set_count && status == TL_OK; k++) {
        if (!acts(&e->set[k]) || (due && !is_due(m, &e->set[k])))
            continue;
        uint32_t count = 0;
        row = row ? row : malloc((t->table.rows + 1) * sizeof *row);
        for (size_t i = first; i < t->table.rows && row; i++)
            if (t->set[i] == k)
                row[count++] = (uint32_t)i;
        status = !row ? tl_fail_memory(&m->error) : count > 0 ? ask(m, &e->set[k], row, count) : TL_OK;
    }
    free(row);
    return status;
}
