/* zone_inside.c - the points of zones inside a block.
 *
 * They lie in a body-centred lattice along the axes of the block's frame, with the centroid as one of its points:
 *
 *     c + a (i, j, k)   and   c + a (i + 1/2, j + 1/2, k + 1/2)      a = BODY_CENTRED h
 *
 * Its tetrahedra are all alike, with a volume of a^3 / 12 and edges of a and sqrt(3) a / 2, which are h on average.
 * Points nearer than NEAR h to a face are left out. Where h is a function of place, lattices of a / 2^k follow each
 * other, coarse ones first, in cubes that may have sizes so small. A point is taken when none that was taken is nearer
 * than APART h. A block whose only points are its corners gets its centroid. */
#include "geometry/zone_inside.h"

#include "base/random.h"

#include <talus/vmath.h>

/* Constant: how near a face a point may be, and graded ones each other, in parts of the wanted edge. A point just there
 * is taken, whatever its rounding. */
#define NEAR (0.5 * (1 - 1e-7))
#define APART (0.8 * (1 - 1e-7))
/* Constant: side of the lattice's cubes for edges of 1. */
#define BODY_CENTRED 1.122
/* Cost only: a cube is divided where the wanted edge at its centre is less than this times its side. */
#define WORTH 1.8
/* Limit: lattices of a block. */
#define MOST_LEVELS 16

static uint64_t key_of(uint32_t level, int64_t i, int64_t j, int64_t k)
{
    return tl_key(tl_key(tl_key(tl_mix64(0x696e73696465u + level), (uint64_t)i), (uint64_t)j), (uint64_t)k);
}

/* The bounds of the corners. */
static tl_bounds bounds_of(const tl_zone_points *p)
{
    tl_bounds b = {p->place[0], p->place[0]};
    for (uint32_t v = 1; v < p->corner_end; v++) {
        b.min = tl_v3_min(b.min, p->place[v]);
        b.max = tl_v3_max(b.max, p->place[v]);
    }
    return b;
}

/* The part of a row along x that is farther than `margin` from all faces. */
static void clip_row(const tl_zone_points *p, double y, double z, double margin, double *from, double *to)
{
    *from = -INFINITY;
    *to = INFINITY;
    for (uint32_t f = 0; f < p->poly->face_count; f++) {
        const tl_vec3 n = p->plane[f].normal;
        const double rest = p->plane[f].offset - margin - n.y * y - n.z * z;
        if (n.x > 0)
            *to = fmin(*to, rest / n.x);
        else if (n.x < 0)
            *from = fmax(*from, rest / n.x);
        else if (rest < 0)
            *to = -INFINITY;
    }
}

/* ---- one size ---- */

static bool lay_row(tl_zone_points *p, double a, int64_t j, int64_t k, double shift)
{
    const double h = p->zoning->edge, y = p->centroid.y + ((double)j + shift) * a;
    const double z = p->centroid.z + ((double)k + shift) * a;
    double from, to;
    clip_row(p, y, z, NEAR * h, &from, &to);
    const double last = floor((to - p->centroid.x) / a - shift);
    for (double i = ceil((from - p->centroid.x) / a - shift); i <= last; i++) {
        const uint64_t key = key_of(shift > 0, (int64_t)i, j, k);
        if (!tl_zone_points_add(p, tl_v3(p->centroid.x + (i + shift) * a, y, z), h, key))
            return false;
    }
    return true;
}

static bool lay_lattice(tl_zone_points *p)
{
    const double a = BODY_CENTRED * p->zoning->edge;
    const tl_bounds b = bounds_of(p);
    const int64_t first_j = (int64_t)floor((b.min.y - p->centroid.y) / a);
    const int64_t last_j = (int64_t)ceil((b.max.y - p->centroid.y) / a);
    const int64_t first_k = (int64_t)floor((b.min.z - p->centroid.z) / a);
    const int64_t last_k = (int64_t)ceil((b.max.z - p->centroid.z) / a);
    for (int64_t k = first_k; k <= last_k; k++)
        for (int half = 0; half < 2; half++)
            for (int64_t j = first_j; j <= last_j; j++)
                if (!lay_row(p, a, j, k, 0.5 * half))
                    return false;
    return true;
}

/* ---- a function of place ---- */

/* A lattice among finer and coarser ones. */
typedef struct graded {
    tl_zone_points *points;
    tl_zone_near *near;
    tl_error *error;
    uint32_t level; /* whose points are tried now */
    double side;    /* of the cubes of level 0 */
    double finest;  /* the smallest wanted edge that was found */
} graded;

static tl_status size_of(graded *g, tl_vec3 place, double *size)
{
    const tl_vec3 real = tl_zone_out_of_frame(g->points, place);
    *size = tl_zoning_size(g->points->zoning, real);
    g->finest = fmin(g->finest, *size);
    return tl_zone_size_check(*size, real, g->error);
}

static bool is_inside(const tl_zone_points *p, tl_vec3 place, double margin)
{
    for (uint32_t f = 0; f < p->poly->face_count; f++)
        if (tl_v3_dot(p->plane[f].normal, place) > p->plane[f].offset - margin)
            return false;
    return true;
}

static tl_status try_point(graded *g, tl_vec3 place, uint64_t key)
{
    tl_zone_points *p = g->points;
    double size;
    if (!is_inside(p, place, 0))
        return TL_OK;
    const tl_status status = size_of(g, place, &size);
    if (status || !is_inside(p, place, NEAR * size) || tl_zone_near_any(g->near, place, APART * size))
        return status;
    return tl_zone_near_add(g->near, g->level, place) && tl_zone_points_add(p, place, size, key)
               ? TL_OK
               : tl_fail_memory(g->error);
}

/* Tries the points of a cube's lower corner and centre, or those of the cubes in it. */
static tl_status try_cube(graded *g, uint32_t level, const int64_t cell[3])
{
    const double side = ldexp(g->side, -(int)level);
    const tl_vec3 c = g->points->centroid;
    const tl_vec3 low = tl_v3(c.x + (double)cell[0] * side, c.y + (double)cell[1] * side, c.z + (double)cell[2] * side);
    const tl_vec3 middle = tl_v3_add(low, tl_v3(0.5 * side, 0.5 * side, 0.5 * side));
    if (level == g->level) {
        const tl_status status = try_point(g, low, key_of(2 * level, cell[0], cell[1], cell[2]));
        return status ? status : try_point(g, middle, key_of(2 * level + 1, cell[0], cell[1], cell[2]));
    }
    double size;
    if (!is_inside(g->points, middle, -side)) /* no point of the cube is farther than 0.87 sides from its middle */
        return TL_OK;
    tl_status status = size_of(g, middle, &size);
    if (status || size > WORTH * side)
        return status;
    for (int i = 0; !status && i < 8; i++) {
        const int64_t part[3] = {2 * cell[0] + (i & 1), 2 * cell[1] + (i >> 1 & 1), 2 * cell[2] + (i >> 2 & 1)};
        status = try_cube(g, level + 1, part);
    }
    return status;
}

static tl_status try_level(graded *g)
{
    const tl_bounds b = bounds_of(g->points);
    const tl_vec3 c = g->points->centroid;
    int64_t first[3], last[3], cell[3];
    const double low[3] = {b.min.x - c.x, b.min.y - c.y, b.min.z - c.z};
    const double high[3] = {b.max.x - c.x, b.max.y - c.y, b.max.z - c.z};
    for (int i = 0; i < 3; i++) {
        first[i] = (int64_t)floor(low[i] / g->side);
        last[i] = (int64_t)ceil(high[i] / g->side);
    }
    tl_status status = TL_OK;
    for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++)
        for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++)
            for (cell[0] = first[0]; !status && cell[0] <= last[0]; cell[0]++)
                status = try_cube(g, 0, cell);
    return status;
}

static tl_status lay_graded(tl_zone_points *p, tl_zone_near *near, tl_error *error)
{
    graded g = {.points = p, .near = near, .error = error, .finest = INFINITY};
    double most = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        g.finest = fmin(g.finest, p->size[i]);
        most = fmax(most, p->size[i]);
    }
    g.side = BODY_CENTRED * fmin(most, p->extent);
    if (!tl_zone_near_begin(near, g.side))
        return tl_fail_memory(error);
    tl_status status = TL_OK;
    double side = g.side;
    for (; !status && g.level < MOST_LEVELS && WORTH * side > g.finest; g.level++, side *= 0.5)
        status = try_level(&g);
    return status;
}

tl_status tl_zone_inside_lay(tl_zone_points *p, tl_zone_near *near, tl_error *error)
{
    tl_status status = TL_OK;
    if (p->zoning->size)
        status = lay_graded(p, near, error);
    else if (!lay_lattice(p))
        status = tl_fail_memory(error);
    if (status || p->count > p->corner_end)
        return status;
    const double size = tl_zoning_size(p->zoning, tl_zone_out_of_frame(p, p->centroid));
    return tl_zone_points_add(p, p->centroid, size, key_of(0, 0, 0, 0)) ? TL_OK : tl_fail_memory(error);
}
