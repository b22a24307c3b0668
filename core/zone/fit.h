/* fit.h - tetrahedra of a file become the zones of the blocks in which they lie. */
#ifndef TL_ZONE_FIT_H
#define TL_ZONE_FIT_H

#include "geometry/zone_mesh.h"
#include "model/model.h"

/* Meshes by rows of blocks: [rows], empty for those that were not chosen. */
typedef struct tl_fitted {
    tl_zone_mesh *mesh;
    size_t rows;
} tl_fitted;

/* Reads a file, and gives its tetrahedra to the blocks chosen[row], where these are now. What lies in none of them is
 * left out. The meshes are in the coordinates of the blocks' bodies. Nothing of the model changes. Free *fitted in any
 * case. TL_E_GEOMETRY: the file is damaged, or a block is not filled. */
tl_status tl_fit_make(tl_model *m, const char *file, const unsigned char *chosen, tl_fitted *fitted);
void tl_fit_free(tl_fitted *fitted);

#endif
