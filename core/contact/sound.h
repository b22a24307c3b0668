/* sound.h - whether a detection that was read from a file fits together. */
#ifndef TL_CONTACT_SOUND_H
#define TL_CONTACT_SOUND_H

#include "contact/detection.h"
#include "model/model.h"

/* What is wrong with the detection, whose lists of contacts by block are not made yet; NULL: it fits together and the
 * model. All numbers of rows, faces, lanes and states are then those of things that are there. `used` has
 * d->press_count zeros. */
const char *tl_detect_unsound(const tl_model *m, const tl_detect *d, unsigned char *used);

#endif
