/* test_page.c - the file of a page: frames are added at its end, and whatever goes wrong leaves it whole. */
#define _GNU_SOURCE /* usleep */
#include "check.h"

#include "io/page.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <talus/talus.h>
#include <unistd.h>

#define FOLDER TALUS_TEST_TMP "/page"

static tl_model *box_model(void)
{
    tl_model_config config = tl_model_config_default();
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    const double min[] = {0, 0, 0}, max[] = {1, 1, 1};
    const tl_value values[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = min, .count = 3},
                               {.key = "max", .type = TL_VALUE_NUMBERS, .data = max, .count = 3},
                               {.key = "density", .type = TL_VALUE_NUMBER, .number = 2500}};
    const tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
    return m;
}

/* The text of a file; the caller's. NULL when there is none. */
static char *text_of(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    fseek(file, 0, SEEK_END);
    *length = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*length + 1);
    *length = fread(text, 1, *length, file);
    text[*length] = '\0';
    fclose(file);
    return text;
}

/* Frames that a reader of the file sees: elements that are no comment, each with its end. -1: something is not whole. */
static int frames_in(const char *path)
{
    size_t length;
    char *text = text_of(path, &length), *at = text;
    int frames = 0;
    while (at && (at = strstr(at, "<"))) {
        if (strncmp(at, "<!--", 4) == 0) {
            at = strstr(at, "-->"); /* one without an end goes to the end of the file */
        } else if (strncmp(at, "<script type=\"text/talus\"", 25) == 0) {
            char number[40];
            snprintf(number, sizeof number, " data-frame=\"%d\"", frames);
            char *end = strstr(at, ">"), *close = strstr(at, "</script>");
            char *named = strstr(at, number);
            frames = close && named && named < end && frames >= 0 ? frames + 1 : -1;
            at = close;
        }
        at = at ? at + 1 : NULL;
    }
    free(text);
    return frames;
}

/* Files of the folder whose names contain `part`. */
static int files_with(const char *part)
{
    int count = 0;
    DIR *folder = opendir(FOLDER);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        count += strstr(entry->d_name, part) != NULL;
    if (folder)
        closedir(folder);
    return count;
}

static int same_file(const char *path, const char *text, size_t length)
{
    size_t now;
    char *read = text_of(path, &now);
    int same = read && text && now == length && memcmp(read, text, length) == 0;
    free(read);
    return same;
}

TEST(frames_are_added)
{
    tl_model *m = box_model();
    struct stat first, later;
    for (int i = 0; i < 20; i++) {
        CHECK_INT(tl_write_html(m, FOLDER "/run", NULL), TL_OK);
        CHECK_INT(frames_in(FOLDER "/run.html"), i + 1);
        CHECK_INT(stat(FOLDER "/run.html", i ? &later : &first), 0);
    }
    CHECK_INT(first.st_ino, later.st_ino); /* in place */
    CHECK_INT(tl_write_html(m, FOLDER "/new/folder/other", NULL), TL_OK);
    CHECK_INT(frames_in(FOLDER "/new/folder/other.html"), 1);
    CHECK_INT(frames_in(FOLDER "/run.html"), 20);
    CHECK_INT(files_with(".tmp"), 0);
    tl_model_destroy(m);

    m = box_model(); /* another model replaces the page */
    CHECK_INT(tl_write_html(m, FOLDER "/run", NULL), TL_OK);
    CHECK_INT(frames_in(FOLDER "/run.html"), 1);
    tl_model_destroy(m);
}

/* A page that is not as it was left is none to go on with. */
TEST(a_page_that_was_changed_begins_anew)
{
    tl_model *m = box_model(), *other = box_model();
    const char *path = FOLDER "/changed.html";
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 3; k++) {
            CHECK_INT(tl_write_html(m, FOLDER "/changed", NULL), TL_OK);
            CHECK_INT(frames_in(path), k + 1);
        }
        struct stat info;
        CHECK_INT(stat(path, &info), 0);
        FILE *file = fopen(path, "r+b");
        if (i == 0)
            remove(path);
        else if (i == 1)
            CHECK_INT(truncate(path, info.st_size - 20), 0);
        else if (i == 2) {
            fseek(file, -40, SEEK_END); /* in the last frame */
            fputc('!', file);
        } else if (i == 3) {
            fseek(file, 0, SEEK_END);
            fputc('\n', file);
        } else
            CHECK_INT(tl_write_html(other, FOLDER "/changed", NULL), TL_OK);
        fclose(file);
    }
    tl_model_destroy(m);
    tl_model_destroy(other);
}

TEST(what_is_refused)
{
    tl_model *m = box_model();
    CHECK_INT(tl_write_html(m, "", NULL), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "write_html: prefix = ''");
    CHECK_INT(tl_write_html(m, FOLDER "/", NULL), TL_E_ARGUMENT);
    tl_html html = tl_html_default();
    html.contacts = 4;
    CHECK_INT(tl_write_html(m, FOLDER "/no", &html), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "contacts = 4");
    html.contacts = -1;
    CHECK_INT(tl_write_html(m, FOLDER "/no", &html), TL_E_ARGUMENT);
    html.contacts = TL_HTML_CONTACTS_ALL;
    const tl_extra_field nameless = {.name = "", .values = NULL, .count = 0};
    html.block_fields = &nameless;
    html.block_field_count = 1;
    CHECK_INT(tl_write_html(m, FOLDER "/no", &html), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "block_fields: field 1 must have a name");
    CHECK_INT(files_with("no"), 0);

    FILE *file = fopen(FOLDER "/plain", "w");
    if (CHECK(file != NULL))
        fclose(file);
    CHECK_INT(tl_write_html(m, FOLDER "/plain/run", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "write_html: cannot write");
    CHECK_CONTAINS(tl_model_error(m)->text, "Not a directory");
    CHECK_INT(mkdir(FOLDER "/folder.html", 0777), 0);
    CHECK_INT(tl_write_html(m, FOLDER "/folder", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "Is a directory");
    CHECK_INT(mkfifo(FOLDER "/pipe.html", 0666), 0);
    CHECK_INT(tl_write_html(m, FOLDER "/pipe", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "it is a pipe");
    tl_model_destroy(m);
}

/* A folder and a page that may not be written; the superuser may write all, and /proc refuses even that one. */
TEST(what_may_not_be_written)
{
    tl_model *m = box_model();
    CHECK_INT(tl_write_html(m, "/proc/nowhere/run", NULL), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "/proc/nowhere/run.html");
    if (geteuid() != 0) {
        CHECK_INT(tl_write_html(m, FOLDER "/locked/run", NULL), TL_OK);
        CHECK_INT(chmod(FOLDER "/locked/run.html", 0444), 0);
        CHECK_INT(tl_write_html(m, FOLDER "/locked/run", NULL), TL_E_IO);
        CHECK_CONTAINS(tl_model_error(m)->text, "Permission denied");
        CHECK_INT(chmod(FOLDER "/locked/run.html", 0644), 0);
        CHECK_INT(chmod(FOLDER "/locked", 0555), 0);
        CHECK_INT(tl_write_html(m, FOLDER "/locked/run", NULL), TL_OK); /* in place */
        CHECK_INT(frames_in(FOLDER "/locked/run.html"), 2);
        CHECK_INT(tl_write_html(m, FOLDER "/locked/new", NULL), TL_E_IO);
        CHECK_INT(chmod(FOLDER "/locked", 0755), 0);
    }
    tl_model_destroy(m);
}

TEST(a_page_has_a_longest_length)
{
    tl_model *m = box_model();
    const char *path = FOLDER "/long.html";
    size_t length;
    CHECK_INT(tl_page_write(m, FOLDER "/long", NULL, 100), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "frame 0");
    CHECK(access(path, F_OK) != 0);
    CHECK_INT(tl_write_html(m, FOLDER "/long", NULL), TL_OK);
    char *text = text_of(path, &length);
    CHECK_INT(tl_page_write(m, FOLDER "/long", NULL, length + 100), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "leave out contacts");
    CHECK(same_file(path, text, length));
    free(text);
    CHECK_INT(tl_page_write(m, FOLDER "/long", NULL, length + 10000), TL_OK);
    text = text_of(path, &length);
    CHECK_INT(frames_in(path), 2);

    /* the length that is looked at is that which it has */
    CHECK_INT(tl_write_html(m, FOLDER "/long", NULL), TL_OK);
    free(text);
    text = text_of(path, &length);
    tl_model *twin = box_model();
    tl_html html = tl_html_default();
    html.title = "long"; /* as long a page as the other */
    for (int i = 0; i < 2; i++)
        CHECK_INT(tl_write_html(twin, FOLDER "/long_twin", &html), TL_OK);
    CHECK_INT(tl_page_write(twin, FOLDER "/long_twin", &html, length - 1), TL_E_ARGUMENT);
    CHECK_INT(tl_page_write(twin, FOLDER "/long_twin", &html, length), TL_OK);
    CHECK(same_file(FOLDER "/long_twin.html", text, length));
    free(text);
    tl_model_destroy(twin);
    tl_model_destroy(m);
}

/* A limit on the size of files stands for a full disk. */
TEST(a_full_disk_is_noticed)
{
    struct rlimit old, small;
    tl_model *m = box_model();
    const char *path = FOLDER "/full.html";
    CHECK_INT(getrlimit(RLIMIT_FSIZE, &old), 0);
    signal(SIGXFSZ, SIG_IGN);
    size_t length = 0;
    char *text = NULL;
    for (int i = 0; i < 3; i++) {
        small = old;
        small.rlim_cur = i ? length + (i == 1 ? 2 : 200) : 1000;
        CHECK_INT(setrlimit(RLIMIT_FSIZE, &small), 0);
        tl_status status = tl_write_html(m, FOLDER "/full", NULL);
        CHECK_INT(setrlimit(RLIMIT_FSIZE, &old), 0);
        CHECK_INT(status, TL_E_IO);
        CHECK_CONTAINS(tl_model_error(m)->text, "full.html");
        if (i)
            CHECK(same_file(path, text, length)); /* as it was */
        else
            CHECK(access(path, F_OK) != 0);
        free(text);
        CHECK_INT(tl_write_html(m, FOLDER "/full", NULL), TL_OK);
        CHECK_INT(frames_in(path), i + 1);
        text = text_of(path, &length);
    }
    free(text);
    CHECK_INT(files_with(".tmp"), 0);
    tl_model_destroy(m);
}

/* A child that adds frames is killed: the page is whole. */
TEST(a_killed_writer_leaves_a_whole_page)
{
    const char *path = FOLDER "/killed.html";
    for (int round = 0; round < 20; round++) {
        remove(path);
        pid_t child = fork();
        if (child == 0) {
            tl_model *m = box_model();
            for (;;)
                if (tl_write_html(m, FOLDER "/killed", NULL) != TL_OK)
                    _exit(1);
        }
        int how = 0;
        while (frames_in(path) < 1 + 3 * round && waitpid(child, &how, WNOHANG) == 0)
            usleep(200);
        kill(child, round % 2 ? SIGKILL : SIGTERM);
        CHECK_INT(waitpid(child, &how, 0), child);
        CHECK(WIFSIGNALED(how));
        CHECK(frames_in(path) >= 1 + 3 * round);
    }
}

static void clean_folder(void)
{
    CHECK_INT(system("rm -rf '" FOLDER "'"), 0);
    mkdir(FOLDER, 0777);
}

TEST_MAIN(RUN(clean_folder), RUN(frames_are_added), RUN(a_page_that_was_changed_begins_anew), RUN(what_is_refused),
          RUN(what_may_not_be_written), RUN(a_page_has_a_longest_length), RUN(a_full_disk_is_noticed),
          RUN(a_killed_writer_leaves_a_whole_page))
