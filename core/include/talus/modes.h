/* talus/modes.h - frequencies and shapes of small vibrations of a model at rest. */
#ifndef TALUS_MODES_H
#define TALUS_MODES_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A free vibration. The largest displacement of a centroid in its shape is 1; where none moves the largest turn is. */
typedef struct tl_mode {
    double frequency;      /* Hz; 0: nothing resists it */
    double mass[3];        /* share of the free mass that goes with a base moving along x, y, z */
    tl_vec3 *shift, *turn; /* of each block of tl_modes: of its centroid, m, and rad */
} tl_mode;

typedef struct tl_modes {
    tl_id *block; /* those of free bodies, ascending */
    size_t block_count;
    tl_mode *mode; /* the slowest first */
    size_t count;
    tl_vec3 *memory; /* of the shapes */
} tl_modes;

/* Most vibrations that are found. */
#define TL_MODES_MOST 1000

/* Finds the slowest `count` vibrations about the present place: fewer where the free bodies have fewer freedoms.
 * Contacts are as stiff as their laws at points that press; those that slip have no stiffness along the face. Elements
 * resist as their forces change by small motions; what yields counts with the stiffness by which it unloads. Elements
 * that stand for what lies outside, as quiet faces and water, are not counted: their forces change when all nodes move
 * together. What weight and load do by turning is not in it. Each free body has six freedoms, less those held.
 *
 * TL_E_STATE: the model has made no step since its blocks were made, or is not at rest: an unbalanced force is above
 * 1e-3 of what its body bears. Also where nothing is free, some blocks are deformable, or the law of a contact is not
 * linear. TL_E_ARGUMENT: count is outside 1 to TL_MODES_MOST. Let go of the result by tl_modes_free, also after a
 * failure. */
TL_API tl_status tl_model_modes(tl_model *model, size_t count, tl_modes *modes);
TL_API void tl_modes_free(tl_modes *modes);

#ifdef __cplusplus
}
#endif
#endif
