/* regular.c - see regular.h. */
#define _XOPEN_SOURCE 700 /* S_ISSOCK */
#include "base/regular.h"

#include <stddef.h>
#include <sys/stat.h>

const char *tl_not_regular(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode))
        return NULL;
    if (S_ISDIR(info.st_mode))
        return "a folder";
    if (S_ISFIFO(info.st_mode))
        return "a pipe";
    return S_ISSOCK(info.st_mode) ? "a socket" : "a device";
}
