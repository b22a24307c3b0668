/* dashpot.c - damping "dashpot": dashpots at contacts, in proportion to their stiffness. Nothing else is damped.
 *
 *     f = beta k A du / dt       at closed points that do not slip, normal and along the face
 *
 * A motion of frequency f in Hz has the fraction beta pi f of critical damping. So `ratio` at a `frequency` gives
 *
 *     beta = ratio / (pi frequency)
 *
 * What falls freely, slides, or turns about an edge is hardly damped. Impacts are, where `frequency` is that of the
 * block on its contact, (k A / m)^(1/2) / (2 pi). */
#include <talus/kit.h>
#include <talus/version.h>

/* Constant: pi. */
#define PI 3.14159265358979323846

typedef struct params {
    double ratio, frequency;
} params;

static const tl_param param_table[] = {
    TL_PARAM_POSITIVE(params, ratio, "", "fraction of critical damping of a motion of the frequency"),
    TL_PARAM_POSITIVE(params, frequency, "Hz",
                      "of the block on its contact, of a wall, or of what else is to be damped"),
};

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)self, (void)batch, (void)report;
    return TL_OK;
}

static void contact(const void *self, double *beta)
{
    const params *p = self;
    *beta = p->ratio / (PI * p->frequency);
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = tl_step_factor_one, .contact = contact);

static const tl_kind kind = TL_KIND(TL_KIND_DAMPING, ops, .name = "dashpot",
                                    .doc = "Dashpots at contacts, in proportion to their stiffness; for impacts.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(14, kind, .id = "talus.dashpot", .version = TALUS_VERSION, .doc = "Damping of contacts.",
                .licence = "BSD-3-Clause");
