/* tangent.c - how the forces of an element change with small motions of its bodies.
 *
 * f are the forces of the nodes, F those of the bodies with moments about the centroids. With J the motions of nodes by
 * those of bodies, F = J^t f. The tangent is
 *
 *     K = -J^t (df/du) J
 *
 * by differences of f over small motions to both sides. Arms and normals stay: as for contacts, what forces do by
 * turning with a body is left out. K of forces that come from an energy is symmetric, and the mean with its transpose
 * is taken. */
#include "element/tangent.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/inside.h"
#include "element/carry.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Constant: size of the motions over that of the element. Forces bend by its square, and rounding of places counts by
 * its inverse. */
#define MOTION 1e-7
/* Tolerance: relative difference of the stiffnesses to both sides from which on an element yields to one of them. Test:
 * lua/test_modes. */
#define ONE_SIDED 1e-3
/* Tolerance: of the change of forces when one body moves, the part that an internal element may have when all do. Test:
 * lua/test_modes. */
#define TOGETHER 1e-3

/* Of one element: columns of its nodes, and what a call of its kind changes. */
typedef struct trial {
    tl_model *m;
    const tl_element_set *set;
    uint32_t row, first, nodes;
    uint32_t *on; /* of each node: its body among those of the tangent, or TL_NO_ROW */
    double *numbers, *rest[3], *u[3], *du[3], *v[3], *normal[3], *force[3], *arm[3], *was[3];
    double *state[TL_ELEMENT_COLUMNS], whole[TL_ELEMENT_COLUMNS], *whole_at[TL_ELEMENT_COLUMNS];
} trial;

enum { VECTORS = 8 };

static bool begin(trial *t)
{
    const tl_element_table *table = &t->m->elements->table;
    const tl_node_table *n = &t->m->elements->nodes;
    t->first = table->node_begin[t->row];
    t->nodes = table->node_count[t->row];
    t->set = &t->m->elements->set[table->set[t->row]];
    t->on = malloc(t->nodes * sizeof *t->on);
    t->numbers = calloc((3 * VECTORS + (size_t)n->state_columns) * t->nodes, sizeof *t->numbers);
    if (!t->on || !t->numbers)
        return false;
    double *next = t->numbers;
    double **const vector[VECTORS] = {t->rest, t->u, t->du, t->v, t->normal, t->force, t->arm, t->was};
    for (int k = 0; k < 3 * VECTORS; k++, next += t->nodes)
        vector[k / 3][k % 3] = next;
    for (uint32_t k = 0; k < n->state_columns; k++, next += t->nodes)
        t->state[k] = next;
    for (uint32_t k = 0; k < table->state_columns; k++)
        t->whole_at[k] = &t->whole[k];
    for (uint32_t i = 0; i < t->nodes; i++) {
        tl_columns_put(t->rest, i, tl_columns_get(n->rest, t->first + i));
        tl_columns_put(t->normal, i, tl_node_normal(t->m, t->first + i));
    }
    return true;
}

/* Lists the bodies that carry nodes and can move. */
static void list_bodies(trial *t, tl_element_tangent *out)
{
    const tl_model *m = t->m;
    const tl_node_table *n = &m->elements->nodes;
    out->count = 0;
    for (uint32_t i = 0; i < t->nodes; i++) {
        const uint32_t body = n->body[t->first + i];
        t->on[i] = TL_NO_ROW;
        if (body == TL_NO_ROW || m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        uint32_t k = 0;
        while (k < out->count && out->body[k] != body)
            k++;
        out->count += k == out->count;
        out->body[k] = body;
        t->on[i] = k;
        tl_columns_put(t->arm, i, tl_m3_mul(&m->bodies.pose[body].r, tl_columns_get(n->local, t->first + i)));
    }
}

/* The largest distance of a node from the first one, m. */
static double size_of(const trial *t)
{
    double most = 0;
    for (uint32_t i = 1; i < t->nodes; i++)
        most = fmax(most, tl_v3_norm2(tl_v3_sub(tl_columns_get(t->rest, i), tl_columns_get(t->rest, 0))));
    return sqrt(most);
}

/* A motion of a body, or of all nodes. */
typedef struct motion {
    uint32_t body; /* of the tangent; TL_NO_ROW: all nodes go along */
    tl_vec3 shift, turn;
} motion;

/* Asks for the forces after a motion, a copy of all else as it is. */
static tl_status ask(trial *t, const motion *by)
{
    const struct tl_elements *e = t->m->elements;
    const tl_node_table *n = &e->nodes;
    uint32_t start[] = {0, t->nodes}, flags = e->table.flags[t->row];
    double stored = e->table.stored[t->row], lost = 0, given = 0;
    for (uint32_t i = 0; i < t->nodes; i++) {
        const bool moves = by->body == TL_NO_ROW || t->on[i] == by->body;
        const tl_vec3 way = tl_v3_add(by->shift, tl_v3_cross(by->turn, tl_columns_get(t->arm, i)));
        const tl_vec3 du = moves ? way : tl_v3(0, 0, 0);
        tl_columns_put(t->u, i, tl_v3_add(tl_node_moved(t->m, t->first + i), du));
        tl_columns_put(t->du, i, du);
        tl_columns_put(t->force, i, tl_columns_get(n->force, t->first + i));
    }
    for (uint32_t k = 0; k < n->state_columns; k++)
        memcpy(t->state[k], n->state[k] + t->first, t->nodes * sizeof *t->state[k]);
    for (uint32_t k = 0; k < e->table.state_columns; k++)
        t->whole[k] = e->table.state[k][t->row];
    tl_element_batch b = {.size = sizeof b,
                          .count = 1,
                          .time = t->m->time,
                          .origin = t->m->origin,
                          .start = start,
                          .weight = n->weight + t->first,
                          .state = t->state,
                          .element_state = t->whole_at,
                          .flags = &flags,
                          .stored = &stored,
                          .lost = &lost,
                          .given = &given,
                          .memory = e->memory ? &e->memory[t->row] : NULL}; /* no result depends on it */
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        b.rest[k] = t->rest[k];
        b.u[k] = t->u[k];
        b.du[k] = t->du[k];
        b.v[k] = t->v[k];
        b.normal[k] = t->normal[k];
        b.force[k] = t->force[k];
    }
    tl_report report = {.size = sizeof report};
    tl_enter(t->set->kind, "update");
    const tl_status status = tl_element_ops_of(t->set)->update(t->set->self, &b, &report);
    tl_leave();
    for (uint32_t i = 0; i < t->nodes; i++)
        sum += 0 * (t->force[0][i] + t->force[1][i] + t->force[2][i]);
    if (status == TL_OK && isfinite(sum))
        return TL_OK;
    return tl_fail(&t->m->error, status == TL_OK ? TL_E_NUMERIC : status, "element %u, '%s' of plugin '%s': %s",
                   e->table.id[t->row], t->set->kind->name, tl_plugin_id(t->set->kind),
                   status == TL_OK ? "it gives a force that is not finite" : tl_report_text(&report, status));
}

static void keep(const trial *t, double *const to[3])
{
    for (int k = 0; k < 3; k++)
        memcpy(to[k], t->force[k], t->nodes * sizeof *to[k]);
}

/* What resists, of forces that were `had` and are `has`: forces and moments of all bodies, over the size of the
 * motion. */
static void resist(const trial *t, double *const had[3], double *const has[3], double per, uint32_t count, double *to)
{
    memset(to, 0, 6 * (size_t)count * sizeof *to);
    for (uint32_t i = 0; i < t->nodes; i++) {
        if (t->on[i] == TL_NO_ROW)
            continue;
        const tl_vec3 f = tl_v3_scale(per, tl_v3_sub(tl_columns_get(had, i), tl_columns_get(has, i)));
        const tl_vec3 moment = tl_v3_cross(tl_columns_get(t->arm, i), f);
        double *of = to + 6 * (size_t)t->on[i];
        for (int k = 0; k < 3; k++) {
            of[k] += (&f.x)[k];
            of[3 + k] += (&moment.x)[k];
        }
    }
}

/* The largest change of a force, N. */
static double change(const trial *t, double *const had[3])
{
    double most = 0;
    for (uint32_t i = 0; i < t->nodes; i++)
        most = fmax(most, tl_v3_norm2(tl_v3_sub(tl_columns_get(t->force, i), tl_columns_get(had, i))));
    return sqrt(most);
}

/* Column j of the tangent: with `size` the motion at a node, m, and `most` the largest change of a force so far. */
static tl_status find_column(trial *t, tl_element_tangent *out, uint32_t j, double size, double *column, double *most)
{
    const uint32_t width = 6 * out->count;
    double arm = 0, *back = column, *on = column + width, by;
    for (uint32_t i = 0; i < t->nodes; i++)
        if (t->on[i] == j / 6)
            arm = fmax(arm, tl_v3_norm(tl_columns_get(t->arm, i)));
    by = j % 6 < 3 ? size : arm > 0 ? size / arm : 0;
    motion way = {.body = j / 6};
    (&(j % 6 < 3 ? &way.shift : &way.turn)->x)[j % 3] = -by;
    tl_status status = by > 0 ? ask(t, &way) : TL_OK;
    if (!(by > 0) || status != TL_OK)
        return status;
    *most = fmax(*most, change(t, t->was));
    resist(t, t->force, t->was, 1 / by, out->count, back);
    (&(j % 6 < 3 ? &way.shift : &way.turn)->x)[j % 3] = by;
    status = ask(t, &way);
    if (status != TL_OK)
        return status;
    *most = fmax(*most, change(t, t->was));
    resist(t, t->was, t->force, 1 / by, out->count, on);
    const bool even = fabs(on[j] - back[j]) <= ONE_SIDED * fmax(fabs(on[j]), fabs(back[j]));
    for (uint32_t i = 0; i < width; i++)
        out->k[(size_t)i * width + j] = even ? 0.5 * (on[i] + back[i]) : on[j] > back[j] ? on[i] : back[i];
    return TL_OK;
}

/* Whether the forces stay when all nodes move together along any axis. */
static tl_status find_internal(trial *t, tl_element_tangent *out, double size, double most)
{
    out->internal = true;
    for (int axis = 0; axis < 3; axis++) {
        motion all = {.body = TL_NO_ROW};
        (&all.shift.x)[axis] = size;
        const tl_status status = ask(t, &all);
        if (status != TL_OK)
            return status;
        out->internal = out->internal && change(t, t->was) <= TOGETHER * most;
    }
    return TL_OK;
}

static tl_status find(trial *t, tl_element_tangent *out, double *column)
{
    const uint32_t width = 6 * out->count;
    const double size = MOTION * size_of(t);
    double most = 0;
    const motion none = {.body = TL_NO_ROW};
    tl_status status = ask(t, &none);
    keep(t, t->was);
    for (uint32_t j = 0; j < width && status == TL_OK; j++)
        status = find_column(t, out, j, size, column, &most);
    for (uint32_t i = 0; i < width; i++)
        for (uint32_t j = 0; j < i; j++) {
            double *a = &out->k[(size_t)i * width + j], *b = &out->k[(size_t)j * width + i];
            *a = *b = 0.5 * (*a + *b);
        }
    return status == TL_OK ? find_internal(t, out, size, most) : status;
}

tl_status tl_element_tangent_find(tl_model *m, uint32_t row, tl_element_tangent *out)
{
    trial t = {.m = m, .row = row};
    double *column = NULL;
    tl_element_tangent_free(out);
    tl_status status = TL_OK;
    out->body = malloc(m->elements->table.node_count[row] * sizeof *out->body);
    if (out->body && begin(&t)) {
        list_bodies(&t, out);
        const size_t width = 6 * (size_t)out->count;
        out->k = calloc(width * width + 1, sizeof *out->k);
        column = malloc((2 * width + 1) * sizeof *column);
        status = out->k && column ? find(&t, out, column) : tl_fail_memory(&m->error);
    } else {
        status = tl_fail_memory(&m->error);
    }
    free(column);
    free(t.on);
    free(t.numbers);
    return status;
}

void tl_element_tangent_free(tl_element_tangent *t)
{
    free(t->body);
    free(t->k);
    *t = (tl_element_tangent){.body = NULL};
}
