/* look.c - the first look at a candidate pair, by libccd: is it near enough to be worth the exact
 * search? Both blocks are grown by a ball. Only the yes or no is used: libccd's depths, normals and
 * positions are not reliable for faces that nearly touch. */
#include "narrow/look.h"

#include <ccd/ccd.h>
#include <talus/vmath.h>

typedef struct grown {
    const tl_vec3 *vertex;
    uint32_t count;
    tl_vec3 center;
    double ball;
} grown;

static void support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    const grown *g = object;
    tl_vec3 d = {direction->v[0], direction->v[1], direction->v[2]};
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
    const grown *g = object;
    ccdVec3Set(out, g->center.x, g->center.y, g->center.z);
}

static tl_vec3 mean(const tl_vec3 *vertex, uint32_t count)
{
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++)
        sum = tl_v3_add(sum, vertex[i]);
    return tl_v3_scale(1.0 / count, sum);
}

bool tl_look_near(const tl_pair_view *view, double reach)
{
    grown a = {view->a->vertex, view->a->vertex_count, {0, 0, 0}, 0.5 * reach};
    grown b = {view->vertex_b, view->b->vertex_count, {0, 0, 0}, 0.5 * reach};
    a.center = mean(a.vertex, a.count);
    b.center = mean(b.vertex, b.count);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.mpr_tolerance = TL_STILL * view->size; /* m; its default of 1e-4 misses pairs */
    return ccdMPRIntersect(&a, &b, &ccd) != 0;
}
