/* cycle_data.h - the phases of a step, and what they keep between them. cycle.c puts them in order. */
#ifndef TL_CYCLE_CYCLE_DATA_H
#define TL_CYCLE_CYCLE_DATA_H

#include "base/exact.h"
#include "base/inline.h"
#include "base/inside.h"
#include "base/lanes.h"
#include "base/parallel.h"
#include "cycle/settling.h"
#include "force/laws.h"
#include "model/contributor.h"
#include "model/loads.h"
#include "model/model.h"

/* Rows a worker takes at a time. Of bodies that are only read, and of contacts, there is little to do with each. */
#define TL_BODY_CHUNK 32
#define TL_READ_CHUNK 256
#define TL_CONTACT_CHUNK 1024

/* Bytes of the name of a term of energy, with its end. */
#define TL_TERM_NAME 16

/* Sums over the free bodies. */
typedef struct tl_sums {
    double unbalanced;    /* sum of |unbalanced force| */
    double turning;       /* sum of |unbalanced moment| over the body's radius */
    double contact_force; /* sum over bodies of the sum of |contact forces| */
    double largest;       /* largest |unbalanced force| */
    double local;         /* largest |unbalanced force| over what the body bears: rest.c */
    double worst_ratio;   /* the same of |unbalanced force| and |unbalanced moment| over its radius */
    uint32_t worst;       /* the body that has it; TL_NO_ROW: none */
    size_t bodies;        /* that are free */
    double kinetic;       /* sum of (m v.v + w.I w) / 2; made for a damping that asks for totals */
    double damped;        /* the same of components that are not held: a damping acts on no others */
    double power;         /* sum of F.v + M.w, F and M unbalanced; made for the same */
    double max_speed2;    /* largest v.v */
} tl_sums;

/* What a thread has gathered of them: exact sums, and the largest of each. */
enum {
    TL_SUM_UNBALANCED,
    TL_SUM_TURNING,
    TL_SUM_CONTACT_FORCE,
    TL_SUM_KINETIC,
    TL_SUM_DAMPED,
    TL_SUM_POWER,
    TL_SUM_COUNT
};
typedef struct tl_gathered {
    tl_exact sum[TL_SUM_COUNT];
    double largest, local, worst_ratio, max_speed2;
    uint32_t worst;
    size_t bodies;
} tl_gathered;

/* Cached for the rules of the time step: the lightest mass of the bodies that count and, with the column face_rate of
 * the bodies, what each asks on its largest face. Valid for one `version` of the bodies. */
struct tl_step_bounds {
    uint64_t version;     /* of the bodies; 0: none */
    uint64_t constraints; /* of the model */
    int32_t rotation;
    bool points; /* whether rates count contact points */
    double least_mass;
    uint32_t lightest; /* row, or TL_NO_ROW */
};

/* Cached: the state of the model for which the rates of the bodies hold, 1/s2, and the extreme one. */
struct tl_stiffness_rates {
    uint64_t version; /* of the bodies and laws; 0: no rates are known */
    int64_t recheck;  /* of mass scaling: steps over RECHECK_STEPS */
    int32_t rotation;
    double extreme; /* the highest rate, with mass scaling the lowest */
    uint32_t body;  /* row, or TL_NO_ROW */
};

/* What partial mass scaling adds: added_mass.c. */
struct tl_added {
    double share; /* of the mass of the bodies that can move */
    size_t bodies;
    double factor;        /* the highest, 1 without any */
    uint32_t worst;       /* row of the body that has it, or TL_NO_ROW */
    uint32_t worst_point; /* of a deformable one the number of its gridpoint, or TL_NO_ROW */
    size_t points;        /* gridpoints that have been given some */
    double point_limit;   /* the highest stable rate of a gridpoint, 1/s2; 0: none is asked for */
};

/* Bounds on the speeds of the bodies after the last kick: of (|v| + |w| r)^2 / 4, m2/s2, and of |w|^2 / 2, 1/s2. */
typedef struct tl_speed_bounds {
    double speed2, turn2;
} tl_speed_bounds;

/* What the ledger books of each body. What is always booked comes first, and what only the first step books last. */
typedef enum tl_work_kind { TL_WORK_GRAVITY, TL_WORK_EXTERNAL, TL_WORK_DAMPING, TL_WORK_COUNT } tl_work_kind;
enum {
    TL_BOOK_KINETIC,
    TL_BOOK_MOTION0, /* kinetic energy before the kick, and after it */
    TL_BOOK_MOTION2,
    TL_BOOK_WORK, /* of each kind: until now, and in the half step that follows */
    TL_BOOK_EXTERNAL = TL_BOOK_WORK + 2 * TL_WORK_EXTERNAL,
    TL_BOOK_DAMPING = TL_BOOK_WORK + 2 * TL_WORK_DAMPING,
    TL_BOOK_FIRST = TL_BOOK_WORK + 2 * TL_WORK_COUNT, /* by which the scheme's sum is less in the first step */
    TL_BOOK_COUNT
};
/* Until now and after it, of a kind of work. */
#define TL_BOOK_UNTIL(kind) (TL_BOOK_WORK + 2 * (kind))
#define TL_BOOK_AFTER(kind) (TL_BOOK_UNTIL(kind) + 1)

/* What a thread has booked: exact sums. */
typedef struct tl_booked {
    tl_exact sum[TL_BOOK_COUNT];
} tl_booked;

/* What a contributor stores now, and what it has turned to heat until now, J. */
typedef struct tl_energy_term {
    char name[TL_TERM_NAME];
    double stored, heat;
} tl_energy_term;

/* The energy ledger: energy.c. */
typedef struct tl_ledger {
    /* in the order in which contributors came; without a name: not used */
    tl_energy_term term[TL_MOST_CONTRIBUTORS];
    double work[TL_WORK_COUNT]; /* until the end of the half step that follows */
    double motion;              /* kinetic energy after the last kick */
    double start_kinetic, start_stored;
    double largest;             /* change of a term so far */
    double by_hand;             /* energy given between steps */
    double given;               /* by contributors, from outside */
    double error;               /* of the sum, at the last step */
    uint64_t structure, laws;   /* of the model, at the last step */
    double overlaps;            /* stored in the first step by blocks that were made overlapping */
    tl_id overlap_a, overlap_b; /* those that stored the most */
    bool started;
    tl_energy energy;
} tl_ledger;

/* Of the contacts, on a body that is held. */
typedef struct tl_reaction {
    tl_vec3 force, moment;
} tl_reaction;

/* What a step does to a body: displacement, m, and turn about the centroid, rad, in the model's axes. */
typedef struct tl_step_motion {
    tl_vec3 shift, turn;
} tl_step_motion;

/* Bounds of a block over a step. */
typedef struct tl_swept {
    tl_bounds box;
    uint32_t row;
    bool moves; /* far enough to be one of a pair that passes */
    bool thin;  /* may be the thinner one of such a pair */
} tl_swept;

struct tl_cycle {
    tl_table table;
    const tl_contributor *contributor[TL_MOST_CONTRIBUTORS + 1]; /* NULL ends them */
    /* per body */
    double *contact_force; /* sum of |contact forces| */
    double *rate;          /* what it asks of the time step, 1/s2 (timestep.c); 0: it is held */
    /* with mass scaling what its rotation asks, and `rate` what its translation does */
    double *turn_rate;
    double *inertia;                                      /* over its own, where `adds` */
    double *damping_force[3], *damping_moment[3], *alpha; /* what the damping plugin gave */
    tl_wrench *contact_damping; /* of each contact, where these are damped: on B, about A's centroid */
    size_t contact_damping_capacity;
    /* index of the reaction on a body that is held in some way, or TL_NO_ROW */
    uint32_t *reaction_of;
    tl_reaction *reaction;
    size_t reaction_capacity;
    uint64_t reactions_for; /* version of the bodies; 0: none */
    /* of each thread */
    tl_gathered *gathered;
    tl_booked *booked;
    tl_exact *heat, *stored; /* of contacts, in this step */
    size_t gathered_capacity, booked_capacity, heat_capacity, stored_capacity;
    tl_sums sums;
    tl_ledger ledger;
    double kinetic_before;                     /* of the last step, for its rate */
    double dt;                                 /* the step in use */
    double share_before;                       /* of the kick's span, in which gravity and loads of the last step act */
    tl_vec3 gravity;                           /* that acts in this step */
    struct tl_step_bounds step_bounds;         /* timestep.c */
    bool all_held;                             /* no body can move */
    struct tl_stiffness_rates stiffness_rates; /* timestep.c */
    uint64_t sliver_structure;                 /* 1 + that of the model when slivers were looked for: sliver.c */
    tl_id sliver;                              /* the one that was told of last */
    size_t contacts;                           /* the most there have been, for the remark on the step */
    double mass_scale;                         /* 1 / (2 rate) of all free bodies, by mass scaling; 0 without it */
    struct tl_added added;                     /* in the last step: added_mass.c */
    tl_id added_block;                         /* that of added.worst then, or TL_NO_ID */
    double told_share;                         /* of mass added, for the remark on it */
    bool adds;                                 /* some body has been given inertia */
    struct tl_undo *undo;                      /* undo.c */
    struct tl_split_work *split;               /* of this step: split.c */
    double split_stored;                       /* energy that new faces have been given in this step, J */
    bool long_step;                            /* the given one is far above what is stable */
    bool may_pass;                             /* a block may pass another in this step: limits.c */
    tl_speed_bounds speeds;                    /* of all bodies in the last step: limits.c */
    tl_speed_bounds given;                     /* of those whose motion is given, in this one */
    double thinnest;                           /* least thickness that a block can have, m: limits.c */
    uint64_t thinnest_version;                 /* 1 + structure of the model then; 0: not known */
    tl_step_motion *motion;                    /* of each body in a step of fast blocks: limits.c */
    size_t motion_capacity;
    tl_swept *swept; /* of each block, likewise */
    size_t swept_capacity;
    bool slides_on; /* a relaxation lets rigid bodies go on, too; not saved */
    tl_settling settling;
    struct tl_secant *secant; /* of each contact, while there are leaps: secants.c */
    size_t secant_count, secant_capacity;
    struct tl_conjugate *conjugate; /* of each body, while there are leaps of many: conjugate.c */
    size_t conjugate_count, conjugate_capacity;
    struct tl_leap_link *link; /* of each contact and each body, in a leap */
    struct tl_leap_body *leap;
    size_t link_count, link_capacity, leap_capacity;
    tl_id *fails; /* blocks that failed in the last run that saw a failure, */
    size_t fails_count, fails_capacity;
    double fails_volume; /* m3, */
    tl_vec3 fails_way;   /* and where to; */
    bool fails_strained; /* or a deformable one is strained on and on, */
    tl_vec3 fails_at;    /* at this place, m */
    tl_id failing;       /* in the last run that was watched: solve.c; or TL_NO_ID */
    double rest_ratio;   /* that the last solve asked for; 0: none has */
    bool fast;           /* a body came near the limit of motion in the last step: limits.c */
    tl_failure failure;  /* of a parallel phase */
};

/* What partial mass scaling makes of a body's inertia: energies count it. */
static inline double tl_energy_scale(const struct tl_cycle *c, uint32_t body)
{
    return c->adds ? c->inertia[body] : 1;
}

/* Whether the last step was a leap of a relaxation. */
static inline bool tl_has_leapt(const tl_model *m)
{
    return m->relaxing && m->cycle->settling.leapt;
}

/* What mass scaling of either kind makes of a body's mass ... */
static inline double tl_inertia_scale(const struct tl_cycle *c, uint32_t body)
{
    if (c->mass_scale > 0)
        return c->rate[body] > 0 ? 2 * c->mass_scale * c->rate[body] : 1;
    return tl_energy_scale(c, body);
}

/* Whether it may make anything of any. */
static inline bool tl_inertia_scaled(const struct tl_cycle *c)
{
    return c->mass_scale > 0 || c->adds;
}

/* Whether inertia is to be added for a step that was asked for. */
static inline bool tl_adds_mass(const tl_model *m)
{
    return !isnan(m->added_dt) && !m->relaxing;
}

/* Whether all free bodies get the inertia that suits one step. */
static inline bool tl_scales_all(const tl_model *m)
{
    return m->mass_scaling || m->relaxing;
}

/* The step that the user has given, s, or NaN. */
static inline double tl_given_step(const tl_model *m)
{
    return m->relaxing ? NAN : m->timestep.dt;
}

/* Whether bodies get damping forces. */
static inline bool tl_is_damped(const tl_model *m)
{
    return m->damping || m->relaxing;
}

/* Whether there is mass scaling of either kind. */
static inline bool tl_mass_scaled(const tl_model *m)
{
    return tl_scales_all(m) || tl_adds_mass(m);
}

/* ... and of its moments of inertia, which it does not make less. */
static inline double tl_turn_scale(const struct tl_cycle *c, uint32_t body)
{
    if (!(c->mass_scale > 0))
        return tl_energy_scale(c, body);
    double scale = c->rate[body] > 0 ? 2 * c->mass_scale * c->turn_rate[body] : 1;
    return scale > 1 ? scale : 1;
}

/* The moments of inertia by which a body turns: by the paper's rule there is only one. */
static inline tl_vec3 tl_moments_of(const tl_model *m, uint32_t body)
{
    const double round = m->bodies.round[body];
    return m->config.rotation == TL_ROTATION_PAPER ? tl_v3(round, round, round) : m->bodies.moments[body];
}

/* The components of a vector in which a body is not held. */
static inline tl_vec3 tl_free_part(tl_vec3 v, unsigned fixed)
{
    return tl_v3(fixed & TL_FIX_X ? 0 : v.x, fixed & TL_FIX_Y ? 0 : v.y, fixed & TL_FIX_Z ? 0 : v.z);
}

/* Whether rates count contact points, or only faces. */
static inline bool tl_rates_points(const tl_model *m)
{
    return tl_mass_scaled(m) || m->timestep.rule != TL_TIMESTEP_PAPER;
}

static inline tl_reaction tl_reaction_on(const struct tl_cycle *c, uint32_t body)
{
    return c->reaction[c->reaction_of[body]];
}

/* The share of gravity and loads that acts: a relaxation may bring them on in parts. */
static inline double tl_loads_share(const tl_model *m)
{
    return m->relaxing ? m->cycle->settling.share : 1;
}

/* What gravity and loads do in a step. The kick spans half of the last step and half of this one. What has been set in
 * between acts only in the latter, and what it was in the former. So their mean acts in the whole span. Forces that are
 * reported are those at the beginning of the step: kicks and energies take the mean. */
static inline tl_vec3 tl_acting_mean(const struct tl_cycle *c, tl_vec3 now, tl_vec3 before)
{
    return tl_v3_madd(tl_v3_scale(1 - c->share_before, now), c->share_before, before);
}
/* Of a body's load. */
static inline tl_wrench tl_acting_load(const tl_model *m, uint32_t body)
{
    tl_wrench acts = tl_load_wrench(&m->bodies, body);
    if (tl_load_changed(m, body)) {
        tl_wrench before = m->bodies.load_before[body];
        acts.force = tl_acting_mean(m->cycle, acts.force, before.force);
        acts.moment = tl_acting_mean(m->cycle, acts.moment, before.moment);
    }
    return acts;
}
/* Whether the mean is not what they are now, and by how much of force and moment it is less on a body. */
static inline bool tl_loads_lag(const tl_model *m)
{
    return m->gravity_changed || m->loads_changed;
}
static inline tl_wrench tl_load_lag(const tl_model *m, uint32_t body)
{
    tl_wrench now = tl_load_wrench(&m->bodies, body), acts = tl_acting_load(m, body);
    const double share = tl_loads_share(m);
    tl_vec3 gravity = tl_v3_sub(tl_v3_scale(share, m->config.gravity), m->cycle->gravity);
    tl_vec3 force = tl_v3_scale(share, tl_v3_sub(now.force, acts.force));
    return (tl_wrench){tl_v3_madd(force, m->bodies.mass[body], gravity),
                       tl_v3_scale(share, tl_v3_sub(now.moment, acts.moment))};
}
/* Weight of a body under gravity of that size; a load weighs as much as its force. */
static inline double tl_weight_of(const tl_bodies *b, uint32_t body, double gravity)
{
    return b->mass[body] * gravity + (b->load ? tl_v3_norm(b->load[body].force) : 0);
}
/* What a body of that weight bears: the sum of its contact forces or, where that is more, its weight. */
static inline double tl_borne(const tl_model *m, uint32_t body, double weight)
{
    double contact = m->cycle->contact_force[body];
    return contact > weight ? contact : weight;
}

/* Power of the unbalanced forces on a body, W. */
static inline double tl_body_power(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    return tl_v3_dot(b->force[body], b->v[body]) + tl_v3_dot(b->moment[body], b->w[body]);
}

/* A row of contacts or bodies and what was looked for in it; TL_NO_ROW: there is none. */
typedef struct tl_row_value {
    double value;
    uint32_t row;
} tl_row_value;

/* Whether a body counts for the rules: one that can move or, where none can, any. */
static inline bool tl_body_counts(const tl_model *m, uint32_t body)
{
    return m->cycle->all_held || m->bodies.fixed[body] != TL_FIX_ALL;
}

#endif
