/* vtk_section.h - the polygons in which a plane cuts the blocks. */
#ifndef TL_IO_VTK_SECTION_H
#define TL_IO_VTK_SECTION_H

#include "io/pieces.h"

#include <talus/output.h>

/* The section of the blocks by the plane, relative to the model's origin. */
tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out);

#endif
