/* elements.c - elements, as a program or a script makes, asks for and changes them. */
#include "base/error.h"
#include "cycle/undo.h"
#include "element/follow.h"
#include "element/life.h"
#include "element/place.h"
#include "element/relay.h"
#include "element/set.h"
#include "element/steady.h"
#include "element/together.h"
#include "model/joints.h"
#include "model/rows.h"
#include "plugin/loader.h"
#include "query/element_fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/boundary.h>
#include <talus/elements.h>
#include <talus/number.h>

/* What elements do has changed: the balance takes the change for one by hand, and the next step is kept. */
static void changed(tl_model *m)
{
    tl_steady_let_go(m);
    m->elements->version++;
    m->laws++;
    tl_undo_by_hand(m);
    if (m->cycle)
        m->cycle->dt = 0;
}

/* ---------------------------------------------------------------- making ----------------- */

/* Outer faces of a group, with their corners: the service `faces` of element/place.h. */
static tl_status find_faces(tl_model *m, const char *group, tl_vec3 facing, double angle, tl_element_face **faces,
                            tl_vec3 **corners, size_t *count)
{
    tl_boundary_action action = tl_boundary_action_default();
    tl_boundary_result found;
    if (tl_v3_norm2(facing) > 0) {
        action.where.facing = facing;
        action.where.within = angle;
    }
    tl_status status = tl_model_boundary(m, &action, 1, false, &found);
    if (status == TL_E_NOT_FOUND)
        return TL_OK;
    if (status != TL_OK)
        return status;
    size_t corner_count = 0, at = 0;
    for (size_t i = 0; i < found.face_count; i++)
        corner_count +=
            tl_poly_face_size(m->blocks.shape[tl_block_row_quiet(m, found.faces[i].block)], found.faces[i].face);
    *faces = malloc((found.face_count + 1) * sizeof **faces);
    *corners = malloc((corner_count + 1) * sizeof **corners);
    for (size_t i = 0; i < found.face_count && *faces && *corners; i++) {
        const tl_boundary_face *f = &found.faces[i];
        const uint32_t row = tl_block_row_quiet(m, f->block);
        const tl_poly *shape = m->blocks.shape[row];
        if (group && strcmp(m->groups[m->blocks.group[row]], group) != 0)
            continue;
        tl_element_face *to = &(*faces)[(*count)++];
        *to = (tl_element_face){f->block, f->face, f->normal, *corners + at, tl_poly_face_size(shape, f->face)};
        for (size_t k = 0; k < to->corner_count; k++)
            (*corners)[at++] =
                tl_model_point(m, m->blocks.body[row], shape->vertex[shape->loop[shape->start[f->face] + k]]);
    }
    tl_boundary_free(&found);
    return *faces && *corners ? TL_OK : tl_fail_memory(&m->error);
}

/* One call: its sets, and what they place. */
typedef struct making {
    tl_model *m;
    const tl_kind *kind;
    tl_element_set *set;
    size_t count;
    tl_placing placing;
} making;

static tl_status make_one(making *k, const tl_args *args, uint32_t group, size_t of)
{
    tl_model *m = k->m;
    char context[80];
    tl_text_print(context, sizeof context, "element '%.40s'", k->kind->name);
    tl_status status = tl_element_set_make(k->kind, args, NULL, context, &m->error, &k->set[k->count]);
    if (status == TL_OK) {
        k->set[k->count].group = group;
        k->set[k->count].structure = m->structure;
        status = tl_placing_ask(&k->placing, &k->set[k->count], (uint32_t)k->count);
        k->count++;
    }
    return status == TL_OK || of == 1 ? status : tl_error_prefix(&m->error, "entry %zu: ", k->count);
}

/* Gives the model the sets and their elements. */
static tl_status commit(making *k, tl_id **ids, size_t *made)
{
    tl_model *m = k->m;
    struct tl_elements *e = m->elements;
    const size_t before = e->table.table.rows, nodes = e->nodes.table.rows, placed = k->placing.placed_count;
    tl_id *list = malloc((placed + 1) * sizeof *list);
    const bool enough =
        list && tl_grow(&e->set, &e->set_capacity, e->set_count + k->count, sizeof *e->set) &&
        tl_elements_hold_states(e, tl_element_columns(k->kind, false), tl_element_columns(k->kind, true));
    if (!enough) {
        free(list);
        return tl_fail_memory(&m->error);
    }
    memcpy(e->set + e->set_count, k->set, k->count * sizeof *k->set);
    const uint32_t first = (uint32_t)e->set_count;
    e->set_count += k->count;
    tl_steady_let_go(m);
    tl_status status = tl_placing_commit(&k->placing, first);
    if (status == TL_OK)
        status = tl_elements_together(m, before, false);
    if (status != TL_OK) {
        tl_table_resize(&e->table.table, before);
        tl_table_resize(&e->nodes.table, nodes);
        e->set_count -= k->count;
        free(list);
        return status;
    }
    for (size_t i = 0; i < placed; i++)
        list[i] = e->table.id[before + i];
    if (placed > 0 && tl_element_ops_of(&e->set[first])->lays_again && !tl_elements_give_way(e, before)) {
        tl_table_resize(&e->table.table, before);
        tl_table_resize(&e->nodes.table, nodes);
        e->set_count -= k->count;
        free(list);
        return tl_fail_memory(&m->error);
    }
    k->count = 0; /* they are the model's */
    changed(m);
    if (made)
        *made = placed;
    if (ids)
        *ids = list;
    else
        free(list);
    return TL_OK;
}

/* Begins a call, and has the kind place what it is for. */
static tl_status ask(making *k, const char *kind, const tl_args *args, size_t count, const char *group)
{
    tl_model *m = k->m;
    tl_status status = tl_model_may_set(m, "place elements");
    if (status != TL_OK)
        return status;
    k->kind = tl_plugin_find(TL_KIND_ELEMENT, kind);
    if (!k->kind)
        return tl_kind_unknown(&m->error, TL_KIND_ELEMENT, kind);
    tl_rows_tidy(m);
    const uint32_t number = tl_group_intern(m, group ? group : "");
    k->set = calloc(count + 1, sizeof *k->set);
    if (number == UINT32_MAX || !k->set || !tl_elements_begin(m))
        return tl_fail_memory(&m->error);
    status = tl_elements_follow(m);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = make_one(k, &args[i], number, count);
    return status;
}

static void end(making *k)
{
    for (size_t i = 0; i < k->count; i++)
        tl_element_set_clear(&k->set[i]);
    free(k->set);
    tl_placing_free(&k->placing);
}

tl_status tl_model_element(tl_model *m, const char *kind, const tl_args *args, size_t count, const char *group,
                           tl_id **ids, size_t *made)
{
    making k = {.m = m};
    if (ids)
        *ids = NULL;
    if (made)
        *made = 0;
    tl_placing_begin(&k.placing, m, find_faces);
    tl_status status = ask(&k, kind, args, count, group);
    if (status == TL_OK)
        status = commit(&k, ids, made);
    end(&k);
    return status;
}

tl_status tl_model_element_places(tl_model *m, const char *kind, const tl_args *args, size_t count, tl_vec3 **places,
                                  size_t *nodes)
{
    making k = {.m = m};
    *places = NULL;
    *nodes = 0;
    tl_placing_begin(&k.placing, m, find_faces);
    tl_status status = ask(&k, kind, args, count, NULL);
    if (status == TL_OK) {
        *places = malloc((k.placing.node_count + 1) * sizeof **places);
        status = *places ? TL_OK : tl_fail_memory(&m->error);
    }
    for (size_t i = 0; status == TL_OK && i < k.placing.node_count; i++)
        (*places)[i] = k.placing.node[i].place;
    *nodes = status == TL_OK ? k.placing.node_count : 0;
    end(&k);
    return status;
}

tl_status tl_model_element_middles(tl_model *m, const char *kind, const tl_args *args, size_t count, tl_vec3 **places,
                                   size_t *elements)
{
    making k = {.m = m};
    *places = NULL;
    *elements = 0;
    tl_placing_begin(&k.placing, m, find_faces);
    tl_status status = ask(&k, kind, args, count, NULL);
    if (status == TL_OK) {
        *places = malloc((k.placing.placed_count + 1) * sizeof **places);
        status = *places ? TL_OK : tl_fail_memory(&m->error);
    }
    for (size_t i = 0; status == TL_OK && i < k.placing.placed_count; i++) {
        const tl_placed *one = &k.placing.placed[i];
        tl_vec3 sum = {0, 0, 0};
        for (size_t n = 0; n < one->node_count; n++)
            sum = tl_v3_add(sum, k.placing.node[one->node + n].place);
        (*places)[i] = tl_v3_scale(1.0 / one->node_count, sum);
    }
    *elements = status == TL_OK ? k.placing.placed_count : 0;
    end(&k);
    return status;
}

/* ---------------------------------------------------------------- changing --------------- */

tl_status tl_element_put(tl_model *m, tl_id element, size_t index, const char *name, double value)
{
    tl_status status = tl_model_may_set(m, "change elements");
    if (status != TL_OK)
        return status;
    if (!isfinite(value))
        return tl_fail(&m->error, TL_E_ARGUMENT, "'%.80s' = %g must be finite", name, value);
    double *at = tl_element_state_at(m, element, index, name);
    if (!at)
        return m->error.status;
    *at = value;
    changed(m);
    return TL_OK;
}

tl_status tl_elements_renew(tl_model *m)
{
    tl_status status = tl_model_may_set(m, "change elements");
    if (status != TL_OK || !tl_model_has_elements(m))
        return status;
    tl_rows_tidy(m);
    status = tl_elements_follow(m);
    if (status == TL_OK)
        status = tl_elements_together(m, 0, false);
    if (status == TL_OK)
        changed(m);
    return status;
}

/* Whether all that is given may be set after placing. */
static tl_status check_args(tl_model *m, const tl_kind *kind, const tl_args *args)
{
    for (size_t i = 0; i < args->count; i++)
        for (uint32_t k = 0; k < kind->param_count; k++) {
            const tl_param *p = &kind->params[k];
            const char *key = args->values[i].key;
            if (p->flags & TL_PARAM_PLACE && (strcmp(p->name, key) == 0 || (p->alias && strcmp(p->alias, key) == 0)))
                return tl_fail(&m->error, TL_E_ARGUMENT,
                               "element '%s': %s says where it is and cannot be set; delete the element and place "
                               "another",
                               kind->name, p->name);
        }
    return TL_OK;
}

/* Of each set how many elements it has, and how many of them are listed. */
typedef struct chosen {
    uint32_t all, some;
} chosen;

/* Counts them; NULL: out of memory. A kind that places again repeats whole calls, so parts of one cannot differ. */
static chosen *choose(tl_model *m, const uint32_t *row, size_t count, const char *what)
{
    const struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    chosen *of = calloc(e->set_count + 1, sizeof *of);
    unsigned char *listed = calloc(t->table.rows + 1, 1);
    tl_status status = of && listed ? TL_OK : tl_fail_memory(&m->error);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        listed[row[i]] = 1;
    for (size_t i = 0; i < t->table.rows && status == TL_OK; i++) {
        of[t->set[i]].all++;
        of[t->set[i]].some += listed[i];
    }
    for (size_t k = 0; k < e->set_count && status == TL_OK; k++)
        if (of[k].some > 0 && of[k].some < of[k].all && tl_element_ops_of(&e->set[k])->lays_again)
            status =
                tl_fail(&m->error, TL_E_ARGUMENT,
                        "element '%s': %u of the %u that one call has placed cannot be %s alone, for the call is "
                        "repeated as a whole where blocks change: name all of them, or make another call for those "
                        "places",
                        e->set[k].kind->name, of[k].some, of[k].all, what);
    free(listed);
    if (status != TL_OK) {
        free(of);
        return NULL;
    }
    return of;
}

/* Makes the sets with the parameters, one for each that has listed elements, at fresh[count of sets]. */
static tl_status make_sets(tl_model *m, const chosen *of, const tl_args *args, tl_element_set *fresh)
{
    const struct tl_elements *e = m->elements;
    tl_status status = TL_OK;
    for (size_t k = 0; k < e->set_count && status == TL_OK; k++) {
        char context[80];
        if (of[k].some == 0)
            continue;
        tl_text_print(context, sizeof context, "element '%.40s'", e->set[k].kind->name);
        status = check_args(m, e->set[k].kind, args);
        if (status == TL_OK)
            status = tl_element_set_make(e->set[k].kind, args, &e->set[k], context, &m->error, &fresh[k]);
    }
    return status;
}

/* Puts a new set in the place of one whose elements are all listed, so that the order of calls stays. Of others the
 * listed elements get the new one, which comes last. */
static void put_sets(struct tl_elements *e, const uint32_t *row, size_t count, const chosen *of, tl_element_set *fresh)
{
    const size_t before = e->set_count;
    for (size_t k = 0; k < before; k++) {
        if (of[k].some == 0)
            continue;
        if (of[k].some == of[k].all) {
            tl_element_set_clear(&e->set[k]);
            e->set[k] = fresh[k];
        } else {
            for (size_t i = 0; i < count; i++)
                if (e->table.set[row[i]] == k)
                    e->table.set[row[i]] = (uint32_t)e->set_count;
            e->set[e->set_count++] = fresh[k];
        }
        fresh[k] = (tl_element_set){.kind = NULL};
    }
}

static tl_status set_all(tl_model *m, const uint32_t *row, size_t count, const tl_args *args)
{
    struct tl_elements *e = m->elements;
    const size_t before = e->set_count;
    chosen *of = choose(m, row, count, "changed");
    if (!of)
        return m->error.status;
    tl_element_set *fresh = calloc(before + 1, sizeof *fresh);
    tl_status status =
        fresh && tl_grow(&e->set, &e->set_capacity, 2 * before, sizeof *e->set) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = make_sets(m, of, args, fresh);
    if (status == TL_OK)
        put_sets(e, row, count, of, fresh);
    for (size_t k = 0; fresh && k < before; k++)
        if (fresh[k].kind)
            tl_element_set_clear(&fresh[k]);
    free(fresh);
    free(of);
    return status;
}

/* Rows of elements, by their ids; NULL after an error. */
static uint32_t *rows_of(tl_model *m, const tl_id *elements, size_t count)
{
    uint32_t *row = malloc((count + 1) * sizeof *row);
    if (!row)
        tl_fail_memory(&m->error);
    for (size_t i = 0; row && i < count; i++) {
        row[i] = tl_element_find(m, elements[i]);
        if (row[i] == TL_NO_ROW) {
            free(row);
            return NULL;
        }
    }
    return row;
}

tl_status tl_elements_set(tl_model *m, const tl_id *elements, size_t count, const tl_args *args)
{
    tl_status status = tl_model_may_set(m, "change elements");
    if (status != TL_OK || count == 0 || args->count == 0)
        return status;
    uint32_t *row = rows_of(m, elements, count);
    if (!row)
        return m->error.status;
    status = set_all(m, row, count, args);
    free(row);
    if (status == TL_OK)
        changed(m);
    return status;
}

tl_status tl_elements_delete(tl_model *m, const tl_id *elements, size_t count)
{
    tl_status status = tl_model_may_set(m, "delete elements");
    if (status != TL_OK || count == 0)
        return status;
    uint32_t *row = rows_of(m, elements, count);
    if (!row)
        return m->error.status;
    struct tl_elements *e = m->elements;
    chosen *of = choose(m, row, count, "deleted");
    if (!of) {
        free(row);
        return m->error.status;
    }
    free(of);
    unsigned char *keep = malloc(e->table.table.rows + 1);
    if (keep) {
        memset(keep, 1, e->table.table.rows);
        for (size_t i = 0; i < count; i++)
            keep[row[i]] = 0;
        tl_steady_let_go(m);
        tl_elements_keep(e, keep, true);
        changed(m);
    }
    free(keep);
    free(row);
    return keep ? TL_OK : tl_fail_memory(&m->error);
}
