/* coarse_test.c - the coarse test of a candidate pair, by libccd: is it near enough to be worth finding its region?
 * Both blocks are grown by a ball. Only the yes or no is used: libccd's depths, normals and positions are not reliable
 * for faces that nearly touch.
 *
 * Its portals may go round in a circle for ever where roundings decide. Nothing in libccd ends that. A block that has
 * been asked for MOST_CALLS points answers from then on with one on the wrong side: that ends any search. What it
 * gives counts for nothing then, and the pair is near. */
#include "narrow/coarse_test.h"

#include "geometry/measure.h"

#include <ccd/ccd.h>
#include <talus/vmath.h>

/* Points of a block that a search asks for: some tens. */
#define MOST_CALLS 1000

/* A block grown by a ball. */
typedef struct grown_block {
    const tl_vec3 *vertex;
    uint32_t count;
    tl_vec3 center;
    double ball;
    uint32_t calls; /* points asked for */
    double far;     /* beyond both blocks, m */
} grown_block;

/* The object is ours, and not const. */
static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    grown_block *g = (grown_block *)(uintptr_t)object;
    tl_vec3 d = {direction->v[0], direction->v[1], direction->v[2]};
    if (++g->calls > MOST_CALLS) {
        tl_vec3 x = tl_v3_scale(-g->far, tl_v3_unit(d));
        ccdVec3Set(out, x.x, x.y, x.z);
        return;
    }
    uint32_t best = 0;
    double most = tl_v3_dot(d, g->vertex[0]);
    for (uint32_t i = 1; i < g->count; i++) {
        double s = tl_v3_dot(d, g->vertex[i]);
        if (s > most) {
            most = s;
            best = i;
        }
    }
    tl_vec3 x = tl_v3_madd(g->vertex[best], g->ball, tl_v3_unit(d));
    ccdVec3Set(out, x.x, x.y, x.z);
}

static void center(const void *object, ccd_vec3_t *out)
{
    const grown_block *g = object;
    ccdVec3Set(out, g->center.x, g->center.y, g->center.z);
}

bool tl_coarse_test(const tl_pair_view *view, double reach)
{
    grown_block a = {.vertex = view->a->vertex, .count = view->a->vertex_count, .ball = 0.5 * reach};
    grown_block b = {.vertex = view->vertex_b, .count = view->b->vertex_count, .ball = 0.5 * reach};
    a.center = tl_points_mean(a.vertex, a.count);
    b.center = tl_points_mean(b.vertex, b.count);
    a.far = b.far = 1e3 * (tl_v3_norm(tl_v3_sub(b.center, a.center)) + view->a->size + view->b->size + reach);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.mpr_tolerance = TL_STILL * view->size; /* m; its default of 1e-4 misses pairs */
    bool met = ccdMPRIntersect(&a, &b, &ccd) != 0;
    return met || a.calls > MOST_CALLS || b.calls > MOST_CALLS;
}
