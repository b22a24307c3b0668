/* frames.h - the frames of VTK files written so far, in an archive (frames.c). */
#ifndef TL_STATE_FRAMES_H
#define TL_STATE_FRAMES_H

#include "model/model.h"
#include "state/archive.h"

/* Adds them; false when out of memory. */
bool tl_frames_save(const tl_model *m, tl_archive_writer *w);
/* Goes on counting them where the saved model was. */
tl_status tl_frames_restore(tl_model *m, const tl_archive *archive);

#endif
