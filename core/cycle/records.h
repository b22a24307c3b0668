/* records.h - runs in which blocks follow records of motion. */
#ifndef TL_CYCLE_RECORDS_H
#define TL_CYCLE_RECORDS_H

#include "model/model.h"

/* TL_E_STATE with a sentence where a record is followed and the damping would hide what it does. */
tl_status tl_records_check(tl_model *m);
/* Says so once when the step just made is longer than those of a record. */
void tl_records_remark(tl_model *m);

#endif
