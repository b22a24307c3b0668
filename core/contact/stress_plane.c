/* stress_plane.c - the stresses between old contact points: the plane fitted through theirs, within their range. */
#include "contact/stress_plane.h"

#include <talus/vmath.h>

/* How far the shear stress among some values is from the mean. */
static double shear_off(const tl_stress_plane *fit, const double *value)
{
    double x = value[TL_STRESS_SHEAR] - fit->mean[TL_STRESS_SHEAR];
    double y = value[TL_STRESS_SHEAR + 1] - fit->mean[TL_STRESS_SHEAR + 1];
    double z = value[TL_STRESS_SHEAR + 2] - fit->mean[TL_STRESS_SHEAR + 2];
    return sqrt(x * x + y * y + z * z);
}

void tl_stress_values(const tl_old_point *o, double *value)
{
    value[TL_STRESS_SHEAR] = o->shear.x;
    value[TL_STRESS_SHEAR + 1] = o->shear.y;
    value[TL_STRESS_SHEAR + 2] = o->shear.z;
    value[TL_STRESS_NORMAL] = o->f_n;
    for (int k = 0; k < TL_SCALAR_COUNT; k++)
        value[TL_STRESS_SCALARS + k] = tl_old_scalar(o, k);
}

tl_stress_plane tl_stress_plane_of(const tl_old_point *old, size_t count, double area,
                                   tl_vec3 centre, tl_vec3 normal, double place)
{
    tl_stress_plane fit = {.centre = centre, .t1 = tl_v3_perpendicular(normal)};
    fit.t2 = tl_v3_cross(normal, fit.t1);
    double i11 = 0, i12 = 0, i22 = 0, value[TL_STRESS_COUNT];
    for (int k = 0; k < TL_STRESS_COUNT; k++) {
        fit.low[k] = INFINITY;
        fit.high[k] = -INFINITY;
    }
    for (size_t i = 0; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(old[i].arm, centre);
        double a = old[i].area / area, x = tl_v3_dot(arm, fit.t1), y = tl_v3_dot(arm, fit.t2);
        i11 += a * x * x;
        i12 += a * x * y;
        i22 += a * y * y;
        tl_stress_values(&old[i], value);
        for (int k = 0; k < TL_STRESS_COUNT; k++) {
            fit.mean[k] += a * value[k];
            fit.along1[k] += a * value[k] * x;
            fit.along2[k] += a * value[k] * y;
            fit.low[k] = fmin(fit.low[k], value[k]);
            fit.high[k] = fmax(fit.high[k], value[k]);
        }
    }
    for (size_t i = 0; i < count; i++) {
        tl_stress_values(&old[i], value);
        fit.spread = fmax(fit.spread, shear_off(&fit, value));
    }
    double det = tl_points_span(i11, i12, i22, 1, place);
    fit.made = det > 0;
    for (int k = 0; k < TL_STRESS_COUNT && fit.made; k++) {
        double m1 = fit.along1[k], m2 = fit.along2[k];
        fit.along1[k] = (m1 * i22 - m2 * i12) / det;
        fit.along2[k] = (m2 * i11 - m1 * i12) / det;
    }
    return fit;
}

/* The plane's stresses at an arm. */
static void on_plane(const tl_stress_plane *fit, tl_vec3 arm, double *value)
{
    tl_vec3 d = tl_v3_sub(arm, fit->centre);
    double x = tl_v3_dot(d, fit->t1), y = tl_v3_dot(d, fit->t2);
    for (int k = 0; k < TL_STRESS_COUNT; k++)
        value[k] = fit->mean[k] + x * fit->along1[k] + y * fit->along2[k];
}

/* Brings stresses into the range of the old ones. */
static void limit(const tl_stress_plane *fit, double *value)
{
    for (int k = TL_STRESS_NORMAL; k < TL_STRESS_COUNT; k++)
        value[k] = fmin(fit->high[k], fmax(fit->low[k], value[k]));
    double off = shear_off(fit, value), part = off > fit->spread ? fit->spread / off : 1;
    for (int k = TL_STRESS_SHEAR; k < TL_STRESS_NORMAL; k++)
        value[k] = fit->mean[k] + part * (value[k] - fit->mean[k]);
}

void tl_stress_at(const tl_stress_plane *fit, tl_vec3 arm, const tl_old_point *o, bool near,
                  double *value)
{
    double own[TL_STRESS_COUNT], plane[TL_STRESS_COUNT];
    tl_stress_values(o, value);
    if (!fit->made)
        return;
    tl_stress_values(o, own);
    on_plane(fit, arm, value);
    on_plane(fit, o->arm, plane);
    for (int k = 0; near && k < TL_STRESS_COUNT; k++)
        value[k] += own[k] - plane[k];
    limit(fit, value);
}
