/* together.h - what the elements of one call do together. */
#ifndef TL_ELEMENT_TOGETHER_H
#define TL_ELEMENT_TOGETHER_H

#include "element/elements.h"

/* Whether some kind has to do something in the next step. */
bool tl_elements_together_due(const tl_model *m);
/* Asks the kinds of the elements in rows from `first` on: of those that are due in the next step, or of all. */
tl_status tl_elements_together(tl_model *m, size_t first, bool due);

#endif
