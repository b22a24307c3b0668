/* scene_chunks.h - the chunks of a frame that hold numbers: SHAP, FRAM, CONT, FIEL, LINE and KEYS. */
#ifndef TL_IO_SCENE_CHUNKS_H
#define TL_IO_SCENE_CHUNKS_H

#include "io/pieces.h"

#include <talus/output.h>

/* SHAP: the blocks in `rows`. */
tl_status tl_scene_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out);
/* FRAM: all blocks. */
tl_status tl_scene_blocks(tl_model *m, tl_piece *out, double *largest);
/* FIEL `number`: value[picked[i]], or value[i] where `picked` is NULL. */
tl_status tl_scene_field(tl_error *error, uint32_t of, size_t number, const double *values,
                         const uint32_t *picked, size_t count, tl_piece *out);
/* CONT and the FIEL of contacts, where they are wanted; and the verdict, by blocks of the median size. */
tl_status tl_scene_contacts(tl_model *m, const tl_html *options, double median, tl_piece *out,
                            tl_verdict *verdict);
/* LINE, and KEYS where there are keyblocks. */
tl_status tl_scene_run(tl_model *m, const tl_html *options, tl_piece *out);

/* A number of a history: a number of its last sample, NaN where it has none. */
typedef void (*tl_scene_history_fn)(void *user, const char *name, const char *unit, double value);
/* Calls for each number of each history of the model: of one with several by "NAME 1", "NAME 2" ... */
void tl_scene_histories(const tl_model *m, tl_scene_history_fn fn, void *user);

#endif
