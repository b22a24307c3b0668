/* test_broad.c - candidate pairs against all pairs of bounds, and contacts of moving blocks against a
 * search of all pairs: the odometers must never let one slip by. */
#include "contact/pair_view.h"
#include "contact_scene.h"
#include "detect/detect.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "narrow/manifold.h"
#include "property/exact_axis.h"

/* ---------------------------------------------------------------- candidates ------------- */

static tl_bounds bounds_of(const tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    const tl_poly *p = m->blocks.shape[row];
    tl_bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        tl_vec3 x = tl_v3_add(tl_body_place(&m->bodies, body), tl_m3_mul(&m->bodies.pose[body].r, p->vertex[i]));
        b.min = tl_v3_min(b.min, x);
        b.max = tl_v3_max(b.max, x);
    }
    return b;
}

static int overlap(tl_bounds a, tl_bounds b, double growth)
{
    return a.min.x <= b.max.x + growth && b.min.x <= a.max.x + growth && a.min.y <= b.max.y + growth &&
           b.min.y <= a.max.y + growth && a.min.z <= b.max.z + growth && b.min.z <= a.max.z + growth;
}

/* Every pair of bounds nearer than the contact tolerance is listed, once, in order; nothing is listed
 * that is farther apart than both skins and the mean of both blocks' tolerances of release. Returns the
 * number of pairs. */
static size_t check_pairs(tl_model *m)
{
    scene_ok(m, tl_detect_refresh(m));
    const tl_detect *d = m->detect;
    size_t rows = m->blocks.table.rows, missing = 0, absurd = 0;
    tl_bounds *bounds = malloc(rows * sizeof *bounds);
    unsigned char *listed = calloc(rows * rows, 1);
    for (uint32_t i = 0; i < rows; i++)
        bounds[i] = bounds_of(m, i);
    for (size_t i = 0; i < d->pair_count; i++) {
        const tl_pair *p = &d->pairs[i];
        CHECK(p->a < p->b);
        if (i)
            CHECK(p[-1].a < p->a || (p[-1].a == p->a && p[-1].b < p->b));
        listed[p->a * rows + p->b] = 1;
    }
    for (uint32_t a = 0; a < rows; a++)
        for (uint32_t b = a + 1; b < rows; b++) {
            double size = fmin(m->blocks.size[a], m->blocks.size[b]);
            int on = listed[a * rows + b];
            missing += !on && overlap(bounds[a], bounds[b], TL_CONTACT_TOLERANCE * size);
            double far = 2 * d->reach +
                         TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * 0.501 * (m->blocks.size[a] + m->blocks.size[b]);
            absurd += on && !overlap(bounds[a], bounds[b], far);
        }
    CHECK_INT(missing, 0);
    CHECK_INT(absurd, 0);
    free(bounds);
    free(listed);
    return d->pair_count;
}

static void random_boxes(tl_model *m, uint64_t *seed, int count, double extent, double decades)
{
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    for (int i = 0; i < count; i++) {
        double size = pow(10, scene_between(seed, -decades, 0));
        tl_vec3 low = {scene_between(seed, 0, extent), scene_between(seed, 0, extent), scene_between(seed, 0, extent)};
        tl_vec3 far = {size * scene_between(seed, 0.3, 1), size * scene_between(seed, 0.3, 1),
                       size * scene_between(seed, 0.3, 1)};
        scene_ok(m, tl_stage_add_box(&stage, low, tl_v3_add(low, far), 2000, "box"));
    }
    scene_ok(m, tl_stage_commit(&stage));
}

TEST(grid_lists_all_near_pairs)
{
    uint64_t seed = 1;
    for (int i = 0; i < 12; i++) {
        tl_model *m = scene_model(1);
        scene_law(m, "coulomb", 1e9, 1e9, 30);
        random_boxes(m, &seed, 300, i % 2 ? 6 : 3, i % 4);
        CHECK(check_pairs(m) > 0);
        tl_model_destroy(m);
    }
}

TEST(grid_lists_pairs_of_many_blocks)
{
    uint64_t seed = 2;
    tl_model *m = scene_model(1);
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    random_boxes(m, &seed, 1000, 9, 0.3);
    CHECK(check_pairs(m) > 0);
    tl_model_destroy(m);
}

/* Clusters a million apart, in a model whose grid must not be huge. */
TEST(grid_serves_clusters_far_apart)
{
    uint64_t seed = 3;
    tl_model *m = scene_model(1);
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    for (int k = 0; k < 6; k++) {
        tl_vec3 at = tl_v3_scale(1e6, scene_direction(&seed));
        for (int i = 0; i < 12; i++) {
            tl_vec3 low = tl_v3_add(at, tl_v3(i % 3, i / 3 % 2, i / 6));
            scene_box(m, low, tl_v3_add(low, tl_v3(1, 1, 1)));
        }
    }
    /* every cluster is a lattice of 3 x 2 x 2 boxes: 2*4 + 3*2 + 3*2 = 20 face neighbours */
    check_pairs(m);
    CHECK_INT(m->detect->contacts.table.rows, 6 * 20);
    tl_model_destroy(m);
}

/* A thousand small blocks on a plate a thousand times larger: the plate's tolerance is not theirs. */
TEST(one_huge_block_does_not_multiply_the_pairs)
{
    tl_model *m = scene_model(1);
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    for (int i = 0; i < 1000; i++) {
        tl_vec3 low = {1.5 * (i % 32), 1.5 * (double)(i / 32), 0};
        scene_ok(m, tl_stage_add_box(&stage, low, tl_v3_add(low, tl_v3(1, 1, 1)), 2000, "box"));
    }
    scene_ok(m, tl_stage_add_box(&stage, tl_v3(-500, -500, -1000), tl_v3(500, 500, 0), 2000, "box"));
    scene_ok(m, tl_stage_commit(&stage));
    CHECK_INT(check_pairs(m), 1000);
    CHECK_INT(m->detect->contacts.table.rows, 1000);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- moving ----------------- */

enum { MOVING = 30 };
#define STIFFNESS 1e6

/* Error of a normal force that is kept for a motion of 1e-11 of the overlap, and of the roundings of its sums. */
#define SAME_FORCE 1e-9

static double normal_force(const tl_model *m, uint32_t c)
{
    const double *f_n = m->detect->points.f_n;
    return f_n[tl_point_row(&m->detect->contacts, c, TL_FIELD_SHEAR)];
}

/* Whether a field contact carries what a field contact does that is found by a look at all. */
static bool as_found(const tl_model *m, uint32_t c, const tl_manifold *found)
{
    const tl_contacts *contacts = &m->detect->contacts;
    if (contacts->facet[c].kind != TL_FACET_FIELD || found->facet.kind != TL_FACET_FIELD ||
        contacts->point_count[c] == 0 || found->point_count == 0)
        return contacts->point_count[c] > 0 || found->point_count == 0;
    double want = 2 * STIFFNESS * tl_v3_norm(found->press->force);
    return fabs(normal_force(m, c) - want) <= SAME_FORCE * want;
}

/* All pairs against the contacts there are, those that are far apart along some face left out; the band between the
 * tolerances of birth and death, too. */
static void check_contacts(tl_model *m, tl_narrow_scratch *scratch, int *closed, int *lost, int *stale)
{
    const tl_manifold_before none = {.kind = TL_FACET_PATCH};
    for (uint32_t a = 0; a < MOVING; a++)
        for (uint32_t b = a + 1; b < MOVING; b++) {
            tl_pair_view view = tl_pair_view_of(m, a, b);
            if (!tl_pair_place(&view, scratch))
                exit(1);
            double tolerance = TL_CONTACT_TOLERANCE * view.size;
            uint32_t c = scene_contact(m, a, b);
            tl_region region;
            if (!tl_region_find(&view, TL_LIST_MARGIN * view.size, scratch, &region))
                exit(1);
            double apart = region.gap > 2 * tolerance ? region.gap : (double)brute_force(&view).s;
            *stale += c != TL_NO_ROW && apart > 1.501 * tolerance;
            if (apart > 0.99 * tolerance)
                continue;
            tl_touch_rule rule = {.reach = TL_CONTACT_RELEASE * tolerance};
            if (!tl_manifold_find(&view, &region, &rule, &none, scratch))
                exit(1);
            *closed += apart < 0;
            *lost += c == TL_NO_ROW && scratch->manifold.point_count > 0;
            *lost += apart < 0 && scratch->manifold.point_count == 0;
            *stale += c != TL_NO_ROW && !as_found(m, c, &scratch->manifold);
        }
}

static void move_about(int64_t threads, double most_step, int steps, int *closed, int *lost, int *stale)
{
    tl_model *m = scene_model(threads);
    uint64_t seed = 21;
    tl_narrow_scratch scratch = {0};
    for (int i = 0; i < MOVING; i++) {
        tl_poly *p =
            i % 3 ? scene_random_hull(&seed, 10, tl_v3(0.5, 0.5, 0.5)) : scene_box_shape(1, 0.2 + 0.025 * i, 0.7);
        scene_block(m, p, scene_any_turn(&seed), tl_v3(i % 3 * 1.0, i / 3 % 3 * 1.0, i / 9 * 1.0));
    }
    scene_law(m, "coulomb", STIFFNESS, STIFFNESS, 30);
    tl_vec3 v[MOVING], w[MOVING];
    for (int step = 0; step < steps; step++) {
        if (step % 40 == 0) /* new directions; some rest, some crawl, some run */
            for (int i = 0; i < MOVING; i++) {
                double speed = most_step * pow(10, -6 * check_random(&seed));
                speed = check_random(&seed) < 0.2 ? 0 : speed;
                v[i] = tl_v3_scale(speed, scene_direction(&seed));
                w[i] = tl_v3_scale(speed, scene_direction(&seed));
            }
        for (uint32_t i = 0; i < MOVING; i++) {
            tl_vec3 x = tl_body_place(&m->bodies, i);
            /* kept together by a fence */
            if (fabs(x.x) > 2)
                v[i].x = copysign(v[i].x, -x.x);
            if (fabs(x.y) > 2)
                v[i].y = copysign(v[i].y, -x.y);
            if (fabs(x.z) > 2)
                v[i].z = copysign(v[i].z, -x.z);
            scene_move(m, i, v[i], w[i]);
        }
        scene_forces(m);
        if (step % 50 == 0)
            check_contacts(m, &scratch, closed, lost, stale);
    }
    tl_narrow_scratch_free(&scratch);
    tl_model_destroy(m);
}

TEST(moving_blocks_lose_no_contact)
{
    int closed = 0, lost = 0, stale = 0;
    move_about(1, 0.05, 3000, &closed, &lost, &stale);
    move_about(1, 1e-3, 3000, &closed, &lost, &stale);
    move_about(2, 5e-3, 2000, &closed, &lost, &stale);
    CHECK(closed > 2000);
    CHECK_INT(lost, 0);
    CHECK_INT(stale, 0);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  %d closed pairs, %d lost, %d stale\n", closed, lost, stale);
}

TEST_MAIN(RUN(grid_lists_all_near_pairs), RUN(grid_lists_pairs_of_many_blocks), RUN(grid_serves_clusters_far_apart),
          RUN(one_huge_block_does_not_multiply_the_pairs), RUN(moving_blocks_lose_no_contact))
