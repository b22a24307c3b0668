/* kinds.h - parameters and states of the kinds "quiet", "free_field" and "incoming". */
#ifndef QUIET_KINDS_H
#define QUIET_KINDS_H

#include <talus/kit.h>

/* ---------------------------------------------------------------- quiet ------------------ */

typedef struct quiet_params {
    const char *faces;
    double kn, ks, p_velocity, s_velocity;
    const char *input_x, *input_y, *input_z;
} quiet_params;

enum { QUIET_SHIFT_X, QUIET_SHIFT_Y, QUIET_SHIFT_Z };                                             /* of a node */
enum { QUIET_NORMAL_X, QUIET_NORMAL_Y, QUIET_NORMAL_Z, QUIET_FACE, QUIET_HEIGHT, QUIET_DENSITY }; /* of the whole */

extern const tl_element_ops quiet_ops;

/* ---------------------------------------------------------------- free field ------------- */

typedef struct free_field_params {
    const char *faces;
    double kn, ks, p_velocity, s_velocity;
    double base_kn, base_ks, base_p_velocity, base_s_velocity, base_density;
    const char *input_x, *input_y, *input_z;
    double alpha, beta;
} free_field_params;

/* Of a node. A level has its width as the weight. */
enum {
    SHIFT_X,
    SHIFT_Y,
    SHIFT_Z,
    LEVEL,
    MOVED_X,
    MOVED_Y,
    MOVED_Z,
    SPEED_X,
    SPEED_Y,
    SPEED_Z,
    TURN,
    SPIN,
    HEIGHT,
    DENSITY,
    KN,
    KS,
    NODE_STATES
};
enum { NORMAL_X, NORMAL_Y, COUNT, STEP, BASE_TURN, WHOLE_STATES }; /* of the whole */

extern const tl_element_ops free_field_ops;

/* ---------------------------------------------------------------- incoming --------------- */

typedef struct incoming_params {
    const char *nodes;
    const char *input_x, *input_y, *input_z;
} incoming_params;

enum { INCOMING_ALONG, INCOMING_ACROSS, INCOMING_NODE_STATES }; /* of a node */

extern const tl_element_ops incoming_ops;

#endif
