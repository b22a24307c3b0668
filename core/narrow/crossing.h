/* crossing.h - points of a point share where edges cross (crossing.c). */
#ifndef TL_NARROW_CROSSING_H
#define TL_NARROW_CROSSING_H

#include "narrow/share_points.h"
#include "narrow/view.h"

tl_line tl_line_of(const tl_edge *e, const tl_vec3 *vertex);

/* Adds the points at which an edge of A and one of B touch along n, with that weight among them: where they cross or, as
 * far as they are nearly parallel and do not lie in a face beside, the ends of their common stretch. As far as one goes on
 * from one face to the next, there are none: it stands on both farther off. */
void tl_crossing_add(const tl_pair_view *view, const tl_crossing *edges, tl_weight weight,
                     const tl_from *from, tl_share_points *found);

/* How nearly the normal n of two edges is that of a face beside one of them, which is A's or B's; `out` is the face's
 * normal, turned from A to B. */
tl_weight tl_crossing_likeness(bool of_a, tl_vec3 out, tl_vec3 n, const tl_line *a,
                               const tl_line *b);

#endif
