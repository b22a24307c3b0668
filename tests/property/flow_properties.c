/* flow_properties.c - water that is stored in random networks of joints: none comes or goes but through heads and drains,
 * while heads rise and fall and joints open and close. */
#include "contact_scene.h"

#include <talus/elements.h>
#include <talus/plugins.h>
#include <talus/state.h>

#define NETWORKS 30
#define STEPS 120
#define STRETCH 20 /* steps between two changes */
#define DT 1e-2
#define SIZE 4.0
#define WEIGHT 9810.0

/* What joints were, how much went through the ends, and the balance. */
typedef struct ledger {
    double water, in, through, time;
    int full, partly, empty, moved;
} ledger;

static double value_of(tl_model *m, tl_id id, const char *name)
{
    double value = NAN;
    CHECK_INT(tl_element_value(m, id, SIZE_MAX, name, &value), TL_OK);
    return value;
}

/* Height of the centroid of a joint. */
static double height_of(tl_model *m, tl_id id)
{
    tl_element_info info;
    double sum = 0, weight = 0;
    CHECK_INT(tl_element_get(m, id, &info), TL_OK);
    for (size_t k = 0; k < info.nodes; k++) {
        tl_element_node_info node;
        CHECK_INT(tl_element_node_get(m, id, k, &node), TL_OK);
        sum += node.weight * node.position.z;
        weight += node.weight;
    }
    return sum / weight;
}

/* Counts the water, and what has come through the ends since the last solution. */
static void read_water(tl_model *m, ledger *l)
{
    const tl_element_filter all = {.size = sizeof all};
    tl_id *ids;
    size_t count;
    CHECK_INT(tl_elements_select(m, &all, &ids, &count), TL_OK);
    const double time = value_of(m, ids[0], "time"), passed = time - l->time;
    const double rounding = 1e-12 * l->water;
    l->water = 0;
    for (size_t i = 0; i < count; i++) {
        if (value_of(m, ids[i], "role") != 0) {
            const double flow = value_of(m, ids[i], "flow") * passed;
            l->in += flow;
            l->through += fabs(flow);
            continue;
        }
        const double water = value_of(m, ids[i], "water"), space = value_of(m, ids[i], "void");
        CHECK(water >= -1e-9 * space - rounding);
        if (water < space * (1 - 1e-9) - rounding) /* a joint that is not full bears nothing */
            CHECK(value_of(m, ids[i], "head") <= height_of(m, ids[i]) + 1e-6);
        l->full += water > space;
        l->partly += water < 0.999 * space && water > 0.001 * space;
        l->empty += water < 1e-9 * space;
        l->water += water;
    }
    free(ids);
    l->time = time;
}

static void load_plugins(void)
{
    const char *const names[] = {"box", "joint", "water"};
    static int loaded;
    tl_error error;
    for (size_t i = 0; i < sizeof names / sizeof *names && !loaded; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s.so", TALUS_TEST_PLUGIN_DIR, names[i]);
        CHECK_INT(tl_plugin_load(path, &error), TL_OK);
    }
    loaded = 1;
}

static void cut(tl_model *m, uint64_t *seed)
{
    tl_generate_summary summary;
    scene_ok(m, tl_generate(m, "joint",
                            TL_ARGS(tl_arg_text("joint", "J"), tl_arg_number("dip", scene_between(seed, 0, 90)),
                                    tl_arg_number("dip_direction", scene_between(seed, 0, 360)),
                                    TL_ARG_VECTOR("origin", scene_between(seed, -1, 1), scene_between(seed, -1, 1),
                                                  scene_between(seed, -1, 1))),
                            &summary));
}

/* Rock with a few joints and stored water. A head on one side, a lower one on the other, and in some a drain. */
static tl_model *network(uint64_t *seed, double stiff)
{
    load_plugins();
    tl_model *m = scene_model(1);
    tl_generate_summary summary;
    const double h = SIZE / 2, far = 2 * SIZE;
    scene_ok(m, tl_generate(m, "box",
                            TL_ARGS(TL_ARG_VECTOR("min", -h, -h, -h), TL_ARG_VECTOR("max", h, h, h),
                                    tl_arg_number("density", 2500)),
                            &summary));
    const int planes = 3 + (int)(3 * check_random(seed));
    for (int i = 0; i < planes; i++)
        cut(m, seed);
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    const tl_timestep step = {.size = sizeof step, .fraction = NAN, .dt = DT};
    scene_ok(m, tl_model_timestep(m, &step));
    const double head = scene_between(seed, -1, 4), low = scene_between(seed, -3, 0), r = 0.05;
    const double heads[] = {-h - r, -far, -far, -h + r, far, far, head, 0, 0,
                            h - r,  -far, -far, h + r,  far, far, low,  0, 0};
    const double drain[] = {0, 0, -h, 0, 0, h, 1e-3, 0, 0};
    const bool drained = check_random(seed) < 0.5;
    tl_value given[] = {tl_arg_number("aperture", 1e-4 * (1 + 5 * check_random(seed))),
                        tl_arg_bool("steady", false),
                        tl_arg_number("bulk", stiff),
                        tl_arg_number("initial_head", scene_between(seed, -2, 2)),
                        {"heads", TL_VALUE_POINTS, 0, NULL, heads, 6},
                        {"drains", TL_VALUE_POINTS, 0, NULL, drain, 3}};
    scene_ok(m, tl_model_element(m, "flow", &(tl_args){given, drained ? 6 : 5}, 1, "", NULL, NULL));
    return m;
}

/* Gives each block another velocity. */
static void shake(tl_model *m, uint64_t *seed, double speed)
{
    const tl_block_filter all = {.size = sizeof all};
    tl_id *ids;
    size_t count;
    scene_ok(m, tl_blocks_select(m, &all, &ids, &count));
    for (size_t i = 0; i < count; i++) {
        const tl_drive drive = {.size = sizeof drive,
                                .velocity = tl_v3_scale(speed * check_random(seed), scene_direction(seed))};
        scene_ok(m, tl_blocks_drive(m, &ids[i], 1, &drive));
    }
    free(ids);
}

/* Lets heads rise and fall. */
static void change_heads(tl_model *m, uint64_t *seed)
{
    const tl_element_filter all = {.size = sizeof all};
    tl_id *ids;
    size_t count;
    scene_ok(m, tl_elements_select(m, &all, &ids, &count));
    for (size_t i = 0; i < count; i++)
        if (value_of(m, ids[i], "role") == 1)
            scene_ok(m, tl_element_put(m, ids[i], SIZE_MAX, "head", scene_between(seed, -3, 6)));
    free(ids);
}

static void check_balance(tl_model *m, ledger *l, double began)
{
    read_water(m, l);
    CHECK_NEAR(l->water - began, l->in, 1e-9 * l->through + 1e-14 * STEPS * l->water);
}

static void run(uint64_t *seed, double stiff, double speed, bool heads, ledger *l)
{
    tl_model *m = network(seed, stiff);
    tl_solve_result result;
    read_water(m, l);
    const double began = l->water;
    l->in = l->through = 0;
    for (int k = 0; k < STEPS; k++) {
        if (k % STRETCH == 0)
            shake(m, seed, speed);
        if (k % STRETCH == 0 && heads)
            change_heads(m, seed);
        scene_ok(m, tl_model_cycle(m, 1, &result));
        check_balance(m, l, began);
    }
    tl_model_destroy(m);
}

TEST(no_water_comes_or_goes_while_heads_and_joints_move)
{
    uint64_t seed = 7;
    ledger l = {.full = 0};
    for (int i = 0; i < NETWORKS; i++) {
        l.time = 0;
        run(&seed, pow(10, scene_between(&seed, 6, 9.5)), pow(10, scene_between(&seed, -6, -4.7)), true, &l);
    }
    printf("%d full, %d partly, %d empty\n", l.full, l.partly, l.empty);
    CHECK(l.full > 1000 && l.partly > 1000 && l.empty > 100);
}

/* How much of their void joints have filled together. */
static double share_of(tl_model *m)
{
    const tl_element_filter all = {.size = sizeof all};
    tl_id *ids;
    size_t count;
    double water = 0, space = 0;
    scene_ok(m, tl_elements_select(m, &all, &ids, &count));
    for (size_t i = 0; i < count; i++) {
        water += value_of(m, ids[i], "water");
        space += value_of(m, ids[i], "void");
    }
    free(ids);
    return water / space;
}

/* Parts of joints that are cut are as full as these were, and the balance goes on with their water. */
TEST(parts_of_joints_are_as_full_as_those)
{
    uint64_t seed = 11;
    for (int i = 0; i < NETWORKS; i++) {
        tl_model *m = network(&seed, pow(10, scene_between(&seed, 6, 9.5)));
        tl_solve_result result;
        ledger l = {.full = 0};
        shake(m, &seed, 0);
        change_heads(m, &seed);
        scene_ok(m, tl_model_cycle(m, STRETCH, &result));
        const double share = share_of(m);
        cut(m, &seed);
        scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-9}));
        scene_ok(m, tl_model_cycle(m, 2, &result));
        CHECK_NEAR(share_of(m), share, 0.03); /* some flows in the step before */
        read_water(m, &l);
        l.in = l.through = 0;
        const double water = l.water;
        for (int k = 0; k < STRETCH; k++) {
            scene_ok(m, tl_model_cycle(m, 1, &result));
            check_balance(m, &l, water);
        }
        tl_model_destroy(m);
    }
}

/* A copy, and what a file keeps, go on with the water that joints have. */
TEST(copies_and_files_keep_the_water)
{
    uint64_t seed = 13;
    const char *path = TALUS_TEST_TMP "/flow_properties.talus";
    tl_model *m = network(&seed, 1e9), *other[2];
    tl_solve_result result;
    tl_error error;
    char hash[3][33];
    shake(m, &seed, 2e-5);
    change_heads(m, &seed);
    scene_ok(m, tl_model_cycle(m, STEPS, &result));
    scene_ok(m, tl_model_copy(m, NULL, NULL, &other[0]));
    scene_ok(m, tl_model_save(m, path));
    CHECK_INT(tl_model_restore(path, 1, NULL, NULL, &other[1], &error), TL_OK);
    scene_ok(m, tl_model_cycle(m, STEPS, &result));
    scene_ok(m, tl_state_hash(m, hash[0]));
    for (int k = 0; k < 2; k++) {
        scene_ok(other[k], tl_model_cycle(other[k], STEPS, &result));
        scene_ok(other[k], tl_state_hash(other[k], hash[k + 1]));
        CHECK_TEXT(hash[k + 1], hash[0]);
        tl_model_destroy(other[k]);
    }
    tl_model_destroy(m);
}

TEST_MAIN(RUN(no_water_comes_or_goes_while_heads_and_joints_move), RUN(parts_of_joints_are_as_full_as_those),
          RUN(copies_and_files_keep_the_water))
