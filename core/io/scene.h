/* scene.h - a model as a stream of chunks, frame by frame, for what shows it (scene.c; docs/scene_format.md). */
#ifndef TL_IO_SCENE_H
#define TL_IO_SCENE_H

#include "base/hash.h"
#include "io/pieces.h"
#include "model/model.h"

/* What was sent of a block: it is sent again when this has changed. */
typedef struct tl_scene_block {
    tl_id id, body;
    uint32_t group;
    uint64_t changed; /* as the column of blocks */
    double density;
} tl_scene_block;

/* What a reader knows. */
typedef struct tl_scene_known {
    tl_scene_block *blocks; /* in ascending order of id */
    size_t count, capacity;
    tl_piece head, touches; /* HEAD's text; the chunk TOUC */
    uint64_t structure;     /* of the model, when `median` was found */
    double median;          /* size of the blocks, m */
    uint32_t frames;
    size_t refused;  /* cuts, of all that were refused since the model was made */
    tl_hash surface; /* of the chunk SURF; zeros: none */
} tl_scene_known;

/* Whether a run is seen as it goes, and whether it takes commands. */
typedef enum tl_scene_live { TL_SCENE_PAGE, TL_SCENE_LIVE, TL_SCENE_COMMANDS } tl_scene_live;

/* A stream that begins with all of the model and goes on with what has changed. All zeros: nothing has been sent. */
typedef struct tl_scene {
    tl_scene_known sent, next; /* after the frames that were sent; with the one that was written last */
    tl_scene_live live;
} tl_scene;

/* Of the frame that was written last. */
typedef struct tl_scene_facts {
    double time, largest; /* s; largest displacement of a block or a gridpoint, m */
    int64_t cycle;
    size_t news; /* bytes at its beginning, from HEAD to SURF; 0: it has none of them */
} tl_scene_facts;

/* Adds the next frame to `out`. The scene goes on with it only after tl_scene_accept. */
tl_status tl_scene_write(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out, tl_scene_facts *facts);
/* The frame that was written last has been sent. */
void tl_scene_accept(tl_scene *scene);
/* The next frame is the first again, with all of the model. */
void tl_scene_forget(tl_scene *scene);
/* Adds a chunk of so many bytes, padded. */
tl_status tl_scene_bytes(tl_model *m, const char letters[5], const void *data, size_t bytes, tl_piece *out);
void tl_scene_free(tl_scene *scene);

#endif
