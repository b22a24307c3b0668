/* joined_faces.h - faces of joined blocks are given in parts that agree, before the blocks are divided into zones. */
#ifndef TL_GEOMETRY_JOINED_FACES_H
#define TL_GEOMETRY_JOINED_FACES_H

#include "base/error.h"
#include "geometry/zone_mesh.h"

/* A block whose faces are given in parts. */
typedef struct tl_joined_block {
    tl_poly *poly;     /* its corners come first, as it numbers them */
    uint32_t *place;   /* [vertices] numbers of their places, alike in all blocks */
    uint8_t *inside;   /* [faces of poly] not 0: the part lies on one of another block */
    uint32_t *face_of; /* [faces of poly] the face of the block */
    tl_zone_parts how;
} tl_joined_block;

typedef struct tl_joined_faces {
    tl_joined_block *block; /* [count] */
    size_t count;
    uint32_t place_count;
} tl_joined_faces;

/* Divides the faces of joined blocks, given in one frame, into parts. Where faces of two blocks lie on each other, what
 * they have in common is a part of both. `more` are places at which edges of parts get corners, too. Sentences know
 * blocks by `id`. Free *splits in any case.
 *
 * TL_E_GEOMETRY: two blocks do not lie flat on each other, or faces do not agree. */
tl_status tl_joined_faces_make(const tl_poly *const *blocks, const tl_id *id, size_t count, const tl_vec3 *more,
                               size_t more_count, tl_joined_faces *splits, tl_error *error);
void tl_joined_faces_free(tl_joined_faces *splits);

#endif
