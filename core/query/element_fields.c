/* element_fields.c - what can be asked of elements: which ones, their named fields, their nodes and states. */
#include "query/element_fields.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/kind_states.h"
#include "base/names.h"
#include "element/carry.h"
#include "element/follow.h"
#include "element/life.h"
#include "element/set.h"
#include "model/rows.h"
#include "query/contact_fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/fields.h>

/* ---------------------------------------------------------------- asking ----------------- */

uint32_t tl_element_find(tl_model *m, tl_id id)
{
    tl_rows_tidy(m);
    if (tl_elements_follow(m) != TL_OK)
        return TL_NO_ROW;
    const uint32_t row = tl_element_row(m, id);
    if (row == TL_NO_ROW)
        tl_fail(&m->error, TL_E_STALE, "there is no element %u: it has been deleted, or never was", id);
    return row;
}

static bool has_block(const struct tl_elements *e, size_t row, tl_id block)
{
    const uint32_t begin = e->table.node_begin[row], end = begin + e->table.node_count[row];
    uint32_t k = begin;
    while (k < end && e->nodes.block[k] != block)
        k++;
    return k < end;
}

tl_status tl_elements_select(tl_model *m, const tl_element_filter *filter, tl_id **ids, size_t *count)
{
    *ids = NULL;
    *count = 0;
    tl_rows_tidy(m);
    const tl_status status = tl_elements_follow(m);
    if (status != TL_OK)
        return status;
    const struct tl_elements *e = m->elements;
    const size_t rows = e ? e->table.table.rows : 0;
    tl_id *list = malloc((rows + 1) * sizeof *list);
    if (!list)
        return tl_fail_memory(&m->error);
    for (size_t row = 0; row < rows; row++) {
        const tl_element_set *set = &e->set[e->table.set[row]];
        if ((filter->kind && strcmp(filter->kind, set->kind->name) != 0) ||
            (filter->group && strcmp(filter->group, m->groups[set->group]) != 0) ||
            (filter->block && !has_block(e, row, filter->block)))
            continue;
        list[(*count)++] = e->table.id[row];
    }
    *ids = list;
    return TL_OK;
}

tl_status tl_element_get(tl_model *m, tl_id element, tl_element_info *info)
{
    const uint32_t row = tl_element_find(m, element);
    if (row == TL_NO_ROW)
        return m->error.status;
    const tl_element_table *t = &m->elements->table;
    const tl_element_set *set = &m->elements->set[t->set[row]];
    *info = (tl_element_info){.kind = set->kind,
                              .params = set->params,
                              .group = m->groups[set->group],
                              .nodes = t->node_count[row],
                              .flags = t->flags[row],
                              .stored = t->stored[row],
                              .lost = t->lost[row],
                              .given = t->given[row]};
    return TL_OK;
}

/* The row of a node; TL_NO_ROW after an error. */
static uint32_t find_node(tl_model *m, tl_id element, size_t index)
{
    const uint32_t row = tl_element_find(m, element);
    if (row == TL_NO_ROW)
        return TL_NO_ROW;
    const tl_element_table *t = &m->elements->table;
    if (index < t->node_count[row])
        return t->node_begin[row] + (uint32_t)index;
    tl_fail(&m->error, TL_E_ARGUMENT, "element %u has %u nodes: there is no node %zu", element, t->node_count[row],
            index + 1);
    return TL_NO_ROW;
}

tl_status tl_element_node_get(tl_model *m, tl_id element, size_t index, tl_element_node_info *node)
{
    const uint32_t row = find_node(m, element, index);
    if (row == TL_NO_ROW)
        return m->error.status;
    const tl_node_table *n = &m->elements->nodes;
    const tl_vec3 rest = tl_v3_add(m->origin, tl_columns_get(n->rest, row));
    *node = (tl_element_node_info){.block = n->block[row] == TL_GONE ? TL_NO_ID : n->block[row],
                                   .rest = rest,
                                   .position = tl_v3_add(rest, tl_node_moved(m, row)),
                                   .force = tl_columns_get(n->force, row),
                                   .weight = n->weight[row]};
    return TL_OK;
}

/* Fails: the kind has no such state. */
static tl_status unknown_state(tl_model *m, const tl_kind *kind, const char *name)
{
    const char *names[2 * TL_ELEMENT_COLUMNS];
    size_t count = 0;
    for (uint32_t k = 0; k < kind->state_count && count < 2 * TL_ELEMENT_COLUMNS; k++)
        names[count++] = kind->states[k].name;
    const char *nearest = tl_nearest_name(name, names, count);
    return tl_fail(&m->error, TL_E_NOT_FOUND, "element '%s' has no state '%.80s'%s%s%s", kind->name, name,
                   nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
}

double *tl_element_state_at(tl_model *m, tl_id element, size_t index, const char *name)
{
    const uint32_t row = tl_element_find(m, element);
    if (row == TL_NO_ROW)
        return NULL;
    struct tl_elements *e = m->elements;
    const tl_kind *kind = e->set[e->table.set[row]].kind;
    uint32_t column;
    bool whole;
    if (!tl_element_column(kind, name, &column, &whole)) {
        unknown_state(m, kind, name);
        return NULL;
    }
    if (whole != (index == SIZE_MAX)) {
        tl_fail(&m->error, TL_E_ARGUMENT, "'%s' is a number of %s of element '%s'", name,
                whole ? "the whole" : "each node", kind->name);
        return NULL;
    }
    if (whole)
        return &e->table.state[column][row];
    const uint32_t node = find_node(m, element, index);
    return node == TL_NO_ROW ? NULL : &e->nodes.state[column][node];
}

tl_status tl_element_value(tl_model *m, tl_id element, size_t index, const char *name, double *value)
{
    const uint32_t row = tl_element_find(m, element);
    if (row == TL_NO_ROW)
        return m->error.status;
    const struct tl_elements *e = m->elements;
    const double whole[] = {e->table.stored[row], e->table.lost[row], e->table.given[row]};
    const char *const names[] = {"stored", "lost", "given"};
    for (int k = 0; index == SIZE_MAX && k < 3; k++)
        if (strcmp(name, names[k]) == 0) {
            *value = whole[k];
            return TL_OK;
        }
    const double *at = tl_element_state_at(m, element, index, name);
    if (at)
        *value = *at;
    return at ? TL_OK : m->error.status;
}

/* ---------------------------------------------------------------- fields ----------------- */

enum { ID, KIND, GROUP, NODES, YIELDED, BROKEN, DETACHED, STORED, LOST, GIVEN, FIELDS };

const tl_field *tl_element_fields(size_t *count)
{
    static const tl_field fields[] = {
        [ID] = {"id", TL_FIELD_COUNT, "", "id"},
        [KIND] = {"kind", TL_FIELD_TEXT, "", "name of its kind"},
        [GROUP] = {"group", TL_FIELD_TEXT, "", "name that was given with the call that placed it"},
        [NODES] = {"node_count", TL_FIELD_COUNT, "", "number of its nodes"},
        [YIELDED] = {"yielded", TL_FIELD_BOOL, "", "whether it has ever yielded"},
        [BROKEN] = {"broken", TL_FIELD_BOOL, "", "whether it has broken"},
        [DETACHED] = {"detached", TL_FIELD_BOOL, "", "whether a block of its nodes has been deleted"},
        [STORED] = {"stored", TL_FIELD_SCALAR, "J", "energy that it holds"},
        [LOST] = {"lost", TL_FIELD_SCALAR, "J", "energy turned to heat in the last step"},
        [GIVEN] = {"given", TL_FIELD_SCALAR, "J", "energy brought in from outside in the last step"},
    };
    *count = FIELDS;
    return fields;
}

tl_status tl_element_field(tl_model *m, tl_id element, size_t index, tl_field_value *value)
{
    tl_element_info info;
    const tl_status status = tl_element_get(m, element, &info);
    if (status != TL_OK)
        return status;
    const double number[FIELDS] = {[ID] = element,
                                   [NODES] = (double)info.nodes,
                                   [YIELDED] = (info.flags & TL_ELEMENT_YIELDED) != 0,
                                   [BROKEN] = (info.flags & TL_ELEMENT_BROKEN) != 0,
                                   [DETACHED] = (info.flags & TL_ELEMENT_DETACHED) != 0,
                                   [STORED] = info.stored,
                                   [LOST] = info.lost,
                                   [GIVEN] = info.given};
    *value = (tl_field_value){.number = {number[index]},
                              .text = index == KIND    ? info.kind->name
                                      : index == GROUP ? info.group
                                                       : NULL};
    return TL_OK;
}

/* Whether a kind of an element that there is has a state of the whole by that name. */
static bool some_have(const tl_model *m, const char *name)
{
    uint32_t column;
    bool whole = false, some = false;
    for (size_t k = 0; m->elements && k < m->elements->set_count && !some; k++)
        some = tl_element_column(m->elements->set[k].kind, name, &column, &whole) && whole;
    return some;
}

tl_status tl_elements_values(tl_model *m, const tl_id *elements, size_t count, const char *name, double *out,
                             size_t *width)
{
    size_t index = 0, fields;
    const tl_field *field = tl_element_fields(&fields);
    while (index < fields && strcmp(field[index].name, name) != 0)
        index++;
    *width = 1;
    if (index < fields && field[index].kind == TL_FIELD_TEXT)
        return tl_fail(&m->error, TL_E_ARGUMENT, "'%.80s' of elements is a text", name);
    if (index == fields && !some_have(m, name))
        return tl_fail(&m->error, TL_E_NOT_FOUND, "elements have no number '%.80s'", name);
    tl_status status = TL_OK;
    for (size_t i = 0; out && i < count && status == TL_OK; i++) {
        const uint32_t row = tl_element_find(m, elements[i]);
        tl_field_value value = {.number = {NAN}};
        uint32_t column;
        bool whole;
        if (row == TL_NO_ROW)
            status = m->error.status;
        else if (index < fields)
            status = tl_element_field(m, elements[i], index, &value);
        else if (tl_element_column(m->elements->set[m->elements->table.set[row]].kind, name, &column, &whole) && whole)
            value.number[0] = m->elements->table.state[column][row];
        out[i] = value.number[0];
    }
    return status;
}

/* ---------------------------------------------------------------- between walls ---------- */

/* A contact that is asked for, by its blocks. */
typedef struct asked_contact {
    tl_id a, b;
    size_t index;
    double sum, weight;
} asked_contact;

static int compare_asked(const void *x, const void *y)
{
    const asked_contact *p = x, *q = y;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

/* Whether an element lies between the walls of two blocks, which are given, the lower id first. */
static bool find_blocks(const struct tl_elements *e, size_t row, asked_contact *of)
{
    const tl_node_table *n = &e->nodes;
    const uint32_t first = e->table.node_begin[row], last = first + e->table.node_count[row] - 1;
    const tl_id a = n->block[first], b = n->block[last];
    of->a = a < b ? a : b;
    of->b = a < b ? b : a;
    return a != b && of->a != TL_NO_ID && of->b != TL_GONE && tl_v3_norm2(tl_node_outward(n, first)) > 0 &&
           tl_v3_norm2(tl_node_outward(n, last)) > 0;
}

/* Adds a state of an element to the sums of a contact. */
static void add_element(const struct tl_elements *e, size_t row, const char *name, const char *unless,
                        asked_contact *to)
{
    const tl_kind *kind = e->set[e->table.set[row]].kind;
    uint32_t column;
    bool whole;
    if (unless && tl_element_column(kind, unless, &column, &whole) && whole && e->table.state[column][row] != 0)
        return;
    if (!tl_element_column(kind, name, &column, &whole))
        return;
    for (uint32_t k = e->table.node_begin[row]; k < e->table.node_begin[row] + e->table.node_count[row]; k++) {
        to->sum += e->nodes.weight[k] * (whole ? e->table.state[column][row] : e->nodes.state[column][k]);
        to->weight += e->nodes.weight[k];
    }
}

tl_status tl_contacts_element_values(tl_model *m, const tl_contact_name *contacts, size_t count, const char *name,
                                     const char *unless, double *out)
{
    const struct tl_elements *e = m->elements;
    asked_contact *asked = calloc(count + 1, sizeof *asked);
    tl_status status = asked ? TL_OK : tl_fail_memory(&m->error);
    uint32_t contact;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        status = tl_contact_find(m, contacts[i], &contact);
        asked[i] = (asked_contact){.a = contacts[i].a, .b = contacts[i].b, .index = i};
    }
    if (status == TL_OK)
        status = tl_elements_follow(m);
    if (status == TL_OK && count > 1)
        qsort(asked, count, sizeof *asked, compare_asked);
    for (size_t row = 0; status == TL_OK && e && count > 0 && row < e->table.table.rows; row++) {
        asked_contact of;
        asked_contact *to = find_blocks(e, row, &of) ? bsearch(&of, asked, count, sizeof *asked, compare_asked) : NULL;
        while (to && to > asked && compare_asked(to - 1, to) == 0)
            to--; /* a contact that is asked for twice: its first place has the sums */
        if (to)
            add_element(e, row, name, unless, to);
    }
    for (size_t i = 0, from = 0; status == TL_OK && i < count; i++) {
        from = compare_asked(&asked[from], &asked[i]) == 0 ? from : i;
        out[asked[i].index] = asked[from].weight > 0 ? asked[from].sum / asked[from].weight : NAN;
    }
    free(asked);
    return status;
}
