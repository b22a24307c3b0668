/* name.h - how zones and gridpoints are known from outside. */
#ifndef TL_ZONE_NAME_H
#define TL_ZONE_NAME_H

#include <talus/types.h>

/* A zone, or a gridpoint: the body that it is of, by the lowest id of its blocks, and its number there, from 0. */
typedef struct tl_zone_name {
    tl_id body;
    uint32_t number;
} tl_zone_name;

#endif
