/* vtk_blocks.h - the blocks of a frame, and a section of them. */
#ifndef TL_IO_VTK_BLOCKS_H
#define TL_IO_VTK_BLOCKS_H

#include "io/pieces.h"

#include <talus/output.h>

tl_status tl_vtk_blocks(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
/* The polygons in which a plane, relative to the model's origin, cuts the blocks. */
tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out);

#endif
