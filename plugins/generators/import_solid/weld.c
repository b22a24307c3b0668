/* weld.c - closes an object: from loose faces to shells.
 *
 * Vertices within `weld` of each other become one, at their mean. Faces that lose their area by it go. Edges take up
 * vertices that lie on them, where these are the ends of other edges (between.c). Every edge then belongs to two faces.
 * Neighbours that run along it the same way are turned against each other: of faces that hang together the fewer are
 * turned. Where shells touch along an edge, four faces or more meet there. Faces that close a surface by the file's
 * numbers of their vertices are a part, and belong with each other. Among other faces, a half-edge belongs with that of
 * the face which is met first when turning from its own face through the inside. A shell of negative volume is turned
 * inside out. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Tolerance: faces along each other are a full turn apart, not none: less than this, in radians, is none. So is what
 * corners off their planes by `flat` make of none, up to MOST_SAME_SIDE. */
#define SAME_SIDE 1e-6
#define MOST_SAME_SIDE 0.3
/* Tolerance: a shell holds no volume below this times the cube of its size. */
#define EMPTY 1e-9

typedef struct side {
    uint32_t low, high; /* vertices */
    uint32_t part;      /* of its face */
    uint32_t half;      /* half-edge */
    bool up;            /* it runs from low to high */
} side;

uint32_t mesh_next(const mesh *m, uint32_t h)
{
    const shell_face *f = &m->face[m->face_of[h]];
    return h + 1 < f->first + f->count ? h + 1 : f->first;
}

void mesh_free(mesh *m)
{
    free(m->vertex);
    free(m->corner);
    free(m->face_of);
    free(m->mate);
    free(m->face);
    free(m->local);
    free(m->cell);
    free(m->next);
    free(m->root);
    free(m->part);
    free(m->sides);
}

static bool resize(void *list, size_t count, size_t each)
{
    void **items = list;
    void *moved = realloc(*items, (count + 1) * each);
    *items = moved ? moved : *items;
    return moved != NULL;
}

bool mesh_room(mesh *m, size_t corners)
{
    if (corners <= m->corner_room)
        return true;
    if (!resize(&m->vertex, corners, sizeof *m->vertex) || !resize(&m->corner, corners, sizeof *m->corner) ||
        !resize(&m->face_of, corners, sizeof *m->face_of) || !resize(&m->mate, corners, sizeof *m->mate) ||
        !resize(&m->next, corners, sizeof *m->next) || !resize(&m->root, corners, sizeof *m->root) ||
        !resize(&m->sides, corners, sizeof(side)))
        return false;
    size_t cells = 64;
    while (cells < 2 * corners)
        cells *= 2;
    if (!resize(&m->cell, cells, sizeof *m->cell))
        return false;
    m->cell_room = cells;
    m->corner_room = corners;
    return true;
}

/* Room for an object of so many corners and faces. */
static bool make_room(const solids *s, mesh *m, size_t corners, size_t faces)
{
    if (!m->local) {
        m->local = malloc((s->soup.vertices + 1) * sizeof *m->local);
        if (!m->local)
            return false;
        memset(m->local, 0xff, (s->soup.vertices + 1) * sizeof *m->local);
    }
    if (!mesh_room(m, corners))
        return false;
    if (faces > m->face_room) {
        if (!resize(&m->face, faces, sizeof *m->face) || !resize(&m->part, faces, sizeof *m->part))
            return false;
        m->face_room = faces;
    }
    return true;
}

/* ---------------------------------------------------------------- parts ------------------ */

/* Compares half-edges by edge, part and number. */
static int by_edge(const void *left, const void *right)
{
    const side *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    if (a->part != b->part)
        return a->part < b->part ? -1 : 1;
    return (a->half > b->half) - (a->half < b->half);
}

/* The end of the run of half-edges of one edge. */
static size_t edge_end(const mesh *m, size_t corners, size_t from)
{
    const side *list = m->sides;
    size_t to = from;
    while (to < corners && list[to].low == list[from].low && list[to].high == list[from].high &&
           list[to].part == list[from].part)
        to++;
    return to;
}

/* Marks the root of vertices that hang together, where their faces close no surface. */
#define OPEN_PART (NONE - 1)

static uint32_t vertex_root(mesh *m, uint32_t v)
{
    uint32_t root = v;
    while (m->local[root] != root && m->local[root] != OPEN_PART)
        root = m->local[root];
    while (v != root) {
        const uint32_t next = m->local[v];
        m->local[v] = root;
        v = next;
    }
    return root;
}

/* Numbers the parts of an object: faces that hang together by the file's numbers of their vertices, and close a surface
 * so. All other faces are part 0. */
static void find_parts(const soup *from, const file_object *o, uint32_t last, mesh *m)
{
    side *list = m->sides;
    size_t corners = 0;
    for (uint32_t h = from->start[o->face]; h < from->start[last]; h++)
        m->local[from->corner[h]] = from->corner[h];
    for (uint32_t f = o->face; f < last; f++)
        for (uint32_t h = from->start[f]; h < from->start[f + 1]; h++) {
            const uint32_t a = from->corner[h], b = from->corner[h + 1 < from->start[f + 1] ? h + 1 : from->start[f]];
            m->local[vertex_root(m, a)] = vertex_root(m, b);
            list[corners++] = a < b ? (side){a, b, 0, h, true} : (side){b, a, 0, h, false};
        }
    qsort(list, corners, sizeof *list, by_edge);
    for (size_t at = 0, to; at < corners; at = to) {
        to = edge_end(m, corners, at);
        if (to != at + 2 && list[at].low != list[at].high)
            m->local[vertex_root(m, list[at].low)] = OPEN_PART;
    }
    for (uint32_t f = o->face; f < last; f++) {
        const uint32_t root = vertex_root(m, from->corner[from->start[f]]);
        m->part[f - o->face] = m->local[root] == OPEN_PART ? 0 : root + 1;
    }
    for (uint32_t h = from->start[o->face]; h < from->start[last]; h++)
        m->local[from->corner[h]] = NONE;
}

/* ---------------------------------------------------------------- welding ---------------- */

static uint64_t hash_cell(const int64_t *at)
{
    uint64_t h = (uint64_t)at[0] * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 29) ^ (uint64_t)at[1]) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 32) ^ (uint64_t)at[2]) * 0x94d049bb133111ebu;
    return h ^ (h >> 31);
}

/* The nearest vertex within `weld` of a place, of those that are in the table of cells; NONE: there is none. */
static uint32_t find_near(const mesh *m, tl_vec3 at, tl_vec3 zero, double size, double weld, uint64_t mask)
{
    double place[3] = {(at.x - zero.x) / size, (at.y - zero.y) / size, (at.z - zero.z) / size};
    int64_t low[3];
    uint32_t best = NONE;
    double nearest = weld * weld;
    for (int i = 0; i < 3; i++)
        low[i] = (int64_t)floor(place[i] - 0.5);
    for (int k = 0; k < 8; k++) {
        int64_t cell[3] = {low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2)};
        for (uint32_t v = m->cell[hash_cell(cell) & mask]; v != NONE; v = m->next[v]) {
            double apart = tl_v3_norm2(tl_v3_sub(m->vertex[v], at));
            if (apart <= nearest && (apart < nearest || v < best)) {
                nearest = apart;
                best = v;
            }
        }
    }
    return best;
}

static int by_number(const void *left, const void *right)
{
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

/* Makes the object's own vertices, and its corners of them. Counts those that are welded. */
static void weld_vertices(solids *s, const file_object *o, uint32_t last, mesh *m, done *d)
{
    const soup *from = &s->soup;
    double size = fmax(4 * s->weld, 1e-12 * fmax(from->reach, 1e-300));
    tl_vec3 zero = from->vertex[from->corner[from->start[o->face]]];
    uint64_t mask = 63;
    while (mask + 1 < 2 * (uint64_t)(from->start[last] - from->start[o->face]))
        mask = 2 * mask + 1;
    memset(m->cell, 0xff, (size_t)(mask + 1) * sizeof *m->cell);
    m->vertices = 0;
    const size_t corners = from->start[last] - from->start[o->face];
    memcpy(m->root, from->corner + from->start[o->face], corners * sizeof *m->root);
    qsort(m->root, corners, sizeof *m->root, by_number); /* vertices are numbered as the file has them */
    for (size_t i = 0; i < corners; i++) {
        uint32_t v = m->root[i];
        if (m->local[v] == NONE) {
            tl_vec3 at = from->vertex[v];
            uint32_t near = find_near(m, at, zero, size, s->weld, mask);
            if (near == NONE) {
                near = (uint32_t)m->vertices++;
                int64_t cell[3] = {(int64_t)floor((at.x - zero.x) / size), (int64_t)floor((at.y - zero.y) / size),
                                   (int64_t)floor((at.z - zero.z) / size)};
                uint32_t *head = &m->cell[hash_cell(cell) & mask];
                m->vertex[near] = at;
                m->next[near] = *head;
                *head = near;
            }
            m->local[v] = near;
        }
    }
    /* the mean of those that were welded, but for places that are one to the bit */
    memset(m->root, 0, m->vertices * sizeof *m->root);
    for (uint32_t h = from->start[o->face]; h < from->start[last]; h++) {
        uint32_t v = from->corner[h], own = m->local[v];
        tl_vec3 off = tl_v3_sub(from->vertex[v], m->vertex[own]);
        m->root[own]++;
        if (tl_v3_norm2(off) > 0) {
            d->welded++;
            m->vertex[own] = tl_v3_madd(m->vertex[own], 1.0 / m->root[own], off);
        }
    }
}

/* The faces with the object's own vertices, without corners that follow themselves. */
static void make_faces(const solids *s, const file_object *o, uint32_t last, mesh *m, done *d)
{
    const soup *from = &s->soup;
    m->faces = m->corners = 0;
    for (uint32_t f = o->face; f < last; f++) {
        uint32_t first = (uint32_t)m->corners;
        for (uint32_t h = from->start[f]; h < from->start[f + 1]; h++) {
            uint32_t v = m->local[from->corner[h]];
            if (m->corners > first && m->corner[m->corners - 1] == v)
                continue;
            m->corner[m->corners++] = v;
        }
        while (m->corners > first + 1 && m->corner[m->corners - 1] == m->corner[first])
            m->corners--;
        if (m->corners < first + 3) {
            m->corners = first;
            d->collapsed++;
            continue;
        }
        shell_face *face = &m->face[m->faces++];
        *face = (shell_face){
            .first = first, .count = (uint32_t)(m->corners - first), .shell = NONE, .part = m->part[f - o->face]};
        for (size_t h = first; h < m->corners; h++)
            m->face_of[h] = (uint32_t)(m->faces - 1);
    }
    for (uint32_t h = from->start[o->face]; h < from->start[last]; h++)
        m->local[from->corner[h]] = NONE;
}

static void measure_face(const mesh *m, shell_face *f)
{
    tl_vec3 zero = m->vertex[m->corner[f->first]], area = {0, 0, 0};
    f->longest = 0;
    for (uint32_t h = f->first; h < f->first + f->count; h++) {
        tl_vec3 a = tl_v3_sub(m->vertex[m->corner[h]], zero);
        tl_vec3 b = tl_v3_sub(m->vertex[m->corner[mesh_next(m, h)]], zero);
        f->longest = fmax(f->longest, tl_v3_norm(tl_v3_sub(b, a)));
        area = tl_v3_add(area, tl_v3_cross(a, b));
    }
    f->area = area;
}

/* Turns the corners of a face round. */
static void turn_face(mesh *m, uint32_t face)
{
    shell_face *f = &m->face[face];
    for (uint32_t i = f->first, k = f->first + f->count - 1; i < k; i++, k--) {
        uint32_t v = m->corner[i];
        m->corner[i] = m->corner[k];
        m->corner[k] = v;
    }
    f->area = tl_v3_neg(f->area);
}

/* ---------------------------------------------------------------- edges ------------------ */

static void sort_edges(mesh *m)
{
    side *list = m->sides;
    for (uint32_t h = 0; h < m->corners; h++) {
        uint32_t a = m->corner[h], b = m->corner[mesh_next(m, h)], part = m->face[m->face_of[h]].part;
        list[h] = a < b ? (side){a, b, part, h, true} : (side){b, a, part, h, false};
        m->mate[h] = NONE;
    }
    qsort(list, m->corners, sizeof *list, by_edge);
}

/* Lets edges of one face take up vertices that lie on them. */
static bool take_between(mesh *m, double weld, done *d)
{
    const side *list = m->sides;
    size_t open = 0;
    sort_edges(m);
    for (size_t from = 0, to; from < m->corners; from = to) {
        to = edge_end(m, m->corners, from);
        if (to == from + 1)
            m->root[open++] = list[from].half;
    }
    qsort(m->root, open, sizeof *m->root, by_number);
    return open == 0 || mesh_take_between(m, m->root, open, weld, &d->between);
}

/* Where two faces share an edge, they are neighbours in any case. */
static void pair_twos(mesh *m)
{
    const side *list = m->sides;
    for (size_t from = 0, to; from < m->corners; from = to) {
        to = edge_end(m, m->corners, from);
        if (to != from + 2)
            continue;
        m->mate[list[from].half] = list[from + 1].half;
        m->mate[list[from + 1].half] = list[from].half;
    }
}

/* Turns the fewer of the faces that hang together over edges of two faces, until neighbours agree. False where a strip
 * of them has one side only. */
static bool agree(mesh *m, done *d)
{
    uint32_t *queue = m->root;
    bool sided = true;
    for (size_t f = 0; f < m->faces; f++)
        m->face[f].side = NONE;
    for (uint32_t first = 0; first < m->faces; first++) {
        if (m->face[first].side != NONE)
            continue;
        size_t count = 1, turned = 0;
        queue[0] = first;
        m->face[first].side = 0;
        for (size_t i = 0; i < count; i++) {
            const shell_face *f = &m->face[queue[i]];
            for (uint32_t h = f->first; h < f->first + f->count; h++) {
                if (m->mate[h] == NONE)
                    continue;
                uint32_t other = m->face_of[m->mate[h]];
                bool same_way = m->corner[h] == m->corner[m->mate[h]];
                uint32_t wanted = f->side ^ (uint32_t)same_way;
                if (m->face[other].side == NONE) {
                    m->face[other].side = wanted;
                    turned += wanted;
                    queue[count++] = other;
                } else if (m->face[other].side != wanted) {
                    sided = false;
                }
            }
        }
        uint32_t turn = 2 * turned <= count;
        for (size_t i = 0; i < count; i++)
            m->face[queue[i]].side = m->face[queue[i]].side == turn;
    }
    for (uint32_t f = 0; f < m->faces; f++)
        if (m->face[f].side) {
            turn_face(m, f);
            d->turned++;
        }
    return sided;
}

/* The largest distance of a face's corners from the line of one of its half-edges, along a unit vector. */
static double reach_of(const mesh *m, uint32_t h, tl_vec3 along)
{
    const shell_face *f = &m->face[m->face_of[h]];
    double reach2 = 0;
    for (uint32_t k = f->first; k < f->first + f->count; k++)
        reach2 =
            fmax(reach2, tl_v3_norm2(tl_v3_cross(along, tl_v3_sub(m->vertex[m->corner[k]], m->vertex[m->corner[h]]))));
    return sqrt(reach2);
}

/* The angle through the inside from the face of half-edge h to that of g, which runs the other way. Faces off their
 * planes by `flat` are along each other within an angle of 2 flat / reach, with their reach from the edge. */
static double inner_angle(const mesh *m, uint32_t h, uint32_t g, double flat)
{
    tl_vec3 a = m->vertex[m->corner[h]], b = m->vertex[m->corner[mesh_next(m, h)]];
    tl_vec3 along = tl_v3_unit(tl_v3_sub(b, a)), n = tl_v3_unit(m->face[m->face_of[h]].area);
    tl_vec3 into = tl_v3_cross(n, along);
    tl_vec3 other = tl_v3_cross(along, tl_v3_unit(m->face[m->face_of[g]].area));
    double angle = tl_atan2(-tl_v3_dot(other, n), tl_v3_dot(other, into));
    double reach = fmin(reach_of(m, h, along), reach_of(m, g, along));
    double same = fmin(fmax(2 * flat / fmax(reach, 1e-300), SAME_SIDE), MOST_SAME_SIDE);
    return angle < same ? angle + 2 * TL_PI : angle;
}

/* Pairs the half-edges of one edge, of which as many run one way as the other. False when two of them find the same
 * partner: faces lie on each other. */
static bool pair_edge(mesh *m, const side *sides, size_t count, double flat)
{
    for (size_t i = 0; i < count; i++) {
        if (!sides[i].up)
            continue;
        uint32_t best = NONE;
        double least = INFINITY;
        for (size_t k = 0; k < count; k++) {
            double angle = sides[k].up ? (double)INFINITY : inner_angle(m, sides[i].half, sides[k].half, flat);
            if (angle < least) {
                least = angle;
                best = sides[k].half;
            }
        }
        if (best == NONE || m->mate[best] != NONE)
            return false;
        m->mate[best] = sides[i].half;
        m->mate[sides[i].half] = best;
    }
    return true;
}

/* What may be wrong with the edges of the surface, the worst first. */
enum { OPEN, ODD, TURNED, DOUBLED, FAULTS };
static const char *const faults_text[FAULTS][2] = {
    [OPEN] = {"the surface is open", "close it, so that every edge belongs to two faces, or set weld"},
    [ODD] = {"an odd number of faces meet, more than two,",
             "remove faces that are there twice and walls inside a solid, or make each solid an object of its own"},
    [TURNED] = {"more than two faces meet, and are turned against each other",
                "make each solid an object of its own, or give the corners of all faces counter-clockwise as seen from "
                "outside"},
    [DOUBLED] = {"faces lie on each other, or are turned against each other",
                 "remove faces that are there twice, or give each solid corners of its own"}};

/* Pairs all half-edges; refuses the object where that cannot be. */
static tl_status pair_all(solids *s, uint32_t object, mesh *m, bool *taken)
{
    size_t count[FAULTS] = {0}, first[FAULTS] = {0};
    sort_edges(m);
    const side *list = m->sides;
    for (size_t from = 0, to; from < m->corners; from = to) {
        size_t up = 0;
        to = edge_end(m, m->corners, from);
        for (size_t i = from; i < to; i++)
            up += list[i].up;
        bool even = 2 * up == to - from;
        if (even && pair_edge(m, list + from, to - from, s->flat))
            continue;
        int fault = even ? DOUBLED : (to - from) % 2 == 0 ? TURNED : to - from > 1 ? ODD : OPEN;
        first[fault] = count[fault]++ ? first[fault] : from;
    }
    for (int k = 0; k < FAULTS; k++) {
        if (count[k] == 0)
            continue;
        tl_vec3 p = m->vertex[list[first[k]].low], q = m->vertex[list[first[k]].high];
        *taken = false;
        return refuse_object(
            s, object, 0, ": %s at %zu edge%s, the first from {%.6g, %.6g, %.6g} to {%.6g, %.6g, %.6g}; %s",
            faults_text[k][0], count[k], count[k] == 1 ? "" : "s", p.x, p.y, p.z, q.x, q.y, q.z, faults_text[k][1]);
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- shells ----------------- */

/* Numbers the faces that hang together over edges, walking each shell from its first face. */
static void number_shells(mesh *m)
{
    uint32_t *open = m->root;
    m->shells = 0;
    for (uint32_t first = 0; first < m->faces; first++) {
        if (m->face[first].shell != NONE)
            continue;
        uint32_t number = (uint32_t)m->shells++;
        size_t count = 0;
        open[count++] = first;
        m->face[first].shell = number;
        while (count > 0) {
            const shell_face *f = &m->face[open[--count]];
            for (uint32_t h = f->first; h < f->first + f->count; h++) {
                uint32_t next = m->face_of[m->mate[h]];
                if (m->face[next].shell != NONE)
                    continue;
                m->face[next].shell = number;
                open[count++] = next;
            }
        }
    }
}

/* Six times the volume within the faces of a shell, or of all with NONE; its size. */
static double volume_of(const mesh *m, uint32_t shell, double *size)
{
    bool begun = false;
    tl_vec3 zero = {0, 0, 0};
    double volume6 = 0;
    *size = 0;
    for (size_t f = 0; f < m->faces; f++) {
        const shell_face *face = &m->face[f];
        if (shell != NONE && face->shell != shell)
            continue;
        tl_vec3 first = m->vertex[m->corner[face->first]];
        zero = begun ? zero : first;
        begun = true;
        volume6 += tl_v3_dot(tl_v3_sub(first, zero), face->area);
        for (uint32_t h = face->first; h < face->first + face->count; h++)
            *size = fmax(*size, tl_v3_norm(tl_v3_sub(m->vertex[m->corner[h]], zero)));
    }
    return volume6;
}

/* Whether a vertex of a shell lies within another one: a ray crosses that an odd number of times. */
static bool lies_inside(const mesh *m, uint32_t shell, uint32_t other)
{
    const tl_vec3 ray = {0.31830988618, 0.57721566490, 0.75204108811}; /* along no likely edge */
    tl_vec3 at = {0, 0, 0};
    size_t crossings = 0;
    for (size_t f = 0; f < m->faces; f++)
        if (m->face[f].shell == shell)
            at = m->vertex[m->corner[m->face[f].first]];
    for (size_t f = 0; f < m->faces; f++) {
        const shell_face *face = &m->face[f];
        if (face->shell != other)
            continue;
        tl_vec3 a = tl_v3_sub(m->vertex[m->corner[face->first]], at);
        for (uint32_t k = 1; k + 1 < face->count; k++) {
            tl_vec3 b = tl_v3_sub(m->vertex[m->corner[face->first + k]], at);
            tl_vec3 c = tl_v3_sub(m->vertex[m->corner[face->first + k + 1]], at);
            double u = tl_v3_dot(ray, tl_v3_cross(a, b)), v = tl_v3_dot(ray, tl_v3_cross(b, c)),
                   w = tl_v3_dot(ray, tl_v3_cross(c, a));
            if ((u > 0) == (v > 0) && (v > 0) == (w > 0))
                crossings += (tl_v3_dot(a, tl_v3_cross(b, c)) > 0) == (u > 0);
        }
    }
    return crossings % 2 == 1;
}

/* The smallest shell that faces outward and holds another one; NONE where none does. */
static uint32_t shell_around(const mesh *m, const double *volume, uint32_t shell)
{
    uint32_t around = NONE;
    for (uint32_t k = 0; k < m->shells; k++)
        if (volume[k] > -volume[shell] && (around == NONE || volume[k] < volume[around]) && lies_inside(m, shell, k))
            around = k;
    return around;
}

/* Gives cavities, which lie in a shell and face inward, to that shell: they bound one solid. Other shells are turned
 * outward. shell_of has the new numbers. */
static void give_cavities(mesh *m, const double *volume, uint32_t *shell_of, done *d)
{
    uint32_t left = 0;
    for (uint32_t k = 0; k < m->shells; k++) {
        uint32_t around = volume[k] < 0 ? shell_around(m, volume, k) : NONE;
        shell_of[k] = around == NONE ? k : around;
    }
    for (uint32_t f = 0; f < m->faces; f++) {
        uint32_t shell = m->face[f].shell;
        if (volume[shell] < 0 && shell_of[shell] == shell) {
            turn_face(m, f);
            d->inside_out = true;
        }
        m->face[f].shell = shell_of[shell];
    }
    for (uint32_t k = 0; k < m->shells; k++)
        shell_of[k] = shell_of[k] == k ? left++ : NONE;
    for (uint32_t f = 0; f < m->faces; f++)
        m->face[f].shell = shell_of[m->face[f].shell];
    m->shells = d->shells = left;
}

/* Turns shells outward but for cavities, and refuses those that hold nothing. */
static tl_status turn_shells(solids *s, uint32_t object, mesh *m, done *d, bool *taken)
{
    double *volume = malloc((m->shells + 1) * sizeof *volume), size;
    uint32_t *shell_of = malloc((m->shells + 1) * sizeof *shell_of);
    tl_status status = volume && shell_of ? TL_OK : soup_no_memory(&s->soup);
    for (uint32_t k = 0; k < m->shells && status == TL_OK && *taken; k++) {
        volume[k] = volume_of(m, k, &size);
        if (!(fabs(volume[k]) > EMPTY * size * size * size)) {
            *taken = false;
            status = refuse_object(s, object, 0, "%s holds no volume; remove it, or give it thickness",
                                   m->shells > 1 ? ": a shell of it" : "");
        }
    }
    if (status == TL_OK && *taken)
        give_cavities(m, volume, shell_of, d);
    free(shell_of);
    free(volume);
    return status;
}

tl_status mesh_close(solids *s, uint32_t object, mesh *m, bool *taken)
{
    const soup *from = &s->soup;
    const file_object *o = &from->object[object];
    uint32_t last = object + 1 < from->objects ? o[1].face : (uint32_t)from->faces;
    done *d = &s->done[object];
    double size;
    *taken = true;
    if (!make_room(s, m, from->start[last] - from->start[o->face], last - o->face))
        return soup_no_memory(from);
    find_parts(from, o, last, m);
    weld_vertices(s, o, last, m, d);
    make_faces(s, o, last, m, d);
    for (size_t f = 0; f < m->faces; f++)
        measure_face(m, &m->face[f]);
    if (m->faces < 4) {
        *taken = false;
        if (d->collapsed > 0)
            return refuse_object(
                s, object, 0,
                " has %zu faces with corners that are farther apart than weld = %g m, and %u without: it "
                "closes no solid; set weld lower",
                m->faces, s->weld, d->collapsed);
        return refuse_object(s, object, 0,
                             " has %zu face%s: it closes no solid, which takes 4 or more; export all its faces",
                             m->faces, m->faces == 1 ? "" : "s");
    }
    if (!take_between(m, s->weld, d))
        return soup_no_memory(from);
    sort_edges(m);
    pair_twos(m);
    if (!agree(m, d)) {
        *taken = false;
        return refuse_object(s, object, 0, " is a surface with one side, as Moebius's strip; remove faces that cross");
    }
    if (volume_of(m, NONE, &size) < 0) {
        d->inside_out = true;
        for (uint32_t f = 0; f < m->faces; f++)
            turn_face(m, f);
    }
    tl_status status = pair_all(s, object, m, taken);
    if (status != TL_OK || !*taken)
        return status;
    number_shells(m);
    d->shells = (uint32_t)m->shells;
    status = turn_shells(s, object, m, d, taken);
    if (status == TL_OK && *taken && d->inside_out) { /* half-edges were renumbered */
        sort_edges(m);
        status = pair_all(s, object, m, taken);
    }
    return status;
}
