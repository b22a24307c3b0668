/* share.h - the point share: what touches along a pair's axis by vertices and edges (share.c), and how what depends
 * on a tilt fades. */
#ifndef TL_NARROW_SHARE_H
#define TL_NARROW_SHARE_H

#include "narrow/axis.h"
#include "narrow/share_points.h"

/* Tilt of two faces, or of an edge and a face, or of two edges, up to which they count as parallel
 * contact, and from which not at all: degrees. */
#define TL_TILT_FULL 5.0
#define TL_TILT_NONE 15.0

/* 1 up to `full` degrees, 0 from `none` on (at most 25), smooth between; `sine` is that of the angle (acute). */
double tl_fade(double sine, double full, double none);
/* Its derivative by the angle, 1/rad. */
double tl_fade_slope(double sine, double full, double none);

/* Adds the facets of the point share of an axis, areas of their points still relative to each other; `swing` is the
 * couple that goes with the whole share (tl_facet). */
void tl_share_add(const tl_pair_view *view, const tl_axis *axis, tl_vec3 swing, tl_narrow *room);

/* Adds a point, or of the same point the one of more weight; not, when memory is out. */
void tl_share_points_add(tl_share_points *found, tl_share_point point);

#endif
