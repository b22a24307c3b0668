/* convex_parts.c - divides a solid into convex parts by cuts along its reflex edges.
 *
 * After B. Chazelle, SIAM J. Comput. 13 (1984) 488-507: a plane through a reflex edge that ends it on both sides cuts
 * the solid there. The cut goes as far as the section hangs together with that edge. Without reflex edges a piece is
 * convex. Three planes are tried at each edge: those of its faces and the one midway. Planes that hold many reflex
 * edges are looked at first. The cut that ends most of them, less those that it divides, is made. Among equals a cut
 * that leaves no sharp wedge goes first, then the smallest, then the one nearest to the centroid of the solid. None of
 * that depends on the order of faces, on place, attitude or unit.
 *
 * A cut that would leave a thin piece is taken back, and the next one is tried. Where all three planes do at all edges,
 * more planes between those of the faces are tried. What is thin by itself gets thin parts: a solid always divides.
 * Where faces bend by about what is flat, the whole solid is divided again with another measure of flat.
 *
 * Each edge on a plane is cut for good, so their number bounds the cuts. A section takes time in proportion to the
 * faces of its piece, one product each for those that the plane passes by. */
#include "geometry/convex_parts.h"

#include "base/error.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/solid_crossing.h"
#include "geometry/solid_cut.h"
#include "geometry/solid_part.h"
#include "geometry/solid_surface.h"

#include <math.h>
#include <stdlib.h>
#include <talus/elementary.h>
#include <talus/vmath.h>

/* Cost only: planes of which the section of a piece is looked at before each cut, and the faces looked at in all. */
#define MOST_TRIED 12
#define LEAST_TRIED 2
#define FACES_TRIED 100000
/* Cost only: reflex edges at which more planes are tried in need, and the parts of the angle from the plane midway to
 * that of a face. */
#define MOST_FANS 8
#define FAN 4
/* Cost only: convex pieces of fewer faces have no more vertices than TL_POLY_MAX_VERTICES. */
#define MOST_FACES (TL_POLY_MAX_FACES / 2)
/* Limit: more parts than this times the reflex edges are refused. */
#define MOST_PARTS 64
/* Tolerance: parts fill a solid whose faces are plane when their volume is that of the surface as nearly as this. */
#define FILLED 1e-9

/* Tolerance: a cut that leaves a sharper wedge (sine) or a piece thinner than this times its size is made in need only:
 * contacts and zones of such parts are poor. */
#define THIN 1e-3

/* Tolerance: a solid of faces that bend by about what is flat may not divide. It is tried again with more that is flat,
 * and with less, by this factor each time, up to this times its size. */
#define FLATTER 8
#define FLATTEST TL_POLY_FLAT

/* A plane that holds reflex edges of the piece at hand. */
typedef struct candidate {
    uint32_t plane, edges;
    double length; /* m: of these edges */
    double far;    /* m: from the centroid of the solid */
} candidate;

typedef struct divider {
    tl_solid_mesh m;
    tl_section *s;
    candidate *list;
    uint32_t count, capacity;
    tl_solid_cuts cuts;
    uint32_t *slot; /* [planes] place in the list, valid where the list says so */
} divider;

static int by_merit(const void *left, const void *right)
{
    const candidate *a = left, *b = right;
    if (a->edges != b->edges)
        return a->edges > b->edges ? -1 : 1;
    if (a->length > b->length || a->length < b->length)
        return a->length > b->length ? -1 : 1;
    if (a->far > b->far || a->far < b->far)
        return a->far < b->far ? -1 : 1;
    return (a->plane > b->plane) - (a->plane < b->plane);
}

static bool count_edge(divider *d, uint32_t plane, double length)
{
    uint32_t at = d->slot[plane];
    if (at >= d->count || d->list[at].plane != plane) {
        if (!tl_solid_grow(&d->list, &d->capacity, d->count, sizeof *d->list))
            return false;
        const tl_plane p = d->m.plane[plane];
        at = d->slot[plane] = d->count++;
        d->list[at] = (candidate){.plane = plane, .far = fabs(tl_v3_dot(p.normal, d->m.center) - p.offset)};
    }
    d->list[at].edges++;
    d->list[at].length += length;
    return true;
}

/* Lists the planes at the reflex edges of a piece, the best first, and forgets edges that are none any more. */
static bool list_candidates(divider *d, uint32_t piece)
{
    tl_solid_mesh *m = &d->m;
    tl_solid_piece *p = &m->piece[piece];
    uint32_t kept = 0;
    d->count = 0;
    for (uint32_t i = 0; i < p->reflexes; i++) {
        const uint32_t h = p->reflex[i];
        if (!m->half[h].reflex)
            continue;
        p->reflex[kept++] = h;
        const double length = tl_v3_norm(tl_v3_sub(m->vertex[tl_half_to(m, h)], m->vertex[m->half[h].from]));
        if (!count_edge(d, m->face[m->half[h].face].plane, length) ||
            !count_edge(d, m->face[m->half[m->half[h].mate].face].plane, length) ||
            !count_edge(d, m->bisector[h], length))
            return false;
    }
    p->reflexes = kept;
    /* lengths that differ by rounding are equal */
    const double unit = ldexp(m->size, -24);
    for (uint32_t i = 0; i < d->count; i++) {
        d->list[i].length = floor(d->list[i].length / unit + 0.5);
        d->list[i].far = floor(d->list[i].far / unit + 0.5);
    }
    if (d->count > 1)
        qsort(d->list, d->count, sizeof *d->list, by_merit);
    return true;
}

/* The best cut that was not refused yet, or NULL. */
static tl_solid_cut *best_cut(const tl_solid_cuts *list)
{
    tl_solid_cut *best = NULL;
    for (uint32_t i = 0; i < list->count; i++)
        if (!list->cut[i].refused && (!best || tl_solid_cut_better(&list->cut[i], best)))
            best = &list->cut[i];
    return best;
}

/* Of the refused cuts the one that leaves the thickest sound pieces, or NULL. */
static const tl_solid_cut *thickest_cut(const tl_solid_cuts *list)
{
    const tl_solid_cut *best = NULL;
    for (uint32_t i = 0; i < list->count; i++)
        if (list->cut[i].thickness > (best ? best->thickness : 0))
            best = &list->cut[i];
    return best;
}

/* Tries the cuts at hand, the best first, until one leaves no thin piece. */
static bool try_cuts(divider *d, uint32_t piece, bool *made)
{
    tl_solid_cut *best;
    while ((best = best_cut(&d->cuts)) != NULL) {
        if (best->thickness >= THIN) {
            if (!tl_solid_cut_make(d->s, &d->m, piece, best, THIN, &best->thickness))
                return false;
            if (best->thickness >= THIN)
                return *made = true;
        }
        best->refused = true;
    }
    return true;
}

/* Lists cuts by more planes through the reflex edges of a piece: n = cos(k a) u + sin(k a) v. u is the normal of the
 * plane midway, and v lies across it and the edge. a is the angle between u and the normal of a face. */
static bool add_fans(divider *d, uint32_t piece)
{
    tl_solid_mesh *m = &d->m;
    const tl_solid_piece *p = &m->piece[piece];
    for (uint32_t i = 0; i < p->reflexes && i < MOST_FANS; i++) {
        const uint32_t h = p->reflex[i];
        const tl_plane midway = m->plane[m->bisector[h]];
        const tl_vec3 a = m->vertex[m->half[h].from], b = m->vertex[tl_half_to(m, h)];
        const tl_vec3 v = tl_v3_cross(midway.normal, tl_v3_unit(tl_v3_sub(b, a)));
        const tl_vec3 n = tl_solid_normal(m, m->half[h].face);
        const double angle = tl_atan2(fabs(tl_v3_dot(n, v)), fabs(tl_v3_dot(n, midway.normal)));
        for (int k = 1 - FAN; k < FAN; k++) {
            uint32_t plane;
            if (k == 0)
                continue;
            const double turned = angle * k / FAN;
            const tl_vec3 normal =
                tl_v3_unit(tl_v3_madd(tl_v3_scale(tl_cos(turned), midway.normal), tl_sin(turned), v));
            const double offset = tl_v3_dot(normal, tl_v3_scale(0.5, tl_v3_add(a, b)));
            if (!tl_solid_add_plane(m, (tl_plane){normal, offset}, &plane) ||
                !tl_section_cuts(d->s, m, piece, plane, &d->cuts))
                return false;
        }
    }
    return true;
}

/* Whether all of a face lies on the plane of another. */
static bool lies_on(const tl_solid_mesh *m, uint32_t face, uint32_t other)
{
    const tl_plane p = m->plane[m->face[other].plane];
    TL_EACH_HALF(m, face, h, first)
    {
        if (fabs(tl_v3_dot(p.normal, m->vertex[m->half[h].from]) - p.offset) > m->on)
            return false;
    }
    return true;
}

/* Makes edges of a piece flat whose faces have become so small that either lies on the plane of the other. */
static bool flatten_edges(divider *d, uint32_t piece)
{
    tl_solid_mesh *m = &d->m;
    const tl_solid_piece *p = &m->piece[piece];
    bool any = false;
    for (uint32_t i = 0; i < p->reflexes; i++) {
        tl_half_edge *a = &m->half[p->reflex[i]], *b = &m->half[a->mate];
        if (!lies_on(m, a->face, b->face) || !lies_on(m, b->face, a->face))
            continue;
        a->reflex = b->reflex = false;
        a->flat = b->flat = any = true;
    }
    return any;
}

/* Makes the best cut of a piece: among the first planes, or the next ones while all leave thin pieces, or more planes
 * at the same edges. In need it makes the one that leaves the thickest pieces. *made: there is a cut. */
static bool make_cut(divider *d, uint32_t piece, bool *made)
{
    const uint32_t faces = d->m.piece[piece].faces;
    uint32_t tried = FACES_TRIED / (faces + 1);
    tried = tried < LEAST_TRIED ? LEAST_TRIED : tried > MOST_TRIED ? MOST_TRIED : tried;
    d->cuts.count = 0;
    *made = false;
    for (uint32_t i = 0; i < d->count && !*made; i++)
        if (!tl_section_cuts(d->s, &d->m, piece, d->list[i].plane, &d->cuts) ||
            ((i + 1 >= tried || i + 1 == d->count) && !try_cuts(d, piece, made)))
            return false;
    if (*made)
        return true;
    if (!add_fans(d, piece) || !try_cuts(d, piece, made))
        return false;
    const tl_solid_cut *thickest = *made ? NULL : thickest_cut(&d->cuts);
    *made = *made || thickest || flatten_edges(d, piece);
    if (!thickest)
        return true;
    double thickness;
    return tl_solid_cut_make(d->s, &d->m, piece, thickest, 0, &thickness);
}

/* Whether a convex piece has more faces or vertices than a polyhedron may have: V = 2 + E - F. */
static bool is_too_large(tl_solid_mesh *m, uint32_t piece)
{
    const uint32_t faces = tl_piece_compact(m, piece);
    size_t halves = 0;
    for (uint32_t i = 0; i < faces && faces > MOST_FACES; i++)
        TL_EACH_HALF(m, m->piece[piece].face[i], h, first)
    halves++;
    return faces > MOST_FACES && (faces > TL_POLY_MAX_FACES || 2 + halves / 2 - faces > TL_POLY_MAX_VERTICES);
}

/* Cuts a convex piece across the way from the middle of its faces to the farthest of them. */
static bool halve_piece(divider *d, uint32_t piece)
{
    tl_solid_mesh *m = &d->m;
    const tl_solid_piece *p = &m->piece[piece];
    tl_vec3 middle = {0, 0, 0}, way = {0, 0, 0};
    uint32_t plane;
    for (uint32_t i = 0; i < p->faces; i++)
        middle = tl_v3_madd(middle, 1.0 / p->faces, m->face[p->face[i]].center);
    for (uint32_t i = 0; i < p->faces; i++) {
        const tl_vec3 arm = tl_v3_sub(m->face[p->face[i]].center, middle);
        if (tl_v3_dot(arm, arm) > tl_v3_dot(way, way))
            way = arm;
    }
    way = tl_v3_unit(way);
    double thickness;
    if (!tl_solid_add_plane(m, (tl_plane){way, tl_v3_dot(way, middle)}, &plane))
        return false;
    const tl_solid_cut cut = {.plane = plane, .edge = TL_SOLID_NONE};
    return tl_solid_cut_make(d->s, m, piece, &cut, 0, &thickness);
}

/* A sentence about the first reflex edge of a piece. */
static tl_status edge_fault(const tl_solid_mesh *m, uint32_t piece, const char *what, const char *remedy,
                            tl_error *error)
{
    const uint32_t h = m->piece[piece].reflex[0];
    const tl_vec3 a = tl_solid_shown(m, m->half[h].from), b = tl_solid_shown(m, tl_half_to(m, h));
    return tl_fail(error, TL_E_GEOMETRY, "%s at the edge from {%g, %g, %g} to {%g, %g, %g}%s", what, a.x, a.y, a.z, b.x,
                   b.y, b.z, remedy);
}

static bool add_part(tl_convex_parts *parts, uint32_t *capacity, tl_poly *part)
{
    if (!tl_solid_grow(&parts->part, capacity, (uint32_t)parts->count, sizeof *parts->part)) {
        tl_poly_free(part);
        return false;
    }
    parts->part[parts->count++] = part;
    return true;
}

/* Divides a piece until it is convex, and takes it; what it is parted from waits for its turn. */
static tl_status finish_piece(divider *d, uint32_t piece, tl_convex_parts *parts, uint32_t *capacity, tl_error *error)
{
    const size_t most = MOST_PARTS * (parts->reflex_edges + 1);
    for (uint32_t cuts = 0;; cuts++) {
        if (!list_candidates(d, piece))
            return tl_fail_memory(error);
        if (d->m.piece[piece].reflexes == 0 && !is_too_large(&d->m, piece))
            break;
        if (d->m.pieces > most || cuts > most)
            return tl_fail(error, TL_E_GEOMETRY, "the solid would become more than %zu convex parts", most);
        bool made = true;
        if (d->m.piece[piece].reflexes == 0 ? !halve_piece(d, piece) : !make_cut(d, piece, &made))
            return tl_fail_memory(error);
        if (!made)
            return edge_fault(&d->m, piece, "the solid could not be divided",
                              ", where it bends inward; faces near it may touch each other, or be bent", error);
    }
    tl_poly *part;
    const tl_solid_piece *p = &d->m.piece[piece];
    const tl_status status = tl_solid_part(&d->m, p->face, tl_piece_compact(&d->m, piece), &part, error);
    if (status != TL_OK)
        return status;
    return add_part(parts, capacity, part) ? TL_OK : tl_fail_memory(error);
}

static tl_status check_volume(const divider *d, const tl_convex_parts *parts, tl_error *error)
{
    double sum = 0, area = 0;
    for (size_t i = 0; i < parts->count; i++) {
        sum += tl_poly_mass(parts->part[i]).volume;
        for (uint32_t f = 0; f < parts->part[i]->face_count; f++)
            area += tl_poly_face_area(parts->part[i], f);
    }
    /* faces may be off their planes by what is flat */
    const double slack = fmax(FILLED * d->m.volume, d->m.on * area);
    if (fabs(sum - d->m.volume) <= slack)
        return TL_OK;
    return tl_fail(
        error, TL_E_GEOMETRY,
        "the solid could not be divided into convex parts: they have %g m3 of its %g m3; its faces may lie on "
        "each other",
        sum, d->m.volume);
}

/* What is asked of a surface before it is divided. */
static tl_status read_solid(divider *d, const tl_solid_surface *surface, tl_error *error)
{
    tl_status status = tl_solid_read(surface, &d->m, error);
    if (status == TL_OK)
        status = tl_solid_check_crossing(&d->m, error);
    if (status == TL_OK)
        status = tl_solid_check_cavities(&d->m, error);
    if (status == TL_OK && surface->whole && d->m.piece[0].reflexes > 0)
        status = edge_fault(&d->m, 0, "the solid is not convex: it bends inward", "", error);
    return status;
}

static tl_status divide(divider *d, tl_convex_parts *parts, tl_error *error)
{
    uint32_t capacity = 0;
    tl_status status = TL_OK;
    *parts = (tl_convex_parts){.reflex_edges = d->m.piece[0].reflexes};
    for (uint32_t i = 0; status == TL_OK && i < d->m.pieces; i++)
        status = finish_piece(d, i, parts, &capacity, error);
    if (status == TL_OK)
        status = check_volume(d, parts, error);
    if (status != TL_OK)
        tl_convex_parts_free(parts);
    return status;
}

/* Divides a solid with what is flat to it. *again: it could not be done. */
static tl_status divide_with(const tl_solid_surface *surface, tl_convex_parts *parts, bool *again, tl_error *error)
{
    divider d = {.s = tl_section_new()};
    tl_status status = d.s ? read_solid(&d, surface, error) : tl_fail_memory(error);
    if (status == TL_OK) {
        d.slot = calloc((size_t)d.m.planes + 1, sizeof *d.slot);
        status = d.slot ? divide(&d, parts, error) : tl_fail_memory(error);
        *again = status == TL_E_GEOMETRY;
    }
    tl_section_free(d.s);
    tl_solid_free(&d.m);
    free(d.cuts.cut);
    free(d.list);
    free(d.slot);
    return status;
}

tl_status tl_convex_parts_make(const tl_solid_surface *surface, tl_convex_parts *parts, tl_error *error)
{
    *parts = (tl_convex_parts){0};
    bool again = false;
    tl_status status = divide_with(surface, parts, &again, error);
    const tl_bounds all = tl_points_bounds(surface->vertices, surface->vertex_count);
    const double size = tl_v3_norm(tl_v3_sub(all.max, all.min));
    for (double by = FLATTER; again && by * TL_POLY_ON <= FLATTEST; by *= FLATTER)
        for (int fine = 0; again && fine < 2; fine++) {
            tl_solid_surface other = *surface;
            tl_error ignored;
            again = false;
            if (fine)
                other.finer = by;
            else
                other.flat = fmax(surface->flat, by * TL_POLY_ON * size);
            if (divide_with(&other, parts, &again, &ignored) == TL_OK)
                return TL_OK;
        }
    if (status == TL_OK && parts->reflex_edges == 0) {
        const double thickness = tl_poly_thickness(parts->part[0]);
        if (thickness < TL_POLY_THIN * parts->part[0]->size)
            status = tl_fail(error, TL_E_GEOMETRY,
                             "the solid is %g m thick for a size of %g m: too thin for a block, which needs %g m",
                             thickness, size, TL_POLY_THIN * size);
    }
    if (status != TL_OK)
        tl_convex_parts_free(parts);
    return status;
}

void tl_convex_parts_free(tl_convex_parts *parts)
{
    for (size_t i = 0; i < parts->count; i++)
        tl_poly_free(parts->part[i]);
    free(parts->part);
    *parts = (tl_convex_parts){0};
}
