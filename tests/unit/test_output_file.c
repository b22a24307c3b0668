/* test_output_file.c - what may be replaced by a file and what not, and what is left of files when the program is ended
 * while it writes them. */
#define _GNU_SOURCE /* types of files, usleep */
#include "base/output_file.h"
#include "base/signals.h"
#include "check.h"

#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <talus/talus.h>
#include <unistd.h>

#define FOLDER TALUS_TEST_TMP "/output_file"
#define TEXT "some text\n"

/* Removes everything in the folder; gives the number of files whose names contain `part`. */
static int files_with(const char *part, int delete)
{
    int count = 0;
    DIR *folder = opendir(FOLDER);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        if (entry->d_name[0] == '.' && strlen(entry->d_name) < 3)
            continue;
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", FOLDER, entry->d_name);
        count += strstr(entry->d_name, part) != NULL;
        if (delete &&strstr(entry->d_name, part))
            remove(path);
    }
    if (folder)
        closedir(folder);
    return count;
}

static void clean_folder(void)
{
    mkdir(FOLDER, 0777);
    files_with("", 1);
}

static tl_status write_text(const char *path, tl_error *error)
{
    tl_output output = {0};
    *error = (tl_error){TL_OK, ""};
    tl_status status = tl_output_open(&output, path, error);
    if (status == TL_OK) {
        fputs(TEXT, output.file);
        status = tl_output_finish(&output, error);
    }
    if (status == TL_OK)
        status = tl_output_commit(&output, error);
    tl_output_drop(&output);
    return status;
}

static int holds_text(const char *path)
{
    char text[64] = "";
    FILE *file = fopen(path, "r");
    size_t read = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file)
        fclose(file);
    return read == strlen(TEXT) && strcmp(text, TEXT) == 0;
}

static mode_t type_of(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0 ? info.st_mode & S_IFMT : 0;
}

static void refuses(const char *path, mode_t type, const char *part)
{
    tl_error error;
    CHECK_INT(write_text(path, &error), *path ? TL_E_IO : TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, part);
    CHECK_CONTAINS(error.text, path);
    CHECK_INT(type_of(path), type);
}

TEST(a_file_is_written_and_replaced)
{
    tl_error error;
    for (int i = 0; i < 3; i++) {
        CHECK_INT(write_text(FOLDER "/plain", &error), TL_OK);
        CHECK(holds_text(FOLDER "/plain"));
    }
    CHECK_INT(files_with("", 0), 1);
    /* 255 bytes, as long as a name may be */
    char path[512];
    snprintf(path, sizeof path, "%s/%0255d", FOLDER, 1);
    CHECK_INT(write_text(path, &error), TL_OK);
    CHECK_INT(write_text(path, &error), TL_OK);
    CHECK(holds_text(path));
    CHECK_INT(files_with("", 0), 2);
}

TEST(only_regular_files_are_replaced)
{
    refuses("", 0, "empty");
    CHECK_INT(mkfifo(FOLDER "/pipe", 0666), 0);
    refuses(FOLDER "/pipe", S_IFIFO, "a pipe");
    CHECK_INT(mkdir(FOLDER "/folder", 0777), 0);
    refuses(FOLDER "/folder", S_IFDIR, "Is a directory");
    CHECK_INT(symlink("/dev/null", FOLDER "/to_device"), 0);
    refuses(FOLDER "/to_device", S_IFLNK, "a device");
    CHECK_INT(symlink(FOLDER "/pipe", FOLDER "/to_pipe"), 0);
    refuses(FOLDER "/to_pipe", S_IFLNK, "a pipe");
    CHECK_INT(symlink(FOLDER "/nothing", FOLDER "/to_nothing"), 0);
    refuses(FOLDER "/to_nothing", S_IFLNK, "leads to no file");
    CHECK_INT(symlink("to_itself", FOLDER "/to_itself"), 0);
    refuses(FOLDER "/to_itself", S_IFLNK, "leads to no file");
    CHECK_INT(type_of("/dev/null"), S_IFCHR);
    CHECK_INT(files_with("", 0), 6);
}

TEST(a_link_stays_and_its_file_is_replaced)
{
    tl_error error;
    CHECK_INT(mkdir(FOLDER "/elsewhere", 0777), 0);
    CHECK_INT(write_text(FOLDER "/elsewhere/file", &error), TL_OK);
    CHECK_INT(truncate(FOLDER "/elsewhere/file", 0), 0);
    CHECK_INT(symlink("elsewhere/file", FOLDER "/link"), 0);
    CHECK_INT(write_text(FOLDER "/link", &error), TL_OK);
    CHECK_INT(type_of(FOLDER "/link"), S_IFLNK);
    CHECK(holds_text(FOLDER "/elsewhere/file"));
    remove(FOLDER "/elsewhere/file");
    CHECK_INT(rmdir(FOLDER "/elsewhere"), 0); /* nothing else is in it */
}

TEST(paths_that_are_none)
{
    tl_error error;
    static char path[10000];
    snprintf(path, sizeof path, "%s/%0300d", FOLDER, 1);
    CHECK_INT(write_text(path, &error), TL_E_IO);
    CHECK_CONTAINS(error.text, "File name too long");
    memset(path, 'x', sizeof path - 1);
    for (size_t i = 100; i < sizeof path; i += 100)
        path[i - 1] = '/';
    memcpy(path, FOLDER, strlen(FOLDER));
    path[strlen(FOLDER)] = '/';
    tl_model_config config = {.size = sizeof(tl_model_config), .threads = 1};
    tl_model *m = NULL;
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    CHECK_INT(tl_write_blocks(m, path), TL_E_IO);
    CHECK_CONTAINS(tl_model_error(m)->text, "write_blocks: cannot write '");
    CHECK_INT(tl_write_blocks(m, ""), TL_E_ARGUMENT);
    CHECK_INT(tl_write_blocks(m, "/"), TL_E_IO);
    CHECK_INT(tl_write_blocks(m, FOLDER "/"), TL_E_IO);
    CHECK_INT(tl_write_blocks(m, "/dev/null/file"), TL_E_IO);
    tl_model_destroy(m);
}

/* The child writes files without end, until the signal ends it. */
static pid_t start_writer(void)
{
    pid_t child = fork();
    if (child != 0)
        return child;
    tl_error error;
    char path[128];
    for (int i = 0;; i++) {
        sigset_t before;
        snprintf(path, sizeof path, "%s/written_%d", FOLDER, i % 4);
        tl_signals_hold(&before, false);
        if (write_text(path, &error) != TL_OK)
            _exit(1);
        tl_signals_release(&before);
    }
}

/* Whether it has written all four. */
static int has_begun(void)
{
    return type_of(FOLDER "/written_3") != 0;
}

TEST(the_end_of_the_program_leaves_nothing)
{
    static const int ends[] = {SIGTERM, SIGINT, SIGHUP, SIGTERM, SIGTERM};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        signal(ends[i], SIG_DFL); /* nohup leaves one ignored */
    for (size_t i = 0; i < 20 * sizeof ends / sizeof *ends; i++) {
        int how = 0, end = ends[i % (sizeof ends / sizeof *ends)];
        files_with("written", 1);
        pid_t child = start_writer();
        while (!has_begun() && waitpid(child, &how, WNOHANG) == 0)
            usleep(100);
        usleep((useconds_t)(i * 37 % 400));
        kill(child, end);
        CHECK_INT(waitpid(child, &how, 0), child);
        CHECK(WIFSIGNALED(how) && WTERMSIG(how) == end);
        CHECK_INT(files_with(".tmp", 0), 0);
        CHECK_INT(files_with("written", 0), 4);
        CHECK(holds_text(FOLDER "/written_0") && holds_text(FOLDER "/written_3"));
    }
}

TEST_MAIN(RUN(clean_folder), RUN(a_file_is_written_and_replaced), RUN(clean_folder),
          RUN(only_regular_files_are_replaced), RUN(clean_folder), RUN(a_link_stays_and_its_file_is_replaced),
          RUN(paths_that_are_none), RUN(clean_folder), RUN(the_end_of_the_program_leaves_nothing))
