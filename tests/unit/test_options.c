/* test_options.c - structs of options: their defaults are those of the tables, and callers of older and newer headers are
 * told apart by the size. */
#include "check.h"
#include "model/options.h"

/* The defaults of a table, written over `own`, must be those that are there already. */
static void compare(const char *function, const void *defaults, size_t bytes)
{
    unsigned char own[512];
    size_t count;
    tl_error error;
    const tl_args none = {NULL, 0};
    const tl_param *params = tl_function_params(function, &count, NULL);
    CHECK(params != NULL && bytes <= sizeof own);
    memcpy(own, defaults, bytes);
    CHECK_INT(tl_args_read(params, count, sizeof *params, &none, false, own, function, &error), TL_OK);
    if (!CHECK(memcmp(own, defaults, bytes) == 0))
        printf("  the defaults of %s are not those of its table\n", function);
}

#define COMPARE(function, type)                                                                                        \
    do {                                                                                                               \
        type defaults = type##_default();                                                                              \
        CHECK_INT(defaults.size, sizeof(type));                                                                        \
        compare(function, &defaults, sizeof defaults);                                                                 \
    } while (0)

TEST(defaults_are_those_of_the_tables)
{
    COMPARE("model", tl_model_config);
    COMPARE("filter", tl_filter);
    COMPARE("insitu", tl_insitu);
    COMPARE("timestep", tl_timestep);
    COMPARE("mass_scaling", tl_mass_scaling);
    COMPARE("contact_area", tl_contact_area);
    COMPARE("solve", tl_solve);
    COMPARE("load", tl_load);
    COMPARE("keyblocks", tl_keyblock_query);
    COMPARE("write_vtk", tl_vtk_parts);
}

TEST(defaults_without_a_table)
{
    tl_block_filter blocks = tl_block_filter_default();
    CHECK(blocks.fixed == -1 && blocks.hidden == 0 && !blocks.group && !blocks.inside);
    tl_block_set set = tl_block_set_default();
    CHECK(isnan(set.density) && isnan(set.velocity.z) && isnan(set.angular_velocity.x));
    CHECK(!set.group);
    tl_drive drive = tl_drive_default();
    CHECK(drive.velocity.x == 0 && !drive.velocity_at && !drive.release);
    tl_contact_filter contacts = tl_contact_filter_default();
    CHECK(!contacts.joint && !contacts.between_a);
}

/* As a program that was built when tl_solve ended with `measure` would have it. */
TEST(an_older_struct_is_filled_up)
{
    tl_error error;
    tl_solve own, old;
    memset(&old, 0xff, sizeof old); /* what lies behind it is another thing of the program's */
    tl_options_default(TL_OPTIONS_OF_tl_solve, &old, offsetof(tl_solve, velocity));
    old.ratio = 0.25;
    CHECK_INT(old.size, offsetof(tl_solve, velocity));
    CHECK(old.stop_at_failure == -1);
    CHECK_INT(TL_OPTIONS_READ(tl_solve, &old, &own, &error), TL_OK);
    CHECK(own.ratio == 0.25 && isnan(own.velocity) && own.every == 500 && !own.progress);
    CHECK_INT(own.stop_at_failure, 0);
    CHECK_INT(own.size, sizeof own);
}

TEST(nothing_means_the_defaults)
{
    tl_error error;
    tl_model *m;
    CHECK_INT(tl_model_create(NULL, &m, &error), TL_OK);
    CHECK(tl_model_settings(m).gravity.z == -9.81);
    CHECK_INT(tl_model_settings(m).size, sizeof(tl_model_config));
    tl_id *ids;
    size_t count;
    CHECK_INT(tl_blocks_select(m, NULL, &ids, &count), TL_OK);
    CHECK_INT(count, 0);
    free(ids);
    tl_solve_result result;
    const tl_history clock = {.name = "clock", .asked = "kinetic", .source = TL_FROM_MODEL, .every = 1};
    CHECK_INT(tl_model_cycle_calling(m, 2, NULL, &result), TL_OK);
    CHECK_INT(result.cycles, 2);
    CHECK_INT(tl_model_cycle_calling(m, 2, NULL, NULL), TL_OK);
    CHECK_INT(tl_history_add(m, &clock, NULL), TL_OK);
    CHECK(tl_history_at(m, 0) != NULL);
    tl_model_destroy(m);
}

/* The call is refused for the size of its options, which it names first. */
#define REFUSES(call, options)                                                                                         \
    do {                                                                                                               \
        CHECK_INT(call, TL_E_ARGUMENT);                                                                                \
        CHECK_CONTAINS(tl_model_error(m)->text, options ": size = 0");                                                 \
    } while (0)

TEST(a_wrong_size_is_refused)
{
    tl_error error;
    tl_model *m = NULL;
    tl_model_config config = tl_model_config_default();
    config.size = 0;
    CHECK_INT(tl_model_create(&config, &m, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "tl_model_config: size = 0");
    CHECK_CONTAINS(error.text, "tl_model_config_default()");
    CHECK(m == NULL);
    config.size = sizeof config + 8;
    CHECK_INT(tl_model_create(&config, &m, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "headers of a newer one");
    /* every function that takes options looks at the size */
    CHECK_INT(tl_model_create(NULL, &m, &error), TL_OK);
    static const uint64_t zeros[64];
    tl_id *ids;
    size_t count;
    tl_contact_name *names;
    tl_filter_result filtered;
    tl_keyblocks keyblocks;
    tl_solve_result solved;
    const void *const bad = zeros;
    REFUSES(tl_blocks_select(m, bad, &ids, &count), "tl_block_filter");
    REFUSES(tl_contacts_select(m, bad, &names, &count), "tl_contact_filter");
    REFUSES(tl_blocks_set(m, NULL, 0, bad), "tl_block_set");
    REFUSES(tl_blocks_load(m, NULL, 0, bad), "tl_load");
    REFUSES(tl_blocks_drive(m, NULL, 0, bad), "tl_drive");
    REFUSES(tl_model_filter(m, bad, &filtered), "tl_filter");
    REFUSES(tl_model_keyblocks(m, bad, &keyblocks), "tl_keyblock_query");
    REFUSES(tl_model_insitu(m, bad), "tl_insitu");
    REFUSES(tl_model_timestep(m, bad), "tl_timestep");
    REFUSES(tl_model_mass_scaling(m, bad), "tl_mass_scaling");
    REFUSES(tl_model_contact_area(m, bad), "tl_contact_area");
    REFUSES(tl_model_solve(m, bad, &solved), "tl_solve");
    REFUSES(tl_write_vtk(m, TALUS_TEST_TMP "/options", bad), "tl_vtk_parts");
    tl_model_destroy(m);
}

/* A number that is none of an enumeration's, as a C program may give, changes nothing. */
TEST(a_choice_that_there_is_not_is_refused)
{
    tl_model *m;
    tl_error error;
    tl_model_config config = tl_model_config_default();
    config.contact_points = TL_POINTS_CORNERS + 1;
    CHECK_INT(tl_model_create(&config, &m, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "model: contact_points = 2 must be one of 0 to 1");
    config.contact_points = TL_POINTS_CORNERS;
    config.rotation = -1;
    CHECK_INT(tl_model_create(&config, &m, NULL), TL_E_ARGUMENT);
    CHECK_INT(tl_model_create(NULL, &m, &error), TL_OK);
    CHECK_INT(tl_model_set_contact_points(m, (tl_contact_points)7), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "contact_points = 7 must be one of 0 to 1");
    CHECK_INT(tl_model_set_rotation(m, (tl_rotation_rule)-3), TL_E_ARGUMENT);
    CHECK_INT(tl_model_settings(m).contact_points, TL_POINTS_CONSISTENT);
    CHECK_INT(tl_model_settings(m).rotation, TL_ROTATION_EXACT);
    tl_model_destroy(m);
}

static void keep_remark(void *user, const char *text)
{
    snprintf(user, 512, "%s", text);
}

/* Remedies are functions of C in a program of C, and verbs of Lua where Lua has said so. */
TEST(remedies_are_in_the_words_of_who_called)
{
    for (int lua = 0; lua < 2; lua++) {
        char remark[512] = "";
        tl_model *m;
        CHECK_INT(tl_model_create(NULL, &m, NULL), TL_OK);
        tl_model_log(m, keep_remark, remark);
        if (lua)
            tl_model_speak_lua(m, 1);
        CHECK_INT(tl_model_solve(m, NULL, NULL), TL_OK);
        CHECK_CONTAINS(remark, lua ? "model:damping(\"local\")" : "tl_model_damping() with \"local\"");
        CHECK_INT(tl_joint_law(m, "*", NULL, NULL), TL_E_STATE);
        CHECK_CONTAINS(tl_model_error(m)->text, lua ? "model:joint(\"*\", LAW" : "give tl_joint_law() one");
        tl_model *twin;
        CHECK_INT(tl_model_copy(m, NULL, NULL, &twin), TL_OK);
        CHECK_INT(tl_joint_law(twin, "*", NULL, NULL), TL_E_STATE);
        CHECK_TEXT(tl_model_error(twin)->text, tl_model_error(m)->text);
        tl_model_destroy(twin);
        tl_model_destroy(m);
    }
}

TEST_MAIN(RUN(defaults_are_those_of_the_tables), RUN(defaults_without_a_table), RUN(an_older_struct_is_filled_up),
          RUN(nothing_means_the_defaults), RUN(a_wrong_size_is_refused), RUN(a_choice_that_there_is_not_is_refused),
          RUN(remedies_are_in_the_words_of_who_called))
