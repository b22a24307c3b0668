/* talus/types.h - the words every part of Talus shares: ids, status codes, small vectors.
 *
 * Stands alone: a plugin that includes this file needs nothing else of Talus. */
#ifndef TALUS_TYPES_H
#define TALUS_TYPES_H

#include <stddef.h>
#include <stdint.h>

/* A function of the library that programs call. */
#define TL_API __attribute__((visibility("default")))

/* Status codes and what each means, once. A function that can fail for a reason outside the
 * programmer's control returns one of these and puts a sentence into a tl_error or tl_report. */
#define TL_STATUS_LIST(X)                                                                                              \
    X(TL_OK, "success")                                                                                                \
    X(TL_E_MEMORY, "out of memory")                                                                                    \
    X(TL_E_ARGUMENT, "a parameter has the wrong name, type or value")                                                  \
    X(TL_E_GEOMETRY, "a shape is degenerate, not convex or not closed")                                                \
    X(TL_E_NOT_FOUND, "something named does not exist")                                                                \
    X(TL_E_STALE, "a handle to something that was deleted or cut")                                                     \
    X(TL_E_STATE, "not possible in the model's present state")                                                         \
    X(TL_E_PLUGIN, "a plugin could not be loaded or broke the plugin interface")                                       \
    X(TL_E_NUMERIC, "a value that must be finite is not")                                                              \
    X(TL_E_IO, "a file could not be read or written")                                                                  \
    X(TL_E_CANCELLED, "stopped on request")

#define TL_STATUS_ENUM(name, text) name,
typedef enum tl_status { TL_STATUS_LIST(TL_STATUS_ENUM) TL_STATUS_COUNT } tl_status;
#undef TL_STATUS_ENUM

/* Identity of a block or a body: a whole number from 1 that is never used twice in a model; 0 means none. */
typedef uint32_t tl_id;
#define TL_NO_ID ((tl_id)0)

/* Identity of a contact: its blocks, the older one first, and how many steps had been made when it began. Two blocks
 * have one contact at a time. */
typedef struct tl_contact_name {
    tl_id a, b;
    int64_t born;
} tl_contact_name;

/* A zone, or a gridpoint: the body that it is of, by the lowest id of its blocks, and its number there, from 0. */
typedef struct tl_zone_name {
    tl_id body;
    uint32_t number;
} tl_zone_name;

typedef struct tl_vec3 {
    double x, y, z;
} tl_vec3;

/* Rotation as a unit quaternion, scalar first. */
typedef struct tl_quat {
    double w, x, y, z;
} tl_quat;

/* Row-major 3 x 3 matrix. */
typedef struct tl_mat3 {
    double m[3][3];
} tl_mat3;

/* Symmetric tensor (inertia, stress). */
typedef struct tl_sym3 {
    double xx, yy, zz, xy, yz, zx;
} tl_sym3;

typedef struct tl_bounds {
    tl_vec3 min, max;
} tl_bounds;

/* Oriented plane: the points x with normal . x = offset; `normal` has unit length. */
typedef struct tl_plane {
    tl_vec3 normal;
    double offset;
} tl_plane;

/* Which joint made a face: joint set (1, 2, ... in order of creation; 0 none) and the number of
 * the plane within its set (from 1). */
typedef struct tl_tag {
    uint32_t joint, plane;
} tl_tag;

#define TL_ERROR_TEXT 640

/* The record of one failure: what went wrong in one sentence, ready to be shown to the user. */
typedef struct tl_error {
    tl_status status;
    char text[TL_ERROR_TEXT];
} tl_error;

#endif
