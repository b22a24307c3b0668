/* exact_axis.h - the common plane by a search in long double over all faces and all pairs of edges, each with full
 * support: what the kernel's is compared with. */
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

/* The largest separation of all axes, its direction, and the largest one of axes that differ. */
typedef struct best_axis {
    real s, second;
    lvec n;
} best_axis;

static void try_axis(const exact *e, lvec n, best_axis *best)
{
    real s = separation(e, n);
    n = lscale(1 / sqrtl(ldot(n, n)), n);
    int alike = ldot(n, best->n) > 1 - 1e-9L;
    if (s > best->s) {
        if (!alike)
            best->second = best->s;
        best->s = s;
        best->n = n;
    } else if (!alike && s > best->second) {
        best->second = s;
    }
}

static best_axis brute_force(const tl_pair_view *view)
{
    static exact e;
    load_exact(view, &e);
    best_axis best = {-INFINITY, -INFINITY, {0, 0, 0}};
    const tl_poly *a = view->a, *b = view->b;
    for (uint32_t f = 0; f < a->face_count; f++)
        try_axis(&e, lv(a->plane[f].normal), &best);
    for (uint32_t f = 0; f < b->face_count; f++)
        try_axis(&e, lscale(-1, e.normal_b[f]), &best);
    for (uint32_t i = 0; i < a->edge_count; i++)
        for (uint32_t j = 0; j < b->edge_count; j++) {
            lvec u = lsub(e.a[a->edge[i].b], e.a[a->edge[i].a]);
            lvec v = lsub(e.b[b->edge[j].b], e.b[b->edge[j].a]);
            lvec n = lcross(u, v);
            if (ldot(n, n) <= 1e-30L * ldot(u, u) * ldot(v, v))
                continue; /* parallel: no direction of their own */
            try_axis(&e, n, &best);
            try_axis(&e, lscale(-1, n), &best);
        }
    return best;
}

/* The largest s of an axis that differs from n, over all faces and all edges whose arcs cross: none is left out. */
static double plain_second(const tl_pair_view *view, const exact *e, tl_vec3 n)
{
    static const double differs =
        0.99; /* cos: axes alike are one, and so may be those alike to these */
    const tl_poly *a = view->a, *b = view->b;
    double second = -INFINITY;
    for (uint32_t f = 0; f < a->face_count; f++)
        if (tl_v3_dot(a->plane[f].normal, n) < differs)
            second = fmax(second, (double)separation(e, lv(a->plane[f].normal)));
    for (uint32_t f = 0; f < b->face_count; f++)
        if (-tl_v3_dot(view->normal_b[f], n) < differs)
            second = fmax(second, (double)separation(e, lv(tl_v3_neg(view->normal_b[f]))));
    for (uint32_t i = 0; i < a->edge_count; i++)
        for (uint32_t j = 0; j < b->edge_count; j++) {
            const tl_edge *ea = &a->edge[i], *eb = &b->edge[j];
            tl_vec3 u = tl_v3_sub(a->vertex[ea->b], a->vertex[ea->a]), c;
            tl_vec3 v = tl_v3_sub(view->vertex_b[eb->b], view->vertex_b[eb->a]);
            tl_vec3 a1 = a->plane[ea->left].normal, a2 = a->plane[ea->right].normal;
            double b1 = tl_v3_dot(u, view->normal_b[eb->left]);
            double b2 = tl_v3_dot(u, view->normal_b[eb->right]);
            double s1 = tl_v3_dot(v, a1), s2 = tl_v3_dot(v, a2);
            if (b1 * b2 < 0 && s1 * s2 < 0 && b1 * s2 < 0 &&
                tl_edge_normal(u, v, tl_v3_add(a1, a2), &c) && tl_v3_dot(c, n) < differs)
                second = fmax(second, (double)separation(e, lv(c)));
        }
    return second;
}

#endif
