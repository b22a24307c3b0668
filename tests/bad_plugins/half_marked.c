/* half_marked.c - a law of Coulomb whose angle of friction is marked as if it were a stress: divided strengths are wrong. */
#include <talus/kit.h>

typedef struct params {
    double kn, ks, friction;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM(TL_PARAM_REAL, params, friction, "deg", "angle of friction", .def = {60}, .min = 0, .max = 80,
             .flags = TL_PARAM_STRENGTH),
};

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    const double tangent = tl_tan(p->friction * TL_DEGREE);
    for (uint32_t i = 0; i < batch->count; i++) {
        const double normal = fmax(0, p->kn * batch->area[i] * batch->closure[i] + batch->f_n0[i]);
        double f[3], size = 0;
        for (int k = 0; k < 3; k++) {
            f[k] = batch->f_s[k][i] - p->ks * batch->area[i] * batch->du_s[k][i];
            size += f[k] * f[k];
        }
        size = sqrt(size);
        const double limit = normal * tangent, scale = size > limit ? limit / size : 1;
        batch->f_n[i] = normal;
        for (int k = 0; k < 3; k++)
            batch->f_s[k][i] = scale * f[k];
        batch->flags[i] = scale < 1 ? TL_POINT_SLIPPING : 0;
        if (batch->stored)
            batch->stored[i] = batch->dissipated[i] = 0;
    }
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    *kn = ((const params *)self)->kn;
    *ks = ((const params *)self)->ks;
}

static const tl_law_ops ops = {.size = sizeof ops, .update = update, .stiffness = stiffness};

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "half_marked", .doc = "An angle marked as a stress.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "bad.half_marked", .version = "1.0", .doc = "A law with a wrong mark.",
          .licence = "BSD-3-Clause");
