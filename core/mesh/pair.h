/* pair.h - which tetrahedra of a mesh hang together, and what sentences call them. */
#ifndef TL_MESH_PAIR_H
#define TL_MESH_PAIR_H

#include "base/error.h"
#include "mesh/mesh.h"

/* Corners of each side of a tetrahedron, counter-clockwise as seen from outside. */
extern const uint8_t tl_mesh_side[4][3];

/* A place in the file, for sentences: "file 'a.msh', line 7: element 12". */
#define TL_MESH_WHERE 300
const char *tl_mesh_where(const tl_mesh *mesh, uint32_t zone, char text[TL_MESH_WHERE]);
/* The corners of side 4 zone + corner. */
void tl_mesh_side_corners(const tl_mesh *mesh, uint32_t side, uint32_t corner[3]);

/* Finds the side that lies on each: side 4 zone + corner on that of another tetrahedron of the same owner, or
 * TL_MESH_NONE. Tetrahedra of the owner TL_MESH_NONE have none. TL_E_GEOMETRY: three have one side, or two lie on the
 * same side of it. `on` is [4 zone_count]. */
tl_status tl_mesh_pair(const tl_mesh *mesh, const uint32_t *owner, uint32_t *on, tl_error *error);

#endif
