/* polygon.h - the common polygon of two faces in the plane of their patch: what patch.c, patch_batch.c,
 * polygon.c and outline.c share. */
#ifndef TL_DETECT_POLYGON_H
#define TL_DETECT_POLYGON_H

#include "detect/detect.h"

/* Corners nearer to each other than this times the size are one, and corners nearer to a line that clips lie on
 * it: far below any length that matters, far above rounding. Edges along each other would otherwise cross
 * here and there, and points come and go. */
#define TL_MERGE 1e-7

/* Edges of A's face are 0, 1, ..., those of B's face TL_EDGE_B, TL_EDGE_B + 1, ... */
enum { TL_EDGE_B = 1 << 16 };
/* What a point is; with the features that made it, this gives its key. */
enum { TL_POINT_A, TL_POINT_B, TL_POINT_CROSSING, TL_POINT_MIDDLE, TL_POINT_CENTROID };

/* Different features of one contact have different keys: corners of A's face their numbers, then those of B's ... */
static inline uint32_t tl_corner_key(uint32_t kind, uint32_t corner)
{
    return kind == TL_POINT_A ? corner : corner | 1u << 16;
}

/* ... and what two features make a mixture of theirs: a multiplication or two must do. */
static inline uint32_t tl_key_of(uint32_t kind, uint32_t one, uint32_t other)
{
    uint64_t x = (kind + UINT64_C(0x9e3779b97f4a7c15) * one) ^ UINT64_C(0xd6e8feb86659fd93) * other;
    return (uint32_t)((x ^ x >> 32) * UINT64_C(0xd6e8feb86659fd93) >> 32);
}

typedef struct tl_point2 {
    double x, y;
} tl_point2;

static inline double tl_cross2(tl_point2 o, tl_point2 a, tl_point2 b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Square of the distance. */
static inline double tl_distance2(tl_point2 a, tl_point2 b)
{
    double x = a.x - b.x, y = a.y - b.y;
    return x * x + y * y;
}

static inline tl_point2 tl_from_to(tl_point2 a, tl_point2 b)
{
    return (tl_point2){b.x - a.x, b.y - a.y};
}

/* How the normal of two crossing edges, a of A's face and b of B's, leans. With both measured from the line in
 * which the faces' planes meet, by angles alpha and beta, it is along M - L sin(alpha + beta)/d - M x L 2 sin alpha
 * sin beta/d, with d = sin(beta - alpha); see tl_lean. `rise` points across that line, up A's face.
 * Bounded, for edges nearly along each other have no normal. */
static inline tl_point2 tl_lean2_of(tl_point2 a, tl_point2 b, tl_point2 rise)
{
    double a_along = a.x * rise.y - a.y * rise.x, a_up = a.x * rise.x + a.y * rise.y;
    double b_along = b.x * rise.y - b.y * rise.x, b_up = b.x * rise.x + b.y * rise.y;
    double d = a_along * b_up - a_up * b_along;
    double face = -(a_along * b_up + a_up * b_along), edge = -2 * a_up * b_up;
    double most = fabs(face) > 0.5 * fabs(edge) ? fabs(face) : 0.5 * fabs(edge);
    most = fabs(d) > most ? fabs(d) : most;
    double scale = most > 0 ? (d < 0 ? -1 : 1) / most : 0;
    return (tl_point2){face * scale, edge * scale};
}

static inline tl_lean tl_lean_of(tl_point2 a, tl_point2 b, tl_point2 rise)
{
    tl_point2 lean = tl_lean2_of(a, b, rise);
    return (tl_lean){(float)lean.x, (float)lean.y};
}

typedef struct tl_corner {
    tl_point2 at;
    uint32_t key;  /* of the features that made it */
    uint32_t edge; /* source of the edge that leaves it */
    tl_lean lean;  /* of its gap's normal */
    double height; /* over the line that cuts */
    double share;  /* of the corner in the mixture: 0 .. 1 */
    double fan;    /* area of the fan triangle of the edge that leaves it */
} tl_corner;

/* ---- outline.c ---- */

/* Faces and polygons of up to this many corners have outlines. */
#define TL_OUTLINE_CORNERS 8

/* A corner of the common polygon of two faces, as its features tell. Corners of A's face have the numbers 0, 1, ...,
 * those of B's TL_OUTLINE_CORNERS, ...; the height of corner i of A over the line that begins at corner j of B has
 * number TL_OUTLINE_CORNERS j + i. A corner is one of a face, `from` and `to`, or lies between these two where
 * heights `over` and `under` meet 0. */
typedef struct tl_outline_corner {
    uint8_t from, to, over, under;
    uint8_t line; /* of B that is crossed */
    int8_t face;  /* lean of a face's own corner; 0 for a crossing */
} tl_outline_corner;

/* Heights of a face's own corner: 0 and -1. */
enum { TL_HEIGHT_OWN = TL_OUTLINE_CORNERS * TL_OUTLINE_CORNERS };

typedef struct tl_outline {
    uint64_t inside_a, inside_b; /* what it was found by */
    uint32_t sides;
    uint32_t count;                               /* of corners; 0: features alone do not tell */
    tl_outline_corner corner[TL_OUTLINE_CORNERS]; /* beyond the last as the first */
    uint32_t key[TL_OUTLINE_CORNERS], middle_key[TL_OUTLINE_CORNERS];
} tl_outline;

/* Remembers what it finds in `room`, a table of TL_OUTLINES. Byte i of `inside_a`: the lines of B, a bit
 * each, which corner i of A lies inside; the same with `inside_b`. */
#define TL_OUTLINES 128
const tl_outline *tl_outline_of(tl_outline *room, uint32_t na, uint32_t nb, uint64_t inside_a,
                                uint64_t inside_b);

struct tl_patch_batch;

/* ---- polygon.c ---- */

/* Room for one clipping. */
struct tl_polygon {
    tl_corner *now, *next;
    tl_point2 *face, *clip; /* outlines of A's and B's face, counter-clockwise */
    size_t room, face_room;
    struct tl_patch_batch *batch; /* patch_batch.c */
};

/* Room for faces of `na` and `nb` corners; NULL when out of memory. */
struct tl_polygon *tl_polygon_room(tl_narrow *room, size_t na, size_t nb);
/* Clips `face` by `clip`: into `now`, beginning with the corner whose edge has the lowest number; corners nearer
 * than `near` are one. Returns their number. */
size_t tl_polygon_clip(struct tl_polygon *p, uint32_t na, uint32_t nb, double near, tl_point2 rise);

#endif
