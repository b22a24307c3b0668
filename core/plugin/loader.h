/* loader.h - the plugins of this process: found, opened, kept. */
#ifndef TL_PLUGIN_LOADER_H
#define TL_PLUGIN_LOADER_H

#include "base/error.h"

#include <talus/talus.h>

/* Takes in a plugin that was read from `path`. Refused when its id, or one of its kinds, is there
 * already; it then stays the caller's. */
tl_status tl_registry_add(const char *path, tl_plugin *plugin, const char *note, tl_error *error);

/* TL_E_NOT_FOUND: "unknown law 'coulom'; did you mean ...". */
tl_status tl_kind_unknown(tl_error *error, tl_kind_type type, const char *name);
/* The id of the plugin that a kind is of, for sentences. */
const char *tl_plugin_id(const tl_kind *kind);

#endif
