/* vtk_arrays.h - arrays of a legacy VTK file. */
#ifndef TL_MESH_VTK_ARRAYS_H
#define TL_MESH_VTK_ARRAYS_H

#include "mesh/vtk_numbers.h"

/* Reads what begins with a word, which is not of the grid itself: an array, or what comes before some. */
tl_status tl_vtk_read_array(tl_vtk *v, const char *word);

#endif
