/* loader.c - finds plugins and modules on disk, and opens plugins.
 *
 * Searched in this order, each folder once, the *.so files of a folder in the order of their names:
 *
 *     TALUS_PLUGIN_PATH                   folders separated by colons
 *     HERE/plugins                        a build: HERE is the folder of the program or library
 *     HERE/../lib/talus/plugins-MAJOR     installed bin/talus
 *     HERE/../../talus/plugins-MAJOR      installed lib/lua/5.4/talus.so
 *     HERE/talus/plugins-MAJOR            installed lib/libtalus.so
 *
 * The file that holds this function is asked for its place (dladdr), so that a moved install still works. A stock Lua
 * that loads the module then finds the module's plugins, not its own.
 *
 * A plugin of an id that is loaded already is refused, so the first found wins.
 *
 * A folder or file that others may write is refused, but where the user has named it: with --plugin, or in
 * TALUS_PLUGIN_PATH, when a note says so.
 *
 * The modules of Talus that are written in Lua are files of
 *
 *     HERE/lib                            a build
 *     HERE/../share/lua/5.4               installed bin/talus
 *     HERE/../../../share/lua/5.4         installed lib/lua/5.4/talus.so
 *     HERE/../../../../share/lua/5.4      the same in lib/MACHINE/lua/5.4 */
#define _GNU_SOURCE /* dladdr; realpath with stat of POSIX, getgrgid_r */
#include "plugin/loader.h"

#include "base/inside.h"
#include "base/names.h"
#include "base/regular.h"
#include "plugin/descriptor.h"

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <grp.h>
#include <limits.h>
#include <pthread.h>
#include <pwd.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---------------------------------------------------------------- whom to trust ----------
 *
 * Whether a folder or file that the user has not named is a place to load code from.
 *
 * It is when nobody can have put anything there but root, the user who runs Talus and the owner of the program. That
 * owner could have put it into the program. So for the folder and the file: they belong to one of these, and others may
 * not write them. A group may, when it is the owner's private group or root's. For the folders above: they belong to
 * one of these, and who may write them may not rename what is in them (the sticky bit); a group that root lets write is
 * root's choice.
 *
 * Limit: lists of access rights (ACL) are looked at only as far as the mode tells of them. */

/* Bytes for an entry of the lists of users and groups; a group with more members is nobody's own. */
#define ENTRY_BYTES 8192

/* The file of the program or library that this function is in, without links; false when the system does not tell. The
 * name of the main program may be a bare word found through PATH; then the system knows where it is. */
static bool own_file(char file[PATH_MAX])
{
    Dl_info info;
    bool named = dladdr((void *)(uintptr_t)&own_file, &info) != 0 && info.dli_fname && strchr(info.dli_fname, '/') &&
                 realpath(info.dli_fname, file);
    return named || realpath("/proc/self/exe", file);
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
    else if (s.st_uid != 0 && s.st_uid != geteuid() && s.st_uid != program)
        snprintf(why, size, "%s belongs to user %lu, who is neither root nor you", path, (unsigned long)s.st_uid);
    else if (above ? others_may_rename_in(&s) : others_may_write(&s))
        snprintf(why, size, "users other than its owner may write %s (mode %04o)", path, (unsigned)(s.st_mode & 07777));
    else
        return false;
    return true;
}

/* Whether nobody but root, the user and the owner of the file `program` can have put the folder or file there;
 * otherwise `why` says who could. */
static bool path_is_trusted(const char *path, const char *program, char *why, size_t size)
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
    for (char *slash; !fault && (slash = strrchr(real, '/')) != NULL && slash != real; file = false) {
        *slash = '\0';
        fault = find_fault(real, !file, owner, why, size);
    }
    return !fault && !find_fault("/", true, owner, why, size);
}

/* ---------------------------------------------------------------- modules written in Lua --- */

tl_status tl_library_find(const char *file, char *path, size_t size, tl_error *error)
{
    static const char *const folders[] = {"lib", "../share/lua/5.4", "../../../share/lua/5.4",
                                          "../../../../share/lua/5.4"};
    char own[PATH_MAX], place[2 * PATH_MAX], plain[PATH_MAX], why[PATH_MAX + 128];
    if (!own_file(own))
        return tl_fail(error, TL_E_NOT_FOUND, "the system does not tell where Talus lies");
    int here = (int)(strrchr(own, '/') - own);
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        struct stat info;
        int n = snprintf(place, sizeof place, "%.*s/%s/%s", here, own, folders[i], file);
        if (n < 0 || (size_t)n >= sizeof place || !realpath(place, plain) || stat(plain, &info) != 0 ||
            !S_ISREG(info.st_mode) || strlen(plain) >= size)
            continue;
        if (!path_is_trusted(plain, own, why, sizeof why))
            return tl_fail(error, TL_E_PLUGIN, "%s: Talus runs nothing from there", why);
        strcpy(path, plain);
        return TL_OK;
    }
    return tl_fail(error, TL_E_NOT_FOUND, "no file '%s' of Talus beside '%s' or in share/lua/5.4", file, own);
}

/* ---------------------------------------------------------------- what is loaded ----------
 *
 * The loaded plugins, their kinds by name, and the record of every attempt to load one. */

typedef struct record record;
struct record {
    char *path;
    char *reason;      /* why it was refused, or NULL */
    char *note;        /* what else there is to say, or NULL */
    tl_plugin *plugin; /* NULL when refused */
    _Atomic(record *) next;
};

/* Append only; guarded by the lock, since models may live on several threads. Records never move, so a handler of
 * signals may follow the list without the lock. */
static struct {
    pthread_mutex_t lock;
    _Atomic(record *) first;
    record *last;
    size_t count;
} registry = {.lock = PTHREAD_MUTEX_INITIALIZER};

static char *copy_of(const char *text)
{
    return text && *text ? strdup(text) : NULL;
}

/* Appends copies of the texts; the lock is held. */
static bool append(const char *path, const char *reason, const char *note, tl_plugin *plugin)
{
    record *r = calloc(1, sizeof *r);
    if (!r)
        return false;
    r->path = strdup(path);
    r->reason = copy_of(reason);
    r->note = copy_of(note);
    r->plugin = plugin;
    if (!r->path || (reason && *reason && !r->reason) || (note && *note && !r->note)) {
        free(r->path);
        free(r->reason);
        free(r->note);
        free(r);
        return false;
    }
    if (registry.last)
        atomic_store(&registry.last->next, r);
    else
        atomic_store(&registry.first, r);
    registry.last = r;
    registry.count++;
    return true;
}

static const record *first_record(void)
{
    return atomic_load(&registry.first);
}

static const record *next_record(const record *r)
{
    return atomic_load(&((record *)(uintptr_t)r)->next);
}

/* Where a walk over the kinds of all plugins is. */
typedef struct place {
    const record *at;
    uint32_t next; /* kind of its plugin */
} place;

/* The next kind of a walk, that of p->at; NULL at the end. */
static const tl_kind *next_kind(place *p)
{
    for (; p->at; p->at = next_record(p->at), p->next = 0)
        if (p->at->plugin && p->next < p->at->plugin->kind_count)
            return &p->at->plugin->kinds[p->next++];
    return NULL;
}

/* The record whose plugin offers this kind, or NULL; the lock is held. */
static const record *provider(uint32_t type, const char *name, const tl_kind **kind)
{
    place p = {first_record(), 0};
    do
        *kind = next_kind(&p);
    while (*kind && ((*kind)->type != type || strcmp((*kind)->name, name) != 0));
    return p.at;
}

const tl_plugin *tl_plugin_of(const tl_kind *kind, const char **path)
{
    place p = {first_record(), 0};
    for (const tl_kind *of; (of = next_kind(&p)) && of != kind;)
        continue;
    if (p.at && path)
        *path = p.at->path;
    return p.at ? p.at->plugin : NULL;
}

static tl_status check_new(const tl_plugin *plugin, tl_error *error)
{
    for (const record *r = first_record(); r; r = next_record(r))
        if (r->plugin && strcmp(r->plugin->id, plugin->id) == 0)
            return tl_fail(error, TL_E_PLUGIN, "plugin '%s' is already loaded from %s", plugin->id, r->path);
    for (uint32_t k = 0; k < plugin->kind_count; k++) {
        const tl_kind *mine = &plugin->kinds[k], *theirs;
        const record *other = provider(mine->type, mine->name, &theirs);
        if (other)
            return tl_fail(error, TL_E_PLUGIN, "%s '%s' is already provided by plugin '%s' from %s",
                           tl_kind_type_name(mine->type), mine->name, other->plugin->id, other->path);
    }
    return TL_OK;
}

tl_status tl_registry_add(const char *path, tl_plugin *plugin, const char *note, tl_error *error)
{
    pthread_mutex_lock(&registry.lock);
    tl_status status = check_new(plugin, error);
    if (status == TL_OK && !append(path, NULL, note, plugin))
        status = tl_fail_memory(error);
    pthread_mutex_unlock(&registry.lock);
    return status;
}

/* Keeps the reason why a file or folder was refused, or a remark on it; false when out of memory. */
static bool keep(const char *path, const char *reason, const char *note)
{
    pthread_mutex_lock(&registry.lock);
    bool done = append(path, reason, note, NULL);
    pthread_mutex_unlock(&registry.lock);
    return done;
}

/* Whether there is a record of that file or folder. */
static bool registry_has(const char *path)
{
    for (const record *r = first_record(); r; r = next_record(r))
        if (strcmp(r->path, path) == 0)
            return true;
    return false;
}

const tl_kind *tl_plugin_kind(tl_kind_type type, size_t index)
{
    const tl_kind *found;
    pthread_mutex_lock(&registry.lock);
    place p = {first_record(), 0};
    do
        found = next_kind(&p);
    while (found && (found->type != (uint32_t)type || index-- > 0));
    pthread_mutex_unlock(&registry.lock);
    return found;
}

const tl_kind *tl_plugin_find(tl_kind_type type, const char *name)
{
    const tl_kind *kind = NULL;
    pthread_mutex_lock(&registry.lock);
    (void)provider((uint32_t)type, name, &kind);
    pthread_mutex_unlock(&registry.lock);
    return kind;
}

size_t tl_plugin_record_count(void)
{
    pthread_mutex_lock(&registry.lock);
    size_t count = registry.count;
    pthread_mutex_unlock(&registry.lock);
    return count;
}

tl_plugin_record tl_plugin_record_at(size_t index)
{
    tl_plugin_record found = {NULL, NULL, NULL, NULL};
    pthread_mutex_lock(&registry.lock);
    const record *r = first_record();
    while (r && index-- > 0)
        r = next_record(r);
    if (r)
        found = (tl_plugin_record){r->path, r->plugin, r->reason, r->note};
    pthread_mutex_unlock(&registry.lock);
    return found;
}

const char *tl_plugin_id(const tl_kind *kind)
{
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    return plugin ? plugin->id : "?";
}

tl_status tl_kind_unknown(tl_error *error, tl_kind_type type, const char *name)
{
    const char *what = tl_kind_type_name(type);
    size_t count = 0;
    while (tl_plugin_kind(type, count))
        count++;
    if (count == 0)
        return tl_fail(error, TL_E_NOT_FOUND,
                       "unknown %s '%.80s': no %s is loaded; TALUS_PLUGIN_PATH may name the folder of the plugins",
                       what, name, what);
    const char **names = malloc(count * sizeof *names);
    if (!names)
        return tl_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        names[i] = tl_plugin_kind(type, i)->name;
    tl_status status = tl_fail_unknown(error, TL_E_NOT_FOUND, "", what, name, names, count);
    free(names);
    return status;
}

/* ---------------------------------------------------------------- loader ------------------ */

#define ENTRY "tl_plugin_entry"
/* Why a folder or file that nobody has named is left alone; what is wrong comes first. */
#define UNTRUSTED                                                                                                      \
    "%s: nothing is loaded from there unless it is named, with --plugin FILE or in "                                   \
    "TALUS_PLUGIN_PATH"

/* Folders searched at most: a TALUS_PLUGIN_PATH longer than this is a mistake. */
#define MOST_FOLDERS 64
/* Major versions that a plugin which refuses this one is asked about. */
#define MOST_MAJORS 16

/* A search: the folders so far, by identity, so that two names of one folder count once. */
typedef struct search {
    dev_t device[MOST_FOLDERS];
    ino_t inode[MOST_FOLDERS];
    size_t count;
    /* a search before this one ran out of memory: what it has recorded is not tried again */
    bool again;
    bool short_of_memory; /* something was left out for want of it */
} search;

/* ISO C has no conversion from an object pointer to a function; POSIX promises this one works. */
static tl_plugin_entry_fn find_entry(void *handle)
{
    tl_plugin_entry_fn entry = NULL;
    void *symbol = dlsym(handle, ENTRY);
    memcpy(&entry, &symbol, sizeof entry);
    return entry;
}

/* Fails, with both versions, where a descriptor is one of another major version, or none. */
static tl_status check_version(const tl_plugin *given, tl_error *error)
{
    if (given->size < offsetof(tl_plugin, abi_minor) + sizeof given->abi_minor)
        return tl_fail(error, TL_E_PLUGIN, "its descriptor has size %u: not a Talus plugin", given->size);
    if (given->abi_major != TL_ABI_MAJOR)
        return tl_fail(error, TL_E_PLUGIN,
                       "it was built for plugin ABI %u.%u, this Talus has %u.%u: build it anew against these headers",
                       given->abi_major, given->abi_minor, TL_ABI_MAJOR, TL_ABI_MINOR);
    return TL_OK;
}

/* Why a plugin gives no descriptor: by what it gives to hosts of other versions, the one it was built with. */
static tl_status tell_refusal(tl_plugin_entry_fn entry, tl_error *error)
{
    for (uint32_t major = 1; major <= MOST_MAJORS; major++) {
        tl_enter(NULL, ENTRY);
        const tl_plugin *given = entry(major, UINT32_MAX);
        tl_leave();
        tl_status status = given ? check_version(given, error) : TL_OK;
        if (status != TL_OK)
            return status;
        if (given)
            return tl_fail(error, TL_E_PLUGIN,
                           "it was built for plugin ABI %u.%u and cannot do without it, this Talus has %u.%u",
                           given->abi_major, given->abi_minor, TL_ABI_MAJOR, TL_ABI_MINOR);
    }
    return tl_fail(error, TL_E_PLUGIN, "it refuses this Talus (plugin ABI %u.%u)", TL_ABI_MAJOR, TL_ABI_MINOR);
}

/* Asks an opened file for its descriptor and takes it into the registry. */
static tl_status take_in(const char *path, void *handle, tl_error *error)
{
    tl_plugin_entry_fn entry = find_entry(handle);
    if (!entry)
        return tl_fail(error, TL_E_PLUGIN, "it does not export " ENTRY ": not a Talus plugin");
    tl_inside_plugin.path = path;
    tl_enter(NULL, ENTRY);
    const tl_plugin *given = entry(TL_ABI_MAJOR, TL_ABI_MINOR);
    tl_leave();
    if (!given)
        return tell_refusal(entry, error);
    tl_plugin *plugin;
    char note[TL_NOTE_TEXT];
    tl_status status = check_version(given, error);
    if (status == TL_OK)
        status = tl_descriptor_read(given, &plugin, note, error);
    if (status != TL_OK)
        return status;
    status = tl_registry_add(path, plugin, note, error);
    if (status != TL_OK)
        tl_descriptor_free(plugin);
    return status;
}

static tl_status open_and_take_in(const char *path, tl_error *error)
{
    /* Without a slash dlopen would search the system's folders instead. */
    char local[PATH_MAX];
    int n = snprintf(local, sizeof local, "%s%s", strchr(path, '/') ? "" : "./", path);
    if (n < 0 || (size_t)n >= sizeof local)
        return tl_fail(error, TL_E_PLUGIN, "its path is too long");
    const char *other = tl_not_regular(local);
    if (other)
        return tl_fail(error, TL_E_PLUGIN, "it is %s: only regular files are loaded", other);
    tl_inside_plugin.path = path;
    tl_enter(NULL, "dlopen"); /* which runs the file's constructors */
    errno = 0;
    void *handle = dlopen(local, RTLD_NOW | RTLD_LOCAL);
    bool short_of_memory = errno == ENOMEM;
    tl_leave();
    if (!handle && short_of_memory)
        return tl_fail_memory(error);
    if (!handle) {
        const char *reason = dlerror();
        size_t length = strlen(local);
        if (!reason)
            reason = "no reason given";
        /* The path is in the sentence already. */
        if (strncmp(reason, local, length) == 0 && strncmp(reason + length, ": ", 2) == 0)
            reason += length + 2;
        return tl_fail(error, TL_E_PLUGIN, "it cannot be opened (%s)", reason);
    }
    tl_status status = take_in(path, handle, error);
    if (status != TL_OK)
        dlclose(handle);
    return status;
}

tl_status tl_plugin_load(const char *path, tl_error *error)
{
    tl_error own = {TL_OK, ""};
    tl_error *told = error ? error : &own;
    tl_status status = open_and_take_in(path, told);
    /* A plugin for which there was no memory may be tried again: it is not refused. */
    if (status != TL_OK && status != TL_E_MEMORY && !keep(path, told->text, NULL))
        status = tl_fail_memory(told);
    if (status != TL_OK)
        tl_error_prefix(told, "plugin %s: ", path);
    return status;
}

/* ---------------------------------------------------------------- search ----------------- */

static int is_plugin_file(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 3 && strcmp(entry->d_name + length - 3, ".so") == 0;
}

/* By bytes, not by the user's language: the order decides which of two plugins wins. */
static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* True the first time an existing folder is seen. */
static bool is_new_folder(search *s, const char *folder)
{
    struct stat info;
    if (stat(folder, &info) != 0 || !S_ISDIR(info.st_mode) || s->count == MOST_FOLDERS)
        return false;
    for (size_t i = 0; i < s->count; i++)
        if (s->device[i] == info.st_dev && s->inode[i] == info.st_ino)
            return false;
    s->device[s->count] = info.st_dev;
    s->inode[s->count++] = info.st_ino;
    return true;
}

/* realpath; false when there is none. */
static bool plain_path(search *s, const char *path, char plain[PATH_MAX])
{
    errno = 0;
    bool there = realpath(path, plain) != NULL;
    s->short_of_memory |= !there && errno == ENOMEM;
    return there;
}

/* A file of a folder. A refusal is kept in the records; the search goes on. */
static void load_found(search *s, const char *path, const char *program)
{
    char why[PATH_MAX + 128], text[PATH_MAX + 256];
    if (s->again && registry_has(path))
        return;
    if (!program || path_is_trusted(path, program, why, sizeof why)) {
        s->short_of_memory |= tl_plugin_load(path, NULL) == TL_E_MEMORY;
        return;
    }
    snprintf(text, sizeof text, UNTRUSTED, why);
    s->short_of_memory |= !keep(path, text, NULL);
}

/* `program`: the file whose owner is trusted, or NULL where the user has named the folder. */
static void load_folder(search *s, const char *folder, const char *program)
{
    char why[PATH_MAX + 128], text[PATH_MAX + 256];
    if (!is_new_folder(s, folder))
        return;
    if (!path_is_trusted(folder, program ? program : folder, why, sizeof why)) {
        snprintf(text, sizeof text,
                 program ? UNTRUSTED : "%s: plugins are loaded from it because TALUS_PLUGIN_PATH names it", why);
        if (!s->again || !registry_has(folder))
            s->short_of_memory |= !keep(folder, program ? text : NULL, program ? NULL : text);
        if (program)
            return;
    }
    struct dirent **entries;
    errno = 0;
    int count = scandir(folder, &entries, is_plugin_file, by_name);
    s->short_of_memory |= count < 0 && errno == ENOMEM;
    for (int i = 0; i < count; i++) {
        char path[PATH_MAX];
        int n = snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        if (n > 0 && (size_t)n < sizeof path)
            load_found(s, path, program);
        free(entries[i]);
    }
    if (count >= 0)
        free(entries);
}

static void load_path_list(search *s, const char *list)
{
    while (list && *list) {
        size_t length = strcspn(list, ":");
        char folder[PATH_MAX];
        if (length > 0 && length < sizeof folder) {
            memcpy(folder, list, length);
            folder[length] = '\0';
            load_folder(s, folder, NULL);
        }
        list += length + (list[length] == ':');
    }
}

static void load_everything(search *s)
{
    static const char *const installed[] = {"../lib/talus", "../../talus", "talus"};
    char own[PATH_MAX], here[PATH_MAX], folder[PATH_MAX + 64], plain[PATH_MAX];
    load_path_list(s, getenv("TALUS_PLUGIN_PATH"));
    errno = 0;
    if (!own_file(own)) {
        s->short_of_memory |= errno == ENOMEM;
        return;
    }
    snprintf(here, sizeof here, "%.*s", (int)(strrchr(own, '/') - own), own);
    snprintf(folder, sizeof folder, "%s/plugins", here);
    load_folder(s, folder, own);
    for (size_t i = 0; i < sizeof installed / sizeof *installed; i++) {
        snprintf(folder, sizeof folder, "%s/%s/plugins-%u", here, installed[i], TL_ABI_MAJOR);
        /* Without the "..", as a user would write it. */
        if (plain_path(s, folder, plain))
            load_folder(s, plain, own);
    }
}

tl_status tl_plugins_load_default(void)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static bool begun, done;
    pthread_mutex_lock(&lock);
    if (!done) {
        search s = {.again = begun};
        begun = true;
        load_everything(&s);
        done = !s.short_of_memory;
    }
    tl_status status = done ? TL_OK : TL_E_MEMORY;
    pthread_mutex_unlock(&lock);
    return status;
}
