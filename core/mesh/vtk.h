/* vtk.h - unstructured grids of VTK's legacy format. */
#ifndef TL_MESH_VTK_H
#define TL_MESH_VTK_H

#include "mesh/filling.h"

/* Reads points, tetrahedra, keys and names of groups. */
tl_status tl_mesh_read_vtk(tl_mesh_reading *reading);

#endif
