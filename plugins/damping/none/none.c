/* none.c - damping "none": takes no energy out. The motion is that of the undamped equations. */
#include <talus/kit.h>
#include <talus/version.h>

/* The host has preset every output to zero, which is what this damping gives. */
static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = tl_step_factor_one);

static const tl_kind kind = TL_KIND(TL_KIND_DAMPING, ops, .name = "none", .doc = "No damping.");

TL_PLUGIN(kind, .id = "talus.none", .version = TALUS_VERSION, .doc = "The absence of damping.",
          .licence = "BSD-3-Clause");
