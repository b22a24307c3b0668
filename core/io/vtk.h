/* vtk.h - a frame for ParaView. */
#ifndef TL_IO_VTK_H
#define TL_IO_VTK_H

#include "base/output_file.h"
#include "state/outputs.h"

/* A change of an index on its way: an entry that goes into the room it has, or the whole of it anew. */
typedef struct tl_vtk_index_change {
    tl_output whole;
    tl_vtk_index *index; /* as it is */
    tl_vtk_index next;   /* as it will be */
    char *path, *entry;
    size_t length; /* of the entry */
    off_t at;      /* where it goes */
    int file;      /* descriptor to write it to; 0: the whole is written anew */
} tl_vtk_index_change;

/* Name of a file of the series: PREFIX_CONTENT_NNNNNN.vtk. The text is the caller's; NULL when out of memory. */
/* Frees; what is not committed is dropped. Does nothing to a zeroed or dropped change. */

#endif
