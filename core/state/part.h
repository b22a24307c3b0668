/* part.h - a part of a saved, restored or copied model beside the entries of its modules. */
#ifndef TL_STATE_PART_H
#define TL_STATE_PART_H

#include "model/model.h"
#include "state/archive.h"

/* A part is made anew when the rows of the model are there, and the parts before it in the list (parts.h). */
typedef struct tl_state_part {
    /* Adds it to an archive, which notes that there was no memory. */
    void (*save)(const tl_model *m, tl_archive_writer *w);
    tl_status (*restore)(tl_model *m, const tl_archive *archive);
    /* NULL: a copy begins without it. */
    tl_status (*copy)(tl_model *to, const tl_model *from);
} tl_state_part;

#endif
