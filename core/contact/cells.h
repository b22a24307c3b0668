/* cells.h - the parts of a patch that its points stand for, and what of each presses. */
#ifndef TL_CONTACT_CELLS_H
#define TL_CONTACT_CELLS_H

#include "base/columns.h"
#include "contact/detection.h"
#include "model/model.h"
#include "narrow/frame2.h"

/* Constant: of the drawn-in triangle of the centroid over that of an edge, and where on the edge a corner's cell
 * ends. */
#define TL_CELL_INNER 0.30550504633038933 /* sqrt(7 / 75) */
#define TL_CELL_SIDE (16.0 / 68)

/* A patch whose points are drawn in towards its centroid, the last of them: n between corners, n at corners, and
 * that. */
typedef struct tl_cell_patch {
    const tl_points_table *p;
    const tl_point_lanes *lanes; /* arms, normals, lifts and cells */
    size_t lane, stride;         /* of the first point, and from each to the next */
    size_t row, corners;         /* in the table; n */
    uint32_t faces;              /* their key, which is in all of its points' */
} tl_cell_patch;

static inline size_t tl_cell_lane(const tl_cell_patch *of, size_t k)
{
    return of->lane + k * of->stride;
}

static inline tl_vec3 tl_cell_arm(const tl_cell_patch *of, size_t k)
{
    return tl_columns_get(of->lanes->arm, tl_cell_lane(of, k));
}

static inline double tl_cell_area(const tl_cell_patch *of, size_t k)
{
    return of->p->area[of->row + k * TL_LANES];
}

/* From the centroid to a point ... */
static inline tl_vec3 tl_cell_place(const tl_cell_patch *of, size_t k)
{
    return tl_v3_sub(tl_cell_arm(of, k), tl_cell_arm(of, 2 * of->corners));
}

/* ... and to a corner of the patch. */
static inline tl_vec3 tl_cell_corner(const tl_cell_patch *of, size_t k)
{
    return tl_v3_scale(1 / tl_point_rule_of(false).reach, tl_cell_place(of, of->corners + k));
}

/* The patch of a contact whose points are in the lanes given. false: it is none. */
bool tl_cell_patch_of(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes, size_t lane, size_t stride,
                      tl_cell_patch *out);
/* Whether its points are those of all corners and of every two neighbours: where faces hardly overlap some may have had
 * no area. */
bool tl_cell_patch_is_whole(const tl_cell_patch *of);

/* Integrals of all cells, of which the overlaps of the faces and the lifts from these are known. Moments are about the
 * centroid. `curved`: of higher powers, too. */
void tl_cells_find(const tl_cell_patch *of, bool curved);

/* The slope of the overlap of the faces, from the closures of its points; of points on a line none. */
tl_vec3 tl_cells_overlap_slope(const tl_cell_patch *of);

#endif
