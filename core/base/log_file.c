/* log_file.c - a file to which one process at a time adds lines.
 *
 * The lock is that of POSIX (fcntl). It belongs to the process, not to copies of it that fork makes. So it ends with
 * the process, while a copy may still run. */
#include "base/error.h"
#include "base/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/log_file.h>
#include <unistd.h>

struct tl_log_file {
    int descriptor;
    char path[]; /* for sentences */
};

static tl_status lock(int descriptor, const char *path, tl_error *error)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(descriptor, F_SETLK, &whole) == 0)
        return TL_OK;
    if (errno == EACCES || errno == EAGAIN)
        return tl_fail(error, TL_E_STATE, "another process writes '%s': wait for its end, or give another file", path);
    return tl_fail(error, TL_E_IO, "cannot lock '%s': %s", path, strerror(errno));
}

tl_status tl_log_open(const char *path, tl_log_file **file, tl_error *error)
{
    *file = NULL;
    const int code = tl_output_folders(path);
    if (code)
        return tl_output_fail(error, path, code);
    tl_log_file *made = malloc(sizeof *made + strlen(path) + 1);
    if (!made)
        return tl_fail_memory(error);
    strcpy(made->path, path);
    struct stat info;
    tl_status status = TL_OK;
    /* O_NONBLOCK: the opening of a pipe does not wait */
    made->descriptor = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
    if (made->descriptor < 0)
        status = tl_output_fail(error, path, errno);
    else if (fstat(made->descriptor, &info) != 0 || !S_ISREG(info.st_mode))
        status = tl_fail(error, TL_E_IO, "cannot write '%s': it is no regular file; give the name of a file", path);
    else
        status = lock(made->descriptor, path, error);
    if (status == TL_OK) {
        *file = made;
        return TL_OK;
    }
    if (made->descriptor >= 0)
        close(made->descriptor);
    free(made);
    return status;
}

tl_status tl_log_read(tl_log_file *file, char **data, size_t *size, tl_error *error)
{
    struct stat info;
    *data = NULL;
    *size = 0;
    if (fstat(file->descriptor, &info) != 0)
        return tl_fail(error, TL_E_IO, "cannot read '%s': %s", file->path, strerror(errno));
    const size_t all = (size_t)info.st_size;
    *data = malloc(all + 1);
    if (!*data)
        return tl_fail_memory(error);
    while (*size < all) {
        const ssize_t got = pread(file->descriptor, *data + *size, all - *size, (off_t)*size);
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            return tl_fail(error, TL_E_IO, "cannot read '%s': %s", file->path, strerror(errno));
        *size += got > 0 ? (size_t)got : 0;
    }
    (*data)[*size] = '\0';
    return TL_OK;
}

tl_status tl_log_cut(tl_log_file *file, uint64_t size, tl_error *error)
{
    if (ftruncate(file->descriptor, (off_t)size) != 0)
        return tl_output_fail(error, file->path, errno);
    return TL_OK;
}

tl_status tl_log_add(tl_log_file *file, const void *data, size_t size, tl_error *error)
{
    const char *at = data;
    while (size > 0) {
        const ssize_t written = write(file->descriptor, at, size);
        if (written < 0 && errno != EINTR)
            return tl_output_fail(error, file->path, errno);
        at += written > 0 ? written : 0;
        size -= written > 0 ? (size_t)written : 0;
    }
    return TL_OK;
}

void tl_log_close(tl_log_file *file)
{
    if (!file)
        return;
    close(file->descriptor);
    free(file);
}
