/* mesh.c - from loose faces to closed solids.
 *
 * Vertices at one place become one. Every edge must then be run through as often one way as the other. Where solids
 * touch along an edge, several faces meet there; a half-edge belongs with that of the face which is met first when
 * turning from its own face through the inside. That is where its solid ends. */
#include "mesh.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* A face whose height over its longest edge is below this times that edge has no area: what floats leave
 * of three points in a line. */
#define SLENDER 1e-7
/* Corners of a face may miss the plane through one of them by this times its longest edge: 1e-4 to either side of a
 * plane between them. */
#define FLAT 2e-4
/* Faces along each other are a full turn apart, not none: less than this, in radians, is none. */
#define SAME_SIDE 1e-6

tl_status mesh_no_memory(const mesh *m)
{
    return m->host->fail(m->host, TL_E_MEMORY, "file '%.200s': out of memory", m->file);
}

tl_status mesh_add_vertex(mesh *m, tl_vec3 at, const char *place, size_t number)
{
    double largest = fmax(fmax(fabs(at.x), fabs(at.y)), fabs(at.z));
    if (!tl_v3_finite(at) || largest > LARGEST_COORDINATE)
        return m->host->fail(m->host, TL_E_NUMERIC,
                             "file '%.200s', %s %zu: the corner {%g, %g, %g} is not finite or beyond "
                             "%g; the file is damaged",
                             m->file, place, number, at.x, at.y, at.z, LARGEST_COORDINATE);
    tl_vec3 *vertex =
        m->vertices < MOST_CORNERS ? tl_grown(m->vertex, &m->vertex_capacity, m->vertices + 1, sizeof *vertex) : NULL;
    if (!vertex)
        return mesh_no_memory(m);
    m->vertex = vertex;
    m->vertex[m->vertices++] = at;
    m->reach = fmax(m->reach, largest);
    return TL_OK;
}

tl_status mesh_add_face(mesh *m, const uint32_t *corner, size_t count)
{
    size_t corners = m->corners + count;
    uint32_t *all = corners < MOST_CORNERS ? tl_grown(m->corner, &m->corner_capacity, corners, sizeof *all) : NULL;
    m->corner = all ? all : m->corner;
    uint32_t *start = tl_grown(m->start, &m->face_capacity, m->faces + 2, sizeof *start);
    m->start = start ? start : m->start;
    if (!all || !start)
        return mesh_no_memory(m);
    memcpy(m->corner + m->corners, corner, count * sizeof *corner);
    m->start[m->faces++] = (uint32_t)m->corners;
    m->corners = corners;
    m->start[m->faces] = (uint32_t)m->corners;
    return TL_OK;
}

void mesh_free(mesh *m)
{
    free(m->vertex);
    free(m->corner);
    free(m->start);
    free(m->face_of);
    free(m->mate);
    free(m->face);
}

uint32_t mesh_next(const mesh *m, uint32_t h)
{
    uint32_t face = m->face_of[h];
    return h + 1 < m->start[face + 1] ? h + 1 : m->start[face];
}

/* ---------------------------------------------------------------- vertices --------------- */

typedef struct place {
    tl_vec3 at;
    uint32_t vertex;
} place;

static int compare_numbers(double a, double b)
{
    return (a > b) - (a < b);
}

static int by_place(const void *left, const void *right)
{
    const place *a = left, *b = right;
    int order = compare_numbers(a->at.x, b->at.x);
    order = order ? order : compare_numbers(a->at.y, b->at.y);
    order = order ? order : compare_numbers(a->at.z, b->at.z);
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* Every corner names the first of the vertices at its place. */
static tl_status weld(mesh *m)
{
    place *places = malloc((m->vertices + 1) * sizeof *places);
    uint32_t *first = malloc((m->vertices + 1) * sizeof *first);
    if (places && first) {
        for (size_t i = 0; i < m->vertices; i++)
            places[i] = (place){m->vertex[i], (uint32_t)i};
        qsort(places, m->vertices, sizeof *places, by_place);
        for (size_t i = 0; i < m->vertices; i++) {
            bool same = i > 0 && tl_v3_norm2(tl_v3_sub(places[i].at, places[i - 1].at)) == 0;
            first[places[i].vertex] = same ? first[places[i - 1].vertex] : places[i].vertex;
        }
        for (size_t i = 0; i < m->corners; i++)
            m->corner[i] = first[m->corner[i]];
    }
    tl_status status = places && first ? TL_OK : mesh_no_memory(m);
    free(places);
    free(first);
    return status;
}

/* ---------------------------------------------------------------- faces ------------------ */

static tl_status face_fault(const mesh *m, uint32_t face, const char *what, const char *remedy)
{
    tl_vec3 at = m->vertex[m->corner[m->start[face]]];
    return MESH_FAULT(m, ": face %u, at {%g, %g, %g}, %s; %s", face + 1, at.x, at.y, at.z, what, remedy);
}

/* Normal, longest edge and height of a face; refuses one without area or not flat. */
static tl_status measure_face(mesh *m, uint32_t face)
{
    uint32_t from = m->start[face], to = m->start[face + 1];
    tl_vec3 zero = m->vertex[m->corner[from]], area = {0, 0, 0};
    double longest = 0;
    for (uint32_t h = from; h < to; h++) {
        m->face_of[h] = face;
        tl_vec3 a = tl_v3_sub(m->vertex[m->corner[h]], zero);
        tl_vec3 b = tl_v3_sub(m->vertex[m->corner[h + 1 < to ? h + 1 : from]], zero);
        double length = tl_v3_norm(tl_v3_sub(b, a));
        if (!(length > 0))
            return face_fault(m, face, "has two neighbouring corners at one place",
                              "remove such faces and close the gap");
        longest = fmax(longest, length);
        area = tl_v3_add(area, tl_v3_cross(a, b));
    }
    double height = tl_v3_norm(area) / longest;
    if (!(height > SLENDER * longest))
        return face_fault(m, face, "has no area", "remove such faces and close the gap");
    m->face[face].normal = tl_v3_unit(area);
    m->face[face].longest = longest;
    m->face[face].height = height;
    for (uint32_t h = from; h < to; h++) {
        double off = tl_v3_dot(m->face[face].normal, tl_v3_sub(m->vertex[m->corner[h]], zero));
        if (fabs(off) > FLAT * longest)
            return face_fault(m, face, "is not flat", "divide it into triangles");
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- edges ------------------ */

typedef struct side {
    uint32_t low, high; /* vertices */
    uint32_t half;      /* half-edge */
    bool up;            /* it runs from low to high */
} side;

static int by_edge(const void *left, const void *right)
{
    const side *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->half > b->half) - (a->half < b->half);
}

static side side_of(const mesh *m, uint32_t h)
{
    uint32_t a = m->corner[h], b = m->corner[mesh_next(m, h)];
    return a < b ? (side){a, b, h, true} : (side){b, a, h, false};
}

/* The angle through the inside from the face of half-edge h to that of g, which runs the other way. */
static double inner_angle(const mesh *m, uint32_t h, uint32_t g)
{
    tl_vec3 a = m->vertex[m->corner[h]], b = m->vertex[m->corner[mesh_next(m, h)]];
    tl_vec3 along = tl_v3_unit(tl_v3_sub(b, a)), n = m->face[m->face_of[h]].normal;
    tl_vec3 into = tl_v3_cross(n, along);
    tl_vec3 other = tl_v3_cross(along, m->face[m->face_of[g]].normal);
    double angle = tl_atan2(-tl_v3_dot(other, n), tl_v3_dot(other, into));
    return angle < SAME_SIDE ? angle + 2 * TL_PI : angle;
}

/* Pairs the half-edges of one edge, of which as many run one way as the other. False when two of them
 * find the same partner: faces lie on each other. */
static bool pair_edge(mesh *m, const side *sides, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!sides[i].up)
            continue;
        uint32_t best = NONE;
        double least = INFINITY;
        for (size_t k = 0; k < count; k++) {
            double angle = sides[k].up ? INFINITY : inner_angle(m, sides[i].half, sides[k].half);
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

/* What may be wrong with the edges of the surface, the worst first; at how many, and the first of them. */
enum { OPEN, TURNED, DOUBLED, FAULTS };
static const char *const faults_text[FAULTS][2] = {
    [OPEN] = {"the surface is open", "close it, so that every edge belongs to two faces"},
    [TURNED] = {"faces are turned against each other",
                "give the corners of all faces counter-clockwise as seen from outside"},
    [DOUBLED] = {"faces lie on each other", "remove faces that are there twice"}};

typedef struct faults {
    size_t count[FAULTS];
    side first[FAULTS];
} faults;

static void look_at_edge(mesh *m, const side *sides, size_t count, faults *f)
{
    size_t up = 0;
    for (size_t i = 0; i < count; i++)
        up += sides[i].up;
    bool even = 2 * up == count;
    int fault = even ? DOUBLED : count % 2 == 0 ? TURNED : OPEN;
    if (even && pair_edge(m, sides, count))
        return;
    if (f->count[fault]++ == 0)
        f->first[fault] = sides[0];
}

static tl_status pair_edges(mesh *m)
{
    side *sides = malloc((m->corners + 1) * sizeof *sides);
    if (!sides)
        return mesh_no_memory(m);
    for (size_t h = 0; h < m->corners; h++) {
        sides[h] = side_of(m, (uint32_t)h);
        m->mate[h] = NONE;
    }
    qsort(sides, m->corners, sizeof *sides, by_edge);
    faults f = {0};
    for (size_t from = 0, to = 0; from < m->corners; from = to) {
        for (; to < m->corners && sides[to].low == sides[from].low && sides[to].high == sides[from].high; to++)
            continue;
        look_at_edge(m, sides + from, to - from, &f);
    }
    free(sides);
    for (int k = 0; k < FAULTS; k++) {
        tl_vec3 p = m->vertex[f.first[k].low], q = m->vertex[f.first[k].high];
        if (f.count[k] > 0)
            return MESH_FAULT(m, ": %s at %zu edge%s, the first from {%g, %g, %g} to {%g, %g, %g} of face %u; %s",
                              faults_text[k][0], f.count[k], f.count[k] == 1 ? "" : "s", p.x, p.y, p.z, q.x, q.y, q.z,
                              m->face_of[f.first[k].half] + 1, faults_text[k][1]);
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- solids ----------------- */

/* Numbers the sets of faces that hang together over edges, walking each from its first face. */
static tl_status number_solids(mesh *m)
{
    uint32_t *open = malloc((m->faces + 1) * sizeof *open);
    if (!open)
        return mesh_no_memory(m);
    for (size_t face = 0; face < m->faces; face++)
        m->face[face].solid = NONE;
    for (size_t first = 0; first < m->faces; first++) {
        if (m->face[first].solid != NONE)
            continue;
        uint32_t number = (uint32_t)m->solids++;
        size_t count = 0;
        open[count++] = (uint32_t)first;
        m->face[first].solid = number;
        while (count > 0) {
            uint32_t face = open[--count];
            for (uint32_t h = m->start[face]; h < m->start[face + 1]; h++) {
                uint32_t next = m->face_of[m->mate[h]];
                if (m->face[next].solid != NONE)
                    continue;
                m->face[next].solid = number;
                open[count++] = next;
            }
        }
    }
    free(open);
    return TL_OK;
}

tl_status mesh_close(mesh *m)
{
    if (m->faces == 0)
        return m->host->fail(m->host, TL_E_GEOMETRY, "file '%.200s' holds no faces", m->file);
    m->face_of = malloc(m->corners * sizeof *m->face_of);
    m->mate = malloc(m->corners * sizeof *m->mate);
    m->face = malloc(m->faces * sizeof *m->face);
    if (!m->face_of || !m->mate || !m->face)
        return mesh_no_memory(m);
    tl_status status = weld(m);
    for (size_t face = 0; face < m->faces && status == TL_OK; face++)
        status = measure_face(m, (uint32_t)face);
    if (status == TL_OK)
        status = pair_edges(m);
    return status == TL_OK ? number_solids(m) : status;
}
