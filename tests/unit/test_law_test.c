/* test_law_test.c - laws that are tried on one point, from C: what cannot be walked is refused by both functions, with the same sentence, before
 * any law is asked; what can be gives as many points as were told. */
#include "contact_scene.h"

#include <talus/law_test.h>

static const tl_law_leg nothing = {NAN, NAN, NAN, NAN, NAN, 0};

/* Both functions say `part`, and no point is written. */
static void refuses(tl_law_test test, const char *part)
{
    tl_error counted = {0}, run = {0};
    tl_law_point points[8];
    size_t count;
    points[0].time = -1;
    CHECK_INT(tl_law_test_points(&test, &count, &counted), TL_E_ARGUMENT);
    CHECK_INT(tl_law_test_run(&test, points, NULL, NULL, &run), TL_E_ARGUMENT);
    CHECK_CONTAINS(counted.text, part);
    CHECK_TEXT(run.text, counted.text);
    CHECK(points[0].time == -1);
}

static tl_law_test sheared(const tl_law_leg *path, size_t count, const tl_args *params)
{
    return (tl_law_test){.law = "coulomb",
                         .params = params,
                         .normal_stress = 1e6,
                         .stiffness = NAN,
                         .speed = 1e-3,
                         .steps = 3,
                         .every = 1,
                         .path = path,
                         .count = count};
}

TEST(what_cannot_be_walked_is_refused)
{
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e10},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e10}};
    const tl_args params = {values, 2};
    tl_law_leg leg = nothing;
    tl_law_test test = sheared(&leg, 1, &params);
    refuses(test, "path[1]: nothing is to happen");
    leg.shear = 0.001;
    leg.closure = 0.001;
    refuses(test, "path[1]: closure is given in a test by normal_stress");
    leg.closure = NAN;
    leg.time = leg.speed = 1;
    refuses(test, "path[1]: time and speed both say how long it takes");
    leg.time = leg.speed = NAN;
    leg.normal_stress = 2e6;
    test.stiffness = 1e9;
    refuses(test, "path[1]: normal_stress can change only in a test with");
    leg.normal_stress = NAN;
    test.normal_stress = NAN;
    refuses(test, "stiffness needs normal_stress");
    test.stiffness = NAN;
    test.count = 0;
    refuses(test, "path has no legs");
}

TEST(what_can_gives_the_points_that_were_told)
{
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e10},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e10}};
    const tl_args params = {values, 2};
    tl_law_leg path[2] = {nothing, nothing};
    tl_model_destroy(scene_model(1)); /* loads the laws */
    path[0].shear = 1e-5;
    path[1].time = 2;
    const tl_law_test test = sheared(path, 2, &params);
    tl_law_point points[8];
    size_t count, ends[2];
    const tl_kind *law;
    tl_error error = {0};
    CHECK_INT(tl_law_test_points(&test, &count, &error), TL_OK);
    CHECK_INT((int)count, 7);
    CHECK_INT(tl_law_test_run(&test, points, ends, &law, &error), TL_OK);
    CHECK_INT((int)ends[0], 3);
    CHECK_INT((int)ends[1], 6);
    CHECK_TEXT(law->name, "coulomb");
    CHECK_NEAR(points[6].shear, 1e-5, 1e-18);
    CHECK_NEAR(points[6].time, 2 + 1e-2, 1e-12);
    CHECK_NEAR(points[3].normal_stress, 1e6, 1);
}

TEST_MAIN(RUN(what_cannot_be_walked_is_refused), RUN(what_can_gives_the_points_that_were_told))
