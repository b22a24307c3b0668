/* drives.h - drives of a copied or restored model. */
#ifndef TL_STATE_DRIVES_H
#define TL_STATE_DRIVES_H

#include "model/model.h"
#include "state/archive.h"

/* A drive without its functions, as a file keeps it. */
typedef struct tl_drive_kept {
    tl_vec3 velocity, angular_velocity;             /* the constant parts */
    tl_vec3 velocity_now, angular_velocity_now;     /* in the last step */
    uint8_t velocity_asked, angular_velocity_asked; /* 1: a function gave it */
} tl_drive_kept;

/* Adds them to an archive; false when out of memory. */
bool tl_drives_save(const tl_model *m, tl_archive_writer *w);
/* How many an archive has. */
size_t tl_drives_in(const tl_archive *archive);
/* Makes the drives of a model whose bodies have the numbers of theirs already. */
tl_status tl_drives_restore(tl_model *m, const tl_archive *archive, tl_drive_again_fn again,
                            void *user);
tl_status tl_drives_copy(tl_model *to, const tl_model *from, tl_drive_again_fn again, void *user);

#endif
