/* sound.h - whether zones that were read from a file fit together. */
#ifndef TL_ZONE_SOUND_H
#define TL_ZONE_SOUND_H

#include "zone/zones.h"

/* What is wrong with them; NULL: nothing. */
const char *tl_zones_unsound(const tl_model *m, const struct tl_zones *z);

#endif
