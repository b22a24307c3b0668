/* exact_axis.h - whether two blocks are apart, and by how much they overlap, by a search in long double over all faces
 * and all pairs of edges, each with full support: what the kernel is compared with. */
#ifndef TALUS_TESTS_EXACT_AXIS_H
#define TALUS_TESTS_EXACT_AXIS_H

#include "contact_scene.h"

typedef long double real;

typedef struct lvec {
    real x, y, z;
} lvec;

static lvec lv(tl_vec3 v)
{
    return (lvec){v.x, v.y, v.z};
}

static lvec lsub(lvec a, lvec b)
{
    return (lvec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static lvec lscale(real s, lvec a)
{
    return (lvec){s * a.x, s * a.y, s * a.z};
}

static real ldot(lvec a, lvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static lvec lcross(lvec a, lvec b)
{
    return (lvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Both blocks in long double, in A's frame. */
typedef struct exact {
    lvec a[256], b[256], normal_b[256];
    uint32_t a_count, b_count;
} exact;

static lvec lturn(const tl_mat3 *r, tl_vec3 v)
{
    lvec out;
    out.x = (real)r->m[0][0] * v.x + (real)r->m[0][1] * v.y + (real)r->m[0][2] * v.z;
    out.y = (real)r->m[1][0] * v.x + (real)r->m[1][1] * v.y + (real)r->m[1][2] * v.z;
    out.z = (real)r->m[2][0] * v.x + (real)r->m[2][1] * v.y + (real)r->m[2][2] * v.z;
    return out;
}

static void load_exact(const tl_pair_view *view, exact *e)
{
    e->a_count = view->a->vertex_count;
    e->b_count = view->b->vertex_count;
    for (uint32_t i = 0; i < e->a_count; i++)
        e->a[i] = lv(view->a->vertex[i]);
    for (uint32_t i = 0; i < e->b_count; i++) {
        lvec x = lturn(&view->turn, view->b->vertex[i]);
        e->b[i] = (lvec){x.x + view->shift.x, x.y + view->shift.y, x.z + view->shift.z};
    }
    for (uint32_t f = 0; f < view->b->face_count; f++)
        e->normal_b[f] = lturn(&view->turn, view->b->plane[f].normal);
}

/* Separation along n (any length), by full support. */
static real separation(const exact *e, lvec n)
{
    n = lscale(1 / sqrtl(ldot(n, n)), n);
    real low = ldot(n, e->b[0]), high = ldot(n, e->a[0]);
    for (uint32_t i = 1; i < e->b_count; i++)
        low = fminl(low, ldot(n, e->b[i]));
    for (uint32_t i = 1; i < e->a_count; i++)
        high = fmaxl(high, ldot(n, e->a[i]));
    return low - high;
}

/* What is asked of an axis: n of any length. */
typedef void ask_axis(const exact *e, lvec n, void *user);

/* Asks all axes that may part two blocks: faces, and pairs of edges in both directions. */
static void try_all(const tl_pair_view *view, ask_axis *ask, void *user)
{
    static exact e;
    load_exact(view, &e);
    const tl_poly *a = view->a, *b = view->b;
    for (uint32_t f = 0; f < a->face_count; f++)
        ask(&e, lv(a->plane[f].normal), user);
    for (uint32_t f = 0; f < b->face_count; f++)
        ask(&e, lscale(-1, e.normal_b[f]), user);
    for (uint32_t i = 0; i < a->edge_count; i++)
        for (uint32_t j = 0; j < b->edge_count; j++) {
            lvec u = lsub(e.a[a->edge[i].b], e.a[a->edge[i].a]);
            lvec v = lsub(e.b[b->edge[j].b], e.b[b->edge[j].a]);
            lvec n = lcross(u, v);
            if (ldot(n, n) <= 1e-30L * ldot(u, u) * ldot(v, v))
                continue; /* parallel: no direction of their own */
            ask(&e, n, user);
            ask(&e, lscale(-1, n), user);
        }
}

/* The largest separation of all axes, and its direction. */
typedef struct best_axis {
    real s;
    lvec n;
} best_axis;

static void keep_best(const exact *e, lvec n, void *user)
{
    best_axis *best = user;
    real s = separation(e, n);
    if (s > best->s)
        *best = (best_axis){s, lscale(1 / sqrtl(ldot(n, n)), n)};
}

SCENE_UNUSED static best_axis brute_force(const tl_pair_view *view)
{
    best_axis best = {-INFINITY, {0, 0, 0}};
    try_all(view, keep_best, &best);
    return best;
}

/* The way along a direction until some axis parts the blocks. */
typedef struct exit_along {
    lvec way;
    real far;
} exit_along;

static void leave_along(const exact *e, lvec n, void *user)
{
    exit_along *out = user;
    real by = ldot(n, out->way) / sqrtl(ldot(n, n));
    if (by > 0)
        out->far = fminl(out->far, -separation(e, n) / by);
}

/* Moves B along the best axis until it overlaps A by a depth; the best axis may change on the way. */
SCENE_UNUSED static void exact_press(scene_pair *p, double depth)
{
    for (int pass = 0; pass < 4; pass++) {
        best_axis best = brute_force(scene_place(p));
        real by = -(real)depth - best.s;
        p->shift =
            tl_v3_add(p->shift, tl_v3((double)(by * best.n.x), (double)(by * best.n.y), (double)(by * best.n.z)));
    }
}

/* How far B, which overlaps A, must go along a direction until they only touch. */
SCENE_UNUSED static double exact_way_out(const tl_pair_view *view, tl_vec3 way)
{
    exit_along out = {.way = lv(way), .far = INFINITY};
    try_all(view, leave_along, &out);
    return (double)out.far;
}

#endif
