/* plugin.c - the plugin of the generators "prism" and "profile". */
#include "prism.h"

#include <talus/version.h>

static tl_kind kinds[2];

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = TL_ABI_MINOR,
    .id = "talus.prism",
    .version = TALUS_VERSION,
    .doc = "Generators of prisms and of sections moved across their plane.",
    .licence = "BSD-3-Clause",
    .kinds = kinds,
    .kind_count = 2,
    .kind_stride = sizeof kinds[0],
};

TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)
{
    (void)host_minor;
    kinds[0] = prism_kind;
    kinds[1] = profile_kind;
    return host_major == TL_ABI_MAJOR ? &plugin : NULL;
}
