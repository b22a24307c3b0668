/* transverse.c - solid "transverse": elastic, with an axis n about which all directions are alike, as of a schist.
 *
 *     d sigma = lambda tr(d eps) I + 2 mu d eps + alpha ((n.d eps.n) I + tr(d eps) n n) + beta (n.d eps.n) n n
 *               + 2 (nu - mu) (n (d eps.n) + (d eps.n) n)
 *
 * (Spencer 1984). mu is the shear modulus in the plane of the layers, nu that across it. The compliance, from which the
 * stored energy follows, has the same form with constants of its own. The axis is a state: it turns with the zone. */
#include <talus/solid_kit.h>
#include <talus/version.h>

typedef struct params {
    double young_plane, young_across, poisson_plane, poisson_across, shear_across, dip, dip_direction;
} params;

static const tl_param param_table[] = {
    TL_PARAM_POSITIVE(params, young_plane, "Pa", "Young's modulus along the layers"),
    TL_PARAM_POSITIVE(params, young_across, "Pa", "Young's modulus across the layers"),
    TL_PARAM(TL_PARAM_REAL, params, poisson_plane, "", "Poisson's ratio within the layers",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .min = -1, .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, poisson_across, "",
             "strain along the layers by that across them, under a stress across them",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .min = -1, .max = 1),
    TL_PARAM_POSITIVE(params, shear_across, "Pa", "shear modulus of shear along the layers"),
    TL_PARAMS_DIP(params, "the layers"),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_AXIS, "axis", "", "unit normal of the layers"),
};

/* Constants of the form above: of the stiffness, Pa, or of the compliance, 1/Pa. */
typedef struct five {
    double volume, twice, mixed, along, across; /* lambda, 2 mu, alpha, beta, 2 (nu - mu) */
} five;

typedef struct layers {
    five stiffness, compliance;
    tl_vec3 axis;
    double constrained, shear;
} layers;

/* The five constants from components in the axes of the layers, where z is the axis: 11, 33, 12, 13 and twice 44. */
static five five_of(double c11, double c33, double c12, double c13, double twice44)
{
    five f = {.volume = c12, .twice = c11 - c12, .mixed = c13 - c12, .across = twice44 - (c11 - c12)};
    f.along = c33 - f.volume - f.twice - 2 * f.mixed - 2 * f.across;
    return f;
}

/* The larger eigenvalue of n.C.n but for pure shear, of waves whose normal n has this sine and cosine to the axis. */
static double fastest(double c11, double c33, double c13, double c44, double sine2, double cosine2)
{
    double xx = c11 * sine2 + c44 * cosine2, zz = c44 * sine2 + c33 * cosine2;
    double xz2 = (c13 + c44) * (c13 + c44) * sine2 * cosine2;
    return 0.5 * (xx + zz) + sqrt(0.25 * (xx - zz) * (xx - zz) + xz2);
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    const double e1 = p->young_plane, e3 = p->young_across, nu1 = p->poisson_plane, nu3 = p->poisson_across;
    /* the compliance is positive when this is: the energy then has a minimum */
    const double left = (1 - nu1) / e1 - 2 * nu3 * nu3 / e3;
    if (!(left > 0))
        return tl_refuse(report,
                         "these constants give a negative energy: 2 poisson_across^2 young_plane / young_across = %g "
                         "must be below 1 - poisson_plane = %g",
                         2 * nu3 * nu3 * e1 / e3, 1 - nu1);
    layers l;
    l.axis = tl_plane_normal(p->dip, p->dip_direction);
    l.compliance = five_of(1 / e1, 1 / e3, -nu1 / e1, -nu3 / e3, 0.5 / p->shear_across);
    double sum = 1 / left, difference = e1 / (1 + nu1); /* c11 + c12, c11 - c12 */
    double c11 = 0.5 * (sum + difference), c12 = 0.5 * (sum - difference);
    double c13 = nu3 / left, c33 = e3 + 2 * nu3 * c13, c44 = p->shear_across;
    l.stiffness = five_of(c11, c33, c12, c13, 2 * c44);
    l.constrained = 0;
    /* Constant: parts of a right angle. Between two of them the largest is at most a ten-thousandth more. */
    const int parts = 90;
    for (int k = 0; k <= parts; k++) {
        double sine = tl_sin_degrees(90. * k / parts), sine2 = sine * sine;
        l.constrained = fmax(l.constrained, fastest(c11, c33, c13, c44, sine2, 1 - sine2));
    }
    l.constrained *= 1.001;
    /* of the three kinds of strain without volume: shear along and within the layers, and stretching along the axis */
    l.shear = fmax(fmax(c44, 0.5 * difference), (sum - 4 * c13 + 2 * c33) / 6);
    return tl_keep(&l, sizeof l, self, report);
}

/* The six components of the form for the tensor e and the axis n. */
TL_IN_LOOP void apply(const five *f, const double n[3], const double e[6], double out[6])
{
    double x = e[0] * n[0] + e[3] * n[1] + e[5] * n[2];
    double y = e[3] * n[0] + e[1] * n[1] + e[4] * n[2];
    double z = e[5] * n[0] + e[4] * n[1] + e[2] * n[2];
    double along = x * n[0] + y * n[1] + z * n[2], sum = e[0] + e[1] + e[2];
    double volume = f->volume * sum + f->mixed * along, axial = f->mixed * sum + f->along * along;
    out[0] = volume + f->twice * e[0] + axial * n[0] * n[0] + 2 * f->across * x * n[0];
    out[1] = volume + f->twice * e[1] + axial * n[1] * n[1] + 2 * f->across * y * n[1];
    out[2] = volume + f->twice * e[2] + axial * n[2] * n[2] + 2 * f->across * z * n[2];
    out[3] = f->twice * e[3] + axial * n[0] * n[1] + f->across * (x * n[1] + y * n[0]);
    out[4] = f->twice * e[4] + axial * n[1] * n[2] + f->across * (y * n[2] + z * n[1]);
    out[5] = f->twice * e[5] + axial * n[2] * n[0] + f->across * (z * n[0] + x * n[2]);
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    const layers *l = self;
    const five compliance = l->compliance;
    for (uint32_t i = 0; i < count; i++) {
        double n[3], e[6];
        const double s[6] = {stress[0][i], stress[1][i], stress[2][i], stress[3][i], stress[4][i], stress[5][i]};
        tl_axis_at(state, 0, i, l->axis, n);
        apply(&compliance, n, s, e);
        stored[i] = 0.5 * (s[0] * e[0] + s[1] * e[1] + s[2] * e[2]) + s[3] * e[3] + s[4] * e[4] + s[5] * e[5];
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const layers *l = self;
    const five stiffness = l->stiffness;
    double *const *s = batch->stress, *const *state = batch->state;
    const double *const *d = batch->strain;
    TL_EACH_ALONE
    for (uint32_t i = 0; i < batch->count; i++) {
        double n[3], more[6];
        const double e[6] = {d[0][i], d[1][i], d[2][i], d[3][i], d[4][i], d[5][i]};
        tl_axis_at(state, 0, i, l->axis, n);
        apply(&stiffness, n, e, more);
        s[0][i] += more[0];
        s[1][i] += more[1];
        s[2][i] += more[2];
        s[3][i] += more[3];
        s[4][i] += more[4];
        s[5][i] += more[5];
        state[0][i] = n[0];
        state[1][i] = n[1];
        state[2][i] = n[2];
    }
    if (batch->stored)
        energy(self, batch->count, (const double *const *)s, state, batch->stored);
    if (batch->dissipated)
        memset(batch->dissipated, 0, batch->count * sizeof *batch->dissipated);
    for (uint32_t i = 0; i < batch->count; i++)
        batch->flags[i] = tl_zone_flags(batch->flags[i], 0);
    return TL_OK;
}

static void moduli(const void *self, double *constrained, double *shear)
{
    const layers *l = self;
    *constrained = l->constrained;
    *shear = l->shear;
}

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind =
    TL_KIND(TL_KIND_SOLID, ops, .name = "transverse", .doc = "Elastic and layered: alike in all directions of a plane.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_transverse", .version = TALUS_VERSION,
                .doc = "Transversely isotropic elastic solid.", .licence = "BSD-3-Clause");
