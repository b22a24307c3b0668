/* zone_flips.c - flat zones give way to others of the same points.
 *
 * The n zones around an edge a b fill a ring of points p_0 ... p_{n-1}. The edge goes, and 2 (n - 2) zones fill the
 * same space: each triangle of the ring with a, and with b. All triangulations of the ring are tried:
 *
 *     best(i, j) = most over k between of   min(best(i, k), best(k, j), worst of (p_i p_k p_j with a, with b))
 *
 * (Klincsek 1980; Freitag and Ollivier-Gooch 1997). The other way round, two zones with a side in common become three
 * around the edge of their far corners. Either is done when the worst share of the zones is
 * positive then and rises by GAIN.
 *
 * Zones with all corners on the surface may stay flat. They get a point near the middle of an edge, which divides all
 * zones around that. */
#include "geometry/zone_flips.h"

#include "base/random.h"
#include "base/table.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define NONE UINT32_MAX

/* Limit: zones around an edge that goes. */
#define MOST_RING 7
#define MOST_MADE (2 * (MOST_RING - 2))
/* Tolerance: what a flip must gain in share, so that none is undone. */
#define GAIN 2e-3
/* Limit: zones around an edge that gets a point. */
#define MOST_SPLIT 24
/* Constant: places that are tried for such a point, and how many of them before the distance is halved. */
#define SPLIT_TRIES 40
#define SPLIT_HALVED 5
/* Constant: how many times as good the worst of the zones must become. */
#define SPLIT_GAIN 3

typedef struct flips {
    const tl_zone_points *points;
    tl_zone_lists *lists;
} flips;

/* The zones around an edge, and the points of the ring: zone k has a, b, p_k, p_{k+1} as its corners. */
typedef struct ring {
    uint32_t a, b, count;
    uint32_t point[MOST_RING], zone[MOST_RING];
    double best[MOST_RING][MOST_RING];
    int by[MOST_RING][MOST_RING];
} ring;

/* The zones around an edge that gets a point. */
typedef struct split_ring {
    uint32_t a, b, count, zone[MOST_SPLIT];
} split_ring;

/* What takes the place of some zones. */
typedef struct change {
    uint32_t old[MOST_RING], old_count;
    uint32_t made[MOST_MADE][4], made_count;
} change;

bool tl_zone_lists_room(tl_zone_lists *l, uint32_t count)
{
    return tl_grow(&l->zone, &l->zone_room, count, sizeof *l->zone) &&
           tl_grow(&l->beside, &l->beside_room, count, sizeof *l->beside);
}

void tl_zone_lists_free(tl_zone_lists *l)
{
    free(l->zone);
    free(l->beside);
    *l = (tl_zone_lists){0};
}

static double share(const flips *f, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return tl_zone_share(f->points, (uint32_t[]){a, b, c, d});
}

static uint32_t place_of(const uint32_t corner[4], uint32_t point)
{
    return corner[0] == point ? 0 : corner[1] == point ? 1 : corner[2] == point ? 2 : 3;
}

/* ---- zones in the place of others ---- */

/* Whether two zones have all corners but one each in common. */
static bool share_side(const uint32_t *one, uint32_t i, const uint32_t *other, uint32_t k)
{
    for (uint32_t m = 0; m < 4; m++)
        if (m != i) {
            const uint32_t at = place_of(other, one[m]);
            if (other[at] != one[m] || at == k)
                return false;
        }
    return true;
}

/* What lies beyond a side of a new zone: another new one, or what was beyond the old ones. */
static uint32_t find_beside(const flips *f, const change *c, const uint32_t *number, uint32_t made, uint32_t i,
                            uint32_t old[MOST_RING][4], uint32_t beyond[MOST_RING][4])
{
    for (uint32_t m = 0; m < c->made_count; m++)
        for (uint32_t k = 0; m != made && k < 4; k++)
            if (share_side(c->made[made], i, c->made[m], k))
                return number[m];
    for (uint32_t m = 0; m < c->old_count; m++)
        for (uint32_t k = 0; k < 4; k++) {
            if (!share_side(c->made[made], i, old[m], k))
                continue;
            const uint32_t outer = beyond[m][k];
            for (uint32_t n = 0; outer != NONE && n < 4; n++)
                if (share_side(f->lists->zone[outer], n, old[m], k))
                    f->lists->beside[outer][n] = number[made];
            return outer;
        }
    return NONE;
}

/* Puts new zones in the place of old ones. What is left over has no corners. */
static bool make_change(flips *f, const change *c)
{
    tl_zone_lists *l = f->lists;
    uint32_t old[MOST_RING][4], beyond[MOST_RING][4], number[MOST_MADE];
    const uint32_t more = c->made_count > c->old_count ? c->made_count - c->old_count : 0;
    if (!tl_zone_lists_room(l, l->count + more))
        return false;
    for (uint32_t m = 0; m < c->old_count; m++) {
        memcpy(old[m], l->zone[c->old[m]], sizeof old[m]);
        memcpy(beyond[m], l->beside[c->old[m]], sizeof beyond[m]);
        l->zone[c->old[m]][0] = NONE;
    }
    for (uint32_t m = 0; m < c->made_count; m++)
        number[m] = m < c->old_count ? c->old[m] : l->count++;
    for (uint32_t m = 0; m < c->made_count; m++)
        memcpy(l->zone[number[m]], c->made[m], sizeof c->made[m]);
    for (uint32_t m = 0; m < c->made_count; m++)
        for (uint32_t i = 0; i < 4; i++)
            l->beside[number[m]][i] = find_beside(f, c, number, m, i, old, beyond);
    return true;
}

/* ---- an edge goes ---- */

/* Finds the ring around the edge between corners i and k of a zone. False on the surface, or where it is too long. */
static bool find_ring(const flips *f, uint32_t zone, uint32_t i, uint32_t k, ring *r)
{
    static const uint8_t rest[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                          {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                          {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                          {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
    const uint32_t(*corner)[4] = (const uint32_t(*)[4])f->lists->zone;
    r->a = corner[zone][i];
    r->b = corner[zone][k];
    r->count = 0;
    uint32_t here = zone, from = corner[zone][rest[i][k][0]], to = corner[zone][rest[i][k][1]];
    do {
        if (r->count == MOST_RING)
            return false;
        r->zone[r->count] = here;
        r->point[r->count++] = from;
        here = f->lists->beside[here][place_of(corner[here], from)];
        if (here == NONE)
            return false;
        /* the corner of the next zone that is neither on the edge nor shared */
        from = to;
        for (uint32_t m = 0; m < 4; m++)
            if (corner[here][m] != r->a && corner[here][m] != r->b && corner[here][m] != from)
                to = corner[here][m];
    } while (here != zone);
    return r->count >= 3;
}

/* The worst share of the two zones of a triangle of the ring. */
static double worst_of_two(const flips *f, const ring *r, uint32_t i, uint32_t k, uint32_t j)
{
    const uint32_t *p = r->point;
    const double under = share(f, p[i], p[k], p[j], r->b);
    return under <= 0 ? under : fmin(under, share(f, p[i], p[j], p[k], r->a));
}

/* The best triangulation of the ring, by what its worst zone has. */
static double triangulate(const flips *f, ring *r)
{
    for (uint32_t i = 0; i + 1 < r->count; i++)
        r->best[i][i + 1] = INFINITY;
    for (uint32_t span = 2; span < r->count; span++)
        for (uint32_t i = 0; i + span < r->count; i++) {
            const uint32_t j = i + span;
            r->best[i][j] = -INFINITY;
            for (uint32_t k = i + 1; k < j; k++) {
                const double worst = fmin(fmin(r->best[i][k], r->best[k][j]), worst_of_two(f, r, i, k, j));
                if (worst > r->best[i][j])
                    r->best[i][j] = worst, r->by[i][j] = (int)k;
            }
        }
    return r->best[0][r->count - 1];
}

static void list_made(const ring *r, uint32_t i, uint32_t j, change *c)
{
    if (j < i + 2)
        return;
    const uint32_t k = (uint32_t)r->by[i][j], *p = r->point;
    memcpy(c->made[c->made_count++], (uint32_t[]){p[i], p[k], p[j], r->b}, sizeof c->made[0]);
    memcpy(c->made[c->made_count++], (uint32_t[]){p[i], p[j], p[k], r->a}, sizeof c->made[0]);
    list_made(r, i, k, c);
    list_made(r, k, j, c);
}

/* Takes the edge between two corners of a zone away, if that is better. */
static bool take_edge(flips *f, uint32_t zone, uint32_t i, uint32_t k, bool *done)
{
    ring r;
    if (!find_ring(f, zone, i, k, &r))
        return true;
    double worst = INFINITY;
    for (uint32_t m = 0; m < r.count; m++)
        worst = fmin(worst, tl_zone_share(f->points, f->lists->zone[r.zone[m]]));
    const double best = triangulate(f, &r);
    if (!(best > 0) || best < worst + GAIN)
        return true;
    change c = {.old_count = r.count};
    memcpy(c.old, r.zone, r.count * sizeof *c.old);
    list_made(&r, 0, r.count - 1, &c);
    *done = true;
    return make_change(f, &c);
}

/* ---- a side goes ---- */

/* Takes the side opposite corner i of a zone away: two zones become three, if that is better. */
static bool take_side(flips *f, uint32_t zone, uint32_t i, bool *done)
{
    static const uint8_t side[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    const uint32_t other = f->lists->beside[zone][i], *v = f->lists->zone[zone];
    if (other == NONE)
        return true;
    const uint32_t near = v[i], p[3] = {v[side[i][0]], v[side[i][1]], v[side[i][2]]};
    uint32_t far = NONE;
    for (uint32_t m = 0; m < 4; m++) {
        const uint32_t point = f->lists->zone[other][m];
        if (point != p[0] && point != p[1] && point != p[2])
            far = point;
    }
    const double worst = fmin(tl_zone_share(f->points, v), tl_zone_share(f->points, f->lists->zone[other]));
    change c = {.old = {zone, other}, .old_count = 2, .made_count = 3};
    double best = INFINITY;
    for (uint32_t m = 0; m < 3; m++) {
        memcpy(c.made[m], (uint32_t[]){far, near, p[m], p[(m + 1) % 3]}, sizeof c.made[m]);
        best = fmin(best, tl_zone_share(f->points, c.made[m]));
    }
    if (!(best > 0) || best < worst + GAIN)
        return true;
    *done = true;
    return make_change(f, &c);
}

/* ---- all ---- */

/* Takes an edge or a side of a flat zone away. */
static bool mend(flips *f, uint32_t zone, bool *done)
{
    bool made = true;
    for (uint32_t i = 0; made && !*done && i < 4; i++)
        for (uint32_t k = i + 1; made && !*done && k < 4; k++)
            made = take_edge(f, zone, i, k, done);
    for (uint32_t i = 0; made && !*done && i < 4; i++)
        made = take_side(f, zone, i, done);
    return made;
}

/* Leaves out the places that have no zone any more. */
static bool close_up(tl_zone_lists *l)
{
    uint32_t *number = malloc((l->count + (size_t)1) * sizeof *number), count = 0;
    if (!number)
        return false;
    for (uint32_t z = 0; z < l->count; z++)
        number[z] = l->zone[z][0] == NONE ? NONE : count++;
    for (uint32_t z = 0; z < l->count; z++) {
        if (number[z] == NONE)
            continue;
        memmove(l->zone[number[z]], l->zone[z], sizeof l->zone[z]);
        for (uint32_t i = 0; i < 4; i++)
            l->beside[number[z]][i] = l->beside[z][i] == NONE ? NONE : number[l->beside[z][i]];
    }
    l->count = count;
    free(number);
    return true;
}

bool tl_zone_flips_make(const tl_zone_points *points, tl_zone_lists *lists, double limit, uint32_t *made)
{
    flips f = {points, lists};
    const uint32_t before = lists->count;
    *made = 0;
    for (uint32_t z = 0; z < before; z++) {
        if (lists->zone[z][0] == NONE || tl_zone_share(points, lists->zone[z]) >= limit)
            continue;
        bool done = false;
        if (!mend(&f, z, &done))
            return false;
        *made += done;
    }
    return *made == 0 || close_up(lists);
}

/* ---- a point more ---- */

/* The worst share of the zones around an edge, when each is divided by a point. */
static double worst_divided(const flips *f, const split_ring *r, uint32_t point)
{
    double worst = INFINITY;
    for (uint32_t k = 0; k < r->count; k++) {
        uint32_t v[4];
        memcpy(v, f->lists->zone[r->zone[k]], sizeof v);
        const uint32_t at_a = place_of(v, r->a), at_b = place_of(v, r->b);
        v[at_b] = point;
        worst = fmin(worst, tl_zone_share(f->points, v));
        v[at_b] = r->b;
        v[at_a] = point;
        worst = fmin(worst, tl_zone_share(f->points, v));
    }
    return worst;
}

/* Divides all zones around an edge by a point. */
static bool divide_ring(flips *f, const split_ring *r, uint32_t point)
{
    tl_zone_lists *l = f->lists;
    const uint32_t first = l->count;
    if (!tl_zone_lists_room(l, first + r->count))
        return false;
    l->count += r->count;
    for (uint32_t k = 0; k < r->count; k++) {
        const uint32_t zone = r->zone[k], made = first + k;
        uint32_t *v = l->zone[zone], *w = l->zone[made];
        const uint32_t at_a = place_of(v, r->a), at_b = place_of(v, r->b), outer = l->beside[zone][at_a];
        memcpy(w, v, sizeof l->zone[made]);
        v[at_b] = point;
        w[at_a] = point;
        /* beyond the sides that hold the whole edge lie the next and the last of the ring, and their new halves */
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t m = 0;
            while (m < r->count && r->zone[m] != l->beside[zone][i])
                m++;
            l->beside[made][i] = first + m;
        }
        l->beside[zone][at_a] = made;
        l->beside[made][at_b] = zone;
        l->beside[made][at_a] = outer;
        for (uint32_t i = 0; outer != NONE && i < 4; i++)
            if (l->beside[outer][i] == zone)
                l->beside[outer][i] = made;
    }
    return true;
}

/* Finds all zones around the edge between corners i and k of a zone, up to MOST_SPLIT. */
static bool find_split_ring(const flips *f, uint32_t zone, uint32_t i, uint32_t k, split_ring *r)
{
    const uint32_t(*corner)[4] = (const uint32_t(*)[4])f->lists->zone;
    r->a = corner[zone][i];
    r->b = corner[zone][k];
    r->count = 0;
    uint32_t here = zone, leave = NONE;
    for (uint32_t m = 0; m < 4; m++)
        if (m != i && m != k)
            leave = corner[zone][m];
    do {
        if (r->count == MOST_SPLIT)
            return false;
        r->zone[r->count++] = here;
        const uint32_t next = f->lists->beside[here][place_of(corner[here], leave)];
        if (next == NONE)
            return false;
        /* the corner that stays is left next */
        for (uint32_t m = 0; m < 4; m++) {
            const uint32_t point = corner[here][m];
            if (point != r->a && point != r->b && point != leave) {
                leave = point;
                break;
            }
        }
        here = next;
    } while (here != zone);
    return true;
}

/* Puts a point near the middle of an edge, where the worst of its zones would be best. */
static bool split_edge(flips *f, tl_zone_points *p, const split_ring *r, bool *done)
{
    const tl_vec3 a = p->place[r->a], step = tl_v3_sub(p->place[r->b], a), middle = tl_v3_madd(a, 0.5, step);
    double before = INFINITY, best = -INFINITY;
    for (uint32_t k = 0; k < r->count; k++)
        before = fmin(before, tl_zone_share(p, f->lists->zone[r->zone[k]]));
    const uint64_t key = tl_key(tl_key(0x73706c6974u, r->a), r->b);
    const uint32_t point = p->count;
    if (!tl_zone_points_add(p, middle, 0.5 * (p->size[r->a] + p->size[r->b]), key))
        return false;
    tl_vec3 chosen = middle;
    double distance = 0.5 * tl_v3_norm(step);
    for (uint32_t try = 0; try < SPLIT_TRIES; try++) {
        const uint64_t draw = tl_key(key, try);
        const tl_vec3 to = {2 * tl_uniform(draw) - 1, 2 * tl_uniform(draw + 1) - 1, 2 * tl_uniform(draw + 2) - 1};
        p->place[point] = tl_v3_madd(chosen, distance, to);
        const double worst = worst_divided(f, r, point);
        if (worst > best)
            best = worst, chosen = p->place[point];
        if (try % SPLIT_HALVED == SPLIT_HALVED - 1)
            distance *= 0.5;
    }
    p->place[point] = chosen;
    *done = best > 0 && best > SPLIT_GAIN * before;
    if (*done)
        return divide_ring(f, r, point);
    p->count--;
    return true;
}

bool tl_zone_splits_make(tl_zone_points *points, tl_zone_lists *lists, double limit, uint32_t *made)
{
    flips f = {points, lists};
    const uint32_t before = lists->count;
    *made = 0;
    for (uint32_t z = 0; z < before; z++) {
        bool done = tl_zone_share(points, lists->zone[z]) >= limit;
        for (uint32_t i = 0; !done && i < 4; i++)
            for (uint32_t k = i + 1; !done && k < 4; k++) {
                split_ring r;
                if (!find_split_ring(&f, z, i, k, &r))
                    continue;
                if (!split_edge(&f, points, &r, &done))
                    return false;
                *made += done;
            }
    }
    return true;
}
