/* repl_history.c - the lines typed at the prompt: $XDG_STATE_HOME/talus/history, or ~/.local/state/talus/history, a text of
 * a line each.
 *
 * A line is appended when it is typed, so that sessions side by side lose nothing of each other. A file with more than
 * twice MOST lines is cut to the last MOST when a session begins. Only the user can read it. Whatever fails, the prompt goes
 * on without the file. */
#include "repl_history.h"

#include <editline/readline.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MOST 1000 /* lines that are kept */

static struct {
    char path[PATH_MAX];
    char *last; /* line, from malloc */
    bool quiet, open;
} history;

static void give_up(const char *why)
{
    history.open = false;
    if (!history.quiet)
        fprintf(stderr, "talus: what is typed is not kept: %s: %s\n", history.path, why);
}

/* Makes the folders of the path; those that are there stay as they are. */
static bool make_folders(void)
{
    for (char *slash = strchr(history.path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        int failed = mkdir(history.path, 0700) != 0 && errno != EEXIST ? errno : 0;
        *slash = '/';
        if (failed) {
            give_up(strerror(failed));
            return false;
        }
    }
    return true;
}

/* A descriptor of the file, or -1 after a remark. A pipe in its place must not let the program wait. */
static int open_file(int flags)
{
    struct stat about;
    int file = open(history.path, flags | O_NONBLOCK | O_CLOEXEC, 0600);
    if (file < 0) {
        give_up(strerror(errno));
        return -1;
    }
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) {
        give_up("it is not a regular file");
        close(file);
        return -1;
    }
    return file;
}

/* Writes the last MOST lines into a file beside it, which then takes its place. */
static void cut_file(FILE *stream, size_t lines)
{
    char beside[PATH_MAX + 8];
    snprintf(beside, sizeof beside, "%s.tmp", history.path);
    int file = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0)
        return; /* another session cuts it */
    FILE *out = fdopen(file, "w");
    if (!out) {
        close(file);
        unlink(beside);
        return;
    }
    rewind(stream);
    for (int c; lines > MOST && (c = getc(stream)) != EOF;)
        lines -= c == '\n';
    for (int c; (c = getc(stream)) != EOF;)
        putc(c, out);
    bool good = !ferror(stream) && !ferror(out);
    good = fclose(out) == 0 && good;
    if (!good || rename(beside, history.path) != 0)
        unlink(beside);
}

static void read_file(void)
{
    int file = open_file(O_RDWR | O_CREAT);
    FILE *stream = file < 0 ? NULL : fdopen(file, "r");
    if (!stream) {
        if (file >= 0)
            close(file);
        return;
    }
    char *text = NULL;
    size_t size = 0, lines = 0;
    ssize_t length;
    while ((length = getline(&text, &size, stream)) > 0) {
        text[strcspn(text, "\n")] = 0;
        if (text[0])
            add_history(text);
        lines++;
    }
    free(text);
    if (lines > 2 * (size_t)MOST)
        cut_file(stream, lines);
    fclose(stream);
}

void tl_repl_history_open(bool quiet)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    history.quiet = quiet;
    using_history();
    stifle_history(MOST);
    int length = 0;
    if (state && state[0] == '/') /* a relative one is to be ignored */
        length = snprintf(history.path, sizeof history.path, "%s/talus/history", state);
    else if (home && home[0] == '/')
        length = snprintf(history.path, sizeof history.path, "%s/.local/state/talus/history", home);
    history.open = length > 0 && (size_t)length < sizeof history.path;
    if (history.open && make_folders())
        read_file();
}

void tl_repl_history_add(const char *line)
{
    size_t length = strlen(line);
    if (length == 0 || (history.last && strcmp(history.last, line) == 0))
        return;
    add_history(line);
    char *copy = malloc(length + 2);
    if (!copy)
        return;
    memcpy(copy, line, length + 1);
    free(history.last);
    history.last = copy;
    int file = history.open ? open_file(O_WRONLY | O_APPEND | O_CREAT) : -1;
    if (file < 0)
        return;
    copy[length] = '\n'; /* in one call, so that lines of two sessions do not mix */
    if (write(file, copy, length + 1) != (ssize_t)length + 1)
        give_up("it cannot be written");
    copy[length] = 0;
    close(file);
}
