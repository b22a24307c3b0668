/* flatten.c - facets that lie in one plane become one face.
 *
 * Meshes give a face as triangles. Corners miss its plane by the digits of a file or by the warp of a grid. Two faces
 * are one when all their corners miss a plane by less than half of TL_POLY_BENT times the size of both together. That
 * size is twice the distance of the farthest corner from their mean. What each has of area across that plane must be
 * less than TL_POLY_TILT of it all. So facets of equal areas may hardly tilt, and a round surface stays one. A sliver
 * knows its normal badly, and may tilt as it likes. Corners that miss a plane by less than TL_POLY_FLAT times the size
 * of the block miss it by nothing. Only facets with one tag are joined.
 *
 * Faces grow over the edges that turn least, so neither the order of facets nor place and attitude of a block decide.
 * Corners are not moved: blocks that share corners still do, and lie flush, for a face gets the plane fitted to its
 * corners. A vertex left with two faces is dropped. */

#include "geometry/flatten.h"

#include "geometry/make.h"
#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* A face turns clockwise at a corner by less than this times the square of the size: what rounding of six digits
 * leaves. */
#define CLOCKWISE (4 * TL_POLY_FLAT)

typedef struct flattener {
    const tl_poly *from;
    double near;      /* distances that are none, a length */
    double shallow;   /* distances that are none for the block, a length */
    tl_vec3 *area;    /* [facets] the vector area of the face */
    tl_vec3 *normal;  /* [facets] of the facet */
    tl_vec3 *vertex;  /* [vertices] that stay */
    tl_plane *plane;  /* [faces] */
    tl_tag *tag;      /* [faces] */
    uint32_t *face;   /* [facets] the face of a facet, named by one of its facets */
    uint32_t *next;   /* [facets] the next facet of the same face, in a ring */
    uint32_t *start;  /* [faces + 1] into loop */
    uint32_t *order;  /* [edges] by the turn over them */
    uint16_t *mate;   /* [2 edges] the facet beyond the edge that begins at a place in the loops */
    uint16_t *loop;   /* [2 edges] of the faces */
    uint16_t *after;  /* [vertices] the corner that follows in the face at hand */
    uint16_t *meets;  /* [vertices] faces that meet there */
    uint16_t *number; /* [vertices] among those that stay */
    uint32_t joined, vertices;
    void *memory;
} flattener;

static bool allocate(flattener *w, const tl_poly *p)
{
    /* Arrays by falling alignment out of one block. */
    size_t f = p->face_count, e = p->edge_count, v = p->vertex_count;
    w->memory = malloc(f * (2 * sizeof *w->area + sizeof *w->plane + sizeof *w->tag + 2 * sizeof *w->face) +
                       v * (sizeof *w->vertex + 3 * sizeof *w->after) + (f + 1) * sizeof *w->start +
                       e * (sizeof *w->order + 2 * sizeof *w->mate + 2 * sizeof *w->loop));
    if (!w->memory)
        return false;
    w->area = w->memory;
    w->normal = w->area + f;
    w->vertex = w->normal + f;
    w->plane = (tl_plane *)(w->vertex + v);
    w->tag = (tl_tag *)(w->plane + f);
    w->face = (uint32_t *)(void *)(w->tag + f);
    w->next = w->face + f;
    w->start = w->next + f;
    w->order = w->start + f + 1;
    w->mate = (uint16_t *)(w->order + e);
    w->loop = w->mate + 2 * e;
    w->after = w->loop + 2 * e;
    w->meets = w->after + v;
    w->number = w->meets + v;
    return true;
}

/* ---- facets to faces ---- */

static tl_vec3 vector_area(const tl_poly *p, uint32_t face)
{
    return tl_v3_scale(0.5, tl_poly_fan_area(p->vertex, p->loop + p->start[face], tl_poly_face_size(p, face)));
}

typedef struct turned {
    double sine2;
    uint32_t edge;
} turned;

static int by_turn(const void *left, const void *right)
{
    const turned *a = left, *b = right;
    if (a->sine2 != b->sine2)
        return a->sine2 < b->sine2 ? -1 : 1;
    return (a->edge > b->edge) - (a->edge < b->edge);
}

/* Lists the edges between facets of one tag that face one way, by the turn over them; returns how many. false: out of
 * memory. */
static bool order_edges(flattener *w, uint32_t *count)
{
    const tl_poly *p = w->from;
    turned *list = malloc(p->edge_count * sizeof *list);
    if (!list)
        return false;
    *count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_edge edge = p->edge[e];
        tl_tag a = p->tag[edge.left], b = p->tag[edge.right];
        if (a.joint == b.joint && a.plane == b.plane)
            list[(*count)++] = (turned){tl_v3_norm2(tl_v3_cross(w->normal[edge.left], w->normal[edge.right])), e};
    }
    qsort(list, *count, sizeof *list, by_turn);
    for (uint32_t i = 0; i < *count; i++)
        w->order[i] = list[i].edge;
    free(list);
    return true;
}

/* What corners span along a direction, and how far the farthest is from a point, squared. */
typedef struct span {
    double low, high;
    tl_vec3 from;
    double far2;
} span;

static span span_from(tl_vec3 from)
{
    return (span){INFINITY, -INFINITY, from, 0};
}

static void add_corners(const tl_poly *p, uint32_t facet, tl_vec3 along, span *s)
{
    for (uint32_t i = p->start[facet]; i < p->start[facet + 1]; i++) {
        tl_vec3 x = p->vertex[p->loop[i]];
        double height = tl_v3_dot(along, x);
        s->low = fmin(s->low, height);
        s->high = fmax(s->high, height);
        s->far2 = fmax(s->far2, tl_v3_norm2(tl_v3_sub(x, s->from)));
    }
}

static void add_face(const flattener *w, uint32_t face, tl_vec3 along, span *s)
{
    uint32_t f = face;
    do {
        add_corners(w->from, f, along, s);
        f = w->next[f];
    } while (f != face);
}

/* Adds the corners of a face; returns their number. */
static uint32_t sum_corners(const flattener *w, uint32_t face, tl_vec3 *sum)
{
    const tl_poly *p = w->from;
    uint32_t f = face, count = 0;
    do {
        for (uint32_t i = p->start[f]; i < p->start[f + 1]; i++, count++)
            *sum = tl_v3_add(*sum, p->vertex[p->loop[i]]);
        f = w->next[f];
    } while (f != face);
    return count;
}

/* Whether two faces are one. */
static bool are_one(const flattener *w, uint32_t a, uint32_t b)
{
    tl_vec3 sum = tl_v3_add(w->area[a], w->area[b]), n = tl_v3_unit(sum);
    if (tl_v3_dot(w->area[a], w->area[b]) <= 0)
        return false;
    tl_vec3 middle = {0, 0, 0};
    uint32_t corners = sum_corners(w, a, &middle) + sum_corners(w, b, &middle);
    span s = span_from(tl_v3_scale(1.0 / corners, middle));
    add_face(w, a, n, &s);
    add_face(w, b, n, &s);
    double off = 0.5 * (s.high - s.low), size = 2 * sqrt(s.far2);
    if (off <= w->near)
        return true;
    double tilted = tl_v3_norm2(tl_v3_cross(n, w->area[a])); /* that of b is as large */
    return off <= fmin(0.5 * TL_POLY_BENT * size, w->shallow) &&
           tilted <= TL_POLY_TILT * TL_POLY_TILT * tl_v3_norm2(sum);
}

static void join(flattener *w, uint32_t to, uint32_t from)
{
    uint32_t f = from;
    do {
        w->face[f] = to;
        f = w->next[f];
    } while (f != from);
    uint32_t swap = w->next[to];
    w->next[to] = w->next[from];
    w->next[from] = swap;
    w->area[to] = tl_v3_add(w->area[to], w->area[from]);
    w->joined++;
}

/* Makes one face of those at an edge, if they are one. */
static bool try_edge(flattener *w, tl_edge edge)
{
    uint32_t a = w->face[edge.left], b = w->face[edge.right];
    if (a == b || !are_one(w, a, b))
        return false;
    join(w, a < b ? a : b, a < b ? b : a);
    return true;
}

static bool find_faces(flattener *w)
{
    const tl_poly *p = w->from;
    for (uint32_t f = 0; f < p->face_count; f++) {
        w->face[f] = w->next[f] = f;
        w->area[f] = vector_area(p, f);
        w->normal[f] = tl_v3_unit(w->area[f]);
    }
    uint32_t count;
    if (!order_edges(w, &count))
        return false;
    /* a face that has grown may take in what it did not before */
    for (bool grows = true; grows;) {
        grows = false;
        for (uint32_t i = 0; i < count; i++)
            grows = try_edge(w, p->edge[w->order[i]]) || grows;
    }
    return true;
}

/* ---- the loops of faces ---- */

/* Counts the faces at every vertex and numbers the vertices where three or more meet. */
static void choose_vertices(flattener *w)
{
    const tl_poly *p = w->from;
    memset(w->meets, 0, p->vertex_count * sizeof *w->meets);
    /* as many borders end at a vertex as faces meet there */
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (w->face[p->edge[e].left] != w->face[p->edge[e].right]) {
            w->meets[p->edge[e].a]++;
            w->meets[p->edge[e].b]++;
        }
    w->vertices = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (w->meets[v] >= 3) {
            w->vertex[w->vertices] = p->vertex[v];
            w->number[v] = (uint16_t)w->vertices++;
        }
}

static void find_mates(flattener *w)
{
    const tl_poly *p = w->from;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_edge edge = p->edge[e];
        for (uint32_t h = p->start[edge.left]; h < p->start[edge.left + 1u]; h++)
            if (p->loop[h] == edge.a && p->loop[tl_poly_after(p, edge.left, h)] == edge.b)
                w->mate[h] = edge.right;
        for (uint32_t h = p->start[edge.right]; h < p->start[edge.right + 1u]; h++)
            if (p->loop[h] == edge.b && p->loop[tl_poly_after(p, edge.right, h)] == edge.a)
                w->mate[h] = edge.left;
    }
}

/* Notes which vertex follows which around a face, and its first one that stays. Returns the number of its borders, or 0
 * when two of them leave one vertex. */
static uint32_t chain_borders(flattener *w, uint32_t face, uint16_t *first)
{
    const tl_poly *p = w->from;
    uint32_t borders = 0, f = face;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        w->after[v] = UINT16_MAX;
    *first = UINT16_MAX;
    do {
        for (uint32_t h = p->start[f]; h < p->start[f + 1]; h++) {
            if (w->face[w->mate[h]] == face)
                continue;
            uint16_t v = p->loop[h];
            if (w->after[v] != UINT16_MAX)
                return 0;
            w->after[v] = p->loop[tl_poly_after(p, f, h)];
            *first = w->meets[v] >= 3 && v < *first ? v : *first;
            borders++;
        }
        f = w->next[f];
    } while (f != face);
    return borders;
}

/* Writes the loop of a face; returns the number of its corners, or 0 when it is not one ring of three or more. */
static uint32_t trace_face(flattener *w, uint32_t face, uint16_t *loop)
{
    uint16_t first;
    uint32_t borders = chain_borders(w, face, &first), corners = 0, passed = 0;
    if (!borders || first == UINT16_MAX)
        return 0;
    uint16_t at = first;
    do {
        if (w->meets[at] >= 3)
            loop[corners++] = w->number[at];
        at = w->after[at];
        passed++;
    } while (at != first && passed < borders);
    return at == first && passed == borders && corners >= 3 ? corners : 0;
}

/* The loops of all faces, in the order of the facets that name them. false: some face is no ring. */
static bool trace_faces(flattener *w)
{
    const tl_poly *p = w->from;
    uint32_t faces = 0, length = 0;
    choose_vertices(w);
    find_mates(w);
    for (uint32_t f = 0; f < p->face_count; f++) {
        if (w->face[f] != f)
            continue;
        uint32_t corners = trace_face(w, f, w->loop + length);
        if (!corners)
            return false;
        w->start[faces] = length;
        w->tag[faces] = p->tag[f];
        w->plane[faces++] = p->plane[f];
        length += corners;
    }
    w->start[faces] = length;
    return true;
}

/* ---- planes ---- */

/* How far the farthest corner misses the plane of a face. */
static double missed_by(const tl_poly *p, uint32_t face)
{
    double most = 0;
    for (uint32_t i = p->start[face]; i < p->start[face + 1]; i++)
        most = fmax(most, fabs(tl_v3_dot(p->plane[face].normal, p->vertex[p->loop[i]]) - p->plane[face].offset));
    return most;
}

/* Whether a facet has the direction of its face; those that tilt more are slivers, or the first faces of a rounded
 * edge. */
static bool goes_along(const flattener *w, uint32_t facet, tl_vec3 n)
{
    return tl_v3_norm2(tl_v3_cross(n, w->normal[facet])) <= 4 * TL_POLY_TILT * TL_POLY_TILT;
}

/* The plane of a face of several facets: of those that have its direction. */
static tl_plane plane_of(const flattener *w, uint32_t face)
{
    tl_vec3 n = tl_v3_unit(w->area[face]), sum = {0, 0, 0};
    uint32_t f = face;
    do {
        if (goes_along(w, f, n))
            sum = tl_v3_add(sum, vector_area(w->from, f));
        f = w->next[f];
    } while (f != face);
    bool none = tl_v3_norm2(sum) == 0;
    tl_plane plane = {.normal = tl_poly_normal(none ? w->area[face] : sum)};
    span s = span_from(sum);
    do {
        if (none || goes_along(w, f, n))
            add_corners(w->from, f, plane.normal, &s);
        f = w->next[f];
    } while (f != face);
    plane.offset = tl_poly_midway(s.low, s.high);
    return plane;
}

/* Fits the planes of faces of several facets, and of those whose corners miss what was given. */
static void fit_planes(const flattener *w, tl_poly *to)
{
    uint32_t face = 0;
    for (uint32_t f = 0; f < w->from->face_count; f++) {
        if (w->face[f] != f)
            continue;
        if (w->next[f] != f || missed_by(to, face) > w->near)
            to->plane[face] = plane_of(w, f);
        face++;
    }
}

/* ---- all of it ---- */

static bool faces_are_convex(const tl_poly *p)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        for (uint32_t i = p->start[f]; i < p->start[f + 1]; i++) {
            uint32_t j = tl_poly_after(p, f, i), k = tl_poly_after(p, f, j);
            tl_vec3 b = p->vertex[p->loop[j]];
            tl_vec3 turn = tl_v3_cross(tl_v3_sub(b, p->vertex[p->loop[i]]), tl_v3_sub(p->vertex[p->loop[k]], b));
            if (tl_v3_dot(p->plane[f].normal, turn) < -CLOCKWISE * p->size * p->size)
                return false;
        }
    return true;
}

/* Whether what came out is a block. Its volume is that of what went in, but for a layer as thick as its faces were
 * bent. */
static bool is_sound(const tl_poly *from, const tl_poly *to)
{
    if (tl_poly_check(to, TL_POLY_BENT, NULL) != TL_OK || !faces_are_convex(to))
        return false;
    double surface = 0;
    for (uint32_t f = 0; f < to->face_count; f++)
        surface += tl_poly_face_area(to, f);
    return fabs(tl_poly_mass(to).volume - tl_poly_mass(from).volume) <= surface * TL_POLY_BENT * from->size;
}

/* The faces as a block in *to; NULL where they make none. */
static tl_status make_block(flattener *w, tl_poly **to, tl_error *error)
{
    size_t faces = w->from->face_count - w->joined;
    if (!trace_faces(w))
        return TL_OK;
    tl_status status = tl_poly_make(w->vertex, w->vertices, w->plane, w->tag, w->start, w->loop, faces, to, NULL);
    if (status != TL_OK)
        return status == TL_E_MEMORY ? tl_fail_memory(error) : TL_OK;
    fit_planes(w, *to);
    if (!is_sound(w->from, *to)) {
        tl_poly_free(*to);
        *to = NULL;
    }
    return TL_OK;
}

static bool is_bent(const tl_poly *p, double near)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        if (missed_by(p, f) > near)
            return true;
    return false;
}

tl_status tl_poly_flatten(tl_poly **poly, tl_error *error)
{
    tl_bounds bounds = tl_poly_bounds(*poly);
    double reach = fmax(tl_v3_norm(bounds.min), tl_v3_norm(bounds.max));
    double shallow = TL_POLY_SHALLOW * tl_poly_thickness(*poly);
    flattener w = {.from = *poly,
                   .near = fmax(fmin(TL_POLY_FLAT * (*poly)->size, shallow), TL_POLY_ROUNDINGS * reach),
                   .shallow = shallow};
    if (!allocate(&w, *poly) || !find_faces(&w)) {
        free(w.memory);
        return tl_fail_memory(error);
    }
    tl_poly *to = NULL;
    tl_status status = TL_OK;
    if (w.joined || is_bent(*poly, w.near))
        status = make_block(&w, &to, error);
    free(w.memory);
    if (to) {
        tl_poly_free(*poly);
        *poly = to;
    }
    return status;
}
