/* output_file.c - writing under a temporary name, then renaming.
 *
 * The temporary name carries the process id, so that two runs writing the same series do not write
 * into each other's files. Limit: a crash of the machine may lose a file (no fsync); a result can
 * be written again. */
#include "io/output_file.h"

#include "base/error.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static tl_status fail_io(tl_error *error, const char *path, int code)
{
    return tl_fail(error, TL_E_IO, "cannot write '%s': %s", path, strerror(code));
}

/* Makes every folder in front of the last '/' of `path`; 0 or an errno. */
static int make_folders(const char *path)
{
    char *folder = strdup(path);
    if (!folder)
        return ENOMEM;
    int code = 0;
    for (char *slash = strchr(folder + 1, '/'); slash && code == 0;
         slash = strchr(slash + 1, '/')) {
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

tl_status tl_output_open(tl_output *output, const char *path, tl_error *error)
{
    size_t room = strlen(path) + 32;
    *output = (tl_output){.path = strdup(path), .temporary = malloc(room)};
    if (!output->path || !output->temporary) {
        tl_output_drop(output);
        return tl_fail_memory(error);
    }
    snprintf(output->temporary, room, "%s.%ld.tmp", path, (long)getpid());

    /* A folder in the file's place would only be found by the rename, when it is too late. */
    struct stat info;
    int code = make_folders(path);
    if (code == 0 && stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        code = EISDIR;
    if (code == 0) {
        output->file = fopen(output->temporary, "wb");
        code = output->file ? 0 : errno;
    }
    if (code != 0) {
        fail_io(error, path, code);
        tl_output_drop(output);
        return TL_E_IO;
    }
    return TL_OK;
}

tl_status tl_output_finish(tl_output *output, tl_error *error)
{
    /* A write error stays on the stream, but the errno of a full disk may come only with the last
     * flush. */
    errno = 0;
    int bad = fflush(output->file) != 0;
    int code = errno;
    bad |= ferror(output->file) != 0;
    if (fclose(output->file) != 0) {
        code = code ? code : errno;
        bad = 1;
    }
    output->file = NULL;
    return bad ? fail_io(error, output->path, code ? code : EIO) : TL_OK;
}

tl_status tl_output_commit(tl_output *output, tl_error *error)
{
    if (rename(output->temporary, output->path) != 0)
        return fail_io(error, output->path, errno);
    free(output->temporary);
    output->temporary = NULL;
    return TL_OK;
}

void tl_output_drop(tl_output *output)
{
    if (output->file)
        fclose(output->file);
    if (output->temporary)
        remove(output->temporary);
    free(output->temporary);
    free(output->path);
    *output = (tl_output){0};
}
