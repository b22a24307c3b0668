/* outputs.h - the files that a model has written so far: frames of VTK files, and pages for browsers. A run that is
 * resumed goes on with the next frame, and in the same page. */
#ifndef TL_STATE_OUTPUTS_H
#define TL_STATE_OUTPUTS_H

#include "base/hash.h"
#include "model/model.h"
#include "state/part.h"

#include <sys/types.h>

/* Most files that a frame consists of. */
#define TL_VTK_PARTS 5

/* Which file of a system a file is, whatever its name. */
typedef struct tl_vtk_file_id {
    dev_t device;
    ino_t number;
} tl_vtk_file_id;

/* A .vtk.series index as it was last written. */
typedef struct tl_vtk_index {
    size_t frames; /* that it lists; 0: nothing is known of it */
    off_t place;   /* where its blank space begins, ... */
    off_t end;     /* ... and ends */
    tl_vtk_file_id written;
} tl_vtk_index;

/* The frames of one prefix and one kind of frame. A model keeps a list of these. */
typedef struct tl_vtk_series {
    struct tl_vtk_series *next;
    char *prefix;
    char *kind;
    double *times;   /* of its frames in the indices, s */
    uint32_t *parts; /* which of their files were written, bit k for number k */
    size_t count, time_capacity, part_capacity;
    size_t written[TL_VTK_PARTS]; /* frames that have the file */
    tl_vtk_index index[TL_VTK_PARTS];
} tl_vtk_series;

/* Most bytes at the end of a page that are compared. */
#define TL_PAGE_CHECKED 4096

/* How a page was left: it goes on only where it still is so. */
typedef struct tl_page_end {
    uint64_t frames;
    uint64_t at;      /* bytes in front of what ends the file */
    uint64_t checked; /* so many of these, the last ones, ... */
    tl_hash digest;   /* ... have this digest */
} tl_page_end;

/* A page that a model has written. What its reader knows is kept by who writes it. */
typedef struct tl_page {
    struct tl_page *next;
    char *prefix;
    tl_page_end end;
    bool restored; /* the page is from an archive, and no frame has been added since */
    struct tl_scene *scene;
    void (*scene_destroy)(struct tl_scene *);
} tl_page;

/* Finds or makes the series of a prefix and a kind of frame, with room for one more frame; NULL when out of memory. */
tl_vtk_series *tl_vtk_series_of(tl_model *m, const char *prefix, const char *kind);
/* Notes that the frame is written. */
void tl_vtk_series_add(tl_vtk_series *series, double time, uint32_t parts);
/* Finds or makes the page of a prefix; NULL when out of memory. */
tl_page *tl_page_of(tl_model *m, const char *prefix);

/* A copy begins without: two models do not write into the same files. A restored one goes on with its frames, and
 * with its pages as far as their files still are as they were then. */
extern const tl_state_part tl_outputs_part;

#endif
