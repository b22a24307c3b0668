/* registry.h - the plugins of this process: what a descriptor must hold, and where it is kept.
 *
 * The registry is the one piece of global state in Talus. It only grows: a plugin that was accepted
 * stays loaded to the end of the process, so pointers to kinds are valid for ever. */
#ifndef TL_PLUGIN_REGISTRY_H
#define TL_PLUGIN_REGISTRY_H

#include "base/error.h"

#include <limits.h>
#include <talus/talus.h>

/* ---- descriptor.c ---- */

/* Room for a note on a plugin that was taken in. */
#define TL_NOTE_TEXT 256

/* Checks a plugin's descriptor and copies it into the host's own shape: every struct at its full size,
 * arrays dense, members the plugin's headers did not have yet zero. Texts and functions stay the
 * plugin's. Kinds of a type this host does not know are left out, which the note then tells. On failure nothing is
 * left and the sentence says what is wrong. */
tl_status tl_descriptor_read(const tl_plugin *given, tl_plugin **plugin, char note[TL_NOTE_TEXT],
                             tl_error *error);
/* Fails, with both versions, where a descriptor is one of another major version, or none. */
tl_status tl_descriptor_version(const tl_plugin *given, tl_error *error);
void tl_descriptor_free(tl_plugin *plugin);

/* "law", "damping", "generator" or "screen". */
const char *tl_kind_type_name(uint32_t type);

/* ---- registry.c ---- */

/* Takes in a plugin that was read from `path`. Refused when its id, or one of its kinds, is there
 * already; it then stays the caller's. */
tl_status tl_registry_add(const char *path, tl_plugin *plugin, const char *note, tl_error *error);
/* Keeps a failed attempt and its reason for the list of records; false when out of memory. */
bool tl_registry_refused(const char *path, const char *reason);
/* Keeps a remark on a folder; false when out of memory. */
bool tl_registry_noted(const char *path, const char *note);
/* Whether there is a record of that file or folder. */
bool tl_registry_has(const char *path);

/* ---- loader.c ---- */

/* The file of the program or library that this code is in, without links; false when the system does not tell. */
bool tl_own_file(char file[PATH_MAX]);

/* ---- trust.c ---- */

/* Whether nobody but root, the user and the owner of the file `program` can have put the folder or file there;
 * otherwise `why` says who could. */
bool tl_path_is_trusted(const char *path, const char *program, char *why, size_t size);

#endif
