/* vtk_joints.h - the joints of a frame. */
#ifndef TL_IO_VTK_JOINTS_H
#define TL_IO_VTK_JOINTS_H

#include "io/pieces.h"

#include <talus/output.h>

tl_status tl_vtk_joints(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);

#endif
