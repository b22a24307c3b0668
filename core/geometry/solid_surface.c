/* solid_surface.c - from the polygons of a closed surface to half-edges.
 *
 * Each edge has two half-edges, one in each direction. Faces of one tag that lie in one plane and meet at an edge
 * become one face, grown from the largest on: a flat side of a mesh is one face, whatever its triangles. Edges inside
 * it go, and so do vertices on straight edges. Planes that are one plane, however far apart their faces lie, get one
 * number: a cut by it is then known to lie along all of them. */
#include "geometry/solid_surface.h"

#include "base/error.h"
#include "geometry/make.h"
#include "geometry/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Tolerance: a solid of less volume than this times the cube of its size holds none. */
#define EMPTY 1e-13
/* Tolerance: sine of the least angle at which a surface bends. */
#define BEND 1e-9
/* Tolerance: planes that are one have keys nearer to each other than this: their normals are known to 1e-8. */
#define KEYS_NEAR 1e-7

typedef struct reader {
    const tl_solid_surface *given;
    tl_solid_mesh *m;
    tl_error *error;
    uint32_t *mate;   /* [corners] */
    uint32_t *of;     /* [corners] the face */
    tl_vec3 *area;    /* [faces] twice the vector area */
    uint32_t *order;  /* [faces] by falling area */
    uint32_t *region; /* [faces] face of the mesh */
    uint32_t *queue;  /* [faces] */
    uint32_t *half;   /* [corners] half-edge of the mesh, or none */
    uint32_t *meets;  /* [vertices] half-edges that begin there */
} reader;

static void reader_free(reader *r)
{
    free(r->mate);
    free(r->of);
    free(r->area);
    free(r->order);
    free(r->region);
    free(r->queue);
    free(r->half);
    free(r->meets);
}

static tl_status reader_begin(reader *r)
{
    const size_t faces = r->given->face_count + 1, corners = r->given->start[r->given->face_count] + (size_t)1;
    r->mate = malloc(corners * sizeof *r->mate);
    r->of = malloc(corners * sizeof *r->of);
    r->area = malloc(faces * sizeof *r->area);
    r->order = malloc(faces * sizeof *r->order);
    r->region = malloc(faces * sizeof *r->region);
    r->queue = malloc(faces * sizeof *r->queue);
    r->half = malloc(corners * sizeof *r->half);
    r->meets = calloc(r->given->vertex_count + 1, sizeof *r->meets);
    if (!r->mate || !r->of || !r->area || !r->order || !r->region || !r->queue || !r->half || !r->meets)
        return tl_fail_memory(r->error);
    return TL_OK;
}

static uint32_t corner_after(const tl_solid_surface *g, uint32_t face, uint32_t c)
{
    return c + 1 < g->start[face + 1] ? c + 1 : g->start[face];
}

/* ---------------------------------------------------------------- closed ----------------- */

typedef struct side {
    uint32_t low, high; /* vertices */
    uint32_t corner;
} side;

static int by_edge(const void *left, const void *right)
{
    const side *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (a->corner > b->corner) - (a->corner < b->corner);
}

static tl_status edge_fault(const reader *r, const side *s, const char *what, const char *remedy)
{
    const uint32_t from = r->given->loops[s->corner], to = s->low == from ? s->high : s->low;
    const tl_vec3 a = tl_v3_add(r->given->place, r->given->vertices[from]);
    const tl_vec3 b = tl_v3_add(r->given->place, r->given->vertices[to]);
    return tl_fail(r->error, TL_E_GEOMETRY,
                   "the surface %s at the edge from {%g, %g, %g} to {%g, %g, %g} of face %u; %s", what, a.x, a.y, a.z,
                   b.x, b.y, b.z, r->of[s->corner] + 1, remedy);
}

static tl_status pair_sides(const reader *r, side *sides, uint32_t count)
{
    const uint32_t *loops = r->given->loops;
    qsort(sides, count, sizeof *sides, by_edge);
    for (uint32_t i = 0, end = 0; i < count; i = end) {
        const side *s = &sides[i];
        while (end < count && sides[end].low == s->low && sides[end].high == s->high)
            end++;
        if (s->low == s->high)
            return edge_fault(r, s, "has two corners that are one", "leave one of them out");
        if (end - i == 1)
            return edge_fault(r, s, "is open", "close it, so that every edge belongs to two faces");
        if (end - i > 2)
            return edge_fault(
                r, s, "has more than two faces",
                "a solid must not touch itself along an edge: make a solid of each of the parts that meet there");
        if (loops[s->corner] == loops[s[1].corner])
            return edge_fault(r, s, "has two faces of which one is turned over",
                              "give the corners of all faces counter-clockwise as seen from outside");
        r->mate[s->corner] = s[1].corner;
        r->mate[s[1].corner] = s->corner;
    }
    return TL_OK;
}

static tl_status pair_edges(const reader *r)
{
    const tl_solid_surface *g = r->given;
    const uint32_t corners = g->start[g->face_count];
    side *sides = malloc(((size_t)corners + 1) * sizeof *sides);
    if (!sides)
        return tl_fail_memory(r->error);
    for (uint32_t f = 0; f < g->face_count; f++)
        for (uint32_t c = g->start[f]; c < g->start[f + 1]; c++) {
            const uint32_t a = g->loops[c], b = g->loops[corner_after(g, f, c)];
            sides[c] = (side){a < b ? a : b, a < b ? b : a, c};
            r->of[c] = f;
        }
    const tl_status status = pair_sides(r, sides, corners);
    free(sides);
    return status;
}

/* ---------------------------------------------------------------- measures --------------- */

static tl_vec3 face_area(const tl_solid_surface *g, uint32_t f)
{
    const tl_vec3 base = g->vertices[g->loops[g->start[f]]];
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t c = g->start[f] + 1; c + 1 < g->start[f + 1]; c++)
        sum = tl_v3_add(
            sum, tl_v3_cross(tl_v3_sub(g->vertices[g->loops[c]], base), tl_v3_sub(g->vertices[g->loops[c + 1]], base)));
    return sum;
}

/* Volume and centroid, by tetrahedra about the middle of the bounds. */
static void measure(const reader *r, const tl_bounds *bounds)
{
    const tl_solid_surface *g = r->given;
    const tl_vec3 middle = tl_v3_scale(0.5, tl_v3_add(bounds->min, bounds->max));
    double six = 0;
    tl_vec3 moment = {0, 0, 0};
    for (uint32_t f = 0; f < g->face_count; f++) {
        r->area[f] = face_area(g, f);
        const tl_vec3 a = tl_v3_sub(g->vertices[g->loops[g->start[f]]], middle);
        for (uint32_t c = g->start[f] + 1; c + 1 < g->start[f + 1]; c++) {
            const tl_vec3 b = tl_v3_sub(g->vertices[g->loops[c]], middle);
            const tl_vec3 d = tl_v3_sub(g->vertices[g->loops[c + 1]], middle);
            const double part = tl_v3_dot(a, tl_v3_cross(b, d));
            six += part;
            moment = tl_v3_madd(moment, part / 4, tl_v3_add(a, tl_v3_add(b, d)));
        }
    }
    r->m->volume = six / 6;
    r->m->center = six > 0 ? tl_v3_madd(middle, 1 / six, moment) : middle;
}

static tl_status measure_all(const reader *r)
{
    const tl_solid_surface *g = r->given;
    tl_solid_mesh *m = r->m;
    const tl_bounds bounds = tl_points_bounds(g->vertices, g->vertex_count);
    const tl_vec3 far = tl_v3_max(bounds.max, tl_v3_neg(bounds.min));
    m->size = tl_v3_norm(tl_v3_sub(bounds.max, bounds.min));
    const double reach = fmax(far.x, fmax(far.y, far.z));
    m->on = fmax(g->flat, fmax(TL_POLY_ON / fmax(g->finer, 1) * m->size, TL_POLY_ROUNDINGS * reach));
    measure(r, &bounds);
    const double least = EMPTY * m->size * m->size * m->size;
    if (m->volume < -least)
        return tl_fail(
            r->error, TL_E_GEOMETRY,
            "the surface is turned inside out: its volume is %g m3; give every face counter-clockwise as seen "
            "from outside",
            m->volume);
    if (!(m->volume > least))
        return tl_fail(r->error, TL_E_GEOMETRY, "the surface holds no volume: %g m3 in a box with a diagonal of %g m",
                       m->volume, m->size);
    return TL_OK;
}

/* ---------------------------------------------------------------- regions ---------------- */

static tl_tag tag_of(const reader *r, uint32_t face)
{
    return r->given->tags ? r->given->tags[face] : (tl_tag){0, 0};
}

/* Whether a face lies in a plane, and does not look the other way; a face that is a line looks any way. */
static bool lies_in(const reader *r, uint32_t face, tl_plane plane)
{
    const tl_solid_surface *g = r->given;
    for (uint32_t c = g->start[face]; c < g->start[face + 1]; c++)
        if (fabs(tl_v3_dot(plane.normal, g->vertices[g->loops[c]]) - plane.offset) > r->m->on)
            return false;
    return tl_v3_dot(r->area[face], plane.normal) > -r->m->on * r->m->size;
}

/* Makes one face of all that hang together with the first one of the queue and lie in its plane. Gives the plane that
 * fits them. */
static tl_plane grow_region(const reader *r, uint32_t number)
{
    const tl_solid_surface *g = r->given;
    const uint32_t seed = r->queue[0];
    const tl_tag tag = tag_of(r, seed);
    const tl_vec3 normal = tl_poly_normal(r->area[seed]);
    const tl_plane plane = {normal, tl_v3_dot(normal, g->vertices[g->loops[g->start[seed]]])};
    tl_vec3 area = {0, 0, 0};
    uint32_t count = 1;
    r->region[seed] = number;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t f = r->queue[i];
        area = tl_v3_add(area, r->area[f]);
        for (uint32_t c = g->start[f]; c < g->start[f + 1]; c++) {
            const uint32_t next = r->of[r->mate[c]];
            const tl_tag other = tag_of(r, next);
            if (r->region[next] != TL_SOLID_NONE || other.joint != tag.joint || other.plane != tag.plane ||
                !lies_in(r, next, plane))
                continue;
            r->region[next] = number;
            r->queue[count++] = next;
        }
    }
    const tl_vec3 fitted = tl_poly_normal(area);
    double sum = 0;
    size_t corners = 0;
    const tl_vec3 base = g->vertices[g->loops[g->start[seed]]];
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t c = g->start[r->queue[i]]; c < g->start[r->queue[i] + 1]; c++, corners++)
            sum += tl_v3_dot(fitted, tl_v3_sub(g->vertices[g->loops[c]], base));
    return (tl_plane){fitted, tl_v3_dot(fitted, base) + sum / (double)corners};
}

typedef struct ranked {
    double area;
    uint32_t face;
} ranked;

static int by_falling_area(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    if (a->area > b->area || a->area < b->area)
        return a->area > b->area ? -1 : 1;
    return (a->face > b->face) - (a->face < b->face);
}

static tl_status check_plane(const reader *r, uint32_t f)
{
    const tl_solid_surface *g = r->given;
    const tl_vec3 normal = tl_poly_normal(r->area[f]);
    const tl_vec3 base = g->vertices[g->loops[g->start[f]]];
    double most = 0;
    for (uint32_t c = g->start[f]; c < g->start[f + 1]; c++)
        most = fmax(most, fabs(tl_v3_dot(normal, tl_v3_sub(g->vertices[g->loops[c]], base))));
    if (most <= 2 * r->m->on)
        return TL_OK;
    const tl_vec3 at = tl_v3_add(g->place, base);
    return tl_fail(r->error, TL_E_GEOMETRY,
                   "face %u at {%g, %g, %g} is bent: a corner lies %g m off its plane, and %g m are flat", f + 1, at.x,
                   at.y, at.z, most, r->m->on);
}

static tl_status find_regions(const reader *r)
{
    const tl_solid_surface *g = r->given;
    ranked *list = malloc((g->face_count + 1) * sizeof *list);
    if (!list)
        return tl_fail_memory(r->error);
    for (uint32_t f = 0; f < g->face_count; f++) {
        list[f] = (ranked){tl_v3_dot(r->area[f], r->area[f]), f};
        r->region[f] = TL_SOLID_NONE;
    }
    qsort(list, g->face_count, sizeof *list, by_falling_area);
    for (uint32_t i = 0; i < g->face_count; i++)
        r->order[i] = list[i].face;
    free(list);
    for (uint32_t i = 0; i < g->face_count; i++) {
        const uint32_t f = r->order[i];
        uint32_t plane, face;
        const tl_status status = check_plane(r, f);
        if (status != TL_OK)
            return status;
        if (r->region[f] != TL_SOLID_NONE)
            continue;
        r->queue[0] = f;
        if (!tl_solid_add_plane(r->m, grow_region(r, r->m->faces), &plane) ||
            !tl_solid_add_face(
                r->m,
                (tl_solid_face){.first = TL_SOLID_NONE, .plane = plane, .tag = tag_of(r, f), .shell = TL_SOLID_NONE},
                &face))
            return tl_fail_memory(r->error);
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- half-edges ------------- */

static bool is_kept(const reader *r, uint32_t corner)
{
    return r->region[r->of[corner]] != r->region[r->of[r->mate[corner]]];
}

/* The next edge of the outline of a region after the one that begins at a corner. */
static uint32_t outline_after(const reader *r, uint32_t corner)
{
    uint32_t c = corner_after(r->given, r->of[corner], corner);
    while (!is_kept(r, c))
        c = corner_after(r->given, r->of[r->mate[c]], r->mate[c]);
    return c;
}

static tl_status add_halves(const reader *r)
{
    const tl_solid_surface *g = r->given;
    const uint32_t corners = g->start[g->face_count];
    tl_solid_mesh *m = r->m;
    uint32_t vertex;
    for (size_t v = 0; v < g->vertex_count; v++)
        if (!tl_solid_add_vertex(m, g->vertices[v], &vertex))
            return tl_fail_memory(r->error);
    for (uint32_t c = 0; c < corners; c++) {
        r->half[c] = TL_SOLID_NONE;
        if (!is_kept(r, c))
            continue;
        if (!tl_solid_add_half(m,
                               (tl_half_edge){.from = g->loops[c], .face = r->region[r->of[c]], .ring = TL_SOLID_NONE},
                               &r->half[c]))
            return tl_fail_memory(r->error);
        r->meets[g->loops[c]]++;
    }
    for (uint32_t c = 0; c < corners; c++) {
        if (r->half[c] == TL_SOLID_NONE)
            continue;
        tl_half_edge *edge = &m->half[r->half[c]];
        edge->mate = r->half[r->mate[c]];
        edge->next = r->half[outline_after(r, c)];
        m->half[edge->next].prev = r->half[c];
    }
    return TL_OK;
}

/* Makes one edge of two that meet in a straight line at a vertex without others. */
static void drop_straight(const reader *r)
{
    tl_solid_mesh *m = r->m;
    for (uint32_t h = 0; h < m->halves; h++) {
        tl_half_edge *out = &m->half[h];
        const uint32_t in = out->prev;
        if (out->face == TL_SOLID_NONE || r->meets[out->from] != 2 || m->half[in].from == tl_half_to(m, h))
            continue;
        const uint32_t far = out->mate, near = m->half[in].mate; /* w -> v and v -> u */
        if (m->half[far].next != near || m->half[near].face == TL_SOLID_NONE || m->half[in].prev == h ||
            m->half[near].next == far)
            continue;
        const tl_vec3 u = m->vertex[m->half[in].from], w = m->vertex[tl_half_to(m, h)];
        const tl_vec3 along = tl_v3_unit(tl_v3_sub(w, u)), arm = tl_v3_sub(m->vertex[out->from], u);
        if (tl_v3_norm(tl_v3_madd(arm, -tl_v3_dot(arm, along), along)) > m->on)
            continue;
        m->half[in].next = out->next;
        m->half[out->next].prev = in;
        m->half[far].next = m->half[near].next;
        m->half[m->half[near].next].prev = far;
        m->half[in].mate = far;
        m->half[far].mate = in;
        out->face = m->half[near].face = TL_SOLID_NONE;
    }
}

/* Lists the loops of each face, the one around it first: that of the largest area about the normal. */
static bool list_loops(tl_solid_mesh *m)
{
    const uint32_t stamp = tl_solid_stamp(m);
    double *most = calloc((size_t)m->faces + 1, sizeof *most);
    if (!most)
        return false;
    for (uint32_t h = 0; h < m->halves; h++) {
        if (m->half[h].face == TL_SOLID_NONE || m->half_mark[h] == stamp)
            continue;
        tl_solid_face *f = &m->face[m->half[h].face];
        for (uint32_t k = h; m->half_mark[k] != stamp; k = m->half[k].next)
            m->half_mark[k] = stamp;
        const double area = tl_v3_dot(tl_solid_loop_area(m, h), m->plane[f->plane].normal);
        if (f->first == TL_SOLID_NONE || area > most[m->half[h].face]) {
            m->half[h].ring = f->first;
            f->first = h;
            most[m->half[h].face] = area;
        } else {
            m->half[h].ring = m->half[f->first].ring;
            m->half[f->first].ring = h;
        }
    }
    free(most);
    return true;
}

/* ---------------------------------------------------------------- reflex edges ----------- */

/* Sets what the half-edges know of how the surface bends, and lists the reflex edges. */
static bool find_reflex(tl_solid_mesh *m)
{
    for (uint32_t h = 0; h < m->halves; h++) {
        tl_half_edge *a = &m->half[h];
        if (a->face == TL_SOLID_NONE || h > a->mate)
            continue;
        tl_half_edge *b = &m->half[a->mate];
        const tl_vec3 along = tl_v3_unit(tl_v3_sub(m->vertex[b->from], m->vertex[a->from]));
        const tl_vec3 n = tl_solid_normal(m, a->face), other = tl_solid_normal(m, b->face);
        const double sine = tl_v3_dot(tl_v3_cross(n, along), other);
        const double reach = 2 * fmin(m->face[a->face].radius, m->face[b->face].radius);
        const bool bends = fabs(sine) > BEND && fabs(sine) * reach > m->on;
        a->flat = b->flat = !bends && tl_v3_dot(n, other) > 0;
        a->reflex = b->reflex = sine > 0 && !a->flat;
        if (a->reflex && !tl_piece_add_reflex(&m->piece[0], h))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------- planes ----------------- */

typedef struct keyed {
    double key;
    uint32_t plane;
    double radius; /* of what lies on it */
    tl_vec3 center;
} keyed;

static int by_key(const void *left, const void *right)
{
    const keyed *a = left, *b = right;
    if (a->key > b->key || a->key < b->key)
        return a->key < b->key ? -1 : 1;
    return (a->plane > b->plane) - (a->plane < b->plane);
}

/* A number that a plane has whichever way its normal looks. */
static double plane_key(const tl_solid_mesh *m, tl_plane p)
{
    const tl_vec3 n = p.normal;
    const double off = (p.offset - tl_v3_dot(n, m->center)) / m->size;
    const double a = 0.5377 * n.x + 0.3191 * n.y - 0.7803 * n.z, b = 0.2113 * n.x - 0.8719 * n.y + 0.4417 * n.z;
    return a * a + 0.7071 * b * b + a * off + 0.4331 * b * off + off * off;
}

/* Whether what lies on plane a lies on plane b, too. */
static bool is_on(const tl_solid_mesh *m, const keyed *a, const tl_plane *pa, const tl_plane *b)
{
    return tl_v3_norm(tl_v3_cross(pa->normal, b->normal)) * a->radius <= m->on &&
           fabs(tl_v3_dot(b->normal, a->center) - b->offset) <= m->on;
}

/* number[plane] becomes the first plane in the order of keys that is the same. */
static void unite_planes(const tl_solid_mesh *m, keyed *list, uint32_t count, uint32_t *number)
{
    qsort(list, count, sizeof *list, by_key);
    for (uint32_t i = 0; i < count; i++) {
        number[list[i].plane] = list[i].plane;
        for (uint32_t j = i; j-- > 0 && list[i].key - list[j].key <= KEYS_NEAR;) {
            const uint32_t other = list[j].plane;
            if (number[other] != other || !is_on(m, &list[i], &m->plane[list[i].plane], &m->plane[other]) ||
                !is_on(m, &list[j], &m->plane[other], &m->plane[list[i].plane]))
                continue;
            number[list[i].plane] = other;
            break;
        }
    }
}

/* Adds the plane midway between the faces of each reflex edge. */
static bool add_bisectors(tl_solid_mesh *m)
{
    const tl_solid_piece *p = &m->piece[0];
    for (uint32_t i = 0; i < p->reflexes; i++) {
        const uint32_t h = p->reflex[i], mate = m->half[h].mate;
        const tl_vec3 a = m->vertex[m->half[h].from], b = m->vertex[tl_half_to(m, h)];
        const tl_vec3 along = tl_v3_unit(tl_v3_sub(b, a));
        tl_vec3 n = tl_v3_unit(tl_v3_sub(tl_solid_normal(m, m->half[h].face), tl_solid_normal(m, m->half[mate].face)));
        n = tl_v3_unit(tl_v3_madd(n, -tl_v3_dot(n, along), along));
        const double offset = tl_v3_dot(n, tl_v3_scale(0.5, tl_v3_add(a, b)));
        if (!tl_solid_add_plane(m, (tl_plane){n, offset}, &m->bisector[h]))
            return false;
        m->bisector[mate] = m->bisector[h];
    }
    return true;
}

/* Gives planes that are one the same number: those of faces at reflex edges, and the planes midway. */
static bool number_planes(tl_solid_mesh *m)
{
    const tl_solid_piece *p = &m->piece[0];
    const uint32_t faces = m->faces;
    keyed *list = malloc(((size_t)m->planes + 1) * sizeof *list);
    uint32_t *number = malloc(((size_t)m->planes + 1) * sizeof *number);
    if (list && number && p->reflexes > 0) {
        uint32_t count = 0;
        for (uint32_t f = 0; f < faces; f++, count++)
            list[count] = (keyed){plane_key(m, m->plane[f]), f, m->face[f].radius, m->face[f].center};
        for (uint32_t i = 0; i < p->reflexes; i++, count++) {
            const uint32_t h = p->reflex[i], plane = m->bisector[h];
            const tl_vec3 a = m->vertex[m->half[h].from], b = m->vertex[tl_half_to(m, h)];
            list[count] = (keyed){plane_key(m, m->plane[plane]), plane, 0.5 * tl_v3_norm(tl_v3_sub(b, a)),
                                  tl_v3_scale(0.5, tl_v3_add(a, b))};
        }
        unite_planes(m, list, count, number);
        for (uint32_t f = 0; f < faces; f++) {
            const tl_vec3 own = m->plane[f].normal;
            m->face[f].plane = number[f];
            m->face[f].turned = tl_v3_dot(own, m->plane[number[f]].normal) < 0;
        }
        for (uint32_t h = 0; h < m->halves; h++)
            if (m->bisector[h] != TL_SOLID_NONE)
                m->bisector[h] = number[m->bisector[h]];
    }
    const bool done = list && number;
    free(list);
    free(number);
    return done;
}

/* ---------------------------------------------------------------- shells ----------------- */

/* Numbers the faces that hang together over edges. */
static bool flood_shell(tl_solid_mesh *m, uint32_t seed, uint32_t *queue, uint32_t *count)
{
    if (!tl_solid_grow(&m->shell, &m->shell_capacity, m->shells, sizeof *m->shell))
        return false;
    m->shell[m->shells] = (tl_solid_shell){seed, false};
    queue[0] = seed;
    m->face[seed].shell = m->shells;
    *count = 1;
    for (uint32_t i = 0; i < *count; i++)
        for (uint32_t first = m->face[queue[i]].first; first != TL_SOLID_NONE; first = m->half[first].ring) {
            uint32_t h = first;
            do {
                const uint32_t next = m->half[m->half[h].mate].face;
                if (m->face[next].shell == TL_SOLID_NONE) {
                    m->face[next].shell = m->shells;
                    queue[(*count)++] = next;
                }
                h = m->half[h].next;
            } while (h != first);
        }
    m->shells++;
    return true;
}

static double volume_of(const tl_solid_mesh *m, const uint32_t *face, uint32_t count)
{
    double six = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t first = m->face[face[i]].first; first != TL_SOLID_NONE; first = m->half[first].ring) {
            const tl_vec3 a = tl_v3_sub(m->vertex[m->half[first].from], m->center);
            six += tl_v3_dot(a, tl_solid_loop_area(m, first));
        }
    return six / 6;
}

/* Lists the shells: one goes around the solid, the others around cavities. */
static tl_status find_shells(tl_solid_mesh *m, tl_error *error)
{
    uint32_t *queue = malloc(((size_t)m->faces + 1) * sizeof *queue), outer = TL_SOLID_NONE;
    bool enough = queue != NULL;
    tl_status status = TL_OK;
    for (uint32_t f = 0, count; enough && f < m->faces && status == TL_OK; f++) {
        if (m->face[f].shell != TL_SOLID_NONE)
            continue;
        enough = flood_shell(m, f, queue, &count);
        if (!enough)
            break;
        tl_solid_shell *shell = &m->shell[m->shells - 1];
        shell->apart = volume_of(m, queue, count) < 0;
        const tl_vec3 at = tl_solid_shown(m, m->half[m->face[f].first].from);
        if (!shell->apart && outer != TL_SOLID_NONE)
            status =
                tl_fail(error, TL_E_GEOMETRY,
                        "the surface is of several solids: one with face %u, another at {%g, %g, %g}; give each by "
                        "itself",
                        outer + 1, at.x, at.y, at.z);
        if (!shell->apart)
            outer = f;
    }
    free(queue);
    return enough ? status : tl_fail_memory(error);
}

tl_status tl_solid_check_cavities(const tl_solid_mesh *m, tl_error *error)
{
    uint32_t *others = malloc(((size_t)m->faces + 1) * sizeof *others);
    tl_status status = others ? TL_OK : tl_fail_memory(error);
    for (uint32_t i = 0; i < m->shells && status == TL_OK; i++) {
        if (!m->shell[i].apart)
            continue;
        uint32_t count = 0;
        for (uint32_t f = 0; f < m->faces; f++)
            if (m->face[f].shell != i)
                others[count++] = f;
        const tl_vec3 at = m->vertex[m->half[m->face[m->shell[i].face].first].from];
        const tl_vec3 shown = tl_v3_add(m->place, at);
        if (tl_solid_winding(m, others, count, at) != 1)
            status = tl_fail(error, TL_E_GEOMETRY,
                             "the surface has a part turned inside out that is no cavity at {%g, %g, %g}", shown.x,
                             shown.y, shown.z);
    }
    free(others);
    return status;
}

/* ---------------------------------------------------------------- all -------------------- */

static tl_status make_mesh(const reader *r)
{
    tl_solid_mesh *m = r->m;
    uint32_t piece;
    tl_status status = find_regions(r);
    if (status == TL_OK)
        status = add_halves(r);
    if (status != TL_OK)
        return status;
    drop_straight(r);
    if (!tl_solid_add_piece(m, &piece) || !list_loops(m))
        return tl_fail_memory(r->error);
    for (uint32_t f = 0; f < m->faces; f++) {
        if (m->face[f].first == TL_SOLID_NONE)
            return tl_fail(r->error, TL_E_GEOMETRY, "the surface holds no volume: it is flat");
        tl_solid_find_ball(m, f);
        if (!tl_piece_add_face(&m->piece[0], f))
            return tl_fail_memory(r->error);
    }
    status = find_shells(m, r->error);
    if (status != TL_OK)
        return status;
    return find_reflex(m) && add_bisectors(m) && number_planes(m) ? TL_OK : tl_fail_memory(r->error);
}

tl_status tl_solid_read(const tl_solid_surface *surface, tl_solid_mesh *m, tl_error *error)
{
    reader r = {.given = surface, .m = m, .error = error};
    *m = (tl_solid_mesh){.place = surface->place};
    tl_status status = reader_begin(&r);
    if (status == TL_OK)
        status = pair_edges(&r);
    if (status == TL_OK)
        status = measure_all(&r);
    if (status == TL_OK)
        status = make_mesh(&r);
    reader_free(&r);
    return status;
}
