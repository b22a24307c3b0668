/* read.h - reads the tetrahedra of a file. */
#ifndef TL_MESH_READ_H
#define TL_MESH_READ_H

#include "base/error.h"
#include "mesh/mesh.h"

/* Reads a file: VTK legacy or gmsh 2.2, as it begins. TL_E_IO: it cannot be read. TL_E_GEOMETRY: it is damaged, of
 * another kind, or has no tetrahedra, flat ones, or some turned inside out. Free *mesh in any case. */
tl_status tl_mesh_read(const char *file, tl_mesh *mesh, tl_error *error);
void tl_mesh_free(tl_mesh *mesh);

#endif
