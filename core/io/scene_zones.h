/* scene_zones.h - the deformable blocks of a frame: their meshes, where these are, and numbers of the zones. */
#ifndef TL_IO_SCENE_ZONES_H
#define TL_IO_SCENE_ZONES_H

#include "io/scene.h"

/* What the head of a scene tells of zones: nothing where no block is deformable. */
void tl_scene_zones_head(const tl_model *m, tl_piece *text);
/* SURF, where it is not the one that was sent; `next` gets its digest. */
tl_status tl_scene_surface(const tl_scene_known *sent, tl_scene_known *next, tl_model *m, tl_piece *out);
/* SPOS and the ZFLD. `largest`: displacement, m, which becomes that of a gridpoint where one has moved farther. */
tl_status tl_scene_zones(tl_model *m, tl_piece *out, double *largest);

#endif
