/* talus/talus.h - the kernel's C interface: build a model, run it, ask it; output.h, write it; state.h, keep it;
 * law_test.h, try a joint law alone.
 *
 * Conventions. Coordinates x east, y north, z up; any consistent units (SI in the examples). Stress tensors are tension
 * positive, joint stresses and forces compression positive. Angles of planes in degrees, angular velocities in rad/s.
 *
 * Options. A struct of options begins with its `size`, and `tl_NAME_default()` gives it with the defaults of the
 * library that runs: tl_solve s = tl_solve_default(). A program then stays right when a later library of the same
 * soname appends members. NULL in the place of options means the defaults. Structs of results do not grow within one
 * soname.
 *
 * Errors. A function that can fail returns a tl_status; the sentence is then in tl_model_error(model). A failed call
 * leaves the model as it was. Functions are called from one thread per model. */
#ifndef TALUS_TALUS_H
#define TALUS_TALUS_H

#include <talus/history.h>
#include <talus/keyblocks.h>
#include <talus/law_test.h>
#include <talus/output.h>
#include <talus/plugin.h>
#include <talus/plugins.h>
#include <talus/record.h>
#include <talus/safety.h>
#include <talus/settings.h>
#include <talus/solid_test.h>
#include <talus/state.h>
#include <talus/types.h>
#include <talus/values.h>
#include <talus/verdict.h>
#include <talus/version.h>
#include <talus/view.h>
#include <talus/watch.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that runs; TALUS_VERSION is that of the headers. */
TL_API const char *tl_version(void);

typedef struct tl_model tl_model;

/* ---------------------------------------------------------------- model ------------------ */

typedef enum tl_rotation_rule {
    TL_ROTATION_EXACT, /* Euler's equations (19) in principal axes */
    TL_ROTATION_PAPER  /* one moment of inertia (20): 0.4 m r^2, r the mean centroid-vertex distance */
} tl_rotation_rule;

/* Where the points of a face-face contact lie. */
typedef enum tl_contact_points {
    TL_POINTS_CONSISTENT, /* corners, middles of edges, centroid: every linear gap integrated exactly */
    /* corners only, as in programs whose contacts are vertices on faces: 3 times as stiff against turning for a
     * rectangle, 4 times for a triangle */
    TL_POINTS_CORNERS
} tl_contact_points;

typedef struct tl_model_config {
    uint32_t size; /* sizeof(tl_model_config) */
    tl_vec3 gravity;
    int64_t seed;
    int64_t threads;  /* 1 .. 256 */
    int32_t rotation; /* tl_rotation_rule */
    int32_t reuse_geometry;
    int32_t contact_points; /* tl_contact_points */
} tl_model_config;

/* What a step depends on is not changed in the middle of one: while a drive's function runs (tl_drive), all calls that
 * change blocks, what acts on them, laws, damping or settings fail with TL_E_STATE. All may be read there. */

/* Remarks and warnings go to this function; NULL restores the default (standard error). */
typedef void (*tl_log_fn)(void *user, const char *text);

/* Makes an empty model in *model, by *config (NULL: the defaults). TL_E_ARGUMENT with a sentence for a value out of its
 * range, TL_E_MEMORY; then *model is NULL. `error` may be NULL. */
TL_API tl_status tl_model_create(const tl_model_config *config, tl_model **model, tl_error *error);
/* Frees a model and all that belongs to it; NULL is left alone. */
TL_API void tl_model_destroy(tl_model *model);
/* Status and sentence of the last call on this model that failed; valid until the next call that fails. Every function
 * that gives a tl_status leaves one. */
TL_API const tl_error *tl_model_error(const tl_model *model);
/* Sends the model's remarks to a function, with `user`. */
TL_API void tl_model_log(tl_model *model, tl_log_fn log, void *user);
/* Whether remarks and errors name the verbs of Lua as a remedy, or functions of C (the default). */
TL_API void tl_model_speak_lua(tl_model *model, int lua);

/* Writes the settings, the first `size` bytes of them, and that size. */
TL_API void tl_model_settings_get(const tl_model *model, tl_model_config *config, size_t size);
static inline tl_model_config tl_model_settings(const tl_model *model)
{
    tl_model_config config;
    tl_model_settings_get(model, &config, sizeof config);
    return config;
}
/* Acceleration of gravity, m/s2, finite (else TL_E_ARGUMENT). */
TL_API tl_status tl_model_set_gravity(tl_model *model, tl_vec3 gravity);
/* How rotations are integrated, one of tl_rotation_rule (else TL_E_ARGUMENT). */
TL_API tl_status tl_model_set_rotation(tl_model *model, tl_rotation_rule rule);
/* Whether contacts that rest are used again as they are: faster, the same within 1e-11 of their overlap. */
TL_API tl_status tl_model_set_reuse_geometry(tl_model *model, bool reuse);
/* Where patches have their points, one of tl_contact_points (else TL_E_ARGUMENT); contacts are laid anew before the
 * next step. */
TL_API tl_status tl_model_set_contact_points(tl_model *model, tl_contact_points where);
/* Simulated time, s. */
TL_API double tl_model_time(const tl_model *model);
/* Steps made so far. */
TL_API int64_t tl_model_cycles(const tl_model *model);

typedef struct tl_generate_summary {
    size_t before, after;                                 /* blocks */
    size_t cuts, refused;                                 /* cuts made; cuts refused because a side would be too thin */
    size_t coincident;                                    /* cuts that fell on an existing face */
    double smallest_volume, smallest_edge, smallest_face; /* of the model after */
    double volume_error; /* |volume after - volume before - volume created| / volume after */
    /* Blocks that this call made with an aspect over 50, or with less than 0.001 of the mean volume of a block. */
    size_t slivers;
} tl_generate_summary;

/* Runs a generator plugin on the visible blocks; commits its work whole or not at all. `summary` may be NULL. */
TL_API tl_status tl_generate(tl_model *model, const char *generator, const tl_args *args, tl_generate_summary *summary);
/* The same for several sets of parameters, one after the other on the blocks as the ones before have left them: all or
 * none. A failure names the entry, counted from 1. */
TL_API tl_status tl_generate_list(tl_model *model, const char *generator, const tl_args *args, size_t count,
                                  tl_generate_summary *summary);

/* A note of a generator on an object of a file that it has read. */
typedef struct tl_generate_note {
    const char *object; /* its name; NULL: the whole */
    const char *key;
    double number;
    const char *text; /* NULL: the number counts */
} tl_generate_note;

/* What the last generator of the model has noted, those of one object one after the other; valid until the next one
 * runs. None after one that failed. */
TL_API const tl_generate_note *tl_generate_notes(const tl_model *model, size_t *count);

/* The extreme value of a measure over the blocks, and the block that has it; 0 without blocks. */
typedef struct tl_extreme {
    double value;
    tl_id block;
} tl_extreme;

/* A cut that was not made because a side would have been thinner than `limit`. */
typedef struct tl_refused_cut {
    tl_tag joint;
    tl_vec3 normal, point;   /* of the plane; upward normal as given */
    tl_id block;             /* the block, or a piece of it when other planes of the call have cut it */
    double thickness, limit; /* of the thinner side, m */
} tl_refused_cut;

/* Quality of the blocks as they are. The aspect of a block is its diameter (largest distance between
 * two vertices) over its thickness (smallest extent along the normal of a face): 1.7 for a cube. */
typedef struct tl_quality {
    size_t blocks, bodies;
    double volume;
    double volume_error; /* |volume + deleted - created| / volume */
    tl_extreme smallest_volume, smallest_edge, smallest_face, worst_aspect;
    size_t cuts, refused, coincident;   /* since the model was made */
    const tl_refused_cut *refused_cuts; /* the first ones; valid until the model changes */
    size_t refused_listed;
    /* Bodies whose shape makes the time step short where all joints are equally stiff; their share of the volume; and
     * how many times longer a step the others allow. `automatic` of tl_filter joins them. */
    size_t slivers;
    double sliver_share, sliver_gain;
} tl_quality;

/* Measures the blocks: volumes, m3, edges, m, faces, m2, and what cuts have done. TL_E_MEMORY. */
TL_API tl_status tl_model_quality(tl_model *model, tl_quality *quality);

typedef enum tl_filter_action { TL_FILTER_REPORT, TL_FILTER_DELETE, TL_FILTER_JOIN } tl_filter_action;

typedef struct tl_filter {
    uint32_t size;               /* sizeof(tl_filter) */
    double volume, edge, aspect; /* smallest volume, m3, and edge, m; worst aspect; NaN: no limit */
    int32_t action;              /* tl_filter_action */
    /* No limits are given: those are taken beyond which little rock lies that makes the time step much shorter. */
    int32_t automatic;
} tl_filter;

/* A visible body beyond one of the limits. One of several parts is measured as a whole: its volume is that of all
 * parts, edge and aspect are those of their convex hull. */
typedef struct tl_sliver {
    tl_id block; /* the body's first block */
    double volume, edge, aspect;
    bool small, short_edge, thin; /* which limits */
    tl_id joined_to;              /* 0: not joined */
} tl_sliver;

typedef struct tl_filter_result {
    tl_sliver *slivers;            /* in the order of their ids; freed with free() */
    size_t count, deleted, joined; /* bodies */
    double volume;                 /* of all slivers, m3 */
    /* How many times longer the time step is or, where slivers are only reported, would be; NaN without `automatic`. As
     * long as some contact has no law: by area over volume of the bodies. */
    double gain;
} tl_filter_result;

/* Finds the slivers and deletes them, or joins each to the body with which it shares the largest area. `result` may be
 * NULL. TL_E_ARGUMENT without limits, or with some and `automatic`; TL_E_STATE in a run; TL_E_MEMORY. */
TL_API tl_status tl_model_filter(tl_model *model, const tl_filter *filter, tl_filter_result *result);

/* Sets the law of a joint: "*" every joint not named otherwise, "J1" a set, "J1:3" a plane of it.
 * `law` NULL changes properties of the law the joint has now; forces stay continuous. */
TL_API tl_status tl_joint_law(tl_model *model, const char *joint, const char *law, const tl_args *args);
/* Multiplies the stiffnesses of all laws, the parameters with TL_PARAM_STIFFNESS, by `factor`; forces stay as they are.
 * TL_E_ARGUMENT, and nothing changes, when a law has none or refuses the new values. TL_E_MEMORY may leave some of the
 * laws stiffer. */
TL_API tl_status tl_joints_stiffen(tl_model *model, double factor);

/* Which contacts a law is for: those of a joint, of one or between two groups or lists of blocks, or of a list of
 * contacts. A group is that of a block now. Parts of a block that is cut follow it into
 * lists. The law that names more rules a contact: first by how many of the two blocks it names, then by how closely it
 * names the joint (plane, set, "*"), then the one named later. */
typedef struct tl_law_scope {
    uint32_t size;          /* sizeof(tl_law_scope) */
    const char *joint;      /* "*", "J1" or "J1:3"; NULL: any */
    const char *group[2];   /* of the one and of the other block, either way round; NULL: of any */
    const tl_id *blocks[2]; /* a list in the place of a group, or NULL */
    size_t block_count[2];
    const tl_contact_name *contacts; /* a list in the place of both: pairs of blocks, in contact or not; or NULL */
    size_t contact_count;
} tl_law_scope;
/* Sets the law of those contacts, as tl_joint_law does; it begins with the properties of the law that is for all of
 * them where `law` is NULL. TL_E_NOT_FOUND for a joint that the model does not have or a group that no block is in.
 * TL_E_ARGUMENT for an empty list, or for one beside a group. */
TL_API tl_status tl_joint_law_for(tl_model *model, const tl_law_scope *scope, const char *law, const tl_args *args);
/* Whether law `index` (of tl_law_at) names blocks, by groups or lists, beside a joint. */
TL_API bool tl_law_names_blocks(const tl_model *model, size_t index);
/* Writes which contacts law `index` is for, with the blocks that live. Its lists are freed with
 * tl_law_scope_free, and its texts are valid until the next call. TL_E_MEMORY; then there is nothing to free. */
TL_API tl_status tl_law_scope_get(tl_model *model, size_t index, tl_law_scope *scope);
/* Frees the lists of a scope that tl_law_scope_get has written. */
TL_API void tl_law_scope_free(tl_law_scope *scope);

typedef struct tl_insitu {
    uint32_t size;            /* sizeof(tl_insitu) */
    tl_sym3 stress, gradient; /* tension positive, Pa and Pa/m over z */
    tl_vec3 at;
    const tl_id *blocks; /* in the zones of these, and on their contacts with any; NULL: everywhere */
    size_t block_count;
} tl_insitu;

/* Puts the initial stress stress + gradient (z - at.z) on the face contacts that exist now, and in the zones of
 * deformable blocks. A stress that is in equilibrium with weight and with tractions on the faces stays as it is. */
TL_API tl_status tl_model_insitu(tl_model *model, const tl_insitu *insitu);

typedef struct tl_seat {
    uint32_t size;       /* sizeof(tl_seat) */
    double gap, overlap; /* up to which a pair is taken as fitting, m; NaN: 1 % of the blocks' mean size */
} tl_seat;

/* A pair of blocks that touch or nearly do, and lie beyond a limit. */
typedef struct tl_seat_beyond {
    tl_id a, b;
    double gap, overlap; /* the largest between its faces, m */
} tl_seat_beyond;

typedef struct tl_seat_result {
    tl_seat_beyond *beyond; /* by ascending blocks; freed with free() */
    size_t beyond_count;
    size_t contacts; /* pairs that have been made to fit; those that do already are not among them */
    /* of these, as they were before, m; means by area, of a pair without a common face by what it presses on */
    double largest_gap, mean_gap, largest_overlap, mean_overlap;
    double gap, overlap; /* the limits, m */
} tl_seat_result;

/* Takes blocks as fitting: gaps and overlaps that they have now, up to limits, become the state without force. Of each
 * pair both blocks see the other with a face moved into a plane between. So no force and no energy is made, under any
 * law. All contacts of rigid blocks are then free of force. `result` may be NULL. TL_E_STATE where a deformable block
 * does not fit: only rigid ones are seated. */
TL_API tl_status tl_model_seat(tl_model *model, const tl_seat *seat, tl_seat_result *result);

/* Chooses the damping plugin; "none" is no damping. */
TL_API tl_status tl_model_damping(tl_model *model, const char *damping, const tl_args *args);

typedef enum tl_timestep_rule { TL_TIMESTEP_PAPER, TL_TIMESTEP_BODY, TL_TIMESTEP_BALANCE } tl_timestep_rule;

/* Limit: largest FRAC: twice what two free blocks bear; more is a slip of the pen. */
#define TL_FRACTION_MOST 2.0
/* Limit: least fraction, and least given step, s: below, steps and their squares leave the range of numbers. Test:
 * lua/test_limits. */
#define TL_FRACTION_LEAST 1e-9
#define TL_STEP_LEAST 1e-100

typedef struct tl_timestep {
    uint32_t size;        /* sizeof(tl_timestep) */
    double fraction;      /* FRAC of (27); NaN: that of the rule */
    int32_t rule;         /* tl_timestep_rule */
    double dt;            /* fixed step, s; NaN: by the rule */
    double error;         /* rule balance: of the energy balance, up to which the step is longer; 0: the default */
    double zone_fraction; /* of the critical step of zones, at most 1; 0: all of it */
} tl_timestep;
/* Sets how the time step is chosen; NULL: by the defaults. TL_E_ARGUMENT with a sentence for a fraction or a step out
 * of the ranges above; then nothing changes. */
TL_API tl_status tl_model_timestep(tl_model *model, const tl_timestep *timestep);
/* The step the next cycle will use, s; 0 where nothing can move and no law is set. */
TL_API tl_status tl_model_dt(tl_model *model, double *dt);

/* Why a block asks for a short step: its mass on its springs, its inertia on them, or its own speed. */
typedef enum tl_step_by { TL_STEP_BY_PUSH, TL_STEP_BY_TURN, TL_STEP_BY_SPEED, TL_STEP_BY_ZONES } tl_step_by;

typedef struct tl_timestep_report {
    double dt;
    tl_id block, partner; /* the block that controls it, and the block of the contact; 0: none */
    double mass;          /* of the block's body, kg; by zones that of a gridpoint */
    /* N/m: by zones of what holds the gridpoint; else of the contact, of all contacts of the body or of the part of its
     * largest face that counts. That of corners and edges is as when they are pressed in twice as deep. */
    double stiffness;
    int32_t by; /* tl_step_by: what of the block is so fast */
} tl_timestep_report;
/* What limits the step that the next cycle will use. Detects contacts when the model has changed. */
TL_API tl_status tl_model_timestep_report(tl_model *model, tl_timestep_report *report);

/* Scales the inertia (not the weight) of free bodies for a longer step. Without `dt` of all, up to that of the one with
 * the longest stable step, for finding equilibria: paths, times and velocities then mean nothing. With `dt` of those in
 * contact whose own stable step is shorter, so that it is `dt`; a step that would add more than the share `most`
 * fails. */
typedef struct tl_mass_scaling {
    uint32_t size; /* sizeof(tl_mass_scaling) */
    int32_t on;
    double dt;   /* s, or NaN */
    double most; /* of the mass of the bodies that can move, or NaN: 0.05 */
} tl_mass_scaling;
/* Sets mass scaling; NULL: by the defaults, on. TL_E_ARGUMENT for a step or a share out of its range, or without each
 * other. */
TL_API tl_status tl_model_mass_scaling(tl_model *model, const tl_mass_scaling *scaling);

/* What the last step has added, with `dt`. */
typedef struct tl_mass_added {
    int32_t on;      /* whether mass scaling is, of either way */
    double dt, most; /* as given: s, or NaN; share */
    double share;    /* of the mass of the bodies that can move */
    size_t bodies;   /* that have been given some */
    tl_id worst;     /* a block of the one that has the highest factor, or TL_NO_ID */
    double factor;   /* its inertia over its own */
} tl_mass_added;
/* See tl_mass_added; zeros while mass scaling is off or before the first step. */
TL_API tl_mass_added tl_model_mass_added(const tl_model *model);

typedef struct tl_contact_area {
    uint32_t size;     /* sizeof(tl_contact_area) */
    double fraction;   /* of the smaller block's mean face area; >= 0. 0: no minimum area */
    double absolute;   /* m2; NaN: by the fraction */
    const char *joint; /* NULL: every joint */
} tl_contact_area;
/* Sets the minimum area of contacts of one joint or of all. TL_E_ARGUMENT for one below 0, TL_E_NOT_FOUND for a joint
 * that the model does not have. */
TL_API tl_status tl_model_contact_area(tl_model *model, const tl_contact_area *rule);

/* Called between steps, on the caller's thread; not TL_OK ends the run after the step. */
typedef tl_status (*tl_step_fn)(void *user, tl_model *model);

typedef enum tl_solve_reason {
    TL_SOLVE_RATIO,
    TL_SOLVE_CYCLES,
    TL_SOLVE_TIME,
    TL_SOLVE_STOP,
    TL_SOLVE_INTERRUPT,
    TL_SOLVE_VELOCITY,
    TL_SOLVE_FAILURE,
    TL_SOLVE_OVERLAP,
    TL_SOLVE_REST /* of tl_model_relax: TL_SOLVE_RATIO of others */
} tl_solve_reason;

/* Which unbalanced force ratio ends a solve. */
typedef enum tl_ratio_measure {
    TL_RATIO_AVERAGE, /* mean unbalanced force over mean sum of contact forces, of the free bodies */
    TL_RATIO_MAXIMUM, /* largest unbalanced force over mean sum of contact forces */
    TL_RATIO_LOCAL    /* each body's own force, moment and motion: docs/theory.md, Convergence */
} tl_ratio_measure;

typedef struct tl_solve {
    uint32_t size;           /* sizeof(tl_solve) */
    double ratio;            /* ends when the unbalanced force ratio falls below, and that of the
                                moments, each over its body's radius, too; 0: never */
    int32_t measure;         /* tl_ratio_measure */
    double velocity;         /* ends when no body is faster, m/s; NaN: no limit */
    int32_t stop_at_failure; /* ends when a steady failure is seen */
    int64_t max_cycles;      /* of this call */
    double max_time;         /* s of this call; NaN: no limit */
    int64_t every;           /* steps between calls of `progress` and `stop` */
    tl_step_fn each;         /* called after every step, before these; or NULL */
    tl_step_fn progress;
    bool (*stop)(void *user, tl_model *model);
    void *user;
    /* called before every step, or NULL: it may change the model, as between two runs */
    tl_step_fn between;
} tl_solve;

typedef struct tl_solve_result {
    tl_solve_reason reason;
    double ratio, time, wall, max_velocity; /* ratio: the average one */
    double ratio_maximum, ratio_local;      /* the latter of forces */
    int32_t measure;                        /* tl_ratio_measure that may end the run */
    int64_t cycles;
    tl_id failing; /* a block that moves on in one direction without slowing down; 0: none seen */
    tl_id worst;   /* block farthest from rest by the local measure; 0: no force on any */
} tl_solve_result;

/* "ratio", "cycles" ...: the word for a reason. */
TL_API const char *tl_solve_reason_name(tl_solve_reason reason);
/* "average", "maximum" or "local": the word for a measure. */
TL_API const char *tl_ratio_measure_name(tl_ratio_measure measure);
/* Runs exactly `cycles` steps (fewer only on an interrupt, an error or a callback's word). `result` may be NULL, also
 * below. */
TL_API tl_status tl_model_cycle(tl_model *model, int64_t cycles, tl_solve_result *result);
/* Runs until a limit is met. `*result` is up to date whenever a callback is called. */
TL_API tl_status tl_model_solve(tl_model *model, const tl_solve *solve, tl_solve_result *result);

/* Finds where the model rests, by the cheapest means: kinetic stops, masses that suit one step, geometry that is kept,
 * and leaps by the stiffness that contacts have shown. */
typedef struct tl_relax {
    uint32_t size;           /* sizeof(tl_relax) */
    double ratio;            /* ends when the unbalanced force ratio falls below; > 0 */
    int32_t measure;         /* tl_ratio_measure */
    int32_t stop_at_failure; /* ends when a steady failure is seen */
    int64_t max_cycles;      /* of this call */
    int64_t load_steps;      /* gravity and loads come on in so many equal parts, each near rest before the next */
    int64_t every;           /* as in tl_solve, like the functions */
    tl_step_fn each, progress;
    bool (*stop)(void *user, tl_model *model);
    void *user;
    tl_step_fn between;
} tl_relax;

typedef struct tl_relax_result {
    tl_solve_result run; /* reason: TL_SOLVE_REST, FAILURE, OVERLAP, CYCLES, STOP or INTERRUPT */
    size_t failing;      /* blocks that fail: tl_model_failing */
    double volume;       /* of these, m3 */
    double direction[3]; /* and where they go: of length 1, or zero */
    char message[400];   /* what the end means */
} tl_relax_result;

/* Brings the model to rest. Velocities are zero afterwards; time, damping, time step, mass scaling and what is held are
 * as before, and steps count. Friction, opening and bonds follow their path. `result` may be NULL and is up to date
 * whenever a callback is called. TL_E_ARGUMENT for an option out of its range, TL_E_STATE when something is driven. */
TL_API tl_status tl_model_relax(tl_model *model, const tl_relax *relax, tl_relax_result *result);
/* The blocks that failed in the last run that saw a failure: writes up to `most` ids, returns how many there are. */
TL_API size_t tl_model_failing(const tl_model *model, tl_id *ids, size_t most);
/* Asks a running cycle or solve to end after the step, a generator or writer to fail with TL_E_CANCELLED. Signal-
 * safe. */
TL_API void tl_model_interrupt(tl_model *model);
/* Has the same happen whenever `asked` answers true, which such a call asks often, on the caller's thread. NULL: no
 * more. */
TL_API void tl_model_interrupt_if(tl_model *model, bool (*asked)(void));

/* ---------------------------------------------------------------- cost ------------------- */

/* The phases of a step, in its order: name, what is done. */
#define TL_PHASES(X)                                                                                                   \
    X(DETECT, detect, "pairs and contacts up to date, gaps and motion of the contact points")                          \
    X(TIMESTEP, timestep, "the step to take")                                                                          \
    X(LAWS, laws, "contact forces, and their sums over each contact")                                                  \
    X(ZONES, zones, "deformable blocks: strain and stress of zones, and forces of segments")                           \
    X(GATHER, gather, "forces and moments of each body")                                                               \
    X(DAMPING, damping, "the damping's forces")                                                                        \
    X(MOVE, move, "velocities, places and rotations")                                                                  \
    X(ENERGY, energy, "the ledger of energy")

typedef enum tl_phase {
#define TL_PHASE_ITEM(item, name, doc) TL_PHASE_##item,
    TL_PHASES(TL_PHASE_ITEM)
#undef TL_PHASE_ITEM
        TL_PHASE_COUNT
} tl_phase;

/* What the steps since profiling began have cost, and what one step works on now. */
typedef struct tl_profile {
    double seconds[TL_PHASE_COUNT]; /* wall clock */
    int64_t steps;
    size_t pairs;    /* candidates of the broad phase */
    size_t contacts; /* that exist */
    size_t loaded;   /* that carry a force */
    size_t points;   /* of the contacts */
} tl_profile;

/* Begins or ends timing the phases; beginning sets all to zero. Results do not depend on it. */
TL_API void tl_model_profiling(tl_model *model, bool on);
/* What the steps since profiling began have cost; zeros where it has not. */
TL_API tl_profile tl_model_profile(const tl_model *model);

/* What a model holds, in bytes, room for growth included. */
#define TL_MEMORY(X)                                                                                                   \
    X(blocks, "columns of the blocks")                                                                                 \
    X(shapes, "polyhedra")                                                                                             \
    X(bodies, "columns of the bodies")                                                                                 \
    X(step, "columns of the bodies that live through a step only")                                                     \
    X(broad, "how far blocks have moved since pairs were listed")                                                      \
    X(pairs, "candidate pairs")                                                                                        \
    X(contacts, "columns of the contacts")                                                                             \
    X(facets, "faces of the contacts, and what field contacts keep beside their points")                               \
    X(points, "columns of the contact points")                                                                         \
    X(index, "lists of each block's contacts, and of contacts by number")                                              \
    X(spare, "second set of tables of contacts and points")                                                            \
    X(zones, "gridpoints, zones and segments of deformable blocks")                                                    \
    X(elements, "elements, their nodes, parameters and lists")                                                         \
    X(other, "rows by number, scratch of the threads, joints and laws")

typedef struct tl_memory {
#define TL_MEMORY_ITEM(name, doc) size_t name;
    TL_MEMORY(TL_MEMORY_ITEM)
#undef TL_MEMORY_ITEM
    size_t total;
} tl_memory;

/* Counts the bytes that the model holds now. */
TL_API tl_memory tl_model_memory(const tl_model *model);

/* ---------------------------------------------------------------- blocks ----------------- */

typedef struct tl_halfspace {
    double dip, dip_direction;
    tl_vec3 origin;
} tl_halfspace;

/* Which blocks; all that is set must hold. */
typedef struct tl_block_filter {
    uint32_t size;     /* sizeof(tl_block_filter) */
    tl_id id;          /* 0: any */
    const char *group; /* NULL: any */
    const char *joint; /* has a face of this joint ("J1" or "J1:3"); NULL: any */
    const tl_vec3 *containing;
    const tl_bounds *inside;           /* centroid in the box, boundary included */
    const tl_halfspace *above, *below; /* centroid on that side, boundary included */
    int fixed;                         /* -1 any, 0 no, 1 yes */
    int hidden;                        /* -1 any, 0 visible ones, 1 hidden ones */
    size_t above_count, below_count;   /* planes at `above` and `below`, 1 by default: all must hold */
    const tl_vec3 *region;             /* centroid in the convex hull of these points, boundary included; NULL: any */
    size_t region_count;
} tl_block_filter;

/* Ids of the blocks that pass, ascending. The list is the caller's, to be freed with free(). */
TL_API tl_status tl_blocks_select(tl_model *model, const tl_block_filter *filter, tl_id **ids, size_t *count);
/* The number of blocks, hidden ones too. */
TL_API size_t tl_block_count(const tl_model *model);
/* TL_OK when the block exists, else TL_E_STALE with a sentence. */
TL_API tl_status tl_block_check(tl_model *model, tl_id block);

typedef enum tl_field_kind {
    TL_FIELD_SCALAR, /* 1 number */
    TL_FIELD_COUNT,  /* 1 whole number */
    TL_FIELD_BOOL,   /* 1 number, 0 or 1 */
    TL_FIELD_VEC3,   /* 3 numbers */
    TL_FIELD_QUAT,   /* 4 numbers w x y z */
    TL_FIELD_SYM3,   /* 6 numbers xx yy zz xy yz zx */
    TL_FIELD_TEXT,   /* text */
    TL_FIELD_IDS     /* 2 whole numbers */
} tl_field_kind;

typedef struct tl_field {
    const char *name;
    tl_field_kind kind;
    const char *unit;
    const char *doc;
} tl_field;

typedef struct tl_field_value {
    double number[6];
    const char *text; /* valid until the model changes */
} tl_field_value;

/* The fields a block has, in the order of the reference; `*count` of them. */
TL_API const tl_field *tl_block_fields(size_t *count);
/* The value of field `index` (of tl_block_fields) of a block. */
TL_API tl_status tl_block_field(tl_model *model, tl_id block, size_t index, tl_field_value *value);

/* A block's shape in its present place. Arrays are freed with free(). `loops` holds the vertex indices (from 0) of each
 * face, counter-clockwise from outside; face i starts at start[i] and ends before start[i + 1]. */
typedef struct tl_block_mesh {
    size_t vertex_count, face_count;
    tl_vec3 *vertices;
    uint32_t *start, *loops;
    tl_tag *tags;
    tl_vec3 *normals;
} tl_block_mesh;

/* Fills *mesh with the shape of a block, in its present place, m. TL_E_STALE for a block that is no more,
 * TL_E_MEMORY. */
TL_API tl_status tl_block_mesh_get(tl_model *model, tl_id block, tl_block_mesh *mesh);
/* Frees the arrays of a mesh and empties it. */
TL_API void tl_block_mesh_free(tl_block_mesh *mesh);
/* Ids of the blocks it is in contact with, ascending; freed with free(). */
TL_API tl_status tl_block_neighbours(tl_model *model, tl_id block, tl_id **ids, size_t *count);
/* "J1:3" of a face's tag, "" for none; valid until the next call. */
TL_API const char *tl_tag_name(tl_model *model, tl_tag tag);

/* Verbs on sets of blocks (ids need not be ordered; a stale id fails the whole call). */
TL_API tl_status tl_blocks_hide(tl_model *model, const tl_id *ids, size_t count, bool hidden);
/* Removes blocks, with their contacts and loads. */
TL_API tl_status tl_blocks_delete(tl_model *model, const tl_id *ids, size_t count);

enum { TL_FIX_X = 1, TL_FIX_Y = 2, TL_FIX_Z = 4, TL_FIX_ROTATION = 8, TL_FIX_ALL = 15 };

/* Holds components of the motion of the blocks' bodies: their velocity becomes 0 and stays. */
TL_API tl_status tl_blocks_fix(tl_model *model, const tl_id *ids, size_t count, unsigned what);
/* Lets the bodies of blocks go, fixed or driven: they begin with the velocity that they have. */
TL_API tl_status tl_blocks_free(tl_model *model, const tl_id *ids, size_t count);
/* Displacements of blocks, and rotations, count from now. */
TL_API tl_status tl_blocks_reset_displacement(tl_model *model, const tl_id *ids, size_t count);

typedef struct tl_block_set {
    uint32_t size;                      /* sizeof(tl_block_set) */
    double density;                     /* NaN: unchanged */
    const char *group;                  /* NULL: unchanged */
    tl_vec3 velocity, angular_velocity; /* NaN: unchanged */
    const char *solid;                  /* of the zones of deformable blocks: zones.h; NULL: unchanged */
} tl_block_set;

/* Changes properties of blocks. A velocity is that of the centroid; of parts of one body that of the centroid of those
 * that are listed. TL_E_ARGUMENT: a density that is not > 0, a group that is no UTF-8, a motion that is not finite, no
 * such solid. TL_E_STATE for a solid of a rigid block. Then no block is changed. */
TL_API tl_status tl_blocks_set(tl_model *model, const tl_id *ids, size_t count, const tl_block_set *set);

/* Makes one rigid body of the blocks and of all blocks joined to them before. Mass, momentum and angular
 * momentum are those of the parts together; contacts between the parts end. Fixed parts must agree. */
TL_API tl_status tl_blocks_join(tl_model *model, const tl_id *ids, size_t count);
/* Makes a body of its own of each block; each goes on with the velocity it had as a part. */
TL_API tl_status tl_blocks_unjoin(tl_model *model, const tl_id *ids, size_t count);

typedef struct tl_load {
    uint32_t size;  /* sizeof(tl_load) */
    tl_vec3 force;  /* N */
    tl_vec3 moment; /* N m */
    /* where the force acts: a point that goes with the body; NaN: the body's centroid */
    tl_vec3 at;
} tl_load;

/* Puts a load on the body of each block, in the place of the one it had; zero takes it off. */
TL_API tl_status tl_blocks_load(tl_model *model, const tl_id *ids, size_t count, const tl_load *load);

/* Velocity of a drive at time t, s; false ends the run after the step. */
typedef bool (*tl_drive_fn)(void *user, double t, tl_vec3 *velocity);

typedef struct tl_drive {
    uint32_t size;                                /* sizeof(tl_drive) */
    tl_vec3 velocity, angular_velocity;           /* constant parts; all zero where not given */
    tl_drive_fn velocity_at, angular_velocity_at; /* in their place, or NULL */
    void *user;
    void (*release)(void *user); /* called when the drive ends, or NULL */
    /* of driven gridpoints (zones.h): gradient (x - at) comes to the velocity, x the present place; 1/s and m */
    double gradient[3][3];
    tl_vec3 at;
    /* Records of x, y and z, or NULL: their velocity comes to the constant one, at the middle of each step. Their time
     * counts from that of the model when the drive begins. The drive holds them. */
    const tl_record *record[3];
    double record_begin; /* s, that time: the model's own entry */
} tl_drive;

/* Prescribes the motion of the blocks' bodies, in the place of any fixing; free ends it. A function is
 * called on the caller's thread, once a step for all bodies of the call, at the middle of the step. */
TL_API tl_status tl_blocks_drive(tl_model *model, const tl_id *ids, size_t count, const tl_drive *drive);

/* ---------------------------------------------------------------- energy ----------------- */

/* The terms of the ledger: name, unit and what it is. */
#define TL_ENERGY(X)                                                                                                   \
    X(kinetic, "J", "of motion, J")                                                                                    \
    X(potential, "J", "minus the work of gravity, J")                                                                  \
    X(stored, "J", "elastic, in all contacts, those of held blocks, too, J")                                           \
    X(friction, "J", "turned to heat by slip, J")                                                                      \
    X(damping, "J", "taken out by the damping, J")                                                                     \
    X(external, "J",                                                                                                   \
      "work of loads and driven bodies, and given by setting velocities and by edits of blocks "                       \
      "and laws, J")                                                                                                   \
    X(balance, "", "error of the sum over the largest change of a term so far")

/* Energy of the bodies that are free to move, J, all at one time and counted from the first step. Its members are
 * numbers, the terms of TL_ENERGY. What is held: kinetic, potential (minus the work of gravity) and stored (in all
 * contacts). What has gone: friction (heat of slip) and damping. What has come: external, work of loads, of driven
 * bodies and of edits. The last, balance, is the error of their sum over the largest change of a term so far. What the
 * zones of deformable blocks hold and have taken, tl_zone_energy, is in that sum. */
typedef struct tl_energy {
#define TL_ENERGY_TERM(name, unit, doc) double name;
    TL_ENERGY(TL_ENERGY_TERM)
#undef TL_ENERGY_TERM
} tl_energy;

/* The ledger, as of the last force evaluation. */
TL_API tl_status tl_model_energy(tl_model *model, tl_energy *energy);

/* The terms of the ledger that zones have: name, unit and what it is. */
#define TL_ZONE_ENERGY(X)                                                                                              \
    X(strain, "J", "elastic, in all zones of deformable blocks, J")                                                    \
    X(plastic, "J", "turned to heat in zones, by yielding, J")

/* Energy of the zones of deformable blocks, J. Its members are numbers, the terms of TL_ZONE_ENERGY: strain (elastic,
 * held now) and plastic (turned to heat so far). Both are 0 without deformable blocks. */
typedef struct tl_zone_energy {
#define TL_ENERGY_TERM(name, unit, doc) double name;
    TL_ZONE_ENERGY(TL_ENERGY_TERM)
#undef TL_ENERGY_TERM
} tl_zone_energy;

/* What zones have in the ledger, as of the last force evaluation. */
TL_API tl_status tl_model_zone_energy(tl_model *model, tl_zone_energy *energy);

/* ---------------------------------------------------------------- contacts --------------- */

typedef struct tl_contact_filter {
    uint32_t size;                      /* sizeof(tl_contact_filter) */
    const char *joint;                  /* NULL: any */
    const tl_id *between_a, *between_b; /* NULL: any; one block of each list, either way round */
    size_t count_a, count_b;
} tl_contact_filter;

/* Names of the contacts that pass, in ascending order of their blocks; freed with free(). Detects contacts when the
 * model has changed since the last step. */
TL_API tl_status tl_contacts_select(tl_model *model, const tl_contact_filter *filter, tl_contact_name **names,
                                    size_t *count);
/* A number for a pair of blocks, a 2^32 + b: no two contacts that there are have the same. */
TL_API int64_t tl_contact_number(tl_contact_name name);
/* The fields a contact has, in the order of the reference; `*count` of them. */
TL_API const tl_field *tl_contact_fields(size_t *count);
/* The value of field `index` (of tl_contact_fields) of a contact, as of the last step. TL_E_STALE for a contact that is
 * no more. */
TL_API tl_status tl_contact_field(tl_model *model, tl_contact_name contact, size_t index, tl_field_value *value);

/* ---------------------------------------------------------------- state ------------------ */

/* 32 hexadecimal digits over all that what comes next depends on: models of the same text go on alike. */
TL_API tl_status tl_state_hash(tl_model *model, char text[33]);

#ifdef __cplusplus
}
#endif

#include <talus/defaults.h>

#endif
