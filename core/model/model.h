/* model.h - what a model is made of, for the rooms to the right of it (contact, force, cycle, io ...).
 *
 * Blocks are shapes; bodies move. A body is one block or several joined ones. All kinematics lives in
 * the bodies' columns: a block's shape is kept in its body's frame, whose origin is the body's
 * centroid, so a point p of a shape is at
 *
 *     origin + x_ref + u + R p
 *
 * `origin` is a point of the model rounded to a coarse power of two, so that a model far from the
 * coordinates' zero loses no digits; x_ref is the body's centroid when the body was made and u its
 * displacement since, kept apart so that a step far below the rounding of x_ref still counts.
 *
 * Rows of blocks and bodies are in ascending order of id. Rows change when blocks are created, cut,
 * joined or deleted; `structure` counts these changes, and a block that came or changed bears the count.
 * Rows of blocks that were deleted go when rows are next gone through (tl_rows_tidy). Ids never change and are never used again. */
#ifndef TL_MODEL_MODEL_H
#define TL_MODEL_MODEL_H

#include "base/error.h"
#include "base/parallel.h"
#include "base/table.h"
#include "geometry/polyhedron.h"
#include "model/cuts.h"
#include "model/law.h"

#include <stdatomic.h>
#include <talus/talus.h>
#include <talus/vmath.h>

/* Default minimum area of field contacts, as a share of the smaller block's mean face area: none. Hart, Cundall and Lemos
 * (1988) have 1 % of a face. */
#define TL_AREA_FRACTION 0.0
/* Default FRAC of (27), by the rule: one contact counts (Hart, Cundall and Lemos 1988), or all of a body. */
#define TL_PAPER_FRACTION 0.1
#define TL_BODY_FRACTION 0.5

/* Default share of the mass that may be added for a longer step: what slides or falls is then as much slower at the most. */
#define TL_MOST_ADDED 0.05

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
    /* From where displacements count, after reset_displacement or when bodies were joined; NULL: from where it was made. */
    tl_base *base;
    /* Where it was made, once bodies were joined; NULL: where the frame of its body has neither shift nor turn. */
    tl_base *made;
    double *size;      /* cube root of the volume: the length tolerances refer to */
    double *mean_face; /* mean face area, m2 */
    uint64_t *lineage; /* key of the block's descent, for random draws */
    uint8_t *hidden;
    uint8_t *
        stays; /* 0: it is deleted, and its row goes when rows are next tidied; its shape has gone */
    uint64_t
        *changed; /* count of `structure` with which it came, or got another shape, frame or tags */
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
 * that memory knows, so all of it lies together, in three of the lines that memory hands over at a time, and not in
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
    tl_vec3 *force;   /* unbalanced: contacts, weight, loads */
    tl_vec3 *moment;
    /* unbalanced, in the last damped step; NULL: no damping has asked for them */
    tl_vec3 *force_before, *moment_before;
    tl_body_load *load; /* of the user's; NULL: none has ever been set */
    tl_wrench *
        load_before; /* what it was in the last step; NULL as it is, and good while loads_changed */
    uint32_t *drive; /* index into drives + 1, or 0 */
    double *odometer; /* sum of (|v| + |w| radius) dt: no vertex has moved farther */
    double *
        face_rate; /* what it asks of the time step on its largest face: cycle/rates.c. 0: not known */
    double *face_turn; /* its rotation's part of that */
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

/* A rule for the minimum area of field contacts. */
typedef struct tl_min_area_rule {
    double fraction;
    double absolute; /* NaN: by the fraction */
} tl_min_area_rule;

typedef struct tl_joint_min_area {
    tl_tag tag;
    tl_min_area_rule rule;
} tl_joint_min_area;

/* Of all blocks, while known: total volume, m3, and the smallest volume, edge, m, and face, m2. */
typedef struct tl_extremes {
    bool known;
    double total, volume, edge, face;
} tl_extremes;

/* Remarks that are made once a model. */
typedef enum tl_remark {
    TL_REMARK_UNDAMPED, /* solve without damping */
    TL_REMARK_GRAVITY,  /* points upward */
    TL_REMARK_STEP,     /* a given one is far too long */
    TL_REMARK_FRICTION, /* looks like a coefficient */
    TL_REMARK_SOFT,     /* blocks sink in under their weight */
    TL_REMARK_STIFF,    /* the closure under weight is lost in rounding */
    TL_REMARK_DENSITY,  /* is not that of a solid, or does not go with the stiffness */
    TL_REMARK_TENSION,  /* initial stress pulls */
    TL_REMARK_OVERLAP,  /* blocks overlap when they come into contact */
    TL_REMARK_CLOSURE,  /* a contact closes by much of a block's thickness */
    TL_REMARK_UNDECIDED /* a run for equilibrium has ended before it, without failure */
} tl_remark;

/* A contact that somebody has asked for, by the ids of its blocks. */
typedef struct tl_asked_id {
    tl_id a, b, contact;
} tl_asked_id;

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
    uint32_t *row_of;  /* [next_id] row of a block id, or TL_NO_ROW */
    size_t member_capacity, row_of_capacity;
    tl_id next_id;
    size_t gone;          /* rows of blocks that are deleted */
    uint64_t structure;   /* counts changes of the rows */
    uint64_t constraints; /* counts changes of fixing, hiding or mass */

    char name[256]; /* of the last tl_tag_name */
    char **groups;
    size_t group_count;
    tl_joint_set *joints; /* joint number j is joints[j - 1] */
    size_t joint_count;
    tl_cut_record record;
    tl_heir *heirs; /* by ascending id */
    size_t heir_count, heir_capacity;
    tl_split *splits; /* by ascending id of the block */
    size_t split_count, split_capacity;
    tl_face_load *face_loads; /* by ascending block and face; of blocks that there were */
    size_t face_load_count, face_load_capacity;
    tl_extremes extremes;

    tl_law *joint_laws;
    size_t joint_law_count;
    uint64_t laws;  /* counts changes of the joint laws */
    uint64_t rules; /* counts changes of minimum areas and of contact_points */
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
    double dt;              /* of the last step; 0 before the first */
    tl_vec3 gravity_before; /* gravity in the last step, where it has been set since; else zero */
    bool gravity_changed, loads_changed; /* since the last step, while dt is not 0 */
    int64_t cycles;
    atomic_bool interrupted;
    bool (*interrupt_asked)(void);                                       /* or NULL */
    void (*show_generate)(void *user, const tl_generate_progress *done); /* or NULL */
    void *show_generate_user;
    bool running;  /* inside a callback: no blocks may be made or deleted */
    bool driving;  /* inside a drive's function: nothing that a step depends on may be set */
    bool reading;  /* the same, and no run may begin: tl_model_only_read */
    uint32_t said; /* bit r: remark r has been made */
    char stage[TL_STAGE_NAME + 1]; /* from which displacements count; "": none has been named */
    uint64_t remarked;           /* changes of blocks and laws at the last look at their numbers */
    bool mass_scaling;           /* of all free bodies */
    double added_dt, added_most; /* of the bodies that need it: tl_mass_scaling; NaN: off */

    bool profiling;
    double phase_began; /* s, of the clock */
    tl_profile profile; /* so far; the counts of contacts are made when asked for */

    struct tl_detect *detect;  /* of the module contact */
    struct tl_detect *stepped; /* before somebody asked after edits: asked.c; or NULL */
    bool only_asked;           /* no step has used it yet */
    tl_asked_id *asked_ids; /* of contacts that were asked for and are to be found again: asked.c */
    size_t asked_count;
    tl_id next_contact; /* the last that was given to one of them */
    void (*detect_destroy)(struct tl_detect *);
    struct tl_cycle *cycle; /* of the module cycle */
    void (*cycle_destroy)(struct tl_cycle *);
    struct tl_vtk_series *vtk; /* of the module io: the frames written so far */
    void (*vtk_destroy)(struct tl_vtk_series *);
    struct tl_page *pages; /* of the io room: the pages written so far */
    void (*pages_destroy)(struct tl_page *);
};

/* Whether the user wants the call of the kernel to end that is being made. */
static inline bool tl_model_interrupted(const tl_model *m)
{
    return atomic_load(&m->interrupted) || (m->interrupt_asked && m->interrupt_asked());
}

/* Present place of a body's centroid, relative to the origin. */
static inline tl_vec3 tl_body_place(const tl_bodies *b, uint32_t body)
{
    return tl_v3_add(b->pose[body].x_ref, b->pose[body].u);
}

/* From body a's centroid to body b's. The references are subtracted first, so that a small relative
 * displacement keeps its digits. */
static inline tl_vec3 tl_apart(tl_vec3 x_ref_a, tl_vec3 u_a, tl_vec3 x_ref_b, tl_vec3 u_b)
{
    return tl_v3_add(tl_v3_sub(x_ref_b, x_ref_a), tl_v3_sub(u_b, u_a));
}

static inline tl_vec3 tl_body_apart(const tl_bodies *bodies, uint32_t a, uint32_t b)
{
    const tl_pose *p = &bodies->pose[a], *q = &bodies->pose[b];
    return tl_apart(p->x_ref, p->u, q->x_ref, q->u);
}

/* Present place of a point of a shape, in the user's coordinates. */
static inline tl_vec3 tl_model_point(const tl_model *m, uint32_t body, tl_vec3 local)
{
    tl_vec3 x =
        tl_v3_add(tl_body_place(&m->bodies, body), tl_m3_mul(&m->bodies.pose[body].r, local));
    return tl_v3_add(m->origin, x);
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

/* Whether two bodies may become one unasked: nothing but their own weight and contacts tells them apart. */
static inline bool tl_bodies_may_join(const tl_bodies *b, uint32_t one, uint32_t other)
{
    return one != other && b->fixed[one] == b->fixed[other] && !b->drive[one] && !b->drive[other] &&
           !tl_body_loaded(b, one) && !tl_body_loaded(b, other);
}

/* A block's centroid in its body's frame. */
static inline tl_vec3 tl_block_local(const tl_model *m, uint32_t row)
{
    return m->blocks.local ? m->blocks.local[row] : tl_v3(0, 0, 0);
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
const tl_heir *tl_heir_of(const tl_model *m, tl_id id);
/* The body that a block was in in the last step when cuts have split it since, or TL_NO_ID. */
tl_id tl_split_of(const tl_model *m, tl_id block);

/* Row of a block id, or TL_NO_ROW with a sentence in the model's error. */
uint32_t tl_block_row(tl_model *m, tl_id id);
/* Row of an id known to live, or TL_NO_ROW. */
uint32_t tl_block_row_quiet(const tl_model *m, tl_id id);

/* TL_E_NOT_FOUND: "unknown law 'coulom'; did you mean ...": kinds.c. */
tl_status tl_kind_unknown(tl_error *error, tl_kind_type type, const char *name);
tl_status tl_unknown_kind(tl_model *m, tl_kind_type type, const char *name);
/* Points farther from zero than this, m, are refused: the fifth power of a length, which inertia needs, must be finite
 * with room for densities and sums over bodies. */
#define TL_FARTHEST 1e50
/* Volume, mass and inertia, in SI units, are computed with between the one and the other: products with what else a step
 * has, and sums over bodies, stay finite, and so do their reciprocals. */
#define TL_LEAST_MEASURE 1e-250
#define TL_MOST_MEASURE 1e250
/* Faster motion, m/s or rad/s, is not set, driven or parted: momentum and angular momentum stay finite, and no step is so short that
 * a model could run with it. */
#define TL_FASTEST 1e50
/* TL_E_ARGUMENT with a sentence, after the name of a verb, unless both are finite and no component is above that: fastest.c. */
tl_status tl_check_motion(tl_error *error, const char *verb, tl_vec3 velocity,
                          tl_vec3 angular_velocity);
/* TL_E_NUMERIC with a sentence when volume, mass or inertia of a block of this density cannot be computed with. */
tl_status tl_check_measures(tl_error *error, const tl_poly *shape, double density);
/* The id of the plugin that a kind is of, for sentences. */
const char *tl_plugin_id(const tl_kind *kind);

/* Takes the damping off. */
void tl_damping_clear(tl_model *m);

void tl_model_say(tl_model *m, const char *format, ...) TL_PRINTF(2, 3);
/* True the first time only: a remark of this kind is made once a model. */
bool tl_model_says(tl_model *m, tl_remark remark);
/* Refuses with TL_E_STATE while a callback runs; `what` is "create blocks". */
tl_status tl_model_may_change(tl_model *m, const char *what);
/* Refuses with TL_E_STATE while a drive's function runs, which is in the middle of a step; `what` is "fix blocks". All that
 * detection, the step, laws, damping or motion depend on asks this before it is changed. */
tl_status tl_model_may_set(tl_model *m, const char *what);

/* ---- groups and joints: joints.c ---- */

/* Index of a group's name, made when new; UINT32_MAX when out of memory. */
uint32_t tl_group_intern(tl_model *m, const char *name);
/* Number of a joint set, 0 when there is none of that name. */
uint32_t tl_joint_find(const tl_model *m, const char *name);
/* Finds or makes a joint set; 0 when out of memory. */
uint32_t tl_joint_intern(tl_model *m, const char *name);
/* Parses "*", "J1" or "J1:3"; fails with a sentence (nearest name) when the joint does not exist. */
tl_status tl_joint_parse(tl_model *m, const char *text, tl_tag *tag);
/* True when `pattern` ("*": 0,0; set: j,0; plane: j,p) covers `tag`. */
bool tl_tag_matches(tl_tag pattern, tl_tag tag);
/* The joint law that rules a contact of this tag, or NULL. */
const tl_law *tl_law_of(const tl_model *m, tl_tag tag);
tl_min_area_rule tl_min_area_of(const tl_model *m, tl_tag tag);
void tl_law_clear(tl_law *law);

/* ---- staging: stage.c ---- */

/* A block of the staging set: an untouched one of the model (source, shape not owned), the same with
 * new tags (retagged), a child of one (source), or a new one (source TL_NO_ROW, shape in coordinates
 * relative to the origin). Children's shapes are in the frame of their source's body. */
typedef struct tl_stage_block {
    tl_poly *shape;
    uint32_t source;
    uint32_t group;
    double density;
    uint64_t lineage;
    uint32_t body; /* blocks of one number are one body */
    uint32_t
        detached_from; /* a body it was taken out of and that has not been settled since, or TL_NO_ROW */
    uint64_t draw; /* key of the body's draws: the least of its blocks' lineages */
    bool owned, retagged, hidden;
    bool hide_on_commit;
    uint8_t fixed;            /* of a new block: what of its motion is held */
    bool hidden_by_generator; /* while it runs */
    bool multi_block;         /* its body may have other blocks */
    bool needs_reconnect;     /* its body has been cut since it was last known to hang together */
} tl_stage_block;

/* A ball about a staged block, relative to the model's origin: the coarse test of a cut. Kept apart from
 * the blocks, for a plane is tested against all of them and cuts few. */
typedef struct tl_stage_ball {
    tl_vec3 center;
    double radius;
} tl_stage_ball;

typedef struct tl_stage {
    tl_model *model;
    tl_stage_block *blocks;
    tl_stage_ball *balls; /* [capacity] */
    size_t count, capacity;
    size_t *visible; /* [capacity] indices of the blocks that generators see, ascending */
    size_t visible_count;
    uint32_t next_body;
    bool opened;          /* the model's blocks are in it */
    bool lost;            /* there was no memory for that when a service asked that cannot say so */
    bool needs_reconnect; /* some block does */
    bool regroups;        /* bodies of several blocks are made or changed */
    tl_generate_summary summary;
    double created_volume;   /* less what was deleted */
    double changed_volume;   /* of what a commit has made, less what it replaced */
    tl_refused_cut *refused; /* `block` is an index into blocks until the commit */
    size_t refused_listed;
    /* what to go back to when the stage is dropped */
    size_t joint_count, group_count;
    uint32_t *plane_count;
    bool origin_set;
} tl_stage;

/* Begins a staging set without the model's blocks, to which new ones may be added. */
tl_status tl_stage_begin_empty(tl_model *m, tl_stage *stage);
/* Puts the model's blocks into it, before those that were added. TL_E_MEMORY leaves it as it was. */
tl_status tl_stage_open(tl_stage *stage);
/* Begins a staging set with the model's blocks in it. */
tl_status tl_stage_begin(tl_model *m, tl_stage *stage);
/* Adds a block, of which it then owns what the block does; false when out of memory. */
bool tl_stage_push(tl_stage *stage, const tl_stage_block *block);
/* Adds the convex hull of vertices, or a box, given in user coordinates (stage_new.c). */
tl_status tl_stage_add_hull(tl_stage *stage, const tl_vec3 *vertices, size_t count, double density,
                            const char *group);
tl_status tl_stage_add_box(tl_stage *stage, tl_vec3 min, tl_vec3 max, double density,
                           const char *group);
/* Adds a block given by its faces; see tl_host.create_block. */
tl_status tl_stage_add_faces(tl_stage *stage, const tl_block_shape *given);
/* Cuts the visible blocks by a plane in user coordinates; see tl_host.cut. */
tl_status tl_stage_cut(tl_stage *stage, tl_vec3 normal, tl_vec3 point, tl_tag tag,
                       double persistence);
/* The same by a disc of `radius` about `point`; adds the blocks in its path to *met; see
 * tl_host.cut_disc. */
tl_status tl_stage_cut_disc(tl_stage *stage, tl_vec3 normal, tl_vec3 point, double radius,
                            tl_tag tag, double persistence, size_t *met);
/* Cuts block `index` (of all staged) without a joint: both sides stay one body. `above` is the new
 * block on the normal's side, or SIZE_MAX when the plane does not divide the block. */
tl_status tl_stage_cut_block(tl_stage *stage, size_t index, tl_vec3 normal, tl_vec3 point,
                             size_t *above);
/* Whether the inside of block `index` meets the common inside of half spaces. */
tl_status tl_stage_meets(tl_stage *stage, size_t index, const tl_half_space *spaces, size_t count,
                         bool *meets);
/* Makes the staging set the model's blocks (stage_commit.c); on failure the model is as before. Ends the stage. */
tl_status tl_stage_commit(tl_stage *stage);
/* Drops the staging set, with the joints, planes and groups made since it was begun. */
void tl_stage_drop(tl_stage *stage);
/* Frees the lists of a staging set whose shapes have gone to the model or are freed. */
void tl_stage_end(tl_stage *stage);

/* ---- bodies of staged blocks: stage_bodies.c ---- */

/* Takes blocks out of their bodies: those that hang together over faces without a new joint are one
 * body, and so is what is left. */
void tl_stage_part(tl_stage *stage, const size_t *indices, size_t count);
/* Makes one body of all the bodies the blocks are of. */
void tl_stage_join(tl_stage *stage, const size_t *indices, size_t count);
void tl_stage_delete(tl_stage *stage, size_t index);
/* Makes the list of visible blocks anew. */
void tl_stage_list_visible(tl_stage *stage);
/* Gives every body that needs it the numbers of the parts it falls into. */
tl_status tl_stage_settle(tl_stage *stage);
/* group[row] of the rows whose blocks have the given ids, as tl_bodies_regroup wants it; `first` has room
 * for stage->next_body numbers. */
void tl_stage_groups(const tl_stage *stage, const tl_id *ids, uint32_t *first, uint32_t *group);

/* ---- bodies: bodies.c ---- */

/* Makes room for `count` blocks and as many bodies, and for the ids below `next_id`. */
bool tl_rows_reserve(tl_model *m, size_t count, tl_id next_id);
/* Derives the members of all bodies and the id-to-row table after rows have changed; the memory must
 * have been reserved. Counts a change of structure. */
void tl_rows_refresh(tl_model *m);
/* The same where single blocks, bodies of their own, have been added from row `first` on. */
void tl_rows_added(tl_model *m, uint32_t first);
/* Takes out the rows of blocks that have been deleted. Whoever goes through rows, and not from ids, calls this before. */
void tl_rows_tidy(tl_model *m);
/* Derives a block's size and mean face from its shape, whose volume is given. */
void tl_block_measure(tl_model *m, uint32_t row, double volume);
/* Derives a body's mass, inertia and radius from its blocks. */
void tl_body_measure(tl_model *m, uint32_t body);
/* The same for a body of one block, whose mass properties at density 1 are known. */
void tl_body_measure_single(tl_model *m, uint32_t body, uint32_t row, tl_mass mass);
/* Removes the blocks with keep[row] == 0, and bodies left without blocks. Their shapes are the caller's. */
void tl_rows_keep(tl_model *m, const unsigned char *keep);

/* ---- extremes.c: a block has come, goes; all that is known of them ---- */
void tl_extremes_add(tl_model *m, uint32_t row);
void tl_extremes_drop(tl_model *m, uint32_t row);
tl_extremes tl_extremes_of(tl_model *m);

/* The rows of blocks and bodies as they were before a change that may fail half-way: aside.c. */
typedef struct tl_aside {
    tl_blocks blocks;
    tl_bodies bodies;
    tl_id next_id;
    uint64_t structure, constraints;
} tl_aside;

/* Sets copies aside; false when out of memory. Until the change is settled shapes of the rows must not be freed, and drives
 * are kept though no body follows them. */
bool tl_rows_set_aside(tl_model *m, tl_aside *aside);
/* Takes them back: the model is as it was. */
void tl_rows_take_back(tl_model *m, tl_aside *aside);
/* Forgets them: the change is made. */
void tl_rows_settle(tl_model *m, tl_aside *aside);

/* ---- regroup.c ---- */

/* Makes the bodies anew: blocks of the same group[row] (the row of the group's lowest block) are one
 * body. Bodies that stay as they are are not touched; others get the mass, momentum and angular
 * momentum of their parts. TL_E_MEMORY leaves the model as it was. */
tl_status tl_bodies_regroup(tl_model *m, const uint32_t *group);
/* Sets group[row] for the bodies that lose blocks (keep[row] is 0) or have lost some since they were
 * measured: what is left of each falls into the groups that hang together over shared faces. */
tl_status tl_bodies_fall_apart(tl_model *m, const unsigned char *keep, uint32_t *group);
/* Makes bodies anew whose blocks were cut off or changed their mass. */
tl_status tl_bodies_mend(tl_model *m);
/* group[row] of the bodies as they are. */
void tl_bodies_groups(const tl_model *m, uint32_t *group);
/* A block's inertia about its centroid, in the axes of the model. */
tl_sym3 tl_block_inertia(const tl_model *m, uint32_t row);
tl_vec3 tl_block_velocity(const tl_model *m, uint32_t row);

/* ---- loads.c ---- */

/* Evaluates all drives at time t; false when a user's function ends the run. */
bool tl_drives_evaluate(tl_model *m, double t);
/* Lets a body go from its drive. */
void tl_drive_leave(tl_model *m, uint32_t body);
/* The motion of a body begins anew, as it is set or was held: its load before does not count. */
void tl_load_begins_anew(tl_model *m, uint32_t body);
/* Holds the columns of loads. A model that has loads has what they were before, too. false: out of memory. */
bool tl_bodies_hold_loads(tl_bodies *b);
/* A step has been made: what gravity and loads are now is what they were in it. */
void tl_loads_stepped(tl_model *m);
void tl_drives_clear(tl_model *m);
/* Counts the bodies of each drive again, after a driven body has fallen into several. */
void tl_drives_recount(tl_model *m);
/* Keeps the drives in use though no body follows them, or ends those that none follows any more. */
void tl_drives_hold(tl_model *m);
void tl_drives_settle(tl_model *m);

/* ---- histories.c ---- */

/* What of a history, beside its samples, cannot be one of this model, as a part of a sentence; NULL: nothing. */
const char *tl_history_unsound(const tl_model *m, const tl_history *h);
/* Adds a history that is sound, with room for its ids and for so many samples of its width; NULL: out of memory. */
tl_history *tl_history_hold(tl_model *m, const tl_history *what, size_t samples);
void tl_history_free(tl_history *h);
size_t tl_history_bytes(const tl_history *h);

#endif
