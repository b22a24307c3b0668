/* principal.h - principal axes of a symmetric tensor. */
#ifndef TL_GEOMETRY_PRINCIPAL_H
#define TL_GEOMETRY_PRINCIPAL_H

#include <talus/types.h>

/* Eigenvalues (ascending in `moments`) and the rotation from principal axes to the given ones. The
 * identity for a diagonal tensor's own axes up to their order. */
void tl_principal_axes(tl_sym3 tensor, tl_vec3 *moments, tl_quat *axes);

#endif
