/* delaunay.c - tetrahedra of points, none of which lies in the sphere of a tetrahedron.
 *
 * Incremental (Bowyer 1981, Watson 1981): the tetrahedra whose spheres have the next point inside give way to those of
 * the point and the border of what they filled. Beyond each triangle of the hull lies a ghost. A ghost's sphere is the
 * half-space beyond its triangle, and in its plane the circle.
 *
 * Signs are exact, so what is made is the Delaunay triangulation of the points on the grid, whatever the order. Where
 * points lie on one sphere it depends on the order, unless their weights decide.
 *
 * Of a block with flat faces, points of one lie in a plane but for the rounding of the grid. So three rules take the
 * place of signs that rounding would decide:
 *
 *     a ghost on face f, p in f        by the circle of its triangle in the coordinates of the face
 *     a ghost on face f, p not in f    not inside, as a block is convex
 *     a tetrahedron at such a ghost    as the ghost, where p is in f
 *
 * The triangles of a face so change by circles in its plane alone. No tetrahedron gets four corners in one face: border
 * and point would lie in one plane, and the third rule puts both sides of that triangle, or none, into the cavity.
 *
 * The order is this. First come the corners of a block. Then come rounds of four times as many points each, chosen by
 * keys, along a Hilbert curve (Amenta, Choi and Rote 2003; Skilling 2004). Each point is found by walking from the last
 * tetrahedron. */
#include "geometry/delaunay.h"

#include "base/random.h"
#include "base/table.h"

#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

/* Marks of tetrahedra: in the cavity, with its sides on the border; looked at and not in it; not to be in it, or
 * to be in it, whatever its sphere. */
enum { IN_CAVITY = 0x80, PASSED = 0x40, KEPT = 0x20, TAKEN = 0x10 };

/* Limit: how often a cavity is mended. */
#define MOST_MENDED 20
/* Cost only: bits of each coordinate along the Hilbert curve, and rounds. */
#define CURVE_BITS 12
#define ROUNDS 12
#define SORT_BITS 10

/* ---- faces ---- */

/* Where point p is in a face; NULL: not in it. */
TL_INLINE const tl_site2 *place_in(const tl_delaunay_points *points, uint32_t p, uint32_t face)
{
    if (p >= points->surface_count)
        return NULL;
    for (uint32_t i = points->start[p]; i < points->start[p + 1]; i++)
        if (points->in_face[i].face == face)
            return &points->in_face[i].at;
    return NULL;
}

/* The face that three points have in common. */
static uint32_t common_face(const tl_delaunay_points *points, const uint32_t p[3])
{
    if (p[0] >= points->surface_count)
        return TL_NO_FACE;
    for (uint32_t i = points->start[p[0]]; i < points->start[p[0] + 1]; i++) {
        const uint32_t face = points->in_face[i].face;
        if (place_in(points, p[1], face) && place_in(points, p[2], face))
            return face;
    }
    return TL_NO_FACE;
}

static int orient(const tl_delaunay_points *points, const uint32_t v[4])
{
    const tl_site *site = points->site;
    return tl_orient_sign(&site[v[0]], &site[v[1]], &site[v[2]], &site[v[3]]);
}

TL_INLINE int sphere(const tl_delaunay_points *points, const uint32_t v[4], uint32_t p)
{
    const tl_site *site = points->site;
    return tl_sphere_sign(&site[v[0]], &site[v[1]], &site[v[2]], &site[v[3]], &site[p]);
}

/* ---- what is in the way of a point ---- */

/* The same for a point in the face of a ghost: by the circle of its triangle. */
static bool in_circle(const tl_delaunay_points *points, const tl_tetrahedron *ghost, const tl_site2 *at)
{
    const uint32_t face = ghost->corner[3] - TL_GHOST;
    const tl_site2 *a = place_in(points, ghost->corner[0], face), *b = place_in(points, ghost->corner[1], face);
    const tl_site2 *c = place_in(points, ghost->corner[2], face);
    const int sign = points->turn[face] > 0 ? tl_circle_sign(a, b, c, at) : tl_circle_sign(a, c, b, at);
    return sign > 0;
}

static bool in_ghost(const tl_delaunay *d, const tl_tetrahedron *ghost, uint32_t p)
{
    const tl_delaunay_points *points = d->points;
    const uint32_t face = ghost->corner[3] - TL_GHOST;
    if (points->flat && face != TL_NO_FACE) {
        const tl_site2 *at = place_in(points, p, face);
        return at && in_circle(points, ghost, at);
    }
    const int side = orient(points, (uint32_t[]){ghost->corner[0], ghost->corner[1], ghost->corner[2], p});
    return side > 0 || (side == 0 && sphere(points, d->tetrahedron[ghost->next[3] / 4].corner, p) > 0);
}

/* The ghost beside a tetrahedron whose face has point p in it; NULL: there is none. */
static const tl_tetrahedron *ghost_beside(const tl_delaunay *d, const tl_tetrahedron *here, uint32_t p)
{
    for (int i = 0; i < 4; i++) {
        const tl_tetrahedron *ghost = &d->tetrahedron[here->next[i] / 4];
        if (tl_is_ghost(ghost) && ghost->corner[3] != TL_GHOST + TL_NO_FACE &&
            place_in(d->points, p, ghost->corner[3] - TL_GHOST))
            return ghost;
    }
    return NULL;
}

/* Whether point p is inside the sphere of a tetrahedron or ghost. */
TL_INLINE bool is_in(const tl_delaunay *d, uint32_t t, uint32_t p)
{
    const tl_delaunay_points *points = d->points;
    const tl_tetrahedron *here = &d->tetrahedron[t];
    if (tl_is_ghost(here))
        return in_ghost(d, here, p);
    if (points->flat && p < points->surface_count) {
        const tl_tetrahedron *ghost = ghost_beside(d, here, p);
        if (ghost)
            return in_circle(points, ghost, place_in(points, p, ghost->corner[3] - TL_GHOST));
    }
    return sphere(points, here->corner, p) > 0;
}

/* ---- walking ---- */

/* Whether a point is beyond the side of a tetrahedron opposite corner i. */
TL_INLINE bool is_beyond(const tl_delaunay *d, const tl_tetrahedron *here, uint32_t i, uint32_t p)
{
    /* a block has points beyond its hull only while corners are missing */
    const tl_tetrahedron *next = &d->tetrahedron[here->next[i] / 4];
    if (d->points->flat && tl_is_ghost(next) && next->corner[3] != TL_GHOST + TL_NO_FACE)
        return false;
    uint32_t v[4] = {here->corner[0], here->corner[1], here->corner[2], here->corner[3]};
    v[i] = p;
    return orient(d->points, v) < 0;
}

/* The tetrahedron in which a point is, or a ghost beyond which it is; NONE: not found. */
static uint32_t walk(tl_delaunay *d, uint32_t p)
{
    uint32_t t = d->last, from = NONE;
    if (tl_is_ghost(&d->tetrahedron[t]))
        t = d->tetrahedron[t].next[3] / 4;
    for (uint32_t step = 0; step < d->used; step++) {
        const tl_tetrahedron *here = &d->tetrahedron[t];
        uint32_t to = NONE;
        d->steps++;
        for (uint32_t k = 0; k < 4 && to == NONE; k++) {
            const uint32_t i = (k + d->steps) & 3, next = here->next[i] / 4;
            if (next != from && is_beyond(d, here, i, p))
                to = next;
        }
        if (to == NONE || tl_is_ghost(&d->tetrahedron[to]))
            return to == NONE ? t : to;
        from = t;
        t = to;
    }
    return NONE;
}

/* A tetrahedron that must give way to point p; NONE: there is none. */
static uint32_t first_in_the_way(tl_delaunay *d, uint32_t p)
{
    const uint32_t t = walk(d, p);
    if (t == NONE || is_in(d, t, p))
        return t;
    for (int i = 0; i < 4; i++) {
        const uint32_t next = d->tetrahedron[t].next[i] / 4;
        if (is_in(d, next, p))
            return next;
    }
    return NONE;
}

/* ---- the cavity ---- */

static bool put(uint32_t **list, uint32_t *count, size_t *room, uint32_t number)
{
    if (!tl_grow(list, room, (size_t)*count + 1, sizeof **list))
        return false;
    (*list)[(*count)++] = number;
    return true;
}

/* Lists the tetrahedra that give way to point p, and their sides on the border. */
static bool list_cavity(tl_delaunay *d, uint32_t first, uint32_t p)
{
    d->cavity_count = d->border_count = 0;
    if (!put(&d->cavity, &d->cavity_count, &d->cavity_room, first))
        return false;
    d->mark[first] = IN_CAVITY;
    for (uint32_t k = 0; k < d->cavity_count; k++) {
        const uint32_t t = d->cavity[k];
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t next = d->tetrahedron[t].next[i] / 4;
            if (d->mark[next] & IN_CAVITY)
                continue;
            const bool passed = d->mark[next] & (PASSED | KEPT);
            if (!passed && (d->mark[next] & TAKEN || is_in(d, next, p))) {
                d->mark[next] = IN_CAVITY | (d->mark[next] & TAKEN);
                if (!put(&d->cavity, &d->cavity_count, &d->cavity_room, next))
                    return false;
                continue;
            }
            d->mark[next] |= PASSED;
            d->mark[t] = (unsigned char)(d->mark[t] | 1u << i);
            if ((!passed && !put(&d->passed, &d->passed_count, &d->passed_room, next)) ||
                !put(&d->border, &d->border_count, &d->border_room, 4 * t + i))
                return false;
        }
    }
    return true;
}

/* Marks what must change so that point p sees all sides of the border. Where it does not, the tetrahedron is left out.
 * If that is the first, or a face decides, what lies beyond the side is taken instead. Returns whether there are any.
 */
static bool mend_cavity(tl_delaunay *d, uint32_t first, uint32_t p)
{
    bool any = false;
    for (uint32_t k = 0; k < d->border_count; k++) {
        const uint32_t t = d->border[k] / 4, i = d->border[k] % 4;
        const tl_tetrahedron *here = &d->tetrahedron[t];
        uint32_t v[4] = {here->corner[0], here->corner[1], here->corner[2], here->corner[3]};
        v[i] = p;
        if (v[3] >= TL_GHOST || d->mark[t] & KEPT || orient(d->points, v) > 0)
            continue;
        const uint32_t beyond = here->next[i] / 4;
        const bool stays = t == first || tl_is_ghost(here) || ghost_beside(d, here, p);
        if (stays && (d->mark[beyond] & KEPT || tl_is_ghost(&d->tetrahedron[beyond]) ||
                      ghost_beside(d, &d->tetrahedron[beyond], p)))
            continue;
        d->mark[stays ? beyond : t] |= stays ? TAKEN : KEPT;
        any = true;
    }
    return any;
}

/* Opens the cavity of point p. Where the circles of a face have decided otherwise than spheres would have, by a little,
 * it is mended. */
static bool open_cavity(tl_delaunay *d, uint32_t first, uint32_t p)
{
    bool made = true, again = true;
    d->passed_count = 0;
    for (int round = 0; made && again; round++) {
        made = list_cavity(d, first, p);
        again = made && round < MOST_MENDED && mend_cavity(d, first, p);
        for (uint32_t k = 0; again && made && k < d->cavity_count; k++) {
            const uint32_t t = d->cavity[k];
            d->mark[t] &= KEPT | TAKEN;
            made = !d->mark[t] || put(&d->passed, &d->passed_count, &d->passed_room, t);
        }
        for (uint32_t k = 0; k < d->passed_count; k++) {
            unsigned char *mark = &d->mark[d->passed[k]];
            *mark = *mark & IN_CAVITY ? *mark : again ? *mark & (KEPT | TAKEN) : 0;
        }
    }
    return made;
}

/* Room for as many tetrahedra more as the border has sides. */
static bool make_room(tl_delaunay *d)
{
    const size_t need = (size_t)d->used + d->border_count;
    return need <= TL_DELAUNAY_MOST && tl_grow(&d->tetrahedron, &d->tetrahedron_room, need, sizeof *d->tetrahedron) &&
           tl_grow(&d->mark, &d->mark_room, need, sizeof *d->mark) &&
           tl_grow(&d->spare, &d->spare_room, (size_t)d->spare_count + d->cavity_count, sizeof *d->spare);
}

static uint32_t new_place(tl_delaunay *d)
{
    if (d->spare_count)
        return d->spare[--d->spare_count];
    d->mark[d->used] = 0;
    return d->used++;
}

/* The face of a ghost that had one, with point p in the place of a corner. */
static uint32_t face_with(const tl_delaunay *d, const tl_tetrahedron *ghost, uint32_t old, uint32_t p)
{
    const uint32_t face = old - TL_GHOST;
    if (face != TL_NO_FACE && place_in(d->points, p, face))
        return old;
    return TL_GHOST + common_face(d->points, ghost->corner);
}

/* Makes the tetrahedron of point p and a side of the border. The side then leads to it. */
static void make_one(tl_delaunay *d, uint32_t side, uint32_t p)
{
    const uint32_t made = new_place(d), i = side % 4;
    tl_tetrahedron *old = &d->tetrahedron[side / 4], *new = &d->tetrahedron[made];
    const uint32_t beyond = old->next[i];
    *new = (tl_tetrahedron){{old->corner[0], old->corner[1], old->corner[2], old->corner[3]}, {NONE, NONE, NONE, NONE}};
    new->corner[i] = p;
    if (i < 3 && tl_is_ghost(old))
        new->corner[3] = face_with(d, new, old->corner[3], p);
    new->next[i] = beyond;
    d->tetrahedron[beyond / 4].next[beyond % 4] = 4 * made + i;
    old->next[i] = 4 * made + i;
}

/* The place of a corner; ghosts' last corners count as one. */
TL_INLINE uint32_t place_of(const tl_tetrahedron *t, uint32_t corner)
{
    if (corner >= TL_GHOST)
        return 3;
    return t->corner[0] == corner ? 0 : t->corner[1] == corner ? 1 : t->corner[2] == corner ? 2 : 3;
}

/* Links what was made at a side of the border with its neighbours, by turning through the cavity around each edge. */
static void link_one(tl_delaunay *d, uint32_t side)
{
    tl_tetrahedron *all = d->tetrahedron;
    const uint32_t i = side % 4, made = all[side / 4].next[i] / 4;
    for (uint32_t j = 0; j < 4; j++) {
        if (j == i || all[made].next[j] != NONE)
            continue;
        uint32_t t = side / 4, out = j, behind = i;
        while (!(d->mark[t] & 1u << out)) {
            const uint32_t leaving = all[t].corner[behind], to = all[t].next[out];
            t = to / 4;
            behind = to % 4;
            out = place_of(&all[t], leaving);
        }
        const uint32_t other = all[t].next[out] / 4;
        all[made].next[j] = 4 * other + behind;
        all[other].next[behind] = 4 * made + j;
    }
}

/* Fills the cavity with tetrahedra of point p. */
static bool fill_cavity(tl_delaunay *d, uint32_t p)
{
    if (!make_room(d))
        return false;
    for (uint32_t k = 0; k < d->border_count; k++)
        make_one(d, d->border[k], p);
    for (uint32_t k = 0; k < d->border_count; k++)
        link_one(d, d->border[k]);
    d->last = d->tetrahedron[d->border[0] / 4].next[d->border[0] % 4] / 4;
    for (uint32_t k = 0; k < d->cavity_count; k++) {
        const uint32_t t = d->cavity[k];
        d->mark[t] = 0;
        d->tetrahedron[t].corner[0] = NONE;
        d->spare[d->spare_count++] = t;
    }
    return true;
}

static tl_status put_in(tl_delaunay *d, uint32_t p, tl_error *error)
{
    const uint32_t first = first_in_the_way(d, p);
    if (first == NONE) {
        d->hidden++;
        return TL_OK;
    }
    return open_cavity(d, first, p) && fill_cavity(d, p) ? TL_OK : tl_fail_memory(error);
}

/* ---- the first tetrahedron ---- */

typedef struct direction {
    double x, y, z;
} direction;

static direction difference(const tl_site *from, const tl_site *to)
{
    return (direction){to->x - from->x, to->y - from->y, to->z - from->z};
}

static direction cross(direction a, direction b)
{
    return (direction){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(direction a, direction b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Four of the first points far apart: the first, the farthest from it, from their line, from their plane. */
static bool choose_first(const tl_delaunay_points *points, uint32_t among, uint32_t v[4])
{
    const tl_site *x = points->site;
    double best[3] = {0, 0, 0};
    v[0] = v[1] = v[2] = v[3] = 0;
    for (uint32_t i = 1; i < among; i++) {
        const direction to = difference(&x[0], &x[i]);
        if (dot(to, to) > best[0])
            best[0] = dot(to, to), v[1] = i;
    }
    const direction along = difference(&x[0], &x[v[1]]);
    for (uint32_t i = 1; i < among; i++) {
        const direction across = cross(along, difference(&x[0], &x[i]));
        if (dot(across, across) > best[1])
            best[1] = dot(across, across), v[2] = i;
    }
    const direction normal = cross(along, difference(&x[0], &x[v[2]]));
    for (uint32_t i = 1; i < among; i++) {
        const double height = fabs(dot(normal, difference(&x[0], &x[i])));
        if (height > best[2])
            best[2] = height, v[3] = i;
    }
    const int sign = orient(points, v);
    if (sign < 0) {
        const uint32_t swap = v[1];
        v[1] = v[2];
        v[2] = swap;
    }
    return sign != 0;
}

/* Makes the tetrahedron of four points, and its ghosts. */
static void make_first(tl_delaunay *d, const uint32_t v[4])
{
    static const uint32_t side[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    d->tetrahedron[0] = (tl_tetrahedron){{v[0], v[1], v[2], v[3]}, {7, 11, 15, 19}};
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t *s = side[i];
        tl_tetrahedron *ghost = &d->tetrahedron[1 + i];
        *ghost = (tl_tetrahedron){{v[s[0]], v[s[1]], v[s[2]], TL_GHOST}, {0, 0, 0, i}};
        ghost->corner[3] = TL_GHOST + common_face(d->points, ghost->corner);
        /* across the edge opposite corner k of the triangle lies the ghost opposite that corner */
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t *other = side[s[k]];
            const uint32_t back = other[0] == i ? 0 : other[1] == i ? 1 : 2;
            ghost->next[k] = 4 * (1 + s[k]) + back;
        }
    }
    memset(d->mark, 0, 5);
    d->used = 5;
    d->spare_count = 0;
    d->last = 0;
}

/* ---- the order of the points ---- */

/* The place along a Hilbert curve (Skilling 2004, "Programming the Hilbert curve", AIP Conf. Proc. 707, 381-387). */
static uint64_t curve_place(uint32_t x[3])
{
    for (uint32_t bit = 1u << (CURVE_BITS - 1); bit > 1; bit >>= 1)
        for (int i = 0; i < 3; i++) {
            const uint32_t below = bit - 1, swap = x[i] & bit ? 0 : (x[0] ^ x[i]) & below;
            x[0] ^= x[i] & bit ? below : swap;
            x[i] ^= swap;
        }
    x[1] ^= x[0];
    x[2] ^= x[1];
    uint32_t turn = 0;
    for (uint32_t bit = 1u << (CURVE_BITS - 1); bit > 1; bit >>= 1)
        if (x[2] & bit)
            turn ^= bit - 1;
    uint64_t place = 0;
    for (int bit = CURVE_BITS - 1; bit >= 0; bit--)
        for (int i = 0; i < 3; i++)
            place = place << 1 | (((x[i] ^ turn) >> bit) & 1);
    return place;
}

/* The round of a point: the last has three of four, the one before three of four of the others. */
static uint32_t round_of(uint32_t p)
{
    uint64_t key = tl_mix64(p);
    uint32_t before = 0;
    while (before < ROUNDS - 1 && (key & 3) == 0) {
        before++;
        key >>= 2;
    }
    return ROUNDS - 1 - before;
}

static uint64_t key_of(const tl_site *site, uint32_t p)
{
    const double unit = 1.0 / (double)(1ull << (TL_GRID_BITS - CURVE_BITS));
    const double x[3] = {site->x, site->y, site->z};
    uint32_t cell[3];
    for (int i = 0; i < 3; i++) {
        const double at = x[i] * unit, most = (double)((1u << CURVE_BITS) - 1);
        cell[i] = (uint32_t)(at < most ? at : most);
    }
    return (uint64_t)round_of(p) << 3 * CURVE_BITS | curve_place(cell);
}

/* Sorts pairs of key and number by key: equal ones stay in their order. */
static void sort_keys(uint64_t *pair, uint64_t *other, size_t count)
{
    for (int shift = 0; shift < 3 * CURVE_BITS + 4; shift += SORT_BITS) {
        size_t start[(1 << SORT_BITS) + 1] = {0};
        const uint64_t most = (1u << SORT_BITS) - 1;
        for (size_t i = 0; i < count; i++)
            start[(pair[2 * i] >> shift & most) + 1]++;
        for (size_t i = 1; i <= most; i++)
            start[i] += start[i - 1];
        for (size_t i = 0; i < count; i++) {
            const size_t to = start[pair[2 * i] >> shift & most]++;
            other[2 * to] = pair[2 * i];
            other[2 * to + 1] = pair[2 * i + 1];
        }
        memcpy(pair, other, 2 * count * sizeof *pair);
    }
}

/* Puts the points from number `first` on in order; returns how many. */
static size_t put_in_order(tl_delaunay *d, uint32_t first)
{
    size_t count = 0;
    for (uint32_t p = first; p < d->points->count; p++, count++) {
        d->order[2 * count] = key_of(&d->points->site[p], p);
        d->order[2 * count + 1] = p;
    }
    sort_keys(d->order, d->other, count);
    return count;
}

/* ---- all ---- */

/* A block whose corners are in has faces beyond all its triangles. */
static bool is_closed(const tl_delaunay *d)
{
    for (uint32_t t = 0; t < d->used; t++)
        if (tl_is_there(&d->tetrahedron[t]) && d->tetrahedron[t].corner[3] == TL_GHOST + TL_NO_FACE)
            return false;
    return true;
}

static tl_status no_block(tl_error *error)
{
    return tl_fail(error, TL_E_GEOMETRY, "its faces are not those of a convex block");
}

static tl_status put_all_in(tl_delaunay *d, const uint32_t four[4], tl_error *error)
{
    const tl_delaunay_points *points = d->points;
    tl_status status = TL_OK;
    for (uint32_t p = 0; !status && p < points->corner_count; p++)
        if (p != four[0] && p != four[1] && p != four[2] && p != four[3])
            status = put_in(d, p, error);
    if (!status && points->flat && !is_closed(d))
        return no_block(error);
    const size_t count = put_in_order(d, points->corner_count);
    for (size_t i = 0; !status && i < count; i++) {
        const uint32_t p = (uint32_t)d->order[2 * i + 1];
        const bool is_in_already = p == four[0] || p == four[1] || p == four[2] || p == four[3];
        if (!is_in_already)
            status = put_in(d, p, error);
    }
    return status;
}

static tl_status make_all(tl_delaunay *d, tl_error *error)
{
    const tl_delaunay_points *points = d->points;
    uint32_t four[4];
    d->used = d->hidden = d->steps = 0;
    if (points->count < 4 || !choose_first(points, points->corner_count ? points->corner_count : points->count, four))
        return tl_fail(error, TL_E_GEOMETRY, "its %u points lie in one plane", points->count);
    const size_t few = 64 + 7 * (size_t)points->count;
    if (!tl_grow(&d->tetrahedron, &d->tetrahedron_room, few, sizeof *d->tetrahedron) ||
        !tl_grow(&d->mark, &d->mark_room, few, sizeof *d->mark) ||
        !tl_grow(&d->order, &d->order_room, 2 * (size_t)points->count, sizeof *d->order) ||
        !tl_grow(&d->other, &d->other_room, 2 * (size_t)points->count, sizeof *d->other))
        return tl_fail_memory(error);
    make_first(d, four);
    tl_status status = put_all_in(d, four, error);
    /* a block of which a point is left out, or whose hull a point has broken, has faces that do not fit */
    if (!status && points->corner_count && (d->hidden || !is_closed(d)))
        return no_block(error);
    return status;
}

tl_status tl_delaunay_make(tl_delaunay *d, const tl_delaunay_points *points, tl_error *error)
{
    d->points = points;
    const tl_status status = make_all(d, error);
    d->points = NULL;
    return status;
}

void tl_delaunay_free(tl_delaunay *d)
{
    free(d->tetrahedron);
    free(d->mark);
    free(d->spare);
    free(d->cavity);
    free(d->border);
    free(d->passed);
    free(d->order);
    free(d->other);
    *d = (tl_delaunay){0};
}
