/* grid.h - meshes of bodies, as tables. */
#ifndef TL_ZONE_GRID_H
#define TL_ZONE_GRID_H

#include "zone/zones.h"

/* A block of a body: its zones and clusters follow those of the block before. */
typedef struct tl_grid_block {
    tl_id block;
    double density; /* kg/m3 */
    size_t zone_end, cluster_end;
} tl_grid_block;

/* Tetrahedra that fill a body. Corners 0, 1, 2 of each are counter-clockwise as seen from the side without corner 3.
 * Clusters are lists of zones that hang together, of 1 to TL_CLUSTER_MOST; what follows each other lies together. */
typedef struct tl_grid {
    const tl_vec3 *point; /* from the model's origin, m */
    size_t point_count;
    const uint32_t (*zone)[4];
    size_t zone_count;
    const uint32_t *cluster_start,
        *cluster_zone; /* cluster k: cluster_zone[cluster_start[k] .. cluster_start[k + 1]) */
    size_t cluster_count;
    const uint32_t *cluster_solid; /* numbers of their solids; NULL: one, given with the grid */
    const tl_grid_block *block;    /* NULL: one, that which names the body, of `density`, kg/m3 */
    size_t block_count;
    double density;
    /* of the surface, by block and face; corners are numbers of points */
    const tl_surface_part *part;
    size_t part_count;
} tl_grid;

/* Gives a body that has none a mesh, all of one solid, free of stress. Nothing has changed when it fails. */
tl_status tl_zones_add(tl_model *m, tl_id body, const tl_grid *grid, uint32_t solid);
/* Lays the zones of mesh `mesh` anew, which has its gridpoints, at the end of other tables of zones: `to` has a list of
 * all meshes, and the zones of those before. The clusters have solids. false: out of memory, `to` is as it was. */
bool tl_zones_lay(tl_model *m, struct tl_zones *to, uint32_t mesh, const tl_grid *grid);
/* Takes back the meshes from a number on. */
void tl_zones_end_at(tl_model *m, uint32_t meshes);
/* Lists the slots of the gridpoints of meshes from a number on, and marks those on surfaces. What was listed of those
 * before stands. false: out of memory. */
bool tl_zones_index(struct tl_zones *z, uint32_t mesh);
/* Gives back what the lists of zones have to spare. */
void tl_zones_trim(struct tl_zones *z);
/* The number of a body's mesh, or TL_NO_ROW. */
uint32_t tl_mesh_of(const tl_model *m, tl_id body);
/* The triangles of a face of a block; NULL: it is rigid. */
const tl_surface_part *tl_face_parts(const tl_model *m, tl_id block, uint32_t number, size_t *count);
/* Whether two blocks meet by segments, by their rows. */
bool tl_blocks_meet(const tl_model *m, uint32_t a, uint32_t b);
/* Whether one of two blocks is deformable, by their rows. */
static inline bool tl_blocks_deform_either(const tl_model *m, uint32_t a, uint32_t b)
{
    return tl_block_deforms(m, a) || tl_block_deforms(m, b);
}

#endif
