/* histories.h - the histories that a model keeps. */
#ifndef TL_MODEL_HISTORIES_H
#define TL_MODEL_HISTORIES_H

#include "model/model.h"

/* What of a history, beside its samples, cannot be one of this model, as a part of a sentence; NULL: nothing. */
const char *tl_history_unsound(const tl_model *m, const tl_history *h);
/* Adds a history that is sound, with room for its ids and for so many samples of its width; NULL: out of memory. */
tl_history *tl_history_hold(tl_model *m, const tl_history *what, size_t samples);

#endif
