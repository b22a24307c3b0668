/* zones.h - the meshes of deformable bodies: gridpoints, and tetrahedra between them, the zones.
 *
 * The strain of a zone is the same everywhere in it. Some six zones that hang together are a cluster: they share the
 * change of their volume, and the change of their mean stress (pass.c).
 *
 * A SIMD group is TL_LANES clusters side by side. Zone k of the cluster in lane l is row start + TL_LANES k + l of the
 * table. A cluster of fewer zones than the deepest of its group, and a lane without a cluster, has inert rows: copies
 * of a zone whose volume counts as 0.
 *
 * A parcel is some groups of one block and one solid, with a list of the gridpoints that they use. A thread takes one
 * parcel at a time. What the zones of a parcel do to a gridpoint is summed in a slot of the parcel; a gridpoint adds
 * its slots in their order. So sums do not depend on threads.
 *
 * Signs: stress and strain are positive in tension. Six components are xx yy zz xy yz zx, strains as of a tensor. */
#ifndef TL_ZONE_ZONES_H
#define TL_ZONE_ZONES_H

#include "base/kind_states.h"
#include "base/table.h"
#include "geometry/zone_clusters.h"
#include "model/model.h"
#include "zone/solid.h"

/* Steps until zones have strained by velocities that are set: the first moves by them, the second sees it. */
#define TL_STEPS_KEPT 2
/* Rows of a parcel, at the most: its gridpoints are numbered by 16 bits. */
#define TL_PARCEL_ZONES 4096
/* Gridpoints of a parcel, at the most. */
#define TL_PARCEL_POINTS 2048

/* A solid that the model has given a name. */
typedef struct tl_named_solid {
    char *name;
    tl_solid of;
    bool turns; /* some of its states turn with the zones */
} tl_named_solid;

typedef struct tl_gridpoints {
    tl_table table;
    double *ref[3];    /* where it was made, from the model's origin, m */
    double *u[3];      /* displacement since, m */
    double *v[3];      /* velocity, half a step behind the place, m/s */
    double *moved[3];  /* that of the last motion: since then v may have been set anew */
    double *mass;      /* kg: a quarter of the mass of each of its zones */
    double *force[3];  /* unbalanced: zones, contacts, weight, load; of held components it is what holds, reversed, N */
    double *bears;     /* a bound of the sum of the sizes of the forces on it, N: pass.c */
    double *touched;   /* the part of it that contacts bring, N */
    uint32_t *zones;   /* that have it for a corner */
    double *stiffness; /* bound of the row of the stiffness matrix of the zones, N/m: stiffness.c */
    double *floor;     /* stiffness of the stiffest joint on its share of outer faces, N/m */
    double *holds;     /* of zones and what touches it, but at least the floor, N/m */
    double *rounded;   /* force that rounding of its place brings, N */
    uint32_t *mesh;    /* its number */
    uint8_t *fixed;    /* TL_FIX_X, _Y, _Z */
    uint8_t *bare;     /* 1: it is on the surface of its body */
    double *load[3];   /* of the user's, N; NULL: none has ever been set */
    double *held[2][3]; /* unit vectors along which it is held beside `fixed`, or zeros; NULL: nowhere is one */
    uint32_t *drive;    /* whose velocity it has: index into the model's drives + 1, or 0; NULL: none is driven */
    double *rolled[3];  /* force by which these directions hold it, in the last step, N; NULL as they are */
    double *pushed[3];  /* by what acts on the surface, in the last step, N; NULL: nothing ever has */
    double *quiet[6];   /* resistance of quiet boundaries, kg/s: xx yy zz xy yz zx; NULL: there has been none */
    double *damping[3], *alpha; /* what the damping gave; NULL: there has been none */
    double *force_before[3];    /* in the last damped step; NULL: no damping has asked for them */
} tl_gridpoints;

typedef struct tl_zone_table {
    tl_table table;
    uint16_t *corner[4]; /* in the list of the parcel's gridpoints; 0-1-2 is counter-clockwise from 3's other side */
    double *stress[6];   /* Pa */
    uint32_t *flags;     /* TL_ZONE_*, of the solid */
    uint32_t *number;    /* of its body's zones, from 0; TL_NO_ROW: an inert row */
    double *state[TL_SOLID_COLUMNS]; /* as many as the solids need; the others are NULL */
    uint32_t state_columns;
} tl_zone_table;

/* A SIMD group: its first row, the zones of its deepest cluster, and those of each lane's. `extent`: cube roots of the
 * volumes that the lanes' clusters were made with, m. */
typedef struct tl_zone_group {
    uint32_t start;
    uint8_t depth, count[TL_LANES];
    double extent[TL_LANES];
} tl_zone_group;

typedef struct tl_parcel {
    uint32_t mesh, solid;
    tl_id block;
    uint32_t group_begin, group_end;
    uint32_t point_begin, point_end; /* in `listed`, and its slots */
} tl_parcel;

typedef struct tl_parcels {
    tl_table table;
    tl_parcel *of;
    double *stored;      /* by its zones, J */
    double *heat;        /* that they have made in the last step, J */
    double *most_strain; /* square of the largest that a zone got in it */
} tl_parcels;

/* What the zones of a parcel do to a gridpoint: the three components of the sum of their forces, and the sum of the
 * squares of their sizes. */
typedef struct tl_slot {
    double of[4];
} tl_slot;

/* A gridpoint among those that a loop takes: where it is, m, and how it came there in the last step. A line of
 * memory. */
typedef struct tl_gridpoint_now {
    double place[4], way[4];
} tl_gridpoint_now;

/* Those of a parcel, from the first line of memory on. Scratch of a thread. */
typedef struct tl_parcel_points {
    tl_gridpoint_now of[TL_PARCEL_POINTS + 1];
} tl_parcel_points;

/* A triangle of the surface of a mesh: rows of its gridpoints, counter-clockwise as seen from outside, and the fourth
 * of its zone; the block and its face that it is a part of. */
typedef struct tl_surface_part {
    uint32_t corner[3], apex, face;
    tl_id block;
} tl_surface_part;

/* The part of a triangle that lies on no other block: integrals of N_a N_b over it, over the area of the triangle, for
 * ab = 00 11 22 01 12 20. */
typedef struct tl_bare {
    double of[6];
} tl_bare;

/* Of a whole triangle. */
static inline tl_bare tl_bare_whole(void)
{
    return (tl_bare){{1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 12, 1.0 / 12, 1.0 / 12}};
}

/* The integral of N_a, over the area of the triangle. */
static inline double tl_bare_at(const tl_bare *b, int a)
{
    return b->of[a] + b->of[3 + a] + b->of[3 + (a + 2) % 3];
}

/* What acts from outside on a triangle of a surface, or holds it: outer.c. */
typedef struct tl_outer_part {
    uint32_t part;  /* in `part` */
    uint32_t drive; /* whose velocity its gridpoints have: index into the model's drives + 1, or 0 */
    uint32_t solid; /* of its zone: for quiet ones */
    uint8_t fixed;  /* TL_FIX_X, _Y, _Z: how its gridpoints are held */
    uint8_t quiet;  /* it lets waves out */
    uint8_t loaded; /* stress, gradient and traction count */
    uint8_t unused;
    tl_vec3 along;            /* unit vector along which its gridpoints are held; zero: none */
    tl_bare bare;             /* what of it lies on no other block */
    double density;           /* of its block, kg/m3 */
    double at;                /* height, in the user's coordinates, at which `stress` holds, m */
    tl_sym3 stress, gradient; /* Pa, and Pa/m of height, tension positive */
    tl_vec3 traction;         /* beside them, Pa */
    tl_vec3 rest[3];          /* forces on its corners that stay as they are, N */
} tl_outer_part;

/* How a mesh moves in a step of a relaxation (settle.c): as a whole, m/s and rad/s; the power of its unbalanced forces
 * on that, and on what it moves beside it, W. */
typedef struct tl_mesh_motion {
    tl_vec3 velocity, turn;
    double power, strain_power;
    bool loose;   /* next to nothing bears it: it goes its own way */
    bool goes_on; /* where others stop */
} tl_mesh_motion;

/* The mesh of a body. */
typedef struct tl_body_mesh {
    tl_id body;
    uint32_t row;                    /* of the body */
    uint32_t point_begin, point_end; /* rows of gridpoints */
    uint32_t parcel_begin, parcel_end;
    uint32_t zone_begin, zone_end; /* in `row_of` */
    uint32_t part_begin, part_end; /* in `part` */
    tl_vec3 made_u;                /* of the body when the mesh was made: displacement, m, and rotation */
    tl_quat made_q;
} tl_body_mesh;

struct tl_zones {
    tl_gridpoints points;
    tl_zone_table zones;
    tl_zone_group *group;
    size_t group_count, group_capacity;
    tl_parcels parcels;
    uint32_t *listed; /* rows of gridpoints, parcel by parcel */
    tl_slot *slot;    /* of each of them */
    size_t listed_count, listed_capacity, slot_capacity;
    /* the slots of gridpoint p are use[use_start[p]] .. use[use_start[p + 1] - 1] */
    uint32_t *use, *use_start;
    size_t use_capacity, use_start_capacity;
    uint32_t *row_of; /* the row of each zone, mesh by mesh, by its number */
    size_t row_of_count, row_of_capacity;
    tl_surface_part *part; /* of the surfaces, mesh by mesh; of a mesh by block and face */
    size_t part_count, part_capacity;
    tl_outer_part *outer; /* by ascending parts, each at most once */
    size_t outer_count, outer_capacity;
    tl_body_mesh *mesh;
    size_t mesh_count, mesh_capacity;
    tl_mesh_motion *motion; /* of each mesh: scratch of a step of a relaxation */
    size_t motion_capacity;
    tl_named_solid *solid;
    size_t solid_count, solid_capacity;
    uint64_t *meeting; /* pairs of blocks that meet by segments, the lower id times 2^32 and the other, ascending */
    size_t meeting_count, meeting_capacity;
    tl_parcel_points *scratch; /* of each thread */
    size_t scratch_capacity;
    double moved_dt;                  /* of the last motion of the gridpoints, s; 0: they have not moved yet */
    uint32_t steps_kept;              /* steps to come that can be undone, for velocities were set */
    uint64_t version;                 /* counts changes of meshes and solids */
    uint64_t followed;                /* structure of the model for which meshes have the rows of their bodies */
    double highest_rate, lowest_rate; /* stiffness over mass of the gridpoints that may move, 1/s2; 0: there are none */
    uint32_t highest, lowest;         /* rows of those with these, or TL_NO_ROW */
    uint64_t rated_for;               /* version then; 0: not known */
    int64_t rated_at;                 /* steps made then */
    uint64_t segments_rated;          /* version of the segments then, */
    uint64_t elements_rated;          /* and of the elements */
};

static inline bool tl_model_deforms(const tl_model *m)
{
    return m->zones && m->zones->mesh_count > 0;
}

static inline tl_vec3 tl_gridpoint_place(const tl_gridpoints *g, size_t row)
{
    return tl_v3(g->ref[0][row] + g->u[0][row], g->ref[1][row] + g->u[1][row], g->ref[2][row] + g->u[2][row]);
}

/* The first of some that begins a line of memory. There is one more than needed. */
static inline tl_gridpoint_now *tl_gridpoints_aligned(tl_gridpoint_now *first)
{
    return (tl_gridpoint_now *)(((uintptr_t)first + TL_ALIGN - 1) / TL_ALIGN * TL_ALIGN);
}

/* A gridpoint after a step of dt. */
static inline void tl_gridpoint_put(tl_gridpoint_now *to, const tl_gridpoints *g, size_t row, double dt)
{
    for (int i = 0; i < 3; i++) {
        to->place[i] = g->ref[i][row] + g->u[i][row];
        to->way[i] = dt * g->moved[i][row];
    }
}

#endif
