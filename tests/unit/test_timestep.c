/* test_timestep.c - the time step: the rates that its rules keep from step to step, against rates made anew in every step,
 * of blocks that fall on each other, so that contacts come, go and change all the time; bodies without contacts; models
 * from which no step follows; and what is said of slivers. */
#include "../contact_scene.h"
#include "cycle/cycle.h"
#include "cycle/cycle_data.h"
#include "cycle/prepare.h"
#include "cycle/timestep.h"
#include "detect/detect.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "model/joints.h"

#include <talus/number.h>

#define KN 1e8     /* Pa/m */
#define ALIKE 1e-5 /* areas and arms are kept within 1e-6 of a block's size, and count twice or more */
#define STEPS 5000 /* in which blocks fall, roll and come to rest */
#define BLOCKS 27

/* Blocks of random shape in three layers over a fixed plate. */
static tl_model *shower(void)
{
    tl_model *m = scene_model(2);
    uint64_t seed = 11;
    m->config.gravity = tl_v3(0, 0, -9.81);
    scene_box(m, tl_v3(-3, -3, -1), tl_v3(6, 6, 0));
    for (int i = 0; i < BLOCKS; i++) {
        tl_vec3 at = {i % 3 * 1.1, i / 3 % 3 * 1.1, 0.7 + i / 9 * 1.1};
        scene_block(m, scene_random_hull(&seed, 16, tl_v3(0.5, 0.4, 0.5)), scene_any_turn(&seed), at);
    }
    scene_law(m, "coulomb", KN, KN, 30);
    tl_id base = m->blocks.id[0];
    scene_ok(m, tl_blocks_fix(m, &base, 1, TL_FIX_ALL));
    return m;
}

/* One step, whose rates are compared with rates made anew; gives how far the worst is off. */
static double compare_step(tl_model *m, double *copy)
{
    size_t bytes = m->bodies.table.rows * sizeof *copy;
    double dt, worst = 0;
    scene_ok(m, tl_cycle_prepare(m));
    scene_ok(m, tl_detect_update(m));
    scene_ok(m, tl_timestep_choose(m, &dt));
    struct tl_cycle *c = m->cycle;
    struct tl_stiffness_rates kept = c->stiffness_rates;
    memcpy(copy, c->rate, bytes);
    c->stiffness_rates.version = 0;
    scene_ok(m, tl_timestep_choose(m, &dt));
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        worst = fmax(worst, fabs(copy[body] - c->rate[body]) / fmax(c->rate[body], 1e-300));
    c->stiffness_rates = kept;
    memcpy(c->rate, copy, bytes);
    scene_ok(m, tl_step(m));
    return worst;
}

TEST(kept_rates_are_those_of_the_present_contacts)
{
    tl_model *m = shower();
    scene_ok(m,
             tl_model_timestep(
                 m, &(tl_timestep){.size = sizeof(tl_timestep), .rule = TL_TIMESTEP_BODY, .fraction = 0.5, .dt = NAN}));
    double copy[BLOCKS + 1], worst = 0;
    size_t most = 0;
    for (int i = 0; i < STEPS; i++) {
        worst = fmax(worst, compare_step(m, copy));
        size_t contacts = m->detect->contacts.table.rows;
        most = contacts > most ? contacts : most;
    }
    CHECK(most > BLOCKS / 2);
    CHECK_NEAR(worst, 0, ALIKE);
    tl_model_destroy(m);
}

/* Mass scaling looks at areas now and then only; but a contact that came or went counts at once. */
TEST(mass_scaling_knows_which_bodies_have_contacts)
{
    tl_model *m = shower();
    scene_ok(m, tl_model_mass_scaling(m, &(tl_mass_scaling){sizeof(tl_mass_scaling), 1, NAN, NAN}));
    double copy[BLOCKS + 1];
    int missed = 0;
    for (int i = 0; i < STEPS; i++) {
        compare_step(m, copy);
        for (uint32_t row = 1; row < m->blocks.table.rows; row++) {
            uint32_t begin = m->detect->by_block_start[row], end = m->detect->by_block_start[row + 1];
            bool carries = false;
            for (uint32_t e = begin; e < end; e++)
                carries = carries || m->detect->contacts.area[m->detect->by_block[e]] > 0;
            missed += carries && !(m->cycle->rate[m->blocks.body[row]] > 0);
        }
    }
    CHECK_INT(missed, 0);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- no contacts ------------ */

/* A box a x b x c that falls past another that is held: on its largest face a x b, whose points are c / 2 below. */
TEST(a_body_without_contacts_stands_on_its_largest_face)
{
    const double a = 3, b = 2, c = 0.5, mass = 2000 * a * b * c, fraction = 0.7;
    const double kn = 2e7, k = 2 * kn * a * b;
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(10, 10, 10), tl_v3(19, 19, 19));
    scene_box(m, tl_v3(0, 0, 0), tl_v3(a, b, c));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    scene_law(m, "elastic", kn / 3, kn, -1);
    double dt, least = mass * fmin(a * a + c * c, b * b + c * c) / 12;
    double r2 = (a * a + b * b) / 12 + c * c / 4;
    tl_timestep timestep = {sizeof(tl_timestep), fraction, TL_TIMESTEP_BODY, NAN, 0, 0};
    scene_ok(m, tl_model_timestep(m, &timestep));
    scene_ok(m, tl_model_dt(m, &dt));
    CHECK_REL(dt, fraction * 2 * sqrt(1 / (k * (1 / mass + r2 / least))), 1e-12);
    timestep.rule = TL_TIMESTEP_PAPER;
    scene_ok(m, tl_model_timestep(m, &timestep));
    scene_ok(m, tl_model_dt(m, &dt));
    CHECK_REL(dt, fraction * 2 * sqrt(mass / k), 1e-12);
    /* no rotation, no part of it in the step */
    timestep.rule = TL_TIMESTEP_BODY;
    scene_ok(m, tl_model_timestep(m, &timestep));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[1], 1, TL_FIX_ROTATION));
    scene_ok(m, tl_model_dt(m, &dt));
    CHECK_REL(dt, fraction * 2 * sqrt(mass / k), 1e-12);
    tl_model_destroy(m);
}

/* A stiff law that only others touch by does not shorten the step of a block on a soft joint. */
TEST(a_body_in_contact_has_the_law_of_its_contacts)
{
    tl_model *m = scene_model(1);
    uint32_t joint = tl_joint_intern(m, "stiff");
    CHECK(joint > 0);
    scene_box(m, tl_v3(0, 0, -1), tl_v3(4, 4, 0));
    scene_box(m, tl_v3(1, 1, 0), tl_v3(2, 2, 1));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    scene_law(m, "elastic", 1e7, 1e7, -1);
    double soft, both;
    scene_ok(m, tl_model_dt(m, &soft));
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e13},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e13}};
    scene_ok(m, tl_joint_law(m, "stiff", "elastic", &(tl_args){values, 2}));
    scene_ok(m, tl_model_dt(m, &both));
    CHECK_REL(both, soft, 1e-15);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- no step ---------------- */

static tl_status ten_steps(tl_model *m)
{
    tl_solve_result result;
    return tl_model_cycle(m, 10, &result);
}

TEST(time_stands_where_nothing_can_move)
{
    tl_model *m = scene_model(1);
    double dt = 1;
    scene_ok(m, tl_model_damping(m, "local", &(tl_args){NULL, 0}));
    scene_ok(m, ten_steps(m)); /* without a block */
    CHECK(m->time == 0);
    CHECK_INT(m->cycles, 10);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    scene_ok(m, ten_steps(m));
    scene_ok(m, tl_model_dt(m, &dt));
    CHECK(m->time == 0 && dt == 0);
    /* what is held but moves needs a step */
    tl_block_set moves = {
        .size = sizeof(tl_block_set), .density = NAN, .velocity = {1, 0, 0}, .angular_velocity = {0, 0, 0}};
    scene_ok(m, tl_blocks_set(m, &m->blocks.id[0], 1, &moves));
    CHECK_INT(ten_steps(m), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "no law says how stiff a contact is");
    /* and where the user gives one, time goes on */
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){sizeof(tl_timestep), NAN, TL_TIMESTEP_BODY, 0.25, 0, 0}));
    scene_ok(m, ten_steps(m));
    CHECK_NEAR(m->time, 2.5, 1e-15);
    CHECK_NEAR(m->bodies.pose[0].u.x, 2.5, 1e-15);
    tl_model_destroy(m);
}

/* A body begins with half a kick when it is freed, whatever went before. */
TEST(a_fall_begins_after_steps_without_time)
{
    tl_model *m = scene_model(1);
    m->config.gravity = tl_v3(0, 0, -10);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    scene_ok(m, ten_steps(m));
    scene_ok(m, tl_blocks_free(m, &m->blocks.id[0], 1));
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){sizeof(tl_timestep), NAN, TL_TIMESTEP_BODY, 0.125, 0, 0}));
    scene_ok(m, ten_steps(m));
    CHECK_NEAR(m->bodies.pose[0].u.z, -5 * 1.25 * 1.25, 1e-14);
    tl_model_destroy(m);
}

TEST(the_reason_for_no_step_is_the_true_one)
{
    tl_model *m = scene_model(1);
    double dt;
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1e-5, 1e-5, 1e-5));
    CHECK_INT(tl_model_dt(m, &dt), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "no law says how stiff a contact is");
    scene_law(m, "elastic", 1e50, 1, -1);
    m->joint_laws[0].kn = 1e308;
    CHECK_INT(ten_steps(m), TL_E_STATE);
    CHECK(m->cycles == 0 && m->time == 0);
    CHECK(!strstr(tl_model_error(m)->text, "no law"));
    CHECK_CONTAINS(tl_model_error(m)->text, "it would be 0 s; check the units of density");
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- slivers ---------------- */

typedef struct remark_log {
    int remarks;
    char last[512];
} remark_log;

static void listen(void *user, const char *text)
{
    remark_log *h = user;
    h->remarks++;
    snprintf(h->last, sizeof h->last, "%s", text);
}

/* Eight cubes of `size`, one of them in two, the thinner one by `share` of it; 0: whole. */
static tl_model *eight_cubes(double size, double share, remark_log *h)
{
    tl_model *m = scene_model(1);
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    for (int i = 0; i < 8; i++) {
        tl_vec3 from = tl_v3_scale(size, tl_v3(i % 2, i / 2 % 2, i / 4)), to = from;
        to = tl_v3_add(to, tl_v3(size, size, size));
        if (i == 5 && share > 0) {
            tl_vec3 thin = to;
            thin.x = from.x + share * size;
            scene_ok(m, tl_stage_add_box(&stage, from, thin, 2000, "rock"));
            from.x = thin.x;
        }
        scene_ok(m, tl_stage_add_box(&stage, from, to, 2000, "rock"));
    }
    scene_ok(m, tl_stage_commit(&stage));
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    scene_ok(m, tl_model_damping(m, "local", &(tl_args){NULL, 0}));
    tl_model_log(m, listen, h);
    return m;
}

/* The filter that the remark names, with joining. */
static tl_filter named_filter(const char *text)
{
    tl_filter filter = tl_filter_default();
    filter.action = TL_FILTER_JOIN;
    const char *named = strstr(text, "tl_model_filter() with ");
    const char *volume = named ? strstr(named, "volume = ") : NULL;
    const char *aspect = named ? strstr(named, "aspect = ") : NULL;
    if (volume)
        filter.volume = tl_number_read(volume + 9, NULL);
    if (aspect)
        filter.aspect = tl_number_read(aspect + 9, NULL);
    return filter;
}

static void check_sliver(double size, double share, int32_t rule)
{
    remark_log h = {0, ""};
    tl_model *m = eight_cubes(size, share, &h);
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){sizeof(tl_timestep), NAN, rule, NAN, 0, 0}));
    scene_ok(m, ten_steps(m));
    scene_ok(m, ten_steps(m));
    if (!CHECK_INT(h.remarks, 1))
        return;
    tl_timestep_report report;
    scene_ok(m, tl_model_timestep_report(m, &report));
    char block[40];
    snprintf(block, sizeof block, "block %u (", report.block);
    CHECK_CONTAINS(h.last, block);
    CHECK_INT(tl_model_timestep_report(m, &report), TL_OK);
    double before = report.dt;
    tl_filter filter = named_filter(h.last);
    tl_filter_result result;
    scene_ok(m, tl_model_filter(m, &filter, &result));
    CHECK_INT(result.joined, 1);
    CHECK_INT(result.slivers[0].block, report.block);
    free(result.slivers);
    scene_ok(m, ten_steps(m));
    scene_ok(m, tl_model_timestep_report(m, &report));
    CHECK_INT(h.remarks, 1);
    CHECK(report.dt > 3 * before);
    tl_model_destroy(m);
}

TEST(a_sliver_is_told_of_once_with_its_remedy)
{
    check_sliver(1, 0.01, TL_TIMESTEP_BODY);
    check_sliver(1e-3, 0.003, TL_TIMESTEP_BODY);
    check_sliver(1e3, 0.02, TL_TIMESTEP_BODY);
    check_sliver(1, 0.01, TL_TIMESTEP_PAPER);
}

static int remarks_of(double share, double density, bool scaling)
{
    remark_log h = {0, ""};
    tl_model *m = eight_cubes(1, share, &h);
    tl_block_set lighter = {sizeof(tl_block_set), density, NULL, {NAN, NAN, NAN}, {NAN, NAN, NAN}, NULL};
    scene_ok(m, tl_blocks_set(m, &m->blocks.id[2], 1, &lighter));
    scene_ok(m, tl_model_mass_scaling(m, &(tl_mass_scaling){sizeof(tl_mass_scaling), scaling, NAN, NAN}));
    scene_ok(m, ten_steps(m));
    tl_model_destroy(m);
    return h.remarks;
}

/* Cubes in a row; the second is on a stiff joint with the first, which is held. */
static int remarks_of_a_stiff_joint(void)
{
    remark_log h = {0, ""};
    tl_model *m = scene_model(1);
    tl_stage stage;
    tl_joint_intern(m, "stiff");
    scene_ok(m, stage_begin(m, &stage));
    scene_ok(m, tl_stage_add_box(&stage, tl_v3(0, 0, 0), tl_v3(2, 1, 1), 2000, "rock"));
    scene_ok(m, stage_cut(&stage, tl_v3(1, 0, 0), tl_v3(1, 0.5, 0.5), (tl_tag){1, 1}, 1));
    for (int i = 2; i < 8; i++)
        scene_ok(m, tl_stage_add_box(&stage, tl_v3(i, 0, 0), tl_v3(i + 1, 1, 1), 2000, "rock"));
    scene_ok(m, tl_stage_commit(&stage));
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        if (tl_block_centroid(m, row).x < 1)
            scene_ok(m, tl_blocks_fix(m, &m->blocks.id[row], 1, TL_FIX_ALL));
    scene_law(m, "elastic", 1e7, 1e7, -1);
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e12},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e12}};
    scene_ok(m, tl_joint_law(m, "stiff", "elastic", &(tl_args){values, 2}));
    tl_model_log(m, listen, &h);
    scene_ok(m, ten_steps(m));
    /* it is the second block's step, and the joint that makes it short */
    tl_timestep_report report;
    scene_ok(m, tl_model_timestep_report(m, &report));
    uint32_t row = tl_block_row_quiet(m, report.block);
    CHECK_NEAR(tl_block_centroid(m, row).x, 1.5, 1e-6);
    CHECK(report.stiffness >= 1e12);
    tl_model_destroy(m);
    return h.remarks;
}

/* A column among held blocks, on which both ends and all sides press, and a cube that stands on one face. */
static int remarks_of_a_crowded_column(void)
{
    remark_log h = {0, ""};
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1.8));
    scene_box(m, tl_v3(8, 0, 0), tl_v3(9.5, 1.5, 1.5));
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(20, 20, 0));
    scene_box(m, tl_v3(-2, -2, 1.8), tl_v3(3, 3, 2));
    scene_box(m, tl_v3(-1, 0, 0), tl_v3(0, 1, 1.8));
    scene_box(m, tl_v3(1, 0, 0), tl_v3(2, 1, 1.8));
    scene_box(m, tl_v3(0, -1, 0), tl_v3(1, 0, 1.8));
    scene_box(m, tl_v3(0, 1, 0), tl_v3(1, 2, 1.8));
    for (uint32_t row = 2; row < 8; row++)
        scene_ok(m, tl_blocks_fix(m, &m->blocks.id[row], 1, TL_FIX_ALL));
    scene_law(m, "elastic", 1e8, 1e8, -1);
    tl_model_log(m, listen, &h);
    scene_ok(m, ten_steps(m));
    CHECK(m->cycle->rate[0] > 9 * m->cycle->rate[1]);
    tl_model_destroy(m);
    return h.remarks;
}

/* Even blocks, a block somewhat thinner, a stout block among many, a light block, a stiff law, and a sliver that mass scaling slows down. */
TEST(nothing_is_said_where_no_sliver_is_to_blame)
{
    CHECK_INT(remarks_of(0.01, 2000, false), 1);
    CHECK_INT(remarks_of(0, 2000, false), 0);
    CHECK_INT(remarks_of(0.3, 2000, false), 0);
    CHECK_INT(remarks_of(0, 20, false), 0);
    CHECK_INT(remarks_of(0.01, 2000, true), 0);
    CHECK_INT(remarks_of_a_stiff_joint(), 0);
    CHECK_INT(remarks_of_a_crowded_column(), 0);
}

TEST_MAIN(RUN(kept_rates_are_those_of_the_present_contacts), RUN(mass_scaling_knows_which_bodies_have_contacts),
          RUN(a_body_without_contacts_stands_on_its_largest_face), RUN(a_body_in_contact_has_the_law_of_its_contacts),
          RUN(time_stands_where_nothing_can_move), RUN(a_fall_begins_after_steps_without_time),
          RUN(the_reason_for_no_step_is_the_true_one), RUN(a_sliver_is_told_of_once_with_its_remedy),
          RUN(nothing_is_said_where_no_sliver_is_to_blame))
