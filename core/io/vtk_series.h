/* vtk_series.h - which frames a model has written under which prefix. */
#ifndef TL_IO_VTK_SERIES_H
#define TL_IO_VTK_SERIES_H

#include "model/model.h"

#include <sys/types.h>

/* Most files that a frame consists of. */
#define TL_VTK_PARTS 3

/* Which file of a system a file is, whatever its name. */
typedef struct tl_vtk_file_id {
    dev_t device;
    ino_t number;
} tl_vtk_file_id;

/* A .vtk.series index as it was last written: vtk_index.c. */
typedef struct tl_vtk_index {
    size_t frames; /* that it lists; 0: nothing is known of it */
    off_t place;   /* where its blank room begins, ... */
    off_t end;     /* ... and ends */
    tl_vtk_file_id written;
} tl_vtk_index;

/* A frame: its time in the indices, and which of its files were written, bit k for number k. */
typedef struct tl_vtk_frame {
    double time;
    unsigned parts;
} tl_vtk_frame;

/* The frames of one prefix and one kind of frame. A model keeps a list of these. */
typedef struct tl_vtk_series {
    struct tl_vtk_series *next;
    char *prefix;
    char *kind;
    tl_vtk_frame *frames;
    size_t count, capacity;
    size_t written[TL_VTK_PARTS]; /* frames that have the file */
    tl_vtk_index index[TL_VTK_PARTS];
} tl_vtk_series;

/* Finds or makes the series of a prefix and a kind of frame, with room for one more frame; NULL when out of memory. */
tl_vtk_series *tl_vtk_series_of(tl_model *m, const char *prefix, const char *kind);

/* Name of a file of the series: PREFIX_CONTENT_NNNNNN.vtk, and of its index:
 * PREFIX_CONTENT.vtk.series. The text is the caller's; NULL when out of memory. */
char *tl_vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame);
char *tl_vtk_index_name(const tl_vtk_series *series, const char *content);

/* The time under which the next frame is listed: that of the model, or a little more than that of the frame before. Readers take
 * frames of one time for one frame, so stages without a step between them would not be seen. */
double tl_vtk_series_time(const tl_vtk_series *series, double time);
/* Notes that the frame is written. */
void tl_vtk_series_add(tl_vtk_series *series, tl_vtk_frame frame);

#endif
