/* test_transfer.c - when a contact gets other points: forces and moments stay at unchanged area, stresses
 * stay uniform when the area changes, and a law's states are copied, split or reset as it declares. */
#include "base/columns.h"
#include "contact/contacts.h"
#include "contact/store.h"
#include "contact/transfer.h"
#include "contact_scene.h"
#include "detect/detect.h"
#include "force/bear.h"

#define KN 1e9
#define OVERLAP 1e-4

/* A cube on a plate. The polygon is the cube's lower face; `twist` turns the cube. */
static tl_model *cube_on_plate(const char *law, double twist)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
    scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(0, 0, 1), twist), tl_v3(0.1, 0.2, 0.5 - OVERLAP));
    scene_law(m, law, KN, KN, strcmp(law, "elastic") == 0 ? -1 : 30);
    scene_forces(m);
    return m;
}

typedef struct totals {
    double area, n0, n0_x, n0_y, reference;
    tl_vec3 shear;
    double torsion;
} totals;

/* Sums over the points of contact 0; moments about `about`, in A's arms. */
static totals sum_points(const tl_model *m, tl_vec3 about)
{
    totals t = {0};
    const tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        tl_vec3 arm = tl_v3_sub(scene_arm(m, i), about);
        tl_vec3 f = {p->f_s[0][i], p->f_s[1][i], p->f_s[2][i]};
        t.area += p->area[i];
        t.n0 += p->f_n0[i];
        t.n0_x += p->f_n0[i] * arm.x;
        t.n0_y += p->f_n0[i] * arm.y;
        t.reference += p->reference[i] * p->area[i];
        t.shear = tl_v3_add(t.shear, f);
        t.torsion += arm.x * f.y - arm.y * f.x;
    }
    return t;
}

static tl_vec3 area_centre(const tl_model *m)
{
    tl_vec3 c = {0, 0, 0};
    double area = 0;
    const tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        c = tl_v3_madd(c, p->area[i], scene_arm(m, i));
        area += p->area[i];
    }
    return tl_v3_scale(1 / area, c);
}

/* Random shear, initial force and reference on the points of contact 0. */
static void load_points(tl_model *m, uint64_t *seed)
{
    tl_points_table *p = &m->detect->points;
    CHECK(tl_detect_hold_initial(m->detect));
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        p->f_s[0][i] = 1e3 * scene_between(seed, -1, 2) * p->area[i];
        p->f_s[1][i] = 1e3 * scene_between(seed, -2, 1) * p->area[i];
        p->f_s[2][i] = 0;
        p->f_n0[i] = 1e4 * scene_between(seed, 0, 1) * p->area[i];
        p->f_n[i] = p->f_n0[i];
        p->reference[i] = 1e-5 * scene_between(seed, 0, 1);
    }
}

static void transfer(tl_model *m, const tl_contact_point *points, size_t count)
{
    tl_narrow_scratch scratch = {0};
    const tl_detect *d = m->detect;
    scratch.manifold.facet = d->contacts.facet[0];
    scratch.manifold.points = malloc(count * sizeof *points);
    memcpy(scratch.manifold.points, points, count * sizeof *points);
    scratch.manifold.point_count = count;
    CHECK(tl_contact_transfer(m, 0, &scratch, &d->lanes[0]));
    free(scratch.manifold.points);
    free(scratch.old);
    free(scratch.cell);
}

/* The contact's points as they are, and as a rule for another polygon of the same area and centroid: the
 * square turned about its centre by `twist`, or drawn out to a rectangle. */
static size_t other_points(const tl_model *m, double twist, double stretch, tl_contact_point *out)
{
    const tl_detect *d = m->detect;
    size_t count = d->contacts.point_count[0];
    tl_vec3 centre = area_centre(m);
    for (size_t k = 0; k < count; k++) {
        size_t i = tl_point_row(&d->contacts, 0, k);
        tl_vec3 arm = tl_v3_sub(tl_columns_get(d->points.p, i), centre);
        arm.x *= stretch;
        arm.y /= stretch;
        arm = tl_v3_add(centre, tl_q_rotate(scene_turn(tl_v3(0, 0, 1), twist), arm));
        out[k] = (tl_contact_point){.p = arm, .area = d->points.area[i], .key = 1000 + (uint32_t)k};
    }
    return count;
}

/* ---------------------------------------------------------------- totals ----------------- */

static void check_totals(const totals *now, const totals *before, double tolerance)
{
    double force = tl_v3_norm(before->shear) + before->n0;
    CHECK_NEAR(now->area, before->area, tolerance);
    CHECK_NEAR(now->shear.x, before->shear.x, tolerance * force);
    CHECK_NEAR(now->shear.y, before->shear.y, tolerance * force);
    CHECK_NEAR(now->torsion, before->torsion, tolerance * force);
    CHECK_NEAR(now->n0, before->n0, tolerance * force);
    CHECK_NEAR(now->n0_x, before->n0_x, tolerance * force);
    CHECK_NEAR(now->n0_y, before->n0_y, tolerance * force);
    CHECK_NEAR(now->reference, before->reference, tolerance * 1e-5);
}

TEST(totals_stay_at_unchanged_area)
{
    uint64_t seed = 2;
    for (int i = 0; i < 200; i++) {
        tl_model *m = cube_on_plate("elastic", 0);
        load_points(m, &seed);
        tl_vec3 centre = area_centre(m);
        totals before = sum_points(m, centre);
        tl_contact_point points[64];
        size_t count = other_points(m, scene_between(&seed, 0, 3), scene_between(&seed, 0.8, 1.2), points);
        transfer(m, points, count);
        CHECK_NEAR(scene_apart(area_centre(m), centre), 0, 1e-14);
        totals now = sum_points(m, centre);
        check_totals(&now, &before, 1e-12);
        CHECK_INT(m->detect->contacts.point_count[0], count);
        tl_model_destroy(m);
    }
}

/* Fewer points for the same polygon: three in the middles of a triangle's edges have its moments too. */
TEST(totals_stay_with_fewer_points)
{
    uint64_t seed = 3;
    tl_model *m = cube_on_plate("elastic", 0);
    load_points(m, &seed);
    tl_vec3 c = area_centre(m);
    totals before = sum_points(m, c);
    tl_contact_point points[4];
    for (int k = 0; k < 4; k++)
        points[k] = (tl_contact_point){.p = tl_v3_add(c, tl_v3(k & 1 ? 0.3 : -0.3, k & 2 ? 0.3 : -0.3, 0)),
                                       .area = before.area / 4,
                                       .key = (uint32_t)(2000 + k)};
    transfer(m, points, 4);
    totals now = sum_points(m, c);
    check_totals(&now, &before, 1e-12);
    /* lanes no longer used are inert */
    const tl_detect *d = m->detect;
    for (uint32_t k = 4; k < d->contacts.point_capacity[0]; k++) {
        CHECK_NEAR(d->points.area[tl_point_row(&d->contacts, 0, k)], 0, 0);
        CHECK_NEAR(d->points.f_n[tl_point_row(&d->contacts, 0, k)], 0, 0);
    }
    tl_model_destroy(m);
}

/* Torsion of a full set of points cannot be carried over to one point in the middle and others with
 * hardly an area: it would take any stress, which comes out when those areas grow. */
TEST(points_of_hardly_any_area_get_no_more_stress_than_there_was)
{
    uint64_t seed = 5;
    tl_model *m = cube_on_plate("elastic", 0);
    load_points(m, &seed);
    const tl_points_table *p = &m->detect->points;
    tl_vec3 c = area_centre(m);
    totals before = sum_points(m, c);
    double largest = 0, largest_n0 = 0;
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        tl_vec3 f = {p->f_s[0][i], p->f_s[1][i], p->f_s[2][i]};
        largest = fmax(largest, tl_v3_norm(f) / p->area[i]);
        largest_n0 = fmax(largest_n0, p->f_n0[i] / p->area[i]);
    }
    tl_contact_point points[3];
    for (int k = 0; k < 3; k++)
        points[k] = (tl_contact_point){.p = tl_v3_add(c, tl_v3(0.4 * (k == 1), 0.4 * (k == 2), 0)),
                                       .area = before.area * (k ? 1e-20 : 1),
                                       .key = (uint32_t)(3000 + k)};
    transfer(m, points, 3);
    for (uint32_t k = 0; k < 3; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        tl_vec3 f = {p->f_s[0][i], p->f_s[1][i], p->f_s[2][i]};
        /* the fit, the traction and the twist, each of which is bounded by the old stresses */
        CHECK(tl_v3_norm(f) <= 3 * largest * p->area[i]);
        CHECK(fabs(p->f_n0[i]) <= 3 * largest_n0 * p->area[i]);
    }
    tl_model_destroy(m);
}

/* Stresses that are linear over the face, as a turn of the block would make them. */
static void load_linearly(tl_model *m)
{
    tl_points_table *p = &m->detect->points;
    CHECK(tl_detect_hold_initial(m->detect));
    tl_vec3 centre = area_centre(m);
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        tl_vec3 arm = tl_v3_sub(scene_arm(m, i), centre);
        p->f_s[0][i] = (1e3 - 4e3 * arm.y) * p->area[i];
        p->f_s[1][i] = (-5e2 + 4e3 * arm.x) * p->area[i];
        p->f_n0[i] = (1e4 + 3e3 * arm.x + 2e3 * arm.y) * p->area[i];
        p->f_n[i] = p->f_n0[i];
    }
}

/* Of the shear springs, times 2 ks. */
static double shear_energy(const tl_model *m)
{
    const tl_points_table *p = &m->detect->points;
    double sum = 0;
    for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, 0, k);
        sum += tl_v3_norm2(tl_columns_get(p->f_s, i)) / p->area[i];
    }
    return sum;
}

/* Through detection itself: cubes stacked exactly, the upper one wobbling about the vertical, so that
 * corners come and go. The initial normal force follows the area. Shear force follows an area that shrinks and stays
 * where it grows; its springs never gain energy, and what they lose is heat. Between two polygons of equal keys stress
 * is kept per point, so totals of a stress that is not uniform are as exact as the shape of the polygon: 1e-3 for a turn
 * of 1e-2. */
TEST(wobbling_takes_shear_by_area)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1 - OVERLAP), tl_v3(1, 1, 2 - OVERLAP));
    scene_law(m, "coulomb", KN, KN, 80); /* elastic joints are bonded: their points stand */
    scene_forces(m);
    load_linearly(m);
    int changes = 0;
    uint32_t last = m->detect->contacts.point_count[0];
    totals before = sum_points(m, area_centre(m));
    double worst = 0, worst_moment = 0, stays = 1, area = before.area, heat = 0;
    double energy = shear_energy(m), begun = energy;
    for (int i = 1; i <= 1000; i++) {
        double angle = 5e-3 * sin(2 * TL_PI * i / 200);
        scene_put(m, 1, tl_v3(0, 0, 0), scene_turn(tl_v3(0, 0, 1), angle));
        scene_ok(m, tl_detect_update(m));
        heat += m->detect->contacts.released[0];
        scene_forces(m); /* dt is 0: no slip comes in */
        uint32_t count = m->detect->contacts.point_count[0];
        changes += count != last;
        last = count;
        totals now = sum_points(m, area_centre(m));
        double follow = now.area / before.area, after = shear_energy(m);
        stays *= fmin(1, now.area / area);
        area = now.area;
        CHECK(after <= energy * (1 + 1e-9));
        energy = after;
        worst = fmax(worst, fabs(now.shear.x / (stays * before.shear.x) - 1));
        worst = fmax(worst, fabs(now.shear.y / (stays * before.shear.y) - 1));
        worst = fmax(worst, fabs(now.n0 / (follow * before.n0) - 1));
        worst_moment = fmax(worst_moment, fabs(now.n0_x / (follow * before.n0_x) - 1));
        worst_moment = fmax(worst_moment, fabs(now.n0_y / (follow * before.n0_y) - 1));
        CHECK(fabs(now.torsion) <= fabs(before.torsion) * (1 + 1e-9));
    }
    CHECK(changes >= 10);
    CHECK(stays < 0.99);
    CHECK(worst <= 1e-3);
    CHECK(worst_moment <= 0.03); /* the polygon's own moment of area changes by as much */
    CHECK_REL(heat, 0.5 / KN * (begun - energy), 1e-9);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  %d changes, %g stays, forces within %.3g, moments %.3g\n", changes, stays, worst, worst_moment);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- uniform stress --------- */

/* In situ stress on a slab that slides off: the stress of every point stays the given one. */
TEST(uniform_stress_stays_uniform)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(0, 0, 1), 0.3), tl_v3(0.5, 0.5, 1.5));
    scene_law(m, "elastic", KN, KN, -1);
    tl_insitu insitu = {.size = sizeof(tl_insitu),
                        .stress = {.xx = -1e6, .yy = -2e6, .zz = -3e6, .zx = 2e5, .yz = -1e5}};
    scene_ok(m, tl_model_insitu(m, &insitu));
    for (int i = 0; i < 300; i++) {
        scene_forces(m);
        if (!CHECK_INT(m->detect->contacts.table.rows, 1))
            break;
        const tl_points_table *p = &m->detect->points;
        for (uint32_t k = 0; k < m->detect->contacts.point_count[0]; k++) {
            size_t row = tl_point_row(&m->detect->contacts, 0, k);
            CHECK_REL(p->f_n0[row] / p->area[row], 3e6, 1e-9);
            CHECK_REL(p->f_n[row] / p->area[row], 3e6, 1e-9);
            CHECK_REL(p->f_s[0][row] / p->area[row], -2e5, 1e-9);
            CHECK_REL(p->f_s[1][row] / p->area[row], 1e5, 1e-9);
        }
        scene_move(m, 1, tl_v3(2e-3, 1e-3, 0), tl_v3(0, 0, 0));
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- states ----------------- */

static tl_status no_update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static void some_stiffness(const void *self, double *kn, double *ks)
{
    (void)self;
    *kn = *ks = 1;
}

TEST(states_are_copied_split_or_reset)
{
    static const tl_law_ops ops = {.size = sizeof ops, .update = no_update, .stiffness = some_stiffness};
    static const tl_state states[] = {
        {.name = "copied", .kind = TL_STATE_SCALAR, .transfer = TL_TRANSFER_COPY, .initial = 1},
        {.name = "split", .kind = TL_STATE_SCALAR, .transfer = TL_TRANSFER_SPLIT, .initial = 2},
        {.name = "vector", .kind = TL_STATE_TANGENT, .transfer = TL_TRANSFER_SPLIT},
        {.name = "reset", .kind = TL_STATE_SCALAR, .transfer = TL_TRANSFER_RESET, .initial = 3}};
    static const tl_kind kind = {.size = sizeof kind,
                                 .type = TL_KIND_LAW,
                                 .name = "remembering",
                                 .states = states,
                                 .state_count = 4,
                                 .state_stride = sizeof *states,
                                 .ops = &ops};
    tl_detect *d = tl_detect_make(1, NULL, 0);
    tl_points_table *p = &d->points;
    CHECK_INT(tl_kind_state_columns(&kind), 6);
    if (!CHECK(tl_table_resize(&p->table, 8) && tl_detect_hold_states(d, 6)))
        return;
    tl_point_initial_state(p, 0, &kind);
    const double initial[] = {1, 2, 0, 0, 0, 3};
    for (int k = 0; k < 6; k++)
        CHECK_NEAR(p->state[k][0], initial[k], 0);
    const double old[TL_STATE_COLUMNS] = {10, 20, 30, 40, 50, 60, 0, 0};
    const double taken[] = {10, 5, 7.5, 10, 12.5, 3}, kept[] = {10, 5, 7.5, 10, 12.5, 60};
    p->area[0] = p->area[1] = 0.5; /* a quarter of the old point's */
    tl_point_take_state(p, 0, &kind, old, 2, false);
    for (int k = 0; k < 6; k++)
        CHECK_NEAR(p->state[k][0], taken[k], 1e-14);
    tl_point_initial_state(p, 1, &kind);
    tl_point_take_state(p, 1, &kind, old, 2, true);
    for (int k = 0; k < 6; k++)
        CHECK_NEAR(p->state[k][1], kept[k], 1e-14);
    tl_detect_destroy(d);
}

/* A contact uses the share of its shear strength that its force is of it; with next to no shear none. */
TEST(used_strength_is_the_share_of_what_the_law_bears)
{
    tl_model *m = cube_on_plate("coulomb", 0);
    const tl_timestep step = {.size = sizeof step, .fraction = NAN, .dt = 1e-3};
    const tl_drive drive = {.size = sizeof drive, .velocity = {1e-2, 0, 0}};
    scene_ok(m, tl_model_timestep(m, &step));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    CHECK(isnan(tl_contact_shear_used(m, 0)));
    scene_ok(m, tl_blocks_drive(m, &m->blocks.id[1], 1, &drive));
    double last = 0;
    for (int k = 0; k < 10; k++) {
        scene_ok(m, tl_model_cycle(m, 1, NULL));
        const tl_vec3 force = scene_force(m, 0, 1);
        const double share = fabs(force.x) / (force.z * tan(TL_PI / 6));
        CHECK_NEAR(share > 0 ? tl_contact_shear_used(m, 0) : 0, share, 1e-9);
        CHECK(share >= last - 1e-9 && share < 1 + 1e-9);
        last = share;
    }
    CHECK_NEAR(last, 1, 1e-9);
    tl_model_destroy(m);
}

/* A bond that has failed stays failed when the polygon changes. */
TEST(failed_bonds_stay_failed)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = KN},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = KN},
                         {.key = "friction", .type = TL_VALUE_NUMBER, .number = 30},
                         {.key = "cohesion", .type = TL_VALUE_NUMBER, .number = 1e5},
                         {.key = "tension", .type = TL_VALUE_NUMBER, .number = 1e5}};
    tl_args args = {values, 5};
    scene_ok(m, tl_joint_law(m, "*", "coulomb_tensile", &args));
    scene_forces(m);
    scene_put(m, 1, tl_v3(0, 0, 5e-5), tl_q_identity()); /* half the strength: it holds */
    scene_forces(m);
    CHECK_REL(scene_force(m, 0, 1).z, -5e4, 1e-6);
    scene_put(m, 1, tl_v3(0, 0, 2e-4), tl_q_identity()); /* twice: it breaks */
    scene_forces(m);
    CHECK_NEAR(scene_force(m, 0, 1).z, 0, 0);
    for (int i = 0; i < 20; i++) { /* other polygons, within what the old strength would carry */
        scene_put(m, 1, tl_v3(1e-2 * i, 0, 5e-5), scene_turn(tl_v3(0, 0, 1), 0.05 * i));
        scene_forces(m);
        CHECK_NEAR(scene_force(m, 0, 1).z, 0, 0);
    }
    tl_model_destroy(m);
}

/* Component of a shear force along its point's normal, over the whole force: rounding. */
#define IN_PLANE 1e-9

/* The largest of a contact's points, in the plane of the last step. The torsion of a field contact lies along
 * the normal. */
static double out_of_plane(const tl_detect *d, uint32_t c, int *sheared)
{
    const tl_facet *facet = &d->contacts.facet[c];
    double worst = 0;
    for (uint32_t j = 0; j < d->contacts.point_count[c]; j++) {
        size_t i = tl_point_row(&d->contacts, c, j);
        tl_vec3 f = tl_columns_get(d->points.f_s, i);
        double along = tl_v3_dot(f, facet->last);
        double across = tl_v3_norm(tl_v3_madd(f, -along, facet->last));
        double whole = tl_v3_norm(f) + fabs(d->points.f_n[i]);
        bool torsion = facet->kind == TL_FACET_FIELD && j == TL_FIELD_TORSION;
        worst = whole > 1e-3 ? fmax(worst, (torsion ? across : fabs(along)) / whole) : worst;
        *sheared += tl_v3_norm(f) > 1e-3;
    }
    return worst;
}

/* Stones tumble over each other: points come, go and lean, and friction acts along the faces all the while. */
TEST(shear_forces_stay_in_the_plane_of_their_point)
{
    uint64_t seed = 5;
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-5, -5, -1), tl_v3(5, 5, 0));
    for (int k = 0; k < 16; k++)
        scene_block(m, scene_random_hull(&seed, 14, tl_v3(0.5, 0.45, 0.4)), scene_any_turn(&seed),
                    tl_v3(0.8 * (k % 4) - 1.2, 0.8 * (k / 4 % 2) - 0.4, 0.5 + 0.75 * (k / 8)));
    const tl_id base = 1;
    scene_ok(m, tl_blocks_fix(m, &base, 1, TL_FIX_ALL));
    scene_ok(m, tl_model_set_gravity(m, tl_v3(1, 0, -10)));
    scene_law(m, "coulomb", KN, KN, 30);
    double worst = 0;
    int sheared = 0;
    for (int step = 0; step < 600; step++) {
        tl_solve_result result;
        scene_ok(m, tl_model_cycle(m, 1, &result));
        for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++)
            worst = fmax(worst, out_of_plane(m->detect, c, &sheared));
    }
    CHECK(sheared > 1000);
    CHECK_NEAR(worst, 0, IN_PLANE);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(totals_stay_at_unchanged_area), RUN(totals_stay_with_fewer_points),
          RUN(points_of_hardly_any_area_get_no_more_stress_than_there_was), RUN(wobbling_takes_shear_by_area),
          RUN(uniform_stress_stays_uniform), RUN(states_are_copied_split_or_reset), RUN(failed_bonds_stay_failed),
          RUN(used_strength_is_the_share_of_what_the_law_bears), RUN(shear_forces_stay_in_the_plane_of_their_point))
