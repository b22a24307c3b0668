/* test_loader.c - what the loader takes and what it refuses, each refusal with its path and reason. */
#include "base/error.h"
#include "check.h"

#include <dirent.h>
#include <sys/stat.h>
#include <talus/talus.h>

static const char bad_folder[] = TALUS_BAD_PLUGIN_DIR;
static const char good_folder[] = TALUS_TEST_PLUGIN_DIR;

/* The record of a path, the last one when it was tried several times. */
static tl_plugin_record record_of(const char *path)
{
    tl_plugin_record found = {NULL, NULL, NULL, NULL};
    for (size_t i = 0; i < tl_plugin_record_count(); i++) {
        tl_plugin_record r = tl_plugin_record_at(i);
        if (strcmp(r.path, path) == 0)
            found = r;
    }
    return found;
}

/* Loading `name` fails; sentence and record contain `reason`, the sentence the path too. */
static void refused(const char *folder, const char *name, const char *reason)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.so", folder, name);
    size_t before = tl_plugin_record_count();
    tl_error error = {TL_OK, ""};
    CHECK_INT(tl_plugin_load(path, &error), TL_E_PLUGIN);
    CHECK_INT(error.status, TL_E_PLUGIN);
    CHECK_CONTAINS(error.text, path);
    CHECK_CONTAINS(error.text, reason);
    CHECK_INT(tl_plugin_record_count(), before + 1);
    tl_plugin_record r = record_of(path);
    CHECK(r.plugin == NULL);
    CHECK_CONTAINS(r.reason, reason);
}

/* The shared objects that lie in the plugins' folder. */
static size_t files_in_folder(void)
{
    size_t count = 0;
    DIR *folder = opendir(good_folder);
    for (struct dirent *entry; folder && (entry = readdir(folder)) != NULL;) {
        const char *ending = strrchr(entry->d_name, '.');
        count += ending && strcmp(ending, ".so") == 0;
    }
    if (folder)
        closedir(folder);
    return count;
}

static size_t kinds_of(tl_kind_type type)
{
    size_t count = 0;
    while (tl_plugin_kind(type, count))
        count++;
    return count;
}

/* Kinds found by the search, to be compared with those at the end. */
static size_t found[TL_KIND_ELEMENT + 1];

TEST(default_search_finds_every_plugin_once_in_order)
{
    static const char *const known[] = {"coulomb", "adaptive",     "box",
                                        NULL,      "mohr_coulomb", "spring"}; /* a screen need not be there */
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++) {
        found[type] = kinds_of((tl_kind_type)type);
        CHECK(found[type] >= 3 || type == TL_KIND_SCREEN);
        CHECK(type == TL_KIND_SCREEN || tl_plugin_find((tl_kind_type)type, known[type]) != NULL);
    }
    CHECK(tl_plugin_find(TL_KIND_LAW, "box") == NULL);
    size_t files = files_in_folder();
    CHECK_INT(tl_plugin_record_count(), files);
    size_t kinds = 0, next[TL_KIND_ELEMENT + 1] = {0};
    for (size_t i = 0; i < tl_plugin_record_count(); i++) {
        tl_plugin_record r = tl_plugin_record_at(i);
        CHECK(r.plugin && !r.reason && !r.note);
        CHECK(i == 0 || strcmp(tl_plugin_record_at(i - 1).path, r.path) < 0);
        for (uint32_t k = 0; r.plugin && k < r.plugin->kind_count; k++) {
            const uint32_t type = r.plugin->kinds[k].type;
            CHECK(tl_plugin_kind((tl_kind_type)type, next[type]++) == &r.plugin->kinds[k]);
        }
        kinds += r.plugin ? r.plugin->kind_count : 0;
        CHECK(strncmp(r.path, good_folder, strlen(good_folder)) == 0);
    }
    CHECK_INT(found[0] + found[1] + found[2] + found[3] + found[4] + found[5], kinds);
    tl_plugins_load_default();
    CHECK_INT(tl_plugin_record_count(), files);
    CHECK(tl_plugin_record_at(files).path == NULL);
}

TEST(a_search_for_nothing_is_no_error)
{
    CHECK(tl_plugin_find(TL_KIND_DAMPING, "") == NULL);
    tl_error error = {TL_OK, ""};
    CHECK_INT(tl_plugin_load("no/such/file.so", &error), TL_E_PLUGIN);
    CHECK_CONTAINS(error.text, "plugin no/such/file.so: it cannot be opened (");
}

TEST(broken_plugins_are_refused_with_the_reason)
{
    refused(bad_folder, "wrong_major", "it was built for plugin ABI 2.16, this Talus has 1.16");
    refused(bad_folder, "later_major", "it was built for plugin ABI 3.16, this Talus has 1.16: build it anew");
    refused(bad_folder, "later_minor",
            "it was built for plugin ABI 1.77 and cannot do without it, this Talus has 1.16");
    refused(bad_folder, "newer_minor", "law 'newer_minor': ops has size");
    refused(bad_folder, "no_entry", "it does not export tl_plugin_entry");
    refused(bad_folder, "refuses", "it refuses this Talus (plugin ABI 1.16)");
    refused(bad_folder, "duplicate_id", "plugin 'talus.coulomb' is already loaded from ");
    refused(bad_folder, "name_clash", "law 'coulomb' is already provided by plugin 'talus.coulomb' from ");
    refused(bad_folder, "bad_default",
            "law 'bad_default': parameter 'value': its default 2 is outside its own range [0, 2)");
    refused(bad_folder, "missing_ops", "law 'missing_ops': its operation 'stiffness' is missing");
    refused(bad_folder, "bad_name", "kind 1 has the bad name 'Bad Name'");
    refused(bad_folder, "bad_codes", "its id is 'bad.\\x1b[2J\\ncodes'");
    refused(bad_folder, "outside", "law 'outside': parameter 'value' lies at bytes 0 to 8");
    refused(bad_folder, "no_unit", "law 'no_unit': parameter 'value' has no unit");
    refused(bad_folder, "twice", "law 'twice': parameters 'value' and 'value' share a name");
    refused(bad_folder, "many_states",
            "law 'many_states': its states take 9 columns (a scalar 1, a tangent 3); 8 at the most");
    refused(bad_folder, "endless_params",
            "law 'endless_params' has a params_size of 18446744073709551615 bytes; 1048576 at the "
            "most");
    refused(bad_folder, "large_params",
            "law 'large_params' has a params_size of 100000000000 bytes; 1048576 at the most");
    refused(bad_folder, "only_unknown", "it holds nothing of use: kind 1, 'only_unknown', is of the unknown type 23");
    refused(bad_folder, "deaf_screen", "screen 'deaf_screen': its operation 'take' is missing");
    refused(bad_folder, "begun_energy", "state 'some' is an energy: it must be a scalar that begins at 0");
    refused(bad_folder, "solid_space", "parameter 'table' is a list of points in space: a solid takes tables");
    refused(bad_folder, "solid_tangent", "state 'slip' of a solid must be a scalar, an axis or a tensor");
    refused(bad_folder, "solid_axis", "state 'axis' is an axis: it must begin at 0");
    refused(bad_folder, "solid_split", "state 'heat' of a solid must have TL_TRANSFER_COPY");
    refused(bad_folder, "solid_states",
            "its states take 18 columns (a scalar 1, an axis 3, a tensor 6); 16 at the most");
    refused(bad_folder, "solid_moduli", "solid 'solid_moduli': its operation 'moduli' is missing");
    refused(bad_folder, "two_energies", "states 'one' and 'two' are both energies of shear");
    refused(bad_folder, "screen_states", "a screen has no states, this one declares 1");
    refused(
        bad_folder, "keeps_text",
        "law 'keeps_text': parameter 'name' is a string, which lives only as long as the call: a law cannot keep it");
    refused(bad_folder, "keeps_points",
            "damping 'keeps_points': parameter 'curve' is a list of points, which lives only as long as the call: a "
            "damping cannot keep it");
    refused(bad_folder, "text_screen",
            "screen 'text_screen': parameter 'name' is a string, which lives only as long as the call: a screen cannot "
            "keep it");
    refused(bad_folder, "snapped", "its descriptor has size 0: not a Talus plugin");
}

TEST(a_kind_of_unknown_type_is_left_out_and_the_others_are_used)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/crasher.so", bad_folder);
    tl_error error = {TL_OK, ""};
    if (!CHECK_INT(tl_plugin_load(path, &error), TL_OK))
        printf("%s\n", error.text);
    for (int type = TL_KIND_LAW; type <= TL_KIND_GENERATOR; type++)
        CHECK(tl_plugin_find((tl_kind_type)type, "crasher") != NULL);
    tl_plugin_record r = record_of(path);
    CHECK(r.plugin && !r.reason && r.plugin->kind_count == 3);
    CHECK_CONTAINS(r.note, "kind 2, 'crasher', is of the unknown type 17 and is left out");
}

TEST(a_screen_is_taken)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/blank_screen.so", bad_folder);
    tl_error error = {TL_OK, ""};
    CHECK_INT(tl_plugin_load(path, &error), TL_OK);
    const tl_kind *kind = tl_plugin_find(TL_KIND_SCREEN, "blank_screen");
    const tl_screen_ops *ops = kind ? kind->ops : NULL;
    CHECK(ops && ops->size == sizeof *ops && ops->open && ops->take && ops->close);
    CHECK(tl_plugin_find(TL_KIND_GENERATOR, "blank_screen") == NULL);
    tl_plugin_record r = record_of(path);
    CHECK(r.plugin && !r.note);
}

TEST(dampings_that_could_not_ask_get_the_forces_of_the_step_before)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/older_minor.so", bad_folder);
    tl_error error = {TL_OK, ""};
    CHECK_INT(tl_plugin_load(path, &error), TL_OK);
    const tl_kind *kind = tl_plugin_find(TL_KIND_DAMPING, "older_minor");
    CHECK(kind && ((const tl_damping_ops *)kind->ops)->before);
    CHECK(kind && !((const tl_damping_ops *)kind->ops)->never_fails);
    CHECK(!((const tl_damping_ops *)tl_plugin_find(TL_KIND_DAMPING, "local")->ops)->before);
    CHECK(((const tl_damping_ops *)tl_plugin_find(TL_KIND_DAMPING, "combined")->ops)->before);
}

TEST(the_same_file_again_is_a_duplicate)
{
    refused(good_folder, "elastic", "plugin 'talus.elastic' is already loaded from ");
    CHECK(tl_plugin_find(TL_KIND_LAW, "elastic") != NULL);
}

TEST(a_text_file_is_refused)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/text.so", TALUS_TEST_TMP);
    FILE *file = fopen(path, "w");
    CHECK(file != NULL);
    fputs("This is not a shared object.\n", file);
    fclose(file);
    refused(TALUS_TEST_TMP, "text", "it cannot be opened (");
    CHECK(strstr(record_of(path).reason, path) == NULL);
    remove(path);
}

TEST(a_pipe_is_refused_and_not_waited_for)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/loader_pipe.so", TALUS_TEST_TMP);
    remove(path);
    CHECK_INT(mkfifo(path, 0600), 0);
    refused(TALUS_TEST_TMP, "loader_pipe", "it is a pipe: only regular files are loaded");
    remove(path);
}

TEST(refusals_leave_the_kinds_as_they_were)
{
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++)
        CHECK_INT(kinds_of((tl_kind_type)type), found[type]);
}

int main(void)
{
    /* A folder given twice, a file in place of a folder and an empty entry do no harm. */
    char search[4096];
    snprintf(search, sizeof search, ":%s::%s/:/dev/null:%s/no_such_folder:", good_folder, good_folder, good_folder);
    setenv("TALUS_PLUGIN_PATH", search, 1);
    tl_plugins_load_default();
    RUN(default_search_finds_every_plugin_once_in_order);
    RUN(a_search_for_nothing_is_no_error);
    RUN(broken_plugins_are_refused_with_the_reason);
    RUN(the_same_file_again_is_a_duplicate);
    RUN(a_text_file_is_refused);
    RUN(a_pipe_is_refused_and_not_waited_for);
    RUN(refusals_leave_the_kinds_as_they_were);
    RUN(a_screen_is_taken);
    RUN(a_kind_of_unknown_type_is_left_out_and_the_others_are_used);
    RUN(dampings_that_could_not_ask_get_the_forces_of_the_step_before);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
