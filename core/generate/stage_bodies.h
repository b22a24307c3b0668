/* stage_bodies.h - bodies of staged blocks. */
#ifndef TL_GENERATE_STAGE_BODIES_H
#define TL_GENERATE_STAGE_BODIES_H

#include "generate/staging.h"

/* Takes blocks out of their bodies: those that hang together over faces without a new joint are one
 * body, and so is what is left. */
void tl_stage_part(tl_stage *stage, const size_t *indices, size_t count);
/* Makes one body of all the bodies the blocks are of. */
void tl_stage_join(tl_stage *stage, const size_t *indices, size_t count);
void tl_stage_delete(tl_stage *stage, size_t index);
/* Lists the visible blocks again from one of all on. */
void tl_stage_list_visible(tl_stage *stage, size_t from);
/* Gives every body that needs it the numbers of the parts it falls into. */
tl_status tl_stage_settle(tl_stage *stage);
/* group[row] of the rows whose blocks have the given ids, as tl_bodies_regroup wants it; `first` has room
 * for stage->next_body numbers. */
void tl_stage_groups(const tl_stage *stage, const tl_id *ids, uint32_t *first, uint32_t *group);

#endif
