/* output_file.c - files that have no name until they are finished.
 *
 * Where the system can (Linux, most file systems), the file is made without a name. So nothing of it is left however
 * the program ends. A new name is then given to it directly. Where a file of that name exists, it gets a temporary
 * one first, since only a rename replaces a file. Elsewhere it has the temporary name from the beginning.
 *
 * Temporary names carry the process id and a number that is not taken. So two runs that write the same series do not
 * write into each other's files. Limit: a crash of the machine may lose a file that is not durable; a result can be
 * written again. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "base/output_file.h"

#include "base/error.h"
#include "base/signals.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Longest temporary name besides its folder, and how many are tried before it is given up. */
#define TEMPORARY_TEXT 64
#define TEMPORARY_TRIES 10000

tl_status tl_output_fail(tl_error *error, const char *path, int code)
{
    return tl_fail(error, TL_E_IO, "cannot write '%s': %s", path, strerror(code));
}

int tl_output_folders(const char *path)
{
    if (strlen(path) >= PATH_MAX)
        return ENAMETOOLONG; /* before any folder is made */
    char *folder = strdup(path);
    if (!folder)
        return ENOMEM;
    int code = 0;
    for (char *slash = strchr(folder + 1, '/'); slash && code == 0; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        struct stat info;
        /* A folder that exists may lie where nothing can be made: ask before complaining. */
        if (mkdir(folder, 0777) != 0) {
            code = errno;
            if (stat(folder, &info) == 0)
                code = S_ISDIR(info.st_mode) ? 0 : ENOTDIR;
        }
        *slash = '/';
    }
    free(folder);
    return code;
}

/* Says what stands in the place of a file, when that is not a regular file. */
static tl_status refuse_special(tl_error *error, const char *path, mode_t mode)
{
    if (S_ISDIR(mode))
        return tl_output_fail(error, path, EISDIR);
    const char *what = S_ISFIFO(mode) ? "a pipe" : S_ISSOCK(mode) ? "a socket" : "a device";
    return tl_fail(error, TL_E_IO,
                   "cannot write '%s': it is %s, and only a regular file can be replaced; give the name of a file",
                   path, what);
}

/* Finds where the file will stand: at the end of symbolic links. What is there may be replaced. */
static tl_status find_place(tl_output *output, tl_error *error)
{
    const char *path = output->path;
    struct stat info;
    if (lstat(path, &info) != 0) {
        if (errno != ENOENT)
            return tl_output_fail(error, path, errno);
        output->place = strdup(path);
        return output->place ? TL_OK : tl_fail_memory(error);
    }
    if (S_ISLNK(info.st_mode) && stat(path, &info) != 0)
        return tl_fail(error, TL_E_IO, "cannot write '%s': it is a symbolic link that leads to no file (%s)", path,
                       strerror(errno));
    if (!S_ISREG(info.st_mode))
        return refuse_special(error, path, info.st_mode);
    output->place = realpath(path, NULL);
    if (!output->place || access(output->place, W_OK) != 0)
        return errno == ENOMEM ? tl_fail_memory(error) : tl_output_fail(error, path, errno);
    return TL_OK;
}

/* Characters of the path of a file's folder, with the last '/'. */
static size_t folder_length(const char *place)
{
    const char *slash = strrchr(place, '/');
    return slash ? (size_t)(slash - place) + 1 : 0;
}

/* Gives the file a temporary name by `make`, which returns 0 or an errno; the first that is free. */
static int take_temporary(tl_output *output, int (*make)(tl_output *output))
{
    size_t folder = folder_length(output->place);
    int code = EEXIST;
    output->temporary = malloc(folder + TEMPORARY_TEXT);
    if (!output->temporary)
        return ENOMEM;
    memcpy(output->temporary, output->place, folder);
    for (int k = 0; code == EEXIST && k < TEMPORARY_TRIES; k++) {
        snprintf(output->temporary + folder, TEMPORARY_TEXT, ".talus.%ld.%d.tmp", (long)getpid(), k);
        code = make(output);
    }
    if (code != 0) {
        free(output->temporary);
        output->temporary = NULL;
    }
    return code;
}

static int make_named(tl_output *output)
{
    int fd = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0)
        return errno;
    output->file = fdopen(fd, "wb");
    if (output->file)
        return 0;
    close(fd);
    unlink(output->temporary);
    return ENOMEM;
}

/* Room for the name under which the system knows a file descriptor. */
#define DESCRIPTOR_TEXT 40

static void name_descriptor(int fd, char *text)
{
    snprintf(text, DESCRIPTOR_TEXT, "/proc/self/fd/%d", fd);
}

/* Opens a file without a name in the folder of the place; false where that cannot be done. */
static bool open_nameless(tl_output *output)
{
#ifdef O_TMPFILE
    size_t folder = folder_length(output->place);
    char *path = folder ? strndup(output->place, folder) : strdup(".");
    int fd = path ? open(path, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666) : -1;
    free(path);
    if (fd < 0)
        return false;
    char name[DESCRIPTOR_TEXT];
    name_descriptor(fd, name);
    if (access(name, F_OK) == 0) /* it can be given a name */
        output->file = fdopen(fd, "wb");
    if (output->file)
        return true;
    close(fd);
#else
    (void)output;
#endif
    return false;
}

tl_status tl_output_open(tl_output *output, const char *path, tl_error *error)
{
    *output = (tl_output){.path = NULL};
    if (!*path)
        return tl_fail(error, TL_E_ARGUMENT, "cannot write '': the name of the file is empty");
    output->path = strdup(path);
    int code = output->path ? tl_output_folders(path) : ENOMEM;
    tl_status status = TL_OK;
    if (code == 0)
        status = find_place(output, error);
    if (code == 0 && status == TL_OK && !open_nameless(output))
        code = take_temporary(output, make_named);
    if (code != 0)
        status = code == ENOMEM ? tl_fail_memory(error) : tl_output_fail(error, path, code);
    if (status != TL_OK)
        tl_output_drop(output);
    return status;
}

void tl_output_put(tl_output *output, const void *data, size_t bytes)
{
    errno = 0;
    if (bytes > 0 && fwrite(data, 1, bytes, output->file) != bytes && !output->code)
        output->code = errno;
}

tl_status tl_output_finish(tl_output *output, tl_error *error)
{
    /* A write error stays on the stream, but the errno of a full disk may come only with the last flush. */
    errno = 0;
    int bad = fflush(output->file) != 0 || (output->durable && fsync(fileno(output->file)) != 0);
    int code = output->code ? output->code : errno;
    if (!bad && !output->temporary) { /* the file is to outlive its stream */
        output->nameless = fcntl(fileno(output->file), F_DUPFD_CLOEXEC, 1);
        if (output->nameless < 0) {
            code = errno;
            bad = 1;
            output->nameless = 0;
        }
    }
    bad |= ferror(output->file) != 0;
    if (fclose(output->file) != 0) {
        code = code ? code : errno;
        bad = 1;
    }
    output->file = NULL;
    return bad ? tl_output_fail(error, output->path, code ? code : EIO) : TL_OK;
}

static int link_nameless(const tl_output *output, const char *name)
{
    char descriptor[DESCRIPTOR_TEXT];
    name_descriptor(output->nameless, descriptor);
    return linkat(AT_FDCWD, descriptor, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

/* Brings the names in the folder of the place to the disk; 0 or an errno. */
static int sync_folder(const tl_output *output)
{
    size_t length = folder_length(output->place);
    char *folder = length ? strndup(output->place, length) : strdup(".");
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    int code = fd < 0 ? errno : 0;
    if (fd >= 0 && fsync(fd) != 0 && errno != EINVAL) /* some file systems have no such thing */
        code = errno;
    if (fd >= 0)
        close(fd);
    free(folder);
    return code;
}

static int link_temporary(tl_output *output)
{
    return link_nameless(output, output->temporary);
}

tl_status tl_output_commit(tl_output *output, tl_error *error)
{
    int code = 0;
    if (output->nameless) {
        code = link_nameless(output, output->place);
        if (code == EEXIST)
            code = take_temporary(output, link_temporary);
    }
    if (code == 0 && output->temporary && rename(output->temporary, output->place) != 0)
        code = errno;
    if (code != 0)
        return tl_output_fail(error, output->path, code);
    free(output->temporary);
    output->temporary = NULL;
    code = output->durable ? sync_folder(output) : 0;
    return code ? tl_output_fail(error, output->path, code) : TL_OK;
}

void tl_output_drop(tl_output *output)
{
    if (output->file)
        fclose(output->file);
    if (output->nameless)
        close(output->nameless);
    if (output->temporary)
        unlink(output->temporary);
    free(output->temporary);
    free(output->place);
    free(output->path);
    *output = (tl_output){.path = NULL};
}

tl_status tl_output_whole(const char *path, tl_output_fn fill, void *user, tl_error *error)
{
    tl_output output = {0};
    sigset_t before;
    tl_signals_hold(&before, false);
    tl_status status = tl_output_open(&output, path, error);
    if (status == TL_OK)
        status = fill(&output, user);
    if (status == TL_OK)
        status = tl_output_finish(&output, error);
    if (status == TL_OK)
        status = tl_output_commit(&output, error);
    tl_output_drop(&output);
    tl_signals_release(&before);
    return status;
}

char *tl_output_prefix(const char *given, const char *ending)
{
    char *prefix = strdup(given);
    size_t length = strlen(given), more = strlen(ending);
    bool named = length > more && given[length - more - 1] != '/';
    if (prefix && named && strcmp(given + length - more, ending) == 0)
        prefix[length - more] = '\0';
    return prefix;
}
