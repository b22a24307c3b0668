/* test_undo.c - a step that a law or the damping fails has changed nothing: the state is as before, as often as it is tried, and
 * what follows the cure is what follows in a model in which nothing ever failed. */
#include "contact_scene.h"
#include "cycle/undo.h"

enum { MOST_ARGS = 4, STEPS = 40, AFTER = 20 };

static const double KN = 1e8, KS = 5e7;

static tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static tl_value truth(const char *key, int value)
{
    return (tl_value){.key = key, .type = TL_VALUE_BOOL, .number = value};
}

/* Properties of the law that all contacts have, or with `law` another law. */
static tl_status set_law(tl_model *m, const char *law, tl_value first, tl_value second)
{
    const tl_value values[] = {first, second};
    const tl_args args = {values, second.key ? 2 : 1};
    return tl_joint_law(m, "*", law, &args);
}

/* Rounded stones that turn and slide over boxes which stand on each other: faces, edges and tilted patches, some pages of
 * points. With threads > 1 pages are worked on in any order. */
static tl_model *scene(int64_t threads, uint64_t seed, const char *law, const char *damping)
{
    static int loaded;
    tl_error error;
    tl_model *m = scene_model(threads);
    if (!loaded++)
        CHECK_INT(tl_plugin_load(TALUS_BAD_PLUGIN_DIR "/failing.so", &error), TL_OK);
    CHECK_INT(tl_model_set_gravity(m, tl_v3(0, 0, -10)), TL_OK);
    scene_box(m, tl_v3(-5, -5, -1), tl_v3(5, 5, 0));
    for (int k = 0; k < 12; k++)
        scene_box(m, tl_v3(k % 4 - 2, k / 4 % 3 - 2, 0), tl_v3(k % 4 - 1, k / 4 % 3 - 1, 1));
    for (int k = 0; k < 4; k++)
        scene_block(m, scene_random_hull(&seed, 16, tl_v3(0.5, 0.4, 0.45)), scene_any_turn(&seed),
                    tl_v3(k - 1.5, -0.5, 1.42));
    const tl_id base = 1;
    scene_ok(m, tl_blocks_fix(m, &base, 1, TL_FIX_ALL));
    if (strcmp(law, "coulomb") == 0)
        scene_law(m, law, KN, KS, 20);
    else
        scene_ok(m, set_law(m, law, number("kn", KN), number("ks", KS)));
    for (tl_id id = 2; id <= 17; id++) {
        const tl_block_set set = {.size = sizeof(tl_block_set),
                                  .density = NAN,
                                  .velocity = {0.2 * (id % 3), 0.1 * (id % 4), -0.1},
                                  .angular_velocity = {0.1, 0.2 * (id % 2), 0.1}};
        scene_ok(m, tl_blocks_set(m, &id, 1, &set));
    }
    if (damping)
        scene_ok(m, tl_model_damping(m, damping, &(tl_args){NULL, 0}));
    return m;
}

static void hash_of(tl_model *m, char text[33])
{
    scene_ok(m, tl_state_hash(m, text));
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

/* Sum of what contacts say that they carry. */
static double carried(const tl_model *m)
{
    double sum = 0;
    for (uint32_t c = 0; m->detect && c < m->detect->contacts.table.rows; c++)
        sum += tl_v3_norm(m->detect->contacts.force[c]) + tl_v3_norm(m->detect->contacts.moment[c]);
    return sum;
}

/* Steps that fail, some times over; the model must not have changed. */
static void fail(tl_model *m, const char *part)
{
    char before[33], after[33];
    hash_of(m, before);
    tl_energy energy[2];
    tl_model_energy(m, &energy[0]);
    double force = carried(m), time = m->time;
    for (int k = 0; k < 3; k++) {
        tl_solve_result result;
        CHECK_INT(tl_model_cycle(m, 5, &result), TL_E_NUMERIC);
        CHECK_CONTAINS(tl_model_error(m)->text, part);
        CHECK_INT(result.cycles, 0);
        hash_of(m, after);
        CHECK_TEXT(after, before);
    }
    tl_model_energy(m, &energy[1]);
    CHECK(memcmp(&energy[0], &energy[1], sizeof energy[0]) == 0);
    CHECK_NEAR(m->time, time, 0);
    if (m->cycles > 0 && m->split_count == 0) /* contacts that were found by the step count from it on */
        CHECK_REL(carried(m), force, 1e-12);
}

static void same(tl_model *m, tl_model *other)
{
    char one[33], two[33];
    tl_energy energy[2];
    hash_of(m, one);
    hash_of(other, two);
    CHECK_TEXT(one, two);
    tl_model_energy(m, &energy[0]);
    tl_model_energy(other, &energy[1]);
    CHECK(memcmp(&energy[0], &energy[1], sizeof energy[0]) == 0);
    tl_model_destroy(m);
    tl_model_destroy(other);
}

/* A law that fails after `steps`, cured by other properties; in one of two models no step is tried in between. */
static void law_fails(int64_t threads, int64_t steps, const char *damping, double kn)
{
    tl_model *m[2];
    for (int k = 0; k < 2; k++) {
        m[k] = scene(threads, 7, "failing", damping);
        run(m[k], steps);
        scene_ok(m[k], set_law(m[k], NULL, truth("fails", 1), number("beyond", 1e-7)));
        if (k == 0)
            fail(m[k], "law 'failing' of plugin 'bad.failing', contact of blocks");
        scene_ok(m[k], set_law(m[k], NULL, truth("fails", 0), number("kn", kn)));
        run(m[k], AFTER);
    }
    same(m[0], m[1]);
}

TEST(a_step_that_a_law_fails_is_undone)
{
    for (int64_t threads = 1; threads <= 3; threads += 2)
        for (int64_t steps = 0; steps <= STEPS; steps += STEPS / 2) {
            law_fails(threads, steps, NULL, KN);
            law_fails(threads, steps, "failing_damping", KN);
            law_fails(threads, steps, "local", 3 * KN);
        }
}

TEST(a_step_that_the_damping_fails_is_undone)
{
    const tl_value told = truth("fails", 1);
    const char *const laws[] = {"failing", "elastic", "coulomb"};
    for (size_t law = 0; law < sizeof laws / sizeof *laws; law++) {
        tl_model *m[2];
        for (int k = 0; k < 2; k++) {
            m[k] = scene(2, 3, laws[law], "failing_damping");
            run(m[k], STEPS);
            if (k == 0) { /* the same damping, but that it fails: its states are set back by hand */
                double calls = m[k]->damping_state[0];
                scene_ok(m[k], tl_model_damping(m[k], "failing_damping", &(tl_args){&told, 1}));
                fail(m[k], "damping 'failing_damping' of plugin 'bad.failing': it was told to fail");
                scene_ok(m[k], tl_model_damping(m[k], "failing_damping", &(tl_args){NULL, 0}));
                m[k]->damping_state[0] = calls;
            } else {
                m[k]->cycle->dt = 0; /* as a change of damping does */
            }
            run(m[k], AFTER);
        }
        same(m[0], m[1]);
    }
}

/* A damping may make the step shorter, and not longer, or none. */
TEST(a_factor_of_the_step_that_cannot_be_is_refused)
{
    const double wrong[] = {1.001, 0, -1, NAN, INFINITY};
    tl_model *m = scene(1, 3, "coulomb", "failing_damping");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const tl_value step = number("step", wrong[i]);
        if (tl_model_damping(m, "failing_damping", &(tl_args){&step, 1}) != TL_OK)
            continue; /* no number at all */
        CHECK_INT(tl_model_cycle(m, 1, NULL), TL_E_PLUGIN);
        CHECK_CONTAINS(tl_model_error(m)->text, "damping 'failing_damping' gives the step factor ");
        CHECK_CONTAINS(tl_model_error(m)->text, "which is outside (0, 1]");
    }
    const tl_value one = number("step", 1), half = number("step", 0.5);
    scene_ok(m, tl_model_damping(m, "failing_damping", &(tl_args){&one, 1}));
    run(m, 1);
    double whole = m->dt;
    scene_ok(m, tl_model_damping(m, "failing_damping", &(tl_args){&half, 1}));
    run(m, 1);
    CHECK_NEAR(m->dt, 0.5 * whole, 0.01 * whole);
    tl_model_destroy(m);
}

/* After a cut new faces are loaded in the step: those of a step that fails are as they were. */
TEST(a_step_after_a_cut_is_undone)
{
    const tl_value told = truth("fails", 1);
    const char *const laws[] = {"coulomb", "failing"};
    for (size_t law = 0; law < sizeof laws / sizeof *laws; law++) {
        tl_model *m[2];
        for (int k = 0; k < 2; k++) {
            m[k] = scene(2, 3, laws[law], "failing_damping");
            run(m[k], STEPS);
            scene_cut(m[k], "new", tl_v3(0.1, 0.2, 1), tl_v3(0, 0, 0.4));
            double calls = m[k]->damping_state[0];
            if (k == 0) {
                scene_ok(m[k], tl_model_damping(m[k], "failing_damping", &(tl_args){&told, 1}));
                fail(m[k], "damping 'failing_damping' of plugin 'bad.failing': it was told to fail");
            }
            scene_ok(m[k], tl_model_damping(m[k], "failing_damping", &(tl_args){NULL, 0}));
            m[k]->damping_state[0] = calls;
            run(m[k], 1);
            CHECK(m[k]->detect->points.initial);
            run(m[k], AFTER);
        }
        same(m[0], m[1]);
    }
}

/* Laws that never fail, and forces that are beyond all numbers: cured by a stress that is not. */
TEST(a_force_beyond_all_numbers_is_undone)
{
    const char *const laws[] = {"elastic", "coulomb"};
    for (size_t law = 0; law < sizeof laws / sizeof *laws; law++) {
        tl_model *m[2];
        for (int k = 0; k < 2; k++) {
            m[k] = scene(2, 5, laws[law], NULL);
            run(m[k], STEPS);
            const tl_insitu tame = {.size = sizeof(tl_insitu), .stress = {.xx = -1e3, .yy = -1e3, .zz = -1e3}};
            scene_ok(m[k], tl_model_insitu(m[k], &tame));
            for (size_t i = 0; i < m[k]->detect->points.table.rows; i++)
                m[k]->detect->points.f_n0[i] = 1.7e308;
            tl_undo_by_hand(m[k]);
            if (k == 0)
                fail(m[k], "the force is not a finite number");
            for (size_t i = 0; i < m[k]->detect->points.table.rows; i++)
                m[k]->detect->points.f_n0[i] = 0;
            scene_ok(m[k], tl_model_insitu(m[k], &tame));
            run(m[k], AFTER);
        }
        same(m[0], m[1]);
    }
}

/* A step that is too long, step by step, until a block would be flung: cured by a shorter one. */
TEST(a_step_that_would_fling_a_block_is_undone)
{
    const tl_timestep longer = {.size = sizeof(tl_timestep), .fraction = 0.1, .dt = 2e-2},
                      shorter = {.size = sizeof(tl_timestep), .fraction = 0.1, .dt = 1e-4};
    int64_t made = 0;
    tl_model *m[2];
    for (int k = 0; k < 2; k++) {
        char before[33], after[33];
        tl_solve_result result;
        m[k] = scene(2, 5, "elastic", NULL);
        run(m[k], STEPS);
        scene_ok(m[k], tl_model_timestep(m[k], &longer));
        tl_status status = TL_OK;
        if (k == 1)
            run(m[k], made);
        while (k == 0 && status == TL_OK && made < 1000) {
            hash_of(m[k], before);
            status = tl_model_cycle(m[k], 1, &result);
            made += status == TL_OK;
        }
        if (k == 0) {
            hash_of(m[k], after);
            CHECK_INT(status, TL_E_NUMERIC);
            CHECK_CONTAINS(tl_model_error(m[k])->text, "block 7, at 207 rad/s, would turn by");
            CHECK_TEXT(after, before);
        }
        scene_ok(m[k], tl_model_timestep(m[k], &shorter));
        run(m[k], AFTER);
    }
    CHECK(made > 0);
    same(m[0], m[1]);
}

TEST(nothing_goes_on_from_a_step_that_cannot_be_undone)
{
    tl_solve_result result;
    tl_model *m = scene(1, 7, "failing_silently", NULL);
    run(m, STEPS);
    /* a stone is pressed down, and some steps later the law fails */
    const tl_id stone = 14;
    const tl_drive down = {.size = sizeof(tl_drive), .velocity = {0, 0, -0.2}};
    scene_ok(m, tl_blocks_drive(m, &stone, 1, &down));
    scene_ok(m, set_law(m, NULL, truth("fails", 1), number("beyond", 0.02)));
    run(m, 2);
    CHECK_INT(tl_model_cycle(m, 1000, &result), TL_E_NUMERIC);
    CHECK(result.cycles > 0);
    scene_ok(m, set_law(m, NULL, truth("fails", 0), number("beyond", 0.02)));
    CHECK_INT(tl_model_cycle(m, 1, &result), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "failed and could not be taken back");
    tl_model_destroy(m);
}

/* What a step that can be undone needs is had once, and given back some steps after the first, which follows settings by hand. */
TEST(laws_that_never_fail_need_no_memory_for_it)
{
    tl_model *m = scene(1, 7, "elastic", "local");
    run(m, 2);
    size_t early = tl_undo_bytes(m->cycle);
    run(m, 80);
    size_t without = tl_undo_bytes(m->cycle);
    tl_model_destroy(m);
    m = scene(1, 7, "failing", "local");
    run(m, 2);
    CHECK(tl_undo_bytes(m->cycle) > 2 * without);
    CHECK(without < 1000 && without < early);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(a_step_that_a_law_fails_is_undone), RUN(a_step_that_the_damping_fails_is_undone),
          RUN(a_factor_of_the_step_that_cannot_be_is_refused), RUN(a_step_after_a_cut_is_undone),
          RUN(a_force_beyond_all_numbers_is_undone), RUN(a_step_that_would_fling_a_block_is_undone),
          RUN(nothing_goes_on_from_a_step_that_cannot_be_undone), RUN(laws_that_never_fail_need_no_memory_for_it))
