/* outline.h - the corners of the common polygon of two faces, as signs tell them (outline.c). */
#ifndef TL_NARROW_OUTLINE_H
#define TL_NARROW_OUTLINE_H

#include <stdint.h>

/* Faces and polygons of up to this many corners have outlines. */
#define TL_OUTLINE_CORNERS 8

/* A corner of the common polygon of two faces, as its features tell. Corners of A's face have the numbers 0, 1, ...,
 * those of B's TL_OUTLINE_CORNERS, ...; the height of corner i of A over the line that begins at corner j of B has
 * number TL_OUTLINE_CORNERS j + i. A corner is one of a face, `from` and `to`, or lies between these two where
 * heights `over` and `under` meet 0. */
typedef struct tl_outline_corner {
    uint8_t from, to, over, under;
} tl_outline_corner;

/* Heights of a face's own corner: 0 and -1. */
enum { TL_HEIGHT_OWN = TL_OUTLINE_CORNERS * TL_OUTLINE_CORNERS };

typedef struct tl_outline {
    uint64_t inside_a, inside_b; /* what it was found by */
    uint32_t sides;
    uint32_t count;                               /* of corners; 0: features alone do not tell */
    tl_outline_corner corner[TL_OUTLINE_CORNERS]; /* beyond the last as the first */
    uint32_t key[TL_OUTLINE_CORNERS], middle_key[TL_OUTLINE_CORNERS];
    /* the edge that leaves the corner: of A's face 0, 1, ..., of B's TL_OUTLINE_CORNERS, ... */
    uint8_t edge[TL_OUTLINE_CORNERS];
} tl_outline;

/* Remembers what it finds in `cache`, a table of TL_OUTLINES. Byte i of `inside_a`: the lines of B, a bit
 * each, which corner i of A lies inside; the same with `inside_b`. */
#define TL_OUTLINES 128

/* Edges of two faces that lie along each other, a bit each. */
typedef struct tl_outline_shared {
    uint32_t a, b;
} tl_outline_shared;

/* By which corners lie on which lines, as with `inside_a` and `inside_b`. */
tl_outline_shared tl_outline_shared_of(uint32_t na, uint32_t nb, uint64_t on_a, uint64_t on_b);
const tl_outline *tl_outline_of(tl_outline *cache, uint32_t na, uint32_t nb, uint64_t inside_a,
                                uint64_t inside_b);

#endif
