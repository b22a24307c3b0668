/* element.c - the conformance check of elements.
 *
 * A kind places its elements in a world of two blocks: block 1 is all that lies at x < 0, block 2 the rest. The square
 * |y|, |z| < 1 at x = 0 is their walls, the halves y < 0 and y > 0. That at x = -1 is an outer face of block 1. The
 * floors are outer faces, too, at z = -1: from there to x = 0 that of block 1, and on to x = 1 that of block 2. With
 * each set of parameters the nodes then go through random motions. An element that brings in nothing from outside is
 * internal: its forces are then in equilibrium, and do not see that all nodes turn and move together. What elements do
 * together comes before each update, as in a model whose steps are all due. */
#include "check/element.h"

#include "base/inside.h"
#include "base/kind_states.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Nodes and elements of one set of parameters, at most; more are left out. */
#define NODES 512
#define ELEMENTS 64
/* Columns of nodes that the check keeps, and columns of states. */
#define STATES TL_ELEMENT_COLUMNS
#define STEPS 24
/* Constant: s, of a step, and m, that nodes move in it. */
#define DT 1e-4
#define WAY 1e-6
/* Cost only: bytes of a line of the cache. */
#define LINE 64
/* Tolerance: forces, moments and energies that rounding explains, relative to their sizes: motions are 1e-6 of
 * lengths. */
#define ROUNDING 1e-7
/* Tolerance: the same of differences of motions, which rounding of places makes larger: stiff elements have forces of
 * motions of 1e-12. Test: lua/test_element. */
#define SLACK 1e-3

/* Tolerance: work that forces which turn within a step make in the second order, relative to it. Test:
 * lua/test_element. */
#define CURVED 0.05

#define RULES(RULE)                                                                                                    \
    RULE(PLACES, "places", "place() makes elements with some set of parameters, and passes failures on")               \
    RULE(RUNS, "runs", "update() returns TL_OK, always when never_fails is set")                                       \
    RULE(REPEATS, "repeats", "the same call gives the same bits")                                                      \
    RULE(SPLIT, "split", "an element alone gets the bits that it gets in a batch")                                     \
    RULE(FINITE, "finite", "forces, states and energies are finite numbers")                                           \
    RULE(STILL, "no motion", "without motion and time forces and states stay")                                         \
    RULE(SUMS, "equilibrium", "forces and moments of an internal element add up to zero")                              \
    RULE(RIGID, "rigid motion", "an internal element does not see that all its nodes move together")                   \
    RULE(BALANCE, "balance", "the work on a path is stored, lost or given")                                            \
    RULE(CYCLE, "closed path", "a closed path of an internal element makes no energy")                                 \
    RULE(STIFFNESS, "stiffness", "stiffness() gives finite numbers of at least 0")                                     \
    RULE(TOGETHER, "together",                                                                                         \
         "together() does the same in any order of the elements, and nothing more at the same time")
#define RULE_NUMBER(number, name, doc) number,
enum { RULES(RULE_NUMBER) };
#define RULE_ROW(number, name, doc) [number] = {name, doc},
static const tl_check_rule rules[] = {RULES(RULE_ROW){NULL, NULL}};

/* Elements and their nodes at one time. */
typedef struct state_of {
    double rest[3][NODES], u[3][NODES], du[3][NODES], v[3][NODES], normal[3][NODES], force[3][NODES], weight[NODES];
    double state[STATES][NODES], whole[STATES][ELEMENTS];
    double stored[ELEMENTS], lost[ELEMENTS], given[ELEMENTS];
    uint32_t flags[ELEMENTS], start[ELEMENTS + 1], count;
} state_of;

typedef struct trial {
    tl_checker *c;
    const tl_element_ops *ops;
    void *self;
    uint32_t columns[2]; /* of nodes, of the whole */
    state_of now, next, other, turned;
    tl_id block[NODES];
    bool places; /* with some set */
    char text[TL_ERROR_TEXT];
    tl_line_node line[NODES];
    double dt, time;
    double stiffest; /* N/m, of stiffness() */
    void *memory[ELEMENTS];
} trial;

/* ---------------------------------------------------------------- the world -------------- */

static tl_status fail(const tl_element_host *h, tl_status status, const char *format, ...)
{
    trial *t = h->impl;
    va_list args;
    va_start(args, format);
    tl_text_vprint(t->text, sizeof t->text, format, args);
    va_end(args);
    return status == TL_OK ? TL_E_PLUGIN : status;
}

static void quiet(const tl_element_host *h, const char *format, ...)
{
    (void)h, (void)format;
}

static tl_status add(const tl_element_host *h, const tl_new_element *one)
{
    trial *t = h->impl;
    state_of *s = &t->now;
    const uint32_t first = s->start[s->count], e = s->count;
    if (one->count == 0 || one->count > TL_ELEMENT_NODES)
        return fail(h, TL_E_ARGUMENT, "an element of %zu nodes", one->count);
    if (e == ELEMENTS || first + one->count > NODES)
        return TL_OK;
    uint32_t at[2] = {0, 0};
    for (uint32_t k = 0; k < t->c->kind->state_count; k++) {
        const tl_state *state = &t->c->kind->states[k];
        const bool whole = state->kind == TL_STATE_WHOLE;
        const uint32_t column = at[whole]++;
        if (whole)
            s->whole[column][e] = one->state ? one->state[column] : state->initial;
        for (size_t i = 0; !whole && i < one->count; i++)
            s->state[column][first + i] =
                one->node_state ? one->node_state[i * t->columns[0] + column] : state->initial;
    }
    for (size_t i = 0; i < one->count; i++) {
        const tl_element_node *node = &one->nodes[i];
        const double place[] = {node->place.x, node->place.y, node->place.z};
        const double normal[] = {node->normal.x, node->normal.y, node->normal.z};
        for (int k = 0; k < 3; k++) {
            s->rest[k][first + i] = place[k];
            s->normal[k][first + i] = normal[k];
        }
        s->weight[first + i] = node->weight;
        t->block[first + i] = node->block;
    }
    s->start[++s->count] = first + (uint32_t)one->count;
    return TL_OK;
}

static tl_id block_at(const tl_element_host *h, tl_vec3 x)
{
    (void)h;
    return x.x < 0 ? 1 : 2;
}

/* Puts nodes on a part of a line, from a on. */
static size_t put_part(trial *t, size_t n, tl_vec3 from, tl_vec3 d, const double part[2], double spacing)
{
    const double length = (part[1] - part[0]) * tl_v3_norm(d), parts = fmax(1, fmin(50, ceil(length / spacing)));
    for (size_t i = 0; i <= (size_t)parts; i++, n++) {
        const double at = part[0] + (part[1] - part[0]) * (double)i / parts;
        const bool ends = i == 0 || i == (size_t)parts;
        const tl_vec3 middle = tl_v3_madd(from, 0.5 * (part[0] + part[1]), d);
        t->line[n] = (tl_line_node){block_at(NULL, middle), (i == 0 && at > 0) || (i == (size_t)parts && at < 1),
                                    tl_v3_madd(from, at, d), at * tl_v3_norm(d), (ends ? 0.5 : 1) * length / parts};
    }
    return n;
}

static tl_status line(const tl_element_host *h, tl_vec3 from, tl_vec3 to, double spacing, const tl_line_node **nodes,
                      size_t *count)
{
    trial *t = h->impl;
    const tl_vec3 d = tl_v3_sub(to, from);
    const double cross = d.x != 0 ? -from.x / d.x : -1;
    *nodes = t->line;
    *count = 0;
    if (!(tl_v3_norm(d) > 0) || !(spacing > 0))
        return fail(h, TL_E_ARGUMENT, "a line without length, or a spacing of %g m", spacing);
    const bool both = cross > 0 && cross < 1;
    *count = put_part(t, 0, from, d, (const double[]){0, both ? cross : 1}, spacing);
    if (both)
        *count = put_part(t, *count, from, d, (const double[]){cross, 1}, spacing);
    return TL_OK;
}

static tl_status faces(const tl_element_host *h, const char *group, tl_vec3 facing, double angle,
                       const tl_element_face **list, size_t *count)
{
    static const tl_vec3 wall[] = {{-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}};
    static const tl_vec3 floor1[] = {{-1, -1, -1}, {-1, 1, -1}, {0, 1, -1}, {0, -1, -1}};
    static const tl_vec3 floor2[] = {{0, -1, -1}, {0, 1, -1}, {1, 1, -1}, {1, -1, -1}};
    static const tl_element_face face[] = {
        {1, 0, {-1, 0, 0}, wall, 4}, {1, 1, {0, 0, -1}, floor1, 4}, {2, 0, {0, 0, -1}, floor2, 4}};
    (void)h, (void)group, (void)facing, (void)angle;
    *list = face;
    *count = sizeof face / sizeof *face;
    return TL_OK;
}

static tl_status walls(const tl_element_host *h, const tl_wall_filter *filter, const tl_element_wall **list,
                       size_t *count)
{
    static const tl_vec3 low[] = {{0, -1, -1}, {0, 0, -1}, {0, 0, 1}, {0, -1, 1}},
                         high[] = {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
    static const tl_element_wall halves[] = {{{1, 2}, {0, 0}, "A", {{1, 0, 0}, {-1, 0, 0}}, {low, low}, 4, 2, 0},
                                             {{1, 2}, {0, 0}, "A", {{1, 0, 0}, {-1, 0, 0}}, {high, high}, 4, 2, 0}};
    (void)h, (void)filter;
    *list = halves;
    *count = 2;
    return TL_OK;
}

/* ---------------------------------------------------------------- memory ----------------- */

/* All elements where they are, without motion; `state` and `whole` are lists to fill. */
static tl_element_batch all_of(state_of *s, double *state[STATES], double *whole[STATES])
{
    for (int n = 0; n < STATES; n++) {
        state[n] = s->state[n];
        whole[n] = s->whole[n];
    }
    return (tl_element_batch){.size = sizeof(tl_element_batch),
                              .count = s->count,
                              .start = s->start,
                              .rest = {s->rest[0], s->rest[1], s->rest[2]},
                              .u = {s->u[0], s->u[1], s->u[2]},
                              .du = {s->du[0], s->du[1], s->du[2]},
                              .v = {s->v[0], s->v[1], s->v[2]},
                              .normal = {s->normal[0], s->normal[1], s->normal[2]},
                              .weight = s->weight,
                              .state = state,
                              .element_state = whole,
                              .flags = s->flags,
                              .force = {s->force[0], s->force[1], s->force[2]},
                              .stored = s->stored,
                              .lost = s->lost,
                              .given = s->given};
}

static void forget(trial *t)
{
    for (int e = 0; e < ELEMENTS; e++) {
        free(t->memory[e]);
        t->memory[e] = NULL;
    }
}

/* Gives elements the memory that their kind asks for, all 0. false: out of memory. */
static bool remember(trial *t)
{
    size_t bytes[ELEMENTS] = {0};
    double *state[STATES], *whole[STATES];
    bool enough = true;
    forget(t);
    if (!t->ops->memory)
        return true;
    const tl_element_batch b = all_of(&t->now, state, whole);
    tl_enter(t->c->kind, "memory");
    t->ops->memory(t->self, &b, bytes);
    tl_leave();
    for (uint32_t e = 0; e < t->now.count; e++) {
        const size_t lines = (bytes[e] + LINE - 1) / LINE + 1;
        t->memory[e] = aligned_alloc(LINE, lines * LINE);
        enough = enough && t->memory[e];
        if (t->memory[e])
            memset(t->memory[e], 0, lines * LINE);
    }
    return enough;
}

/* ---------------------------------------------------------------- updates ---------------- */

/* Updates elements [first, end) of a state in place. */
static tl_status update(trial *t, state_of *s, uint32_t first, uint32_t end)
{
    double *state[STATES], *whole[STATES];
    uint32_t start[ELEMENTS + 1];
    const uint32_t node = s->start[first];
    tl_report report = {.size = sizeof report};
    tl_element_batch b = {.size = sizeof b, .count = end - first, .dt = t->dt, .time = t->time, .start = start};
    for (uint32_t e = first; e <= end; e++)
        start[e - first] = s->start[e] - node;
    for (int k = 0; k < 3; k++) {
        b.rest[k] = s->rest[k] + node;
        b.u[k] = s->u[k] + node;
        b.du[k] = s->du[k] + node;
        b.v[k] = s->v[k] + node;
        b.normal[k] = s->normal[k] + node;
        b.force[k] = s->force[k] + node;
    }
    for (int k = 0; k < STATES; k++) {
        state[k] = s->state[k] + node;
        whole[k] = s->whole[k] + first;
    }
    b.weight = s->weight + node;
    b.state = state;
    b.element_state = whole;
    b.flags = s->flags + first;
    b.stored = s->stored + first;
    b.lost = s->lost + first;
    b.given = s->given + first;
    b.memory = t->ops->memory ? t->memory + first : NULL;
    memset(b.lost, 0, b.count * sizeof *b.lost);
    memset(b.given, 0, b.count * sizeof *b.given);
    tl_enter(t->c->kind, "update");
    const tl_status status = t->ops->update(t->self, &b, &report);
    tl_leave();
    if (status != TL_OK)
        tl_check_note(t->c, RUNS, "update() failed: %s", tl_report_text(&report, status));
    return status;
}

/* Copies element e of a state, and its nodes, to element k of another, behind what that has. */
static void copy_element(const state_of *from, uint32_t e, state_of *to, uint32_t k)
{
    const uint32_t first = from->start[e], count = from->start[e + 1] - first, into = to->start[k];
    const double(*const columns[])[NODES] = {from->rest, from->u, from->normal, &from->weight, from->state};
    double(*const into_columns[])[NODES] = {to->rest, to->u, to->normal, &to->weight, to->state};
    static const int widths[] = {3, 3, 3, 1, STATES};
    for (size_t c = 0; c < sizeof widths / sizeof *widths; c++)
        for (int w = 0; w < widths[c]; w++)
            memcpy(into_columns[c][w] + into, columns[c][w] + first, count * sizeof(double));
    for (int w = 0; w < STATES; w++)
        to->whole[w][k] = from->whole[w][e];
    to->flags[k] = from->flags[e];
    to->start[k + 1] = into + count;
}

/* The elements of a state in the opposite order. */
static void turn_round(const state_of *from, state_of *to)
{
    *to = *from;
    to->start[0] = 0;
    for (uint32_t k = 0; k < from->count; k++)
        copy_element(from, from->count - 1 - k, to, k);
}

/* Has all elements of a state do what they do together. */
static tl_status call_together(trial *t, state_of *s)
{
    double *state[STATES], *whole[STATES], sum = 0;
    tl_report report = {.size = sizeof report};
    tl_element_batch b = all_of(s, state, whole);
    b.dt = t->dt;
    b.time = t->time;
    for (int k = 0; k < 3; k++) {
        b.du[k] = b.v[k] = NULL;
        b.force[k] = NULL;
    }
    b.stored = b.lost = b.given = NULL;
    tl_enter(t->c->kind, "together");
    const tl_status status = t->ops->together(t->self, &b, &report);
    tl_leave();
    if (status != TL_OK) {
        tl_check_note(t->c, RUNS, "together() failed: %s", tl_report_text(&report, status));
        return status;
    }
    for (uint32_t k = 0; k < t->columns[0]; k++)
        for (uint32_t i = 0; i < s->start[s->count]; i++)
            sum += 0 * s->state[k][i];
    for (uint32_t k = 0; k < t->columns[1]; k++)
        for (uint32_t e = 0; e < s->count; e++)
            sum += 0 * s->whole[k][e];
    if (!isfinite(sum))
        tl_check_note(t->c, FINITE, "together() gives a state that is not finite");
    return TL_OK;
}

/* Whether two states have the same states of elements, within rounding of the largest of a column. */
static bool have_same_states(const trial *t, const state_of *a, const state_of *b)
{
    bool same = true;
    for (uint32_t k = 0; k < t->columns[0] + t->columns[1]; k++) {
        const bool whole = k >= t->columns[0];
        const double *x = whole ? a->whole[k - t->columns[0]] : a->state[k];
        const double *y = whole ? b->whole[k - t->columns[0]] : b->state[k];
        const uint32_t count = whole ? a->count : a->start[a->count];
        double most = 0, off = 0;
        for (uint32_t i = 0; i < count; i++) {
            most = fmax(most, fabs(x[i]));
            off = fmax(off, fabs(x[i] - y[i]));
        }
        same = same && off <= ROUNDING * most;
    }
    return same;
}

/* What elements do together where they are: once more, in the opposite order, and at the same time again. */
static tl_status act_together(trial *t, state_of *s)
{
    if (!t->ops->together)
        return TL_OK;
    state_of *const other = &t->other, *const turned = &t->turned;
    *other = *s;
    turn_round(s, turned);
    const tl_status status = call_together(t, s);
    if (status != TL_OK)
        return status;
    if (call_together(t, other) == TL_OK && memcmp(other, s, sizeof *s) != 0)
        tl_check_note(t->c, REPEATS, "the same call of together() gives another result");
    if (call_together(t, turned) == TL_OK) {
        turn_round(turned, other);
        if (!have_same_states(t, s, other))
            tl_check_note(t->c, TOGETHER, "in the opposite order the elements get other states");
    }
    *other = *s;
    if (call_together(t, other) == TL_OK && !have_same_states(t, s, other))
        tl_check_note(t->c, TOGETHER, "asked again at the same time and places it changes a state");
    return TL_OK;
}

static tl_vec3 at(double (*column)[NODES], uint32_t i)
{
    return tl_v3(column[0][i], column[1][i], column[2][i]);
}

/* How far a point moves when it turns about zero by an angle and axis, rad. */
static tl_vec3 turned(tl_vec3 turn, tl_vec3 x)
{
    const double angle = tl_v3_norm(turn), half = tl_sin(0.5 * angle) / angle;
    const tl_vec3 once = tl_v3_cross(turn, x);
    return tl_v3_madd(tl_v3_scale(tl_sin(angle) / angle, once), 2 * half * half, tl_v3_cross(turn, once));
}

/* Moves all nodes: those of each block by a small motion of their own or, with `together`, of one. */
static void move(trial *t, uint64_t key, bool together, double scale)
{
    state_of *s = &t->next;
    *s = t->now;
    for (uint32_t i = 0; i < s->start[s->count]; i++) {
        const uint64_t own = tl_key(key, together ? 9 : t->block[i]);
        const double size = scale * tl_check_scale(tl_key(own, 3), -1, 1);
        const tl_vec3 shift = tl_v3_scale(size, tl_check_direction(tl_key(own, 1)));
        const tl_vec3 turn = tl_v3_scale(size, tl_check_direction(tl_key(own, 2)));
        const tl_vec3 x = tl_v3_add(at(s->rest, i), at(s->u, i));
        const tl_vec3 way = tl_v3_add(shift, turned(turn, x));
        const double du[] = {way.x, way.y, way.z};
        const bool ground = t->block[i] == TL_NO_ID && !together;
        for (int k = 0; k < 3; k++) {
            s->du[k][i] = ground ? 0 : du[k];
            s->u[k][i] += s->du[k][i];
            s->v[k][i] = t->dt > 0 ? s->du[k][i] / t->dt : 0;
        }
    }
}

/* ---------------------------------------------------------------- rules ------------------ */

/* Whether numbers are the same within rounding. */
static bool are_alike(const double *a, const double *b, size_t count)
{
    bool alike = true;
    for (size_t i = 0; i < count; i++)
        alike = alike && fabs(a[i] - b[i]) <= ROUNDING * (fabs(a[i]) + fabs(b[i]));
    return alike;
}

static void check_numbers(trial *t)
{
    const state_of *s = &t->next;
    double sum = 0;
    for (uint32_t i = 0; i < s->start[s->count]; i++) {
        for (int k = 0; k < 3; k++)
            sum += 0 * s->force[k][i];
        for (uint32_t k = 0; k < t->columns[0]; k++)
            sum += 0 * s->state[k][i];
    }
    for (uint32_t e = 0; e < s->count; e++) {
        sum += 0 * (s->stored[e] + s->lost[e] + s->given[e]);
        for (uint32_t k = 0; k < t->columns[1]; k++)
            sum += 0 * s->whole[k][e];
    }
    if (!isfinite(sum))
        tl_check_note(t->c, FINITE, "a force, a state or an energy is not finite");
}

/* The same state by other ways: once more, and element by element, which remember nothing. */
static void check_batches(trial *t, const state_of *before)
{
    t->other = *before;
    if (update(t, &t->other, 0, before->count) == TL_OK && memcmp(&t->other, &t->next, sizeof t->next) != 0)
        tl_check_note(t->c, REPEATS, "the same call gives another result");
    t->other = *before;
    if (!remember(t))
        return;
    for (uint32_t e = 0; e < before->count; e++)
        update(t, &t->other, e, e + 1);
    if (memcmp(&t->other, &t->next, sizeof t->next) != 0)
        tl_check_note(t->c, SPLIT, "elements one by one get another result than in a batch");
}

/* Work on element e in a step, and the size of what goes into it. */
static double work_on(const trial *t, uint32_t e, double *size)
{
    double sum = 0;
    for (uint32_t i = t->next.start[e]; i < t->next.start[e + 1]; i++)
        for (int k = 0; k < 3; k++) {
            const double part = -0.5 * (t->now.force[k][i] + t->next.force[k][i]) * t->next.du[k][i];
            sum += part;
            *size += fabs(part);
        }
    return sum;
}

static void check_sums(trial *t, uint32_t e)
{
    tl_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
    double size = 0, arm = 0;
    for (uint32_t i = t->next.start[e]; i < t->next.start[e + 1]; i++) {
        const tl_vec3 f = at(t->next.force, i), x = tl_v3_add(at(t->next.rest, i), at(t->next.u, i));
        force = tl_v3_add(force, f);
        moment = tl_v3_add(moment, tl_v3_cross(x, f));
        size += tl_v3_norm(f) + ROUNDING * t->stiffest * WAY;
        arm = fmax(arm, tl_v3_norm(x));
    }
    if (tl_v3_norm(force) > ROUNDING * size || tl_v3_norm(moment) > ROUNDING * arm * size)
        tl_check_note(t->c, SUMS, "forces of %g N add up to %g N, and their moments to %g N m", size, tl_v3_norm(force),
                      tl_v3_norm(moment));
}

/* A random step of all, and what it asks of each element; the work so far is added to. */
static bool step(trial *t, uint64_t key, bool internal[ELEMENTS])
{
    move(t, key, false, WAY);
    t->time += t->dt;
    if (act_together(t, &t->next) != TL_OK)
        return false;
    const state_of before = t->next;
    if (update(t, &t->next, 0, t->next.count) != TL_OK)
        return false;
    check_numbers(t);
    check_batches(t, &before);
    for (uint32_t e = 0; e < t->next.count; e++) {
        double size = fabs(t->next.stored[e] - t->now.stored[e]) + fabs(t->next.lost[e]) + fabs(t->next.given[e]);
        const double work = work_on(t, e, &size);
        const double kept = t->next.stored[e] - t->now.stored[e] + t->next.lost[e] - t->next.given[e];
        internal[e] = internal[e] && t->next.given[e] == 0;
        size += ROUNDING * fabs(t->next.stored[e]) + ROUNDING * t->stiffest * WAY * WAY;
        if (fabs(work - kept) > CURVED * size)
            tl_check_note(t->c, BALANCE, "work of %g J became %g J, stored %g, lost %g, given %g", work, kept,
                          t->next.stored[e] - t->now.stored[e], t->next.lost[e], t->next.given[e]);
        if (internal[e])
            check_sums(t, e);
    }
    t->now = t->next;
    return true;
}

/* Without motion and time nothing changes. */
static void check_still(trial *t)
{
    const double dt = t->dt;
    t->next = t->now;
    t->dt = 0;
    for (int k = 0; k < 3; k++) {
        memset(t->next.du[k], 0, sizeof t->next.du[k]);
        memset(t->next.v[k], 0, sizeof t->next.v[k]);
    }
    update(t, &t->next, 0, t->next.count); /* forces of dashpots go */
    t->other = t->next;
    update(t, &t->other, 0, t->other.count);
    if (!are_alike(t->other.force[0], t->next.force[0], sizeof t->next.force / sizeof(double)) ||
        !are_alike(t->other.state[0], t->next.state[0], sizeof t->next.state / sizeof(double)) ||
        !are_alike(t->other.whole[0], t->next.whole[0], sizeof t->next.whole / sizeof(double)))
        tl_check_note(t->c, STILL, "without motion and time a force or a state changes");
    t->now = t->next;
    t->dt = dt;
}

/* All nodes move together: no internal element stores anything else. */
static void check_rigid(trial *t, const bool internal[ELEMENTS])
{
    move(t, 77, true, WAY);
    t->other = t->next;
    if (update(t, &t->next, 0, t->next.count) != TL_OK)
        return;
    for (uint32_t e = 0; e < t->next.count; e++)
        for (uint32_t i = t->next.start[e]; internal[e] && i < t->next.start[e + 1]; i++) {
            const tl_vec3 had = at(t->now.force, i), has = at(t->next.force, i);
            const double rounding = ROUNDING * t->stiffest * WAY;
            if (fabs(tl_v3_norm(has) - tl_v3_norm(had)) > SLACK * (tl_v3_norm(had) + tl_v3_norm(has)) + rounding)
                tl_check_note(t->c, RIGID, "a force of %g N became %g N", tl_v3_norm(had), tl_v3_norm(has));
        }
}

/* A path there and back: an internal element has taken no less than it gave. */
static void check_cycle(trial *t, const bool internal[ELEMENTS])
{
    const state_of begin = t->now;
    double work[ELEMENTS] = {0}, size[ELEMENTS] = {0};
    for (int k = 0; k < 2; k++) {
        move(t, 5, false, k ? -WAY : WAY);
        if (update(t, &t->next, 0, t->next.count) != TL_OK)
            return;
        for (uint32_t e = 0; e < t->next.count; e++)
            work[e] += work_on(t, e, &size[e]);
        t->now = t->next;
    }
    for (uint32_t e = 0; e < begin.count; e++) {
        const double left = t->now.stored[e] - begin.stored[e];
        if (internal[e] && work[e] - left < -SLACK * size[e])
            tl_check_note(t->c, CYCLE, "a closed path took %g J and gave back %g J more", size[e], left - work[e]);
    }
}

static void check_stiffness(trial *t)
{
    state_of *s = &t->now;
    double k[NODES] = {0}, c[NODES] = {0}, *state[STATES], *whole[STATES];
    const tl_element_batch b = all_of(s, state, whole);
    tl_enter(t->c->kind, "stiffness");
    t->ops->stiffness(t->self, &b, k, c);
    tl_leave();
    t->stiffest = 0;
    for (uint32_t i = 0; i < s->start[s->count]; i++)
        t->stiffest = fmax(t->stiffest, k[i]);
    for (uint32_t i = 0; i < s->start[s->count]; i++)
        if (!(k[i] >= 0 && c[i] >= 0 && isfinite(k[i] + c[i])))
            tl_check_note(t->c, STIFFNESS, "stiffness() gives %g N/m and %g N s/m", k[i], c[i]);
}

/* ---------------------------------------------------------------- all of it -------------- */

static void run_trial(trial *t)
{
    bool internal[ELEMENTS];
    for (int e = 0; e < ELEMENTS; e++)
        internal[e] = true;
    if (!remember(t))
        return;
    check_stiffness(t);
    t->dt = 0; /* as the host does, once where they were placed */
    t->time = 1;
    if (act_together(t, &t->now) != TL_OK || update(t, &t->now, 0, t->now.count) != TL_OK)
        return;
    t->dt = DT;
    for (uint64_t k = 0; k < STEPS; k++)
        if (!step(t, tl_key(tl_key(2045, (uint64_t)t->c->set), k), internal))
            return;
    check_still(t);
    check_rigid(t, internal);
    check_cycle(t, internal);
}

static tl_status try_set(tl_checker *c, void *params, void *user)
{
    trial *t = user;
    const tl_element_host host = {.size = sizeof host,
                                  .impl = t,
                                  .seed = 1,
                                  .add = add,
                                  .line = line,
                                  .faces = faces,
                                  .walls = walls,
                                  .block_at = block_at,
                                  .log = quiet,
                                  .fail = fail};
    memset(&t->now, 0, sizeof t->now);
    t->text[0] = '\0';
    tl_status status = tl_check_create(c, t->ops->create, params, &t->self);
    if (status != TL_OK)
        return status;
    tl_enter(c->kind, "place");
    status = t->ops->place(&host, params);
    tl_leave();
    if (status == TL_OK && t->now.count > 0) {
        t->places = true;
        run_trial(t);
    } else if (status != TL_OK) {
        tl_fail(c->error, status, "%s", t->text);
    }
    forget(t);
    if (t->ops->destroy)
        t->ops->destroy(t->self);
    return status;
}

static tl_status check_kind(tl_checker *c)
{
    trial *t = calloc(1, sizeof *t);
    if (!t)
        return tl_fail_memory(c->error);
    t->c = c;
    t->ops = c->kind->ops;
    for (uint32_t k = 0; k < c->kind->state_count; k++)
        t->columns[c->kind->states[k].kind == TL_STATE_WHOLE]++;
    const tl_status status = tl_check_sets(c, try_set, t);
    if (status == TL_OK && !t->places)
        tl_check_note(c, PLACES, "no set of parameters makes an element: %s", t->text);
    free(t);
    return status;
}

const tl_check_type tl_check_elements = {rules, check_kind};
