/* kinds.h - laws and damping in an archive: of which plugin, with which parameters and states, by their names. */
#ifndef TL_STATE_KINDS_H
#define TL_STATE_KINDS_H

#include "model/model.h"
#include "state/archive.h"

void tl_laws_save(const tl_model *m, tl_archive_writer *w);
void tl_damping_save(const tl_model *m, tl_archive_writer *w);

/* Make them anew. TL_E_NOT_FOUND: a plugin is not loaded; TL_E_STATE: it is there in another version. */
tl_status tl_laws_restore(tl_model *m, const tl_archive *archive);
tl_status tl_damping_restore(tl_model *m, const tl_archive *archive);

#endif
