/* registry.c - the loaded plugins, their kinds by name, and the record of every attempt to load one. */
#include "plugin/registry.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

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

/* The record whose plugin offers this kind, or NULL; the lock is held. */
static const record *provider(uint32_t type, const char *name, const tl_kind **kind)
{
    for (const record *r = first_record(); r; r = next_record(r)) {
        const tl_plugin *plugin = r->plugin;
        for (uint32_t k = 0; plugin && k < plugin->kind_count; k++) {
            if (plugin->kinds[k].type == type && strcmp(plugin->kinds[k].name, name) == 0) {
                *kind = &plugin->kinds[k];
                return r;
            }
        }
    }
    return NULL;
}

const tl_plugin *tl_plugin_of(const tl_kind *kind, const char **path)
{
    for (const record *r = first_record(); r; r = next_record(r)) {
        const tl_plugin *plugin = r->plugin;
        for (uint32_t k = 0; plugin && k < plugin->kind_count; k++) {
            if (&plugin->kinds[k] == kind) {
                if (path)
                    *path = r->path;
                return plugin;
            }
        }
    }
    return NULL;
}

static tl_status check_new(const tl_plugin *plugin, tl_error *error)
{
    for (const record *r = first_record(); r; r = next_record(r))
        if (r->plugin && strcmp(r->plugin->id, plugin->id) == 0)
            return tl_fail(error, TL_E_PLUGIN, "plugin '%s' is already loaded from %s", plugin->id,
                           r->path);
    for (uint32_t k = 0; k < plugin->kind_count; k++) {
        const tl_kind *mine = &plugin->kinds[k], *theirs;
        const record *other = provider(mine->type, mine->name, &theirs);
        if (other)
            return tl_fail(error, TL_E_PLUGIN, "%s '%s' is already provided by plugin '%s' from %s",
                           tl_kind_type_name(mine->type), mine->name, other->plugin->id,
                           other->path);
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

static bool append_locked(const char *path, const char *reason, const char *note)
{
    pthread_mutex_lock(&registry.lock);
    bool done = append(path, reason, note, NULL);
    pthread_mutex_unlock(&registry.lock);
    return done;
}

bool tl_registry_refused(const char *path, const char *reason)
{
    return append_locked(path, reason, NULL);
}

bool tl_registry_noted(const char *path, const char *note)
{
    return append_locked(path, NULL, note);
}

bool tl_registry_has(const char *path)
{
    for (const record *r = first_record(); r; r = next_record(r))
        if (strcmp(r->path, path) == 0)
            return true;
    return false;
}

const tl_kind *tl_plugin_kind(tl_kind_type type, size_t index)
{
    const tl_kind *found = NULL;
    pthread_mutex_lock(&registry.lock);
    for (const record *r = first_record(); r && !found; r = next_record(r))
        for (uint32_t k = 0; r->plugin && k < r->plugin->kind_count && !found; k++)
            if (r->plugin->kinds[k].type == (uint32_t)type && index-- == 0)
                found = &r->plugin->kinds[k];
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
