/* mesh.c - triangles over faces of blocks.
 *
 * Corners of faces that are close to each other become one node. A node on the edge of another face becomes a corner of
 * that face, too. So faces meet along whole edges. A face is a fan of triangles about its middle. Sides that are too
 * long are halved, always the longest of a triangle first. So no angle falls below half of the least one
 * (Rivara 1984). Then sides within a face are flipped until circles about triangles hold no other node (Lawson 1977).
 *
 * A liner of many triangles is cut in halves across its longest way until a half is one patch. */
#include "mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Tolerance: over the spacing, distance of corners that are one. Test: lua/test_liner. */
#define SAME 0.05
/* Constant: cotangents of two angles add up to less than -FLIPS where a side is flipped: beyond rounding, so nothing is
 * flipped for ever. */
#define FLIPS 1e-9
/* Limit: rounds of flips. */
#define ROUNDS 20

typedef struct side {
    uint32_t low, high, triangle, corner; /* the corner across the side */
} side;

/* Sides of all triangles, those between the same nodes together. */
typedef struct sides {
    side *at;
    uint32_t *group; /* [3 for each triangle] */
    double *length2; /* [groups], m2 */
    uint32_t *first; /* [groups + 1] */
    unsigned char *marked;
    uint32_t *middle; /* nodes */
    size_t groups, room;
} sides;

static bool grow(void **list, size_t *capacity, size_t count, size_t size)
{
    if (count <= *capacity)
        return true;
    const size_t more = 2 * count + 16;
    void *moved = realloc(*list, more * size);
    if (!moved)
        return false;
    *list = moved;
    *capacity = more;
    return true;
}

static bool put_node(mesh *m, tl_vec3 at)
{
    if (!grow((void **)&m->at, &m->node_capacity, m->nodes + 1, sizeof *m->at))
        return false;
    m->at[m->nodes++] = at;
    return true;
}

static bool put_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t face)
{
    if (!grow((void **)&m->of, &m->capacity, m->count + 1, sizeof *m->of))
        return false;
    m->of[m->count++] = (mesh_triangle){{a, b, c}, face};
    return true;
}

void mesh_free(mesh *m)
{
    free(m->at);
    free(m->of);
    free(m->patch);
    *m = (mesh){.at = NULL};
}

/* ---------------------------------------------------------------- corners ---------------- */

typedef struct corner {
    tl_vec3 at;
    uint32_t face, index;
} corner;

static int by_x(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    if (p->at.x != q->at.x)
        return p->at.x < q->at.x ? -1 : 1;
    if (p->face != q->face)
        return p->face < q->face ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

/* Makes the nodes, which ascend along x; `node` gets that of each corner of each face, one face after the other. */
static bool join_corners(mesh *m, const tl_element_face *faces, size_t count, double near, uint32_t *node)
{
    size_t sum = 0, k = 0;
    for (size_t f = 0; f < count; f++)
        sum += faces[f].corner_count;
    corner *list = malloc((sum + 1) * sizeof *list);
    size_t *begin = malloc((count + 1) * sizeof *begin);
    bool enough = list && begin;
    for (size_t f = 0; f < count && enough; f++) {
        begin[f] = k;
        for (size_t i = 0; i < faces[f].corner_count; i++)
            list[k++] = (corner){faces[f].corners[i], (uint32_t)f, (uint32_t)i};
    }
    if (enough)
        qsort(list, sum, sizeof *list, by_x);
    for (k = 0; k < sum && enough; k++) {
        size_t i = m->nodes;
        bool known = false;
        while (i > 0 && !known && m->at[i - 1].x >= list[k].at.x - near)
            known = tl_v3_norm(tl_v3_sub(m->at[--i], list[k].at)) <= near;
        if (!known) {
            i = m->nodes;
            enough = put_node(m, list[k].at);
        }
        node[begin[list[k].face] + list[k].index] = (uint32_t)i;
    }
    free(list);
    free(begin);
    return enough;
}

typedef struct stop {
    double part;
    uint32_t node;
} stop;

static int by_part(const void *a, const void *b)
{
    const stop *p = a, *q = b;
    if (p->part != q->part)
        return p->part < q->part ? -1 : 1;
    return p->node < q->node ? -1 : p->node > q->node;
}

/* The nodes of faces that lie on the side from a to b, between these, in order. SIZE_MAX: out of memory. */
static size_t stops_on(const mesh *m, size_t nodes, uint32_t a, uint32_t b, double near, stop **list, size_t *room)
{
    const tl_vec3 from = m->at[a], way = tl_v3_sub(m->at[b], from);
    const double least = fmin(from.x, m->at[b].x) - near, most = fmax(from.x, m->at[b].x) + near;
    const double length2 = tl_v3_norm2(way);
    size_t low = 0, high = nodes, count = 0;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (m->at[middle].x < least)
            low = middle + 1;
        else
            high = middle;
    }
    for (size_t i = low; i < nodes && m->at[i].x <= most && length2 > 0; i++) {
        const tl_vec3 d = tl_v3_sub(m->at[i], from);
        const double part = tl_v3_dot(d, way) / length2;
        if (i == a || i == b || part <= 0 || part >= 1 || tl_v3_norm(tl_v3_madd(d, -part, way)) > near)
            continue;
        if (!grow((void **)list, room, count + 1, sizeof **list))
            return SIZE_MAX;
        (*list)[count++] = (stop){part, (uint32_t)i};
    }
    if (count > 1)
        qsort(*list, count, sizeof **list, by_part);
    return count;
}

/* A face as a fan about its middle. */
static bool put_fan(mesh *m, size_t nodes, const tl_element_face *f, uint32_t face, const uint32_t *node, double near,
                    stop **list, size_t *room)
{
    tl_vec3 middle = {0, 0, 0};
    for (size_t i = 0; i < f->corner_count; i++)
        middle = tl_v3_madd(middle, 1 / (double)f->corner_count, f->corners[i]);
    const uint32_t hub = (uint32_t)m->nodes;
    if (!put_node(m, middle))
        return false;
    for (size_t i = 0; i < f->corner_count; i++) {
        uint32_t from = node[i];
        const uint32_t to = node[(i + 1) % f->corner_count];
        if (from == to)
            continue;
        const size_t stops = stops_on(m, nodes, from, to, near, list, room);
        if (stops == SIZE_MAX)
            return false;
        for (size_t k = 0; k <= stops; k++) {
            const uint32_t next = k == stops ? to : (*list)[k].node;
            if (!put_triangle(m, hub, from, next, face))
                return false;
            from = next;
        }
    }
    return true;
}

static bool put_fans(mesh *m, const tl_element_face *faces, size_t count, double near)
{
    size_t corners = 0, at = 0, room = 0;
    for (size_t f = 0; f < count; f++)
        corners += faces[f].corner_count;
    uint32_t *node = malloc((corners + 1) * sizeof *node);
    bool enough = node && join_corners(m, faces, count, near, node);
    const size_t nodes = m->nodes;
    stop *list = NULL;
    for (size_t f = 0; f < count && enough; f++) {
        enough = put_fan(m, nodes, &faces[f], (uint32_t)f, node + at, near, &list, &room);
        at += faces[f].corner_count;
    }
    free(list);
    free(node);
    return enough;
}

/* ---------------------------------------------------------------- sides ------------------ */

static int by_nodes(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static void sides_free(sides *s)
{
    void *const owned[] = {s->at, s->group, s->length2, s->first, s->marked, s->middle};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    *s = (sides){.at = NULL};
}

static bool list_sides(const mesh *m, sides *s)
{
    const size_t count = 3 * m->count;
    sides_free(s);
    s->at = malloc((count + 1) * sizeof *s->at);
    s->group = malloc((count + 1) * sizeof *s->group);
    s->length2 = malloc((count + 1) * sizeof *s->length2);
    s->first = malloc((count + 2) * sizeof *s->first);
    s->marked = calloc(count + 1, 1);
    s->middle = malloc((count + 1) * sizeof *s->middle);
    if (!s->at || !s->group || !s->length2 || !s->first || !s->marked || !s->middle)
        return false;
    for (size_t k = 0; k < count; k++) {
        const mesh_triangle *t = &m->of[k / 3];
        const uint32_t a = t->node[(k + 1) % 3], b = t->node[(k + 2) % 3];
        s->at[k] = (side){a < b ? a : b, a < b ? b : a, (uint32_t)(k / 3), (uint32_t)(k % 3)};
    }
    qsort(s->at, count, sizeof *s->at, by_nodes);
    for (size_t k = 0; k < count; k++) {
        const side *one = &s->at[k];
        if (k == 0 || one->low != one[-1].low || one->high != one[-1].high) {
            s->length2[s->groups] = tl_v3_norm2(tl_v3_sub(m->at[one->high], m->at[one->low]));
            s->first[s->groups++] = (uint32_t)k;
        }
        s->group[3 * one->triangle + one->corner] = (uint32_t)(s->groups - 1);
    }
    s->first[s->groups] = (uint32_t)count;
    return true;
}

/* The corner of a triangle across its longest side. */
static uint32_t across_longest(const sides *s, size_t triangle)
{
    uint32_t best = 0;
    for (uint32_t c = 1; c < 3; c++) {
        const uint32_t has = s->group[3 * triangle + best], one = s->group[3 * triangle + c];
        if (s->length2[one] > s->length2[has] || (s->length2[one] == s->length2[has] && one > has))
            best = c;
    }
    return best;
}

/* Marks sides that are too long, and the longest of each triangle that has a marked one. Whether there are any. */
static bool mark_sides(const mesh *m, sides *s, double spacing)
{
    bool any = false, more = true;
    for (size_t t = 0; t < m->count; t++) {
        const uint32_t longest = s->group[3 * t + across_longest(s, t)];
        if (s->length2[longest] > spacing * spacing) {
            s->marked[longest] = 1;
            any = true;
        }
    }
    while (more) {
        more = false;
        for (size_t t = 0; t < m->count; t++) {
            const uint32_t *of = &s->group[3 * t], longest = of[across_longest(s, t)];
            if ((s->marked[of[0]] || s->marked[of[1]] || s->marked[of[2]]) && !s->marked[longest]) {
                s->marked[longest] = 1;
                more = true;
            }
        }
    }
    return any;
}

/* Halves triangle t by the middles of its marked sides. */
static bool split(mesh *m, const sides *s, size_t t)
{
    const mesh_triangle whole = m->of[t];
    const uint32_t top = across_longest(s, t), *of = &s->group[3 * t];
    const uint32_t apex = whole.node[top], a = whole.node[(top + 1) % 3], b = whole.node[(top + 2) % 3];
    if (!s->marked[of[top]])
        return true;
    const uint32_t middle = s->middle[of[top]], left = of[(top + 2) % 3], right = of[(top + 1) % 3];
    m->of[t] = (mesh_triangle){{apex, a, middle}, whole.face};
    bool enough = true;
    if (s->marked[left]) {
        m->of[t] = (mesh_triangle){{apex, s->middle[left], middle}, whole.face};
        enough = put_triangle(m, s->middle[left], a, middle, whole.face);
    }
    if (s->marked[right])
        return enough && put_triangle(m, apex, middle, s->middle[right], whole.face) &&
               put_triangle(m, s->middle[right], middle, b, whole.face);
    return enough && put_triangle(m, apex, middle, b, whole.face);
}

static bool refine(mesh *m, sides *s, double spacing)
{
    bool enough = list_sides(m, s);
    while (enough && mark_sides(m, s, spacing)) {
        for (size_t g = 0; g < s->groups && enough; g++)
            if (s->marked[g]) {
                const side *one = &s->at[s->first[g]];
                s->middle[g] = (uint32_t)m->nodes;
                enough = put_node(m, tl_v3_scale(0.5, tl_v3_add(m->at[one->low], m->at[one->high])));
            }
        const size_t count = m->count;
        for (size_t t = 0; t < count && enough; t++)
            enough = split(m, s, t);
        enough = enough && list_sides(m, s);
    }
    return enough;
}

static double cotangent(const mesh *m, uint32_t at, uint32_t a, uint32_t b)
{
    const tl_vec3 p = tl_v3_sub(m->at[a], m->at[at]), q = tl_v3_sub(m->at[b], m->at[at]);
    return tl_v3_dot(p, q) / tl_v3_norm(tl_v3_cross(p, q));
}

/* Flips sides within faces, none of one triangle twice; whether any has been flipped. */
static bool flip_once(mesh *m, const sides *s, unsigned char *turned)
{
    bool any = false;
    memset(turned, 0, m->count);
    for (size_t g = 0; g < s->groups; g++) {
        const side *p = &s->at[s->first[g]], *q = p + 1;
        if (s->first[g + 1] - s->first[g] != 2 || m->of[p->triangle].face != m->of[q->triangle].face ||
            turned[p->triangle] || turned[q->triangle])
            continue;
        mesh_triangle *t = &m->of[p->triangle], *u = &m->of[q->triangle];
        const uint32_t c = t->node[p->corner], d = u->node[q->corner], a = t->node[(p->corner + 1) % 3],
                       b = t->node[(p->corner + 2) % 3];
        if (!(cotangent(m, c, a, b) + cotangent(m, d, a, b) < -FLIPS))
            continue;
        memcpy(t->node, (const uint32_t[]){c, a, d}, sizeof t->node);
        memcpy(u->node, (const uint32_t[]){d, b, c}, sizeof u->node);
        turned[p->triangle] = turned[q->triangle] = 1;
        any = true;
    }
    return any;
}

static bool flip(mesh *m, sides *s)
{
    unsigned char *turned = malloc(m->count + 1);
    bool enough = turned != NULL;
    for (int round = 0; round < ROUNDS && enough && flip_once(m, s, turned); round++)
        enough = list_sides(m, s);
    free(turned);
    return enough;
}

/* ---------------------------------------------------------------- patches ---------------- */

typedef struct along {
    double at;
    uint32_t number;
    mesh_triangle of;
} along;

static int by_way(const void *a, const void *b)
{
    const along *p = a, *q = b;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

static tl_vec3 middle_of(const mesh *m, size_t t)
{
    const uint32_t *n = m->of[t].node;
    return tl_v3_scale(1.0 / 3, tl_v3_add(tl_v3_add(m->at[n[0]], m->at[n[1]]), m->at[n[2]]));
}

/* The triangle of those from `begin` to `end` that is farthest from a place. */
static tl_vec3 farthest(const mesh *m, size_t begin, size_t end, tl_vec3 from)
{
    tl_vec3 best = from;
    double most = -1;
    for (size_t t = begin; t < end; t++) {
        const tl_vec3 x = middle_of(m, t);
        const double far = tl_v3_norm2(tl_v3_sub(x, from));
        if (far > most) {
            most = far;
            best = x;
        }
    }
    return best;
}

/* About the longest way through some triangles. */
static tl_vec3 longest_way(const mesh *m, size_t begin, size_t end)
{
    const tl_vec3 one = farthest(m, begin, end, middle_of(m, begin));
    return tl_v3_sub(farthest(m, begin, end, one), one);
}

/* Sorts triangles along their longest way, and halves them until they are patches. */
static bool halve(mesh *m, size_t begin, size_t end, along *list)
{
    const tl_vec3 way = longest_way(m, begin, end);
    for (size_t t = begin; t < end; t++)
        list[t] = (along){tl_v3_dot(way, middle_of(m, t)), (uint32_t)t, m->of[t]};
    qsort(list + begin, end - begin, sizeof *list, by_way);
    for (size_t t = begin; t < end; t++)
        m->of[t] = list[t].of;
    if (end - begin > PATCH_TRIANGLES) {
        const size_t middle = begin + (end - begin) / 2;
        return halve(m, begin, middle, list) && halve(m, middle, end, list);
    }
    if (!grow((void **)&m->patch, &m->patch_capacity, m->patches + 2, sizeof *m->patch))
        return false;
    m->patch[m->patches++] = (uint32_t)begin;
    m->patch[m->patches] = (uint32_t)end;
    return true;
}

bool mesh_number(const mesh *m, size_t patch, uint32_t *number)
{
    const size_t begin = m->patch[patch], end = m->patch[patch + 1], corners = 3 * (end - begin);
    const tl_vec3 way = longest_way(m, begin, end);
    along *list = malloc((corners + 1) * sizeof *list);
    for (size_t k = 0; k < corners && list; k++) {
        const uint32_t node = m->of[begin + k / 3].node[k % 3];
        list[k] = (along){tl_v3_dot(way, m->at[node]), node, {{(uint32_t)k, 0, 0}, 0}};
    }
    if (list)
        qsort(list, corners, sizeof *list, by_way);
    uint32_t next = 0;
    for (size_t k = 0; k < corners && list; k++) {
        next += k > 0 && list[k].number != list[k - 1].number;
        number[list[k].of.node[0]] = next;
    }
    free(list);
    return list != NULL;
}

/* Leaves out triangles without an area: of a node close to an edge. */
static void drop_slivers(mesh *m, double spacing)
{
    size_t kept = 0;
    for (size_t t = 0; t < m->count; t++) {
        const tl_vec3 a = m->at[m->of[t].node[0]];
        const tl_vec3 twice = tl_v3_cross(tl_v3_sub(m->at[m->of[t].node[1]], a), tl_v3_sub(m->at[m->of[t].node[2]], a));
        if (tl_v3_norm(twice) > SAME * SAME * spacing * spacing)
            m->of[kept++] = m->of[t];
    }
    m->count = kept;
}

bool mesh_make(mesh *m, const tl_element_face *faces, size_t count, double spacing)
{
    sides s = {.at = NULL};
    *m = (mesh){.at = NULL};
    bool enough = put_fans(m, faces, count, SAME * spacing);
    if (enough)
        drop_slivers(m, spacing);
    enough = enough && refine(m, &s, spacing) && flip(m, &s);
    sides_free(&s);
    along *list = enough ? malloc((m->count + 1) * sizeof *list) : NULL;
    enough = list && (m->count == 0 || halve(m, 0, m->count, list));
    free(list);
    return enough;
}
