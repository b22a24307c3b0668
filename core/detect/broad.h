/* broad.h - pairs of blocks whose inflated bounds overlap (broad.c). */
#ifndef TL_DETECT_BROAD_H
#define TL_DETECT_BROAD_H

#include "model/model.h"

tl_status tl_broad_update(tl_model *m);

#endif
