/* meets.h - which faces may touch by segments, and the segments that they have. */
#ifndef TL_SEGMENT_MEETS_H
#define TL_SEGMENT_MEETS_H

#include "segment/segments.h"

/* A part of a face that lies on one of another block: rows of the blocks, numbers of the faces, and their parts, or
 * TL_NO_ROW of a rigid face. */
typedef struct tl_cover {
    uint32_t block, face, part;
    uint32_t other_block, other_face, other_part;
    double area;   /* that both have in common, m2 */
    tl_vec3 at[3]; /* on the plane of the first: three points of a third of it each, which integrate over it */
} tl_cover;

/* Lists, at the present places, what lies on what where one of two blocks is deformable: each overlay for both sides,
 * by block, face and part. Segments stay as they are. false: out of memory. The caller frees the list in any case. */
bool tl_meets_cover(const tl_model *m, tl_cover **list, size_t *count);

/* Brings meets and their segments up to the present places. */
tl_status tl_segments_find(tl_model *m);
/* Finds them for somebody who asks, where no step has yet. Pairs and contacts are up to date. */
tl_status tl_segments_ask(tl_model *m);
/* Forgets what has been found so: the next step, or what is put on segments, begins as if nobody had asked. */
void tl_segments_forget_asked(tl_model *m);

#endif
