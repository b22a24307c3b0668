/* scene_parts.h - the parts of a frame: scene_head.c, scene_blocks.c, scene_refused.c, scene_touches.c, scene_contacts.c,
 * scene_numbers.c, scene_finding.c, scene_histories.c. */
#ifndef TL_IO_SCENE_PARTS_H
#define TL_IO_SCENE_PARTS_H

#include "io/scene.h"

/* The JSON of the head of the scene's next frame, into `text`. */
void tl_scene_head(const tl_model *m, const tl_html *options, const tl_scene *scene,
                   tl_piece *text);

/* A number of a history: a number of its last sample, NaN where it has none. */
typedef void (*tl_scene_history_fn)(void *user, const char *name, const char *unit, double value);
/* Calls for each number of each history of the model: of one with several by "NAME 1", "NAME 2" ... */
void tl_scene_histories(const tl_model *m, tl_scene_history_fn fn, void *user);

/* SHAP: the blocks in `rows`. */
tl_status tl_scene_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out);
/* REFU: the cuts that were refused. */
tl_status tl_scene_refused(tl_model *m, tl_piece *out);
/* TOUC: the faces with which bodies lie on others. */
tl_status tl_scene_touches(tl_model *m, tl_piece *out);
/* FRAM: all blocks. */
tl_status tl_scene_blocks(tl_model *m, tl_piece *out, double *largest);
/* CONT and the FIEL of contacts, where they are wanted; and the verdict, by blocks of the median size. */
tl_status tl_scene_contacts(tl_model *m, const tl_html *options, double median, tl_piece *out,
                            tl_verdict *verdict);
/* FIEL `number`: value[picked[i]], or value[i] where `picked` is NULL. */
tl_status tl_scene_field(tl_error *error, uint32_t of, size_t number, const double *values,
                         const uint32_t *picked, size_t count, tl_piece *out);
/* LINE, and KEYS where there are keyblocks. */
tl_status tl_scene_run(tl_model *m, const tl_html *options, tl_piece *out);
/* The JSON of FIND, the verdict, with the state hash unless that is NULL, into `text`. */
void tl_scene_finding(const tl_verdict *verdict, const char *hash, tl_piece *text);

#endif
