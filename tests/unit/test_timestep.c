/* test_timestep.c - the rates that the rules of the time step keep from step to step, against rates made anew in
 * every step: of blocks that fall on each other, so that contacts come, go and change all the time. */
#include "../contact_scene.h"

#define KN 1e8 /* Pa/m */
#define ALIKE                                                                                      \
    1e-5 /* areas and arms are kept within 1e-6 of a block's size, and count twice or more */
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
        scene_block(m, scene_random_hull(&seed, 16, tl_v3(0.5, 0.4, 0.5)), scene_any_turn(&seed),
                    at);
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
    struct tl_rated rated = c->rated;
    memcpy(copy, c->rate, bytes);
    c->rated.version = 0;
    scene_ok(m, tl_timestep_choose(m, &dt));
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        worst = fmax(worst, fabs(copy[body] - c->rate[body]) / fmax(c->rate[body], 1e-300));
    c->rated = rated;
    memcpy(c->rate, copy, bytes);
    scene_ok(m, tl_step(m));
    return worst;
}

TEST(kept_rates_are_those_of_the_present_contacts)
{
    tl_model *m = shower();
    scene_ok(m, tl_model_timestep(
                    m, &(tl_timestep){.rule = TL_TIMESTEP_BODY, .fraction = 0.5, .dt = NAN}));
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
    scene_ok(m, tl_model_mass_scaling(m, true));
    double copy[BLOCKS + 1];
    int missed = 0;
    for (int i = 0; i < STEPS; i++) {
        compare_step(m, copy);
        for (uint32_t row = 1; row < m->blocks.table.rows; row++) {
            uint32_t begin = m->detect->by_block_start[row],
                     end = m->detect->by_block_start[row + 1];
            bool carries = false;
            for (uint32_t e = begin; e < end; e++)
                carries = carries || m->detect->contacts.area[m->detect->by_block[e]] > 0;
            missed += carries && !(m->cycle->rate[m->blocks.body[row]] > 0);
        }
    }
    CHECK_INT(missed, 0);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(kept_rates_are_those_of_the_present_contacts),
          RUN(mass_scaling_knows_which_bodies_have_contacts))
