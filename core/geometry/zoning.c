/* zoning.c - a convex block is divided into tetrahedra, its zones.
 *
 * Points are laid on edges (zone_edges.c), on faces (zone_faces.c), and inside (zone_inside.c), and put on a grid of
 * 2^-40 of the block's size. Zones are the tetrahedra of Delaunay of these (delaunay.c). Points inside are then moved
 * (zone_repair.c), and the outcome is checked:
 *
 *     every zone has a positive volume
 *     the triangles of each face are turned the right way and add up to its area
 *     the zones add up to the volume of the block
 *
 * Faces may be bent a little, as those of meshes are. Points of such a block are moved before they go onto the grid.
 * Corners go inwards the most, so that no face is hollow, and with the weights w of points (zone_weight.h):
 *
 *     x' = c + (x - c) (1 - bulge (|x - c|^2 - w) / R^2)
 *
 * c is the centroid and R the largest distance from it. The hull of a face moved so has the Delaunay triangles of the
 * flat face, as far as the bulge is more than the bend. Only what lies on the grid is moved. Where a check fails,
 * another bulge is tried, and another unit of the grid: which flat zones are made among points on a sphere hangs on
 * rounding.
 *
 * Faces may be given in parts (joined_faces.c). Delaunay knows the whole face alone. Where one of its triangles lies
 * across an edge between two parts, nothing is made, and the middle of what it crosses is told. With corners there the
 * parts of the edge are shorter, and sooner or later no triangle crosses them (Ruppert 1995). */
#include "geometry/zoning.h"

#include "base/table.h"
#include "geometry/measure.h"
#include "geometry/zone_edges.h"
#include "geometry/zone_faces.h"
#include "geometry/zone_inside.h"
#include "geometry/zone_repair.h"
#include "geometry/zone_weight.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define NONE UINT32_MAX

/* Tolerance: the zones of a block add up to its volume within this share, beside the roundings of coordinates. */
#define FILLED 1e-12
/* Tolerance: roundings of coordinates that a volume may be off by, times the surface. */
#define ROUNDINGS (16 * DBL_EPSILON)
/* Tolerance: triangles of a face add up to its area within this share, and within so many units of the grid all around
 * it: points on its edges are rounded. */
#define COVERED 1e-9
#define RIM 4
/* Tolerance: faces bent by less than this share of the extent count as flat. Far from zero coordinates are rounded so.
 */
#define FLAT 1e-8
/* Limit: the shortest edge, as a share of the extent: some hundred units of the grid. */
#define SHORTEST 1e-10
/* Constant: the bulge of a bent block is this many times its bend at first. Then less and more of it is tried in turn:
 * a large one may turn an edge between two faces that are nearly one, a small one leave a face hollow. */
#define BULGE_OF_BEND 3e3
#define OTHER_BULGE 0.2
#define MOST_BULGE 0.05
/* Constant: so many tries of a flat block have no bulge, the others this one. */
#define FLAT_TRIES 4
#define FLAT_BULGE 1e-3
/* Constant: the share of altitudes below which zones are so flat that a block is tried again. */
#define FLATTEST 1e-6
/* Constant: the factor of weights after a point has been hidden by them. */
#define LIGHTER 1e-2
/* Constant: how often a block is tried, and the share by which each has a coarser grid. */
#define TRIES 9
#define COARSER 0.04

/* How a block is tried. */
typedef struct attempt {
    double bulge, stretch; /* of the places on the grid, and of its unit */
    double light;          /* factor of the weights */
    double least_share;    /* refused are zones that have less */
} attempt;

struct tl_zone_scratch {
    tl_zone_points points;
    tl_zone_near near;
    tl_delaunay delaunay;
    tl_zone_repair repair;
    tl_site *site;
    tl_zone_lists lists;
    uint32_t *number; /* of the zone of a tetrahedron */
    tl_zone_triangle *triangle;
    uint32_t *triangle_at; /* [face + 1] */
    size_t site_room, number_room, triangle_room, triangle_at_room;
    uint32_t triangle_count;
    uint32_t *on; /* of a block whose faces are given in parts: the edge or the part that a surface point is on */
    tl_vec3 *crossed;
    size_t on_room, crossed_room, crossed_count;
};

tl_zone_scratch *tl_zone_scratch_create(void)
{
    return calloc(1, sizeof(tl_zone_scratch));
}

void tl_zone_scratch_free(tl_zone_scratch *s)
{
    if (!s)
        return;
    tl_zone_points_free(&s->points);
    tl_zone_near_free(&s->near);
    tl_delaunay_free(&s->delaunay);
    tl_zone_repair_free(&s->repair);
    free(s->site);
    tl_zone_lists_free(&s->lists);
    free(s->number);
    free(s->triangle);
    free(s->triangle_at);
    free(s->on);
    free(s->crossed);
    free(s);
}

void tl_zone_mesh_free(tl_zone_mesh *m)
{
    free(m->point);
    free(m->zone);
    free(m->beside);
    free(m->triangle);
    *m = (tl_zone_mesh){0};
}

double tl_zoning_expected(double volume, double surface, double edge)
{
    /* 12 tetrahedra in two thirds of a cube of the lattice each, and a layer of smaller ones on the surface */
    const double inside = 8.5 * volume / (edge * edge * edge), layer = 2.5 * surface / (edge * edge);
    return 12 + inside + layer;
}

/* ---- points on the grid ---- */

static double weight_of(const tl_zone_points *p, uint32_t i, double unit)
{
    return tl_zone_weight(i < p->edge_end, unit * p->size[i], unit * p->shortest, p->chance[i]);
}

static tl_vec3 bulged(const tl_zone_points *p, uint32_t i, double bulge, double unit)
{
    const tl_vec3 arm = tl_v3_sub(p->place[i], p->centroid);
    const double power = tl_v3_norm2(arm) - weight_of(p, i, unit) / (unit * unit);
    return tl_v3_madd(p->place[i], -bulge * power / (p->extent * p->extent), arm);
}

static bool put_on_grid(tl_zone_scratch *s, const attempt *a)
{
    const tl_zone_points *p = &s->points;
    if (!tl_grow(&s->site, &s->site_room, p->count, sizeof *s->site))
        return false;
    const tl_bounds b = tl_points_bounds(p->place, p->corner_end);
    const tl_vec3 sides = tl_v3_sub(b.max, b.min);
    int exponent;
    (void)frexp(fmax(sides.x, fmax(sides.y, sides.z)), &exponent);
    /* no point of a bulge is farther out than the corners were */
    const double unit = a->stretch * ldexp(1, TL_GRID_BITS - exponent);
    for (uint32_t i = 0; i < p->count; i++) {
        const tl_vec3 at = tl_v3_sub(a->bulge > 0 ? bulged(p, i, a->bulge, unit) : p->place[i], b.min);
        s->site[i] = (tl_site){floor(unit * at.x + 0.5), floor(unit * at.y + 0.5), floor(unit * at.z + 0.5),
                               floor(a->light * weight_of(p, i, unit))};
    }
    return true;
}

/* ---- zones and triangles of tetrahedra ---- */

static void list_zones(tl_zone_scratch *s)
{
    const tl_delaunay *d = &s->delaunay;
    s->lists.count = 0;
    for (uint32_t t = 0; t < d->used; t++) {
        const tl_tetrahedron *here = &d->tetrahedron[t];
        s->number[t] = NONE;
        if (!tl_is_there(here) || tl_is_ghost(here))
            continue;
        s->number[t] = s->lists.count;
        memcpy(s->lists.zone[s->lists.count++], here->corner, sizeof here->corner);
    }
    for (uint32_t t = 0; t < d->used; t++)
        for (int i = 0; s->number[t] != NONE && i < 4; i++)
            s->lists.beside[s->number[t]][i] = s->number[d->tetrahedron[t].next[i] / 4];
}

/* Whether a surface point is in a part of a face. */
static bool is_in_part(const tl_zone_scratch *s, uint32_t point, uint32_t part)
{
    const tl_zone_points *p = &s->points;
    const tl_poly *poly = p->poly;
    if (point >= p->edge_end)
        return s->on[point] == part;
    if (point >= p->corner_end)
        return poly->edge[s->on[point]].left == part || poly->edge[s->on[point]].right == part;
    for (uint32_t h = poly->start[part]; h < poly->start[part + 1]; h++)
        if (poly->loop[h] == point)
            return true;
    return false;
}

/* The face, or the part of one, that a ghost's triangle lies in; NONE: it lies across an edge between parts. */
static uint32_t part_of(const tl_zone_scratch *s, const tl_tetrahedron *ghost)
{
    const uint32_t face = ghost->corner[3] - TL_GHOST;
    if (!s->points.zoning->parts)
        return face;
    for (uint32_t part = 0; part < s->points.poly->face_count; part++)
        if (tl_zone_block_face(&s->points, part) == face && is_in_part(s, ghost->corner[0], part) &&
            is_in_part(s, ghost->corner[1], part) && is_in_part(s, ghost->corner[2], part))
            return part;
    return NONE;
}

/* Triangles by face, in the order of the ghosts. */
static void list_triangles(tl_zone_scratch *s)
{
    const tl_delaunay *d = &s->delaunay;
    const uint32_t faces = s->points.poly->face_count;
    memset(s->triangle_at, 0, (faces + 2) * sizeof *s->triangle_at);
    for (uint32_t t = 0; t < d->used; t++)
        if (tl_is_there(&d->tetrahedron[t]) && tl_is_ghost(&d->tetrahedron[t]))
            s->triangle_at[part_of(s, &d->tetrahedron[t]) + 2]++;
    for (uint32_t f = 0; f < faces; f++)
        s->triangle_at[f + 2] += s->triangle_at[f + 1];
    for (uint32_t t = 0; t < d->used; t++) {
        const tl_tetrahedron *ghost = &d->tetrahedron[t];
        if (!tl_is_there(ghost) || !tl_is_ghost(ghost))
            continue;
        const uint32_t face = part_of(s, ghost);
        s->triangle[s->triangle_at[face + 1]++] =
            (tl_zone_triangle){{ghost->corner[0], ghost->corner[1], ghost->corner[2]}, face};
    }
}

static bool take_over(tl_zone_scratch *s)
{
    const tl_delaunay *d = &s->delaunay;
    uint32_t zones = 0, ghosts = 0;
    for (uint32_t t = 0; t < d->used; t++)
        if (tl_is_there(&d->tetrahedron[t])) {
            zones += !tl_is_ghost(&d->tetrahedron[t]);
            ghosts += tl_is_ghost(&d->tetrahedron[t]);
        }
    const size_t faces = s->points.poly->face_count;
    if (!tl_zone_lists_room(&s->lists, zones) || !tl_grow(&s->number, &s->number_room, d->used, sizeof *s->number) ||
        !tl_grow(&s->triangle, &s->triangle_room, ghosts, sizeof *s->triangle) ||
        !tl_grow(&s->triangle_at, &s->triangle_at_room, faces + 2, sizeof *s->triangle_at))
        return false;
    s->triangle_count = ghosts;
    list_zones(s);
    list_triangles(s);
    return true;
}

/* ---- checks ---- */

/* Where a point is in the face of the block that a part is of. */
static const tl_site2 *place_in(const tl_zone_points *p, uint32_t point, uint32_t part)
{
    const uint32_t face = tl_zone_block_face(p, part);
    uint32_t i = p->start[point];
    while (i + 1 < p->start[point + 1] && p->in_face[i].face != face)
        i++;
    return &p->in_face[i].at;
}

static double twice_area(const tl_site2 *a, const tl_site2 *b, const tl_site2 *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

/* Whether the triangles of a face cover it. */
static bool is_covered(const tl_zone_scratch *s, uint32_t face)
{
    const tl_zone_points *p = &s->points;
    const tl_poly *poly = p->poly;
    const double turn = p->turn[tl_zone_block_face(p, face)];
    double sum = 0, all = 0;
    for (uint32_t i = s->triangle_at[face]; i < s->triangle_at[face + 1]; i++) {
        const uint32_t *v = s->triangle[i].corner;
        const double area =
            turn * twice_area(place_in(p, v[0], face), place_in(p, v[1], face), place_in(p, v[2], face));
        if (!(area > 0))
            return false;
        sum += area;
    }
    const tl_site2 *first = place_in(p, poly->loop[poly->start[face]], face);
    for (uint32_t h = poly->start[face] + 1u; h + 1 < poly->start[face + 1]; h++)
        all += turn * twice_area(first, place_in(p, poly->loop[h], face), place_in(p, poly->loop[h + 1], face));
    return fabs(sum - all) <= COVERED * all + RIM * ldexp(1, TL_GRID_BITS);
}

static tl_status check_faces(const tl_zone_scratch *s, tl_error *error)
{
    for (uint32_t f = 0; f < s->points.poly->face_count; f++)
        if (!is_covered(s, f))
            return tl_fail(error, TL_E_GEOMETRY,
                           "the zones do not cover its face %u: its corners are too close together", f + 1);
    return TL_OK;
}

/* What volumes may be off by where faces are bent. */
static double bent_volume(const tl_zone_points *p)
{
    double off = 0;
    for (uint32_t f = 0; f < p->poly->face_count; f++)
        off += 2 * p->bend[f] * tl_poly_face_area(p->poly, f);
    return off;
}

static double surface_of(const tl_poly *poly)
{
    double area = 0;
    for (uint32_t f = 0; f < poly->face_count; f++)
        area += tl_poly_face_area(poly, f);
    return area;
}

static double volume_of(const tl_zone_mesh *m, uint32_t zone)
{
    const uint32_t *v = m->zone[zone];
    return tl_tetrahedron_volume((tl_vec3[4]){m->point[v[0]], m->point[v[1]], m->point[v[2]], m->point[v[3]]});
}

/* Measures the zones: altitudes in the frame, where places are not rounded by where the block is. */
static void measure(const tl_zone_points *p, tl_zone_mesh *m)
{
    m->least_altitude = m->least_share = INFINITY;
    double left = 0;
    for (uint32_t z = 0; z < m->zone_count; z++) {
        const uint32_t *v = m->zone[z];
        const double altitude = tl_zone_altitude(p->place[v[0]], p->place[v[1]], p->place[v[2]], p->place[v[3]]);
        const double share = tl_zone_share(p, v);
        m->least_altitude = fmin(m->least_altitude, altitude);
        if (share < m->least_share)
            m->least_share = share, m->worst = z;
        /* what rounding leaves out of the sum is added to the next */
        const double next = volume_of(m, z) + left, sum = m->volume + next;
        left = next - (sum - m->volume);
        m->volume = sum;
    }
}

static tl_status check_zones(const tl_zone_points *p, const tl_zone_mesh *m, double least_share, tl_error *error)
{
    if (!(m->least_share > least_share))
        return tl_fail(error, TL_E_GEOMETRY, "its zone %u would have no volume: its faces lie too close together",
                       m->worst);
    const tl_poly *poly = p->poly;
    const tl_bounds bounds = tl_poly_bounds(poly);
    const double reach = fmax(tl_v3_norm(bounds.min), tl_v3_norm(bounds.max));
    const double whole = tl_poly_mass(poly).volume;
    const double allowed = FILLED * whole + ROUNDINGS * reach * surface_of(poly) + bent_volume(p);
    if (!(fabs(m->volume - whole) <= allowed))
        return tl_fail(error, TL_E_GEOMETRY, "its zones have a volume of %.17g, but it has %.17g", m->volume, whole);
    return TL_OK;
}

/* ---- edges between parts of a face ---- */

/* Notes the edge or the part that each surface point is on. */
static bool note_where(tl_zone_scratch *s)
{
    const tl_zone_points *p = &s->points;
    if (!tl_grow(&s->on, &s->on_room, p->face_end, sizeof *s->on))
        return false;
    for (uint32_t e = 0; e < p->poly->edge_count; e++)
        for (uint32_t i = p->edge_start[e]; i < p->edge_start[e + 1]; i++)
            s->on[i] = e;
    for (uint32_t f = 0; f < p->poly->face_count; f++)
        for (uint32_t i = p->face_from[f]; i < p->face_from[f + 1]; i++)
            s->on[i] = f;
    return true;
}

/* Whether two sides cross each other inside both. */
static bool cross_inside(const tl_site2 *a, const tl_site2 *b, const tl_site2 *c, const tl_site2 *d)
{
    const double abc = twice_area(a, b, c), abd = twice_area(a, b, d), cda = twice_area(c, d, a),
                 cdb = twice_area(c, d, b);
    return abc * abd < 0 && cda * cdb < 0;
}

/* Notes the middle of a part of an edge, from point a to point b, if a triangle lies across it. */
static bool note_crossed(tl_zone_scratch *s, const uint32_t corner[3], uint32_t part, uint32_t a, uint32_t b)
{
    const tl_zone_points *p = &s->points;
    const tl_site2 *u = place_in(p, a, part), *w = place_in(p, b, part);
    bool crosses = false;
    for (int k = 0; k < 3; k++)
        crosses = crosses || cross_inside(u, w, place_in(p, corner[k], part), place_in(p, corner[(k + 1) % 3], part));
    if (!crosses)
        return true;
    const tl_vec3 middle = tl_v3_scale(0.5, tl_v3_add(p->real[a], p->real[b]));
    for (size_t k = 0; k < s->crossed_count; k++)
        if (tl_v3_is_zero(tl_v3_sub(s->crossed[k], middle)))
            return true;
    if (!tl_grow(&s->crossed, &s->crossed_room, s->crossed_count + 1, sizeof *s->crossed))
        return false;
    s->crossed[s->crossed_count++] = middle;
    return true;
}

/* Notes what a ghost's triangle crosses of an edge between two parts of its face. */
static bool note_edge_crossed(tl_zone_scratch *s, const tl_tetrahedron *ghost, uint32_t edge)
{
    const tl_zone_points *p = &s->points;
    const tl_edge *e = &p->poly->edge[edge];
    const uint32_t face = ghost->corner[3] - TL_GHOST;
    if (tl_zone_block_face(p, e->left) != face || tl_zone_block_face(p, e->right) != face)
        return true;
    const bool forward = tl_zone_corner_key(p, e->a) < tl_zone_corner_key(p, e->b);
    const uint32_t end = p->edge_start[edge + 1];
    uint32_t from = forward ? e->a : e->b;
    bool enough = true;
    for (uint32_t i = p->edge_start[edge]; enough && i <= end; i++) {
        const uint32_t to = i < end ? i : forward ? e->b : e->a;
        enough = note_crossed(s, ghost->corner, e->left, from, to);
        from = to;
    }
    return enough;
}

/* Looks for triangles that lie across edges between parts. */
static tl_status check_parts(tl_zone_scratch *s, tl_error *error)
{
    const tl_delaunay *d = &s->delaunay;
    bool across = false, enough = note_where(s);
    for (uint32_t t = 0; enough && t < d->used; t++) {
        const tl_tetrahedron *ghost = &d->tetrahedron[t];
        if (!tl_is_there(ghost) || !tl_is_ghost(ghost) || part_of(s, ghost) != NONE)
            continue;
        across = true;
        for (uint32_t e = 0; enough && e < s->points.poly->edge_count; e++)
            enough = note_edge_crossed(s, ghost, e);
    }
    if (!enough)
        return tl_fail_memory(error);
    return across ? tl_fail(error, TL_E_GEOMETRY, "its zones do not end at the edges of the blocks beside it") : TL_OK;
}

const tl_vec3 *tl_zoning_crossed(const tl_zone_scratch *s, size_t *count)
{
    *count = s->crossed_count;
    return s->crossed;
}

/* ---- all ---- */

static tl_status lay_points(tl_zone_scratch *s, const tl_poly *poly, const tl_shape_zoning *zoning, tl_error *error)
{
    tl_status status = tl_zone_points_begin(&s->points, poly, zoning, error);
    if (!status)
        status = tl_zone_edges_lay(&s->points, error);
    if (!status && s->points.shortest < SHORTEST * s->points.extent)
        return tl_fail(error, TL_E_GEOMETRY, "its shortest edge is %.3g, which is nothing beside its size of %.3g",
                       s->points.shortest, poly->size);
    if (!status)
        status = tl_zone_faces_lay(&s->points, &s->near, error);
    if (!status)
        status = tl_zone_inside_lay(&s->points, &s->near, error);
    return status;
}

/* Zones of the points with a bulge, whose faces are covered. */
static tl_status divide(tl_zone_scratch *s, const attempt *a, tl_error *error)
{
    const tl_zone_points *p = &s->points;
    if (!put_on_grid(s, a))
        return tl_fail_memory(error);
    const tl_delaunay_points points = {.count = p->count,
                                       .site = s->site,
                                       .corner_count =
                                           p->zoning->parts ? p->zoning->parts->corner_count : p->corner_end,
                                       .surface_count = p->face_end,
                                       .start = p->start,
                                       .in_face = p->in_face,
                                       .flat = a->bulge == 0,
                                       .turn = p->turn};
    tl_status status = tl_delaunay_make(&s->delaunay, &points, error);
    if (!status && p->zoning->parts)
        status = check_parts(s, error);
    if (status)
        return status;
    return take_over(s) ? check_faces(s, error) : tl_fail_memory(error);
}

static bool make_mesh(const tl_zone_scratch *s, tl_zone_mesh *m)
{
    const tl_zone_points *p = &s->points;
    *m = (tl_zone_mesh){.point_count = p->count,
                        .zone_count = s->lists.count,
                        .triangle_count = s->triangle_count,
                        .corner_end = p->corner_end,
                        .edge_end = p->edge_end,
                        .face_end = p->face_end};
    m->point = malloc(m->point_count * sizeof *m->point);
    m->zone = malloc(m->zone_count * sizeof *m->zone);
    m->beside = malloc(m->zone_count * sizeof *m->beside);
    m->triangle = malloc(m->triangle_count * sizeof *m->triangle);
    if (!m->point || !m->zone || !m->beside || !m->triangle)
        return false;
    memcpy(m->point, p->real, p->face_end * sizeof *m->point);
    for (uint32_t i = p->edge_end; i < p->count; i++)
        if (i >= p->face_end || (p->zoning->face_free && p->zoning->face_free[p->in_face[p->start[i]].face]))
            m->point[i] = tl_zone_out_of_frame(p, p->place[i]);
    memcpy(m->zone, s->lists.zone, m->zone_count * sizeof *m->zone);
    memcpy(m->beside, s->lists.beside, m->zone_count * sizeof *m->beside);
    memcpy(m->triangle, s->triangle, m->triangle_count * sizeof *m->triangle);
    return true;
}

static tl_status make_once(tl_zone_scratch *s, const attempt *a, tl_zone_mesh *m, tl_error *error)
{
    tl_status status = divide(s, a, error);
    if (!status)
        status = tl_zone_repair_make(&s->repair, &s->points, &s->lists, error);
    if (!status && !make_mesh(s, m))
        status = tl_fail_memory(error);
    if (!status) {
        measure(&s->points, m);
        status = check_zones(&s->points, m, a->least_share, error);
    }
    if (status)
        tl_zone_mesh_free(m);
    return status;
}

/* The bulge with which a block is tried first: 0 where its faces are flat. Faces in parts count as flat: a bulge would
 * let the two sides of a part choose by its bend, and not alike. */
static double first_bulge(const tl_zone_points *p)
{
    double bend = 0;
    if (p->zoning->parts)
        return 0;
    for (uint32_t f = 0; f < p->poly->face_count; f++)
        bend = fmax(bend, p->bend[f]);
    bend /= p->extent;
    return bend > FLAT ? fmin(BULGE_OF_BEND * bend, MOST_BULGE) : 0;
}

/* That with which it is tried again: the first, less, more, still less, still more, and so on. */
static double bulge_of(double first, int again)
{
    if (first == 0)
        return again < FLAT_TRIES ? 0 : FLAT_BULGE;
    double factor = 1;
    for (int i = 0; i < (again + 1) / 2; i++)
        factor *= again % 2 ? OTHER_BULGE : 1 / OTHER_BULGE;
    return fmin(first * factor, MOST_BULGE);
}

/* Whether zones have a volume with places as far from zero as they are. */
static tl_status check_rounding(const tl_zone_mesh *m, tl_error *error)
{
    for (uint32_t z = 0; z < m->zone_count; z++)
        if (!(volume_of(m, z) > 0))
            return tl_fail(error, TL_E_GEOMETRY,
                           "its zone %u has no volume in coordinates of %g: move the model nearer to the origin", z,
                           tl_v3_norm(m->point[m->zone[z][0]]));
    return TL_OK;
}

tl_status tl_zoning_make(const tl_poly *poly, const tl_shape_zoning *zoning, tl_zone_scratch *scratch,
                         tl_zone_mesh *mesh, tl_error *error)
{
    *mesh = (tl_zone_mesh){0};
    scratch->crossed_count = 0;
    tl_status status = lay_points(scratch, poly, zoning, error);
    if (status)
        return status;
    const double bulge = first_bulge(&scratch->points);
    attempt a = {.bulge = bulge, .stretch = 1, .light = 1, .least_share = FLATTEST};
    status = make_once(scratch, &a, mesh, error);
    for (int again = 1; status == TL_E_GEOMETRY && again < TRIES && scratch->crossed_count == 0; again++) {
        /* repaired places are no places of lattices: all are laid anew */
        a.bulge = bulge_of(bulge, again);
        a.stretch = 1 - again * COARSER;
        a.light *= scratch->delaunay.hidden > 0 ? LIGHTER : 1;
        a.least_share = again < TRIES - 1 ? FLATTEST : 0;
        status = lay_points(scratch, poly, zoning, error);
        if (!status)
            status = make_once(scratch, &a, mesh, error);
    }
    if (!status)
        status = check_rounding(mesh, error);
    if (status)
        tl_zone_mesh_free(mesh);
    return status;
}
