/* test_settings.c - a setting is declared once: one row more in the table of talus.model has its default, is read from a script, saved, restored,
 * refused where it is none of its choices, copied and hashed. Nothing else knows of it.
 *
 * This program has its own table: functions.c, with that row. */
#include "check.h"

#include <talus/state.h>

/* The member lies in what the struct has left at its end. */
#define DUMMY (offsetof(tl_model_config, contact_points) + sizeof(int32_t))
static const char *const dummies[] = {"one", "two", "three", NULL};
#define MORE_MODEL_PARAMS                                                                                              \
    {.size = sizeof(tl_param),                                                                                         \
     .type = TL_PARAM_ENUM,                                                                                            \
     .name = "dummy",                                                                                                  \
     .unit = "",                                                                                                       \
     .offset = DUMMY,                                                                                                  \
     .def = {1.0},                                                                                                     \
     .choices = dummies},

#include "model/functions.c"

#include "model/model.h"

_Static_assert(DUMMY + sizeof(int32_t) <= sizeof(tl_model_config), "there is room for the member");

#define FILE_NAME TALUS_TEST_TMP "/test_settings.talus"

static int32_t dummy_of(const tl_model_config *config)
{
    int32_t dummy;
    memcpy(&dummy, (const char *)config + DUMMY, sizeof dummy);
    return dummy;
}

static tl_model *model_with(int32_t dummy)
{
    tl_error error;
    tl_model *m;
    CHECK_INT(tl_model_create(NULL, &m, &error), TL_OK);
    memcpy((char *)&m->config + DUMMY, &dummy, sizeof dummy);
    return m;
}

TEST(has_its_default_and_is_read)
{
    tl_error error;
    tl_model_config config = tl_model_config_default();
    CHECK_INT(dummy_of(&config), 1);
    size_t count;
    const tl_param *params = tl_function_params("model", &count, NULL);
    tl_value value = {.key = "dummy", .type = TL_VALUE_STRING, .text = "three"};
    const tl_args args = {&value, 1};
    CHECK_INT(tl_args_read(params, count, 0, &args, false, &config, "model", &error), TL_OK);
    CHECK_INT(dummy_of(&config), 2);
    value.text = "four";
    CHECK_INT(tl_args_read(params, count, 0, &args, false, &config, "model", &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "unknown dummy 'four'");
}

TEST(is_saved_restored_and_copied)
{
    tl_error error;
    tl_model *m = model_with(2), *restored, *copy;
    CHECK_INT(tl_model_save(m, FILE_NAME), TL_OK);
    CHECK_INT(tl_model_restore(FILE_NAME, 1, NULL, NULL, &restored, &error), TL_OK);
    CHECK_INT(dummy_of(&restored->config), 2);
    CHECK_INT(tl_model_copy(m, NULL, NULL, &copy), TL_OK);
    CHECK_INT(dummy_of(&copy->config), 2);
    tl_model_destroy(copy);
    tl_model_destroy(restored);
    tl_model_destroy(m);
}

TEST(is_refused_where_it_cannot_be)
{
    tl_error error;
    tl_model *m = model_with(3), *restored;
    CHECK_INT(tl_model_save(m, FILE_NAME), TL_OK);
    CHECK_INT(tl_model_restore(FILE_NAME, 1, NULL, NULL, &restored, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "a setting has an impossible value");
    tl_model_destroy(m);
}

TEST(is_hashed)
{
    tl_model *m = model_with(1), *other = model_with(2);
    char text[33], other_text[33];
    CHECK_INT(tl_state_hash(m, text), TL_OK);
    CHECK_INT(tl_state_hash(other, other_text), TL_OK);
    CHECK(strcmp(text, other_text) != 0);
    tl_model_destroy(other);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(has_its_default_and_is_read), RUN(is_saved_restored_and_copied), RUN(is_refused_where_it_cannot_be),
          RUN(is_hashed))
