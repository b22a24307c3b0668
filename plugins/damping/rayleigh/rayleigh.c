/* rayleigh.c - damping "rayleigh": in proportion to mass and to the stiffness of contacts, as given by two frequencies.
 *
 *     m v' + alpha m v + beta K v + K u = F
 *
 * A motion of circular frequency w has the fraction of critical damping alpha / (2 w) + beta w / 2. It is `ratio` at
 * both frequencies w1 and w2, and between them less, at the least (alpha beta)^(1/2):
 *
 *     alpha = 2 ratio w1 w2 / (w1 + w2),    beta = 2 ratio / (w1 + w2)
 *
 * The host integrates alpha as of "viscous" and adds beta K v at contacts. Source: Rayleigh, Theory of Sound (1877).
 * Of contacts alone the stable step is shorter by (1 + l^2)^(1/2) - l, l = beta w / 2 of the fastest motion
 * (Belytschko 1983). What beta leaves alone shortens it no more than without damping. */
#include <talus/kit.h>
#include <talus/version.h>

/* Constant: pi. */
#define PI 3.14159265358979323846

typedef struct params {
    double ratio, from, to;
} params;

typedef struct factors {
    double alpha, beta; /* 1/s, s */
} factors;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, ratio, "", "fraction of critical damping at both frequencies",
             .flags = TL_PARAM_REQUIRED, .min = 0, .max = 1),
    TL_PARAM_POSITIVE(params, from, "Hz", "the lower frequency"),
    TL_PARAM_POSITIVE(params, to, "Hz", "the higher frequency"),
};

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (!(p->from <= p->to))
        return tl_refuse(report, "from = %g Hz is above to = %g Hz: give the lower frequency first", p->from, p->to);
    factors *f = malloc(sizeof *f);
    if (!f)
        return TL_E_MEMORY;
    const double sum = 2 * PI * (p->from + p->to);
    f->alpha = 2 * p->ratio * (2 * PI * p->from) * (2 * PI * p->to) / sum;
    f->beta = 2 * p->ratio / sum;
    *self = f;
    return TL_OK;
}

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)report;
    const factors *f = self;
    for (uint32_t i = 0; i < batch->count; i++)
        batch->alpha[i] = f->alpha;
    return TL_OK;
}

static void contact(const void *self, double *beta)
{
    *beta = ((const factors *)self)->beta;
}

static const tl_damping_ops ops =
    TL_DAMPING_OPS(.create = create, .destroy = free, .step_factor = tl_step_factor_one, .contact = contact);

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "rayleigh",
            .doc = "A fraction of critical damping at two frequencies, by mass and by the stiffness of contacts.",
            TL_KIND_PARAMS(params, param_table));

/* Older hosts would leave out the part of the contacts. */
TL_PLUGIN_SINCE(14, kind, .id = "talus.rayleigh", .version = TALUS_VERSION, .doc = "Rayleigh damping.",
                .licence = "BSD-3-Clause");
