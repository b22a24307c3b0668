/* moved_face.h - a polyhedron with one face in another plane. */
#ifndef TL_GEOMETRY_MOVED_FACE_H
#define TL_GEOMETRY_MOVED_FACE_H

#include "geometry/polyhedron.h"

/* A copy of a polyhedron with a face in a plane near that of the face. All vertices lie behind the plane. Faces keep
 * their numbers. Adds to *way, if it is more, how far a vertex has moved. NULL: out of memory. */
tl_poly *tl_poly_move_face(const tl_poly *poly, uint32_t face, tl_plane plane, double *way);

#endif
