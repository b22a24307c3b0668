/* test_interrupt.c - a request to stop at every moment at which the kernel asks: what is done whole or not at all leaves no trace,
 * a run ends with a whole step. Nor need results be asked for. */
#include "check.h"
#include "model/model.h"

#include <dirent.h>
#include <sys/stat.h>
#include <talus/boundary.h>

static long asked, stop_at;

/* Answers true from the stop_at-th question on. */
static bool stop_now(void)
{
    return ++asked >= stop_at;
}

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

static const double zero[3] = {0, 0, 0}, size[3] = {6, 6, 6}, middle[3] = {3, 3, 3};

static tl_status joint_set(tl_model *m, const char *name, double dip, double direction)
{
    tl_value values[] = {
        text("joint", name), number("dip", dip),       number("spacing", 0.8), number("dip_direction", direction),
        number("number", 5), vector("origin", middle), number("dip_dev", 5),   number("persistence", 0.9)};
    tl_args args = {values, sizeof values / sizeof *values};
    return tl_generate(m, "jointset", &args, NULL);
}

static tl_status tunnel(tl_model *m)
{
    static const double face1[] = {2, 0, 2, 4, 0, 2, 4, 0, 4, 2, 0, 4};
    static const double face2[] = {2, 6, 2, 4, 6, 2, 4, 6, 4, 2, 6, 4};
    tl_value values[] = {
        {.key = "face1", .type = TL_VALUE_POINTS, .data = face1, .count = 4},
        {.key = "face2", .type = TL_VALUE_POINTS, .data = face2, .count = 4},
        text("group", "drift"),
    };
    tl_args args = {values, sizeof values / sizeof *values};
    return tl_generate(m, "tunnel", &args, NULL);
}

static tl_model *rock(void)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = 3, .threads = 1, .gravity = {0, 0, -10}};
    tl_error error;
    tl_model *m;
    tl_value values[] = {vector("min", zero), vector("max", size), number("density", 2000)};
    tl_args args = {values, 3};
    if (tl_model_create(&config, &m, &error) != TL_OK || tl_generate(m, "box", &args, NULL) != TL_OK)
        exit(1);
    tl_value law[] = {number("kn", 1e8), number("ks", 1e8), number("friction", 30)};
    args = (tl_args){law, 3};
    if (joint_set(m, "A", 20, 40) != TL_OK || tl_joint_law(m, "*", "coulomb", &args) != TL_OK)
        exit(1);
    return m;
}

static tl_status second_set(tl_model *m)
{
    return joint_set(m, "B", 70, 200);
}

static void every_moment_of(tl_status (*generate)(tl_model *))
{
    tl_model *m = rock();
    char before[33], after[33];
    tl_state_hash(m, before);
    size_t blocks = tl_block_count(m), joints = m->joint_count, groups = m->group_count;
    tl_status status = TL_E_CANCELLED;
    for (stop_at = 1; status == TL_E_CANCELLED; stop_at++) {
        asked = 0;
        tl_model_interrupt_if(m, stop_now);
        status = generate(m);
        tl_model_interrupt_if(m, NULL);
        tl_state_hash(m, after);
        if (status == TL_OK)
            break;
        CHECK_INT(status, TL_E_CANCELLED);
        CHECK(strcmp(before, after) == 0);
        CHECK(tl_block_count(m) == blocks && m->joint_count == joints && m->group_count == groups);
    }
    CHECK_INT(status, TL_OK);
    CHECK(stop_at > 5 && strcmp(before, after) != 0);
    /* the same as of a model that nobody stopped */
    tl_model *twin = rock();
    CHECK_INT(generate(twin), TL_OK);
    tl_state_hash(twin, before);
    CHECK(strcmp(before, after) == 0);
    tl_model_destroy(twin);
    tl_model_destroy(m);
}

static void a_cancelled_generator_leaves_no_trace(void)
{
    every_moment_of(second_set);
    every_moment_of(tunnel);
}

static void a_run_ends_with_a_whole_step(void)
{
    tl_model *m = rock(), *twin = rock();
    for (int64_t i = 1; i <= 5; i++) {
        tl_solve_result result;
        asked = 0;
        stop_at = i;
        tl_model_interrupt_if(m, stop_now);
        CHECK_INT(tl_model_cycle(m, 100, &result), TL_OK);
        CHECK_INT(result.reason, TL_SOLVE_INTERRUPT);
        CHECK_INT(result.cycles, i);
        CHECK_INT(tl_model_cycle(twin, i, &result), TL_OK);
        char a[33], b[33];
        tl_state_hash(m, a);
        tl_state_hash(twin, b);
        CHECK(strcmp(a, b) == 0);
    }
    tl_model_destroy(twin);
    tl_model_destroy(m);
}

static size_t files_in(const char *folder)
{
    size_t count = 0;
    DIR *list = opendir(folder);
    for (struct dirent *file; list && (file = readdir(list));)
        count += file->d_name[0] != '.';
    if (list)
        closedir(list);
    return count;
}

static tl_status write_frame(tl_model *m)
{
    return tl_write_vtk(m, TALUS_TEST_TMP "/interrupt_vtk/run", NULL);
}

static tl_status write_rock(tl_model *m)
{
    return tl_write_blocks(m, TALUS_TEST_TMP "/interrupt_blocks/rock.json");
}

/* Cancelled, no file appears; then all of them. */
static void every_moment_of_writing(tl_status (*write)(tl_model *), const char *folder, size_t files)
{
    tl_model *m = rock();
    CHECK_INT(write(m), TL_OK);
    char command[300];
    snprintf(command, sizeof command, "rm -f '%s'/*", folder);
    CHECK_INT(system(command), 0);
    tl_status status = TL_E_CANCELLED;
    for (stop_at = 1; status == TL_E_CANCELLED; stop_at++) {
        asked = 0;
        tl_model_interrupt_if(m, stop_now);
        status = write(m);
        tl_model_interrupt_if(m, NULL);
        CHECK_INT(files_in(folder), status == TL_OK ? files : 0);
    }
    CHECK_INT(status, TL_OK);
    CHECK(stop_at > 3);
    tl_model_destroy(m);
}

static void cancelled_files_do_not_appear(void)
{
    every_moment_of_writing(write_frame, TALUS_TEST_TMP "/interrupt_vtk", 6);
    every_moment_of_writing(write_rock, TALUS_TEST_TMP "/interrupt_blocks", 1);
}

/* Who does not ask for a result need not give room for it. */
TEST(no_result_is_wanted)
{
    tl_model *m = rock();
    const tl_solve two = {.size = sizeof two, .max_cycles = 2, .velocity = NAN, .max_time = NAN};
    tl_boundary_action side = tl_boundary_action_default();
    side.where.side = TL_SIDE_XMIN;
    side.fixed = true;
    tl_filter slivers = tl_filter_default();
    slivers.volume = 1e3;
    CHECK_INT(tl_model_cycle(m, 1, NULL), TL_OK);
    CHECK_INT(tl_model_solve(m, &two, NULL), TL_OK);
    CHECK_INT(tl_model_cycles(m), 3);
    CHECK_INT(tl_model_boundary(m, &side, 1, false, NULL), TL_OK);
    CHECK_INT(tl_model_filter(m, &slivers, NULL), TL_OK);
    tl_model_destroy(m);
}

int main(void)
{
    tl_plugins_load_default();
    RUN(a_cancelled_generator_leaves_no_trace);
    RUN(a_run_ends_with_a_whole_step);
    RUN(cancelled_files_do_not_appear);
    RUN(no_result_is_wanted);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
