/* zone_faces.c - the points of zones on the faces of a block.
 *
 * A face has a frame of its own: origin P and x along its longest edge P Q, y into the face. Among equal edges that
 * with the lowest keys of corners is the longest. P is the end whose other edge is longer or, where both are alike, the
 * end with the lower key. Corners are listed from P over Q on. Both sides of a joint have the same list, and one of
 * them sees the frame from behind: its `turn` is -1.
 *
 * Points lie in a triangular lattice on P Q, whose points are points of that edge, too:
 *
 *     x = (i + j / 2) p    y = j p sqrt(3) / 2    p = |P Q| / n
 *
 * Those nearer than NEAR h to an edge are left out. Where h is a function of place, lattices of p / 2^k follow each
 * other, coarse ones first. A point is taken when none that was taken is nearer than APART h.
 *
 * A face of a block that is given in parts (joined_faces.c) has points on each part, in the frame of that. Their
 * places in the face are then those in the frame of its first part.
 *
 * Triangles are those of Delaunay in these coordinates, put on a grid (delaunay.c). Weights decide among points on one
 * circle. They are random by keys, and the same on both sides (zone_weight.h). */
#include "geometry/zone_faces.h"

#include "base/random.h"
#include "base/table.h"
#include "geometry/zone_weight.h"

#include <talus/vmath.h>

#define NONE UINT32_MAX

/* Tolerance: lengths that differ by less than this share count as equal. */
#define TIE 1e-9
/* Constant: how near an edge a point on a face may be, and graded ones each other, in parts of the wanted edge. A point
 * just there is taken, whatever its rounding. */
#define NEAR (0.55 * (1 - 1e-7))
#define APART (0.8 * (1 - 1e-7))
/* Cost only: a lattice is tried where the wanted edge is less than this times its own. */
#define WORTH 2.0
/* Limit: lattices of a face. */
#define MOST_LEVELS 20
/* Constant: height of an equilateral triangle of edge 1. */
#define TRIANGLE_HEIGHT 0.86602540378443865

/* A face's frame, as the block's vertices are given. */
typedef struct face_frame {
    uint32_t face, corners;
    uint32_t first;   /* place in the loop of P */
    bool forward;     /* Q comes after P in the loop */
    uint32_t longest; /* edge P Q */
    tl_vec3 x, y, normal;
    double height; /* of the mean plane over P */
    double low[2], high[2];
    double unit; /* grid units per length */
} face_frame;

static uint32_t corner_at(const tl_poly *poly, uint32_t face, uint32_t i)
{
    const uint32_t n = tl_poly_face_size(poly, face);
    return poly->loop[poly->start[face] + i % n];
}

static double side_length(const tl_poly *poly, uint32_t face, uint32_t i)
{
    return tl_v3_norm(tl_v3_sub(poly->vertex[corner_at(poly, face, i + 1)], poly->vertex[corner_at(poly, face, i)]));
}

/* Whether the keys of side i come before those of side k. */
static bool has_lower_keys(const tl_zone_points *p, uint32_t face, uint32_t i, uint32_t k)
{
    uint64_t a = tl_zone_corner_key(p, corner_at(p->poly, face, i));
    uint64_t b = tl_zone_corner_key(p, corner_at(p->poly, face, i + 1));
    uint64_t c = tl_zone_corner_key(p, corner_at(p->poly, face, k));
    uint64_t d = tl_zone_corner_key(p, corner_at(p->poly, face, k + 1));
    const uint64_t low = a < b ? a : b, other = c < d ? c : d;
    return low != other ? low < other : (a < b ? b : a) < (c < d ? d : c);
}

static void choose_start(const tl_zone_points *p, face_frame *f)
{
    const tl_poly *poly = p->poly;
    const uint32_t n = f->corners;
    double longest = 0;
    for (uint32_t i = 0; i < n; i++)
        longest = fmax(longest, side_length(poly, f->face, i));
    uint32_t side = n;
    for (uint32_t i = 0; i < n; i++)
        if (side_length(poly, f->face, i) >= longest * (1 - TIE) && (side == n || has_lower_keys(p, f->face, i, side)))
            side = i;
    const double before = side_length(poly, f->face, side + n - 1), after = side_length(poly, f->face, side + 1);
    if (before > after * (1 + TIE) || after > before * (1 + TIE))
        f->forward = before > after;
    else
        f->forward = tl_zone_corner_key(p, corner_at(poly, f->face, side)) <
                     tl_zone_corner_key(p, corner_at(poly, f->face, side + 1));
    f->first = f->forward ? side : side + 1;
    f->longest = p->edge_at[poly->start[f->face] + side];
}

/* Corner k of the list that begins with P and Q. */
static tl_vec3 listed(const tl_zone_points *p, const face_frame *f, uint32_t k)
{
    const uint32_t i = f->forward ? f->first + k : f->first + f->corners - k;
    return p->poly->vertex[corner_at(p->poly, f->face, i)];
}

static tl_site2 into_face(const face_frame *f, tl_vec3 from_first)
{
    return (tl_site2){tl_v3_dot(from_first, f->x), tl_v3_dot(from_first, f->y), 0};
}

/* Takes the corners of a face into the bounds of a frame: how far they are from its plane, the least and the most. */
static void take_in(const tl_zone_points *p, face_frame *f, uint32_t face, double *least, double *most)
{
    const tl_vec3 origin = listed(p, f, 0);
    for (uint32_t h = p->poly->start[face]; h < p->poly->start[face + 1u]; h++) {
        const tl_vec3 to = tl_v3_sub(p->poly->vertex[p->poly->loop[h]], origin);
        const tl_site2 at = into_face(f, to);
        f->low[0] = fmin(f->low[0], at.x), f->high[0] = fmax(f->high[0], at.x);
        f->low[1] = fmin(f->low[1], at.y), f->high[1] = fmax(f->high[1], at.y);
        *least = fmin(*least, tl_v3_dot(to, f->normal)), *most = fmax(*most, tl_v3_dot(to, f->normal));
    }
    int exponent;
    (void)frexp(fmax(f->high[0] - f->low[0], f->high[1] - f->low[1]), &exponent);
    f->unit = ldexp(1, TL_GRID_BITS - exponent);
}

static face_frame frame_of(const tl_zone_points *p, uint32_t face)
{
    face_frame f = {.face = face, .corners = tl_poly_face_size(p->poly, face)};
    choose_start(p, &f);
    const tl_vec3 origin = listed(p, &f, 0);
    tl_vec3 area = {0, 0, 0}, before = tl_v3_sub(listed(p, &f, 1), origin);
    f.x = tl_v3_unit(before);
    for (uint32_t k = 2; k < f.corners; k++) {
        const tl_vec3 next = tl_v3_sub(listed(p, &f, k), origin);
        area = tl_v3_add(area, tl_v3_cross(before, next));
        before = next;
    }
    f.y = tl_v3_unit(tl_v3_cross(area, f.x));
    f.normal = tl_v3_cross(f.x, f.y);
    f.low[0] = f.low[1] = INFINITY;
    f.high[0] = f.high[1] = -INFINITY;
    double least = INFINITY, most = -INFINITY;
    take_in(p, &f, face, &least, &most);
    f.height = 0.5 * (least + most);
    return f;
}

/* ---- coordinates in the faces ---- */

/* The shortest part of an edge of the face: weights are small beside it. */
static double shortest_part(const tl_zone_points *p, const face_frame *f)
{
    double shortest = INFINITY;
    if (p->zoning->parts)
        return p->zoning->parts->shortest;
    for (uint32_t h = p->poly->start[f->face]; h < p->poly->start[f->face + 1u]; h++)
        shortest = fmin(shortest, p->edge_part[p->edge_at[h]]);
    return shortest;
}

static void note(tl_zone_points *p, const face_frame *f, uint32_t point, tl_site2 at, double shortest)
{
    const uint32_t i = p->start[point] + p->filled[point]++;
    at.x = floor(f->unit * (at.x - f->low[0]) + 0.5);
    at.y = floor(f->unit * (at.y - f->low[1]) + 0.5);
    at.weight = tl_zone_weight(point < p->edge_end, p->size[point] * f->unit, shortest * f->unit, p->chance[point]);
    p->in_face[i] = (tl_in_face){tl_zone_block_face(p, f->face), at};
}

/* Whether an edge lies between two parts of one face of the block. */
static bool is_within(const tl_zone_points *p, uint32_t edge)
{
    const tl_edge *e = &p->poly->edge[edge];
    return tl_zone_block_face(p, e->left) == tl_zone_block_face(p, e->right);
}

/* Counts the faces of each surface point, and makes room for them. */
static bool count_faces(tl_zone_points *p)
{
    const tl_poly *poly = p->poly;
    const size_t points = p->face_end;
    if (!tl_grow(&p->start, &p->start_room, points + 1, sizeof *p->start) ||
        !tl_grow(&p->filled, &p->filled_room, points, sizeof *p->filled))
        return false;
    for (uint32_t i = 0; i < p->face_end; i++) {
        p->filled[i] = i < p->edge_end ? 0 : 1;
        p->start[i] = NONE;
    }
    for (uint32_t e = 0; e < poly->edge_count; e++)
        for (uint32_t i = p->edge_start[e]; i < p->edge_start[e + 1]; i++)
            p->filled[i] = is_within(p, e) ? 1 : 2;
    for (uint32_t f = 0; f < poly->face_count; f++)
        for (uint32_t h = poly->start[f]; h < poly->start[f + 1]; h++) {
            const uint32_t corner = poly->loop[h], face = tl_zone_block_face(p, f);
            p->filled[corner] += p->start[corner] != face; /* `start` serves as the last face until then */
            p->start[corner] = face;
        }
    p->start[0] = 0;
    for (uint32_t i = 0; i < p->face_end; i++) {
        p->start[i + 1] = p->start[i] + p->filled[i];
        p->filled[i] = 0;
    }
    return tl_grow(&p->in_face, &p->in_face_room, p->start[points], sizeof *p->in_face);
}

/* Places of the points on an edge of a face, from differences of corners alone. */
static void note_edge(tl_zone_points *p, const face_frame *f, uint32_t edge, double shortest)
{
    const tl_edge *e = &p->poly->edge[edge];
    const bool forward = tl_zone_corner_key(p, e->a) < tl_zone_corner_key(p, e->b);
    const tl_vec3 low = p->poly->vertex[forward ? e->a : e->b], high = p->poly->vertex[forward ? e->b : e->a];
    const tl_vec3 from = tl_v3_sub(low, listed(p, f, 0)), step = tl_v3_sub(high, low);
    for (uint32_t i = p->edge_start[edge]; i < p->edge_start[edge + 1]; i++)
        note(p, f, i, into_face(f, tl_v3_madd(from, p->flat[i].x, step)), shortest);
}

/* Whether a corner has its place in a face of the block already: by another part of that. */
static bool is_noted(const tl_zone_points *p, uint32_t corner, uint32_t block_face)
{
    return p->filled[corner] > 0 && p->in_face[p->start[corner] + p->filled[corner] - 1].face == block_face;
}

/* Places of the points inside a part of a face, which has a frame of its own, in that of the face. */
static void note_inner(tl_zone_points *p, const face_frame *f, uint32_t part, double shortest)
{
    const tl_vec3 origin = listed(p, f, 0);
    for (uint32_t i = p->face_from[part]; i < p->face_from[part + 1]; i++) {
        const tl_site2 own = {p->flat[i].x, p->flat[i].y, 0};
        note(p, f, i, part == f->face ? own : into_face(f, tl_v3_sub(p->real[i], origin)), shortest);
    }
}

/* Places of all points of a face of the block: of its parts from `first` on. */
static void note_all(tl_zone_points *p, uint32_t first, uint32_t end)
{
    const tl_poly *poly = p->poly;
    face_frame f = frame_of(p, first);
    double least = 0, most = 0;
    for (uint32_t part = first + 1; part < end; part++)
        take_in(p, &f, part, &least, &most);
    p->turn[tl_zone_block_face(p, first)] = f.forward ? 1 : -1;
    const double shortest = shortest_part(p, &f);
    for (uint32_t part = first; part < end; part++) {
        for (uint32_t h = poly->start[part]; h < poly->start[part + 1]; h++) {
            const tl_vec3 corner = poly->vertex[poly->loop[h]];
            if (!is_noted(p, poly->loop[h], tl_zone_block_face(p, first)))
                note(p, &f, poly->loop[h], into_face(&f, tl_v3_sub(corner, listed(p, &f, 0))), shortest);
            if (!is_within(p, p->edge_at[h]) || poly->edge[p->edge_at[h]].left == part)
                note_edge(p, &f, p->edge_at[h], shortest);
        }
        note_inner(p, &f, part, shortest);
    }
}

/* ---- lattices ---- */

/* The part of a row at height y that is farther than `margin` from all edges. */
static void clip_row(const tl_zone_points *p, const face_frame *f, double y, double margin, double *from, double *to)
{
    const tl_vec3 origin = listed(p, f, 0);
    *from = -INFINITY;
    *to = INFINITY;
    for (uint32_t k = 0; k < f->corners; k++) {
        const tl_site2 a = into_face(f, tl_v3_sub(listed(p, f, k), origin));
        const tl_site2 b = into_face(f, tl_v3_sub(listed(p, f, (k + 1) % f->corners), origin));
        const double ex = b.x - a.x, ey = b.y - a.y, length = sqrt(ex * ex + ey * ey);
        /* left of the edge: ex (y - a.y) - ey (x - a.x) >= margin length */
        const double rest = ex * (y - a.y) + ey * a.x - margin * length;
        if (ey > 0)
            *to = fmin(*to, rest / ey);
        else if (ey < 0)
            *from = fmax(*from, rest / ey);
        else if (rest < 0)
            *to = -INFINITY;
    }
}

typedef struct lattice {
    uint32_t level;
    double pitch;
    double finest; /* the smallest size that was asked for */
} lattice;

/* Whether a lattice point is taken where sizes are a function of place. */
static bool is_free(const tl_zone_points *p, const face_frame *f, const tl_zone_near *near, tl_site2 at, double size,
                    double pitch)
{
    double from, to;
    if (size > WORTH * pitch)
        return false;
    clip_row(p, f, at.y, NEAR * size, &from, &to);
    return at.x >= from && at.x <= to && !tl_zone_near_any(near, tl_v3(at.x, at.y, 0), APART * size);
}

static tl_status try_point(tl_zone_points *p, const face_frame *f, tl_zone_near *near, lattice *l, tl_site2 at,
                           uint64_t key, tl_error *error)
{
    const tl_vec3 origin = listed(p, f, 0);
    const tl_vec3 step = tl_v3_madd(tl_v3_madd(tl_v3_scale(at.x, f->x), at.y, f->y), f->height, f->normal);
    const tl_vec3 real = tl_v3_add(origin, step);
    const double size = tl_zoning_size(p->zoning, real);
    if (p->zoning->size) {
        const tl_status status = tl_zone_size_check(size, real, error);
        if (status)
            return status;
        l->finest = fmin(l->finest, size);
        if (!is_free(p, f, near, at, size, l->pitch))
            return TL_OK;
        if (!tl_zone_near_add(near, l->level, tl_v3(at.x, at.y, 0)))
            return tl_fail_memory(error);
    }
    const tl_vec3 place = tl_zone_into_frame(p, tl_v3_add(tl_v3_sub(origin, p->poly->vertex[0]), step));
    const tl_point2 flat = {at.x, at.y};
    return tl_zone_points_add_outer(p, place, real, flat, size, key) ? TL_OK : tl_fail_memory(error);
}

static tl_status lay_lattice(tl_zone_points *p, const face_frame *f, tl_zone_near *near, lattice *l, tl_error *error)
{
    const double margin = p->zoning->size ? 0 : NEAR * p->zoning->edge, row = l->pitch * TRIANGLE_HEIGHT;
    tl_status status = TL_OK;
    for (uint32_t j = 1; !status && j * row < f->high[1]; j++) {
        const double shift = 0.5 * (double)(j % 2);
        double from, to;
        clip_row(p, f, j * row, margin, &from, &to);
        const double first = ceil(from / l->pitch - shift), last = floor(to / l->pitch - shift);
        for (double i = first; !status && i <= last; i++) {
            /* counted along the slanted axis, for the key */
            const int64_t number = (int64_t)i - (int64_t)(j / 2);
            const uint64_t key = tl_key(tl_key(tl_mix64(l->level), j), (uint64_t)number);
            status = try_point(p, f, near, l, (tl_site2){(i + shift) * l->pitch, j * row, 0}, key, error);
        }
    }
    return status;
}

/* The sizes at the points around a face. */
static void sizes_around(const tl_zone_points *p, uint32_t face, double *least, double *most)
{
    const tl_poly *poly = p->poly;
    *least = INFINITY;
    *most = 0;
    for (uint32_t h = poly->start[face]; h < poly->start[face + 1]; h++) {
        const uint32_t corner = poly->loop[h], edge = p->edge_at[h];
        *least = fmin(*least, p->size[corner]);
        *most = fmax(*most, p->size[corner]);
        for (uint32_t i = p->edge_start[edge]; i < p->edge_start[edge + 1]; i++) {
            *least = fmin(*least, p->size[i]);
            *most = fmax(*most, p->size[i]);
        }
    }
}

static tl_status lay_one(tl_zone_points *p, uint32_t face, tl_zone_near *near, tl_error *error)
{
    const face_frame f = frame_of(p, face);
    const uint32_t longest = f.longest, parts = p->edge_start[longest + 1] - p->edge_start[longest] + 1;
    const double length = f.high[0] - f.low[0];
    lattice l = {.pitch = side_length(p->poly, face, f.forward ? f.first : f.first + f.corners - 1) / parts};
    if (!p->zoning->size)
        return lay_lattice(p, &f, near, &l, error);
    double most;
    sizes_around(p, face, &l.finest, &most);
    l.pitch = fmin(most, length);
    if (!tl_zone_near_begin(near, l.pitch))
        return tl_fail_memory(error);
    tl_status status = TL_OK;
    for (; !status && l.level < MOST_LEVELS && WORTH * l.pitch > l.finest; l.level++, l.pitch *= 0.5)
        status = lay_lattice(p, &f, near, &l, error);
    return status;
}

tl_status tl_zone_faces_lay(tl_zone_points *p, tl_zone_near *near, tl_error *error)
{
    for (uint32_t f = 0; f < p->poly->face_count; f++) {
        p->face_from[f] = p->count;
        const tl_status status = lay_one(p, f, near, error);
        if (status)
            return status;
    }
    p->face_from[p->poly->face_count] = p->face_end = p->count;
    if (!count_faces(p))
        return tl_fail_memory(error);
    for (uint32_t first = 0, end = 0; first < p->poly->face_count; first = end) {
        while (end < p->poly->face_count && tl_zone_block_face(p, end) == tl_zone_block_face(p, first))
            end++;
        note_all(p, first, end);
    }
    return TL_OK;
}
