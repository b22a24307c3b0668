/* resolid.h - zones get another solid. */
#ifndef TL_ZONE_RESOLID_H
#define TL_ZONE_RESOLID_H

#include "zone/zones.h"

/* Gives the zones of blocks another solid. Nothing has changed when it fails: TL_E_ARGUMENT for a solid that is not
 * there, TL_E_STATE for a rigid block. */
tl_status tl_blocks_resolid(tl_model *m, const tl_id *blocks, size_t count, const char *solid);

#endif
