/* test_fields.c - fields and states of many contacts and points at once, with laws whose states clash in their names. */
#include "check.h"
#include "values.h"

#include "plugin/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

/* ---------------------------------------------------------------- two laws --------------- */

/* `area` 2 + closure, `worn` 3 a m2, `way` (1, 2, 3): columns 0, 1 and 2 to 4. */
static tl_status update_first(const void *self, const tl_law_batch *b, tl_report *report)
{
    (void)report;
    const double *kn = self;
    for (uint32_t i = 0; i < b->count; i++) {
        b->f_n[i] = b->closure[i] > 0 ? *kn * b->area[i] * b->closure[i] : 0;
        for (int k = 0; k < 3; k++)
            b->f_s[k][i] = 0;
        b->state[0][i] = 2 + b->closure[i];
        b->state[1][i] = 3 * b->area[i];
        for (int k = 0; k < 3; k++)
            b->state[2 + k][i] = k + 1;
    }
    return TL_OK;
}

static tl_status update_second(const void *self, const tl_law_batch *b, tl_report *report)
{
    (void)self, (void)report;
    for (uint32_t i = 0; i < b->count; i++) {
        b->f_n[i] = 0;
        for (int k = 0; k < 3; k++)
            b->f_s[k][i] = 0;
    }
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    *kn = *ks = *(const double *)self;
}

static const tl_param stiffness_param[] = {
    {.size = sizeof(tl_param), .type = TL_PARAM_REAL, .name = "kn", .def = {1e7}}};

#define STATE(name_, kind_, transfer_)                                                                                 \
    {                                                                                                                  \
        .size = sizeof(tl_state), .kind = (kind_), .transfer = (transfer_), .name = (name_), .unit = "", .doc = ""     \
    }

static const tl_state first_states[] = {STATE("area", TL_STATE_SCALAR, TL_TRANSFER_COPY),
                                        STATE("worn", TL_STATE_SCALAR, TL_TRANSFER_SPLIT),
                                        STATE("way", TL_STATE_TANGENT, TL_TRANSFER_COPY)};
static const tl_state second_states[] = {STATE("worn", TL_STATE_TANGENT, TL_TRANSFER_COPY),
                                         STATE("way", TL_STATE_TANGENT, TL_TRANSFER_COPY)};

static const tl_law_ops first_ops = {.size = sizeof first_ops, .update = update_first, .stiffness = stiffness};
static const tl_law_ops second_ops = {.size = sizeof second_ops, .update = update_second, .stiffness = stiffness};

#define LAW(name_, states_, count_, ops_)                                                                              \
    {                                                                                                                  \
        .size = sizeof(tl_kind), .type = TL_KIND_LAW, .name = (name_), .doc = "", .params_size = sizeof(double),       \
        .params = stiffness_param, .param_count = 1, .param_stride = sizeof(tl_param), .states = (states_),            \
        .state_count = (count_), .state_stride = sizeof(tl_state), .ops = (ops_)                                       \
    }

static const tl_kind laws[] = {LAW("first", first_states, 3, &first_ops), LAW("second", second_states, 2, &second_ops)};

static tl_plugin plugin = {.size = sizeof plugin,
                           .abi_major = TL_ABI_MAJOR,
                           .abi_minor = TL_ABI_MINOR,
                           .id = "test.fields",
                           .version = "1",
                           .doc = "",
                           .licence = "",
                           .kinds = laws,
                           .kind_count = 2,
                           .kind_stride = sizeof(tl_kind)};

/* ---------------------------------------------------------------- model ------------------ */

static void create_box(tl_model *m, double x, double y, double z, double width)
{
    const double min[] = {x, y, z}, max[] = {x + width, y + width, z + 1};
    const tl_value values[] = {vector("min", min), vector("max", max), number("density", 1000)};
    tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
}

static void cut(tl_model *m, const char *joint, double z)
{
    const double at[] = {0, 0, z};
    const tl_value values[] = {text("joint", joint), number("dip", 0), number("dip_direction", 0),
                               vector("origin", at)};
    tl_args args = {values, 4};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "joint", &args, &summary), TL_OK);
}

/* A column of three blocks: two contacts, the lower with the law "first", the upper with "second". */
static tl_model *column(void)
{
    tl_model_config config = tl_model_config_default();
    config.gravity = (tl_vec3){0, 0, -10};
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    static bool added;
    if (!added)
        CHECK_INT(tl_registry_add("test_fields", &plugin, NULL, &error), TL_OK);
    added = true;
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    create_box(m, 0, 0, 0, 2);
    cut(m, "low", 0.5);
    cut(m, "high", 0.75);
    const tl_args none = {NULL, 0};
    CHECK_INT(tl_joint_law(m, "low", "first", &none), TL_OK);
    CHECK_INT(tl_joint_law(m, "high", "second", &none), TL_OK);
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 3, &result), TL_OK);
    return m;
}

/* The contacts of a joint, as a list that the caller frees. */
static tl_contact_name *contacts_of(tl_model *m, const char *joint, size_t *count)
{
    tl_contact_name *names = NULL;
    tl_contact_filter filter = tl_contact_filter_default();
    filter.joint = joint;
    CHECK_INT(tl_contacts_select(m, &filter, &names, count), TL_OK);
    return names;
}

/* ---------------------------------------------------------------- tests ------------------ */

TEST(clashing_names_stay_apart)
{
    tl_model *m = column();
    tl_law_state *list = NULL;
    size_t count = 0, contacts;
    CHECK_INT(tl_states_list(m, NULL, &list, &count), TL_OK);
    static const char *const names[] = {"law_area", "worn", "way", "second_worn"};
    static const size_t widths[] = {1, 1, 3, 3};
    CHECK_INT(count, 4);
    for (size_t i = 0; i < count && i < 4; i++) {
        CHECK_TEXT(list[i].name, names[i]);
        CHECK_INT(list[i].width, widths[i]);
    }
    free(list);
    tl_contact_name *high = contacts_of(m, "high", &contacts);
    CHECK_INT(tl_states_list(m, high, &list, &count), TL_OK);
    CHECK_INT(count, 2);
    CHECK_TEXT(list[0].name, "way");
    CHECK_TEXT(list[1].name, "second_worn");
    free(list);
    CHECK_INT(tl_states_list(m, &(tl_contact_name){1, 999, 0}, &list, &count), TL_E_STALE);
    CHECK(list == NULL && count == 0);
    free(high);
    tl_model_destroy(m);
}

/* A state of the contact is the mean over the area, or the sum of what goes with the area. */
TEST(states_of_contacts)
{
    tl_model *m = column();
    size_t count, width;
    tl_contact_name *all = contacts_of(m, NULL, &count);
    CHECK_INT(count, 2);
    double value[6], area[2];
    CHECK_INT(tl_contacts_values(m, all, 2, "area", area, &width), TL_OK);
    CHECK_INT(width, 1);
    CHECK_NEAR(area[0], 4, 1e-12);
    CHECK_INT(tl_contacts_values(m, all, 2, "worn", value, &width), TL_OK);
    CHECK_NEAR(value[0], 12, 1e-12);
    CHECK(isnan(value[1]));
    CHECK_INT(tl_contacts_values(m, all, 2, "way", value, &width), TL_OK);
    CHECK_INT(width, 3);
    for (int k = 0; k < 3; k++) {
        CHECK_NEAR(value[k], k + 1, 1e-12);
        CHECK_NEAR(value[3 + k], 0, 0);
    }
    CHECK_INT(tl_contacts_values(m, all, 2, "law_area", value, &width), TL_OK);
    CHECK_NEAR(value[0], 2, 1e-3);
    CHECK_INT(tl_contacts_values(m, all, 2, "state", value, &width), TL_OK);
    CHECK_TEXT(tl_state_name((size_t)value[0]), "elastic");
    CHECK(tl_state_name(4) == NULL);
    CHECK_INT(tl_contacts_values(m, all, 2, "joint", value, &width), TL_E_ARGUMENT);
    CHECK_INT(tl_contacts_values(m, all, 2, "wornn", value, &width), TL_E_NOT_FOUND);
    CHECK_CONTAINS(tl_model_error(m)->text, "did you mean 'worn'?");
    free(all);
    tl_model_destroy(m);
}

/* What the points carry is what the contact carries. */
TEST(points_add_up)
{
    tl_model *m = column();
    size_t count, width, start[3];
    tl_contact_name *all = contacts_of(m, NULL, &count);
    CHECK_INT(tl_points_start(m, all, 2, start), TL_OK);
    CHECK(start[0] == 0 && start[1] >= 4 && start[2] > start[1]);
    double *value = malloc(3 * start[2] * sizeof *value), *area = malloc(start[2] * sizeof *area);
    CHECK_INT(tl_points_values(m, all, 2, "area", area, &width), TL_OK);
    double sum = 0;
    for (size_t i = 0; i < start[1]; i++)
        sum += area[i];
    CHECK_NEAR(sum, 4, 1e-12);
    double normal[2];
    CHECK_INT(tl_contacts_values(m, all, 2, "normal_force", normal, &width), TL_OK);
    CHECK_INT(tl_points_values(m, all, 2, "normal_force", value, &width), TL_OK);
    sum = 0;
    for (size_t i = 0; i < start[1]; i++)
        sum += value[i];
    CHECK(normal[0] >= 0);
    CHECK_NEAR(sum, normal[0], 1e-9);
    CHECK_INT(tl_points_values(m, all, 2, "worn", value, &width), TL_OK);
    for (size_t i = 0; i < start[1]; i++)
        CHECK_NEAR(value[i], 3 * area[i], 1e-12);
    CHECK(isnan(value[start[1]]));
    CHECK_INT(tl_points_values(m, all, 2, "position", value, &width), TL_OK);
    CHECK_INT(width, 3);
    double centre = 0;
    for (size_t i = 0; i < start[1]; i++) {
        CHECK_NEAR(value[3 * i + 2], 0.5, 1e-3);
        centre += area[i] * value[3 * i] / 4;
    }
    CHECK_NEAR(centre, 1, 1e-6);
    CHECK_INT(tl_points_values(m, all, 2, "aera", value, &width), TL_E_NOT_FOUND);
    CHECK_CONTAINS(tl_model_error(m)->text, "did you mean 'area'?");
    const tl_contact_name stale = {1, 999, 0};
    CHECK_INT(tl_points_values(m, &stale, 1, "area", value, &width), TL_E_STALE);
    free(value);
    free(area);
    free(all);
    tl_model_destroy(m);
}

TEST(blocks_in_the_order_asked_for)
{
    tl_model *m = column();
    tl_id *ids = NULL;
    size_t count, width;
    const tl_block_filter filter = tl_block_filter_default();
    CHECK_INT(tl_blocks_select(m, &filter, &ids, &count), TL_OK);
    CHECK_INT(count, 3);
    const tl_id turned[] = {ids[2], ids[0], ids[2]};
    double mass[3], centroid[9], inertia[18];
    CHECK_INT(tl_blocks_values(m, turned, 3, "mass", mass, &width), TL_OK);
    CHECK_INT(tl_blocks_values(m, turned, 3, "centroid", centroid, &width), TL_OK);
    CHECK_INT(width, 3);
    CHECK_NEAR(mass[0], mass[2], 0);
    CHECK_NEAR(mass[0] + 2 * mass[1], mass[2] + 2 * mass[1], 0);
    CHECK_NEAR(centroid[0], 1, 1e-12);
    CHECK_NEAR(centroid[2], centroid[8], 0);
    CHECK_INT(tl_blocks_values(m, turned, 3, "inertia", inertia, &width), TL_OK);
    CHECK_INT(width, 6);
    CHECK_INT(tl_blocks_values(m, NULL, 0, "rotation", NULL, &width), TL_OK);
    CHECK_INT(width, 4);
    CHECK_INT(tl_blocks_values(m, turned, 3, "group", mass, &width), TL_E_ARGUMENT);
    CHECK_INT(tl_blocks_values(m, turned, 3, "worn", mass, &width), TL_E_NOT_FOUND);
    const tl_id stale[] = {ids[0], 999};
    CHECK_INT(tl_blocks_values(m, stale, 2, "mass", mass, &width), TL_E_STALE);
    free(ids);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(clashing_names_stay_apart), RUN(states_of_contacts), RUN(points_add_up),
          RUN(blocks_in_the_order_asked_for))
