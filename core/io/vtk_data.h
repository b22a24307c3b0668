/* vtk_data.h - the files of a frame: what is in each is described at the head of its source.
 *
 * Each function writes one file, that of `out`. TL_OK says that the model could be asked for all of it;
 * whether the disk took it, the stream tells. */
#ifndef TL_IO_VTK_DATA_H
#define TL_IO_VTK_DATA_H

#include "io/pieces.h"

#include <talus/output.h>

tl_status tl_vtk_blocks(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
tl_status tl_vtk_contacts(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
tl_status tl_vtk_joints(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
/* The section of the blocks by the plane, relative to the model's origin. */
tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out);

#endif
