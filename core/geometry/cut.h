/* cut.h - cutting a polyhedron in two by a plane. */
#ifndef TL_GEOMETRY_CUT_H
#define TL_GEOMETRY_CUT_H

#include "geometry/polyhedron.h"

typedef enum tl_cut_result {
    TL_CUT_MISS,       /* the plane does not cross the polyhedron */
    TL_CUT_MADE,       /* below and above are set */
    TL_CUT_COINCIDENT, /* the plane falls on a face: `face` is set */
    TL_CUT_REFUSED     /* a side would be thinner than TL_POLY_THIN; `face` is set when the thin side
                      lies along one face, else it is UINT32_MAX */
} tl_cut_result;

typedef struct tl_cut {
    tl_cut_result result;
    tl_poly *below, *above; /* normal . x < offset, > offset */
    uint32_t face;
    /* When refused: of the thinner side along the plane's normal, and what is asked of it. */
    double thickness, limit;
} tl_cut;

/* Cuts by a plane. Vertices are never moved. Each crossed edge gets one new vertex, shared bit for bit by both sides.
 * Faces keep their planes. The cap gets the cutting plane and `tag`. `reach` is the largest coordinate the plane's
 * offset was computed from. A vertex within rounding of the plane is a corner of the cap as it is. 0: nothing is
 * larger than the offset and the vertices. The volume of both sides is that of the polyhedron to rounding, a few
 * DBL_EPSILON of the farthest coordinate times the surface. TL_E_MEMORY is the only failure. */
tl_status tl_poly_cut(const tl_poly *poly, tl_plane plane, double reach, tl_tag tag, tl_cut *cut, tl_error *error);

#endif
