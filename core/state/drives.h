/* drives.h - drives of a copied or restored model. */
#ifndef TL_STATE_DRIVES_H
#define TL_STATE_DRIVES_H

#include "state/part.h"

/* A drive without its functions, as a file keeps it: the chunk "drives". */
typedef struct tl_drive_kept {
    tl_vec3 velocity, angular_velocity;             /* the constant parts */
    tl_vec3 velocity_now, angular_velocity_now;     /* in the last step */
    uint8_t velocity_asked, angular_velocity_asked; /* 1: a function gave it */
} tl_drive_kept;

/* The bodies have the numbers of their drives already. */
extern const tl_state_part tl_drives_part;

#endif
