/* test_layout.c - a law of its own for a plane: its contacts move to a span behind the others, to the same results as when
 * all are laid out anew, which follows when there is no room or when empty lanes have cost as much. */
#include "contact/contacts.h"
#include "contact_scene.h"

#include <talus/state.h>

#define SETS 3
#define PLANES 5

static tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static tl_value vector(const char *key, const double *data)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBERS, .data = data, .count = 3};
}

static tl_value text(const char *key, const char *value)
{
    return (tl_value){.key = key, .type = TL_VALUE_STRING, .text = value};
}

static void cut(tl_model *m, const char *name, double dip, double direction)
{
    static const double middle[3] = {3, 3, 3};
    const tl_value values[] = {text("joint", name),      number("dip", dip),
                               number("spacing", 1),     number("dip_direction", direction),
                               number("number", PLANES), vector("origin", middle)};
    scene_ok(m, tl_generate(m, "jointset", &(tl_args){values, sizeof values / sizeof *values}, NULL));
}

static void set_law(tl_model *m, const char *joint, double kn)
{
    const tl_value values[] = {number("kn", kn), number("ks", 5e8), number("friction", 30)};
    scene_ok(m, tl_joint_law(m, joint, "coulomb", &(tl_args){values, 3}));
}

/* A cube of 216 blocks, which begins to fall apart in steps. */
static tl_model *rock(int64_t threads)
{
    static const double zero[3] = {0, 0, 0}, size[3] = {6, 6, 6};
    const tl_value box[] = {vector("min", zero), vector("max", size), number("density", 2600)};
    const tl_model_config config = {
        .size = sizeof(tl_model_config), .seed = 1, .threads = threads, .gravity = {1, 2, -9}, .reuse_geometry = 1};
    tl_error error;
    tl_model *m;
    tl_plugins_load_default();
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_model_log(m, scene_hush, NULL);
    scene_ok(m, tl_generate(m, "box", &(tl_args){box, 3}, NULL));
    cut(m, "A", 2, 40);
    cut(m, "B", 88, 85);
    cut(m, "C", 86, 175);
    set_law(m, "*", 1e9);
    scene_ok(m, tl_model_cycle(m, 10, NULL));
    return m;
}

static size_t added_rows(const tl_model *m)
{
    const tl_layout *layout = &m->detect->layout;
    return layout->spans[layout->span_count - 1].limit - layout->laid_rows;
}

/* Points in spans of a law: all of a plane's are in one. */
static size_t spans_of_law(const tl_model *m, uint32_t law)
{
    size_t count = 0;
    for (size_t k = 0; k < m->detect->layout.span_count; k++)
        count += m->detect->layout.spans[k].law == law;
    return count;
}

static void same_hash(tl_model *m, tl_model *twin)
{
    char one[33], other[33];
    scene_ok(m, tl_state_hash(m, one));
    scene_ok(twin, tl_state_hash(twin, other));
    CHECK_TEXT(one, other);
}

TEST(a_law_for_a_plane_moves_its_contacts_alone)
{
    for (int64_t threads = 1; threads <= 2; threads++)
        for (int stiffer = 0; stiffer < 2; stiffer++) {
            tl_model *m = rock(threads), *twin;
            const int64_t laid_at = m->detect->laid_at;
            scene_ok(m, tl_model_copy(m, NULL, NULL, &twin));
            CHECK_INT(added_rows(m), 0);
            for (int plane = 1; plane <= 2; plane++) {
                const char *joint = plane == 1 ? "A:2" : "C:3";
                set_law(m, joint, stiffer ? 3e9 : 1e9);
                set_law(twin, joint, stiffer ? 3e9 : 1e9);
                scene_ok(m, tl_model_cycle(m, 1, NULL));
                scene_ok(twin, tl_model_cycle(twin, 1, NULL));
                CHECK_INT(tl_contacts_repack(twin), TL_OK);
                CHECK(added_rows(m) > 0);
                CHECK_INT(added_rows(twin), 0);
                CHECK(spans_of_law(m, (uint32_t)plane) > 0);
                scene_ok(m, tl_model_cycle(m, 5, NULL));
                scene_ok(twin, tl_model_cycle(twin, 5, NULL));
                same_hash(m, twin);
            }
            CHECK_INT(m->detect->laid_at, laid_at);
            tl_model_destroy(twin);
            tl_model_destroy(m);
        }
}

TEST(a_copy_goes_on_with_the_spans_that_were_added)
{
    tl_model *m = rock(1), *twin;
    set_law(m, "B:1", 2e9);
    scene_ok(m, tl_model_cycle(m, 1, NULL));
    scene_ok(m, tl_model_copy(m, NULL, NULL, &twin));
    CHECK_INT(added_rows(twin), added_rows(m));
    for (int k = 0; k < 2; k++) {
        set_law(m, k ? "B:3" : "B:2", 3e9);
        set_law(twin, k ? "B:3" : "B:2", 3e9);
        scene_ok(m, tl_model_cycle(m, 10, NULL));
        scene_ok(twin, tl_model_cycle(twin, 10, NULL));
        CHECK_INT(twin->detect->laid_at, m->detect->laid_at);
        same_hash(m, twin);
    }
    tl_model_destroy(twin);
    tl_model_destroy(m);
}

TEST(all_are_laid_out_anew_where_there_is_no_room)
{
    tl_model *m = rock(1);
    size_t laid = 0;
    for (int k = 0; k < SETS * PLANES; k++) {
        const int64_t laid_at = m->detect->laid_at;
        const char joint[] = {(char)('A' + k % SETS), ':', (char)('1' + k / SETS), '\0'};
        set_law(m, joint, 2e9);
        scene_ok(m, tl_model_cycle(m, 1, NULL));
        CHECK(added_rows(m) <= m->detect->layout.laid_rows / 2);
        laid += m->detect->laid_at != laid_at;
    }
    CHECK(laid > 0 && laid < SETS * PLANES / 2);
    tl_model_destroy(m);
}

TEST(all_are_laid_out_anew_when_empty_lanes_have_cost_as_much)
{
    tl_model *m = rock(1), *quiet;
    m->config.gravity = tl_v3(0, 0, 0); /* else contacts end and are born */
    const int64_t laid_at = m->detect->laid_at;
    scene_ok(m, tl_model_copy(m, NULL, NULL, &quiet));
    scene_ok(quiet, tl_model_cycle(quiet, 200, NULL));
    CHECK_INT(quiet->detect->laid_at, laid_at);
    set_law(m, "A:2", 1e9);
    scene_ok(m, tl_model_cycle(m, 10, NULL));
    CHECK_INT(m->detect->laid_at, laid_at);
    CHECK(added_rows(m) > 0);
    scene_ok(m, tl_model_cycle(m, 190, NULL));
    CHECK(m->detect->laid_at > laid_at + 10);
    CHECK_INT(added_rows(m), 0);
    tl_model_destroy(quiet);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(a_law_for_a_plane_moves_its_contacts_alone), RUN(a_copy_goes_on_with_the_spans_that_were_added),
          RUN(all_are_laid_out_anew_where_there_is_no_room),
          RUN(all_are_laid_out_anew_when_empty_lanes_have_cost_as_much))
