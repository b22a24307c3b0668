/* surfaces.h - the surfaces of blocks in files that other programs read. */
#ifndef TL_IO_SURFACES_H
#define TL_IO_SURFACES_H

#include "base/output_file.h"
#include "model/model.h"

typedef enum tl_surface_format {
    TL_SURFACES_NONE,
    TL_SURFACES_OBJ,
    TL_SURFACES_STL,
    TL_SURFACES_PLY,
    TL_SURFACES_VTK
} tl_surface_format;

/* The format that the ending of a file's name asks for: .obj, .stl, .ply or .vtk. */
tl_surface_format tl_surface_format_of(const char *path);
/* Writes all blocks. */
tl_status tl_surfaces_write(tl_output *output, tl_model *m, tl_surface_format format);

#endif
