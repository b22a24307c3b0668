/* scene_blocks.h - SHAP and FRAM. */
#ifndef TL_IO_SCENE_BLOCKS_H
#define TL_IO_SCENE_BLOCKS_H

#include "io/pieces.h"

#include <talus/output.h>

/* SHAP: the blocks in `rows`. */
tl_status tl_scene_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out);
/* FRAM: all blocks. */
tl_status tl_scene_blocks(tl_model *m, tl_piece *out, double *largest);

#endif
