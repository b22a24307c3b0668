/* grazing_properties.c - grazing pairs, which touch without area: as long as two faces say that nothing is carried, a
 * look at all faces finds no more than that.
 *
 * Boxes, some of them sheared, meet in an edge or a corner, or nearly; then B moves as far as it may, in any way. */
#include "contact_scene.h"
#include "detect/grazing.h"
#include "geometry/make.h"
#include "narrow/manifold.h"

/* Overlap along both of two directions that may go unseen, over the size, as in grazing.c. */
#define UNSEEN 2e-4
/* The prism in common may be skew (sine of its angle, 0.7), and s is that of the deepest point: bound on force over
 * stiffness, in units of (UNSEEN size)^2 times the blocks' largest diameter. */
#define SKEW 3

/* A box sheared along x and y by its height. */
static tl_poly *some_block(uint64_t *seed, tl_vec3 *side)
{
    *side = tl_v3(scene_between(seed, 0.3, 2), scene_between(seed, 0.3, 2), scene_between(seed, 0.3, 2));
    return scene_box_shape(side->x, side->y, side->z);
}

static tl_poly *sheared(tl_poly *box, double by)
{
    tl_vec3 points[8];
    for (int i = 0; i < 8; i++) {
        points[i] = box->vertex[i];
        points[i].x += by * points[i].y;
    }
    tl_poly_free(box);
    return scene_hull_shape(points, 8);
}

static double small(uint64_t *seed, double low, double high)
{
    double x = pow(10, scene_between(seed, low, high));
    return check_random(seed) < 0.5 ? -x : x;
}

/* Edge along edge, or corner at corner. */
static scene_pair touching_pair(uint64_t *seed)
{
    tl_vec3 p, q;
    tl_poly *a = some_block(seed, &p), *b = some_block(seed, &q);
    tl_vec3 shift = tl_v3_scale(0.5, tl_v3_add(p, q));
    double shear = check_random(seed) < 0.5 ? 0 : scene_between(seed, -0.4, 0.4);
    if (check_random(seed) < 0.5)
        shift.z *= scene_between(seed, -0.9, 0.9);
    else
        shift.z += small(seed, -8, -4);
    shift.y += small(seed, -8, -3);
    shift.x += shear * shift.y + small(seed, -8, -3);
    tl_quat tilt = scene_turn(scene_direction(seed), small(seed, -9, -1.7));
    return scene_pair_of(sheared(a, shear), sheared(b, shear), tilt, shift);
}

static double far(const tl_poly *p)
{
    double r = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        r = fmax(r, tl_v3_norm(p->vertex[i]));
    return r;
}

/* Moves B by the odometer `way`. */
static void move(scene_pair *p, double way, uint64_t *seed)
{
    double turn = check_random(seed) < 0.5 ? 0 : way * check_random(seed);
    p->shift = tl_v3_madd(p->shift, way - turn, scene_direction(seed));
    p->turn = tl_q_mul(scene_turn(scene_direction(seed), turn / far(p->b)), p->turn);
}

/* What the pair carries over its normal stiffness, at most. */
static double carried(scene_pair *p)
{
    const tl_manifold_before none = {.kind = TL_FACET_PATCH};
    const tl_pair_view *view = scene_place(p);
    tl_touch_rule rule = {.reach = TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size};
    tl_region region;
    CHECK(tl_region_find(view, TL_LIST_MARGIN * view->size, &p->scratch, &region));
    CHECK(tl_manifold_find(view, &region, &rule, &none, &p->scratch));
    const tl_manifold *m = &p->scratch.manifold;
    double area = 0;
    for (size_t i = 0; i < m->point_count; i++)
        area += m->points[i].area;
    if (m->point_count && m->facet.kind == TL_FACET_FIELD)
        return 2 * tl_v3_norm(m->press->force);
    return fmax(0, -region.gap) * area;
}

TEST(what_goes_unseen_is_little)
{
    uint64_t seed = 1;
    int silent = 0, broken = 0;
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        scene_pair p = touching_pair(&seed);
        tl_pair pair = {0};
        double gap, unseen = UNSEEN * scene_place(&p)->size;
        tl_grazing_choose_faces(&p.view, &pair, NULL);
        double margin = tl_grazing_margin(&p.view, &pair, &gap);
        silent += margin >= 0;
        tl_vec3 shift = p.shift;
        tl_quat turn = p.turn;
        for (int k = 0; k < 8 && margin >= 0; k++) {
            p.shift = shift;
            p.turn = turn;
            move(&p, margin * (k < 4 ? 1 : check_random(&seed)), &seed);
            double bound = unseen * unseen * 2 * fmax(far(p.a), far(p.b));
            double force = carried(&p) / bound;
            worst = fmax(worst, force);
            broken += force > SKEW;
        }
        scene_pair_free(&p);
    }
    CHECK(silent > 1000);
    CHECK_INT(broken, 0);
    if (broken || getenv("TALUS_TEST_VERBOSE"))
        printf("  %d silent, worst %.3g of the bound\n", silent, worst);
}

/* Faces that are too deep to show that a pair grazes are passed over, and nothing else comes of it. */
TEST(deep_faces_are_passed_over)
{
    uint64_t seed = 3;
    int silent = 0, others = 0, passed = 0;
    for (int i = 0; i < 4000; i++) {
        scene_pair p = touching_pair(&seed);
        if (i % 2) /* over the face */
            p.shift.x -= scene_between(&seed, 0.01, 0.2);
        const tl_pair_view *view = scene_place(&p);
        tl_pair all = {0}, some = {0};
        tl_region_lows lows;
        double gap, gap_of_some;
        CHECK(tl_region_gap(view, &p.scratch, &lows));
        tl_grazing_choose_faces(view, &all, NULL);
        tl_grazing_choose_faces(view, &some, &lows);
        double margin = tl_grazing_margin(view, &all, &gap);
        double margin_of_some = tl_grazing_margin(view, &some, &gap_of_some);
        silent += margin >= 0;
        passed += all.faces != some.faces;
        if (lows.gap <= TL_CONTACT_TOLERANCE * view->size)
            others += margin >= 0 ? margin != margin_of_some || gap != gap_of_some : margin_of_some >= 0;
        scene_pair_free(&p);
    }
    CHECK(silent > 500);
    CHECK(passed > 500);
    CHECK_INT(others, 0);
}

/* A pair that slides from its edge over the other's face is seen at once. */
TEST(sliding_over_an_edge_is_seen)
{
    uint64_t seed = 2;
    int unseen = 0, carrying = 0;
    for (int i = 0; i < 2000; i++) {
        scene_pair p = touching_pair(&seed);
        tl_pair pair = {0};
        double gap;
        tl_grazing_choose_faces(scene_place(&p), &pair, NULL);
        p.shift.x -= scene_between(&seed, 0.01, 0.2);
        scene_place(&p);
        double carries = carried(&p), u = UNSEEN * p.view.size;
        bool much = carries > SKEW * u * u * 2 * fmax(far(p.a), far(p.b));
        carrying += much;
        unseen += much && tl_grazing_margin(&p.view, &pair, &gap) >= 0;
        scene_pair_free(&p);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  %d carry, %d unseen\n", carrying, unseen);
    CHECK(carrying > 200);
    CHECK_INT(unseen, 0);
}

TEST_MAIN(RUN(what_goes_unseen_is_little), RUN(deep_faces_are_passed_over), RUN(sliding_over_an_edge_is_seen))
