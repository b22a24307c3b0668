/* vtk_index.h - the .vtk.series index of one file of each frame, kept up to date frame by frame. */
#ifndef TL_IO_VTK_INDEX_H
#define TL_IO_VTK_INDEX_H

#include "io/output_file.h"
#include "io/vtk_series.h"

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

/* Makes ready what adds the next frame, at `time`, to the index of `content`, number `part` of the series. */
tl_status tl_vtk_index_open(tl_vtk_index_change *change, tl_vtk_series *series, size_t part,
                            const char *content, double time, tl_error *error);
tl_status tl_vtk_index_commit(tl_vtk_index_change *change, tl_error *error);
/* Frees; what is not committed is dropped. Does nothing to a zeroed or dropped change. */
void tl_vtk_index_drop(tl_vtk_index_change *change);

#endif
