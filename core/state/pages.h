/* pages.h - the pages written so far, in an archive (pages.c). */
#ifndef TL_STATE_PAGES_H
#define TL_STATE_PAGES_H

#include "model/model.h"
#include "state/archive.h"

/* Adds them. */
void tl_pages_save(const tl_model *m, tl_archive_writer *w);
/* Goes on with them where the saved model was, as far as their files still are as they were then. */
tl_status tl_pages_restore(tl_model *m, const tl_archive *archive);

#endif
