/* polar.h - the rotation in a gradient, and the quaternion of a rotation. */
#ifndef TL_GEOMETRY_POLAR_H
#define TL_GEOMETRY_POLAR_H

#include <talus/vmath.h>

double tl_m3_determinant(const tl_mat3 *a);
/* The inverse; of a matrix without one not finite. */
tl_mat3 tl_m3_inverse(const tl_mat3 *a);
/* R of F = R U, with U symmetric and positive: of an F whose determinant is positive. */
tl_mat3 tl_m3_polar(const tl_mat3 *f);
/* The quaternion of a rotation, with w >= 0. */
tl_quat tl_q_of_matrix(const tl_mat3 *r);

#endif
