/* patch_batch.h - patches of several pairs of faces at once, a lane each. */
#ifndef TL_NARROW_PATCH_BATCH_H
#define TL_NARROW_PATCH_BATCH_H

#include "base/lanes.h"
#include "narrow/corner.h"
#include "narrow/frame2.h"
#include "narrow/narrow.h"

/* Faces and polygons of up to this many corners have outlines. */
#define TL_OUTLINE_CORNERS 8

/* A corner of the common polygon of two faces, as its features tell. Corners of A's face have the numbers 0, 1, ...,
 * those of B's TL_OUTLINE_CORNERS, .... The height of corner i of A over the line that begins at corner j of B has
 * number TL_OUTLINE_CORNERS j + i. A corner is one of a face, `from` and `to`, or lies between these two where heights
 * `over` and `under` meet 0. */
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

const tl_outline *tl_outline_of(tl_outline *cache, uint32_t na, uint32_t nb, uint64_t inside_a, uint64_t inside_b);

typedef double tl_batch1[TL_LANES];

/* Points of a kind, one of each lane. */
typedef struct tl_batch_point {
    tl_lanes3 p;
    tl_batch1 area;
} tl_batch_point;

typedef struct tl_patch_batch {
    /* the pairs: bodies' rotations, the way from A's body to B's in the model's axes */
    _Alignas(64) tl_lanes9 r_a, r_b;
    tl_lanes3 apart;
    /* their faces: corners counter-clockwise seen against the patch's normal, B's in B's frame */
    tl_lanes3 a[TL_OUTLINE_CORNERS], b[TL_OUTLINE_CORNERS], normal_a, normal_b;
    tl_batch1 offset_a, offset_b;
    tl_batch1 near, least, reach; /* corners nearer to each other are one; least area; largest gap */
    /* the patches */
    uint64_t laid[TL_LANES];      /* whether there is one, of full corners that stand clear */
    tl_outline outline[TL_LANES]; /* its corners */
    tl_batch_point middles[TL_OUTLINE_CORNERS], corners[TL_OUTLINE_CORNERS], centroid;
    tl_lanes9 turn; /* as in a tl_pair_view */
    tl_lanes3 shift;
    tl_batch1 area;          /* in all */
    tl_batch1 ride;          /* tl_facet */
    tl_lanes3 placed_b;      /* B's normal, A's frame */
    tl_batch1 placed_offset; /* B's plane's */
    /* what is not in columns */
    uint32_t na[TL_LANES], nb[TL_LANES], faces[TL_LANES];
    uint32_t used; /* bits of the lanes that have a pair */
    bool alike;    /* all outlines are, as in rock cut by a few sets of joints */
    double steep;  /* square of the sine of the tilt beyond which there is no patch */
    tl_point_rule rule;
    tl_outline found[TL_OUTLINES];
} tl_patch_batch;

/* The thread's batch, empty; NULL when out of memory. Points are at corners only, or not; faces tilted so that
 * the square of the sine between them is more than `steep` have no patch. */
tl_patch_batch *tl_batch_begin(tl_narrow_scratch *scratch, bool corners, double steep);
/* Whether two faces are for a batch. */
static inline bool tl_batch_takes(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb)
{
    return tl_poly_face_size(a, fa) <= TL_OUTLINE_CORNERS && tl_poly_face_size(b, fb) <= TL_OUTLINE_CORNERS;
}
/* Puts two faces, of blocks the smaller of which has this size, into a lane: where they are is yet to be
 * told. Patches with every gap beyond `reach` are left out. */
void tl_batch_add(tl_patch_batch *batch, uint32_t lane, const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb,
                  double size, double reach);
/* Lays the patches of all lanes. */
void tl_batch_lay(tl_patch_batch *batch);
/* A lane that is laid has as many points as tl_patch_lay gives it, in the same order. They are `middles` middles (0
 * where points are at corners only), `corners` corners, and the centroid if `centroid`. */
typedef struct tl_batch_counts {
    uint32_t middles, corners, all;
    bool centroid;
} tl_batch_counts;

static inline tl_batch_counts tl_batch_count(const tl_patch_batch *b, uint32_t lane)
{
    tl_batch_counts n = {.corners = b->outline[lane].count, .centroid = b->centroid.area[lane] > 0};
    n.middles = b->rule.middle > 0 ? n.corners : 0;
    n.all = n.middles + n.corners + n.centroid;
    return n;
}

/* Whether a lane's points, counted, have these keys, which are `stride` apart. */
static inline bool tl_batch_has_keys(const tl_patch_batch *b, uint32_t lane, tl_batch_counts n, const uint32_t *key,
                                     size_t stride)
{
    const tl_outline *o = &b->outline[lane];
    uint32_t faces = b->faces[lane], others = 0;
    for (uint32_t k = 0; k < n.middles; k++)
        others |= faces ^ o->middle_key[k] ^ key[k * stride];
    for (uint32_t k = 0; k < n.corners; k++)
        others |= faces ^ o->key[k] ^ key[(n.middles + k) * stride];
    if (n.centroid)
        others |= faces ^ tl_key_of(TL_POINT_CENTROID, 0, 0) ^ key[(n.all - 1) * stride];
    return others == 0;
}

/* Rotations of the bodies of a lane, and the way from A's to B's in the model's axes. */
static inline void tl_batch_between(tl_patch_batch *batch, uint32_t lane, const tl_mat3 *r_a, const tl_mat3 *r_b,
                                    tl_vec3 apart)
{
    tl_lanes9_put(&batch->r_a, lane, r_a);
    tl_lanes9_put(&batch->r_b, lane, r_b);
    tl_lanes3_put(&batch->apart, lane, apart);
}

#endif
