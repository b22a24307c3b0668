/* cuts.h - what a model notes of the cuts of its blocks. */
#ifndef TL_MODEL_CUTS_H
#define TL_MODEL_CUTS_H

#include <talus/talus.h>
#include <talus/vmath.h>

/* What has been done to the blocks since the model was made, for its report. */
typedef struct tl_cut_record {
    size_t cuts, refused, coincident;
    double created, deleted; /* volumes, m3 */
    tl_refused_cut *list;
    size_t listed;
} tl_cut_record;

/* A part of a block that was cut since contacts were brought up to date last: these know the whole, its root. */
typedef struct tl_cut_part {
    tl_id id, root;
    tl_mat3 r;     /* rotation of the root's body, */
    tl_vec3 place; /* and its centroid, relative to the origin */
} tl_cut_part;

/* A block of a body that cuts have split since the last step. Two blocks were in one body in the last step when they
 * have the same `whole`, the id of that body. */
typedef struct tl_split {
    tl_id block, whole;
} tl_split;

/* What a traction on a face of a block has put on its body: force, and moment about the centroid of the face, in axes
 * of the model. It is part of the body's load. */
typedef struct tl_face_load {
    tl_id block;
    uint32_t face;
    tl_vec3 force, moment;
} tl_face_load;

/* Limit: most refused cuts that are listed; more are only counted. */
#define TL_REFUSED_LISTED 1000

#endif
