/* library.c - finds the modules of Talus that are written in Lua:
 *
 *     HERE/lib                                a build: HERE is the folder of the program or library
 *     HERE/../share/lua/5.4                   installed bin/talus
 *     HERE/../../../share/lua/5.4             installed lib/lua/5.4/talus.so
 *     HERE/../../../../share/lua/5.4          the same in lib/MACHINE/lua/5.4
 *
 * As with plugins, a file is taken only when nobody but the owner of the program can have put it there (trust.c). */
#define _GNU_SOURCE /* realpath with stat of POSIX */
#include "plugin/registry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

tl_status tl_library_find(const char *file, char *path, size_t size, tl_error *error)
{
    static const char *const folders[] = {"lib", "../share/lua/5.4", "../../../share/lua/5.4",
                                          "../../../../share/lua/5.4"};
    char own[PATH_MAX], place[2 * PATH_MAX], plain[PATH_MAX], why[PATH_MAX + 128];
    if (!tl_own_file(own))
        return tl_fail(error, TL_E_NOT_FOUND, "the system does not tell where Talus lies");
    int here = (int)(strrchr(own, '/') - own);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        struct stat info;
        int n = snprintf(place, sizeof place, "%.*s/%s/%s", here, own, folders[i], file);
        if (n < 0 || (size_t)n >= sizeof place || !realpath(place, plain) ||
            stat(plain, &info) != 0 || !S_ISREG(info.st_mode) || strlen(plain) >= size)
            continue;
        if (!tl_path_is_trusted(plain, own, why, sizeof why))
            return tl_fail(error, TL_E_PLUGIN, "%s: Talus runs nothing from there", why);
        strcpy(path, plain);
        return TL_OK;
    }
    return tl_fail(error, TL_E_NOT_FOUND, "no file '%s' of Talus beside '%s' or in share/lua/5.4",
                   file, own);
}
