/* near_walls.c - see near_walls.h.
 *
 * Between a face of A and one of C, a few centimetres apart, may lie the tip of a wedge or a thin slab B. Then A faces
 * B and B faces C. A and C face each other only beside B. So two polygons on one wall are compared: that with the
 * smaller opening keeps the common area, if its other block is as thin as the difference. Blocks side by side that
 * press into each other have a common area as well, but are thicker. All is seen along the mean normal of the farther
 * polygon. Openings are linear over a polygon, so they are compared at the centroid of the common area. */
#include "element/near_walls.h"

#include "base/table.h"
#include "geometry/point2.h"
#include "model/model.h"

#include <stdlib.h>
#include <string.h>

/* Tolerance: thickness of what lies between two walls over their distance: walls that are pressed overlap. Test:
 * lua/test_water_between, lua/test_drawdown. */
#define MOST_DEPTH 2.0

/* A polygon that lies on a wall of a block. */
typedef struct use {
    size_t flat, wall;
} use;

/* Convex polygons, one after the other. */
typedef struct pieces {
    tl_point2 *at;
    size_t *end;
    size_t count, capacity, end_capacity;
} pieces;

typedef struct work {
    tl_placing *p;
    const tl_flats *flats;
    const tl_wall_sides *sides;
    use *uses; /* by flats */
    size_t use_count;
    pieces now, next;
    tl_point2 *scratch[3];
    size_t scratch_capacity[3];
    tl_element_wall *wall; /* what is left */
    tl_vec3 *corner;
    size_t wall_count, wall_capacity, corner_count, corner_capacity;
} work;

/* A polygon as it is seen along its mean normal. */
typedef struct view {
    const tl_element_wall *wall;
    tl_vec3 at, x, y, n;  /* n from the first side to the second */
    double least, hidden; /* least area of a polygon, and of what others hide of it */
} view;

/* ---------------------------------------------------------------- one polygon ------------ */

static view view_of(const work *k, const tl_element_wall *w)
{
    const tl_model *m = k->p->m;
    const tl_vec3 n = tl_v3_unit(tl_v3_sub(w->normal[0], w->normal[1])), x = tl_v3_perpendicular(n);
    const double size =
        fmin(m->blocks.size[tl_block_row_quiet(m, w->block[0])], m->blocks.size[tl_block_row_quiet(m, w->block[1])]);
    return (view){.wall = w,
                  .at = w->corners[0][0],
                  .x = x,
                  .y = tl_v3_cross(n, x),
                  .n = n,
                  .least = TL_WALL_NO_AREA * size * size,
                  .hidden = TL_WALL_LEAST_HIDDEN * size * size};
}

static tl_point2 seen(const view *v, tl_vec3 x)
{
    const tl_vec3 d = tl_v3_sub(x, v->at);
    return (tl_point2){tl_v3_dot(d, v->x), tl_v3_dot(d, v->y)};
}

/* Where the line along n through a point meets a wall of a polygon. */
static tl_vec3 on_wall(const tl_element_wall *w, int side, tl_vec3 n, tl_vec3 x)
{
    const double t = tl_v3_dot(w->normal[side], tl_v3_sub(w->corners[side][0], x)) / tl_v3_dot(w->normal[side], n);
    return tl_v3_madd(x, t, n);
}

/* From a wall to the other one. */
static tl_vec3 way_across(const tl_element_wall *w, int side)
{
    return tl_v3_unit(tl_v3_sub(w->normal[side], w->normal[1 - side]));
}

/* The opening of a polygon at a point of one of its walls. */
static double opening_at(const tl_element_wall *w, int side, tl_vec3 x)
{
    const tl_vec3 n = way_across(w, side);
    return tl_v3_dot(n, tl_v3_sub(on_wall(w, 1 - side, n, x), x));
}

/* Whether the other block of a polygon lies between a point of its wall and another wall, so far away. */
static bool lies_between(const work *k, const tl_element_wall *w, int side, tl_vec3 x, double far)
{
    const tl_vec3 n = way_across(w, side), from = on_wall(w, 1 - side, n, x), origin = k->p->m->origin;
    const double beyond = far - opening_at(w, side, x);
    const uint32_t row = tl_block_row_quiet(k->p->m, w->block[1 - side]);
    return beyond > 0 && tl_flats_depth(k->flats, row, tl_v3_sub(from, origin), n) < MOST_DEPTH * beyond;
}

/* Twice the area of a polygon, below 0 of one that is clockwise, and its centroid. */
static double twice_area(const tl_point2 *q, size_t count, tl_point2 *centroid)
{
    double twice = 0, x = 0, y = 0;
    for (size_t i = 2; i < count; i++) {
        const double part = tl_cross2(q[0], q[i - 1], q[i]);
        twice += part;
        x += part * ((q[i - 1].x - q[0].x) + (q[i].x - q[0].x)) / 3;
        y += part * ((q[i - 1].y - q[0].y) + (q[i].y - q[0].y)) / 3;
    }
    *centroid = count > 0 && twice != 0 ? (tl_point2){q[0].x + x / twice, q[0].y + y / twice} : (tl_point2){0, 0};
    return twice;
}

/* The corners of a polygon on one of its walls, clockwise in a view. */
static void outline(const view *v, const tl_element_wall *of, int side, tl_point2 *out)
{
    tl_point2 centroid;
    const size_t count = of->corner_count;
    for (size_t i = 0; i < count; i++)
        out[i] = seen(v, of->corners[side][i]);
    if (twice_area(out, count, &centroid) <= 0)
        return;
    for (size_t i = 0; 2 * i < count - 1; i++) {
        const tl_point2 swap = out[i];
        out[i] = out[count - 1 - i];
        out[count - 1 - i] = swap;
    }
}

double tl_flats_depth(const tl_flats *f, uint32_t row, tl_vec3 x, tl_vec3 n)
{
    double depth = INFINITY;
    for (size_t k = f->first[row]; k < f->first[row + 1]; k++) {
        const tl_plane plane = f->at[k].plane;
        const double along = tl_v3_dot(plane.normal, n), room = plane.offset - tl_v3_dot(plane.normal, x);
        if (along > 0 && room > 0)
            depth = fmin(depth, room / along);
    }
    return depth;
}

/* ---------------------------------------------------------------- pieces ----------------- */

static bool add_piece(pieces *to, const tl_point2 *q, size_t count, double least)
{
    tl_point2 centroid;
    if (count < 3 || !(0.5 * twice_area(q, count, &centroid) > least))
        return true;
    const size_t begin = to->count ? to->end[to->count - 1] : 0;
    if (!tl_grow(&to->at, &to->capacity, begin + count, sizeof *to->at) ||
        !tl_grow(&to->end, &to->end_capacity, to->count + 1, sizeof *to->end))
        return false;
    memcpy(to->at + begin, q, count * sizeof *q);
    to->end[to->count++] = begin + count;
    return true;
}

/* Room in the scratch for the corners of any piece that is cut by an outline. */
static bool reserve(work *k, size_t corners, size_t sides)
{
    for (int i = 0; i < 3; i++)
        if (!tl_grow(&k->scratch[i], &k->scratch_capacity[i], 2 * (corners + sides), sizeof *k->scratch[i]))
            return false;
    return true;
}

/* Takes a clockwise outline, which is scratch[2], from all pieces. */
static bool take_away(work *k, size_t sides, double least)
{
    k->next.count = 0;
    for (size_t i = 0, begin = 0; i < k->now.count; begin = k->now.end[i++]) {
        size_t count = k->now.end[i] - begin;
        if (!reserve(k, count, sides))
            return false;
        const tl_point2 *by = k->scratch[2], *whole = k->now.at + begin;
        tl_point2 *rest = k->scratch[0], *part = k->scratch[1], centroid;
        memcpy(rest, whole, count * sizeof *rest);
        const size_t hidden = tl_polygon_common(&rest, &part, count, by, sides);
        if (!(0.5 * twice_area(rest, hidden, &centroid) > least)) {
            if (!add_piece(&k->next, whole, count, least))
                return false;
            continue;
        }
        memcpy(rest, whole, count * sizeof *rest);
        for (size_t e = 0; e < sides && count; e++) {
            const tl_point2 from = by[e], to = by[(e + 1) % sides];
            if (!add_piece(&k->next, part, tl_polygon_left(rest, count, from, to, part), least))
                return false;
            count = tl_polygon_left(rest, count, to, from, part);
            tl_point2 *swap = rest;
            rest = part;
            part = swap;
        }
    }
    const pieces swap = k->now;
    k->now = k->next;
    k->next = swap;
    return true;
}

/* ---------------------------------------------------------------- pairs ------------------ */

/* Takes what another polygon on the same wall hides from a polygon; *cut tells whether there is such. */
static bool hide(work *k, const view *v, int side, const tl_element_wall *other, int other_side, bool *cut)
{
    const size_t mine = v->wall->corner_count, its = other->corner_count;
    if (!reserve(k, mine, its))
        return false;
    for (size_t i = 0; i < mine; i++)
        k->scratch[0][i] = seen(v, v->wall->corners[0][i]);
    outline(v, other, other_side, k->scratch[2]);
    tl_point2 *now = k->scratch[0], *next = k->scratch[1], centroid;
    const size_t count = tl_polygon_common(&now, &next, mine, k->scratch[2], its);
    if (!(0.5 * twice_area(now, count, &centroid) > v->hidden))
        return true;
    const tl_vec3 between = tl_v3_madd(tl_v3_madd(v->at, centroid.x, v->x), centroid.y, v->y);
    const tl_vec3 x = on_wall(v->wall, side, v->n, between);
    if (!lies_between(k, other, other_side, x, opening_at(v->wall, side, x)))
        return true;
    *cut = true;
    return take_away(k, its, v->least);
}

static int compare_uses(const void *left, const void *right)
{
    const use *a = left, *b = right;
    if (a->flat != b->flat)
        return a->flat < b->flat ? -1 : 1;
    return (a->wall > b->wall) - (a->wall < b->wall);
}

static bool list_uses(work *k)
{
    k->use_count = 2 * k->p->wall_count;
    k->uses = malloc((k->use_count + 1) * sizeof *k->uses);
    for (size_t i = 0; k->uses && i < k->use_count; i++)
        k->uses[i] = (use){k->sides[i / 2].flat[i % 2], i / 2};
    if (k->uses && k->use_count > 1)
        qsort(k->uses, k->use_count, sizeof *k->uses, compare_uses);
    return k->uses != NULL;
}

static size_t first_use(const work *k, size_t flat)
{
    size_t low = 0, high = k->use_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (k->uses[middle].flat < flat)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* ---------------------------------------------------------------- what is left ----------- */

static bool put(work *k, const tl_element_wall *w, size_t count)
{
    if (!tl_grow(&k->wall, &k->wall_capacity, k->wall_count + 1, sizeof *k->wall) ||
        !tl_grow(&k->corner, &k->corner_capacity, k->corner_count + 2 * count, sizeof *k->corner))
        return false;
    k->wall[k->wall_count] = *w;
    k->wall[k->wall_count++].corner_count = count;
    k->corner_count += 2 * count;
    return true;
}

/* A polygon as it was. */
static bool put_whole(work *k, const tl_element_wall *w)
{
    const size_t count = w->corner_count, begin = k->corner_count;
    if (!put(k, w, count))
        return false;
    for (int side = 0; side < 2; side++)
        memcpy(k->corner + begin + (size_t)side * count, w->corners[side], count * sizeof *k->corner);
    return true;
}

/* What is left of one that others hide, and its area and mean opening. */
static bool put_pieces(work *k, const view *v)
{
    const tl_element_wall *w = v->wall;
    for (size_t i = 0, first = 0; i < k->now.count; first = k->now.end[i++]) {
        const size_t count = k->now.end[i] - first, begin = k->corner_count;
        const tl_point2 *q = k->now.at + first;
        tl_point2 centroid;
        if (!put(k, w, count))
            return false;
        for (size_t c = 0; c < 2 * count; c++) {
            const tl_point2 *from = &q[c % count];
            const tl_vec3 x = tl_v3_madd(tl_v3_madd(v->at, from->x, v->x), from->y, v->y);
            k->corner[begin + c] = on_wall(w, c < count ? 0 : 1, v->n, x);
        }
        tl_element_wall *made = &k->wall[k->wall_count - 1];
        made->area = 0.5 * twice_area(q, count, &centroid);
        const tl_vec3 middle = tl_v3_madd(tl_v3_madd(v->at, centroid.x, v->x), centroid.y, v->y);
        made->opening = opening_at(w, 0, on_wall(w, 0, v->n, middle));
    }
    return true;
}

static bool keep_near(work *k, size_t wall)
{
    const view v = view_of(k, &k->p->wall[wall]);
    bool cut = false;
    k->now.count = 0;
    if (!reserve(k, v.wall->corner_count, 0))
        return false;
    for (size_t i = 0; i < v.wall->corner_count; i++)
        k->scratch[0][i] = seen(&v, v.wall->corners[0][i]);
    if (!add_piece(&k->now, k->scratch[0], v.wall->corner_count, 0))
        return false;
    for (int side = 0; side < 2; side++) {
        const size_t flat = k->sides[wall].flat[side];
        for (size_t i = first_use(k, flat); i < k->use_count && k->uses[i].flat == flat; i++) {
            const size_t other = k->uses[i].wall;
            const int other_side = k->sides[other].flat[0] == flat ? 0 : 1;
            if (other != wall && !hide(k, &v, side, &k->p->wall[other], other_side, &cut))
                return false;
        }
    }
    return cut ? put_pieces(k, &v) : put_whole(k, v.wall);
}

bool tl_walls_keep_near(tl_placing *p, const tl_flats *flats, const tl_wall_sides *sides)
{
    work k = {.p = p, .flats = flats, .sides = sides};
    bool enough = list_uses(&k);
    for (size_t i = 0; i < p->wall_count && enough; i++)
        if (sides[i].meant)
            enough = keep_near(&k, i);
    if (enough) {
        void *const old[] = {p->wall, p->wall_corner};
        p->wall = k.wall;
        p->wall_corner = k.corner;
        p->wall_capacity = k.wall_capacity;
        p->wall_corner_capacity = k.corner_capacity;
        p->wall_count = k.wall_count;
        p->wall_corner_count = k.corner_count;
        k.wall = old[0];
        k.corner = old[1];
    }
    void *const owned[] = {k.uses,       k.now.at,     k.now.end,    k.next.at, k.next.end,
                           k.scratch[0], k.scratch[1], k.scratch[2], k.wall,    k.corner};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
    return enough;
}
