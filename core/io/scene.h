/* scene.h - a model as a stream of chunks, frame by frame, for what shows it (scene.c; docs/scene_format.md). */
#ifndef TL_IO_SCENE_H
#define TL_IO_SCENE_H

#include "io/pieces.h"

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
    tl_piece head;
    uint64_t structure; /* of the model, when `median` was found */
    double median;      /* size of the blocks, m */
    uint32_t frames;
} tl_scene_known;

/* A stream that begins with all of the model and goes on with what has changed. All zeros: nothing has been sent. */
typedef struct tl_scene {
    tl_scene_known sent,
        next; /* after the frames that were sent; with the one that was written last */
} tl_scene;

/* Of the frame that was written last. */
typedef struct tl_scene_facts {
    double time, largest; /* s; largest displacement of a block, m */
    int64_t cycle;
    bool model; /* it has HEAD, SHAP or GONE */
} tl_scene_facts;

/* Adds the next frame to `out`. The scene goes on with it only after tl_scene_accept. */
tl_status tl_scene_write(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out,
                         tl_scene_facts *facts);
/* The frame that was written last has been sent. */
void tl_scene_accept(tl_scene *scene);
void tl_scene_free(tl_scene *scene);

#endif
