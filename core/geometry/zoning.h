/* zoning.h - a convex block is divided into tetrahedra, its zones. */
#ifndef TL_GEOMETRY_ZONING_H
#define TL_GEOMETRY_ZONING_H

#include "base/error.h"
#include "geometry/zone_mesh.h"

/* Space for the work, kept from one block to the next. One thread uses it at a time. */
typedef struct tl_zone_scratch tl_zone_scratch;

tl_zone_scratch *tl_zone_scratch_create(void);
void tl_zone_scratch_free(tl_zone_scratch *scratch);

/* Divides a block. What is made depends on the block and the zoning alone, not on what the scratch did before.
 *
 * TL_E_ARGUMENT: the wanted edge is no positive number somewhere, or makes too many zones. TL_E_GEOMETRY: the zones
 * fail a check, and the mesh is empty. The sentence says what of the block is so: the caller puts its name in front. */
tl_status tl_zoning_make(const tl_poly *poly, const tl_shape_zoning *zoning, tl_zone_scratch *scratch,
                         tl_zone_mesh *mesh, tl_error *error);
void tl_zone_mesh_free(tl_zone_mesh *mesh);
/* Places on edges between parts of faces at which the last block, which was not divided for that, needs corners. */
const tl_vec3 *tl_zoning_crossed(const tl_zone_scratch *scratch, size_t *count);

/* About how many zones of an edge fill a volume with a surface: for a limit before the work. */
double tl_zoning_expected(double volume, double surface, double edge);

#endif
