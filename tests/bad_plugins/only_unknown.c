/* only_unknown.c - one kind, of a type that no host knows. */
#include "plain_law.h"

static const tl_kind kind = {
    .size = sizeof kind,
    .type = 23,
    .name = "only_unknown",
    .doc = "A law for the loader's test.",
    .params_size = sizeof(params),
    .params = param_table,
    .param_count = sizeof param_table / sizeof *param_table,
    .param_stride = sizeof *param_table,
    .ops = &ops,
};

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = TL_ABI_MINOR,
    .id = "bad.only_unknown",
    .version = "1",
    .doc = "A plugin for the loader's test.",
    .licence = "BSD-3-Clause",
    .kinds = &kind,
    .kind_count = 1,
    .kind_stride = sizeof kind,
};

TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)
{
    (void)host_major;
    (void)host_minor;
    return &plugin;
}
