/* press_faces.h - the planes of the faces that press, where they are moved out and lean (press_faces.c). */
#ifndef TL_NARROW_PRESS_FACES_H
#define TL_NARROW_PRESS_FACES_H

#include "narrow/press_query.h"

/* Where the planes of a region are put together. */
typedef struct tl_press_planes {
    tl_field_faces faces;
    tl_vec3 origin;
    uint32_t count;
} tl_press_planes;

/* Room for planes of so many pairs, each of which has no more than its region. false: out of memory. */
bool tl_press_reserve(tl_narrow_scratch *scratch, const tl_press_query query[], uint32_t count,
                      tl_press_planes p[]);
/* How far a face is moved out. */
double tl_press_shift_of(const tl_press_query *of, bool of_b, uint32_t face);
/* Where a face presses, in A's frame. */
tl_plane tl_pressing_plane(const tl_press_query *of, bool of_b, uint32_t face);
/* The faces that count for the field, or for the patch of the flush ones, with their borders. */
void tl_press_list_field(tl_press_planes *p, const tl_press_query *of);
void tl_press_list_patch(tl_press_planes *p, const tl_press_query *of);

#endif
