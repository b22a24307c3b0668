/* test_safety.c - what a factor makes of parameters, and a search that is stopped. */
#include "base/strength.h"
#include "law_cases.h"

#include <math.h>
#include <talus/plugins.h>
#include <talus/safety.h>
#include <talus/state.h>

#define PI 3.14159265358979323846

typedef struct marked {
    double stress, angle, slope, divisor, work, plain;
    tl_points table;
} marked;

static const tl_param rows[] = {
    TL_PARAM(TL_PARAM_REAL, marked, stress, "Pa", "a stress", .flags = TL_PARAM_STRENGTH, .min = 0, .max = 10),
    TL_PARAM(TL_PARAM_REAL, marked, angle, "deg", "an angle", .flags = TL_PARAM_STRENGTH_ANGLE, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, marked, slope, "deg", "another", .flags = TL_PARAM_STRENGTH_ANGLE | TL_PARAM_MAX_OPEN,
             .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, marked, divisor, "", "a divisor", .flags = TL_PARAM_STRENGTH_DIVISOR | TL_PARAM_MIN_OPEN,
             .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, marked, work, "J/m2", "a work", .flags = TL_PARAM_STRENGTH_ENERGY, .min = 0,
             .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, marked, plain, "Pa/m", "no strength", .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_POINTS, marked, table, "deg", "a table", .flags = TL_PARAM_STRENGTH_ANGLE | TL_PARAM_FLAT),
};

static const tl_kind kind = {.size = sizeof kind,
                             .type = TL_KIND_SOLID,
                             .name = "marked",
                             .params = rows,
                             .param_count = sizeof rows / sizeof *rows,
                             .param_stride = sizeof *rows,
                             .params_size = sizeof(marked)};

/* The parameters, divided. */
static marked divide(marked given, double factor, double table[2])
{
    tl_args args;
    void *held;
    tl_error error;
    CHECK(tl_strengths_divide(&kind, &given, factor, &args, &held));
    CHECK_INT(tl_args_read(kind.params, kind.param_count, kind.param_stride, &args, true, &given, "", &error), TL_OK);
    for (size_t k = 0; k < given.table.count && k < 2; k++)
        table[k] = given.table.at[k].y;
    free(held);
    return given;
}

static const tl_vec3 steps[] = {{0, 40, 0}, {1, 20, 0}};
static const marked some = {6, 30, 60, 1, 8, 5, {steps, 2}};

TEST(each_mark_divides_in_its_way)
{
    double table[2];
    const marked half = divide(some, 2, table);
    CHECK_NEAR(half.stress, 3, 0);
    CHECK_REL(half.angle, atan(tan(PI / 6) / 2) * 180 / PI, 1e-14);
    CHECK_REL(half.slope, atan(tan(PI / 3) / 2) * 180 / PI, 1e-14);
    CHECK_NEAR(half.divisor, 2, 0);
    CHECK_NEAR(half.work, 2, 0);
    CHECK_NEAR(half.plain, 5, 0);
    CHECK_REL(table[0], atan(tan(PI / 4.5) / 2) * 180 / PI, 1e-14);
    CHECK_REL(table[1], atan(tan(PI / 9) / 2) * 180 / PI, 1e-14);
    const marked same = divide(some, 1, table);
    CHECK_NEAR(same.angle, 30, 0);
    CHECK_NEAR(same.slope, 60, 0);
    CHECK(tl_kind_has_strength(&kind));
    tl_kind none = kind;
    none.params = &rows[5];
    none.param_count = 1;
    CHECK(!tl_kind_has_strength(&none));
}

TEST(values_stay_in_their_ranges)
{
    double table[2];
    marked steep = some;
    steep.angle = 90;
    steep.slope = nextafter(90, 0);
    const marked strong = divide(steep, 0.05, table);
    CHECK_NEAR(strong.angle, 90, 0);
    CHECK(strong.slope < 90);
    CHECK_NEAR(strong.stress, 10, 0);
    CHECK_NEAR(divide(steep, 100, table).angle, 90, 0);
    marked level = some;
    level.angle = level.stress = level.work = 0;
    const marked weak = divide(level, 3, table);
    CHECK_NEAR(weak.angle, 0, 0);
    CHECK_NEAR(weak.stress, 0, 0);
    CHECK_NEAR(weak.work, 0, 0);
    /* what is left out stays left out */
    level.stress = NAN;
    CHECK(isnan(divide(level, 3, table).stress));
}

/* Equal angles stay equal, and larger ones do not become smaller ones. */
TEST(angles_keep_their_order)
{
    double table[2];
    for (int k = 0; k < 900; k++)
        for (int j = 0; j < 4; j++) {
            static const double factors[] = {0.05, 0.7, 1.3, 10};
            marked pair = some;
            pair.angle = pair.slope = 0.1 * k;
            const marked equal = divide(pair, factors[j], table);
            pair.angle = 0.1 * (k + 1);
            CHECK(equal.angle == equal.slope);
            CHECK(divide(pair, factors[j], table).angle >= equal.slope);
        }
}

/* A cube on a level base. */
static tl_model *cube_on_base(void)
{
    const tl_model_config config = {.size = sizeof config, .seed = 1, .threads = 1};
    const tl_id held = 1;
    tl_error error;
    tl_model *m;
    tl_plugins_load_default();
    const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1}, below[3] = {0, 0, -1}, top[3] = {1, 1, 0};
    const tl_args strong = {frictional, 4};
    if (tl_model_create(&config, &m, &error) != TL_OK ||
        tl_generate(
            m, "box",
            TL_ARGS(tl_arg_numbers("min", below, 3), tl_arg_numbers("max", top, 3), tl_arg_number("density", 2000)),
            NULL) != TL_OK ||
        tl_generate(
            m, "box",
            TL_ARGS(tl_arg_numbers("min", low, 3), tl_arg_numbers("max", high, 3), tl_arg_number("density", 2000)),
            NULL) != TL_OK ||
        tl_blocks_fix(m, &held, 1, TL_FIX_ALL) != TL_OK || tl_joint_law(m, "*", "coulomb", &strong) != TL_OK) {
        printf("%s\n", tl_model_error(m)->text);
        exit(1);
    }
    return m;
}

static int asked_before;

static bool asked(void)
{
    return asked_before-- <= 0;
}

TEST(a_search_that_is_stopped_leaves_the_model)
{
    tl_model *m = cube_on_base();
    char before[33], after[33];
    tl_safety_result result;
    CHECK_INT(tl_state_hash(m, before), TL_OK);
    for (int k = 0; k < 20; k++) {
        asked_before = k;
        tl_model_interrupt_if(m, asked);
        CHECK_INT(tl_model_factor_of_safety(m, NULL, &result), TL_E_CANCELLED);
        CHECK_CONTAINS(tl_model_error(m)->text, "the model is as it was");
        CHECK(result.trials == NULL && result.failing.ids == NULL);
        tl_safety_map map;
        asked_before = k;
        CHECK_INT(tl_model_safety_map(m, NULL, &map), TL_E_CANCELLED);
        CHECK(map.ids == NULL && map.factor == NULL && map.curve == NULL);
        tl_model_interrupt_if(m, NULL);
        CHECK_INT(tl_state_hash(m, after), TL_OK);
        CHECK_TEXT(after, before);
    }
    CHECK_INT(tl_model_factor_of_safety(m, NULL, &result), TL_OK);
    CHECK(isinf(result.factor));
    CHECK_TEXT(tl_safety_mode_name((tl_safety_mode)result.mode), "holds");
    tl_safety_free(&result);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(each_mark_divides_in_its_way), RUN(values_stay_in_their_ranges), RUN(angles_keep_their_order),
          RUN(a_search_that_is_stopped_leaves_the_model))
