/* asked.h - contacts found for somebody who asks between edits (asked.c). */
#ifndef TL_DETECT_ASKED_H
#define TL_DETECT_ASKED_H

#include "model/model.h"

/* Before contacts are found for somebody who asks: from here on they are found in a copy, if what is found now could be seen in a
 * later step. TL_E_MEMORY: nothing has changed. */
tl_status tl_asked_begin(tl_model *m);
/* Before contacts are found for a step, or for what is put on them: from those of the last step. */
void tl_asked_end(tl_model *m);

#endif
