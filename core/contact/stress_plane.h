/* stress_plane.h - the stresses between old contact points (stress_plane.c). */
#ifndef TL_CONTACT_STRESS_PLANE_H
#define TL_CONTACT_STRESS_PLANE_H

#include "contact/old_point.h"

/* What is fitted: shear stress, normal stress, and the scalars. */
enum {
    TL_STRESS_SHEAR,
    TL_STRESS_NORMAL = 3,
    TL_STRESS_SCALARS,
    TL_STRESS_COUNT = TL_STRESS_SCALARS + TL_SCALAR_COUNT
};

/* Area-weighted plane through the old points' stresses, and their range, which bounds it. */
typedef struct tl_stress_plane {
    bool made; /* false: the old points lie on a line */
    tl_vec3 centre, t1, t2;
    double mean[TL_STRESS_COUNT], along1[TL_STRESS_COUNT], along2[TL_STRESS_COUNT];
    double low[TL_STRESS_COUNT], high[TL_STRESS_COUNT];
    double
        spread; /* largest deviation of a shear stress from the mean: bounds of components would hang on the axes */
} tl_stress_plane;

/* Whether points span a plane, by the second moments of their areas about their centre: det of the moments, or 0 when
 * they lie within about `place` of a line through it, where slopes would be quotients of rounding. */
static inline double tl_points_span(double i11, double i12, double i22, double area, double place)
{
    double sum = i11 + i22, det = i11 * i22 - i12 * i12;
    return det > area * place * place * sum ? det : 0;
}

/* Of old points with this area, centre and normal, in all; points within about `place` of a line have none. */
tl_stress_plane tl_stress_plane_of(const tl_old_point *old, size_t count, double area,
                                   tl_vec3 centre, tl_vec3 normal, double place);
/* The stresses of an old point: [TL_STRESS_COUNT]. */
void tl_stress_values(const tl_old_point *old, double *value);
/* The stresses at an arm between the old points; those of `old` when there is no plane. `near`: with what those of `old`, the nearest,
 * are off the plane. */
void tl_stress_at(const tl_stress_plane *plane, tl_vec3 arm, const tl_old_point *old, bool near,
                  double *value);

#endif
