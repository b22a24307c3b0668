/* broad.h - pairs of blocks whose inflated bounds overlap. */
#ifndef TL_DETECT_BROAD_H
#define TL_DETECT_BROAD_H

#include "model/model.h"

/* Lists all pairs anew where something may have left its skin: what is known of those that stay is kept. Else, after
 * `edits`, adds the pairs of blocks that have come or changed since the detection looked. */
tl_status tl_broad_update(tl_model *m, bool edits);

#endif
