/* vtk_section.h - the section of a model by a plane. */
#ifndef TL_IO_VTK_SECTION_H
#define TL_IO_VTK_SECTION_H

#include "io/pieces.h"

/* Polygons in which a plane, relative to the model's origin, cuts the model. Rows are tidy. */
tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out);

#endif
