/* vtk_zones.h - the zones of a frame, those that a section cuts, and the surfaces of deformable blocks. */
#ifndef TL_IO_VTK_ZONES_H
#define TL_IO_VTK_ZONES_H

#include "io/pieces.h"
#include "io/zone_list.h"

#include <talus/output.h>

tl_status tl_vtk_zones(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
/* The arrays of zones, but for block and group, for `count` cells: picked[i] is the number in the list of the zone of
 * cell i. TL_NO_ROW: its block is rigid, and has NaN, or -1 where numbers are whole. */
tl_status tl_vtk_picked_zones(tl_model *m, const tl_zone_list *list, const uint32_t *picked, size_t count,
                              tl_pieces *out);

/* The surfaces of all deformable blocks, by row of the block; a rigid one has no vertices and no triangles. */
typedef struct tl_block_surfaces {
    uint32_t *vertex_start, *triangle_start; /* [rows + 1] */
    uint32_t *vertex;                        /* rows of gridpoints, ascending within a block */
    uint32_t (*triangle)[3];                 /* numbers among the vertices of the block */
} tl_block_surfaces;

/* Finds them; rows are tidy. Freed by tl_block_surfaces_free, also after a failure: out of memory. */
tl_status tl_block_surfaces_find(tl_model *m, tl_block_surfaces *surfaces);
void tl_block_surfaces_free(tl_block_surfaces *surfaces);

static inline uint32_t tl_surface_vertices(const tl_block_surfaces *s, size_t block)
{
    return s->vertex_start[block + 1] - s->vertex_start[block];
}

static inline uint32_t tl_surface_triangles(const tl_block_surfaces *s, size_t block)
{
    return s->triangle_start[block + 1] - s->triangle_start[block];
}

#endif
