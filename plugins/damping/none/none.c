/* none.c - damping "none": takes no energy out. The motion is that of the undamped equations. */
#include <talus/plugin.h>
#include <talus/version.h>

/* The host has preset every output to zero, which is what this damping gives. */
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
    .size = sizeof ops, .update = update, .step_factor = step_factor, .never_fails = true};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_DAMPING,
    .name = "none",
    .doc = "No damping.",
    .ops = &ops,
};

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = TL_ABI_MINOR,
    .id = "talus.none",
    .version = TALUS_VERSION,
    .doc = "The absence of damping.",
    .licence = "BSD-3-Clause",
    .kinds = &kind,
    .kind_count = 1,
    .kind_stride = sizeof kind,
};

TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)
{
    (void)host_minor;
    return host_major == TL_ABI_MAJOR ? &plugin : NULL;
}
