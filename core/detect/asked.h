/* asked.h - contacts found for somebody who asks. */
#ifndef TL_DETECT_ASKED_H
#define TL_DETECT_ASKED_H

#include "model/model.h"

/* Before contacts are found for a query after edits: in a copy, or for the first time. TL_E_MEMORY: nothing has
 * changed. */
tl_status tl_asked_begin(tl_model *m);
/* Before contacts are found for a step, or for what is put on them: goes back to those of the last step, if any. */
void tl_asked_end(tl_model *m);
/* After a step that failed: contacts of a model that has not begun, which it has found, are those of somebody who
 * asked. Else the next edit would go on from them, and answers would depend on earlier ones. */
void tl_asked_step_failed(tl_model *m);

#endif
