/* scene_elements.c - see scene_elements.h; docs/scene_format.md says what is in the chunks.
 *
 * An element with nodes inside of blocks is a line through them. One of triangles is shown as these, each as an element
 * of its own with the same id. Another with nodes on faces is shown where its kind has a
 * state "pressure": as the polygon in which its two walls face each other, or as its one wall. A pressure that is
 * linear on the polygon has three nodes on each wall. They give it at every corner, and the line on which it is zero:
 * the part beyond that is left out. More than three nodes on a wall are the corners of the polygon, in order. Elements
 * of other kinds on faces, as quiet ones, are not shown, nor lines on the ground whose nodes stand for nothing. */
#include "io/scene_elements.h"

#include "base/columns.h"
#include "base/error.h"
#include "element/carry.h"
#include "element/follow.h"
#include "element/set.h"
#include "geometry/point2.h"
#include "io/json.h"
#include "io/scene_put.h"
#include "zone/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Limit: numbers of elements that a frame has. */
#define MOST_FIELDS 32
/* Corners of two faces, and one more by the line of zero pressure. */
#define MOST_CORNERS (2 * TL_POLY_MAX_VERTICES + 1)
#define PRESSURE "pressure"

enum { FACE = 8 }; /* beside TL_ELEMENT_* in flags */

/* A number of elements by its name: states of nodes and of the whole that have one name are one. */
typedef struct number {
    const char *name, *unit;
} number;

typedef struct numbers {
    number at[MOST_FIELDS];
    size_t count;
} numbers;

/* A frame in which a wall is seen: z along its normal. */
typedef struct view {
    tl_vec3 at, x, y, n;
} view;

/* What goes into the chunks, column by column. */
typedef struct columns {
    tl_model *m;
    numbers of;
    size_t elements, points;
    tl_piece id, kind, count, flags, block, place, value[MOST_FIELDS];
    tl_vec3 *corner[2]; /* [MOST_CORNERS] of the walls */
    tl_point2 *flat[3]; /* [MOST_CORNERS] */
} columns;

/* ---------------------------------------------------------------- which ------------------ */

static bool is_line(const struct tl_elements *e, size_t row)
{
    return !(tl_v3_norm2(tl_node_outward(&e->nodes, e->table.node_begin[row])) > 0);
}

static bool has_pressure(const tl_kind *kind)
{
    uint32_t column;
    bool whole;
    return tl_element_column(kind, PRESSURE, &column, &whole) && !whole;
}

static bool has_triangles(const struct tl_elements *e, size_t row)
{
    return tl_element_ops_of(&e->set[e->table.set[row]])->triangles != 0;
}

/* Whether any node is on a block, or stands for something. */
static bool acts(const struct tl_elements *e, size_t row)
{
    bool any = false;
    for (size_t k = 0; k < e->table.node_count[row] && !any; k++) {
        const size_t node = e->table.node_begin[row] + k;
        any = e->nodes.block[node] != TL_NO_ID || e->nodes.weight[node] > 0;
    }
    return any;
}

static bool is_shown(const struct tl_elements *e, size_t row)
{
    return is_line(e, row) ? e->table.node_count[row] > 1 && acts(e, row)
                           : has_triangles(e, row) || has_pressure(e->set[e->table.set[row]].kind);
}

/* Adds states with a unit; those without are flags, of which the element's own tell. */
static void add_states(numbers *list, const tl_kind *kind, bool whole)
{
    for (uint32_t k = 0; k < kind->state_count; k++) {
        const tl_state *s = &kind->states[k];
        bool known = (s->kind == TL_STATE_WHOLE) != whole || s->unit[0] == '\0' || list->count == MOST_FIELDS;
        for (size_t i = 0; i < list->count && !known; i++)
            known = strcmp(list->at[i].name, s->name) == 0;
        if (!known)
            list->at[list->count++] = (number){s->name, s->unit};
    }
}

/* The numbers of all elements that are shown: those of nodes first, in the order in which the kinds have them. */
static void list_numbers(const tl_model *m, numbers *list)
{
    const struct tl_elements *e = m->elements;
    list->count = 0;
    for (int whole = 0; whole < 2; whole++) {
        uint32_t last = UINT32_MAX; /* set whose states are in the list */
        for (size_t row = 0; row < e->table.table.rows; row++)
            if (e->table.set[row] != last && is_shown(e, row)) {
                last = e->table.set[row];
                add_states(list, e->set[last].kind, whole != 0);
            }
    }
}

void tl_scene_elements_head(const tl_model *m, tl_piece *text)
{
    numbers list;
    if (!tl_model_has_elements(m))
        return;
    list_numbers(m, &list);
    tl_json_put(text, ", \"elements\": [");
    for (size_t s = 0; s < m->elements->set_count; s++)
        tl_json_print(text, s ? ", %s" : "%s", m->elements->set[s].kind->name);
    tl_json_put(text, "], \"element_fields\": [");
    for (size_t i = 0; i < list.count; i++)
        tl_json_print(text, "%r{\"name\": %s, \"unit\": %s}", i ? ", " : "", list.at[i].name, list.at[i].unit);
    tl_json_put(text, "]");
}

/* ---------------------------------------------------------------- columns ---------------- */

/* A number of an element, at a node where it is one of nodes; NaN: its kind has none. */
static double number_of(const struct tl_elements *e, size_t row, size_t node, const char *name)
{
    uint32_t column;
    bool whole;
    if (!tl_element_column(e->set[e->table.set[row]].kind, name, &column, &whole))
        return NAN;
    return whole ? e->table.state[column][row] : e->nodes.state[column][node];
}

static void add_u32(tl_piece *to, uint32_t value)
{
    unsigned char *at = tl_piece_add(to, 4);
    if (at)
        tl_put_u32(at, value);
}

static void add_f32(tl_piece *to, double value)
{
    unsigned char *at = tl_piece_add(to, 4);
    if (at)
        tl_put_f32(at, isfinite(value) ? value : NAN);
}

static void add_element(columns *c, size_t row, size_t points, uint32_t more)
{
    const tl_element_table *t = &c->m->elements->table;
    add_u32(&c->id, t->id[row]);
    add_u32(&c->kind, t->set[row]);
    add_u32(&c->count, (uint32_t)points);
    add_u32(&c->flags, t->flags[row] | more);
    c->elements++;
}

static void add_point(columns *c, tl_vec3 place, tl_id block)
{
    unsigned char *at = tl_piece_add(&c->place, 12);
    if (at)
        tl_put_vec3(at, place);
    add_u32(&c->block, block == TL_GONE ? TL_NO_ID : block);
    c->points++;
}

static tl_vec3 place_of(const tl_model *m, size_t node)
{
    return tl_v3_add(tl_columns_get(m->elements->nodes.rest, node), tl_node_moved(m, node));
}

/* ---------------------------------------------------------------- walls ------------------ */

/* Corners of the face that a node lies on, counter-clockwise from outside; 0: it lies on none now. */
static size_t wall_of(const tl_model *m, size_t node, tl_vec3 *corner)
{
    const tl_node_table *n = &m->elements->nodes;
    const uint32_t row = n->block[node] == TL_GONE ? TL_NO_ROW : tl_block_row_quiet(m, n->block[node]);
    if (row == TL_NO_ROW)
        return 0;
    if (tl_block_deforms(m, row)) {
        for (int a = 0; a < 3; a++)
            corner[a] = tl_gridpoint_place(&m->zones->points, n->point[node][a]);
        return 3;
    }
    const tl_poly *shape = m->blocks.shape[row];
    const tl_vec3 normal = tl_columns_get(tl_node_normals(n), node);
    uint32_t face = 0; /* a convex block has one face along a normal */
    for (uint32_t f = 1; f < shape->face_count; f++)
        if (tl_v3_dot(shape->plane[f].normal, normal) > tl_v3_dot(shape->plane[face].normal, normal))
            face = f;
    const size_t count = tl_poly_face_size(shape, face);
    for (size_t i = 0; i < count; i++)
        corner[i] = tl_body_point(&m->bodies, m->blocks.body[row], shape->vertex[shape->loop[shape->start[face] + i]]);
    return count;
}

static tl_point2 seen(const view *v, tl_vec3 x)
{
    const tl_vec3 d = tl_v3_sub(x, v->at);
    return (tl_point2){tl_v3_dot(d, v->x), tl_v3_dot(d, v->y)};
}

/* The polygon in flat[0]: the first wall, or what it has in common with the second one, counter-clockwise. */
static size_t common(columns *c, const view *v, size_t count, size_t other)
{
    for (size_t i = 0; i < count; i++)
        c->flat[0][i] = seen(v, c->corner[0][i]);
    for (size_t i = 0; i < other; i++)
        c->flat[2][i] = seen(v, c->corner[1][i]);
    return other ? tl_polygon_common(&c->flat[0], &c->flat[1], count, c->flat[2], other) : count;
}

/* A number over the wall, value + gx x + gy y. */
typedef struct slope {
    double value, gx, gy;
} slope;

/* That of nodes on one wall: linear by three of them, else their mean. */
static slope slope_of(const columns *c, const view *v, size_t row, size_t nodes, const char *name)
{
    const struct tl_elements *e = c->m->elements;
    const size_t begin = e->table.node_begin[row];
    double value[3] = {0}, sum = 0;
    for (size_t i = 0; i < nodes; i++) {
        const double one = number_of(e, row, begin + i, name);
        sum += one;
        if (i < 3)
            value[i] = one;
    }
    const slope flat = {sum / (double)nodes, 0, 0};
    if (nodes != 3)
        return flat;
    const tl_point2 o = seen(v, place_of(c->m, begin)), a = tl_from_to(o, seen(v, place_of(c->m, begin + 1)));
    const tl_point2 b = tl_from_to(o, seen(v, place_of(c->m, begin + 2)));
    const double twice = a.x * b.y - a.y * b.x, p = value[1] - value[0], q = value[2] - value[0];
    if (!(fabs(twice) > 0))
        return flat;
    const double gx = (p * b.y - q * a.y) / twice, gy = (q * a.x - p * b.x) / twice;
    return (slope){value[0] - gx * o.x - gy * o.y, gx, gy};
}

static double at(const slope *s, tl_point2 q)
{
    return s->value + s->gx * q.x + s->gy * q.y;
}

/* Keeps of the polygon in flat[0] where the pressure is above zero. */
static size_t keep_wet(columns *c, const slope *pressure, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const tl_point2 here = c->flat[0][i], next = c->flat[0][(i + 1) % count];
        const double h = at(pressure, here), g = at(pressure, next);
        if (h > 0)
            c->flat[1][kept++] = here;
        if ((h > 0) != (g > 0))
            c->flat[1][kept++] = tl_part_way(here, next, h, g);
    }
    tl_point2 *swap = c->flat[0];
    c->flat[0] = c->flat[1];
    c->flat[1] = swap;
    return kept;
}

/* Nodes, and their numbers. */
static void add_nodes(columns *c, size_t row, size_t begin, size_t count)
{
    const struct tl_elements *e = c->m->elements;
    for (size_t node = begin; node < begin + count; node++) {
        add_point(c, place_of(c->m, node), e->nodes.block[node]);
        for (size_t k = 0; k < c->of.count; k++)
            add_f32(&c->value[k], number_of(e, row, node, c->of.at[k].name));
    }
}

static void add_line(columns *c, size_t row)
{
    const tl_element_table *t = &c->m->elements->table;
    add_element(c, row, t->node_count[row], 0);
    add_nodes(c, row, t->node_begin[row], t->node_count[row]);
}

static void add_triangles(columns *c, size_t row)
{
    const tl_element_table *t = &c->m->elements->table;
    for (uint32_t k = 0; k + 3 <= t->node_count[row]; k += 3) {
        add_element(c, row, 3, FACE);
        add_nodes(c, row, t->node_begin[row] + k, 3);
    }
}

/* A polygon whose corners are nodes; nothing where all of it is dry. */
static void add_corners(columns *c, size_t row, size_t begin, size_t count)
{
    bool wet = false;
    for (size_t i = 0; i < count && !wet; i++)
        wet = number_of(c->m->elements, row, begin + i, PRESSURE) > 0;
    if (!wet)
        return;
    add_element(c, row, count, FACE);
    add_nodes(c, row, begin, count);
}

static void add_wall(columns *c, size_t row)
{
    const struct tl_elements *e = c->m->elements;
    const size_t begin = e->table.node_begin[row], last = begin + e->table.node_count[row] - 1;
    const bool two = e->nodes.block[begin] != e->nodes.block[last];
    const size_t nodes = two ? e->table.node_count[row] / 2 : e->table.node_count[row];
    if (nodes > 3) {
        add_corners(c, row, begin, nodes);
        return;
    }
    const size_t count = wall_of(c->m, begin, c->corner[0]), other = two ? wall_of(c->m, last, c->corner[1]) : 0;
    if (count < 3 || (two && other < 3))
        return;
    const tl_vec3 own = tl_node_normal(c->m, begin);
    const tl_vec3 n = two ? tl_v3_unit(tl_v3_sub(own, tl_node_normal(c->m, last))) : own, x = tl_v3_perpendicular(n);
    const view v = {c->corner[0][0], x, tl_v3_cross(n, x), n};
    const slope pressure = slope_of(c, &v, row, nodes, PRESSURE);
    const size_t wet = keep_wet(c, &pressure, common(c, &v, count, other));
    if (wet < 3)
        return;
    add_element(c, row, wet, FACE);
    for (size_t i = 0; i < wet; i++) {
        const tl_point2 q = c->flat[0][i];
        const tl_vec3 on = tl_v3_madd(tl_v3_madd(v.at, q.x, v.x), q.y, v.y);
        const double away = tl_v3_dot(own, tl_v3_sub(v.at, on)) / tl_v3_dot(own, n);
        add_point(c, tl_v3_madd(on, away, n), e->nodes.block[begin]);
        for (size_t k = 0; k < c->of.count; k++) {
            const slope s = slope_of(c, &v, row, nodes, c->of.at[k].name);
            add_f32(&c->value[k], at(&s, q));
        }
    }
}

/* ---------------------------------------------------------------- chunks ----------------- */

static void copy_column(unsigned char **to, const tl_piece *from)
{
    if (from->length)
        memcpy(*to, from->data, from->length);
    *to += from->length;
}

static tl_status put_columns(columns *c, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "ELEM", 8 + 16 * c->elements + 16 * c->points, &c->m->error);
    if (!to)
        return c->m->error.status;
    to = tl_put_u32(to, (uint32_t)c->elements);
    to = tl_put_u32(to, (uint32_t)c->points);
    const tl_piece *const list[] = {&c->id, &c->kind, &c->count, &c->flags, &c->block, &c->place};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++)
        copy_column(&to, list[k]);
    for (size_t k = 0; k < c->of.count; k++) {
        to = tl_scene_chunk(out, "EFLD", 8 + 4 * c->points, &c->m->error);
        if (!to)
            return c->m->error.status;
        to = tl_put_u32(to, (uint32_t)k);
        to = tl_put_u32(to, (uint32_t)c->points);
        copy_column(&to, &c->value[k]);
    }
    return TL_OK;
}

tl_status tl_scene_elements(tl_model *m, tl_piece *out)
{
    if (!tl_model_has_elements(m))
        return TL_OK;
    const tl_status followed = tl_elements_follow(m);
    if (followed != TL_OK)
        return followed;
    columns c = {.m = m};
    list_numbers(m, &c.of);
    bool failed = false;
    for (int k = 0; k < 3; k++) {
        c.flat[k] = malloc(MOST_CORNERS * sizeof *c.flat[k]);
        if (k < 2)
            c.corner[k] = malloc(TL_POLY_MAX_VERTICES * sizeof *c.corner[k]);
        failed = failed || !c.flat[k] || (k < 2 && !c.corner[k]);
    }
    for (size_t row = 0; row < m->elements->table.table.rows && !failed; row++)
        if (is_shown(m->elements, row)) {
            if (is_line(m->elements, row))
                add_line(&c, row);
            else if (has_triangles(m->elements, row))
                add_triangles(&c, row);
            else
                add_wall(&c, row);
        }
    tl_piece *const pieces[] = {&c.id, &c.kind, &c.count, &c.flags, &c.block, &c.place};
    for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++)
        failed = failed || pieces[k]->failed;
    for (size_t k = 0; k < c.of.count; k++)
        failed = failed || c.value[k].failed;
    const tl_status status = failed ? tl_fail_memory(&m->error) : put_columns(&c, out);
    for (size_t k = 0; k < sizeof pieces / sizeof *pieces; k++)
        free(pieces[k]->data);
    for (size_t k = 0; k < MOST_FIELDS; k++)
        free(c.value[k].data);
    for (int k = 0; k < 3; k++)
        free(c.flat[k]);
    free(c.corner[0]);
    free(c.corner[1]);
    return status;
}
