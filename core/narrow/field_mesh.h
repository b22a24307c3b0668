/* field_mesh.h - the polygons of a pressure field at one place, by the planes that make their corners, and what they
 * are at another. */
#ifndef TL_NARROW_FIELD_MESH_H
#define TL_NARROW_FIELD_MESH_H

#include "narrow/field_sums.h"

/* The integrals over the polygons of the mesh that is known of some faces; false: there is none, or they are others
 * now. The volume and its gradients are not found where only the energy is wanted. */
bool tl_mesh_integrate(const tl_field_faces *faces, tl_field_sums *sums);

#endif
