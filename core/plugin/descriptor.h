/* descriptor.h - what a plugin says of itself: checked, and in the shape that this host knows. */
#ifndef TL_PLUGIN_DESCRIPTOR_H
#define TL_PLUGIN_DESCRIPTOR_H

#include <talus/plugins.h>

/* Room for a note on a plugin that was taken in. */
#define TL_NOTE_TEXT 256

/* Checks a plugin's descriptor, which is one of this major version, and copies it into the host's own shape: every
 * struct at its full size, arrays dense, members the plugin's headers did not have yet zero. Texts and functions stay
 * the plugin's. Kinds of a type this host does not know are left out, which the note then tells. On failure nothing is
 * left and the sentence says what is wrong. */
tl_status tl_descriptor_read(const tl_plugin *given, tl_plugin **plugin, char note[TL_NOTE_TEXT], tl_error *error);
void tl_descriptor_free(tl_plugin *plugin);

/* "law", "damping", "generator" or "screen". */
const char *tl_kind_type_name(uint32_t type);

#endif
