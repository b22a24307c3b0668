/* save.h - a model as bytes. */
#ifndef TL_STATE_SAVE_H
#define TL_STATE_SAVE_H

#include "model/model.h"

/* What a saved file of a model would hold: *bytes, to be freed. */
tl_status tl_model_bytes(tl_model *m, unsigned char **bytes, size_t *length);

#endif
