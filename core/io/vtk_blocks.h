/* vtk_blocks.h - the blocks of a frame. */
#ifndef TL_IO_VTK_BLOCKS_H
#define TL_IO_VTK_BLOCKS_H

#include "io/pieces.h"

#include <talus/output.h>

tl_status tl_vtk_blocks(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);

#endif
