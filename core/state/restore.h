/* restore.h - a model from an archive in memory. */
#ifndef TL_STATE_RESTORE_H
#define TL_STATE_RESTORE_H

#include "cycle/cycle_data.h"
#include "model/model.h"
#include "state/archive.h"

/* Makes a model of the bytes of a saved one (state/save.h), which it frees: *bytes becomes NULL. */
tl_status tl_model_of_bytes(unsigned char **bytes, size_t length, tl_model **model, tl_error *error);
tl_status tl_model_restore_archive(const tl_archive *archive, int64_t threads, tl_drive_again_fn again, void *user,
                                   tl_model **model, tl_error *error);

#endif
