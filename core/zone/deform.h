/* deform.h - rigid bodies become deformable. */
#ifndef TL_ZONE_DEFORM_H
#define TL_ZONE_DEFORM_H

#include "zone/zones.h"

/* How blocks are divided. */
typedef struct tl_dividing {
    double edge; /* of zones, m, > 0. Larger than a block: its corners and its centroid alone */
    /* or a function of the place, in the user's coordinates; NULL: `edge` everywhere */
    double (*size)(void *user, tl_vec3 place);
    void *user;
    const char *solid; /* name of the solid that zones are made of */
} tl_dividing;

/* What has been made. */
typedef struct tl_divided {
    size_t blocks, zones, gridpoints, clusters;
    double least_altitude; /* of all zones over their largest sides, m */
    double least_share;    /* of altitudes over the wanted edges */
    tl_id worst;           /* the block that has that */
} tl_divided;

/* Gives blocks zones, free of stress where the blocks are, with the blocks' velocities. A block that is held, in some
 * components or all, has gridpoints that are held so. Where faces of two blocks are the same polygon, the triangles of
 * both are. Joined blocks come all at once: where they lie on each other they share gridpoints. Nothing has changed when
 * it fails:
 *
 * TL_E_ARGUMENT: the edge is not positive, or makes too many zones; there is no such solid. TL_E_STALE: no such block.
 * TL_E_STATE: a block has zones, is joined to one that is not given, or is driven or loaded. TL_E_GEOMETRY: a block
 * cannot be divided, or joined blocks do not lie flat on each other.
 */
tl_status tl_blocks_divide(tl_model *m, const tl_id *blocks, size_t count, const tl_dividing *how, tl_divided *made);

#endif
