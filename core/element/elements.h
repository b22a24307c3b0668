/* elements.h - elements: what acts on points of blocks, its nodes, by kinds of plugins.
 *
 * A *set* is what one call has made: a kind, its parameters, and elements of ascending ids. An element has nodes in
 * rows that follow each other; rows of both tables are in the order of the ids. A node is carried by a rigid body, by
 * the zone of a deformable one that it lies in, or by the ground.
 *
 * A node's place when installed is `rest`. Its block had moved by `from` there since it was made. Cuts and joins keep
 * where blocks were made (tl_block_made). So rest - from gives the place in the frame of any later body:
 *
 *     x_made = x_ref + shift + T p,    p = T^t (rest - from - x_ref - shift)
 *
 * with the shift and turn T of tl_block_made. The displacement since installing, of the present pose u, R:
 *
 *     u_node = (u + R p) - base
 *
 * base is u + R p when the node was installed, or what keeps u_node as it is when the frame changes. A node in a zone
 * has shares N_a of its gridpoints. It moves by the sum of N_a u_a and gives them N_a f of its force f. */
#ifndef TL_ELEMENT_ELEMENTS_H
#define TL_ELEMENT_ELEMENTS_H

#include "base/parallel.h"
#include "model/model.h"

#include <talus/elements.h>

/* The block of a node whose block has been deleted. */
#define TL_GONE UINT32_MAX

/* What one call has made. */
typedef struct tl_element_set {
    const tl_kind *kind;
    void *params;       /* the plugin's params struct; its texts are owned by it */
    void *self;         /* what its create made, or params */
    uint32_t group;     /* of the model's groups */
    uint32_t number;    /* scratch */
    uint64_t structure; /* of the model when the kind last placed its elements */
} tl_element_set;

typedef struct tl_element_table {
    tl_table table;
    tl_id *id;
    uint32_t *set;
    uint32_t *node_begin, *node_count;
    uint32_t *flags;      /* TL_ELEMENT_* */
    uint64_t *key;        /* by which `place` knows it again; 0: none */
    double *stored;       /* J */
    double *lost, *given; /* in the last step, J */
    double *state[TL_ELEMENT_COLUMNS];
    uint32_t state_columns; /* that there are; the others are NULL */
} tl_element_table;

typedef struct tl_node_table {
    tl_table table;
    tl_id *block;     /* TL_NO_ID: the ground; or TL_GONE */
    double *rest[3];  /* m, place when installed, from the model's origin */
    double *local[3]; /* m, in the body's frame */
    double *weight;   /* m or m2 */
    double *u[3];     /* m, displacement since it was installed, as of the last step */
    double *force[3]; /* N, on the block, in the last step */
    double *state[TL_ELEMENT_COLUMNS];
    uint32_t *body; /* row, or TL_NO_ROW */
    double *k;      /* N/m, bound that the kind has told */
    uint32_t state_columns;
    /* What only some elements need: NULL until there are such. */
    double *base[3];      /* m; NULL: it is `local`, as of nodes on blocks that had not moved */
    double *from[3];      /* m, how far the block had moved there since it was made; NULL: nowhere */
    double *outward[3];   /* normal of its face when its block was made, or 0; */
    double *normal[3];    /* likewise in the body's frame; NULL: it is the same */
    uint32_t (*point)[4]; /* numbers of gridpoints in the mesh; of a node on a face the corners of its triangle first */
    double (*share)[4];   /* of them at the node; all 0: it is in no zone */
    double *c;            /* N s/m, bound that the kind has told */
} tl_node_table;

/* Whole elements of one set that a thread takes at a time. */
typedef struct tl_element_chunk {
    uint32_t set, begin, end; /* rows of elements */
    uint32_t node_begin, node_end;
    bool steady;                 /* the forces of its kind are kept while bodies hardly move: steady.c */
    uint32_t broke, first_broke; /* how many have broken in this step, and the row of the first one */
} tl_element_chunk;

/* What steady elements do to each rigid body, in its own frame, and where it was. */
typedef struct tl_steady_table {
    tl_table table;
    uint8_t *held;     /* 1: the sums are those of the nodes */
    tl_vec3 *force;    /* N */
    tl_vec3 *moment;   /* N m, about its centroid */
    double *magnitude; /* N, sum of the lengths of the forces */
    tl_vec3 *acts;     /* N, force, and */
    tl_vec3 *turns;    /* N m, moment in the axes of the model, at the rotation of the last step */
    tl_vec3 *at;       /* m, displacement of the body in the last step, */
    tl_mat3 *turn;     /* and its rotation then */
    tl_mat3 *from;     /* likewise when its nodes were asked for their forces */
    double *odometer;  /* m, of the body then */
    double *given;     /* J, work of these forces in the last step */
} tl_steady_table;

struct tl_elements {
    tl_element_table table;
    tl_node_table nodes;
    tl_steady_table steady;
    tl_element_set *set;
    size_t set_count, set_capacity;
    tl_element_chunk *chunk;
    size_t chunk_count, chunk_capacity;
    /* rows of nodes on a rigid body: use[use_start[body]] .. use[use_start[body + 1] - 1]. Those of steady elements
     * come last, from steady_start[body] on. Both ascend. */
    uint32_t *use, *use_start, *steady_start;
    size_t use_capacity, use_start_capacity, steady_start_capacity;
    bool any_steady;       /* some chunks are, */
    bool all_steady;       /* or all */
    bool resting;          /* steady elements were not asked for forces in the last step */
    uint64_t asked;        /* counts steps in which some were */
    uint64_t looked;       /* that count, when it was looked at how far blocks have slid */
    double most_k, most_c; /* of all nodes, where there are lists, N/m and N s/m */
    uint32_t *carried;     /* rows of nodes in zones, ascending */
    size_t carried_count, carried_capacity;
    void **memory; /* of elements, what their kinds keep between steps (memory.c); NULL: of none */
    unsigned char *memory_block;
    size_t memory_bytes; /* of these, and of the room */
    double *room;        /* [9 for each node] motions and normals of elements with many nodes; NULL: there are none */
    uint64_t remembered; /* version for which there is memory */
    tl_id next_id;
    uint64_t version;  /* counts changes of elements, nodes and their carriers */
    uint64_t listed;   /* version for which there are chunks and lists */
    uint64_t rated;    /* version for which k and c are known */
    uint64_t followed; /* structure of the model for which nodes have their carriers */
    uint64_t zones;    /* version of the zones, likewise */
};

static inline bool tl_model_has_elements(const tl_model *m)
{
    return m->elements && m->elements->table.table.rows > 0;
}

static inline const tl_element_ops *tl_element_ops_of(const tl_element_set *set)
{
    return set->kind->ops;
}

/* Whether its lists are those of the model as it is. */
static inline bool tl_elements_are_listed(const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    return e && e->listed == e->version && e->followed == m->structure;
}

/* How far the block of a node had moved there, when it was installed, since it was made, m. */
static inline tl_vec3 tl_node_from(const tl_node_table *n, size_t row)
{
    return n->from[0] ? tl_v3(n->from[0][row], n->from[1][row], n->from[2][row]) : tl_v3(0, 0, 0);
}

/* Columns of base. */
static inline double *const *tl_node_bases(const tl_node_table *n)
{
    return n->base[0] ? n->base : n->local;
}

/* Columns of the normals in the frames of bodies; their pointers are NULL where no node has one. */
static inline double *const *tl_node_normals(const tl_node_table *n)
{
    return n->normal[0] ? n->normal : n->outward;
}

/* Normal of the face of a node when its block was made, or 0. */
static inline tl_vec3 tl_node_outward(const tl_node_table *n, size_t row)
{
    return n->outward[0] ? tl_v3(n->outward[0][row], n->outward[1][row], n->outward[2][row]) : tl_v3(0, 0, 0);
}

/* Bound of its damping, N s/m. */
static inline double tl_node_damping(const tl_node_table *n, size_t row)
{
    return n->c ? n->c[row] : 0;
}

/* Present place of a node, as of the last step, from the model's origin. */
static inline tl_vec3 tl_node_place(const tl_node_table *n, size_t row)
{
    return tl_v3(n->rest[0][row] + n->u[0][row], n->rest[1][row] + n->u[1][row], n->rest[2][row] + n->u[2][row]);
}

#endif
