/* talus/plugin.h - the plugin interface: laws, dampings, generators, screens, solids and elements as shared objects.
 *
 * A plugin is a shared object that exports one function,
 *
 *     const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor);
 *
 * which returns a descriptor of pure data (or NULL to refuse the host); TL_PLUGIN writes it. Scanning a plugin creates
 * nothing. The descriptor lists *kinds*: laws, dampings, generators, screens, solids and elements, each with its
 * parameters, states and operations. The host checks, defaults and documents parameters from one table. It owns
 * states, carries them over, saves and writes them.
 *
 * Growth: every struct begins with its `size` and every array carries a stride, so a newer host
 * reads an older plugin. The major version must match; a minor version only appends.
 *
 * Threads: a function marked [main] runs on the main thread. One marked [worker] runs on several threads at once and
 * must be a pure function of what it is given.
 *
 * Errors: a function returns TL_OK, or another status after putting one sentence (and the first
 * bad index) into the report. The host adds plugin, joint, blocks, cycle and script line. */
#ifndef TALUS_PLUGIN_H
#define TALUS_PLUGIN_H

#include <stdbool.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TL_ABI_MAJOR 1u
#define TL_ABI_MINOR 16u

#if defined(__GNUC__)
#define TL_PLUGIN_EXPORT __attribute__((visibility("default")))
#define TL_PRINTF(fmt, first) __attribute__((format(printf, fmt, first)))
#else
#define TL_PLUGIN_EXPORT
#define TL_PRINTF(fmt, first)
#endif

/* Number of double lanes to which batches are padded; columns are aligned to TL_ALIGN bytes. */
#define TL_LANES 8u
#define TL_ALIGN 64u

/* Before a function whose loops run over columns: compiled once more for processors with wider vectors, of
 * which the program takes what it finds. Contraction of products is off, so all give the same bits. */
#if defined(TL_VECTORIZED)
/* whoever builds has chosen */
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TL_VECTORIZED /* the choice is made before the sanitizer has started */
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TL_VECTORIZED
#endif
#endif
#ifndef TL_VECTORIZED
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__)
#define TL_VECTORIZED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TL_VECTORIZED
#endif
#endif

/* ---------------------------------------------------------------- parameters ------------- */

/* Type of a parameter, and the C member the host writes at `offset` of the params struct. */
typedef enum tl_param_type {
    TL_PARAM_REAL, /* double; NaN when optional and not given */
    TL_PARAM_INT,  /* int64_t */
    TL_PARAM_BOOL, /* int32_t, 0 or 1 */
    TL_PARAM_ENUM, /* int32_t, index into `choices` */
    TL_PARAM_VEC3, /* tl_vec3; NaN when optional and not given */
    /* of generators only: they are valid during the call, and the host refuses them in kinds that keep parameters.
     * Since 1.13 also of elements: the host keeps the text as long as `self`. */
    TL_PARAM_STRING, /* const char *; NULL when optional and not given */
    /* tl_points: a list of vectors; empty when optional and not given. Since 1.10 also of solids, with TL_PARAM_FLAT: a
     * table of rows {x, y} in which x ascends. The host keeps the rows as long as `self`. Since 1.15 also of
     * elements. */
    TL_PARAM_POINTS
} tl_param_type;

typedef struct tl_points {
    const tl_vec3 *at;
    size_t count;
} tl_points;

enum {
    TL_PARAM_REQUIRED = 1, /* must be given; `def` is not used */
    TL_PARAM_OPTIONAL = 2, /* may be missing, and has no default */
    TL_PARAM_MIN_OPEN = 4, /* value > min instead of >= */
    TL_PARAM_MAX_OPEN = 8, /* value < max instead of <= */
    /* since 1.6, of points: rows of two numbers, {{1, 2}, ...}; the third is 0 */
    TL_PARAM_FLAT = 128,
    /* since 1.3, of a string: a file that is read. The host refuses pipes, devices and folders, whose opening may
     * wait */
    TL_PARAM_FILE = 16,
    /* since 1.11, of a real of a law: a stiffness of the joint, which a trial with stiffer joints multiplies */
    TL_PARAM_STIFFNESS = 32,
    /* since 1.12, of a real of a law or a solid, or of the second numbers of a solid's table: what a factor of safety F
     * does to it. STRENGTH: a stress, or whatever the strength is proportional to, is divided by F. STRENGTH_ANGLE: the
     * tangent of an angle in degrees is; 90 stays 90. STRENGTH_DIVISOR: what divides the strength is multiplied by F.
     * STRENGTH_ENERGY: a work of fracture is divided by F^2, so that the displacements of its curve are divided by F.
     * All strengths at once are then 1/F of what they were; values stay within the range of their row. */
    TL_PARAM_STRENGTH = 64,
    TL_PARAM_STRENGTH_ANGLE = 256,
    TL_PARAM_STRENGTH_DIVISOR = 512,
    TL_PARAM_STRENGTH_ENERGY = 1024,
    /* since 1.13, of an element: `place` reads it, so it cannot be set later */
    TL_PARAM_PLACE = 2048
};

/* One parameter. Reals and integers are checked against [min, max]; for a vec3 every component
 * is. min = max = 0 means no range. NaN and infinity are always refused. So are reals of laws, dampings and solids that
 * are not 0 and whose size is outside [1e-50, 1e50]. */
typedef struct tl_param {
    uint32_t size; /* sizeof(tl_param) */
    uint32_t type; /* tl_param_type */
    const char *name;
    const char *alias; /* second name, or NULL */
    const char *unit;  /* "Pa/m", "deg", "" */
    const char *doc;   /* one sentence */
    size_t offset;     /* of the member in the params struct */
    uint32_t flags;
    double def[3]; /* default; reals, ints, bools and enums use def[0] */
    double min, max;
    const char *def_text;       /* default of a string */
    const char *const *choices; /* of an enum: names, NULL terminated */
} tl_param;

/* Declares one row of a parameter table: TL_PARAM(struct type, member, "unit", "doc", .field = ...) */
#define TL_PARAM(kind, owner, member, unit_, doc_, ...)                                                                \
    {                                                                                                                  \
        .size = sizeof(tl_param), .type = (kind), .name = #member, .unit = (unit_), .doc = (doc_),                     \
        .offset = offsetof(owner, member), __VA_ARGS__                                                                 \
    }

/* ---------------------------------------------------------------- states ----------------- */

/* Columns that the states of one law or damping may take: one for a scalar, three for a tangent. */
#define TL_STATE_COLUMNS 8
/* Columns that the states of one solid may take. */
#define TL_SOLID_COLUMNS 16
/* Columns that the states of one kind of element may take: of its nodes, and as many of whole elements. */
#define TL_ELEMENT_COLUMNS 16

typedef enum tl_state_kind {
    TL_STATE_SCALAR,  /* one column */
    TL_STATE_TANGENT, /* of laws, three columns: a vector in the common plane, turned with it by the host */
    /* since 1.10, of solids, three columns: a vector, turned with the zone by the host. A new one is 0, and 0 stays
     * 0: a solid whose axis is 0 takes the one that its parameters give. */
    TL_STATE_AXIS,
    TL_STATE_TENSOR, /* since 1.10, of solids, six columns xx yy zz xy yz zx, turned with the zone by the host */
    TL_STATE_WHOLE   /* since 1.13, of elements, one column: a number of a whole element, not of each node */
} tl_state_kind;

/* What becomes of a state when the contact polygon changes. */
typedef enum tl_state_transfer {
    TL_TRANSFER_COPY,  /* intensive: the mean over the area that the point gets, within what there was */
    TL_TRANSFER_SPLIT, /* extensive: the sum goes with the area */
    TL_TRANSFER_RESET, /* back to the initial value */
    /* 1.8, a scalar, J: what shear holds beyond f^2 / (2 ks area); the host keeps its sum over the points */
    TL_TRANSFER_ENERGY,
    TL_TRANSFER_LIFT /* 1.8, >= 0: what the normal force is linear in; its moments over the area stay, too */
} tl_state_transfer;

/* One state: of a law per contact point, of a damping per model, of a solid per zone, of an element per node or for the
 * whole. The host owns it. */
typedef struct tl_state {
    uint32_t size;
    uint32_t kind;     /* tl_state_kind; a damping has scalars only */
    uint32_t transfer; /* tl_state_transfer; TL_TRANSFER_COPY for dampings, solids and elements. Since 1.15 an element
                        * may have TL_TRANSFER_RESET: where `place` is called again the state is what that gives.
                        * Since 1.16 one of the whole may have TL_TRANSFER_SPLIT: it goes with the weight of nodes, from
                        * the element with the same key or else the nearest. */
    const char *name;
    const char *unit;
    const char *doc;
    double initial;
} tl_state;

/* Declares one row of a state table: TL_STATE(TL_STATE_SCALAR, "slip", "m", "length of the slip so far"). It is copied
 * from old points and begins at 0, unless .transfer or .initial follow the sentence. */
#define TL_STATE(kind_, name_, unit_, ...)                                                                             \
    {                                                                                                                  \
        .size = sizeof(tl_state), .kind = (kind_), .name = (name_), .unit = (unit_), .doc = __VA_ARGS__                \
    }

/* ---------------------------------------------------------------- reports ---------------- */

typedef struct tl_report {
    uint32_t size;
    size_t first_bad; /* index into the batch, where that means something */
    char text[256];
} tl_report;

/* ---------------------------------------------------------------- laws ------------------- */

/* Flags of a contact point, set by the law. 0 is elastic. */
enum {
    TL_POINT_SLIPPING = 1, /* shear force at its limit in this step */
    TL_POINT_OPEN = 2,     /* carries nothing */
    TL_POINT_FAILED = 4,   /* bond lost; stays set */
    /* since 1.1: set by the host on a point made while the walls were apart: they were never bonded. The law clears it,
     * or keeps it until they meet */
    TL_POINT_APART = 8
};

/* Contact points under the law of one joint, with one set of properties, as columns. Every column has `count` entries,
 * a multiple of TL_LANES, aligned to TL_ALIGN bytes, padded with inert lanes (area 0), so loops need no tail.
 *
 * Signs: the unit normal n points from block A to block B; forces are those on B. Normal force and closure are
 * compression positive; closure is how far the walls have approached since the reference state. du is the motion of B
 * relative to A during dt (1-4 of Hart, Cundall and Lemos 1988), closing is negative du_n. f_s comes in already turned
 * into the new common plane and scaled to the new area (5). */
typedef struct tl_law_batch {
    uint32_t size;
    uint32_t count;
    double dt;               /* s, in which it moves; 0 in the first step of a run, and while model:relax runs */
    const double *area;      /* m2 */
    const double *closure;   /* m */
    const double *f_n0;      /* N, normal force at closure 0 (in situ) */
    const double *normal[3]; /* A to B */
    const double *du_n;      /* m, along n */
    const double *du_s[3];   /* m, in the common plane */
    double *f_n;             /* in: last step's; out: N, compression positive */
    double *f_s[3];          /* in/out: N, shear force on B */
    double *const *state;    /* in/out: state columns in the order declared (3 for a tangent) */
    uint32_t *flags;         /* in/out */
    double *stored;          /* out, or NULL: elastic energy, J */
    double *dissipated;      /* out, or NULL: energy turned to heat in this step, J */
    /* since 1.4: m, closure at the outermost fibre of the area that a point stands for, where that is least. Points of
     * a patch are drawn in from its corners and edges; a bond begins to break there. The closure itself for points that
     * stand alone. */
    const double *closure_edge;
    /* since 1.8: m, >= 0. Where a joint opens from one side, the area of a point may be closed in part. Then `closure`
     * is that of the closed part, and `closure_apart` how far the other part is apart, both as means over the whole
     * area:
     *
     *     closure + lift = (1 / A) int max(0, o + lift) dA,    closure_apart = (1 / A) int max(0, -o - lift) dA
     *
     * with o the closure from place to place and the lift of `across_gap`. A law without tension has the right force
     * from `closure` alone; one that pulls with a share `hold` of its area takes hold * closure_apart from it. 0 where
     * the area is wholly closed or wholly apart. */
    const double *closure_apart;
} tl_law_batch;

/* Which points of a law may pull, that is carry a normal force below 0. */
enum {
    TL_PULL_ANY,    /* any may */
    TL_PULL_BONDED, /* those without TL_POINT_FAILED may */
    TL_PULL_NONE    /* none */
};

/* Operations of a law. `create` and `destroy` may both be NULL: then `self` is the host's own copy
 * of the params struct. */
typedef struct tl_law_ops {
    uint32_t size;
    /* [main] */
    tl_status (*create)(const void *params, void **self, tl_report *report);
    /* [worker] */
    tl_status (*update)(const void *self, const tl_law_batch *batch, tl_report *report);
    /* [worker] upper bounds, Pa/m */
    void (*stiffness)(const void *self, double *kn, double *ks);
    /* [main] */
    void (*destroy)(void *self);
    /* [main] since 1.2; may be NULL. 1: with these parameters the law does not write to its states, and they are 0
     * unless other parameters have made them something else. The host then need not keep them: they are 0 in the
     * batch. */
    int (*stateless)(const void *self);
    /* since 1.3; not 0: `update` always returns TL_OK. A step in which a law or the damping fails is undone; of those
     * that cannot fail the host need not keep what that takes, up to a fifth of the time of a step. */
    uint32_t never_fails;
    /* [main] since 1.4; may be NULL, which is TL_PULL_ANY. TL_PULL_*, with these parameters. */
    uint32_t (*pulls)(const void *self);
    /* [worker] since 1.8; may be NULL. What points carry where their walls are apart, from the batch's area, f_n0,
     * state and flags; its other columns are NULL. `lift`, m: a point carries no pressure at closures below -lift; NULL
     * gives f_n0 / (kn A). So a law has to tell whose slip opens the joint, or whose initial force is not that of this
     * closure. `hold`, 0 to 1: the share of the tension in a part apart that the point carries; NULL gives 0. Padding
     * lanes get any number. */
    void (*across_gap)(const void *self, const tl_law_batch *batch, double *lift, double *hold);
    /* since 1.8; not 0: what presses has the normal force kn A u, with the kn of stiffness() and u the closure and
     * lift */
    uint32_t linear;
    /* since 1.8, for a law that is not linear; may be NULL: energy, J, of what presses at the closure, as it is part of
     * `stored`. The batch has the columns area, closure, f_n0, state, flags and f_n. Into f_n the normal force that
     * belongs to the energy may be written, for all points or for none; without it the host asks at two closures more
     * for their difference. Where edges and corners press, the host needs this to make the force the gradient of an
     * energy; else some energy is lost or made there. */
    void (*pressed)(const void *self, const tl_law_batch *batch, double *energy);
} tl_law_ops;

/* ---------------------------------------------------------------- damping ---------------- */

/* Sums over the free bodies, at the start of the damping phase of a step. */
typedef struct tl_damping_totals {
    uint32_t size;
    double dt;           /* s */
    double kinetic;      /* sum of (m v.v + I w.w) / 2, J */
    double kinetic_rate; /* change of `kinetic` over the last step / dt, W */
    double power_unit;   /* sum of (m v.v + I w.w) of what is not held, W per unit of alpha */
    /* since minor 5: sum of (F.v + M.w), W: the power of the unbalanced forces, on velocities of half a step ago */
    double power;
} tl_damping_totals;

/* A run of bodies. The host then applies (23): v <- (D1 v + (F + F_d)/m dt) D2 with
 * D1 = 1 - alpha dt/2, D2 = 1/(1 + alpha dt/2), for velocities and angular velocities alike; m is the moving mass. */
typedef struct tl_damping_batch {
    uint32_t size;
    uint32_t count;
    double dt;
    const double *velocity[3];         /* m/s, half a step ago */
    const double *angular_velocity[3]; /* rad/s */
    const double *force[3];            /* N, whole unbalanced force: contacts, weight, loads */
    const double *moment[3];           /* N m, about the centroid */
    const double *mass;                /* kg, the body's own: its weight goes with it */
    const double *inertia;             /* kg m2, mean principal moment, the body's own */
    double *damping_force[3];          /* out, preset to 0 */
    double *damping_moment[3];         /* out, preset to 0 */
    double *alpha;                     /* out, preset to 0: viscous coefficient, 1/s */
    double *const *state;              /* the damping's states, one number each, read only here */
    /* since minor 1: force and moment of the step before, 0 on a new body; NULL when `before` is 0 */
    const double *force_before[3];
    const double *moment_before[3];
    /* since minor 9: what the step divides forces and moments by: the body's own, or what mass scaling makes of it */
    const double *moving_mass;    /* kg */
    const double *moving_inertia; /* kg m2, mean of the three moments, or the paper's one */
} tl_damping_batch;

typedef struct tl_damping_ops {
    uint32_t size;
    /* [main] */
    tl_status (*create)(const void *params, void **self, tl_report *report);
    /* [main] once a step before `update`: a controller adjusts its states. May be NULL. */
    tl_status (*begin)(const void *self, const tl_damping_totals *totals, double *const *state, tl_report *report);
    /* [worker] */
    tl_status (*update)(const void *self, const tl_damping_batch *batch, tl_report *report);
    /* [main] factor on the stable time step, (0, 1] */
    double (*step_factor)(const void *self);
    /* [main] */
    void (*destroy)(void *self);
    /* since minor 2: not 0: `update` reads force and moment of the step before, which the host then keeps. Plugins of
     * minor 1 are given them. */
    uint32_t before;
    /* since minor 3; not 0: `begin` and `update` always return TL_OK, as a law's */
    uint32_t never_fails;
    /* [main] since minor 14; may be NULL. Damping of contacts in proportion to their stiffness: *beta, s, >= 0. The
     * host adds the force beta k A du/dt, normal and along the face, at closed points that do not slip. Where
     * contacts alone hold, the stable step is then shorter by sqrt(1 + l^2) - l, l = beta / step. What cannot pull gets
     * no tension by it. */
    void (*contact)(const void *self, double *beta);
} tl_damping_ops;

/* ---------------------------------------------------------------- generators ------------- */

/* What a generator may ask of the host. All works on a staging set that is committed when the
 * generator returns TL_OK and dropped otherwise. Every function that returns a status has already
 * written its sentence when it is not TL_OK: return that status at once. */
typedef struct tl_host tl_host;

typedef struct tl_block_info {
    uint32_t size;
    double volume;
    tl_vec3 centroid;
    tl_bounds bounds;
    const char *group;
    uint64_t lineage; /* key of the block's descent, for random draws */
    /* since minor 1 */
    uint32_t body; /* blocks of one number are one body; the number changes as bodies do */
} tl_block_info;

/* The points x with normal . (x - point) < 0; the normal is of unit length. */
typedef struct tl_half_space {
    tl_vec3 normal, point;
} tl_half_space;

/* A block given by its faces, for create_block. Faces are counter-clockwise from outside, flat, and close
 * a convex shape; face f has the corners loops[start[f]] .. loops[start[f + 1] - 1], counted from 0. */
typedef struct tl_block_shape {
    uint32_t size;
    const tl_vec3 *vertices;
    size_t vertex_count;
    const uint32_t *start, *loops;
    size_t face_count;
    const tl_tag *tags; /* [face_count] planes asked for by `joint` and `next_plane`; 0: no joint */
    double density;     /* kg/m3, > 0 */
    const char *group;
    uint32_t fixed;  /* held: 1 x, 2 y, 4 z, 8 rotation, added up */
    uint32_t hidden; /* 1: hidden once the generator has ended */
} tl_block_shape;

/* Since 1.11: a solid given by its surface, for create_solid. It need not be convex. Faces are flat polygons with any
 * number of corners, counter-clockwise from outside, and close one solid: one shell around it, and one around each of
 * its cavities. Holes may go through it. Members are those of tl_block_shape. */
typedef struct tl_solid_shape {
    uint32_t size;
    const tl_vec3 *vertices;
    size_t vertex_count;
    const uint32_t *start, *loops;
    size_t face_count;
    const tl_tag *tags; /* [face_count] or NULL */
    double density;     /* kg/m3, > 0 */
    const char *group;
    uint32_t fixed, hidden;
    /* m, >= 0: what stands off a plane, or bends inward, by less is flat. 0 is what rounding asks for: 1e-9 of the
     * solid's size. Seams of parts may bend by as much, and what touches them then presses: give what corners really
     * are off their faces. */
    double flat;
    uint32_t whole; /* 1: a solid that is not convex is refused with the edge at which it bends inward */
} tl_solid_shape;

/* Since 1.10: tetrahedra of a file, of one group, that hang together over their sides and fill a convex solid. */
typedef struct tl_mesh_part {
    const char *group; /* the name of their group in the file; "": it has none */
    const tl_vec3 *corners;
    size_t corner_count;
    double volume; /* m3 */
} tl_mesh_part;

struct tl_host {
    uint32_t size;
    void *impl;
    uint64_t seed; /* of the model */

    /* Creates a block: the convex hull of `count` vertices. Refused with TL_E_GEOMETRY when they span no volume, or
     * when one lies inside the hull of the others. density in kg/m3 > 0; group may be NULL. */
    tl_status (*create_hull)(const tl_host *, const tl_vec3 *vertices, size_t count, double density, const char *group);
    /* Creates a block: an axis-aligned box, min < max in every component. */
    tl_status (*create_box)(const tl_host *, tl_vec3 min, tl_vec3 max, double density, const char *group);
    /* Finds or creates the joint set `name` and gives its number. */
    tl_status (*joint)(const tl_host *, const char *name, uint32_t *joint);
    /* The number of the next plane of a joint set, from 1. */
    uint32_t (*next_plane)(const tl_host *, uint32_t joint);
    /* Cuts every visible block that the plane through `point` with unit `normal` crosses, each with
     * probability `persistence` drawn from (seed, set, plane, block's lineage); body-wise for
     * joined blocks. The new faces carry `tag`. */
    tl_status (*cut)(const tl_host *, tl_vec3 normal, tl_vec3 point, tl_tag tag, double persistence);
    /* The visible blocks of the staging set. */
    size_t (*block_count)(const tl_host *);
    void (*block_info)(const tl_host *, size_t index, tl_block_info *info);
    /* Uniform in [0, 1), a pure function of (seed, joint set, plane, draw). */
    double (*random)(const tl_host *, uint32_t joint, int64_t plane, uint32_t draw);
    /* Shows progress in [0, 1]; not TL_OK when the user asked to stop. */
    tl_status (*progress)(const tl_host *, double fraction);
    /* A remark for the user. */
    void (*log)(const tl_host *, const char *format, ...) TL_PRINTF(2, 3);
    /* Puts a sentence into the error and returns `status`. */
    tl_status (*fail)(const tl_host *, tl_status status, const char *format, ...) TL_PRINTF(3, 4);
    /* since minor 1: as `cut`, by a disc of `radius` about `point` (INFINITY: the whole plane). A block is in the
     * disc's path when the disc reaches into the polygon in which the plane cuts the block. It is then cut through.
     * `met`, which may be NULL, gets the number of blocks in the path, whether the draw had them cut or not. */
    tl_status (*cut_disc)(const tl_host *, tl_vec3 normal, tl_vec3 point, double radius, tl_tag tag, double persistence,
                          size_t *met);

    /* Single blocks. `index` counts the visible blocks as in block_info. Cuts keep indices: the side
     * away from the normal stays at its index, the other becomes the last. `hide` and `remove` make
     * one fewer of those after the index. */

    /* Whether the block's inside meets the common inside of half spaces. */
    tl_status (*meets)(const tl_host *, size_t index, const tl_half_space *spaces, size_t count, bool *meets);
    /* Cuts one block without a joint: its new faces carry no tag and the two sides stay one body. *above is the index
     * of the part on the normal's side; SIZE_MAX: the plane does not divide the block, or would leave a sliver. */
    tl_status (*cut_block)(const tl_host *, size_t index, tl_vec3 normal, tl_vec3 point, size_t *above);
    tl_status (*set_group)(const tl_host *, size_t index, const char *group);
    /* Takes blocks out of their bodies: those among them that hang together are one body, and so are
     * those left behind. Faces of joints cut by this generator part what shares them. */
    tl_status (*part)(const tl_host *, const size_t *indices, size_t count);
    /* Makes one body of blocks and all that is joined to them. */
    tl_status (*join)(const tl_host *, const size_t *indices, size_t count);
    tl_status (*remove)(const tl_host *, size_t index);
    /* Hides a block from this generator's further cuts, until it ends or shows all it has hidden. */
    tl_status (*hide)(const tl_host *, size_t index);
    tl_status (*show)(const tl_host *);
    /* Creates a block from its faces. Refused with TL_E_GEOMETRY when they do not close a convex shape. */
    tl_status (*create_block)(const tl_host *, const tl_block_shape *shape);
    /* since 1.10: reads the tetrahedra of a file, VTK legacy or gmsh 2.2. The parts are in the order of their first
     * tetrahedra, and valid until the generator ends or reads another. Refused with TL_E_GEOMETRY are a damaged file
     * and a part that is not convex. */
    tl_status (*read_mesh)(const tl_host *, const char *file, const tl_mesh_part **parts, size_t *count);
    /* since 1.11: creates convex blocks that fill a solid, joined to one body; *parts, which may be NULL, gets their
     * number. They are the last blocks. A convex solid becomes one block, as create_block makes it. A face of several
     * tags gets the one with most of its area. Refused with TL_E_GEOMETRY and the place is a surface that is open
     * or crosses itself. So is one that has more than two faces at an edge, is turned inside out or holds no volume. */
    tl_status (*create_solid)(const tl_host *, const tl_solid_shape *shape, size_t *parts);
    /* since 1.11: notes for the user what was done with an object of a file, or why it was refused. The number counts
     * where `text` is NULL. `object` is its name, NULL: the whole. Notes of one object follow each other. They are in
     * the report of the summary, unless the generator fails. */
    tl_status (*note)(const tl_host *, const char *object, const char *key, double number, const char *text);
    /* since 1.11: the sentence of the service that failed last, for a generator that goes on without the block. */
    const char *(*reason)(const tl_host *);
    /* since 1.11: as `cut_disc`, by a convex polygon of `count` corners, in order around it. A block is in its path
     * when it reaches into the polygon in which its plane cuts the block. Refused with TL_E_GEOMETRY are corners that
     * are not in one plane or not convex. */
    tl_status (*cut_polygon)(const tl_host *, const tl_vec3 *corners, size_t count, tl_tag tag, double persistence,
                             size_t *met);
};

typedef struct tl_generator_ops {
    uint32_t size;
    tl_status (*generate)(const tl_host *host, const void *params); /* [main] */
} tl_generator_ops;

/* ---------------------------------------------------------------- screens ---------------- */

/* Since 1.7: a screen shows a model while it runs, and hands on what those who look ask for. */

/* Room for a command, bytes with the 0 at its end. */
#define TL_SCREEN_COMMAND 512

/* The page in which the frames are seen. What it points to is valid during `open`; `check` is valid for ever. */
typedef struct tl_screen_page {
    uint32_t size;
    /* HTML in UTF-8. It asks for the frames and posts commands as docs/scene_format.md tells */
    const char *text;
    size_t length;
    uint32_t commands; /* 0: the screen only shows, and refuses commands */
    /* [worker] 1 when the text, which need not end in a 0, is a command; else 0, with a sentence in `why`, of `room`
     * bytes. A pure function. */
    int (*check)(const char *text, size_t length, char *why, size_t room);
} tl_screen_page;

/* What there is to see after a step. Valid during `put`. */
typedef struct tl_screen_frame {
    uint32_t size;
    uint32_t begin;   /* 1: `news` tells the whole model; all `news` before it is needed no more */
    const void *news; /* chunks that each watcher gets once, in the order of `put` */
    size_t news_length;
    const void *now; /* chunks of this moment, to their DONE; a newer frame's take their place */
    size_t now_length;
} tl_screen_frame;

/* Operations of a screen; all must be there. */
typedef struct tl_screen_ops {
    uint32_t size;
    /* [main] Begins to show. The first `put` has `begin`. */
    tl_status (*open)(const tl_screen_page *page, const void *params, void **self, tl_report *report);
    /* [main] Where to look: an address for a browser, its token in it. Valid until `close`. */
    const char *(*address)(const void *self);
    /* [main] How many look now. Asked after every step, so it is a read of a number. */
    uint32_t (*watchers)(const void *self);
    /* [main] Shows a frame. It takes a copy and waits for nobody who looks. On failure what was put before stays. */
    tl_status (*put)(void *self, const tl_screen_frame *frame, tl_report *report);
    /* [main] Takes the next command into `text`, of `room` bytes (TL_SCREEN_COMMAND are enough for any), with a 0 at
     * its end. Without one it waits `seconds` at the most; with 0 s, as it is asked after every step, it is a read of a
     * number. 1: there was one. 0: there was none, or somebody has begun to look, which ends the waiting. */
    int (*take)(void *self, char *text, size_t room, double seconds);
    /* [main] Ends. Those who look get what they have not got yet, if they take it within a second. */
    void (*close)(void *self);
} tl_screen_ops;

/* ---------------------------------------------------------------- solids ----------------- */

/* Since 1.10: a solid is the material of the zones into which blocks are divided. */

/* Flags of a zone, set by the solid. 0 is elastic, and always has been. */
enum {
    TL_ZONE_SHEAR = 1,        /* yields in shear in this step */
    TL_ZONE_TENSION = 2,      /* yields in tension in this step */
    TL_ZONE_SHEAR_PAST = 4,   /* has yielded in shear in a step before */
    TL_ZONE_TENSION_PAST = 8, /* has yielded in tension in a step before */
    TL_ZONE_JOINT = 16,       /* yields on its weak plane, in shear or tension, in this step */
    TL_ZONE_JOINT_PAST = 32   /* has yielded on its weak plane in a step before */
};

/* Zones of one solid, with one set of properties, as columns. Every column has `count` entries, a multiple of TL_LANES,
 * aligned to TL_ALIGN bytes, padded with inert lanes (volume 0), so loops need no tail.
 *
 * Signs: stress and strain are positive in tension. Their components are in the order xx yy zz xy yz zx; xy, yz and zx
 * of a strain are those of the tensor, half the angle. The stress is that of Cauchy. It comes in turned with the zone
 * into the present, as states are that are an axis or a tensor. */
typedef struct tl_solid_batch {
    uint32_t size;
    uint32_t count;
    double dt;               /* s, in which it moves; 0 in the first step of a run, and while model:relax runs */
    const double *volume;    /* m3 */
    const double *extent;    /* m, cube root of the volume of the zones that share their volumetric strain */
    const double *strain[6]; /* increment in this step */
    double *stress[6];       /* in/out: Pa */
    double *const *state;    /* in/out: state columns in the order declared (3 for an axis, 6 for a tensor) */
    uint32_t *flags;         /* in/out: TL_ZONE_* */
    double *stored;          /* out, or NULL: elastic energy, J/m3 */
    double *dissipated;      /* out, or NULL: energy turned to heat in this step, J/m3, >= 0 */
} tl_solid_batch;

/* Operations of a solid. `create` and `destroy` may both be NULL: then `self` is the host's own copy of the params
 * struct. */
typedef struct tl_solid_ops {
    uint32_t size;
    /* [main] */
    tl_status (*create)(const void *params, void **self, tl_report *report);
    /* [worker] a pure function; zones do not depend on each other */
    tl_status (*update)(const void *self, const tl_solid_batch *batch, tl_report *report);
    /* [worker] upper bounds, Pa: of the constrained modulus K + 4 G / 3, and of the shear modulus G */
    void (*moduli)(const void *self, double *constrained, double *shear);
    /* [main] */
    void (*destroy)(void *self);
    /* [worker] the elastic energy, J/m3, that `update` tells as `stored`, of `count` zones. May be NULL: the host then
     * asks `update` with strains of 0. */
    void (*energy)(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                   double *stored);
    /* not 0: `update` always returns TL_OK, as a law's */
    uint32_t never_fails;
} tl_solid_ops;

/* ---------------------------------------------------------------- elements --------------- */

/* Since 1.13: an element acts on points of blocks, its nodes. A bolt is one, and so is water between two walls. */

/* Limit: nodes of one element. A worker takes so many at a time. */
#define TL_ELEMENT_NODES 512
/* Limit: since 1.16, nodes of one element whose kind has `memory`: it comes alone if there are more than
 * TL_ELEMENT_NODES. */
#define TL_ELEMENT_MANY 3072

/* Flags of an element. The kind sets and clears them, but for the last one, which the host sets. */
enum {
    TL_ELEMENT_YIELDED = 1,
    TL_ELEMENT_BROKEN = 2,
    TL_ELEMENT_DETACHED = 4 /* the block of a node has been deleted: the node has weight 0 and acts on nothing */
};

/* Whole elements of one call, in the order of their ids, as columns: element e has the nodes start[e] .. start[e + 1]
 * of the columns of nodes. Columns need not be aligned. Places count from `origin`, so far from zero they keep their
 * digits. A node without a block is on the ground: it does not move.
 *
 * Energies are those at the present places. `given` is work that comes from outside, as of water. The bodies do the
 * work stored - stored before + lost - given on the element; the balance of the model shows what is missing. It books
 * the work of a step with the mean of the forces before and after it: lost and given should do so, too. */
typedef struct tl_element_batch {
    uint32_t size, count;
    double dt;   /* s, in which nodes have moved last; 0 in the first step of a run, and while model:relax runs */
    double time; /* s */
    tl_vec3 origin;
    const uint32_t *start;        /* [count + 1] */
    const double *rest[3];        /* m, place when installed, from `origin` */
    const double *u[3];           /* m, displacement since */
    const double *du[3];          /* m, displacement in the last step */
    const double *v[3];           /* m/s, of that motion; 0 while model:relax runs */
    const double *normal[3];      /* present outward normal of the node's face; 0: it was placed without one */
    const double *weight;         /* m or m2 that the node stands for */
    double *const *state;         /* in/out: states of nodes (TL_STATE_SCALAR), in the order declared */
    double *const *element_state; /* in/out: states of elements (TL_STATE_WHOLE), likewise */
    uint32_t *flags;              /* in/out, of elements: TL_ELEMENT_* */
    double *force[3];             /* in: of the last step; out: N, on the block */
    double *stored;               /* in: of the last step; out: J that an element holds */
    double *lost;                 /* out, preset to 0: J turned to heat in this step */
    double *given;                /* out, preset to 0: J brought in from outside in this step */
    void *const *memory;          /* since 1.16, of elements: what `memory` asked for; NULL: the kind has none */
} tl_element_batch;

/* A node to be. */
typedef struct tl_element_node {
    tl_id block;    /* 0: the ground */
    tl_vec3 place;  /* m, in the user's coordinates; on or in the block */
    tl_vec3 normal; /* outward, unit; 0: none */
    double weight;  /* m or m2 that it stands for, >= 0 */
} tl_element_node;

/* An element to be. */
typedef struct tl_new_element {
    uint32_t size;
    const tl_element_node *nodes; /* 1 to TL_ELEMENT_NODES, or TL_ELEMENT_MANY */
    size_t count;
    const double *node_state; /* [count][states of a node]; NULL: their initial values */
    const double *state;      /* [states of an element]; NULL: their initial values */
    /* With `lays_again`, a name among the elements of the kind; 0: none. The element takes the place of that of an
     * earlier call with the same key. Where `place` is called again it keeps its states: nodes have those of the
     * nearest old one on the same block. */
    uint64_t key;
} tl_new_element;

/* A node on a line through blocks. Those of one body follow each other without a gap. */
typedef struct tl_line_node {
    tl_id block;
    uint32_t passes; /* 1: the line enters or leaves a body here */
    tl_vec3 place;   /* in the user's coordinates */
    double at;       /* m from the beginning of the line */
    double length;   /* m of the line that it stands for: half of the way to its neighbours in the body */
} tl_line_node;

/* An outer face, or the part of it that lies on no other block. */
typedef struct tl_element_face {
    tl_id block;
    uint32_t face;
    tl_vec3 normal;         /* outward, unit */
    const tl_vec3 *corners; /* counter-clockwise from outside, in the user's coordinates */
    size_t corner_count;
} tl_element_face;

/* The polygon in which a face of one block faces one of another. */
typedef struct tl_element_wall {
    tl_id block[2]; /* the lower id first */
    uint32_t face[2];
    const char *joint;         /* name of the joint that made the face; "": none */
    tl_vec3 normal[2];         /* of the faces, outward, unit */
    const tl_vec3 *corners[2]; /* on both walls, in the user's coordinates: opposite corners have the same number */
    size_t corner_count;
    double area;    /* m2, halfway between */
    double opening; /* m, mean distance of the walls; below 0 they overlap */
} tl_element_wall;

/* Which walls. */
typedef struct tl_wall_filter {
    uint32_t size;
    const char *joints; /* names or patterns ("A", "A:3", "*"), separated by commas */
    double gap;         /* m: walls farther apart on the mean are left out */
    double angle;       /* degrees: so far their normals may be from opposite, 0 to 45 */
} tl_wall_filter;

/* What `place` may ask of the host. Lists last until `place` returns or asks the same service again. A function that
 * returns a status has written its sentence when it is not TL_OK: return that status at once. */
typedef struct tl_element_host tl_element_host;
struct tl_element_host {
    uint32_t size;
    void *impl;
    uint64_t seed;  /* of the model */
    uint32_t again; /* 1: the call is repeated: none of what it finds may be there any more */

    /* Makes an element. Elements of one call get ascending ids. */
    tl_status (*add)(const tl_element_host *, const tl_new_element *element);
    /* Nodes on the line between two points: at both ends of each way through a body, and between at distances of at
     * most `spacing`. Where the line passes from one body to another there are two, one on each side. None lie outside
     * of all blocks. */
    tl_status (*line)(const tl_element_host *, tl_vec3 from, tl_vec3 to, double spacing, const tl_line_node **nodes,
                      size_t *count);
    /* Outer faces of blocks whose group is `group`, NULL: of all, that look along `facing` within `angle` degrees; a
     * vector of zeros: of all that there are. */
    tl_status (*faces)(const tl_element_host *, const char *group, tl_vec3 facing, double angle,
                       const tl_element_face **faces, size_t *count);
    /* Pairs of faces that face each other, of blocks of different bodies, by ascending blocks and faces. */
    tl_status (*walls)(const tl_element_host *, const tl_wall_filter *filter, const tl_element_wall **walls,
                       size_t *count);
    /* The block that holds a point, the deepest of several, or 0. */
    tl_id (*block_at)(const tl_element_host *, tl_vec3 place);
    /* A remark for the user. */
    void (*log)(const tl_element_host *, const char *format, ...) TL_PRINTF(2, 3);
    /* Puts a sentence into the error and returns `status`. */
    tl_status (*fail)(const tl_element_host *, tl_status status, const char *format, ...) TL_PRINTF(3, 4);
};

/* Operations of an element. `create` and `destroy` may both be NULL: then `self` is the host's own copy of the params
 * struct. */
typedef struct tl_element_ops {
    uint32_t size;
    /* [main] */
    tl_status (*create)(const void *params, void **self, tl_report *report);
    /* [main] Makes the elements of one call; all or nothing. */
    tl_status (*place)(const tl_element_host *host, const void *params);
    /* [worker] a pure function; elements do not depend on each other */
    tl_status (*update)(const void *self, const tl_element_batch *batch, tl_report *report);
    /* [worker] bounds of the stiffness k, N/m, and of the damping c, N s/m, with which each node holds its block, both
     * preset to 0. Of the batch are known rest, weight, states and flags; `u` and the motion are 0. Asked once, and
     * again when parameters or blocks have changed. */
    void (*stiffness)(const void *self, const tl_element_batch *batch, double *k, double *c);
    /* [main] */
    void (*destroy)(void *self);
    /* not 0: `update` always returns TL_OK, as a law's */
    uint32_t never_fails;
    /* not 0: `place` is called again when blocks have come, gone or been cut. So it is when the first and the last node
     * of an element have moved apart by 1e-3 of the size of their blocks. Its elements are then those that it makes. */
    uint32_t lays_again;
    /* not 0: forces depend on nothing but places, and turn with the blocks. The host may then keep the forces, and turn
     * them itself, until a block has gone farther than 1e-4 of its size. Every 64 steps it is 1e-6. It books their work
     * meanwhile. `stored` and `lost` must be 0. With nodes in zones all are asked in every step. */
    uint32_t steady;
    /* [main] Since 1.15, may be NULL: what the elements of one call do together, such as water that flows from one to
     * the other. It changes states, by which `update` then finds the forces. Of the batch, which holds all elements of
     * the call, du, v, force, stored, lost and given are NULL. Called once they are placed, when they have been placed
     * again, and before `update` in steps of which the number is divisible by `every`. Elements that have got other
     * parameters by tl_elements_set are calls of their own. Elements that are placed again may come in another order:
     * that must change nothing but rounding. Asked again at the same time and places it must change nothing. */
    tl_status (*together)(const void *self, const tl_element_batch *batch, tl_report *report);
    /* [main] Since 1.15, may be NULL: 1. Steps between two calls of `together`; 0: none in steps. */
    uint32_t (*every)(const void *self);
    /* [main] Since 1.16, may be NULL. Bytes of memory for each element, preset to 0; the batch is that of `stiffness`.
     * `update` keeps there what takes long to find: what follows from `rest`, weight, parameters and states, as a
     * factorised matrix does. The host sets it to 0 when elements, parameters or blocks change, and does not save it.
     * So results must not depend on whether something is kept. Memory is aligned to 64 bytes. */
    void (*memory)(const void *self, const tl_element_batch *batch, size_t *bytes);
    /* Since 1.16: not 0: nodes are corners of triangles, three for each, counter-clockwise from outside. Pictures show
     * the triangles. */
    uint32_t triangles;
} tl_element_ops;

/* ---------------------------------------------------------------- descriptors ------------ */

typedef enum tl_kind_type {
    TL_KIND_LAW,
    TL_KIND_DAMPING,
    TL_KIND_GENERATOR,
    TL_KIND_SCREEN, /* since 1.7 */
    TL_KIND_SOLID,  /* since 1.10 */
    TL_KIND_ELEMENT /* since 1.13 */
} tl_kind_type;

/* One law, damping, generator, screen, solid or element. `ops` points to tl_law_ops, tl_damping_ops, tl_generator_ops,
 * tl_screen_ops, tl_solid_ops or tl_element_ops. */
typedef struct tl_kind {
    uint32_t size;
    uint32_t type;    /* tl_kind_type */
    const char *name; /* [a-z][a-z0-9_]*, unique among kinds of its type */
    const char *doc;
    size_t params_size;
    const tl_param *params;
    uint32_t param_count, param_stride;
    const tl_state *states;
    uint32_t state_count, state_stride;
    const void *ops;
} tl_kind;

typedef struct tl_plugin {
    uint32_t size;
    uint32_t abi_major, abi_minor; /* TL_ABI_MAJOR, TL_ABI_MINOR of the headers it was built with */
    const char *id;                /* unique, "talus.coulomb" */
    const char *version;
    const char *doc;
    const char *licence;
    const tl_kind *kinds;
    uint32_t kind_count, kind_stride;
} tl_plugin;

typedef const tl_plugin *(*tl_plugin_entry_fn)(uint32_t host_major, uint32_t host_minor);

/* One kind with its operations, for a `static const tl_kind` or an array of them:
 *
 *     TL_KIND(TL_KIND_LAW, ops, .name = "my_law", .doc = "Falling friction.", TL_KIND_PARAMS(params, param_table)) */
#define TL_KIND(type_, ops_, ...)                                                                                      \
    {                                                                                                                  \
        .size = sizeof(tl_kind), .type = (type_), .ops = &(ops_), __VA_ARGS__                                          \
    }
/* Members of a tl_kind: its parameters, written to a struct `owner`, and its states. `table` is an array. */
#define TL_KIND_PARAMS(owner, table)                                                                                   \
    .params_size = sizeof(owner), .params = (table), .param_count = sizeof(table) / sizeof(tl_param),                  \
    .param_stride = sizeof(tl_param)
#define TL_KIND_STATES(table)                                                                                          \
    .states = (table), .state_count = sizeof(table) / sizeof(tl_state), .state_stride = sizeof(tl_state)

/* The descriptor and the entry of a plugin with the tl_kind, or the array of them, `kinds_`:
 *
 *     TL_PLUGIN(kind, .id = "example.drag", .version = "1.0", .doc = "Quadratic drag.", .licence = "MIT");
 *
 * It refuses hosts of another major version. TL_PLUGIN_SINCE also refuses those of a minor version below `least`, for a
 * plugin that cannot do without what came with it. Once in a plugin, in C, at file scope. */
#define TL_PLUGIN(kinds_, ...) TL_PLUGIN_SINCE(0, kinds_, __VA_ARGS__)
#define TL_PLUGIN_SINCE(least, kinds_, ...)                                                                            \
    TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)                        \
    {                                                                                                                  \
        static const tl_plugin plugin = {.size = sizeof plugin,                                                        \
                                         .abi_major = TL_ABI_MAJOR,                                                    \
                                         .abi_minor = TL_ABI_MINOR,                                                    \
                                         .kinds = (const tl_kind *)&(kinds_),                                          \
                                         .kind_count = sizeof(kinds_) / sizeof(tl_kind),                               \
                                         .kind_stride = sizeof(tl_kind),                                               \
                                         __VA_ARGS__};                                                                 \
        static const uint32_t least_minor = (least);                                                                   \
        return host_major == TL_ABI_MAJOR && host_minor >= least_minor ? &plugin : NULL;                               \
    }                                                                                                                  \
    _Static_assert(sizeof(kinds_) % sizeof(tl_kind) == 0, "give the kinds, not their address")

#ifdef __cplusplus
}
#endif
#endif
