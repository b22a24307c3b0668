/* test_params.c - the sentences a mistyped, mistaken or missing parameter earns. */
#include "base/error.h"
#include "base/names.h"
#include "base/params.h"
#include "check.h"

#include <talus/number.h>

typedef struct sample_params {
    double friction, spacing, scale;
    double limit;
    int64_t number;
    int32_t on, rule;
    tl_vec3 origin, at;
    const char *name, *label;
    tl_points vertices;
} sample_params;

static const char *const rules[] = {"paper", "body", NULL};

static const tl_param table[] = {
    TL_PARAM(TL_PARAM_REAL, sample_params, friction, "deg", "angle of friction", .alias = "phi",
             .flags = TL_PARAM_MAX_OPEN, .def = {30}, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, sample_params, spacing, "m", "distance between planes",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, sample_params, scale, "", "some factor", .def = {-2}, .min = -INFINITY, .max = 0),
    TL_PARAM(TL_PARAM_REAL, sample_params, limit, "s", "longest time", .flags = TL_PARAM_OPTIONAL, .min = 0,
             .max = INFINITY),
    TL_PARAM(TL_PARAM_INT, sample_params, number, "", "how many", .def = {7}, .min = 1, .max = 100),
    TL_PARAM(TL_PARAM_BOOL, sample_params, on, "", "whether", .def = {1}),
    TL_PARAM(TL_PARAM_ENUM, sample_params, rule, "", "which rule", .def = {1}, .choices = rules),
    TL_PARAM(TL_PARAM_VEC3, sample_params, origin, "m", "a point", .def = {1, 2, 3}),
    TL_PARAM(TL_PARAM_VEC3, sample_params, at, "m", "another point", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, sample_params, name, "", "its name", .def_text = "rock"),
    TL_PARAM(TL_PARAM_STRING, sample_params, label, "", "a label", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_POINTS, sample_params, vertices, "m", "corners", .flags = TL_PARAM_OPTIONAL),
};

enum { ROWS = sizeof table / sizeof *table };

static tl_error error;

static tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static tl_value text(const char *key, const char *value)
{
    return (tl_value){.key = key, .type = TL_VALUE_STRING, .text = value};
}

static tl_value list(const char *key, tl_value_type type, const double *data, size_t count)
{
    return (tl_value){.key = key, .type = type, .data = data, .count = count};
}

static tl_status read_all(sample_params *t, const tl_value *values, size_t count, bool keep)
{
    error = (tl_error){TL_OK, ""};
    tl_args args = {values, count};
    return tl_args_read(table, ROWS, sizeof *table, &args, keep, t, "joint 'J1', law 'x'", &error);
}

/* One value beside the required one is refused with exactly this sentence. */
static void refused(tl_value value, const char *sentence)
{
    sample_params t;
    tl_value values[] = {number("spacing", 1), value};
    char whole[TL_ERROR_TEXT];
    snprintf(whole, sizeof whole, "joint 'J1', law 'x': %s", sentence);
    CHECK_INT(read_all(&t, values, 2, false), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, whole);
}

static void accepted(tl_value value, sample_params *t)
{
    tl_value values[] = {number("spacing", 1), value};
    if (!CHECK_INT(read_all(t, values, 2, false), TL_OK))
        printf("%s\n", error.text);
}

TEST(defaults_fill_what_is_not_given)
{
    sample_params t;
    tl_value values[] = {number("spacing", 0.25)};
    CHECK_INT(read_all(&t, values, 1, false), TL_OK);
    CHECK(t.friction == 30 && t.spacing == 0.25 && t.scale == -2 && isnan(t.limit));
    CHECK(t.number == 7 && t.on == 1 && t.rule == 1);
    CHECK(t.origin.x == 1 && t.origin.y == 2 && t.origin.z == 3 && isnan(t.at.y));
    CHECK_TEXT(t.name, "rock");
    CHECK(t.label == NULL && t.vertices.at == NULL && t.vertices.count == 0);
}

TEST(values_of_every_type_arrive)
{
    static const double point[] = {4, 5, 6}, points[] = {0, 0, 0, 1, 2, 3};
    sample_params t;
    accepted(number("phi", 89.5), &t);
    CHECK(t.friction == 89.5);
    accepted(number("number", 100), &t);
    CHECK_INT(t.number, 100);
    accepted((tl_value){.key = "on", .type = TL_VALUE_BOOL, .number = 0}, &t);
    CHECK_INT(t.on, 0);
    accepted(text("rule", "paper"), &t);
    CHECK_INT(t.rule, 0);
    accepted(list("origin", TL_VALUE_NUMBERS, point, 3), &t);
    CHECK(t.origin.x == 4 && t.origin.y == 5 && t.origin.z == 6);
    accepted(text("label", "abc"), &t);
    CHECK_TEXT(t.label, "abc");
    accepted(list("vertices", TL_VALUE_POINTS, points, 2), &t);
    CHECK(t.vertices.count == 2 && t.vertices.at[1].y == 2);
    accepted(list("vertices", TL_VALUE_NUMBERS, NULL, 0), &t);
    CHECK_INT(t.vertices.count, 0);
}

TEST(ranges_with_open_and_missing_ends)
{
    sample_params t;
    accepted(number("friction", 0), &t);
    refused(number("friction", 90), "friction = 90 deg is outside [0, 90)");
    refused(number("friction", 95), "friction = 95 deg is outside [0, 90)");
    refused(number("phi", -1e-9), "friction = -1e-09 deg is outside [0, 90)");
    refused(number("friction", 90.00000001), "friction = 90.00000001 deg is outside [0, 90)");
    refused(number("scale", 0.5), "scale = 0.5 must be <= 0");
    refused(number("limit", -1), "limit = -1 s must be >= 0");
    refused(number("number", 0), "number = 0 is outside [1, 100]");
    tl_value zero[] = {number("spacing", 0)};
    CHECK_INT(read_all(&t, zero, 1, false), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "joint 'J1', law 'x': spacing = 0 m must be > 0");
}

TEST(numbers_must_be_finite_and_whole)
{
    static const double bad[] = {0, NAN, 0}, worse[] = {0, 0, 0, 1, 2, INFINITY};
    refused(number("friction", NAN), "friction = nan is not a finite number");
    refused(number("friction", -NAN), "friction = nan is not a finite number");
    refused(number("limit", INFINITY), "limit = inf is not a finite number");
    refused(number("number", 2.5), "number must be a whole number, not the number 2.5");
    refused(list("origin", TL_VALUE_NUMBERS, bad, 3), "origin.y = nan is not a finite number");
    refused(list("vertices", TL_VALUE_POINTS, worse, 2), "vertices, row 2, z = inf is not a finite number");
}

TEST(wrong_types_name_both)
{
    static const double two[] = {1, 2};
    refused(text("friction", "30"), "friction must be a number, not the string '30'");
    refused(number("on", 1), "on must be true or false, not the number 1");
    refused(number("name", 3.25), "name must be a string, not the number 3.25");
    refused((tl_value){.key = "number", .type = TL_VALUE_BOOL, .number = 1}, "number must be a whole number, not true");
    refused(number("origin", 1), "origin must be a list of 3 numbers {x, y, z}, not the number 1");
    refused(list("origin", TL_VALUE_NUMBERS, two, 2),
            "origin must be a list of 3 numbers {x, y, z}, not a list of 2 numbers");
    refused(list("vertices", TL_VALUE_NUMBERS, two, 2),
            "vertices must be a list of points {{x, y, z}, ...}, not a list of 2 numbers");
    refused((tl_value){.key = "friction", .type = TL_VALUE_OTHER, .text = "function"},
            "friction must be a number, not a function");
    refused((tl_value){.key = "vertices", .type = TL_VALUE_OTHER, .text = "list whose row 4 has 2 numbers"},
            "vertices must be a list of points {{x, y, z}, ...}, not a list whose row 4 has 2 "
            "numbers");
    refused(number("rule", 1), "rule must be a name in quotes, not the number 1");
    refused(text("rule", "papre"), "unknown rule 'papre'; did you mean 'paper'? (known: paper, body)");
}

TEST(unknown_keys_get_the_nearest_name)
{
    static const char known[] = "(known: friction, phi, spacing, scale, limit, number, on, rule, "
                                "origin, at, name, label, vertices)";
    char sentence[TL_ERROR_TEXT];
    snprintf(sentence, sizeof sentence, "unknown parameter 'frction'; did you mean 'friction'? %s", known);
    refused(number("frction", 1), sentence);
    snprintf(sentence, sizeof sentence, "unknown parameter 'qqqqqq' %s", known);
    refused(number("qqqqqq", 1), sentence);
    error = (tl_error){TL_OK, ""};
    tl_value values[] = {number("a", 1)};
    char nothing;
    CHECK_INT(tl_args_read(NULL, 0, 0, &(tl_args){values, 1}, false, &nothing, "damping 'none'", &error),
              TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "damping 'none': unknown parameter 'a' (it takes none)");
}

TEST(missing_and_double_parameters)
{
    sample_params t;
    CHECK_INT(read_all(&t, NULL, 0, false), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "joint 'J1', law 'x': parameter 'spacing' is missing, in m (distance between planes)");
    CHECK_INT(tl_args_read(table, ROWS, sizeof *table, NULL, false, &t, "", &error), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "parameter 'spacing' is missing, in m (distance between planes)");
    tl_value values[] = {number("spacing", 1), number("friction", 10), number("phi", 20)};
    CHECK_INT(read_all(&t, values, 3, false), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "joint 'J1', law 'x': friction and phi are the same parameter: give one "
                           "of them");
}

TEST(keep_writes_only_what_is_given)
{
    sample_params t;
    memset(&t, 0, sizeof t);
    t.spacing = 8;
    t.number = 9;
    tl_value values[] = {number("friction", 12)};
    CHECK_INT(read_all(&t, values, 1, true), TL_OK);
    CHECK(t.friction == 12 && t.spacing == 8 && t.number == 9 && t.name == NULL);
    CHECK_INT(read_all(&t, NULL, 0, true), TL_OK);
}

/* A table of an older plugin, whose rows were shorter, and of a newer one, whose rows are longer. */
TEST(tables_of_other_versions_are_read)
{
    struct longer {
        tl_param param;
        char more[24];
    } wide[2];
    memset(wide, 0x55, sizeof wide);
    for (int i = 0; i < 2; i++) {
        wide[i].param = table[i];
        wide[i].param.size = sizeof wide[i];
    }
    sample_params t;
    tl_value values[] = {number("spacing", 3)};
    tl_args args = {values, 1};
    CHECK_INT(tl_args_read(&wide[0].param, 2, sizeof *wide, &args, false, &t, "", &error), TL_OK);
    CHECK(t.friction == 30 && t.spacing == 3);

    /* Rows that end before `def_text`: what lies there belongs to the next row. */
    enum { SHORT = offsetof(tl_param, def_text) };
    _Alignas(tl_param) char narrow[3 * SHORT];
    for (int i = 0; i < 3; i++) {
        tl_param row = table[i == 2 ? 9 : i];
        row.size = SHORT;
        memcpy(narrow + i * SHORT, &row, SHORT);
    }
    CHECK_INT(tl_args_read((const tl_param *)(const void *)narrow, 3, SHORT, &args, false, &t, "", &error), TL_OK);
    CHECK(t.friction == 30 && t.spacing == 3 && t.name == NULL);
}

TEST(nearest_names)
{
    static const char *const names[] = {"friction", "cohesion", "kn", "ks", "dip", "dip_direction"};
    CHECK_TEXT(tl_nearest_name("Friction", names, 6), "friction");
    CHECK_TEXT(tl_nearest_name("fritcion", names, 6), "friction");
    CHECK_TEXT(tl_nearest_name("fric", names, 6), "friction");
    CHECK_TEXT(tl_nearest_name("cohesoin", names, 6), "cohesion");
    CHECK_TEXT(tl_nearest_name("dipdirection", names, 6), "dip_direction");
    CHECK_TEXT(tl_nearest_name("kk", names, 6), "kn");
    CHECK(tl_nearest_name("x", names, 6) == NULL);
    CHECK(tl_nearest_name("", names, 6) == NULL);
    CHECK(tl_nearest_name("density", names, 6) == NULL);
    CHECK(tl_nearest_name("kn", names, 0) == NULL);
}

TEST(edit_distance_is_a_metric_on_short_words)
{
    CHECK_INT(tl_edit_distance("", ""), 0);
    CHECK_INT(tl_edit_distance("kitten", "sitting"), 3);
    CHECK_INT(tl_edit_distance("ab", "ba"), 1);
    CHECK_INT(tl_edit_distance("abc", ""), 3);
    char longer[65];
    memset(longer, 'a', 64);
    longer[64] = '\0';
    CHECK(tl_edit_distance(longer, "a") == SIZE_MAX);
    /* Symmetric, zero only for equal words, at most the longer length, at least the difference. */
    uint64_t seed = 4;
    for (int round = 0; round < 2000; round++) {
        char a[9], b[9];
        size_t la = (size_t)(9 * check_random(&seed)), lb = (size_t)(9 * check_random(&seed));
        for (size_t i = 0; i < la; i++)
            a[i] = (char)('a' + (int)(3 * check_random(&seed)));
        for (size_t i = 0; i < lb; i++)
            b[i] = (char)('a' + (int)(3 * check_random(&seed)));
        a[la] = b[lb] = '\0';
        size_t d = tl_edit_distance(a, b);
        CHECK_INT(d, tl_edit_distance(b, a));
        CHECK((d == 0) == (strcmp(a, b) == 0));
        CHECK(d <= (la > lb ? la : lb) && d >= (la > lb ? la - lb : lb - la));
    }
}

TEST(number_texts_read_back_the_same)
{
    uint64_t seed = 12;
    char out[TL_NUMBER_TEXT];
    for (int i = 0; i < 2000; i++) {
        double value = ldexp(check_random(&seed) - 0.5, (int)(200 * check_random(&seed)) - 100);
        tl_number_text(value, out);
        CHECK(tl_number_read(out, NULL) == value);
    }
    tl_number_text(0.1, out);
    CHECK_TEXT(out, "0.1");
    char cut[4];
    tl_param_range(&table[0], cut, sizeof cut);
    CHECK_TEXT(cut, "[0,");
}

/* A value as long as the sentence, and many names, are cut off and never overrun. */
TEST(long_texts_are_cut)
{
    char longer[2000];
    memset(longer, 'z', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    sample_params t;
    tl_value values[] = {number(longer, 1)};
    CHECK_INT(read_all(&t, values, 1, false), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "unknown parameter 'zzzz");
    values[0] = text("spacing", longer);
    CHECK_INT(read_all(&t, values, 1, false), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "spacing must be a number, not the string 'zzzz");
    CHECK_INT(tl_args_read(table, ROWS, sizeof *table, &(tl_args){values, 1}, false, &t, longer, &error),
              TL_E_ARGUMENT);
    CHECK(strlen(error.text) < sizeof error.text);
}

TEST_MAIN(RUN(defaults_fill_what_is_not_given), RUN(values_of_every_type_arrive),
          RUN(ranges_with_open_and_missing_ends), RUN(numbers_must_be_finite_and_whole), RUN(wrong_types_name_both),
          RUN(unknown_keys_get_the_nearest_name), RUN(missing_and_double_parameters),
          RUN(keep_writes_only_what_is_given), RUN(tables_of_other_versions_are_read), RUN(nearest_names),
          RUN(edit_distance_is_a_metric_on_short_words), RUN(number_texts_read_back_the_same), RUN(long_texts_are_cut))
