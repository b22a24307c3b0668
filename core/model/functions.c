/* functions.c - the parameters of the kernel's own functions, declared once. The check of what a script gives, the
 * defaults and the help text all read these tables.
 *
 * A function whose arguments are positional ("cycle", "write_vtk") is listed with them as if they
 * were named. What a table of parameters cannot express (functions, nested tables, lists of
 * blocks) belongs to the front end, which adds it to the help. */
#include "model/functions.h"

#include <math.h>
#include <string.h>
#include <talus/talus.h>

typedef struct profile_args {
    int32_t on;
} profile_args;

typedef struct write_blocks_args {
    const char *path;
} write_blocks_args;

static const char *const filter_actions[] = {
    [TL_FILTER_REPORT] = "report", [TL_FILTER_DELETE] = "delete", [TL_FILTER_JOIN] = "join", NULL};

static const char *const point_names[] = {"consistent", "corners", NULL};
static const char *const rotation_names[] = {"exact", "paper", NULL};
static const char *const timestep_names[] = {"paper", "body", "balance", NULL};

/* A test adds a setting by one row here. */
#ifndef MORE_MODEL_PARAMS
#define MORE_MODEL_PARAMS
#endif

/* A row that is not TL_PARAM_PASSING is a setting: models save, restore and hash it. */
static const tl_param model_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_model_config, gravity, "m/s2", "acceleration of gravity", .def = {0.0, 0.0, -9.81}),
    TL_PARAM(TL_PARAM_INT, tl_model_config, seed, "", "seed of every random draw: the same seed gives the same model",
             .def = {1.0}, .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_model_config, threads, "", "number of threads; results do not depend on it", .def = {1.0},
             .min = 1.0, .max = 256.0, .flags = TL_PARAM_PASSING),
    TL_PARAM(TL_PARAM_ENUM, tl_model_config, rotation, "",
             "how blocks turn: Euler's equations, or the paper's single moment of inertia", .def = {TL_ROTATION_EXACT},
             .choices = rotation_names),
    TL_PARAM(TL_PARAM_BOOL, tl_model_config, reuse_geometry, "",
             "whether a field contact that hardly moved goes by slopes of its force", .def = {1.0}),
    TL_PARAM(TL_PARAM_ENUM, tl_model_config, contact_points, "",
             "where the points of a face-face contact lie: also inside, which integrates the pressure of elastic faces "
             "exactly, or at the corners only, up to a tilt of 5 degrees: springs as those of rigid statics, and of "
             "rigid blocks of 3DEC; docs/how_stiff.md compares both",
             .def = {TL_POINTS_CONSISTENT}, .choices = point_names),
    MORE_MODEL_PARAMS};

static const tl_param insitu_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_insitu, at, "m",
             "point at whose height the stress holds; the gradient counts from there", .def = {0.0, 0.0, 0.0}),
};

typedef struct modes_args {
    int64_t count;
} modes_args;

static const tl_param modes_params[] = {
    TL_PARAM(TL_PARAM_INT, modes_args, count, "", "how many vibrations, the slowest first", .def = {6.0}, .min = 1.0,
             .max = 1000.0),
};

static const tl_param seat_params[] = {
    TL_PARAM(
        TL_PARAM_REAL, tl_seat, gap, "m",
        "gaps up to which faces are taken as being on each other; when left out 1 % of the mean size of the blocks",
        .min = 0, .max = INFINITY, .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_seat, overlap, "m",
             "overlaps up to which blocks are taken as only touching; when left out 1 % of the mean size of the blocks",
             .min = 0, .max = INFINITY, .flags = TL_PARAM_OPTIONAL),
};

/* The components of insitu's two tensors, as members of a tl_sym3. */
static const tl_param tensor_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_sym3, xx, "Pa or Pa/m", "normal component, tension positive", .def = {0.0}),
    TL_PARAM(TL_PARAM_REAL, tl_sym3, yy, "Pa or Pa/m", "normal component, tension positive", .def = {0.0}),
    TL_PARAM(TL_PARAM_REAL, tl_sym3, zz, "Pa or Pa/m", "normal component, tension positive", .def = {0.0}),
    TL_PARAM(TL_PARAM_REAL, tl_sym3, xy, "Pa or Pa/m", "shear component", .def = {0.0}, .alias = "yx"),
    TL_PARAM(TL_PARAM_REAL, tl_sym3, yz, "Pa or Pa/m", "shear component", .def = {0.0}, .alias = "zy"),
    TL_PARAM(TL_PARAM_REAL, tl_sym3, zx, "Pa or Pa/m", "shear component", .def = {0.0}, .alias = "xz"),
};

static const tl_param timestep_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_timestep, fraction, "",
             "share of the critical step that is used, FRAC of (27); when left out 0.5, by the rule paper 0.1, by the "
             "rule balance 1",
             .min = TL_FRACTION_LEAST, .max = TL_FRACTION_MOST, .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_ENUM, tl_timestep, rule, "",
             "critical step from the lightest block and the stiffest contact (paper), or from each body's own mass and "
             "stiffness (body). balance is for collapses: the critical step of body, and field contacts in motion by "
             "slopes of their force, both as far as the energy balance allows; with dt the slopes only",
             .def = {TL_TIMESTEP_BODY}, .choices = timestep_names),
    TL_PARAM(TL_PARAM_REAL, tl_timestep, dt, "s", "a fixed time step instead of the rule", .min = TL_STEP_LEAST,
             .max = 1 / TL_STEP_LEAST, .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_timestep, error, "",
             "rule balance: up to half of this error of the energy balance the step is the longest; from there to all "
             "of it it falls to half of that, and the slopes are used for contacts at rest only",
             .def = {TL_BALANCE_ERROR}, .min = 0.0, .max = 1.0),
    TL_PARAM(TL_PARAM_REAL, tl_timestep, zone_fraction, "",
             "of deformable blocks: share of the step up to which zones are stable, whatever their motion",
             .def = {1.0}, .min = TL_FRACTION_LEAST, .max = 1.0),
};

static const tl_param mass_scaling_params[] = {
    TL_PARAM(TL_PARAM_BOOL, tl_mass_scaling, on, "", "whether the inertia is scaled", .def = {1.0}),
    TL_PARAM(TL_PARAM_REAL, tl_mass_scaling, dt, "s",
             "for motion that is to be right: the step. Only bodies in contact whose own stable step is shorter get "
             "inertia, as much as they need for it",
             .min = TL_STEP_LEAST, .max = 1 / TL_STEP_LEAST, .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_mass_scaling, most, "",
             "with dt: mass that may be added, as a share of the mass of all bodies that can move; a step that would "
             "need more fails. Left out, 0.05",
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN | TL_PARAM_OPTIONAL),
};

static const tl_param profile_params[] = {
    TL_PARAM(TL_PARAM_BOOL, profile_args, on, "",
             "begins to time the phases of each step, from zero, or ends it; left out, gives the result so far",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param load_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_load, force, "N", "force on the body of each block", .def = {0.0, 0.0, 0.0}),
    TL_PARAM(TL_PARAM_VEC3, tl_load, moment, "N m", "moment on the body of each block", .def = {0.0, 0.0, 0.0}),
    TL_PARAM(TL_PARAM_VEC3, tl_load, at, "m",
             "point where the force acts, which goes with the body; its centroid when left out",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param contact_area_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_contact_area, fraction, "",
             "minimum area of field contacts, as a share of the smaller block's mean face area; with 0 they have no "
             "more than their own",
             .def = {TL_AREA_FRACTION}, .min = 0.0, .max = 1.0),
    TL_PARAM(TL_PARAM_REAL, tl_contact_area, absolute, "m2", "minimum area in square metres instead of the share",
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_STRING, tl_contact_area, joint, "",
             "the joint (\"J1\") or plane (\"J1:3\") it applies to; every joint when left out",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param cycle_params[] = {
    TL_PARAM(TL_PARAM_INT, tl_cycle_args, cycles, "", "number of steps to run",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MAX_OPEN, .min = 0.0, .max = INFINITY),
    TL_PARAM(TL_PARAM_INT, tl_cycle_args, every, "", "steps between calls of on_progress", .def = {500.0}, .min = 1.0,
             .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
};

static const char *const ratio_measures[] = {
    [TL_RATIO_AVERAGE] = "average", [TL_RATIO_MAXIMUM] = "maximum", [TL_RATIO_LOCAL] = "local", NULL};

const char *tl_ratio_measure_name(tl_ratio_measure measure)
{
    return ratio_measures[measure];
}

static const tl_param solve_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_solve, ratio, "", "ends when the unbalanced force ratio falls below this; 0 for never",
             .def = {1e-5}, .min = 0.0, .max = 1.0),
    TL_PARAM(TL_PARAM_ENUM, tl_solve, measure, "",
             "which unbalanced force ratio ends the run: see theory.md, Convergence", .def = {TL_RATIO_LOCAL},
             .choices = ratio_measures),
    TL_PARAM(TL_PARAM_REAL, tl_solve, velocity, "m/s", "ends when no block is faster than this",
             .flags = TL_PARAM_OPTIONAL, .min = 0.0, .max = INFINITY),
    TL_PARAM(TL_PARAM_BOOL, tl_solve, stop_at_failure, "", "ends when some block is seen to fail steadily",
             .def = {0.0}),
    TL_PARAM(TL_PARAM_INT, tl_solve, max_cycles, "", "largest number of steps of this call", .def = {1000000.0},
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_solve, max_time, "s", "longest simulated time of this call", .min = 0.0, .max = INFINITY,
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_solve, every, "", "steps between calls of on_progress and stop", .def = {500.0},
             .min = 1.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
};

static const tl_param relax_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_relax, ratio, "", "ends when the unbalanced force ratio falls below this", .def = {1e-5},
             .min = 0.0, .max = 1.0, .flags = TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_ENUM, tl_relax, measure, "", "which unbalanced force ratio ends it: see theory.md, Convergence",
             .def = {TL_RATIO_LOCAL}, .choices = ratio_measures),
    TL_PARAM(TL_PARAM_BOOL, tl_relax, stop_at_failure, "", "ends when some block is seen to fail steadily",
             .def = {1.0}),
    TL_PARAM(TL_PARAM_INT, tl_relax, max_cycles, "", "largest number of steps of this call", .def = {1000000.0},
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_relax, load_steps, "",
             "gravity and loads come on in so many equal parts, each near rest before the next: put on at once they "
             "settle a rock mass some per cent deeper, and zones yield that would not, for both follow their path. For "
             "loads that come on for the first "
             "time: a model that has borne them before is unloaded first",
             .def = {1.0}, .min = 1.0, .max = 10000.0),
    TL_PARAM(TL_PARAM_INT, tl_relax, every, "", "steps between calls of on_progress and stop", .def = {500.0},
             .min = 1.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
};

static const tl_param write_vtk_params[] = {
    TL_PARAM(TL_PARAM_BOOL, tl_vtk_parts, blocks, "", "whether the frame has a file of the blocks", .def = {1.0}),
    TL_PARAM(TL_PARAM_BOOL, tl_vtk_parts, contacts, "", "whether the frame has a file of the contacts", .def = {1.0}),
    TL_PARAM(TL_PARAM_BOOL, tl_vtk_parts, joints, "", "whether the frame has a file of the faces that joints made",
             .def = {1.0}),
    TL_PARAM(TL_PARAM_BOOL, tl_vtk_parts, elements, "", "whether the frame has a file of the elements", .def = {1.0}),
    TL_PARAM(TL_PARAM_BOOL, tl_vtk_parts, zones, "", "whether the frame has a file of the zones of deformable blocks",
             .def = {1.0}),
};

static const tl_param write_html_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_html, title, "", "title of the page; the name at the end of its path when left out",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param view_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_view_options, title, "", "title of the page", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_BOOL, tl_view_options, commands, "", "whether commands are taken; without, the page only shows",
             .def = {1.0}),
    TL_PARAM(TL_PARAM_REAL, tl_view_options, share, "", "most of the run's time that goes into frames", .def = {0.02},
             .min = 0.0, .max = 1.0, .flags = TL_PARAM_MIN_OPEN),
};

static const tl_param write_blocks_params[] = {
    TL_PARAM(TL_PARAM_STRING, write_blocks_args, path, "", "name of the file", .flags = TL_PARAM_REQUIRED),
};

static const tl_param write_section_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_halfspace, dip, "deg", "dip of the plane below horizontal", .flags = TL_PARAM_REQUIRED,
             .min = 0.0, .max = 90.0),
    TL_PARAM(TL_PARAM_REAL, tl_halfspace, dip_direction, "deg", "its dip direction, clockwise from north (+y)",
             .def = {0.0}, .min = 0.0, .max = 360.0),
    TL_PARAM(TL_PARAM_VEC3, tl_halfspace, origin, "m", "a point on the plane", .def = {0.0, 0.0, 0.0}),
};

static const tl_param filter_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_filter, volume, "m3", "blocks smaller than this are slivers", .min = 0.0,
             .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_filter, edge, "m", "blocks with a shorter edge are slivers", .min = 0.0, .max = INFINITY,
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_filter, aspect, "",
             "blocks whose diameter is more than this times their thickness are slivers", .min = 1.0, .max = INFINITY,
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_ENUM, tl_filter, action, "",
             "what is done with them: nothing; they are deleted; or each is joined to the block it shares the largest "
             "face with; joined when left out with auto = true",
             .choices = filter_actions),
    {.size = sizeof(tl_param),
     .type = TL_PARAM_BOOL,
     .name = "auto",
     .unit = "",
     .doc = "no limits are given: they are chosen so that little rock is beyond them, without which the time step is "
            "much longer; none where no filter gains a factor of two",
     .offset = offsetof(tl_filter, automatic)},
};

static const tl_param keyblocks_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_keyblock_query, gravity, "m/s2",
             "acceleration that acts on the blocks; that of the model when left out", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_keyblock_query, target, "",
             "factor of safety that is asked for: each keyblock then tells the support that it takes", .min = 0.0,
             .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
};

static const char *const failed_blocks[] = {"delete", "hold", NULL};

/* What factor_of_safety and safety_map have in common. */
#define SAFETY_PARAMS                                                                                                  \
    TL_PARAM(TL_PARAM_INT, tl_safety, max_cycles, "",                                                                  \
             "largest number of steps of one trial; one that is undecided then counts as failing", .def = {100000.0},  \
             .min = 1.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),                                                 \
        TL_PARAM(TL_PARAM_INT, tl_safety, workers, "",                                                                 \
                 "processes that make trials at once; what is found is the same for any number", .def = {1.0},         \
                 .min = 1.0, .max = 256.0),                                                                            \
        TL_PARAM(TL_PARAM_BOOL, tl_safety, solids, "",                                                                 \
                 "whether the strengths of deformable blocks' solids are divided, too", .def = {1.0}),                 \
        TL_PARAM(TL_PARAM_BOOL, tl_safety, elements, "",                                                               \
                 "whether the strengths of elements, such as bolts, are divided, too", .def = {0.0})

static const tl_param factor_of_safety_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_safety, from, "", "least factor that is tried", .def = {0.1}, .min = 0.05,
             .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_safety, to, "", "largest factor that is tried; above `from`", .def = {10.0}, .min = 0.05,
             .max = INFINITY, .flags = TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_safety, resolution, "", "relative width of the bracket that is found", .def = {0.01},
             .min = 1e-4, .max = 0.5),
    TL_PARAM(TL_PARAM_REAL, tl_safety, least_volume, "m3",
             "what fails and is smaller than this in all is deleted in the copies and listed, and the search goes on",
             .def = {0.0}, .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    SAFETY_PARAMS,
};

static const tl_param safety_map_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_safety, from, "", "least factor that is tried", .def = {0.5}, .min = 0.05,
             .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_safety, to, "", "largest factor that is tried; above `from`", .def = {3.0}, .min = 0.05,
             .max = INFINITY, .flags = TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_safety, step, "", "from one factor to the next", .def = {0.02}, .min = 1e-3,
             .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    {.size = sizeof(tl_param),
     .type = TL_PARAM_ENUM,
     .name = "failed",
     .unit = "",
     .doc = "what becomes of blocks that have failed, in the copies: they are deleted, or held where they were",
     .offset = offsetof(tl_safety, hold),
     .choices = failed_blocks},
    SAFETY_PARAMS,
};

static const char *const record_quantities[] = {"acceleration", "velocity", NULL};
static const char *const record_units[] = {"own", "m/s2", "g", "cm/s2", "m/s", "cm/s", NULL};
static const char *const record_baselines[] = {"as_is", "mean", "parabola", NULL};

static const tl_param record_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_record_options, file, "",
             "lines of numbers, or PEER's AT2 or VT2; or give samples in `at`",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FILE),
    TL_PARAM(TL_PARAM_INT, tl_record_options, column, "",
             "which number of each line it is; 0: the last of two, all of a file that tells NPTS", .def = {0.0},
             .min = 0.0, .max = 64.0),
    TL_PARAM(TL_PARAM_REAL, tl_record_options, dt, "s", "from one sample to the next; 0: as the file says",
             .def = {0.0}, .min = 0.0, .max = INFINITY),
    TL_PARAM(TL_PARAM_ENUM, tl_record_options, quantity, "", "what the samples are", .def = {TL_RECORD_ACCELERATION},
             .choices = record_quantities),
    TL_PARAM(TL_PARAM_ENUM, tl_record_options, unit, "",
             "of the samples; own: as the file says, or m/s2 and m/s; g is 9.80665 m/s2", .def = {TL_RECORD_UNIT_OWN},
             .choices = record_units),
    TL_PARAM(TL_PARAM_REAL, tl_record_options, scale, "", "by which the samples are multiplied", .def = {1.0},
             .min = -INFINITY, .max = INFINITY),
    TL_PARAM(TL_PARAM_ENUM, tl_record_options, baseline, "",
             "what is taken off a motion that drifts: nothing, the mean acceleration, or the parabola that fits the "
             "velocity best",
             .def = {TL_BASELINE_NONE}, .choices = record_baselines),
};

static const tl_param law_test_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_law_test, law, "", "name of the law", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, tl_law_test, normal_stress, "Pa",
             "normal stress, compression positive, which is held by closing and opening; when left out the closure is "
             "given, and begins at 0",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_law_test, stiffness, "Pa/m",
             "normal stiffness of the surroundings: normal_stress is that of the start, and rises by so much a metre "
             "of dilation",
             .flags = TL_PARAM_OPTIONAL, .min = 0.0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, tl_law_test, speed, "m/s", "speed of shear, or of closing where nothing is sheared",
             .def = {1e-5}, .min = 0.0, .max = INFINITY, .flags = TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_law_test, steps, "", "steps of each leg of the path", .def = {200.0}, .min = 1.0,
             .max = TL_LAW_TEST_STEPS),
    TL_PARAM(TL_PARAM_INT, tl_law_test, every, "",
             "steps from one point of the curve to the next; the end of a leg is always one", .def = {1.0}, .min = 1.0,
             .max = TL_LAW_TEST_STEPS),
};

static const tl_param law_leg_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_law_leg, shear, "m", "shear displacement at the end of the leg",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_law_leg, closure, "m",
             "closure at its end, opening negative; without normal_stress of the test only",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_law_leg, normal_stress, "Pa",
             "normal stress at its end; with normal_stress and without stiffness of the test only",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, tl_law_leg, time, "s",
             "how long the leg takes; when left out its length over the speed, or 1 s of one without length",
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_REAL, tl_law_leg, speed, "m/s", "in the place of the test's", .min = 0.0, .max = INFINITY,
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_law_leg, steps, "", "in the place of the test's", .min = 1.0, .max = TL_LAW_TEST_STEPS,
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param solid_test_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_solid_test, solid, "", "name of the solid", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, tl_solid_test, extent, "m",
             "extent of the zone, the cube root of its volume, which solids may ask for", .def = {1.0}, .min = 0.0,
             .max = INFINITY, .flags = TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_INT, tl_solid_test, steps, "", "steps of each leg of the path", .def = {100.0}, .min = 1.0,
             .max = TL_SOLID_TEST_STEPS),
    TL_PARAM(TL_PARAM_INT, tl_solid_test, every, "",
             "steps from one point of the curve to the next; the end of a leg is always one", .def = {1.0}, .min = 1.0,
             .max = TL_SOLID_TEST_STEPS),
};

static const tl_param solid_leg_params[] = {
    TL_PARAM(TL_PARAM_INT, tl_solid_leg, steps, "", "in the place of the test's", .min = 1.0,
             .max = TL_SOLID_TEST_STEPS, .flags = TL_PARAM_OPTIONAL),
};

#define COMPONENT(name, other)                                                                                         \
    TL_PARAM(TL_PARAM_REAL, tl_sym3, name, "Pa or 1", "component, tension positive", .alias = (other),                 \
             .flags = TL_PARAM_OPTIONAL)
static const tl_param components_params[] = {
    COMPONENT(xx, NULL), COMPONENT(yy, NULL), COMPONENT(zz, NULL),
    COMPONENT(xy, "yx"), COMPONENT(yz, "zy"), COMPONENT(zx, "xz"),
};

typedef struct model_function {
    const char *name, *doc;
    const tl_param *params;
    size_t count;
} model_function;

#define PARAMS(table) table, sizeof(table) / sizeof(table)[0]

static const model_function functions[] = {
    {"model", "Makes an empty model.", PARAMS(model_params)},
    {"insitu", "Puts an initial stress in the zones, and on the face contacts, that exist now, once.",
     PARAMS(insitu_params)},
    {"modes", "Finds the slowest vibrations of small size about the present place of a model at rest.",
     PARAMS(modes_params)},
    {"seat",
     "Takes blocks as drawn as fitting: gaps and overlaps up to a limit become the state free of force, under any law. "
     "Contacts are free of force after it. Prints and returns what was found.",
     PARAMS(seat_params)},
    {"tensor", "A symmetric tensor by its components.", PARAMS(tensor_params)},
    {"timestep", "Chooses how the time step is found.", PARAMS(timestep_params)},
    {"mass_scaling",
     "Scales the inertia, not the weight, of free bodies up to that of the one with the longest stable step, for "
     "finding equilibria: times and velocities then mean nothing. With dt it is for dynamics: inertia is added to the "
     "few bodies that need it. Without arguments it tells what the last step has added.",
     PARAMS(mass_scaling_params)},
    {"load",
     "Puts a force and a moment, along the axes of the model, on the bodies of blocks, in the place of what they had; "
     "none at all takes the load off.",
     PARAMS(load_params)},
    {"contact_area",
     "Sets the minimum area of field contacts: those of edges, vertices and tilted faces. None by default.",
     PARAMS(contact_area_params)},
    {"cycle", "Runs a number of steps.", PARAMS(cycle_params)},
    {"solve", "Runs until the forces balance or a limit is met.", PARAMS(solve_params)},
    {"relax",
     "Finds where the model rests, or that it does not, by the cheapest means. Time, damping, time step and masses are "
     "afterwards as before, and nothing moves.",
     PARAMS(relax_params)},
    {"profile", "Times the phases of the steps, and tells what a step works on.", PARAMS(profile_params)},
    {"write_vtk",
     "Writes the next frame of a series of VTK files for ParaView, all of it or some of its files. Their names begin "
     "with the folder and the name given first.",
     PARAMS(write_vtk_params)},
    {"write_section",
     "Writes the next frame of a section: the polygons in which a plane cuts the blocks, with their displacements.",
     PARAMS(write_section_params)},
    {"write_html",
     "Adds a frame to a page for a browser: one file that shows the blocks, in every frame so far. The folder and the "
     "name are given first, with or without .html.",
     PARAMS(write_html_params)},
    {"view",
     "Shows the model in a browser while it runs, and takes commands from there. Gives the address to open. The page "
     "shows the model whenever a run makes steps, and while view waits.",
     PARAMS(view_params)},
    {"write_blocks",
     "Writes all blocks as they stand into a JSON file. A name that ends in .obj, .stl, .ply or .vtk gets surfaces.",
     PARAMS(write_blocks_params)},
    {"filter", "Finds slivers, the visible blocks beyond the limits, and deletes them or joins them to neighbours.",
     PARAMS(filter_params)},
    {"keyblocks",
     "Finds the bodies that a translation can move out of the others (Shi's theorem), how they move, and their factor "
     "of safety in limit equilibrium.",
     PARAMS(keyblocks_params)},
    {"factor_of_safety",
     "Finds by how much the strengths of laws and solids may be divided before the model does not come to rest any "
     "more. Trials are made on copies: the model stays as it is.",
     PARAMS(factor_of_safety_params)},
    {"safety_map",
     "Finds the factor of safety of every block: strengths are divided by more and more, and what has failed goes "
     "before it goes on. Trials are made on copies: the model stays as it is.",
     PARAMS(safety_map_params)},
    {"law_test",
     "Tries a joint law on one contact point, without a model: direct shear under a constant normal stress, or in "
     "surroundings of constant normal stiffness, and closure tests.",
     PARAMS(law_test_params)},
    {"record", "A record of ground motion, which blocks follow as selection:drive{velocity = {rec, 0, 0}}.",
     PARAMS(record_params)},
    {"law_leg", "One leg of the path of a law_test.", PARAMS(law_leg_params)},
    {"solid_test",
     "Tries a solid on one zone, without a model: any path of strains that are driven and stresses that are held.",
     PARAMS(solid_test_params)},
    {"solid_leg", "One leg of the path of a solid_test.", PARAMS(solid_leg_params)},
    {"components", "Components of a stress or a strain, those that are meant.", PARAMS(components_params)},
};

#define FUNCTION_COUNT (sizeof functions / sizeof functions[0])

const tl_param *tl_function_params(const char *function, size_t *count, const char **doc)
{
    for (size_t i = 0; i < FUNCTION_COUNT; i++) {
        if (strcmp(functions[i].name, function) != 0)
            continue;
        if (count)
            *count = functions[i].count;
        if (doc)
            *doc = functions[i].doc;
        return functions[i].params;
    }
    return NULL;
}
