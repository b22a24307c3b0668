/* model.h - what a model is made of, for the modules above it (contact, force, cycle, io ...).
 *
 * Blocks are shapes; bodies move. A body is one block or several joined ones. All kinematics lives in the bodies'
 * columns: a block's shape is kept in its body's frame, whose origin is the body's centroid, so a point p of a shape is
 * at
 *
 *     origin + x_ref + u + R p
 *
 * `origin` is a point of the model rounded to a coarse power of two. So a model far from the coordinates' zero loses
 * no digits. x_ref is the body's centroid when the body was made and u its displacement since. They are kept
 * apart so that a step far below the rounding of x_ref still counts.
 *
 * Rows of blocks and bodies are in ascending order of id. Rows change when blocks are created, cut, joined or deleted;
 * `structure` counts these changes, and a block that came or changed bears the count. Rows of blocks that were deleted
 * go when rows are next gone through (tl_rows_tidy). Ids never change and are never used again. */
#ifndef TL_MODEL_MODEL_H
#define TL_MODEL_MODEL_H

#include "base/error.h"
#include "base/parallel.h"
#include "base/table.h"
#include "geometry/polyhedron.h"
#include "model/cuts.h"
#include "model/law.h"
#include "model/remark.h"
#include "model/seat.h"

#include <stdatomic.h>
#include <talus/talus.h>
#include <talus/vmath.h>

/* A place of a block by the frame of its body: shift, m, and turn. */
typedef struct tl_base {
    tl_vec3 shift;
    tl_quat turn;
} tl_base;

typedef struct tl_blocks {
    tl_table table;
    tl_id *id;
    uint32_t *body;  /* row of its body */
    tl_poly **shape; /* in the body's frame; owned */
    uint32_t *group; /* index into groups */
    double *density; /* kg/m3 */
    double *volume;  /* m3 */
    tl_vec3 *local;  /* centroid in the body's frame, zero for a body of one block; NULL: all are */
    /* From where displacements count, after a reset or when bodies were joined; NULL: from where it was made. */
    tl_base *base;
    /* Where it was made, once bodies were joined; NULL: where the frame of its body has neither shift nor turn. */
    tl_base *made;
    double *size;      /* cube root of the volume: the length tolerances refer to */
    double *mean_face; /* mean face area, m2 */
    uint64_t *lineage; /* key of the block's descent, for random draws */
    uint8_t *hidden;
    /* 0: it is deleted, and its row goes when rows are next tidied; its shape has gone */
    uint8_t *stays;
    /* count of `structure` with which it came, or got another shape, frame or tags */
    uint64_t *changed;
} tl_blocks;

typedef struct tl_body_load {
    tl_vec3 force, moment; /* axes of the model */
    tl_vec3 arm;           /* where it acts, body's frame */
} tl_body_load;

/* A force, and a moment about the centroid, in axes of the model. */
typedef struct tl_wrench {
    tl_vec3 force, moment;
} tl_wrench;

/* Where a body is and how it came there in the last step: what contacts need of it. They come to bodies in no order
 * that memory knows. So all of it lies together, in three of the lines that memory hands over at a time, and not in
 * columns. A row of TL_POSE_ROW doubles. */
typedef struct tl_pose {
    tl_mat3 r;        /* the rotation q as a matrix */
    tl_vec3 x_ref;    /* centroid when made, relative to the origin */
    tl_vec3 u;        /* displacement since */
    tl_vec3 v_moved;  /* of the last step's motion: since then v and w may have been set anew */
    tl_vec3 w_moved;  /* the turn of the step over its duration: w is that at its end */
    double unused[3]; /* up to whole lines */
} tl_pose;

#define TL_POSE_ROW 24

typedef struct tl_bodies {
    tl_table table;
    tl_id *id;              /* the lowest id of its blocks */
    uint32_t *member_start; /* its blocks: model->members[member_start .. + member_count) */
    uint32_t *member_count;
    tl_pose *pose;
    tl_quat *q; /* rotation since it was made */
    tl_vec3 *v; /* velocity, half a step behind the position */
    tl_vec3 *w; /* angular velocity */
    double *mass;
    tl_vec3 *moments; /* principal moments of inertia */
    tl_quat *axes;    /* from principal axes to the body's frame */
    double *round;    /* the paper's one moment of inertia (20) */
    double *radius;   /* farthest vertex from the centroid */
    uint8_t *fixed;   /* TL_FIX_* */
    uint32_t *mesh;   /* number of its mesh + 1; 0: it is rigid */
    tl_vec3 *force;   /* unbalanced: contacts, weight, loads */
    tl_vec3 *moment;
    /* unbalanced, in the last damped step; NULL: no damping has asked for them */
    tl_vec3 *force_before, *moment_before;
    double *fall;           /* of a relaxation: way in a step, m, up to which it falls by its own mass, */
    struct tl_going *going; /* and how it goes on (cycle/settling.h); NULL: there was none */
    tl_body_load *load;     /* of the user's; NULL: none has ever been set */
    tl_wrench *load_before; /* in the last step; NULL as `load` is, and valid while loads_changed */
    uint32_t *drive;        /* index into drives + 1, or 0 */
    double *odometer;       /* sum of (|v| + |w| radius) dt: no vertex has moved farther */
    /* what it asks of the time step on its largest face: cycle/timestep.c. 0: not known */
    double *face_rate, *face_turn; /* the latter: its rotation's part of that */
} tl_bodies;

typedef struct tl_joint_set {
    char *name;
    uint32_t planes; /* number of planes so far */
} tl_joint_set;

/* A prescribed motion, shared by the bodies of one call. */
typedef struct tl_drive_record {
    tl_drive drive;
    tl_vec3 velocity, angular_velocity; /* in the step being made */
    size_t bodies;                      /* that follow it; 0: free for use again */
    bool held;                          /* it may be asked for again: tl_rows_set_aside */
} tl_drive_record;

/* Of all blocks, while known: total volume, m3, and the smallest volume, edge, m, and face, m2. */
typedef struct tl_extremes {
    bool known;
    double total, volume, edge, face;
} tl_extremes;

/* For what the contacts in `detect` were found: asked.c. */
typedef enum tl_found_for {
    TL_FOR_STEPS,          /* the next step goes on from them */
    TL_FOR_QUERIES,        /* no step has used them: the next one finds all anew */
    TL_FOR_QUERIES_IN_COPY /* the next step goes on from `stepped` */
} tl_found_for;

/* Groups by the hash of their name. A slot holds a group's number plus one, or 0. Slots of groups that a failed
 * generator has taken back stay: no name is found by them. */
typedef struct tl_group_index {
    uint32_t *slot;
    size_t slots, used; /* slots: a power of two, or 0 */
} tl_group_index;

struct tl_model {
    tl_model_config config;
    tl_error error;
    tl_log_fn log;
    void *log_user;
    bool speaks_lua;
    tl_pool *pool;

    tl_vec3 origin;
    bool origin_set;
    tl_blocks blocks;
    tl_bodies bodies;
    uint32_t *members; /* block rows, body by body, ascending */
    size_t member_capacity;
    tl_id next_id;
    size_t gone;          /* rows of blocks that are deleted */
    uint64_t structure;   /* counts changes of the rows */
    uint64_t constraints; /* counts changes of fixing, hiding or mass */

    char name[256]; /* of the last tl_tag_name */
    char **groups;
    size_t group_count;
    tl_group_index group_index;
    tl_joint_set *joints; /* joint number j is joints[j - 1] */
    size_t joint_count;
    tl_cut_record record;
    tl_cut_part *cut_parts; /* by ascending id */
    size_t cut_part_count, cut_part_capacity;
    tl_split *splits; /* by ascending id of the block */
    size_t split_count, split_capacity;
    /* blocks that were cut out of others since nodes of elements followed last: `whole` is the block that nodes know */
    tl_split *cut_out;
    size_t cut_out_count, cut_out_capacity;
    tl_face_load *face_loads; /* by ascending block and face; of blocks that there were */
    size_t face_load_count, face_load_capacity;
    tl_extremes extremes;
    tl_seats seats;

    tl_law *joint_laws;
    size_t joint_law_count;
    const struct tl_group_verbs *group_verbs; /* who keeps forces when groups change, or NULL: scope.h */
    uint64_t laws;                            /* counts changes of the joint laws */
    uint64_t rules;                           /* counts changes of minimum areas and of contact_points */
    tl_min_area_rule min_area;
    tl_joint_min_area *joint_min_areas;
    size_t joint_min_area_count;

    tl_drive_record *drives;
    size_t drive_count;

    tl_history **histories;
    size_t history_count;

    tl_timestep timestep;
    const tl_kind *damping;
    void *damping_params, *damping_self;
    double *damping_state;
    double time;
    double dt;                           /* of the last step; 0 before the first */
    tl_vec3 gravity_before;              /* gravity in the last step, where it has been set since; else zero */
    bool gravity_changed, loads_changed; /* since the last step, while dt is not 0 */
    int64_t cycles;
    atomic_bool interrupted;
    bool (*interrupt_asked)(void);                                       /* or NULL */
    void (*show_generate)(void *user, const tl_generate_progress *done); /* or NULL */
    void *show_generate_user;
    struct tl_notes *notes;        /* of the last generator; NULL: none */
    bool running;                  /* inside a callback: no blocks may be made or deleted */
    bool driving;                  /* inside a drive's function: nothing that a step depends on may be set */
    bool reading;                  /* the same, and no run may begin: tl_model_only_read */
    uint32_t said;                 /* bit r: remark r has been made */
    char stage[TL_STAGE_NAME + 1]; /* from which displacements count; "": none has been named */
    uint64_t remarked;             /* changes of blocks and laws at the last look at their numbers */
    bool mass_scaling;             /* of all free bodies */
    /* its steps are those of a relaxation (cycle/relax.c), which sets the damping, the time step and the masses */
    bool relaxing;
    double still; /* in a relaxation: share of a block's size up to which motion changes no geometry; else 0 */
    double added_dt, added_most; /* of the bodies that need it: tl_mass_scaling; NaN: off */

    bool profiling;
    double phase_began; /* s, of the clock */
    tl_profile profile; /* so far; the counts of contacts are made when asked for */

    struct tl_detect *detect;  /* of the module contact */
    struct tl_detect *stepped; /* of the last step; NULL but for TL_FOR_QUERIES_IN_COPY */
    tl_found_for found_for;
    void (*detect_destroy)(struct tl_detect *);
    struct tl_cycle *cycle; /* of the module cycle */
    void (*cycle_destroy)(struct tl_cycle *);
    struct tl_zones *zones; /* meshes of deformable bodies and their materials, or NULL: module zone */
    void (*zones_destroy)(struct tl_zones *);
    const struct tl_zone_verbs *zone_verbs; /* what is done to their bodies: deformable.h; NULL: there are no zones */
    struct tl_segments *segments;           /* their flush contacts, or NULL: module segment */
    void (*segments_destroy)(struct tl_segments *);
    void (*segments_follow)(struct tl_model *); /* lets them follow rows that have moved */
    struct tl_elements *elements;               /* what acts on points of blocks, or NULL: module element */
    void (*elements_destroy)(struct tl_elements *);
    struct tl_outputs *outputs; /* of the module state: files written so far */
    void (*outputs_destroy)(struct tl_outputs *);
};

/* Whether the user wants the call of the kernel to end that is being made. */
static inline bool tl_model_interrupted(const tl_model *m)
{
    return atomic_load(&m->interrupted) || (m->interrupt_asked && m->interrupt_asked());
}

/* Rows of a body's blocks, ascending: [member_count]. */
static inline const uint32_t *tl_body_blocks(const tl_model *m, uint32_t body)
{
    return &m->members[m->bodies.member_start[body]];
}

/* Whether the bodies of two blocks are held in every component: no force can move them. */
static inline bool tl_blocks_fixed(const tl_model *m, uint32_t a, uint32_t b)
{
    const uint8_t *fixed = m->bodies.fixed;
    return fixed[m->blocks.body[a]] == TL_FIX_ALL && fixed[m->blocks.body[b]] == TL_FIX_ALL;
}

/* Whether a block's body is deformable, by the row of the block. */
static inline bool tl_block_deforms(const tl_model *m, uint32_t row)
{
    return m->bodies.mesh[m->blocks.body[row]] != 0;
}

/* Present place of a body's centroid, relative to the origin. */
static inline tl_vec3 tl_body_place(const tl_bodies *b, uint32_t body)
{
    return tl_v3_add(b->pose[body].x_ref, b->pose[body].u);
}

/* A point of a body's frame, relative to the model's origin; and the way back. */
static inline tl_vec3 tl_body_point(const tl_bodies *b, uint32_t body, tl_vec3 local)
{
    return tl_v3_add(tl_body_place(b, body), tl_m3_mul(&b->pose[body].r, local));
}

static inline tl_vec3 tl_body_local(const tl_bodies *b, uint32_t body, tl_vec3 place)
{
    return tl_m3_tmul(&b->pose[body].r, tl_v3_sub(place, tl_body_place(b, body)));
}

/* From a centroid a to b. The references are subtracted first, so that a small relative
 * displacement keeps its digits. */
static inline tl_vec3 tl_apart(tl_vec3 x_ref_a, tl_vec3 u_a, tl_vec3 x_ref_b, tl_vec3 u_b)
{
    return tl_v3_add(tl_v3_sub(x_ref_b, x_ref_a), tl_v3_sub(u_b, u_a));
}

/* Present place of a point of a shape, in the user's coordinates. */
static inline tl_vec3 tl_model_point(const tl_model *m, uint32_t body, tl_vec3 local)
{
    return tl_v3_add(m->origin, tl_body_point(&m->bodies, body, local));
}

/* Load of a body, zero where there is none. */
static inline tl_body_load tl_load_of(const tl_bodies *b, uint32_t body)
{
    return b->load ? b->load[body] : (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
}

static inline bool tl_body_loaded(const tl_bodies *b, uint32_t body)
{
    return b->load && tl_v3_norm2(b->load[body].force) + tl_v3_norm2(b->load[body].moment) > 0;
}

/* A remedy as those who called would write it. */
static inline const char *tl_words(const tl_model *m, const char *lua, const char *c)
{
    return m->speaks_lua ? lua : c;
}

/* A block's centroid in its body's frame. */
static inline tl_vec3 tl_block_local(const tl_model *m, uint32_t row)
{
    return m->blocks.local ? m->blocks.local[row] : tl_v3(0, 0, 0);
}

/* Present place of a block's centroid, relative to the origin. */
static inline tl_vec3 tl_block_place(const tl_model *m, uint32_t row)
{
    return tl_body_point(&m->bodies, m->blocks.body[row], tl_block_local(m, row));
}

/* Centroid and displacement of a block, in the user's coordinates. */
tl_vec3 tl_block_centroid(const tl_model *m, uint32_t row);
tl_vec3 tl_block_displacement(const tl_model *m, uint32_t row);
/* Makes the columns of that from which displacements count; false: out of memory. */
bool tl_blocks_hold_base(tl_model *m);
/* The same for where blocks were made. */
bool tl_blocks_hold_made(tl_model *m);
/* From where displacements of a block count, and where it was made. */
tl_base tl_block_base(const tl_model *m, uint32_t row);
tl_base tl_block_made(const tl_model *m, uint32_t row);
/* How far a point of a block, in its body's frame, has gone since the frame was at `from`, m. */
tl_vec3 tl_block_point_moved(const tl_model *m, uint32_t row, const tl_base *from, tl_vec3 local);
/* Displacement of a point (in the body's frame) of a block since its creation or last reset. */
tl_vec3 tl_block_point_displacement(const tl_model *m, uint32_t row, tl_vec3 local);

/* Notes that a block has come, or has got another shape, frame or tags; rows are refreshed after that. */
static inline void tl_block_changes(tl_model *m, uint32_t row)
{
    m->blocks.changed[row] = m->structure + 1;
}

/* What a block was cut out of since contacts were brought up to date last, or NULL. */
const tl_cut_part *tl_cut_part_of(const tl_model *m, tl_id id);
/* The body that a block was in in the last step when cuts have split it since, or TL_NO_ID. */
tl_id tl_split_of(const tl_model *m, tl_id block);

/* Row of a block id, or TL_NO_ROW with a sentence in the model's error. Whether several have rows. */
uint32_t tl_block_row(tl_model *m, tl_id id);
tl_status tl_blocks_check(tl_model *m, const tl_id *ids, size_t count);
/* The same of blocks that are to be rigid: TL_E_STATE where one has zones. `verb`: "fix blocks"; `instead`: what is to
 * be done. */
tl_status tl_blocks_check_rigid(tl_model *m, const tl_id *ids, size_t count, const char *verb, const char *instead);
/* Row of an id known to live, or TL_NO_ROW. */
uint32_t tl_block_row_quiet(const tl_model *m, tl_id id);

/* Limit: points farther from zero than this, m, are refused. The fifth power of a length, which inertia needs, must be
 * finite, and so must densities times it and sums over bodies. */
#define TL_FARTHEST 1e50
/* Limit: volume, mass and inertia, in SI units, lie between the one and the other. Products with what else a step has,
 * sums over bodies and reciprocals stay finite. */
#define TL_LEAST_MEASURE 1e-250
#define TL_MOST_MEASURE 1e250
/* Takes the damping off. */
void tl_damping_clear(tl_model *m);

/* TL_E_CANCELLED when the user asked to stop, else TL_OK. */
tl_status tl_model_go_on(tl_model *m);
void tl_model_say(tl_model *m, const char *format, ...) TL_PRINTF(2, 3);
/* True the first time only: a remark of this kind is made once a model. */
bool tl_model_says(tl_model *m, tl_remark remark);
/* Refuses with TL_E_STATE while a callback runs; `what` is "create blocks". */
tl_status tl_model_may_change(tl_model *m, const char *what);
/* Refuses with TL_E_STATE while a drive's function runs, which is in the middle of a step; `what` is "fix blocks". All
 * that detection, the step, laws, damping or motion depend on asks this before it is changed. */
tl_status tl_model_may_set(tl_model *m, const char *what);

#endif
