/* sound.h - whether segments that were read from a file fit together. */
#ifndef TL_SEGMENT_SOUND_H
#define TL_SEGMENT_SOUND_H

#include "base/walk.h"
#include "segment/segments.h"

/* What is wrong with them; NULL: nothing. */
const char *tl_segments_unsound(const tl_model *m, const struct tl_segments *s);

#endif
