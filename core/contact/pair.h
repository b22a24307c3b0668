/* pair.h - two blocks that may come near, as the broad phase lists them: there are many, so each is kept small. */
#ifndef TL_CONTACT_PAIR_H
#define TL_CONTACT_PAIR_H

#include <assert.h>
#include <math.h>

#include "geometry/polyhedron.h"

/* Twice the number of any face and one more. */
#define TL_PAIR_FACE 0x1fffu
static_assert(2 * TL_POLY_MAX_FACES - 1 <= TL_PAIR_FACE, "faces do not fit into a pair");

/* Two blocks that may come near. */
typedef struct tl_pair {
    uint32_t a, b; /* block rows, a < b */
    /* row of the contact; or, without one, TL_PAIR_APART and the faces */
    uint32_t contact;
    union {
        float wake; /* without a contact: sum of the blocks' path lengths at which to test again, or TL_PAIR_FOUND */
        uint16_t want_points; /* of a contact that must grow: room */
        uint32_t faces;       /* of one that has no points */
    };
} tl_pair;

/* The order of two pairs of blocks, for qsort and bsearch. */
static inline int tl_pair_order(uint32_t a, uint32_t b, uint32_t other_a, uint32_t other_b)
{
    if (a != other_a)
        return a < other_a ? -1 : 1;
    return (b > other_b) - (b < other_b);
}

/* Without a contact. */
#define TL_PAIR_APART 0x80000000u

static inline bool tl_pair_is_apart(const tl_pair *p)
{
    return p->contact >= TL_PAIR_APART;
}

/* Two faces that show whether a pair still touches without area (grazing.c), twice the number and one more for a
 * face of B; the same: none. */
typedef struct tl_pair_faces {
    uint32_t one, other;
} tl_pair_faces;

static inline tl_pair_faces tl_pair_faces_of(const tl_pair *p)
{
    uint32_t both = tl_pair_is_apart(p) ? p->contact : p->faces;
    return (tl_pair_faces){both & TL_PAIR_FACE, both >> 13 & TL_PAIR_FACE};
}

static inline void tl_pair_set_faces(tl_pair *p, tl_pair_faces faces)
{
    uint32_t both = faces.one | faces.other << 13;
    if (tl_pair_is_apart(p))
        p->contact = TL_PAIR_APART | both;
    else
        p->faces = both;
}

static inline void tl_pair_forget_faces(tl_pair *p)
{
    tl_pair_set_faces(p, (tl_pair_faces){0, 0});
}

/* A pair that was tested and is near enough to become a contact. */
#define TL_PAIR_FOUND (-INFINITY)

/* Pairs a worker takes at a time, and what is known of them together. */
#define TL_PAIR_CHUNK 256
typedef struct tl_pair_chunk {
    float wake; /* none without a contact has an earlier one */
    bool found; /* some pair is */
} tl_pair_chunk;

#endif
