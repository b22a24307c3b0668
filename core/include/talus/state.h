/* talus/state.h - a model once more: in memory, or in a file. Included by talus.h. */
#ifndef TALUS_STATE_H
#define TALUS_STATE_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_model tl_model;
typedef struct tl_drive tl_drive;

/* A drive whose functions are asked for again: a copy has to have its own owner of them, and no file keeps them. */
typedef struct tl_drive_asked {
    tl_id block;                     /* the lowest that it drives */
    size_t bodies;                   /* that it drives */
    bool velocity, angular_velocity; /* which of both were functions */
    const tl_drive *from;            /* of a copy: the original's drive; of a file NULL */
} tl_drive_asked;

/* Gives the functions, user and release of a drive; false when there are none. */
typedef bool (*tl_drive_again_fn)(void *user, const tl_drive_asked *asked, tl_drive *drive);

/* The same model once more, in memory: an equal state, and from then on equal bits after equal calls. Its log goes
 * where that of the model goes; the frames of VTK files written so far are not the copy's. `again`, which may be NULL,
 * is asked for the functions of drives: TL_E_STATE when it has none, and of a model whose last step failed and could
 * not be taken back. From a callback of a run it may be called, not from a drive's function. */
TL_API tl_status tl_model_copy(tl_model *model, tl_drive_again_fn again, void *user, tl_model **copy);

/* Saves the model: all that the next steps depend on, to the bit, so that a restored model goes on as this one. The
 * file appears whole or not at all, durably, in the place of an older one; folders are made. The run goes on as if it
 * had not been saved. What no file keeps: functions of drives and of histories, the number of threads. */
TL_API tl_status tl_model_save(tl_model *model, const char *path);
/* The model that a file holds, for so many threads. TL_E_IO: it cannot be read; TL_E_ARGUMENT: it is no such file, of
 * another format, cut off or damaged; TL_E_NOT_FOUND, TL_E_STATE: a plugin it needs is not loaded, or in another
 * version, or `again` has not given the functions of a drive. The file is not trusted: whatever its bytes, a model or a
 * sentence comes of it. */
TL_API tl_status tl_model_restore(const char *path, int64_t threads, tl_drive_again_fn again, void *user,
                                  tl_model **model, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
