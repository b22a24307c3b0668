/* field_scene.h - random pairs of shapes that overlap, and their planes: what the tests of pressure fields try. */
#ifndef TALUS_TESTS_FIELD_SCENE_H
#define TALUS_TESTS_FIELD_SCENE_H

#include "exact_axis.h"
#include "narrow/coarse_test.h"
#include "narrow/field.h"

/* How far outside, relative to the size, a face lies that cannot meet a block. */
#define NEAR 1e-3

/* All faces of both blocks as planes about a point, those of A's and B's `border` masks as borders. */
typedef struct planes {
    double number[4][512];
    bool all;
    tl_field_faces faces;
} planes;

/* All integrals of one pair. */
static inline bool field_integrate(const tl_field_faces *faces, tl_field_scratch *scratch, tl_field_sums *sums)
{
    return tl_field_integrate(&faces, &sums, 1, scratch);
}

/* Whether a face may meet the other block: not when all its corners lie outside one face of the other. */
static bool may_meet(const tl_pair_view *view, bool of_b, uint32_t face)
{
    const tl_poly *p = of_b ? view->b : view->a, *q = of_b ? view->a : view->b;
    const tl_vec3 *vertex = of_b ? view->vertex_b : view->a->vertex;
    for (uint32_t g = 0; g < q->face_count; g++) {
        tl_vec3 n = of_b ? q->plane[g].normal : view->normal_b[g];
        double c = q->plane[g].offset + (of_b ? 0 : tl_v3_dot(n, view->shift)), low = INFINITY;
        for (uint32_t h = p->start[face]; h < p->start[face + 1]; h++)
            low = fmin(low, tl_v3_dot(n, vertex[p->loop[h]]) - c);
        if (low > NEAR * view->size)
            return false;
    }
    return true;
}

static void add_planes(planes *p, const tl_pair_view *view, bool of_b, const uint8_t *border, bool wanted,
                       tl_vec3 origin, uint32_t *count)
{
    const tl_poly *poly = of_b ? view->b : view->a;
    for (uint32_t f = 0; f < poly->face_count; f++) {
        if ((border && border[f]) != wanted || (!p->all && !may_meet(view, of_b, f)))
            continue;
        tl_vec3 n = of_b ? view->normal_b[f] : poly->plane[f].normal;
        double c = poly->plane[f].offset + (of_b ? tl_v3_dot(n, view->shift) : 0);
        uint32_t i = p->faces.a + p->faces.b + p->faces.border_a + p->faces.border_b;
        p->number[0][i] = n.x;
        p->number[1][i] = n.y;
        p->number[2][i] = n.z;
        p->number[3][i] = c - tl_v3_dot(n, origin);
        ++*count;
    }
}

static void list_planes(planes *p, const tl_pair_view *view, const uint8_t *border_a, const uint8_t *border_b,
                        tl_vec3 origin)
{
    p->faces = (tl_field_faces){.n = {p->number[0], p->number[1], p->number[2]}, .c = p->number[3]};
    add_planes(p, view, false, border_a, false, origin, &p->faces.a);
    add_planes(p, view, true, border_b, false, origin, &p->faces.b);
    add_planes(p, view, false, border_a, true, origin, &p->faces.border_a);
    add_planes(p, view, true, border_b, true, origin, &p->faces.border_b);
}

typedef struct scene {
    scene_pair pair;
    planes planes;
    uint8_t border_a[256], border_b[256];
    bool borders, apart;
    tl_vec3 origin; /* near the common volume */
    int power;      /* of d in the integral over K that is looked at: 2 or 3, else 1 */
} scene;

static void list_scene(scene *s)
{
    const tl_pair_view *view = scene_place(&s->pair);
    /* faces that cannot meet may be left out of blocks that do; of blocks that are apart all are needed to tell */
    s->planes.all = s->borders || s->apart || !tl_coarse_test(view, 0);
    list_planes(&s->planes, view, s->borders ? s->border_a : NULL, s->borders ? s->border_b : NULL, s->origin);
    s->planes.faces.powers = s->power > 1;
}

static tl_vec3 axis_of(int k)
{
    return tl_v3(k == 0, k == 1, k == 2);
}

static tl_poly *shape_of(uint64_t *seed, int kind)
{
    switch (kind) {
    case 0: return scene_box_shape(1, 1, 1);
    case 1: return scene_random_hull(seed, 14, tl_v3(0.6, 0.6, 0.6));
    case 2: return scene_box_shape(2, 2, 0.2);
    case 3: return scene_box_shape(0.2, 0.2, 2);
    case 4: return scene_box_shape(10, 10, 10);
    case 5: return scene_random_hull(seed, 40, tl_v3(0.5, 0.7, 0.6));
    default: return scene_random_hull(seed, 5, tl_v3(0.6, 0.6, 0.6));
    }
}

/* Moves B along a direction until it overlaps by a depth from where they touch. */
static void dip(scene *s, tl_vec3 way, double depth)
{
    double out = exact_way_out(scene_place(&s->pair), way);
    s->pair.shift = tl_v3_madd(s->pair.shift, out - depth, way);
    s->apart = depth < 0;
}

/* A point of the common volume: vertices of one inside the other, or crossings of edges with faces; the mean. */
static tl_vec3 middle_of(const tl_pair_view *view)
{
    tl_vec3 sum = tl_v3(0, 0, 0);
    int count = 0;
    for (int side = 0; side < 2; side++) {
        const tl_poly *p = side ? view->b : view->a, *q = side ? view->a : view->b;
        const tl_vec3 *vertex = side ? view->vertex_b : view->a->vertex;
        for (uint32_t e = 0; e < p->edge_count; e++) {
            double from = 0, to = 1;
            tl_vec3 x = vertex[p->edge[e].a], d = tl_v3_sub(vertex[p->edge[e].b], x);
            for (uint32_t f = 0; f < q->face_count; f++) {
                tl_vec3 n = side ? q->plane[f].normal : view->normal_b[f];
                double c = q->plane[f].offset + (side ? 0 : tl_v3_dot(n, view->shift));
                double h = tl_v3_dot(n, x) - c, slope = tl_v3_dot(n, d);
                if (slope > 0)
                    to = fmin(to, -h / slope);
                else if (slope < 0)
                    from = fmax(from, -h / slope);
                else if (h > 0)
                    to = -1;
            }
            if (to >= from) {
                sum = tl_v3_add(sum, tl_v3_madd(x, 0.5 * (from + to), d));
                count++;
            }
        }
    }
    return count ? tl_v3_scale(1.0 / count, sum) : sum;
}

/* Two blocks that overlap by a depth, relative to the smaller one's size. */
static void make_scene(scene *s, int one, int other, double depth, bool flush, uint64_t *seed)
{
    *s = (scene){.pair = scene_pair_of(shape_of(seed, one), shape_of(seed, other),
                                       flush ? tl_q_identity() : scene_any_turn(seed),
                                       tl_v3_scale(0.3, scene_direction(seed)))};
    scene_place(&s->pair);
    tl_vec3 way = scene_direction(seed);
    if (flush)
        way = axis_of((int)(3 * check_random(seed)));
    dip(s, way, depth * s->pair.view.size);
    s->origin = middle_of(scene_place(&s->pair));
}

static void free_scene(scene *s)
{
    scene_pair_free(&s->pair);
}

static int random_kind(uint64_t *seed)
{
    return (int)(7 * check_random(seed));
}

#endif
