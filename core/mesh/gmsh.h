/* gmsh.h - meshes of gmsh. */
#ifndef TL_MESH_GMSH_H
#define TL_MESH_GMSH_H

#include "mesh/filling.h"

/* Reads points, tetrahedra, keys and names of groups. */
tl_status tl_mesh_read_gmsh(tl_mesh_reading *reading);

#endif
