/* place.c - a kind places its elements: what it asks of the host, and what comes of it. */
#include "element/place.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/inside.h"
#include "base/kind_states.h"
#include "element/carry.h"
#include "element/line.h"
#include "element/set.h"
#include "element/walls.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Tolerance: over the size of a block, by so much a node may lie outside of it. It is what contacts take for
 * touching. */
#define OUTSIDE 1e-3

static tl_placing *placing_of(const tl_element_host *host)
{
    return host->impl;
}

/* ---------------------------------------------------------------- adding ----------------- */

static tl_status check_node(tl_placing *p, const tl_element_node *node, size_t index)
{
    tl_model *m = p->m;
    if (!tl_v3_finite(node->place) || !tl_v3_finite(node->normal) || !(node->weight >= 0 && isfinite(node->weight)))
        return tl_fail(&m->error, TL_E_PLUGIN,
                       "node %zu has a place, a normal or a weight that is not finite, or a weight below 0", index + 1);
    if (node->block == TL_NO_ID)
        return TL_OK;
    const uint32_t row = tl_block_row_quiet(m, node->block);
    if (row == TL_NO_ROW)
        return tl_fail(&m->error, TL_E_NOT_FOUND, "node %zu is on block %u, which is not there", index + 1,
                       node->block);
    const double depth = tl_block_deforms(m, row) ? 0 : tl_block_depth(m, row, tl_v3_sub(node->place, m->origin));
    if (depth < -OUTSIDE * m->blocks.size[row])
        return tl_fail(&m->error, TL_E_GEOMETRY,
                       "node %zu at (%g, %g, %g) lies %g m outside of block %u: move it into the block", index + 1,
                       node->place.x, node->place.y, node->place.z, -depth, node->block);
    return TL_OK;
}

/* Adds states, as given or their initial values; where they begin. */
static bool put_states(tl_placing *p, const double *given, bool whole, size_t times, size_t *begin)
{
    const uint32_t columns = tl_element_columns(p->kind, whole);
    *begin = p->number_count;
    if (!tl_grow(&p->number, &p->number_capacity, p->number_count + columns * times + 1, sizeof *p->number))
        return false;
    for (size_t i = 0; i < times; i++)
        for (uint32_t k = 0, at = 0; k < p->kind->state_count; k++) {
            const tl_state *state = tl_kind_state(p->kind, k);
            if ((state->kind == TL_STATE_WHOLE) == whole) {
                p->number[p->number_count++] = given ? given[i * columns + at] : state->initial;
                at++;
            }
        }
    return true;
}

static tl_status add(const tl_element_host *host, const tl_new_element *element)
{
    tl_placing *p = placing_of(host);
    tl_model *m = p->m;
    const size_t most = ((const tl_element_ops *)p->kind->ops)->memory ? TL_ELEMENT_MANY : TL_ELEMENT_NODES;
    if (element->count == 0 || element->count > most)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "an element would have %zu nodes, and 1 to %zu are allowed: make the spacing longer, or several "
                       "elements",
                       element->count, most);
    tl_status status = TL_OK;
    for (size_t k = 0; k < element->count && status == TL_OK; k++)
        status = check_node(p, &element->nodes[k], k);
    if (status != TL_OK)
        return status;
    tl_placed one = {p->set, (uint32_t)element->count, element->key, p->node_count, 0, 0};
    if (!tl_grow(&p->placed, &p->placed_capacity, p->placed_count + 1, sizeof *p->placed) ||
        !tl_grow(&p->node, &p->node_capacity, p->node_count + element->count, sizeof *p->node) ||
        !put_states(p, element->node_state, false, element->count, &one.node_state) ||
        !put_states(p, element->state, true, 1, &one.state))
        return tl_fail_memory(&m->error);
    memcpy(p->node + p->node_count, element->nodes, element->count * sizeof *p->node);
    p->node_count += element->count;
    p->placed[p->placed_count++] = one;
    return TL_OK;
}

/* ---------------------------------------------------------------- asking ----------------- */

static tl_status line(const tl_element_host *host, tl_vec3 from, tl_vec3 to, double spacing, const tl_line_node **nodes,
                      size_t *count)
{
    tl_placing *p = placing_of(host);
    const tl_status status = tl_line_find(p, from, to, spacing, count);
    *nodes = p->line;
    return status;
}

static tl_status faces(const tl_element_host *host, const char *group, tl_vec3 facing, double angle,
                       const tl_element_face **list, size_t *count)
{
    tl_placing *p = placing_of(host);
    free(p->face);
    free(p->face_corner);
    p->face = NULL;
    p->face_corner = NULL;
    *count = 0;
    if (!p->find_faces)
        return tl_fail(&p->m->error, TL_E_STATE, "outer faces cannot be asked for when elements are placed again");
    const tl_status status = p->find_faces(p->m, group, facing, angle, &p->face, &p->face_corner, count);
    *list = p->face;
    return status;
}

static tl_status walls(const tl_element_host *host, const tl_wall_filter *filter, const tl_element_wall **list,
                       size_t *count)
{
    tl_placing *p = placing_of(host);
    const tl_status status = tl_walls_find(p, filter);
    *list = p->wall;
    *count = p->wall_count;
    return status;
}

static tl_id block_at(const tl_element_host *host, tl_vec3 place)
{
    const tl_model *m = placing_of(host)->m;
    const tl_vec3 local = tl_v3_sub(place, m->origin);
    tl_id best = TL_NO_ID;
    double most = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const uint32_t body = m->blocks.body[row];
        if (tl_v3_norm(tl_v3_sub(local, tl_body_place(&m->bodies, body))) > (1 + OUTSIDE) * m->bodies.radius[body])
            continue;
        const double depth = tl_block_depth(m, row, local);
        if (depth >= most && (best == TL_NO_ID || depth > most)) {
            most = depth;
            best = m->blocks.id[row];
        }
    }
    return best;
}

static void say(const tl_element_host *host, const char *format, ...)
{
    char text[TL_ERROR_TEXT];
    va_list args;
    va_start(args, format);
    tl_text_vprint(text, sizeof text, format, args);
    va_end(args);
    tl_model_say(placing_of(host)->m, "%s: %s", placing_of(host)->kind->name, text);
}

static tl_status fail(const tl_element_host *host, tl_status status, const char *format, ...)
{
    char text[TL_ERROR_TEXT];
    va_list args;
    va_start(args, format);
    tl_text_vprint(text, sizeof text, format, args);
    va_end(args);
    return tl_fail(&placing_of(host)->m->error, status == TL_OK ? TL_E_PLUGIN : status, "%s", text);
}

void tl_placing_begin(tl_placing *p, tl_model *m, tl_faces_fn find_faces)
{
    *p = (tl_placing){.m = m, .find_faces = find_faces};
    p->host = (tl_element_host){.size = sizeof p->host,
                                .impl = p,
                                .seed = (uint64_t)m->config.seed,
                                .add = add,
                                .line = line,
                                .faces = faces,
                                .walls = walls,
                                .block_at = block_at,
                                .log = say,
                                .fail = fail};
}

tl_status tl_placing_ask(tl_placing *p, const tl_element_set *of, uint32_t set)
{
    p->kind = of->kind;
    p->set = set;
    p->m->error = (tl_error){.status = TL_OK};
    tl_enter(of->kind, "place");
    const tl_status status = tl_element_ops_of(of)->place(&p->host, of->params);
    tl_leave();
    if (status == TL_OK)
        return TL_OK;
    if (p->m->error.status == TL_OK)
        return tl_fail(&p->m->error, status, "element '%s' of plugin '%s': place() failed without saying why",
                       of->kind->name, tl_plugin_id(of->kind));
    return tl_error_prefix(&p->m->error, "element '%s': ", of->kind->name);
}

/* ---------------------------------------------------------------- making ----------------- */

/* Fills the rows of an element and its nodes. */
static void put(tl_placing *p, const tl_placed *one, uint32_t set)
{
    struct tl_elements *e = p->m->elements;
    tl_element_table *t = &e->table;
    const tl_kind *kind = e->set[set].kind;
    const size_t row = t->table.rows - 1, first = e->nodes.table.rows - one->node_count;
    t->id[row] = e->next_id++;
    t->set[row] = set;
    t->node_begin[row] = (uint32_t)first;
    t->node_count[row] = one->node_count;
    t->key[row] = one->key;
    const uint32_t whole = tl_element_columns(kind, true), columns = tl_element_columns(kind, false);
    for (uint32_t k = 0; k < whole; k++)
        t->state[k][row] = p->number[one->state + k];
    for (uint32_t i = 0; i < one->node_count; i++) {
        const tl_element_node *node = &p->node[one->node + i];
        e->nodes.block[first + i] = node->block;
        e->nodes.weight[first + i] = node->weight;
        tl_node_install(p->m, first + i, tl_v3_sub(node->place, p->m->origin), node->normal);
        for (uint32_t k = 0; k < columns; k++)
            e->nodes.state[k][first + i] = p->number[one->node_state + i * columns + k];
    }
}

/* Gives nodes the columns that what is placed needs. */
static bool hold_columns(const tl_placing *p)
{
    tl_node_table *n = &p->m->elements->nodes;
    bool faces = false, zones = false, moved = false;
    for (size_t i = 0; i < p->node_count; i++) {
        const tl_element_node *node = &p->node[i];
        const uint32_t row = node->block == TL_NO_ID ? TL_NO_ROW : tl_block_row_quiet(p->m, node->block);
        faces = faces || tl_v3_norm2(node->normal) > 0;
        zones = zones || (row != TL_NO_ROW && tl_block_deforms(p->m, row));
        moved = moved || (row != TL_NO_ROW && tl_block_has_moved(p->m, row));
    }
    return (!faces || tl_nodes_hold_normals(n, p->m->blocks.made)) && (!zones || tl_nodes_hold_zones(n)) &&
           (!moved || (tl_nodes_hold_base(n) && tl_nodes_hold_from(n)));
}

tl_status tl_placing_commit(tl_placing *p, uint32_t first_set)
{
    struct tl_elements *e = p->m->elements;
    const size_t elements = e->table.table.rows + p->placed_count, nodes = e->nodes.table.rows + p->node_count;
    if (elements >= TL_NO_ROW || nodes >= TL_NO_ROW || e->next_id > TL_NO_ROW - p->placed_count)
        return tl_fail(&p->m->error, TL_E_STATE, "there would be too many elements");
    if (!hold_columns(p) || !tl_table_reserve(&e->table.table, elements) || !tl_table_reserve(&e->nodes.table, nodes))
        return tl_fail_memory(&p->m->error);
    for (size_t k = 0; k < p->placed_count; k++) {
        const tl_placed *one = &p->placed[k];
        tl_table_resize(&e->table.table, e->table.table.rows + 1); /* there is room */
        tl_table_resize(&e->nodes.table, e->nodes.table.rows + one->node_count);
        put(p, one, first_set + one->set);
    }
    e->version++;
    return TL_OK;
}

void tl_placing_free(tl_placing *p)
{
    void *const owned[] = {p->placed, p->node, p->number, p->line, p->face, p->face_corner, p->wall, p->wall_corner};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    *p = (tl_placing){.m = NULL};
}
