/* kinds.c - tables of the kinds "quiet", "free_field" and "incoming", and their plugin. */
#include "kinds.h"

#include <talus/version.h>

/* ---------------------------------------------------------------- quiet ------------------ */

static const tl_param quiet_param_table[] = {
    TL_PARAM(TL_PARAM_STRING, quiet_params, faces, "",
             "Numbers: block, face (from 0), area (m2), height (m) and density (kg/m3), of one face after the other.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, quiet_params, kn, "Pa/m", "Normal stiffness of the joints.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, quiet_params, ks, "Pa/m", "Shear stiffness of the joints.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, quiet_params, p_velocity, "m/s",
             "In the place of kn: of pressure waves in what was cut off.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, quiet_params, s_velocity, "m/s", "In the place of ks: of shear waves in what was cut off.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_STRING, quiet_params, input_x, "",
             "Incoming wave along x, numbers: time of its begin (s), time between samples (s), then displacement (m) "
             "and velocity (m/s) of each sample.",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, quiet_params, input_y, "", "Incoming wave along y, likewise.",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, quiet_params, input_z, "", "Incoming wave along z, likewise.",
             .flags = TL_PARAM_OPTIONAL)};

static const tl_state quiet_state_table[] = {TL_STATE(TL_STATE_SCALAR, "shift_x", "m", "displacement of the dashpot"),
                                             TL_STATE(TL_STATE_SCALAR, "shift_y", "m", "likewise"),
                                             TL_STATE(TL_STATE_SCALAR, "shift_z", "m", "likewise"),
                                             TL_STATE(TL_STATE_WHOLE, "normal_x", "", "outward normal when placed"),
                                             TL_STATE(TL_STATE_WHOLE, "normal_y", "", "likewise"),
                                             TL_STATE(TL_STATE_WHOLE, "normal_z", "", "likewise"),
                                             TL_STATE(TL_STATE_WHOLE, "face", "", "of the block, from 1"),
                                             TL_STATE(TL_STATE_WHOLE, "height", "m", "of the block across the face"),
                                             TL_STATE(TL_STATE_WHOLE, "density", "kg/m3", "of what was cut off")};

/* ---------------------------------------------------------------- free field ------------- */

static const tl_param free_param_table[] = {
    TL_PARAM(
        TL_PARAM_STRING, free_field_params, faces, "",
        "Numbers: block, face (from 0), area (m2), width (m), density (kg/m3) and held components (1 x, 2 y, 4 z, 8 "
        "rotation), of one face after the other.",
        .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, free_field_params, kn, "Pa/m", "Normal stiffness of the joints of the column.",
             .flags = TL_PARAM_PLACE | TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, ks, "Pa/m", "Shear stiffness likewise.",
             .flags = TL_PARAM_PLACE | TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, p_velocity, "m/s",
             "In the place of kn: of pressure waves in the column.",
             .flags = TL_PARAM_PLACE | TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, s_velocity, "m/s", "In the place of ks: of shear waves.",
             .flags = TL_PARAM_PLACE | TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, base_kn, "Pa/m",
             "Of a quiet base: as kn, of what was cut off below. Without it the lowest level is held.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, base_ks, "Pa/m", "Likewise, as ks.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, base_p_velocity, "m/s", "Likewise, as p_velocity.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, base_s_velocity, "m/s", "Likewise, as s_velocity.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, base_density, "kg/m3",
             "Likewise, density; that of the lowest level when left out.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_STRING, free_field_params, input_x, "",
             "Wave along x that comes in through a quiet base, numbers as of the kind quiet.",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, free_field_params, input_y, "", "Likewise along y.", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, free_field_params, input_z, "", "Likewise along z.", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, free_field_params, alpha, "1/s", "Damping of the levels by their mass.", .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, free_field_params, beta, "s", "Damping of the levels by their stiffness.", .max = 1e50)};

static const tl_state free_state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "shift_x", "m", "displacement of the dashpot; of the lowest level: that of the base"),
    TL_STATE(TL_STATE_SCALAR, "shift_y", "m", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "shift_z", "m", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "level", "", "of a face: its level, from 1 at the bottom; of a level: what is held"),
    TL_STATE(TL_STATE_SCALAR, "moved_x", "m", "displacement of a level"),
    TL_STATE(TL_STATE_SCALAR, "moved_y", "m", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "moved_z", "m", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "speed_x", "m/s", "velocity of a level"),
    TL_STATE(TL_STATE_SCALAR, "speed_y", "m/s", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "speed_z", "m/s", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "turn", "rad", "of a level about the horizontal axis along the side"),
    TL_STATE(TL_STATE_SCALAR, "spin", "rad/s", "likewise"),
    TL_STATE(TL_STATE_SCALAR, "height", "m", "of a level"),
    TL_STATE(TL_STATE_SCALAR, "density", "kg/m3", "of a level"),
    TL_STATE(TL_STATE_SCALAR, "kn", "Pa/m", "of a level"),
    TL_STATE(TL_STATE_SCALAR, "ks", "Pa/m", "of a level"),
    TL_STATE(TL_STATE_WHOLE, "normal_x", "", "outward normal of the side"),
    TL_STATE(TL_STATE_WHOLE, "normal_y", "", "likewise"),
    TL_STATE(TL_STATE_WHOLE, "levels", "", "nodes that are levels, the first ones"),
    TL_STATE(TL_STATE_WHOLE, "step", "s", "time step before the last one"),
    TL_STATE(TL_STATE_WHOLE, "base_turn", "rad", "turn of the dashpot of the base")};

/* ---------------------------------------------------------------- incoming --------------- */

static const tl_param incoming_param_table[] = {
    TL_PARAM(TL_PARAM_STRING, incoming_params, nodes, "",
             "Numbers: block, face (from 0), place (m), outward normal, area (m2) and impedances of pressure and shear "
             "waves (Pa s/m), of one gridpoint after the other.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_STRING, incoming_params, input_x, "", "Incoming wave along x, numbers as of the kind quiet.",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, incoming_params, input_y, "", "Likewise along y.", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, incoming_params, input_z, "", "Likewise along z.", .flags = TL_PARAM_OPTIONAL)};

static const tl_state incoming_state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "impedance_p", "Pa s/m", "density times the velocity of pressure waves"),
    TL_STATE(TL_STATE_SCALAR, "impedance_s", "Pa s/m", "likewise of shear waves"),
    TL_STATE(TL_STATE_WHOLE, "normal_x", "", "outward normal when placed"),
    TL_STATE(TL_STATE_WHOLE, "normal_y", "", "likewise"),
    TL_STATE(TL_STATE_WHOLE, "normal_z", "", "likewise"),
    TL_STATE(TL_STATE_WHOLE, "face", "", "of the block, from 1")};

static const tl_kind kinds[] = {
    TL_KIND(TL_KIND_ELEMENT, quiet_ops, .name = "quiet",
            .doc = "Outer faces of rigid blocks that let waves out: model:boundary.",
            TL_KIND_PARAMS(quiet_params, quiet_param_table), TL_KIND_STATES(quiet_state_table)),
    TL_KIND(TL_KIND_ELEMENT, free_field_ops, .name = "free_field",
            .doc = "Vertical sides of rigid blocks that move as the ground far away: model:boundary.",
            TL_KIND_PARAMS(free_field_params, free_param_table), TL_KIND_STATES(free_state_table)),
    TL_KIND(TL_KIND_ELEMENT, incoming_ops, .name = "incoming",
            .doc = "Waves that come in through quiet faces of deformable blocks: model:boundary.",
            TL_KIND_PARAMS(incoming_params, incoming_param_table), TL_KIND_STATES(incoming_state_table))};

TL_PLUGIN_SINCE(13, kinds, .id = "talus.quiet", .version = TALUS_VERSION, .doc = "Quiet faces and free fields.",
                .licence = "BSD-3-Clause");
