/* registry.c - the loaded plugins, their kinds by name, and the record of every attempt to load one. */
#include "plugin/registry.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

typedef struct record {
    char *path;
    char *reason;      /* NULL when loaded */
    tl_plugin *plugin; /* NULL when refused */
} record;

/* Append only; guarded by the lock, since models may live on several threads. */
static struct {
    pthread_mutex_t lock;
    record *records;
    size_t count, capacity;
} registry = {.lock = PTHREAD_MUTEX_INITIALIZER};

static bool make_room(void)
{
    if (registry.count < registry.capacity)
        return true;
    size_t capacity = registry.capacity ? 2 * registry.capacity : 32;
    record *records = realloc(registry.records, capacity * sizeof *records);
    if (!records)
        return false;
    registry.records = records;
    registry.capacity = capacity;
    return true;
}

/* Appends copies of the texts; the lock is held. */
static bool append(const char *path, const char *reason, tl_plugin *plugin)
{
    record r = {strdup(path), reason ? strdup(reason) : NULL, plugin};
    if (!r.path || (reason && !r.reason) || !make_room()) {
        free(r.path);
        free(r.reason);
        return false;
    }
    registry.records[registry.count++] = r;
    return true;
}

/* The record whose plugin offers this kind, or NULL; the lock is held. */
static const record *provider(uint32_t type, const char *name, const tl_kind **kind)
{
    for (size_t i = 0; i < registry.count; i++) {
        const tl_plugin *plugin = registry.records[i].plugin;
        for (uint32_t k = 0; plugin && k < plugin->kind_count; k++) {
            if (plugin->kinds[k].type == type && strcmp(plugin->kinds[k].name, name) == 0) {
                *kind = &plugin->kinds[k];
                return &registry.records[i];
            }
        }
    }
    return NULL;
}

static tl_status check_new(const tl_plugin *plugin, tl_error *error)
{
    for (size_t i = 0; i < registry.count; i++) {
        const tl_plugin *other = registry.records[i].plugin;
        if (other && strcmp(other->id, plugin->id) == 0)
            return tl_fail(error, TL_E_PLUGIN, "plugin '%s' is already loaded from %s", plugin->id,
                           registry.records[i].path);
    }
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

tl_status tl_registry_add(const char *path, tl_plugin *plugin, tl_error *error)
{
    pthread_mutex_lock(&registry.lock);
    tl_status status = check_new(plugin, error);
    if (status == TL_OK && !append(path, NULL, plugin))
        status = tl_fail_memory(error);
    pthread_mutex_unlock(&registry.lock);
    return status;
}

void tl_registry_refused(const char *path, const char *reason)
{
    pthread_mutex_lock(&registry.lock);
    /* Out of memory the record is lost; the caller still has the sentence. */
    (void)append(path, reason, NULL);
    pthread_mutex_unlock(&registry.lock);
}

const tl_kind *tl_plugin_kind(tl_kind_type type, size_t index)
{
    const tl_kind *found = NULL;
    pthread_mutex_lock(&registry.lock);
    for (size_t i = 0; i < registry.count && !found; i++) {
        const tl_plugin *plugin = registry.records[i].plugin;
        for (uint32_t k = 0; plugin && k < plugin->kind_count && !found; k++)
            if (plugin->kinds[k].type == (uint32_t)type && index-- == 0)
                found = &plugin->kinds[k];
    }
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
    tl_plugin_record r = {NULL, NULL, NULL};
    pthread_mutex_lock(&registry.lock);
    if (index < registry.count)
        r = (tl_plugin_record){registry.records[index].path, registry.records[index].plugin,
                               registry.records[index].reason};
    pthread_mutex_unlock(&registry.lock);
    return r;
}
