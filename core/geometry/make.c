/* make.c - making, copying and checking convex polyhedra.
 *
 * A polyhedron is one allocation: the header, then its arrays by falling alignment; seams, which few have, are another.
 * Edges are found by pairing half-edges: the half-edge a -> b of one face needs exactly one b -> a in another. */
#include "geometry/make.h"

#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Half-edges up to which pairing works on the stack: a polyhedron of 86 edges, while blocks of
 * jointed rock have 12 to 60. */
#define LOCAL_HALF_EDGES 172

/* Tolerance: deviation from length 1 that still counts as a unit normal: 1e6 roundings, without effect. */
#define UNIT_TOLERANCE 1e-10

static size_t allocation(size_t v, size_t f, size_t e)
{
    const tl_poly *p = NULL;
    return sizeof *p + v * sizeof *p->vertex + f * (sizeof *p->plane + sizeof *p->tag) + (f + 1) * sizeof *p->start +
           e * sizeof *p->edge + 2 * e * sizeof *p->loop;
}

size_t tl_poly_bytes(const tl_poly *p)
{
    return allocation(p->vertex_count, p->face_count, p->edge_count) + (p->seams ? p->face_count : 0) +
           (p->plane_count > p->face_count ? p->plane_count * sizeof *p->plane : 0);
}

/* No face is covered: of all polyhedra without seams. */
static const uint8_t no_seams[TL_POLY_MAX_FACES];

/* The planes of the faces, in the allocation of the polyhedron. */
static tl_plane *own_planes(tl_poly *p)
{
    return (tl_plane *)(p->vertex + p->vertex_count);
}

/* Keeps the planes of the faces only, where they are now. */
static void forget_planes(tl_poly *p)
{
    tl_plane *own = own_planes(p);
    if (p->plane != own) {
        memcpy(own, p->plane, p->face_count * sizeof *own);
        free(p->plane);
    }
    p->plane = own;
    p->plane_count = p->face_count;
}

void tl_poly_clear_seams(tl_poly *p)
{
    if (p->seams)
        free((void *)(uintptr_t)p->covered);
    p->seams = false;
    p->covered = no_seams;
    forget_planes(p);
}

bool tl_poly_add_planes(tl_poly *p, const tl_plane *planes, uint32_t count)
{
    forget_planes(p);
    if (count == 0)
        return true;
    tl_plane *all = malloc(((size_t)p->face_count + count) * sizeof *all);
    if (!all)
        return false;
    memcpy(all, p->plane, p->face_count * sizeof *all);
    memcpy(all + p->face_count, planes, count * sizeof *all);
    p->plane = all;
    p->plane_count = p->face_count + count;
    return true;
}

uint8_t *tl_poly_open_seams(tl_poly *p)
{
    uint8_t *marks = calloc(p->face_count, 1);
    if (!marks)
        return NULL;
    tl_poly_clear_seams(p);
    p->seams = true;
    p->covered = marks;
    return marks;
}

tl_poly *tl_poly_allocate(uint32_t vertex_count, uint32_t face_count, uint32_t edge_count)
{
    size_t v = vertex_count, f = face_count, e = edge_count;
    tl_poly *p = malloc(allocation(v, f, e));
    if (!p)
        return NULL;
    p->vertex_count = vertex_count;
    p->face_count = face_count;
    p->edge_count = edge_count;
    p->size = 0;
    p->plane_count = face_count;
    p->plane = own_planes(p);
    p->tag = (tl_tag *)(p->plane + f);
    p->edge = (tl_edge *)(p->tag + f);
    p->loop = (uint16_t *)(p->edge + e);
    p->start = p->loop + 2 * e;
    p->seams = false;
    p->covered = no_seams;
    return p;
}

/* A half-edge is known by its place in `loop`. */
typedef struct half_edges {
    uint16_t *at;   /* [vertex + 1] into star: the half-edges that begin there */
    uint16_t *star; /* half-edges by their first vertex */
    uint16_t *end;  /* [place in star] the vertex it runs to: neighbours are searched together */
    uint16_t *face; /* [half-edge] */
} half_edges;

/* The vertex that follows place h in the loop of a face. */
static uint16_t after(const tl_poly *p, uint32_t face, uint32_t h)
{
    return p->loop[tl_poly_after(p, face, h)];
}

/* Groups half-edges by origin, and notes each one's face and end. */
static void group_half_edges(tl_poly *p, half_edges half)
{
    uint16_t *at = half.at;
    uint32_t half_count = 2 * p->edge_count;
    memset(at, 0, (p->vertex_count + 1) * sizeof *at);
    for (uint32_t h = 0; h < half_count; h++)
        at[p->loop[h] + 1]++;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        at[v + 1] = (uint16_t)(at[v + 1] + at[v]);
    for (uint32_t f = 0; f < p->face_count; f++)
        for (uint32_t h = p->start[f]; h < p->start[f + 1]; h++) {
            uint32_t place = at[p->loop[h]]++;
            half.face[h] = (uint16_t)f;
            half.end[place] = after(p, f, h);
            half.star[place] = (uint16_t)h;
        }
    /* Filling moved every start to the next one's place. */
    memmove(at + 1, at, p->vertex_count * sizeof *at);
    at[0] = 0;
}

/* The number of half-edges from a to b; the last of them goes into *found. */
static int find_half_edge(half_edges half, uint16_t a, uint16_t b, uint16_t *found)
{
    int count = 0;
    for (uint32_t i = half.at[a]; i < half.at[a + 1]; i++)
        if (half.end[i] == b) {
            *found = half.star[i];
            count++;
        }
    return count;
}

/* The sentence for the first half-edge that has no partner or a rival. */
static tl_status report_unpaired(const tl_poly *p, half_edges half, tl_error *error)
{
    uint32_t half_count = 2 * p->edge_count;
    for (uint32_t h = 0; error && h < half_count; h++) {
        uint16_t a = p->loop[h], b = after(p, half.face[h], h), found;
        int forth = find_half_edge(half, a, b, &found), back = find_half_edge(half, b, a, &found);
        if (a != b && forth == 1 && back == 1)
            continue;
        return tl_fail(error, TL_E_GEOMETRY,
                       "the edge from vertex %d to vertex %d belongs to %d face%s, not to two that run along it in "
                       "opposite directions: give every face counter-clockwise from outside and leave no hole",
                       a + 1, b + 1, forth + back, forth + back == 1 ? "" : "s");
    }
    return TL_E_GEOMETRY;
}

/* Finds the edges from their half-edges that run to the higher vertex. When every one of them has
 * one partner and there are half as many as half-edges, no other can be without. */
static tl_status pair_half_edges(tl_poly *p, half_edges half, tl_error *error)
{
    uint32_t half_count = 2 * p->edge_count, edges = 0;
    for (uint32_t h = 0; h < half_count; h++) {
        uint16_t a = p->loop[h], b = after(p, half.face[h], h), forth, back;
        if (a >= b)
            continue;
        if (edges == p->edge_count || find_half_edge(half, a, b, &forth) != 1 || find_half_edge(half, b, a, &back) != 1)
            return report_unpaired(p, half, error);
        p->edge[edges] = (tl_edge){a, b, half.face[h], half.face[back]};
        edges++;
    }
    if (edges != p->edge_count)
        return report_unpaired(p, half, error);
    return TL_OK;
}

tl_status tl_poly_link(tl_poly *p, tl_poly **linked, tl_error *error)
{
    /* there are fewer vertices than half-edges */
    uint32_t half_count = 2 * p->edge_count;
    uint16_t local[4 * LOCAL_HALF_EDGES], *scratch = local;
    if (half_count > LOCAL_HALF_EDGES && !(scratch = malloc(4 * half_count * sizeof *scratch))) {
        tl_poly_free(p);
        return tl_fail_memory(error);
    }
    half_edges half = {scratch, scratch + half_count, scratch + 2 * half_count, scratch + 3 * half_count};
    group_half_edges(p, half);
    tl_status status = pair_half_edges(p, half, error);
    if (scratch != local)
        free(scratch);
    if (status != TL_OK) {
        tl_poly_free(p);
        return status;
    }
    tl_poly_find_size(p);
    *linked = p;
    return TL_OK;
}

tl_vec3 tl_poly_normal(tl_vec3 area)
{
    double length = tl_v3_norm(area);
    /* Division keeps an axis an axis; adding zero turns -0 into 0. */
    return length > 0 ? tl_v3(area.x / length + 0.0, area.y / length + 0.0, area.z / length + 0.0) : tl_v3(0, 0, 0);
}

double tl_poly_midway(double low, double high)
{
    return low == high ? low : 0.5 * (low + high);
}

tl_vec3 tl_poly_fan_area(const tl_vec3 *vertices, const uint16_t *loop, size_t count)
{
    tl_vec3 base = vertices[loop[0]], sum = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; i++)
        sum = tl_v3_add(sum, tl_v3_cross(tl_v3_sub(vertices[loop[i]], base), tl_v3_sub(vertices[loop[i + 1]], base)));
    return sum;
}

/* Everything tl_poly_make asks of its input short of pairing the edges. */
static tl_status check_input(const tl_vec3 *vertices, size_t vertex_count, const tl_plane *planes,
                             const uint32_t *start, const uint16_t *loops, size_t face_count, tl_error *error)
{
    if (vertex_count < 4 || vertex_count > TL_POLY_MAX_VERTICES)
        return tl_fail(error, TL_E_GEOMETRY, "a polyhedron of %zu vertices: it needs 4 to %d", vertex_count,
                       TL_POLY_MAX_VERTICES);
    if (face_count < 4 || face_count > TL_POLY_MAX_FACES)
        return tl_fail(error, TL_E_GEOMETRY, "a polyhedron of %zu faces: it needs 4 to %d", face_count,
                       TL_POLY_MAX_FACES);
    for (size_t v = 0; v < vertex_count; v++)
        if (!tl_v3_finite(vertices[v]))
            return tl_fail(error, TL_E_GEOMETRY, "vertex %zu has a coordinate that is not finite", v + 1);
    for (size_t f = 0; f < face_count; f++) {
        if (start[f + 1] < start[f] + 3 || start[f + 1] > 2 * TL_POLY_MAX_EDGES)
            return tl_fail(error, TL_E_GEOMETRY,
                           "face %zu needs three vertices or more, and all faces together no more than %d", f + 1,
                           2 * TL_POLY_MAX_EDGES);
        if (!tl_v3_finite(planes[f].normal) || !isfinite(planes[f].offset))
            return tl_fail(error, TL_E_GEOMETRY, "the plane of face %zu is not finite", f + 1);
        for (uint32_t i = start[f]; i < start[f + 1]; i++)
            if (loops[i] >= vertex_count)
                return tl_fail(error, TL_E_GEOMETRY, "face %zu names vertex %d of %zu", f + 1, loops[i] + 1,
                               vertex_count);
    }
    if (start[face_count] - start[0] != 2 * (vertex_count + face_count - 2))
        return tl_fail(error, TL_E_GEOMETRY,
                       "%zu vertices, %zu faces and %g edges do not make a closed convex surface: vertices + faces - "
                       "edges must be 2",
                       vertex_count, face_count, 0.5 * (start[face_count] - start[0]));
    return TL_OK;
}

tl_status tl_poly_make(const tl_vec3 *vertices, size_t vertex_count, const tl_plane *planes, const tl_tag *tags,
                       const uint32_t *start, const uint16_t *loops, size_t face_count, tl_poly **poly, tl_error *error)
{
    *poly = NULL;
    tl_status status = check_input(vertices, vertex_count, planes, start, loops, face_count, error);
    if (status)
        return status;
    uint32_t loop_count = start[face_count] - start[0];
    tl_poly *p = tl_poly_allocate((uint32_t)vertex_count, (uint32_t)face_count, loop_count / 2);
    if (!p)
        return tl_fail_memory(error);
    memcpy(p->vertex, vertices, vertex_count * sizeof *vertices);
    memcpy(p->plane, planes, face_count * sizeof *planes);
    if (tags)
        memcpy(p->tag, tags, face_count * sizeof *tags);
    else
        memset(p->tag, 0, face_count * sizeof *p->tag);
    for (size_t f = 0; f <= face_count; f++)
        p->start[f] = (uint16_t)(start[f] - start[0]);
    memcpy(p->loop, loops + start[0], loop_count * sizeof *loops);
    return tl_poly_link(p, poly, error);
}

tl_status tl_poly_box(tl_vec3 min, tl_vec3 max, tl_poly **poly, tl_error *error)
{
    *poly = NULL;
    if (!tl_v3_finite(min) || !tl_v3_finite(max))
        return tl_fail(error, TL_E_GEOMETRY, "a corner of the box is not finite");
    tl_vec3 edge = tl_v3_sub(max, min);
    double diagonal = tl_v3_norm(edge), thinnest = fmin(edge.x, fmin(edge.y, edge.z));
    if (!isfinite(diagonal * diagonal * diagonal) || !(thinnest >= TL_POLY_THIN * diagonal) ||
        !(thinnest * thinnest * thinnest > 0))
        return tl_fail(error, TL_E_GEOMETRY,
                       "a box with edges %g, %g, %g: every edge must be positive and at least %g of the diagonal",
                       edge.x, edge.y, edge.z, TL_POLY_THIN);
    tl_vec3 vertices[8];
    for (int i = 0; i < 8; i++)
        vertices[i] = tl_v3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
    const tl_plane planes[6] = {{{-1, 0, 0}, -min.x}, {{1, 0, 0}, max.x},   {{0, -1, 0}, -min.y},
                                {{0, 1, 0}, max.y},   {{0, 0, -1}, -min.z}, {{0, 0, 1}, max.z}};
    static const uint32_t start[7] = {0, 4, 8, 12, 16, 20, 24};
    static const uint16_t loops[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    return tl_poly_make(vertices, 8, planes, NULL, start, loops, 6, poly, error);
}

void tl_poly_free(tl_poly *poly)
{
    if (poly)
        tl_poly_clear_seams(poly);
    free(poly);
}

tl_poly *tl_poly_copy(const tl_poly *poly)
{
    tl_poly *p = tl_poly_allocate(poly->vertex_count, poly->face_count, poly->edge_count);
    if (!p)
        return NULL;
    p->size = poly->size;
    memcpy(p->vertex, poly->vertex, p->vertex_count * sizeof *p->vertex);
    memcpy(p->plane, poly->plane, p->face_count * sizeof *p->plane);
    memcpy(p->tag, poly->tag, p->face_count * sizeof *p->tag);
    memcpy(p->start, poly->start, (p->face_count + 1) * sizeof *p->start);
    memcpy(p->edge, poly->edge, p->edge_count * sizeof *p->edge);
    memcpy(p->loop, poly->loop, 2 * p->edge_count * sizeof *p->loop);
    uint8_t *marks = poly->seams ? tl_poly_open_seams(p) : NULL;
    if (marks)
        memcpy(marks, poly->covered, p->face_count);
    if ((marks || !poly->seams) &&
        tl_poly_add_planes(p, poly->plane + p->face_count, poly->plane_count - p->face_count))
        return p;
    tl_poly_free(p);
    return NULL;
}

tl_status tl_poly_transformed(const tl_poly *poly, const tl_mat3 *rotation, tl_vec3 translation, tl_poly **copy,
                              tl_error *error)
{
    *copy = NULL;
    tl_poly *p = tl_poly_copy(poly);
    if (!p)
        return tl_fail_memory(error);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        tl_vec3 x = poly->vertex[v];
        p->vertex[v] = tl_v3_add(rotation ? tl_m3_mul(rotation, x) : x, translation);
    }
    for (uint32_t f = 0; f < p->plane_count; f++) {
        tl_vec3 n = poly->plane[f].normal;
        p->plane[f].normal = rotation ? tl_m3_mul(rotation, n) : n;
        p->plane[f].offset = poly->plane[f].offset + tl_v3_dot(p->plane[f].normal, translation);
    }
    tl_poly_find_size(p);
    *copy = p;
    return TL_OK;
}

/* Whether vertex `a` is followed by `b` in the loop of `face`. */
static bool runs_along(const tl_poly *p, uint32_t face, uint16_t a, uint16_t b)
{
    uint32_t begin = p->start[face], end = p->start[face + 1];
    for (uint32_t i = begin; i < end; i++)
        if (p->loop[i] == a && p->loop[i + 1 < end ? i + 1 : begin] == b)
            return true;
    return false;
}

static tl_status check_topology(const tl_poly *p, tl_error *error)
{
    if (p->vertex_count + p->face_count != p->edge_count + 2)
        return tl_fail(error, TL_E_GEOMETRY, "%u vertices - %u edges + %u faces is not 2", p->vertex_count,
                       p->edge_count, p->face_count);
    if (p->start[0] != 0 || p->start[p->face_count] != 2 * p->edge_count)
        return tl_fail(error, TL_E_GEOMETRY, "the face loops do not hold every edge twice");
    uint16_t edges[TL_POLY_MAX_VERTICES] = {0};
    for (uint32_t h = 0; h < 2 * p->edge_count; h++)
        edges[p->loop[h]]++;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (edges[v] < 3)
            return tl_fail(error, TL_E_GEOMETRY, "vertex %u has fewer than three edges", v + 1);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_edge edge = p->edge[e];
        if (!runs_along(p, edge.left, edge.a, edge.b) || !runs_along(p, edge.right, edge.b, edge.a))
            return tl_fail(error, TL_E_GEOMETRY, "edge %u is not in the loops of its faces", e + 1);
    }
    return TL_OK;
}

static tl_status check_face(const tl_poly *p, uint32_t face, double tolerance, tl_error *error)
{
    uint32_t n = tl_poly_face_size(p, face);
    const uint16_t *loop = p->loop + p->start[face];
    tl_plane plane = p->plane[face];
    if (!(fabs(tl_v3_norm(plane.normal) - 1) <= UNIT_TOLERANCE))
        return tl_fail(error, TL_E_GEOMETRY, "the normal of face %u has length %g", face + 1, tl_v3_norm(plane.normal));
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double d = tl_v3_dot(plane.normal, p->vertex[v]) - plane.offset;
        if (!(d <= tolerance * p->size))
            return tl_fail(error, TL_E_GEOMETRY, "vertex %u lies %.3g outside face %u", v + 1, d, face + 1);
    }
    for (uint32_t i = 0; i < n; i++) {
        tl_vec3 a = p->vertex[loop[i]], b = p->vertex[loop[(i + 1) % n]];
        tl_vec3 c = p->vertex[loop[(i + 2) % n]];
        double d = tl_v3_dot(plane.normal, a) - plane.offset;
        if (!(fabs(d) <= tolerance * p->size))
            return tl_fail(error, TL_E_GEOMETRY, "vertex %d lies %.3g off its face %u", loop[i] + 1, d, face + 1);
        double turn = tl_v3_dot(plane.normal, tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, b)));
        if (!(turn >= -tolerance * p->size * p->size))
            return tl_fail(error, TL_E_GEOMETRY, "face %u turns clockwise at vertex %d", face + 1,
                           loop[(i + 1) % n] + 1);
    }
    return TL_OK;
}

tl_status tl_poly_check(const tl_poly *poly, double tolerance, tl_error *error)
{
    tl_status status = check_topology(poly, error);
    for (uint32_t f = 0; !status && f < poly->face_count; f++)
        status = check_face(poly, f, tolerance, error);
    if (status)
        return status;
    double volume = tl_poly_mass(poly).volume;
    if (!(volume > 0))
        return tl_fail(error, TL_E_GEOMETRY, "the volume is %g", volume);
    return TL_OK;
}
