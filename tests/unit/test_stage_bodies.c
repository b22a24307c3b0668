/* test_stage_bodies.c - what generators do to single blocks and their bodies, through the host's
 * services. */
#include "check.h"
#include "model/model.h"

/* Runs the test generator in a new model. */
static tl_model *run(const char *mode, tl_status expected, tl_generate_summary *summary)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = 1, .threads = 1};
    tl_error error;
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_value value = {.key = "mode", .type = TL_VALUE_STRING, .text = mode};
    tl_args args = {&value, 1};
    if (!CHECK_INT(tl_generate(m, "single_blocks", &args, summary), expected))
        printf("%s: %s\n", mode, tl_model_error(m)->text);
    return m;
}

typedef struct outcome {
    const char *mode;
    size_t blocks, bodies, largest; /* the last: members of the first body */
    double volume;
} outcome;

TEST(bodies_follow_what_generators_do)
{
    static const outcome outcomes[] = {
        {"join", 4, 2, 3, 4},          /* three and one */
        {"join_cut", 8, 4, 3, 4},      /* the three hang together above and below the joint */
        {"remove", 4, 4, 1, 3},        /* and a joint cuts the third of the row */
        {"remove_joined", 4, 4, 1, 3}, /* the middle one of the three held them together */
        {"part", 4, 4, 1, 4},          /* likewise */
        {"hide", 7, 7, 1, 4},          /* the hidden one is not cut */
        {"hide_show", 8, 8, 1, 4},
    };
    for (size_t i = 0; i < sizeof outcomes / sizeof *outcomes; i++) {
        const outcome *o = &outcomes[i];
        tl_generate_summary summary;
        tl_model *m = run(o->mode, TL_OK, &summary);
        CHECK_INT(tl_block_count(m), o->blocks);
        CHECK_INT(m->bodies.table.rows, o->bodies);
        if (m->bodies.table.rows)
            CHECK_INT(m->bodies.member_count[0], o->largest);
        double volume = 0, mass = 0;
        for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
            volume += m->blocks.volume[row];
            CHECK_INT(m->blocks.hidden[row], 0); /* hiding ends with the generator */
        }
        for (uint32_t body = 0; body < m->bodies.table.rows; body++)
            mass += m->bodies.mass[body];
        CHECK_REL(volume, o->volume, 1e-14);
        CHECK_REL(mass, 2000 * o->volume, 1e-14);
        CHECK(summary.volume_error <= 1e-14);
        tl_model_destroy(m);
    }
}

TEST(mistakes_of_a_generator_are_told)
{
    static const char *const modes[] = {"beyond", "long_group", "skew"};
    static const char *const reasons[] = {"it asks for block 4 of 4, counted from 0", "is longer than 63 letters",
                                          "which is not of unit length"};
    for (int i = 0; i < 3; i++) {
        tl_model *m = run(modes[i], i == 0 ? TL_E_PLUGIN : i == 1 ? TL_E_ARGUMENT : TL_E_NUMERIC, NULL);
        CHECK_CONTAINS(tl_model_error(m)->text, "generator 'single_blocks' of plugin 'test.single_blocks': ");
        CHECK_CONTAINS(tl_model_error(m)->text, reasons[i]);
        CHECK_INT(tl_block_count(m), 0);
        CHECK_INT(m->group_count, 0);
        tl_model_destroy(m);
    }
}

int main(void)
{
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    if (!CHECK_INT(tl_plugin_load(TALUS_BAD_PLUGIN_DIR "/single_blocks.so", &error), TL_OK))
        printf("%s\n", error.text);
    RUN(bodies_follow_what_generators_do);
    RUN(mistakes_of_a_generator_are_told);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
