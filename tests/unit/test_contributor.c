/* test_contributor.c - a step takes what acts on bodies from a list: a spring to the ground that is added to it is asked in every phase
 * as contacts are. All of it is this file, and a pointer in the list. */
#include "contact_scene.h"
#include "cycle/contact_forces.h"

static const double K = 4e5, G = 10; /* N/m, m/s2 */

/* ---------------------------------------------------------------- the contributor -------- */

/* One spring for each body from where it was made, that stretches along z. It keeps its force in a column, as bolts would. */
static struct springs {
    tl_table table;
    double *force, stored, wound;
    int64_t fails_at; /* steps made before the one that fails; -1: none */
} springs;

static double stretch_of(const tl_model *m, uint32_t body)
{
    return m->bodies.pose[body].u.z;
}

static tl_status prepare(tl_model *m)
{
    if (!springs.table.column_count) {
        tl_table_init(&springs.table, &springs);
        TL_COLUMN(&springs.table, &springs, force, TL_COLUMN_STEP);
    }
    return tl_table_resize(&springs.table, m->bodies.table.rows) ? TL_OK : tl_fail_memory(&m->error);
}

static tl_status apply(tl_model *m)
{
    springs.stored = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        springs.force[body] = springs.wound - K * stretch_of(m, body);
        springs.stored += 0.5 * K * stretch_of(m, body) * stretch_of(m, body);
    }
    return m->cycles == springs.fails_at ? tl_fail(&m->error, TL_E_PLUGIN, "a spring broke") : TL_OK;
}

static void gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    (void)m;
    for (uint32_t body = begin; body < end; body++) {
        on[body - begin].force.z += springs.force[body];
        on[body - begin].magnitude += fabs(springs.force[body]);
    }
}

static double stiffness(const tl_model *m, uint32_t body)
{
    (void)m, (void)body;
    return K;
}

static void hold(const tl_model *m, uint32_t body, bool points, tl_holding *sum)
{
    sum->stiffness.sum += points ? stiffness(m, body) : 0;
}

static tl_energies energies(tl_model *m)
{
    (void)m;
    return (tl_energies){.stored = springs.stored};
}

static size_t tables(tl_model *m, tl_table *table[TL_CONTRIBUTOR_TABLES])
{
    (void)m;
    table[0] = &springs.table;
    return 1;
}

static bool may_fail(const tl_model *m)
{
    (void)m;
    return springs.fails_at >= 0;
}

static const tl_contributor springs_act = {.name = "springs",
                                           .prepare = prepare,
                                           .apply = apply,
                                           .gather = gather,
                                           .stiffness = stiffness,
                                           .hold = hold,
                                           .energies = energies,
                                           .tables = tables,
                                           .may_fail = may_fail};

/* ---------------------------------------------------------------- what is asked of it ---- */

/* A cube of 1 m that hangs on its spring, with a law that no contact has. */
static tl_model *hanging(void)
{
    springs.fails_at = -1;
    springs.wound = 0;
    tl_model *m = scene_model(1);
    CHECK_INT(tl_model_set_gravity(m, tl_v3(0, 0, -G)), TL_OK);
    scene_box(m, tl_v3(-0.5, -0.5, -0.5), tl_v3(0.5, 0.5, 0.5));
    scene_law(m, "coulomb", 1, 1, 30);
    CHECK_INT(tl_cycle_prepare(m), TL_OK);
    CHECK(m->cycle->contributor[0] == &tl_contacts_act);
    m->cycle->contributor[1] = &springs_act;
    return m;
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

/* The step is stable, the cube swings about mg/K with the period of its mass on its spring, and no energy is made. */
TEST(a_cube_swings_on_it_and_makes_no_energy)
{
    tl_model *m = hanging();
    double dt, low = 0;
    scene_ok(m, tl_model_dt(m, &dt));
    const double mass = m->bodies.mass[0], period = 2 * TL_PI * sqrt(mass / K);
    CHECK(dt > 0 && dt < period / TL_PI);
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = period / 400}));
    for (int k = 0; k < 400; k++) {
        tl_energy energy;
        run(m, 1);
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(fabs(energy.balance) < 1e-3);
        low = fmin(low, stretch_of(m, 0));
    }
    CHECK_NEAR(low, -2 * mass * G / K, 1e-4 * mass * G / K);
    CHECK_TEXT(m->cycle->ledger.term[0].name, "contacts");
    CHECK_TEXT(m->cycle->ledger.term[1].name, "springs");
    CHECK(m->cycle->ledger.term[1].stored == springs.stored && m->cycle->ledger.term[2].name[0] == 0);
    CHECK_NEAR(stretch_of(m, 0), 0, 1e-3 * mass * G / K); /* after one period */
    tl_model_destroy(m);
}

/* A step three times as long as the stable one makes the cube nine times as heavy to move, though it has no contact: its
 * weight stays, and it swings as far in three times the period. */
TEST(a_cube_that_only_it_holds_gets_mass_for_a_longer_step)
{
    tl_model *m = hanging();
    double stable, low = 0, when = 0;
    scene_ok(m, tl_model_dt(m, &stable));
    const double mass = m->bodies.mass[0], period = 3 * 2 * TL_PI * sqrt(mass / K);
    tl_mass_scaling scaling = {sizeof scaling, 1, 3 * stable, 7.99};
    tl_solve_result result;
    char before[33], after[33];
    scene_ok(m, tl_state_hash(m, before));
    scene_ok(m, tl_model_mass_scaling(m, &scaling));
    CHECK_INT(tl_model_cycle(m, 1, &result), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "would add 8 of the mass of the bodies that can move");
    CHECK_CONTAINS(tl_model_error(m)->text, "block 1 would get 9 times its inertia");
    scene_ok(m, tl_model_mass_scaling(m, &(tl_mass_scaling){sizeof scaling, 0, NAN, NAN}));
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(after, before);
    scaling.most = 8.01;
    scene_ok(m, tl_model_mass_scaling(m, &scaling));
    for (int k = 0; m->time < period; k++) {
        tl_energy energy;
        run(m, 1);
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(fabs(energy.balance) < 1e-2);
        if (stretch_of(m, 0) < low) {
            low = stretch_of(m, 0);
            when = m->time;
        }
    }
    const tl_mass_added added = tl_model_mass_added(m);
    CHECK_INT(added.bodies, 1);
    CHECK_INT(added.worst, 1);
    CHECK_NEAR(added.factor, 9, 1e-9);
    CHECK_NEAR(added.share, 8, 1e-9);
    CHECK_NEAR(low, -2 * mass * G / K,
               0.07 * mass * G / K); /* a step is 0.7 rad: the lowest is within 0.35 rad of one */
    CHECK_NEAR(when, period / 2, 3 * stable);
    tl_model_destroy(m);
}

/* Rest is found where the spring carries the weight. */
TEST(a_cube_comes_to_rest_on_it)
{
    tl_model *m = hanging();
    tl_solve_result result;
    scene_ok(m, tl_model_damping(m, "local", &(tl_args){NULL, 0}));
    scene_ok(m, tl_model_solve(m,
                               &(tl_solve){.size = sizeof(tl_solve),
                                           .ratio = 1e-6,
                                           .measure = TL_RATIO_LOCAL,
                                           .velocity = NAN,
                                           .max_cycles = 100000,
                                           .max_time = NAN,
                                           .every = 500},
                               &result));
    CHECK(result.reason == TL_SOLVE_RATIO);
    CHECK_NEAR(stretch_of(m, 0), -m->bodies.mass[0] * G / K, 1e-5 * m->bodies.mass[0] * G / K);
    tl_model_destroy(m);
}

/* A step that it fails has changed nothing, also of contacts, which were asked before; and can be made again. */
TEST(a_step_that_it_fails_is_undone)
{
    tl_model *models[2] = {hanging(), NULL};
    char hash[2][33];
    for (int k = 0; k < 2; k++) {
        tl_model *m = models[k] ? models[k] : hanging();
        tl_solve_result result;
        run(m, 10);
        double force = springs.force[0];
        if (k == 1) {
            char before[33], after[33];
            springs.fails_at = 10;
            scene_ok(m, tl_state_hash(m, before));
            CHECK_INT(tl_model_cycle(m, 5, &result), TL_E_PLUGIN);
            scene_ok(m, tl_state_hash(m, after));
            CHECK_TEXT(after, before);
            CHECK_INT(m->cycles, 10);
            CHECK(springs.force[0] == force);
            springs.fails_at = -1;
        }
        run(m, 5);
        scene_ok(m, tl_state_hash(m, hash[k]));
        tl_model_destroy(m);
    }
    CHECK_TEXT(hash[1], hash[0]);
}

/* What acts on a body that is held, and whose contacts rest, follows a spring that is wound up. */
TEST(a_held_body_feels_it)
{
    tl_model *m = hanging();
    scene_box(m, tl_v3(-0.5, -0.5, -1.5), tl_v3(0.5, 0.5, -0.5));
    scene_ok(m, tl_blocks_fix(m, (const tl_id[]){1, 2}, 2, TL_FIX_ALL));
    for (int k = 0; k < 40; k++) {
        springs.wound = 100 * k;
        run(m, 1);
        CHECK_NEAR(tl_reaction_on(m->cycle, 0).force.z - tl_reaction_on(m->cycle, 1).force.z, 0, 1e-9);
        CHECK_NEAR(tl_reaction_on(m->cycle, 0).force.z, 100 * k, 1e-9);
    }
    CHECK(m->detect->any_idle);
    tl_model_destroy(m);
}

/* The memory of the springs outlives the models. */
TEST(springs_end)
{
    tl_table_free(&springs.table);
}

TEST_MAIN(RUN(a_cube_swings_on_it_and_makes_no_energy), RUN(a_cube_that_only_it_holds_gets_mass_for_a_longer_step),
          RUN(a_cube_comes_to_rest_on_it), RUN(a_step_that_it_fails_is_undone), RUN(a_held_body_feels_it),
          RUN(springs_end))
