/* mesh_draft.h - a new mesh of the polygons of a pressure field. */
#ifndef TL_NARROW_MESH_DRAFT_H
#define TL_NARROW_MESH_DRAFT_H

#include "narrow/field_lanes.h"
#include "narrow/field_sums.h"

/* Polygons as they are found, before they are put together. */
typedef struct tl_mesh_draft {
    bool full; /* there are more than a mesh has room for */
    uint8_t polygons, labels;
    uint8_t own[TL_MESH_POLYGONS][2], sides[TL_MESH_POLYGONS];
    uint8_t label[TL_MESH_SIDES]; /* the plane on the other side of each side; TL_MESH_ZERO: none */
} tl_mesh_draft;

/* Adds the polygon of a lane to a draft. `own` are its two planes, `bound` those whose lines come after the first one,
 * which is that of d = 0. */
void tl_mesh_draw(tl_mesh_draft *draft, const uint16_t own[2], const uint16_t *bound,
                  const tl_field_line *line, size_t lines, unsigned lane);
/* Makes a mesh of all polygons of a field. It has none when they do not fit together, or are too many. */
void tl_mesh_make(const tl_mesh_draft *draft, const tl_field_faces *faces, tl_field_mesh *mesh);

#endif
