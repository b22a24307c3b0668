/* failing.h - watches for steady failure in a run of steps. */
#ifndef TL_CYCLE_FAILING_H
#define TL_CYCLE_FAILING_H

#include "model/model.h"

typedef struct tl_watch tl_watch;

/* A body, how far it has gone since the run began, m, and that over its size; TL_NO_ROW: none. */
typedef struct tl_gone {
    uint32_t body;
    double way, share;
} tl_gone;

/* A watch of the bodies that there are; NULL: out of memory. */
tl_watch *tl_watch_begin(const tl_model *m);
void tl_watch_end(tl_watch *w);
/* After each step; gives the id of the block that fails steadily, or 0. */
tl_id tl_watch_step(tl_watch *w, const tl_model *m);
/* Keeps the blocks that fail with the one found, how much rock that is, and where it goes. */
tl_status tl_watch_list(const tl_watch *w, tl_model *m);
/* Of the bodies that touched something when the run began, the one that has gone the farthest over its size.
 * `gone`: so far that it has failed and come to rest elsewhere. `moved`: by more than a hundredth of its size. */
tl_gone tl_watch_gone(const tl_watch *w, const tl_model *m);
tl_gone tl_watch_moved(const tl_watch *w, const tl_model *m);
/* Free blocks on end across the model, and how far it may settle as its contacts and zones are loaded now, m. */
double tl_watch_on_end(const tl_watch *w);
double tl_watch_settlement(const tl_watch *w, const tl_model *m);

#endif
