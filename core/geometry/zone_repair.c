/* zone_repair.c - points of zones are moved until no zone is flatter than it must be.
 *
 * A zone is as good as its share: its least altitude over the wanted edge.
 *
 *     altitude = 3 V / A_most = |(b - a) . ((c - a) x (d - a))| / most |(b - a) x (c - a)| of its triangles
 *
 * First, ROUNDS times, each point inside goes to the mean of the centroids of its zones by volume. (Chen 2004, "Mesh
 * smoothing schemes based on optimal Delaunay triangulations".) It stays where that makes the worst of them worse,
 * unless all are good. Then points of zones whose share is below GOOD try places at random, by keys, ever nearer. They
 * take each that makes the worst of their zones better. Points on free faces may go along them. Between rounds, edges
 * and sides of zones that stay flat are flipped (zone_flips.c). */
#include "geometry/zone_repair.h"

#include "base/random.h"
#include "base/table.h"

#include <stdlib.h>
#include <talus/vmath.h>

/* Constant: the share from which on a zone is good, and that which moves to means may leave. */
#define GOOD 0.4
#define FINE 0.42
/* Constant: the share below which a zone may get a point more. */
#define LOCKED 0.01
/* Constant: rounds of means, of random moves, and how many of these are followed by flips. */
#define ROUNDS 4
#define RANDOM_ROUNDS 10
#define FLIP_ROUNDS 4
/* Constant: places a point tries in a round, the farthest in parts of the wanted edge, and how many of them before the
 * distance is halved. */
#define TRIES 16
#define FARTHEST 0.3
#define HALVED 4
/* Cost only: a point goes to its mean only when that is farther than this, in parts of the wanted edge. */
#define MOVES 1e-3

typedef struct repair {
    tl_zone_points *points;
    tl_zone_lists *lists;
    tl_zone_repair *space;
} repair;

static double share_of(const repair *r, uint32_t zone)
{
    return tl_zone_share(r->points, r->lists->zone[zone]);
}

/* ---- zones of points ---- */

static bool list_zones(repair *r)
{
    tl_zone_repair *s = r->space;
    const uint32_t count = r->points->count;
    if (!tl_grow(&s->first, &s->first_room, (size_t)count + 2, sizeof *s->first) ||
        !tl_grow(&s->zone_of, &s->zone_of_room, 4 * (size_t)r->lists->count, sizeof *s->zone_of) ||
        !tl_grow(&s->share, &s->share_room, r->lists->count, sizeof *s->share))
        return false;
    for (uint32_t i = 0; i < count + 2; i++)
        s->first[i] = 0;
    for (uint32_t z = 0; z < r->lists->count; z++)
        for (int k = 0; k < 4; k++)
            s->first[r->lists->zone[z][k] + 2]++;
    for (uint32_t i = 0; i < count; i++)
        s->first[i + 2] += s->first[i + 1];
    for (uint32_t z = 0; z < r->lists->count; z++)
        for (int k = 0; k < 4; k++)
            s->zone_of[s->first[r->lists->zone[z][k] + 1]++] = z;
    for (uint32_t z = 0; z < r->lists->count; z++)
        s->share[z] = share_of(r, z);
    return true;
}

/* The worst share of a point's zones as they are known. */
static double worst_known(const repair *r, uint32_t point)
{
    const tl_zone_repair *s = r->space;
    double worst = INFINITY;
    for (uint32_t i = s->first[point]; i < s->first[point + 1]; i++)
        worst = fmin(worst, s->share[s->zone_of[i]]);
    return worst;
}

/* Moves a point if the worst share of its zones is then more than `least`; else it stays. */
static bool moves(repair *r, uint32_t point, tl_vec3 to, double least)
{
    const tl_zone_repair *s = r->space;
    const tl_vec3 from = r->points->place[point];
    r->points->place[point] = to;
    for (uint32_t i = s->first[point]; i < s->first[point + 1]; i++)
        if (!(share_of(r, s->zone_of[i]) > least)) {
            r->points->place[point] = from;
            return false;
        }
    for (uint32_t i = s->first[point]; i < s->first[point + 1]; i++)
        s->share[s->zone_of[i]] = share_of(r, s->zone_of[i]);
    return true;
}

/* ---- means ---- */

/* From a point to the mean of its zones' centroids, weighted by volume. */
static tl_vec3 to_mean(const repair *r, uint32_t point)
{
    const tl_zone_repair *s = r->space;
    const tl_vec3 *x = r->points->place, at = x[point];
    tl_vec3 sum = {0, 0, 0};
    double volume = 0;
    for (uint32_t i = s->first[point]; i < s->first[point + 1]; i++) {
        const uint32_t *v = r->lists->zone[s->zone_of[i]];
        const tl_vec3 a = tl_v3_sub(x[v[0]], at), b = tl_v3_sub(x[v[1]], at), c = tl_v3_sub(x[v[2]], at);
        const tl_vec3 d = tl_v3_sub(x[v[3]], at);
        const double six = tl_v3_dot(tl_v3_sub(b, a), tl_v3_cross(tl_v3_sub(c, a), tl_v3_sub(d, a)));
        volume += six;
        sum = tl_v3_madd(sum, six, tl_v3_add(tl_v3_add(a, b), tl_v3_add(c, d)));
    }
    return volume > 0 ? tl_v3_scale(1 / (4 * volume), sum) : (tl_vec3){0, 0, 0};
}

static void move_to_means(repair *r)
{
    for (uint32_t i = r->points->face_end; i < r->points->count; i++) {
        const tl_vec3 step = to_mean(r, i);
        const double size = r->points->size[i];
        if (tl_v3_norm2(step) > MOVES * MOVES * size * size)
            moves(r, i, tl_v3_add(r->points->place[i], step), fmin(worst_known(r, i), FINE));
    }
}

/* ---- random moves ---- */

/* The free face of a point inside it; UINT32_MAX: none. */
static uint32_t free_face(const tl_zone_points *p, uint32_t point)
{
    if (!p->zoning->face_free || point < p->edge_end || point >= p->face_end)
        return UINT32_MAX;
    const uint32_t face = p->in_face[p->start[point]].face;
    return p->zoning->face_free[face] ? face : UINT32_MAX;
}

/* Lets a point try places until all its zones are good. */
static void try_places(repair *r, uint32_t point, uint32_t round)
{
    const tl_zone_points *p = r->points;
    const uint32_t face = free_face(p, point);
    if (point < p->face_end && face == UINT32_MAX)
        return;
    double worst = worst_known(r, point), distance = FARTHEST * p->size[point];
    const uint64_t key = tl_key(tl_key(tl_mix64(round), point), 0x7a6f6e6573u);
    for (uint32_t try = 0; try < TRIES && worst < GOOD; try++) {
        const uint64_t draw = tl_key(key, try);
        tl_vec3 step = tl_v3(2 * tl_uniform(draw) - 1, 2 * tl_uniform(draw + 1) - 1, 2 * tl_uniform(draw + 2) - 1);
        if (face != UINT32_MAX)
            step = tl_v3_madd(step, -tl_v3_dot(step, p->plane[face].normal), p->plane[face].normal);
        if (moves(r, point, tl_v3_madd(p->place[point], distance, step), worst))
            worst = worst_known(r, point);
        if (try % HALVED == HALVED - 1)
            distance *= 0.5;
    }
}

/* One round; whether a zone is still flat. */
static bool move_at_random(repair *r, uint32_t round)
{
    bool flat = false;
    for (uint32_t z = 0; z < r->lists->count; z++)
        for (int k = 0; k < 4 && r->space->share[z] < GOOD; k++) {
            flat = true;
            try_places(r, r->lists->zone[z][k], round);
        }
    return flat;
}

/* Changes zones that have stayed flat after a round. */
static bool change_zones(repair *r, uint32_t round)
{
    uint32_t flips = 0, splits = 0;
    if (round < FLIP_ROUNDS && !tl_zone_flips_make(r->points, r->lists, GOOD, &flips))
        return false;
    if (round >= FLIP_ROUNDS - 2 && round < FLIP_ROUNDS && !tl_zone_splits_make(r->points, r->lists, LOCKED, &splits))
        return false;
    return flips + splits == 0 || list_zones(r);
}

/* Random moves and changes of zones in turn, until no zone is flat. */
static bool mend(repair *r)
{
    for (uint32_t round = 0; round < RANDOM_ROUNDS; round++) {
        if (!move_at_random(r, round))
            return true;
        if (!change_zones(r, round))
            return false;
    }
    return true;
}

tl_status tl_zone_repair_make(tl_zone_repair *space, tl_zone_points *points, tl_zone_lists *lists, tl_error *error)
{
    repair r = {points, lists, space};
    if (!list_zones(&r))
        return tl_fail_memory(error);
    for (int round = 0; round < ROUNDS; round++)
        move_to_means(&r);
    return mend(&r) ? TL_OK : tl_fail_memory(error);
}

void tl_zone_repair_free(tl_zone_repair *s)
{
    free(s->first);
    free(s->zone_of);
    free(s->share);
    *s = (tl_zone_repair){0};
}
