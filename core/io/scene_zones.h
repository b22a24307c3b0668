/* scene_zones.h - the deformable blocks of a frame: their meshes, where these are, and numbers of the zones. */
#ifndef TL_IO_SCENE_ZONES_H
#define TL_IO_SCENE_ZONES_H

#include "base/hash.h"
#include "io/pieces.h"

/* What the head of a scene tells of zones: nothing where no block is deformable. */
void tl_scene_zones_head(const tl_model *m, tl_piece *text);
/* SURF, where its digest is not `sent`, that of the one that was sent: zeros where none was. `next`: its digest. */
tl_status tl_scene_surface(tl_model *m, tl_hash sent, tl_hash *next, tl_piece *out);
/* SPOS and the ZFLD. `largest`: displacement, m, which becomes that of a gridpoint where one has moved farther. */
tl_status tl_scene_zones(tl_model *m, tl_piece *out, double *largest);

#endif
