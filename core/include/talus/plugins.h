/* talus/plugins.h - the plugins of this process: loading them, finding their kinds, what became of each file.
 *
 * They stay loaded to the end of the process, so pointers to kinds are valid for ever. All functions may be called
 * from any thread. */
#ifndef TALUS_PLUGINS_H
#define TALUS_PLUGINS_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Loads the plugins found in TALUS_PLUGIN_PATH, beside the library and in the installed place. Done once a process;
 * later calls do nothing. Refused files are kept with their reasons. TL_E_MEMORY: some could not be loaded for want of
 * memory; the next call tries them again. */
TL_API tl_status tl_plugins_load_default(void);
/* Loads one shared object. */
TL_API tl_status tl_plugin_load(const char *path, tl_error *error);
/* From now on a crash inside a plugin names it on the standard error before the process ends by the same signal. For
 * programs: it handles SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT, which a library must leave to the program it is
 * in. */
TL_API void tl_plugin_name_crashes(void);
/* The loaded kinds of one type, in the order loaded; index past the end gives NULL. */
TL_API const tl_kind *tl_plugin_kind(tl_kind_type type, size_t index);
/* The kind of that name, or NULL. */
TL_API const tl_kind *tl_plugin_find(tl_kind_type type, const char *name);
/* The plugin that a loaded kind is of and, unless `path` is NULL, its file; NULL of any other kind. Takes no lock. */
TL_API const tl_plugin *tl_plugin_of(const tl_kind *kind, const char **path);

typedef struct tl_plugin_record {
    const char *path;
    const tl_plugin *plugin; /* NULL when refused */
    const char *reason;      /* why it was refused, NULL when loaded */
    const char *note;        /* what else there is to say of the file or folder, or NULL */
} tl_plugin_record;

/* What was loaded and what was refused, in the order tried; with neither plugin nor reason, a note on a folder. */
TL_API size_t tl_plugin_record_count(void);
/* Record `index`, below tl_plugin_record_count; its texts last as long as the process. */
TL_API tl_plugin_record tl_plugin_record_at(size_t index);

/* Finds a file of Talus's own library of scripts ("talus/plot.lua"): beside a build, or in share/lua/5.4 of an
 * installed Talus, wherever it was moved to. TL_E_NOT_FOUND when there is none, TL_E_PLUGIN when others could have put
 * it there. */
TL_API tl_status tl_library_find(const char *file, char *path, size_t size, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
