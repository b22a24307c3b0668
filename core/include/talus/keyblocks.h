/* talus/keyblocks.h - blocks that a translation can move out of the others, and their factors of safety. Included by
 * talus.h.
 *
 * Source: Goodman and Shi, "Block theory and its application to rock engineering" (1985). */
#ifndef TALUS_KEYBLOCKS_H
#define TALUS_KEYBLOCKS_H

#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;

/* Strength of a joint in the limit equilibrium of keyblocks. */
typedef struct tl_joint_strength {
    const char *joint; /* "J1:3", "J1" or "*": of several the closest counts */
    double friction;   /* degrees, [0, 90); NaN: not given here */
    double cohesion;   /* Pa, >= 0; NaN: not given here. 0 where nothing is given */
} tl_joint_strength;

typedef struct tl_keyblock_query {
    uint32_t size;   /* sizeof(tl_keyblock_query) */
    tl_vec3 gravity; /* NaN: the model's */
    const tl_joint_strength *strength;
    size_t count;
    double target; /* factor of safety that support is to bring, > 0; NaN: none */
} tl_keyblock_query;

typedef enum tl_keyblock_mode {
    TL_KEYBLOCK_FALLING,        /* away from all its joints */
    TL_KEYBLOCK_SLIDING,        /* on one face */
    TL_KEYBLOCK_SLIDING_ON_TWO, /* along the line of two faces */
    TL_KEYBLOCK_STABLE          /* removable, but pressed in by its weight */
} tl_keyblock_mode;

/* A face that a keyblock slides on. */
typedef struct tl_keyblock_face {
    tl_tag joint;
    tl_vec3 normal;            /* outward */
    double area, normal_force; /* m2; N, compression positive */
} tl_keyblock_face;

/* A body that can be moved out by a translation. */
typedef struct tl_keyblock {
    tl_id block; /* the oldest block of the body */
    int32_t mode;
    double volume, mass; /* of the body */
    tl_vec3 force;       /* weight, load and elements, N */
    tl_vec3 direction;   /* of the motion, unit; zero when stable */
    double driving;      /* force along it, N */
    double safety;       /* factor of safety: 0 falling, infinite stable */
    tl_keyblock_face faces[2];
    size_t face_count;
    size_t edge_start, edge_count; /* edges of its joint pyramid in tl_keyblocks.edges */
    double support;                /* least force against the motion that brings the target, N; NaN without one */
    /* on the outer faces, which has that force against the motion; what it adds to normal forces is left out. Pa; NaN
     * without a target, or where outer faces do not look along the motion */
    double support_pressure;
} tl_keyblock;

typedef struct tl_keyblocks {
    tl_keyblock *blocks; /* in the order of their ids */
    size_t count;
    tl_vec3 *edges; /* unit vectors */
    size_t edge_count;
} tl_keyblocks;

/* Finds the removable ones of the bodies that can move and are not driven (Shi's theorem). Bodies are taken as they lay
 * when they were made, those that have moved by more than 1 % of their size as they lie now. */
TL_API tl_status tl_model_keyblocks(struct tl_model *model, const tl_keyblock_query *query, tl_keyblocks *keyblocks);
/* Frees the lists of a result and empties it. */
TL_API void tl_keyblocks_free(tl_keyblocks *keyblocks);

#ifdef __cplusplus
}
#endif
#endif
