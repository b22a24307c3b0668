/* older_minor.c - a damping built when operations could not say that forces of the step before are read. */
#include <stddef.h>
#include <talus/plugin.h>

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static double step_factor(const void *self)
{
    (void)self;
    return 1;
}

static const tl_damping_ops ops = {
    .size = offsetof(tl_damping_ops, before), .update = update, .step_factor = step_factor};

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "older_minor", .doc = "A damping for the loader's test.");

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = 1,
    .id = "bad.older_minor",
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
