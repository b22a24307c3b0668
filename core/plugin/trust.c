/* trust.c - where the program lies, and whether a folder or file that the user has not named is a place to load code
 * from.
 *
 * It is when nobody can have put anything there but root, the user who runs Talus and the owner of the program. That
 * owner could have put it into the program. So for the folder and the file: they belong to one of these, and others may
 * not write them. A group may, when it is the owner's private group or root's. For the folders above: they belong to
 * one of these, and who may write them may not rename what is in them (the sticky bit); a group that root lets write is
 * root's choice.
 *
 * Limit: lists of access rights (ACL) are looked at only as far as the mode tells of them. */
#define _GNU_SOURCE /* dladdr; realpath with stat of POSIX, getgrgid_r */
#include "plugin/trust.h"

#include <dlfcn.h>
#include <grp.h>
#include <limits.h>
#include <pwd.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes for an entry of the lists of users and groups; a group with more members is nobody's own. */
#define ENTRY_BYTES 8192

/* The file of the program or library that this function is in. The name of the main program may be a bare
 * word found through PATH; then the system knows where it is. */
bool tl_own_file(char file[PATH_MAX])
{
    Dl_info info;
    bool named = dladdr((void *)(uintptr_t)&tl_own_file, &info) != 0 && info.dli_fname &&
                 strchr(info.dli_fname, '/') && realpath(info.dli_fname, file);
    return named || realpath("/proc/self/exe", file);
}

static bool is_trusted(uid_t owner, uid_t program)
{
    return owner == 0 || owner == geteuid() || owner == program;
}

/* Whether the group is of the user's name and has no other member, as many systems make one for each user. */
static bool is_private(gid_t gid, uid_t uid)
{
    char user_text[ENTRY_BYTES], group_text[ENTRY_BYTES];
    struct passwd user, *found_user = NULL;
    struct group group, *found_group = NULL;
    if (gid == 0)
        return true;
    if (getpwuid_r(uid, &user, user_text, sizeof user_text, &found_user) != 0 || !found_user ||
        getgrgid_r(gid, &group, group_text, sizeof group_text, &found_group) != 0 || !found_group)
        return false;
    bool alone = strcmp(user.pw_name, group.gr_name) == 0;
    for (char **member = group.gr_mem; alone && *member; member++)
        alone = strcmp(*member, user.pw_name) == 0;
    return alone;
}

static bool others_may_write(const struct stat *s)
{
    return s->st_mode & S_IWOTH || (s->st_mode & S_IWGRP && !is_private(s->st_gid, s->st_uid));
}

static bool others_may_rename_in(const struct stat *s)
{
    if (s->st_mode & S_ISVTX)
        return false;
    return s->st_mode & S_IWOTH || (s->st_uid != 0 && others_may_write(s));
}

/* What is wrong with one file or folder, as the end of a sentence about it; false when nothing is. */
static bool find_fault(const char *path, bool above, uid_t program, char *why, size_t size)
{
    struct stat s;
    if (stat(path, &s) != 0)
        snprintf(why, size, "%s cannot be looked at", path);
    else if (!is_trusted(s.st_uid, program))
        snprintf(why, size, "%s belongs to user %lu, who is neither root nor you", path,
                 (unsigned long)s.st_uid);
    else if (above ? others_may_rename_in(&s) : others_may_write(&s))
        snprintf(why, size, "users other than its owner may write %s (mode %04o)", path,
                 (unsigned)(s.st_mode & 07777));
    else
        return false;
    return true;
}

bool tl_path_is_trusted(const char *path, const char *program, char *why, size_t size)
{
    char real[PATH_MAX];
    struct stat own;
    uid_t owner = stat(program, &own) == 0 ? own.st_uid : 0;
    if (!realpath(path, real)) {
        snprintf(why, size, "%s cannot be found", path);
        return false;
    }
    bool fault = find_fault(real, false, owner, why, size), file = true;
    struct stat s;
    if (stat(real, &s) == 0)
        file = !S_ISDIR(s.st_mode);
    /* upward; the folder of a file is as near as the file itself */
    for (char *slash; !fault && (slash = strrchr(real, '/')) != NULL && slash != real;
         file = false) {
        *slash = '\0';
        fault = find_fault(real, !file, owner, why, size);
    }
    return !fault && !find_fault("/", true, owner, why, size);
}
