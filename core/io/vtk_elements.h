/* vtk_elements.h - the elements of a frame. */
#ifndef TL_IO_VTK_ELEMENTS_H
#define TL_IO_VTK_ELEMENTS_H

#include "io/pieces.h"

#include <talus/output.h>

/* Writes them as an unstructured grid. */
tl_status tl_vtk_elements(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);

#endif
