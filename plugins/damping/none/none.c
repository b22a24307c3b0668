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

TL_PLUGIN(kind, .id = "talus.none", .version = TALUS_VERSION, .doc = "The absence of damping.",
          .licence = "BSD-3-Clause");
