/* drives.h - drives of a copied or restored model. */
#ifndef TL_STATE_DRIVES_H
#define TL_STATE_DRIVES_H

#include "model/model.h"

/* A drive without its functions, as a file keeps it. */
typedef struct tl_drive_kept {
    tl_vec3 velocity, angular_velocity;             /* the constant parts */
    tl_vec3 velocity_now, angular_velocity_now;     /* in the last step */
    uint8_t velocity_asked, angular_velocity_asked; /* 1: a function gave it */
} tl_drive_kept;

/* Puts what a file keeps of a drive into a row that is zero. */
void tl_drive_keep(const tl_drive_record *record, tl_drive_kept *kept);
/* Makes the drives of a model whose bodies have the numbers of theirs already. `from` has those of the original, of a copy;
 * of a file it is NULL. */
tl_status tl_drives_make(tl_model *m, const tl_drive_kept *kept, size_t count,
                         const tl_drive_record *from, tl_drive_again_fn again, void *user);
tl_status tl_drives_copy(tl_model *to, const tl_model *from, tl_drive_again_fn again, void *user);

#endif
