/* life.h - the tables of zones come and go. */
#ifndef TL_ZONE_LIFE_H
#define TL_ZONE_LIFE_H

#include "zone/columns.h"

/* Makes the model's zones, without any; nothing when they are there. */
tl_status tl_zones_begin(tl_model *m);
void tl_zones_free(struct tl_zones *z);

#endif
