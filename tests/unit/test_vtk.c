/* test_vtk.c - writing frames: names, failures that leave nothing behind, and the files that
 * tests/python/check_vtk.py reads back with VTK itself.
 *
 * The model: a box of 4 x 3 x 2 cut into 24 unit cubes by three joint sets, then once obliquely. */
#define _GNU_SOURCE /* usleep */
#include "check.h"

#include "zone/zones.h"
#include "zoned_column.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <unistd.h>

#define FOLDER TALUS_TEST_TMP "/vtk"

static tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static tl_value vector(const char *key, const double *data)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBERS, .data = data, .count = 3};
}

static tl_value string(const char *key, const char *text)
{
    return (tl_value){.key = key, .type = TL_VALUE_STRING, .text = text};
}

static int generate(tl_model *m, const char *kind, const tl_value *values, size_t count)
{
    tl_generate_summary summary;
    tl_args args = {values, count};
    int ok = CHECK_INT(tl_generate(m, kind, &args, &summary), TL_OK);
    if (!ok)
        printf("  %s\n", tl_model_error(m)->text);
    return ok;
}

static void add_box(tl_model *m, double x, double y, double z, const char *group)
{
    const double min[] = {0, 0, 0}, max[] = {x, y, z};
    const tl_value values[] = {vector("min", min), vector("max", max), number("density", 2500)};
    generate(m, "box", values, 3);
    const tl_id first = 1;
    const tl_vec3 unchanged = {NAN, NAN, NAN};
    const tl_block_set set = {sizeof(tl_block_set), NAN, group, unchanged, unchanged, NULL};
    CHECK_INT(tl_blocks_set(m, &first, 1, &set), TL_OK);
}

static void add_set(tl_model *m, const char *name, double dip, double direction, int planes, tl_vec3 origin)
{
    const double at[] = {origin.x, origin.y, origin.z};
    const tl_value values[] = {string("joint", name), number("dip", dip),       number("dip_direction", direction),
                               number("spacing", 1),  number("number", planes), vector("origin", at)};
    generate(m, "jointset", values, 6);
}

static tl_model *empty_model(void)
{
    tl_model_config config = {
        .size = sizeof(tl_model_config), .gravity = {0, 0, -10}, .seed = 1, .threads = 1, .reuse_geometry = 1};
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    return m;
}

/* The group's name is longer than 63 bytes: its length then takes two bytes in the file. */
#define LONG_GROUP "a group whose name is much longer than the sixty-three bytes of a short text"

static tl_model *cut_box(void)
{
    tl_model *m = empty_model();
    add_box(m, 4, 3, 2, LONG_GROUP);
    add_set(m, "east", 90, 90, 9, (tl_vec3){2, 0, 0});
    add_set(m, "north", 90, 0, 9, (tl_vec3){0, 1, 0});
    add_set(m, "up", 0, 0, 9, (tl_vec3){0, 0, 1});
    const double origin[] = {2.3, 1.6, 0.9};
    const tl_value values[] = {string("joint", "oblique"), number("dip", 50), number("dip_direction", 320),
                               vector("origin", origin)};
    generate(m, "joint", values, 4);
    const tl_value law[] = {number("kn", 1e8), number("ks", 1e8)};
    const tl_args args = {law, 2};
    CHECK_INT(tl_joint_law(m, "*", "elastic", &args), TL_OK);
    const tl_value bonded[] = {number("kn", 1e8), number("ks", 1e8), number("tension", 1e9), number("cohesion", 1e9)};
    const tl_args strong = {bonded, 4};
    CHECK_INT(tl_joint_law(m, "oblique", "coulomb_tensile", &strong), TL_OK);
    return m;
}

static int exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

/* Number of files of the folder whose names contain `part`, removing them when asked. */
static int files_with(const char *part, int delete)
{
    int count = 0;
    DIR *folder = opendir(FOLDER);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (strstr(entry->d_name, part)) {
            char path[4096];
            snprintf(path, sizeof path, "%s/%s", FOLDER, entry->d_name);
            count++;
            if (delete)
                remove(path);
        }
    if (folder)
        closedir(folder);
    return count;
}

/* What the reader of the files is to find. */
static void note_expected(tl_model *m)
{
    FILE *file = fopen(FOLDER "/expected.txt", "w");
    tl_contact_name *names = NULL;
    size_t contacts = 0;
    CHECK_INT(tl_contacts_select(m, NULL, &names, &contacts), TL_OK);
    free(names);
    if (CHECK(file != NULL)) {
        fprintf(file, "blocks %zu\ncontacts %zu\nvolume 24\ngroup %s\n", tl_block_count(m), contacts, LONG_GROUP);
        fclose(file);
    }
}

TEST(two_frames_for_the_reader)
{
    tl_model *m = cut_box();
    CHECK(tl_block_count(m) > 24);
    CHECK_INT(tl_write_vtk(m, FOLDER "/run", NULL), TL_OK);
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 20, &result), TL_OK);
    CHECK_INT(tl_write_vtk(m, FOLDER "/run", NULL), TL_OK);
    CHECK_TEXT(tl_model_error(m)->text, "");
    CHECK(exists(FOLDER "/run_blocks_000001.vtk"));
    CHECK(exists(FOLDER "/run_contacts_000001.vtk"));
    CHECK(exists(FOLDER "/run_joints_000001.vtk"));
    note_expected(m);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- zones ------------------ */

static tl_model *column(void)
{
    tl_model *m = empty_model();
    zoned_column(m, 0.7);
    return m;
}

/* What the reader is to find of the zones: how many, and sums over them, weighted by their volumes. */
static void note_zones(tl_model *m, const char *path)
{
    tl_zone_name *names = NULL;
    size_t count = 0, width, plastic = 0;
    double sum[6] = {0}, volume = 0;
    const tl_zone_filter all = tl_zone_filter_default();
    CHECK_INT(tl_zones_select(m, &all, &names, &count), TL_OK);
    for (size_t k = 0; k < count; k++) {
        double v, s[6], yields;
        tl_zones_values(m, names + k, 1, "volume", &v, &width);
        tl_zones_values(m, names + k, 1, "stress", s, &width);
        tl_zones_values(m, names + k, 1, "plastic", &yields, &width);
        plastic += yields != 0;
        volume += v;
        for (int c = 0; c < 6; c++)
            sum[c] += v * s[c];
    }
    free(names);
    char text[512];
    tl_text_print(text, sizeof text,
                  "zones %zu\npoints %zu\nplastic %zu\nvolume %.17g\nstress %.17g %.17g %.17g %.17g %.17g %.17g\n",
                  count, (size_t)(m->zones->mesh[0].point_end - m->zones->mesh[0].point_begin), plastic, volume, sum[0],
                  sum[1], sum[2], sum[3], sum[4], sum[5]);
    CHECK(volume > 5.9 && volume < 6.1 && sum[2] < -1e4);
    FILE *file = fopen(path, "w");
    if (CHECK(file != NULL)) {
        fputs(text, file);
        fclose(file);
    }
}

/* Zones have a file of their own, with numbers of a program's own; the deformed surface is that of the block. */
TEST(zones_for_the_reader)
{
    tl_model *m = column();
    tl_vtk_parts parts = tl_vtk_parts_default();
    tl_solve_result result;
    CHECK_INT(tl_write_vtk(m, FOLDER "/zoned", NULL), TL_OK);
    CHECK_INT(tl_model_cycle(m, 400, &result), TL_OK);
    const size_t count = m->zones->mesh[0].zone_end - m->zones->mesh[0].zone_begin;
    double *values = calloc(count, sizeof *values);
    for (size_t k = 0; k < count; k++)
        values[k] = 0.5 * (double)k;
    const tl_extra_field mine = {.name = "mine", .values = values, .count = count};
    parts.zone_fields = &mine;
    parts.zone_field_count = 1;
    CHECK_INT(tl_write_vtk(m, FOLDER "/zoned", &parts), TL_OK);
    CHECK_TEXT(tl_model_error(m)->text, "");
    note_zones(m, FOLDER "/zoned.txt");
    const tl_halfspace level = {0, 0, {0, 0, 1.4}}, upright = {90, 0, {0, 0.45, 0}};
    CHECK_INT(tl_write_section(m, FOLDER "/zoned_level", &level), TL_OK);
    CHECK_INT(tl_write_section(m, FOLDER "/zoned_upright", &upright), TL_OK);
    CHECK_TEXT(tl_model_error(m)->text, "");
    free(values);
    tl_model_destroy(m);
}

/* Bad fields are refused, and a frame can go without its zones. */
TEST(zones_can_be_left_out)
{
    tl_model *m = column();
    const double few[] = {1, 2};
    tl_extra_field field = {.name = "mine", .values = few, .count = 2};
    tl_vtk_parts parts = tl_vtk_parts_default();
    parts.zone_fields = &field;
    parts.zone_field_count = 1;
    CHECK_INT(tl_write_vtk(m, FOLDER "/few", &parts), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "zone_fields: 'mine' has 2 values, and there are");
    CHECK(!exists(FOLDER "/few_zones_000000.vtk") && !exists(FOLDER "/few_blocks_000000.vtk"));
    parts = tl_vtk_parts_default();
    parts.zones = 0;
    CHECK_INT(tl_write_vtk(m, FOLDER "/plain", &parts), TL_OK);
    CHECK(exists(FOLDER "/plain_blocks_000000.vtk") && !exists(FOLDER "/plain_zones_000000.vtk"));
    parts.zones = 1;
    parts.blocks = parts.contacts = parts.joints = 0;
    CHECK_INT(tl_write_vtk(m, FOLDER "/plain", &parts), TL_OK);
    CHECK(!exists(FOLDER "/plain_blocks_000001.vtk") && exists(FOLDER "/plain_zones_000001.vtk"));
    tl_model_destroy(m);
    tl_model *rigid = cut_box();
    CHECK_INT(tl_write_vtk(rigid, FOLDER "/plain", &parts), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(rigid)->text, "no block is deformable");
    tl_model_destroy(rigid);
}

/* ---------------------------------------------------------------- refused ---------------- */

/* Numbers of a program's own are as many as there are blocks or contacts, whatever files are written. */
TEST(added_fields_fit_the_model)
{
    tl_model *m = cut_box();
    const double few[] = {1, 2, 3};
    const tl_extra_field field = {.name = "mine", .values = few, .count = 3};
    tl_vtk_parts parts = tl_vtk_parts_default();
    parts.contact_fields = &field;
    parts.contact_field_count = 1;
    for (int k = 0; k < 2; k++) { /* joints alone, then contacts alone */
        parts.blocks = 0;
        parts.contacts = k;
        parts.joints = !k;
        CHECK_INT(tl_write_vtk(m, FOLDER "/few", &parts), TL_E_ARGUMENT);
        CHECK_CONTAINS(tl_model_error(m)->text, "contact_fields: 'mine' has 3 values, and there");
    }
    parts = tl_vtk_parts_default();
    parts.block_fields = &field;
    parts.block_field_count = 1;
    CHECK_INT(tl_write_vtk(m, FOLDER "/few", &parts), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "block_fields: 'mine' has 3 values, and there");
    CHECK(!exists(FOLDER "/few_blocks_000000.vtk") && !exists(FOLDER "/few_joints_000000.vtk"));
    tl_model_destroy(m);
}

/* Across blocks, along a joint's faces and outside the model. The series count for themselves. */
TEST(sections_for_the_reader)
{
    tl_model *m = cut_box();
    const tl_halfspace across = {90, 90, {1.5, 0, 0}}, along = {90, 90, {2, 0, 0}}, steep = {50, 320, {2, 1.5, 1}},
                       outside = {0, 0, {0, 0, 5}};
    CHECK_INT(tl_write_section(m, FOLDER "/cut", &across), TL_OK);
    CHECK_INT(tl_write_section(m, FOLDER "/along", &along), TL_OK);
    CHECK_INT(tl_write_section(m, FOLDER "/steep", &steep), TL_OK);
    CHECK_INT(tl_write_section(m, FOLDER "/outside", &outside), TL_OK);
    CHECK_INT(tl_write_vtk(m, FOLDER "/cut", NULL), TL_OK);
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 20, &result), TL_OK);
    CHECK_INT(tl_write_section(m, FOLDER "/cut", &across), TL_OK);
    CHECK(exists(FOLDER "/cut_section_000001.vtk") && !exists(FOLDER "/cut_section_000002.vtk"));
    const tl_halfspace wrong = {91, 0, {0, 0, 0}};
    CHECK_INT(tl_write_section(m, FOLDER "/wrong", &wrong), TL_E_ARGUMENT);
    CHECK(strstr(tl_model_error(m)->text, "dip = 91") != NULL);
    CHECK_INT(tl_write_section(m, FOLDER "/", &across), TL_E_ARGUMENT);
    CHECK_INT(files_with("wrong", 0), 0);
    tl_model_destroy(m);
}

TEST(an_empty_model_has_files_too)
{
    tl_model *m = empty_model();
    CHECK_INT(tl_write_vtk(m, FOLDER "/empty", NULL), TL_OK);
    const tl_halfspace level = {0, 0, {0, 0, 0}};
    CHECK_INT(tl_write_section(m, FOLDER "/empty", &level), TL_OK);
    CHECK_INT(files_with("empty_", 0), 8);
    tl_model_destroy(m);
}

TEST(prefixes_count_their_own_frames)
{
    tl_model *m = empty_model();
    CHECK_INT(tl_write_vtk(m, FOLDER "/new/folder/a", NULL), TL_OK);
    CHECK_INT(tl_write_vtk(m, FOLDER "/quote\"b", NULL), TL_OK);
    CHECK_INT(tl_write_vtk(m, FOLDER "/new/folder/a", NULL), TL_OK);
    CHECK(exists(FOLDER "/new/folder/a_blocks_000001.vtk"));
    CHECK(exists(FOLDER "/quote\"b_blocks_000000.vtk"));
    CHECK(!exists(FOLDER "/quote\"b_blocks_000001.vtk"));
    tl_model_destroy(m);
}

TEST(a_prefix_names_files)
{
    tl_model *m = empty_model();
    CHECK_INT(tl_write_vtk(m, "", NULL), TL_E_ARGUMENT);
    CHECK_INT(tl_write_vtk(m, FOLDER "/", NULL), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "prefix");
    tl_model_destroy(m);
}

TEST(a_file_is_no_folder)
{
    tl_model *m = empty_model();
    FILE *file = fopen(FOLDER "/plain", "w");
    if (CHECK(file != NULL))
        fclose(file);
    CHECK_INT(tl_write_vtk(m, FOLDER "/plain/run", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, FOLDER "/plain/run_blocks_000000.vtk");
    CHECK_CONTAINS(tl_model_error(m)->text, "Not a directory");
    tl_model_destroy(m);
}

/* One of the six places is taken: none of the others may appear, and the next try is frame 0. */
TEST(a_failed_frame_leaves_nothing)
{
    tl_model *m = empty_model();
    CHECK_INT(mkdir(FOLDER "/taken_joints.vtk.series", 0777), 0);
    CHECK_INT(tl_write_vtk(m, FOLDER "/taken", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "Is a directory");
    CHECK_INT(files_with("taken_", 0), 1);
    CHECK_INT(rmdir(FOLDER "/taken_joints.vtk.series"), 0);
    CHECK_INT(tl_write_vtk(m, FOLDER "/taken", NULL), TL_OK);
    CHECK(exists(FOLDER "/taken_blocks_000000.vtk"));
    CHECK_INT(files_with("taken_", 0), 6);
    tl_model_destroy(m);
}

/* A limit on the size of files stands for a full disk. */
TEST(a_full_disk_is_noticed)
{
    struct rlimit old, small;
    tl_model *m = cut_box();
    CHECK_INT(getrlimit(RLIMIT_FSIZE, &old), 0);
    small = old;
    small.rlim_cur = 2048;
    signal(SIGXFSZ, SIG_IGN);
    CHECK_INT(setrlimit(RLIMIT_FSIZE, &small), 0);
    tl_status status = tl_write_vtk(m, FOLDER "/full", NULL);
    CHECK_INT(setrlimit(RLIMIT_FSIZE, &old), 0);
    CHECK_INT(status, TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "full_blocks_000000.vtk");
    CHECK_INT(files_with("full_", 0), 0);
    CHECK_INT(files_with(".tmp", 0), 0);
    tl_model_destroy(m);
}

/* ---- the index of a long series ---- */

#define FRAMES 600

/* The text of a file without blanks; the caller's. */
static char *squeezed(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t capacity = 1 << 20, count = 0;
    char *text = malloc(capacity);
    for (int c; file && text && count + 1 < capacity && (c = fgetc(file)) != EOF;)
        if (c != ' ' && c != '\n')
            text[count++] = (char)c;
    if (text)
        text[count] = '\0';
    if (file)
        fclose(file);
    return text;
}

/* What the index of the blocks is to be, for so many frames at time 0: each listed a nanosecond after the one before. */
static char *index_of(const char *name, int frames)
{
    char *text = malloc(100 + 100 * (size_t)frames), *end = text;
    double time = 0;
    end += sprintf(end, "{\"file-series-version\":\"1.0\",\"files\":[");
    for (int i = 0; i < frames; i++, time += 1e-9)
        end +=
            tl_text_print(end, 100, "%s{\"name\":\"%s_blocks_%06d.vtk\",\"time\":%.17g}", i ? "," : "", name, i, time);
    sprintf(end, "]}");
    return text;
}

static int lists(const char *name, int frames)
{
    char path[256];
    snprintf(path, sizeof path, FOLDER "/%s_blocks.vtk.series", name);
    char *text = squeezed(path), *wanted = index_of(name, frames);
    int same = text && wanted && strcmp(text, wanted) == 0;
    free(text);
    free(wanted);
    return same;
}

static ino_t number_of(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? info.st_ino : 0;
}

/* Complete after every frame, and written anew a few times only: what a frame costs does not grow with their number. */
TEST(an_index_is_kept_in_its_place)
{
    tl_model *m = empty_model();
    const char *path = FOLDER "/many_blocks.vtk.series";
    int anew = 0, wrong = 0;
    ino_t before = 0;
    for (int i = 0; i < FRAMES; i++) {
        CHECK_INT(tl_write_vtk(m, FOLDER "/many", NULL), TL_OK);
        wrong += !lists("many", i + 1);
        anew += number_of(path) != before;
        before = number_of(path);
    }
    CHECK_INT(wrong, 0);
    CHECK(anew <= 30); /* the first 17, and each time when it has doubled */
    tl_model_destroy(m);
}

/* A list that is not the one that was written is no place for an entry. */
TEST(an_index_that_was_changed_is_written_anew)
{
    tl_model *one = empty_model(), *other = empty_model();
    const char *path = FOLDER "/two_blocks.vtk.series";
    for (int i = 0; i < 60; i++) {
        CHECK_INT(tl_write_vtk(one, FOLDER "/two", NULL), TL_OK);
        CHECK(lists("two", i + 1));
        if (i % 20 == 5)
            remove(path);
        if (i % 20 == 9)
            CHECK_INT(truncate(path, 100), 0);
        if (i % 20 == 15) {
            CHECK_INT(tl_write_vtk(other, FOLDER "/two", NULL), TL_OK);
            CHECK(lists("two", i / 20 + 1));
        }
    }
    tl_model_destroy(one);
    tl_model_destroy(other);
}

/* A child that writes frames is killed: what the index lists is there, and nothing else is left. */
TEST(a_killed_writer_leaves_a_whole_series)
{
    for (int round = 0; round < 20; round++) {
        files_with("killed_", 1);
        pid_t child = fork();
        if (child == 0) {
            tl_model *m = empty_model();
            for (;;)
                if (tl_write_vtk(m, FOLDER "/killed", NULL) != TL_OK)
                    _exit(1);
        }
        char last[256];
        snprintf(last, sizeof last, FOLDER "/killed_joints_%06d.vtk", 10 * round);
        int how = 0;
        while (!exists(last) && waitpid(child, &how, WNOHANG) == 0)
            usleep(200);
        kill(child, round % 2 ? SIGKILL : SIGTERM);
        CHECK_INT(waitpid(child, &how, 0), child);
        CHECK(WIFSIGNALED(how));
        int frames = files_with("killed_blocks_0", 0);
        CHECK(lists("killed", frames) || lists("killed", frames - 1));
        if (round % 2 == 0)
            CHECK_INT(files_with(".tmp", 0), 0);
        files_with(".tmp", 1);
    }
    files_with("killed_", 1);
}

static void clean_folder(void)
{
    mkdir(FOLDER, 0777);
    rmdir(FOLDER "/taken_joints.vtk.series");
    files_with("_", 1);
    files_with(".txt", 1);
    files_with("plain", 1);
}

TEST_MAIN(RUN(clean_folder), RUN(two_frames_for_the_reader), RUN(zones_for_the_reader), RUN(zones_can_be_left_out),
          RUN(added_fields_fit_the_model), RUN(sections_for_the_reader), RUN(an_empty_model_has_files_too),
          RUN(prefixes_count_their_own_frames), RUN(a_prefix_names_files), RUN(a_file_is_no_folder),
          RUN(a_failed_frame_leaves_nothing), RUN(a_full_disk_is_noticed), RUN(an_index_is_kept_in_its_place),
          RUN(an_index_that_was_changed_is_written_anew), RUN(a_killed_writer_leaves_a_whole_series))
