/* scene_elements.h - the elements of a frame: bars along lines, and water between walls. */
#ifndef TL_IO_SCENE_ELEMENTS_H
#define TL_IO_SCENE_ELEMENTS_H

#include "io/pieces.h"

/* What the head of a scene tells of elements: nothing where there are none. */
void tl_scene_elements_head(const tl_model *m, tl_piece *text);
/* ELEM and the EFLD; nothing where there are no elements. */
tl_status tl_scene_elements(tl_model *m, tl_piece *out);

#endif
