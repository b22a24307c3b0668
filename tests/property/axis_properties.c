/* axis_properties.c - the common plane and the first look against independent references.
 *
 * tl_axis_search is compared with a search in long double over all faces and all pairs of edges, in
 * both directions, each with full support: no Gauss map, no early end. A pair of a class is moved along
 * its axis until it overlaps, or is apart, by 1e-3 to 1e-9 of its size. The first look is compared with
 * the distance of all features, and libccd without any growth is a third opinion. */
#include "contact_scene.h"
#include "exact_axis.h"
#include "narrow/look.h"

#include <ccd/ccd.h>

/* Allowed error of the depth over the smaller block's size, and over the larger block's extent: a few
 * dozen roundings of the coordinates, which matter when a block is 1000 times larger. */
#define DEPTH_ERROR 1e-12
#define COORDINATE_ERROR 2e-15
/* Allowed error of the lead over the next best axis, over |s|: two axes that tie but for rounding may go for one. */
#define LEAD_ERROR 1e-3
/* An axis is unique when the next best one is behind by this times the size. */
#define CLEAR_LEAD 1e-6

/* ---------------------------------------------------------------- classes of pairs ------- */

enum {
    FACES_EXACT,
    FACES_TILTED,
    BOX_STACK,
    VERTEX_FACE,
    EDGE_FACE,
    EDGE_EDGE,
    NEAR_PARALLEL_EDGES,
    SLIVERS,
    SIZE_RATIO,
    BOX_CORNERS,
    BOX_EDGES,
    RANDOM_HULLS,
    CLASS_COUNT
};

static const char *const class_name[CLASS_COUNT] = {
    "faces exact", "faces tilted", "box stack",           "vertex-face",
    "edge-face",   "edge-edge",    "near-parallel edges", "slivers",
    "size ratio",  "box corners",  "box edges",           "random hulls"};
static const int class_pairs[CLASS_COUNT] = {3000, 3000, 3000, 3000, 3000, 3000,
                                             6000, 1800, 2400, 3000, 3000, 900};

static const tl_quat none = {1, 0, 0, 0};

static tl_poly *some_box(uint64_t *seed)
{
    return scene_box_shape(scene_between(seed, 0.5, 2), scene_between(seed, 0.5, 2),
                           scene_between(seed, 0.5, 2));
}

/* The turn that brings direction `from` to direction `to`. */
static tl_quat turn_to(tl_vec3 from, tl_vec3 to)
{
    tl_vec3 a = tl_v3_unit(from), b = tl_v3_unit(to), w = tl_v3_cross(a, b);
    return tl_q_unit((tl_quat){1 + tl_v3_dot(a, b), w.x, w.y, w.z});
}

/* A small angle, 1e-9 to 1e-2 rad, of either sign. */
static double small_angle(uint64_t *seed)
{
    double angle = pow(10, scene_between(seed, -9, -2));
    return check_random(seed) < 0.5 ? -angle : angle;
}

/* An edge of B, turned down, across an edge of A, at an angle of `cross`. */
static scene_pair crossing_edges(tl_poly *a, uint64_t *seed, double cross)
{
    const tl_vec3 up = {0, 0, 1}, along = {1, 0, 0}, corner = a->vertex[0];
    /* A's edges along x come to the top when B is placed above one of them */
    tl_vec3 ridge = {0, scene_between(seed, 0.3, 1), scene_between(seed, 0.3, 1)};
    tl_quat lean = scene_turn(along, scene_between(seed, 0.5, 1.07));
    tl_quat on_edge = tl_q_mul(turn_to(up, ridge), tl_q_mul(scene_turn(up, cross), lean));
    tl_vec3 foot = {scene_between(seed, -0.3, 0.3), fabs(corner.y), fabs(corner.z)};
    return scene_pair_of(a, some_box(seed), on_edge, tl_v3_madd(foot, 1.2, tl_v3_unit(ridge)));
}

/* A block on one a thousand times larger. */
static scene_pair unequal_sizes(uint64_t *seed)
{
    tl_vec3 place = {scene_between(seed, -450, 450), scene_between(seed, -450, 450), 502};
    tl_poly *small =
        check_random(seed) < 0.5 ? some_box(seed) : scene_random_hull(seed, 9, tl_v3(1, 1, 1));
    tl_quat turn = check_random(seed) < 0.3 ? none : scene_any_turn(seed);
    return scene_pair_of(scene_box_shape(1000, 1000, 1000), small, turn, place);
}

/* Two blocks of a class, near each other; the gap is set afterwards, times `scale`: nearly parallel edges
 * are each other's nearest features only at gaps far below their length times their angle. */
static scene_pair make_pair(int class, uint64_t *seed, double *scale)
{
    *scale = 1;
    tl_vec3 side = {scene_between(seed, -0.4, 0.4), scene_between(seed, -0.4, 0.4), 1.5};
    tl_vec3 flat = {scene_between(seed, -1, 1), scene_between(seed, -1, 1), 0};
    tl_vec3 up = {0, 0, 1};
    tl_poly *a = some_box(seed);
    switch (class) {
    case FACES_EXACT:
        return scene_pair_of(a, some_box(seed), scene_turn(up, scene_between(seed, 0, 7)), side);
    case FACES_TILTED:
        return scene_pair_of(a, some_box(seed), scene_turn(flat, small_angle(seed)), side);
    case BOX_STACK: /* equal boxes, one on the other, or nearly */
        tl_poly_free(a);
        side.x = side.y = 0;
        return scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1),
                             check_random(seed) < 0.5 ? none : scene_turn(flat, small_angle(seed)),
                             side);
    case VERTEX_FACE:
        return scene_pair_of(a, scene_random_hull(seed, 8, tl_v3(1, 1, 1)), scene_any_turn(seed),
                             side);
    case EDGE_FACE: /* a box on its edge */
        return scene_pair_of(a, some_box(seed),
                             tl_q_mul(scene_turn(up, scene_between(seed, 0, 7)),
                                      scene_turn(tl_v3(1, 0, 0), scene_between(seed, 0.3, 1.2))),
                             side);
    case EDGE_EDGE: return crossing_edges(a, seed, scene_between(seed, 0.2, 1.5));
    case NEAR_PARALLEL_EDGES: {
        double cross = pow(10, scene_between(seed, -9, -3));
        if (check_random(seed) < 0.8)
            *scale = fmin(1, 0.1 * cross / 1e-3);
        return crossing_edges(a, seed, cross);
    }
    case SLIVERS: {
        double thin = pow(10, scene_between(seed, -4, -1));
        tl_poly_free(a);
        a = check_random(seed) < 0.5 ? scene_box_shape(1, thin, 1)
                                     : scene_random_hull(seed, 8, tl_v3(1, thin, 1));
        return scene_pair_of(a, scene_box_shape(1, 1, thin), scene_any_turn(seed),
                             scene_direction(seed));
    }
    case SIZE_RATIO: tl_poly_free(a); return unequal_sizes(seed);
    case BOX_CORNERS: { /* corner to corner, aligned or nearly or not at all */
        tl_poly_free(a);
        tl_quat turn = none;
        if (check_random(seed) < 0.6)
            turn = check_random(seed) < 0.5 ? scene_any_turn(seed)
                                            : scene_turn(scene_direction(seed), small_angle(seed));
        return scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), turn,
                             tl_v3(1, 1, 1));
    }
    case BOX_EDGES: { /* edge along edge, in a lattice or nearly: axes tie */
        tl_poly_free(a);
        tl_vec3 by = tl_v3_scale(pow(10, scene_between(seed, -9, -4)), scene_direction(seed));
        return scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1),
                             scene_turn(scene_direction(seed), small_angle(seed)),
                             tl_v3_add(tl_v3(1, 1, scene_between(seed, -0.9, 0.9)), by));
    }
    default:
        tl_poly_free(a);
        a = scene_random_hull(seed, 8 + (size_t)(6 * check_random(seed)), tl_v3(1, 1, 1));
        return scene_pair_of(a,
                             scene_random_hull(seed, 8 + (size_t)(6 * check_random(seed)),
                                               tl_v3(1, scene_between(seed, 0.3, 1), 1)),
                             scene_any_turn(seed), tl_v3_scale(2, scene_direction(seed)));
    }
}

/* Moves B along its best axis until s is `gap`; the best axis may change on the way. */
static void set_gap(scene_pair *p, double gap, best_axis *best)
{
    real by = gap - best->s;
    p->shift = tl_v3_add(p->shift, tl_v3((double)(by * best->n.x), (double)(by * best->n.y),
                                         (double)(by * best->n.z)));
    *best = brute_force(scene_place(p));
}

/* The same for a pair just made. */
static best_axis first_gap(scene_pair *p, double gap)
{
    best_axis best = brute_force(scene_place(p));
    for (int pass = 0; pass < 3; pass++)
        set_gap(p, gap, &best);
    return best;
}

/* ---------------------------------------------------------------- distance --------------- */

/* Distance of two segments, by their four ends and the crossing of their lines. */
static double segment_distance(tl_vec3 p, tl_vec3 q, tl_vec3 r, tl_vec3 t)
{
    tl_vec3 u = tl_v3_sub(q, p), v = tl_v3_sub(t, r), w = tl_v3_sub(r, p);
    double uu = tl_v3_norm2(u), vv = tl_v3_norm2(v), uv = tl_v3_dot(u, v);
    double wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v), det = uu * vv - uv * uv;
    double best = INFINITY;
    for (int k = 0; k < 5; k++) {
        double x, y;
        if (k == 4) {
            x = det > 0 ? (wu * vv - wv * uv) / det : 0;
            y = det > 0 ? (wu * uv - wv * uu) / det : 0;
            x = fmin(1, fmax(0, x));
            y = fmin(1, fmax(0, y));
        } else if (k < 2) { /* an end of the first segment */
            x = k;
            y = fmin(1, fmax(0, (k * uv - wv) / vv));
        } else {
            y = k - 2;
            x = fmin(1, fmax(0, (wu + y * uv) / uu));
        }
        tl_vec3 d = tl_v3_madd(tl_v3_madd(w, y, v), -x, u);
        best = fmin(best, tl_v3_norm(d));
    }
    return best;
}

/* Height of x over a face if it lies within the face's outline, else infinity. */
static double over_face_distance(const tl_poly *p, uint32_t f, tl_vec3 x)
{
    tl_vec3 n = p->plane[f].normal;
    uint32_t count = tl_poly_face_size(p, f);
    for (uint32_t i = 0; i < count; i++) {
        tl_vec3 c = p->vertex[p->loop[p->start[f] + i]];
        tl_vec3 d = p->vertex[p->loop[p->start[f] + (i + 1) % count]];
        if (tl_v3_dot(tl_v3_cross(n, tl_v3_sub(d, c)), tl_v3_sub(x, c)) < 0)
            return INFINITY;
    }
    double h = tl_v3_dot(n, x) - p->plane[f].offset;
    return h >= 0 ? h : INFINITY;
}

/* Distance of two blocks that are apart, by all pairs of features. */
static double distance(const tl_pair_view *view)
{
    const tl_poly *a = view->a, *b = view->b;
    double best = INFINITY;
    for (uint32_t i = 0; i < a->edge_count; i++)
        for (uint32_t j = 0; j < b->edge_count; j++)
            best = fmin(best, segment_distance(a->vertex[a->edge[i].a], a->vertex[a->edge[i].b],
                                               view->vertex_b[b->edge[j].a],
                                               view->vertex_b[b->edge[j].b]));
    for (uint32_t f = 0; f < a->face_count; f++)
        for (uint32_t i = 0; i < b->vertex_count; i++)
            best = fmin(best, over_face_distance(a, f, view->vertex_b[i]));
    for (uint32_t f = 0; f < b->face_count; f++)
        for (uint32_t i = 0; i < a->vertex_count; i++) {
            tl_vec3 x = tl_m3_tmul(&view->turn, tl_v3_sub(a->vertex[i], view->shift));
            best = fmin(best, over_face_distance(b, f, x));
        }
    return best;
}

/* ---------------------------------------------------------------- checks ----------------- */

typedef struct tally {
    int pairs, edges, signs, depths, leads, swaps, turns, misses, false_hits;
    double worst_depth;
} tally;

static double extent(const scene_pair *p)
{
    return fmax(p->a->size, p->b->size) + tl_v3_norm(p->shift);
}

static void check_search(scene_pair *p, const best_axis *best, tally *t)
{
    const tl_pair_view *view = &p->view;
    tl_axis axis = tl_axis_search(view, &p->room, NULL);
    t->edges += axis.kind == TL_AXIS_EDGES;
    double allowed = DEPTH_ERROR * view->size + COORDINATE_ERROR * extent(p);
    double error = fabs((double)(axis.s - best->s));
    /* a face is preferred within 1e-12 of the size: a gap below that may be reported as touching */
    t->signs += fabsl(best->s) > allowed && (axis.s < 0) != (best->s < 0);
    if (best->s >= 0) /* apart: a lower bound of the distance, and no better than the best */
        error = fmax(0, (double)(axis.s - best->s));
    t->depths += error > allowed;
    t->worst_depth = fmax(t->worst_depth, error / view->size);
    /* n is a unit vector, and s really is the separation along it */
    static exact e;
    load_exact(view, &e);
    t->depths += fabs(tl_v3_norm(axis.n) - 1) > 1e-14;
    t->depths += fabs((double)(separation(&e, lv(axis.n)) - axis.s)) > allowed;
    /* the lead over the next best axis is no larger than it is, but for a share of |s| far below AXIS_SHARE */
    allowed += LEAD_ERROR * fabs(axis.s);
    t->leads += axis.second < plain_second(view, &e, axis.n) - allowed;
}

/* B seen from A: the mirrored axis, the same s. */
static void check_swap(scene_pair *p, const best_axis *best, tally *t)
{
    tl_axis axis = tl_axis_search(&p->view, &p->room, NULL);
    tl_quat back = tl_q_conj(p->turn);
    scene_pair other = scene_pair_of(p->b, p->a, back, tl_v3_neg(tl_q_rotate(back, p->shift)));
    tl_axis mirror = tl_axis_search(scene_place(&other), &other.room, NULL);
    double allowed = 2 * (DEPTH_ERROR * p->view.size + 3 * COORDINATE_ERROR * extent(p));
    t->swaps += best->s < 0 && fabs(mirror.s - axis.s) > allowed;
    tl_vec3 n = tl_v3_neg(tl_q_rotate(p->turn, mirror.n));
    if (best->s < 0 && best->s - best->second > CLEAR_LEAD * p->view.size)
        t->swaps += scene_apart(n, axis.n) > 1e-6;
    tl_narrow_free(&other.room);
}

/* Both blocks turned alike: the axis turns with them. */
static void check_turned(scene_pair *p, const best_axis *best, tally *t, uint64_t *seed)
{
    tl_axis axis = tl_axis_search(&p->view, &p->room, NULL);
    tl_quat q = scene_any_turn(seed);
    tl_mat3 r = tl_q_matrix(q);
    tl_poly *turned;
    tl_error error;
    if (tl_poly_transformed(p->a, &r, tl_v3(0, 0, 0), &turned, &error) != TL_OK)
        exit(1);
    scene_pair other = scene_pair_of(turned, p->b, tl_q_mul(q, p->turn), tl_q_rotate(q, p->shift));
    tl_axis found = tl_axis_search(scene_place(&other), &other.room, NULL);
    double allowed = 2 * (DEPTH_ERROR * p->view.size + 4 * COORDINATE_ERROR * extent(p));
    t->turns += best->s < 0 && fabs(found.s - axis.s) > allowed;
    if (best->s < 0 && best->s - best->second > CLEAR_LEAD * p->view.size)
        t->turns += scene_apart(tl_q_rotate(q, axis.n), found.n) > 1e-6;
    tl_narrow_free(&other.room);
    tl_poly_free(turned);
}

/* The first look at reaches just above and just below the true distance. */
static void check_look(const scene_pair *p, const best_axis *best, tally *t)
{
    const tl_pair_view *view = &p->view;
    double tolerance = TL_CONTACT_TOLERANCE * view->size;
    if (best->s <= 0) {
        t->misses += !tl_look_near(view, tolerance);
        return;
    }
    double d = distance(view);
    t->misses += d < tolerance && !tl_look_near(view, tolerance);
    t->misses += !tl_look_near(view, d * 1.001 + 1e-8 * view->size);
    if (d > 1e-6 * view->size)
        t->false_hits += tl_look_near(view, d * 0.999 - 1e-8 * view->size);
}

TEST(search_agrees_with_brute_force)
{
    for (int class = 0; class < CLASS_COUNT; class ++) {
        tally t = {0};
        uint64_t seed = 1000 + (uint64_t) class;
        for (int i = 0; i < class_pairs[class]; i += 6) {
            double scale;
            scene_pair p = make_pair(class, &seed, &scale);
            double size = scene_place(&p)->size;
            best_axis best = first_gap(&p, -1e-4 * scale * size);
            for (int k = 0; k < 6; k++) { /* several gaps of one pair */
                double gap = scale * size * pow(10, scene_between(&seed, -9, -3));
                set_gap(&p, (k % 3 ? -1 : 1) * gap, &best);
                t.pairs++;
                check_search(&p, &best, &t);
                check_look(&p, &best, &t);
                if (k < 2) {
                    check_swap(&p, &best, &t);
                    check_turned(&p, &best, &t, &seed);
                }
            }
            scene_pair_free(&p);
        }
        /* the classes are what they are called */
        if (class == EDGE_EDGE || class == NEAR_PARALLEL_EDGES)
            CHECK(t.edges > t.pairs / 4);
        int ok = CHECK_INT(t.signs, 0);
        ok &= CHECK_INT(t.depths, 0);
        ok &= CHECK_INT(t.leads, 0);
        ok &= CHECK_INT(t.swaps, 0);
        ok &= CHECK_INT(t.turns, 0);
        ok &= CHECK_INT(t.misses, 0);
        ok &= CHECK_INT(t.false_hits, 0);
        if (!ok || getenv("TALUS_TEST_VERBOSE"))
            printf("  %s: %d pairs, %d by edges, worst depth error %.2g of the size\n",
                   class_name[class], t.pairs, t.edges, t.worst_depth);
    }
}

/* ---------------------------------------------------------------- libccd as a judge ------ */

typedef struct judged {
    const tl_vec3 *vertex;
    uint32_t count;
} judged;

static void judged_support(const void *object, const ccd_vec3_t *d, ccd_vec3_t *out)
{
    const judged *j = object;
    tl_vec3 direction = {d->v[0], d->v[1], d->v[2]}, best = j->vertex[0];
    for (uint32_t i = 1; i < j->count; i++)
        if (tl_v3_dot(direction, j->vertex[i]) > tl_v3_dot(direction, best))
            best = j->vertex[i];
    ccdVec3Set(out, best.x, best.y, best.z);
}

static void judged_center(const void *object, ccd_vec3_t *out)
{
    const judged *j = object;
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < j->count; i++)
        sum = tl_v3_add(sum, j->vertex[i]);
    ccdVec3Set(out, sum.x / j->count, sum.y / j->count, sum.z / j->count);
}

static int judge(const tl_pair_view *view)
{
    judged a = {view->a->vertex, view->a->vertex_count};
    judged b = {view->vertex_b, view->b->vertex_count};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = judged_support;
    ccd.center1 = ccd.center2 = judged_center;
    ccd.mpr_tolerance = 1e-12;
    ccd.max_iterations = 1000;
    return ccdMPRIntersect(&a, &b, &ccd);
}

TEST(libccd_agrees_on_touching)
{
    for (int class = 0; class < CLASS_COUNT; class ++) {
        uint64_t seed = 77 + (uint64_t) class;
        int wrong = 0;
        for (int i = 0; i < 300; i++) {
            double scale;
            scene_pair p = make_pair(class, &seed, &scale);
            double size = scene_place(&p)->size;
            first_gap(&p, (i % 2 ? -1 : 1) * pow(10, scene_between(&seed, -5, -2)) * size);
            tl_axis axis = tl_axis_search(&p.view, &p.room, NULL);
            wrong += judge(&p.view) != (axis.s < 0);
            scene_pair_free(&p);
        }
        if (!CHECK_INT(wrong, 0))
            printf("  %s\n", class_name[class]);
    }
}

/* ---------------------------------------------------------------- edges and following ---- */

TEST(normal_of_nearly_parallel_edges_is_perpendicular_to_both)
{
    uint64_t seed = 5;
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        tl_vec3 a = scene_direction(&seed);
        tl_quat tilt = scene_turn(tl_v3_perpendicular(a), pow(10, scene_between(&seed, -11, -2)));
        tl_vec3 b = tl_q_rotate(scene_turn(a, scene_between(&seed, 0, 7)), tl_q_rotate(tilt, a));
        tl_vec3 outward = scene_direction(&seed), n;
        if (!CHECK(tl_edge_normal(tl_v3_scale(3, a), tl_v3_scale(-0.1, b), outward, &n)))
            continue;
        worst = fmax(worst, fmax(fabs(tl_v3_dot(n, a)), fabs(tl_v3_dot(n, b))));
        worst = fmax(worst, fabs(tl_v3_norm(n) - 1));
        CHECK(tl_v3_dot(n, outward) >= 0);
    }
    CHECK(worst <= 1e-15);
    tl_vec3 n, x = {1, 0, 0};
    CHECK(!tl_edge_normal(x, tl_v3(-2, 0, 0), tl_v3(0, 0, 1), &n));
}

/* While a followed axis says it still holds, its s is the separation along its n, and never above the
 * best. */
TEST(followed_axis_keeps_its_word)
{
    uint64_t seed = 9;
    int broken = 0, above = 0, held = 0;
    for (int i = 0; i < 600; i++) {
        double scale;
        scene_pair p = make_pair(i % CLASS_COUNT, &seed, &scale);
        double size = scene_place(&p)->size;
        first_gap(&p, -1e-4 * size);
        tl_axis axis = tl_axis_search(&p.view, &p.room, NULL);
        for (int k = 0; k < 10; k++) {
            p.shift = tl_v3_madd(p.shift, 1e-5 * size, scene_direction(&seed));
            p.turn = tl_q_unit(tl_q_mul(scene_turn(scene_direction(&seed), 1e-5), p.turn));
            if (!tl_axis_follow(scene_place(&p), &axis))
                break;
            held++;
            static exact e;
            load_exact(&p.view, &e);
            double allowed = DEPTH_ERROR * size + COORDINATE_ERROR * extent(&p);
            broken += fabs((double)(separation(&e, lv(axis.n)) - axis.s)) > allowed;
            best_axis best = brute_force(&p.view);
            above += axis.s > (double)best.s + allowed;
        }
        scene_pair_free(&p);
    }
    CHECK(held > 2000);
    CHECK_INT(broken, 0);
    CHECK_INT(above, 0);
}

TEST_MAIN(RUN(search_agrees_with_brute_force), RUN(libccd_agrees_on_touching),
          RUN(normal_of_nearly_parallel_edges_is_perpendicular_to_both),
          RUN(followed_axis_keeps_its_word))
