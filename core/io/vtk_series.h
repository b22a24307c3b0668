/* vtk_series.h - the names of frames' files, and the index that lists them. */
#ifndef TL_IO_VTK_SERIES_H
#define TL_IO_VTK_SERIES_H

#include "base/output_file.h"
#include "io/pieces.h"
#include "state/outputs.h"

/* A change of an index on its way: an entry that goes into the space it has, or the whole of it anew. */
typedef struct tl_vtk_index_change {
    tl_output whole;
    tl_vtk_index *index; /* as it is */
    tl_vtk_index next;   /* as it will be */
    char *path;
    tl_piece entry;
    off_t at; /* where it goes */
    int file; /* descriptor to write it to; 0: the whole is written anew */
} tl_vtk_index_change;

/* Name of a file of the series: PREFIX_CONTENT_NNNNNN.vtk. The text is the caller's; NULL when out of memory. */
char *tl_vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame);
/* The time under which the next frame is listed: that of the model, or a little more than that of the frame before.
 * Readers take frames of one time for one frame, so stages without a step between them would not be seen. */
double tl_vtk_series_time(const tl_vtk_series *series, double time);
/* Makes ready what adds the next frame, at `time`, to the index of `content`, number `part` of the series. */
tl_status tl_vtk_index_open(tl_vtk_index_change *change, tl_vtk_series *series, size_t part, const char *content,
                            double time, tl_error *error);
tl_status tl_vtk_index_commit(tl_vtk_index_change *change, tl_error *error);
/* Frees; what is not committed is dropped. Does nothing to a zeroed or dropped change. */
void tl_vtk_index_drop(tl_vtk_index_change *change);

#endif
