/* drives.h - drives of a copied or restored model. */
#ifndef TL_STATE_DRIVES_H
#define TL_STATE_DRIVES_H

#include "model/model.h"
#include "state/archive.h"

/* A drive without its functions, as a file keeps it: the chunk "drives". */
typedef struct tl_drive_kept {
    tl_vec3 velocity, angular_velocity;             /* the constant parts */
    tl_vec3 velocity_now, angular_velocity_now;     /* in the last step */
    uint8_t velocity_asked, angular_velocity_asked; /* 1: a function gave it */
} tl_drive_kept;

/* A gradient of a drive, as a file keeps it: the chunk "drive_gradients", of all drives if one has any. */
typedef struct tl_gradient_kept {
    double gradient[3][3];
    tl_vec3 at;
} tl_gradient_kept;

/* Which records a drive follows, as a file keeps it: the chunk "drive_records", of all drives if one follows any.
 * Numbers count from 1 in "record_heads"; 0: none. */
typedef struct tl_records_kept {
    uint32_t number[3];
    double begin;
} tl_records_kept;

/* A record: its accelerations at both ends of each interval are in "record_samples", one record after the other. */
typedef struct tl_record_head {
    double dt, velocity; /* s, m/s at the begin */
    uint64_t count;
} tl_record_head;

/* Who gives the functions of drives again. */
typedef struct tl_drives_again {
    tl_drive_again_fn fn; /* NULL: nobody */
    void *user;
} tl_drives_again;

/* As of a part (part.h). The bodies have the numbers of their drives already. */
void tl_drives_save(const tl_model *m, tl_archive_writer *w);
tl_status tl_drives_restore(tl_model *m, const tl_archive *a, const tl_drives_again *again);
tl_status tl_drives_copy(tl_model *to, const tl_model *from, const tl_drives_again *again);

#endif
