/* sound.h - whether elements that were read from a file fit together. */
#ifndef TL_ELEMENT_SOUND_H
#define TL_ELEMENT_SOUND_H

#include "element/elements.h"

/* What is wrong with them, or NULL. Blocks, bodies and zones have been read. */
const char *tl_elements_unsound(const tl_model *m);

#endif
