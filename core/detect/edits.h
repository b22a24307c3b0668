/* edits.h - what edits of the model leave of pairs and contacts. */
#ifndef TL_DETECT_EDITS_H
#define TL_DETECT_EDITS_H

#include "model/model.h"

/* Finds the blocks of pairs and contacts again after rows have changed, and drops what was known of those that have
 * come, gone or changed: their pairs without a contact, and contacts of which a block has gone. TL_E_MEMORY: nothing
 * has changed. */
tl_status tl_edits_find_rows(tl_model *m);
/* Marks the contacts that come under another joint law, and those whose facets follow other rules than they did. After
 * changes of `rows` makes anew what contacts keep in the frames of bodies, before anything is computed from it. */
void tl_edits_follow(tl_model *m, bool rows);

#endif
