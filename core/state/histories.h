/* histories.h - histories of a copied or restored model. */
#ifndef TL_STATE_HISTORIES_H
#define TL_STATE_HISTORIES_H

#include "model/model.h"
#include "state/archive.h"

/* Adds them, if there are any; false when out of memory. */
bool tl_histories_save(const tl_model *m, tl_archive_writer *w);
/* The histories of a file, with all their samples; a file may have none. */
tl_status tl_histories_restore(tl_model *m, const tl_archive *archive);
tl_status tl_histories_copy(tl_model *to, const tl_model *from);

#endif
