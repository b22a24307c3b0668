/* talus/views.h - the columns of a model as they are kept, without a copy: for renderers and for programs that read
 * every step.
 *
 * A view points into the model's memory. It is valid until the next step, or until the model is changed or asked for
 * views again after a change; nobody may write through it. Number k of row i is data[stride * i + k], k < width.
 *
 * Rows are in ascending order of id. tl_structure tells when rows have changed. While it gives the same number, row i
 * is the same block or body. The mesh of a block is then the same in its body's frame. A renderer uploads meshes when
 * the structure changes, and places and rotations of bodies each frame. */
#ifndef TALUS_VIEWS_H
#define TALUS_VIEWS_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_view {
    const double *data;
    size_t count, stride, width;
} tl_view;

typedef struct tl_index_view {
    const uint32_t *data; /* count numbers */
    size_t count;
} tl_index_view;

/* Changes whenever blocks have come, gone, been cut or been joined otherwise. */
TL_API uint64_t tl_structure(tl_model *model);

typedef struct tl_block_views {
    tl_index_view id;
    tl_index_view body; /* row of the block's body in tl_body_views */
    tl_view volume;     /* m3 */
    tl_view density;    /* kg/m3 */
} tl_block_views;

/* The blocks' columns as they stand: valid until tl_structure changes or the model is stepped. */
TL_API tl_block_views tl_view_blocks(tl_model *model);

/* A point p of the body's frame is at origin + reference + displacement + R(rotation) p. The three parts of the place
 * are kept apart, so that a small displacement of a body far from zero loses no digits. */
typedef struct tl_body_views {
    tl_vec3 origin;           /* of all bodies, m */
    tl_index_view id;         /* the lowest id of its blocks */
    tl_view reference;        /* centroid when the body was made, less the origin, m */
    tl_view displacement;     /* of the centroid since then, m: reset_displacement does not change it */
    tl_view rotation;         /* since then: unit quaternion w, x, y, z */
    tl_view velocity;         /* of the centroid, half a step ago, m/s */
    tl_view angular_velocity; /* rad/s */
    tl_view force, moment;    /* unbalanced, in the last step, N and N m about the centroid */
    tl_view mass;             /* kg */
} tl_body_views;

/* The bodies' columns as they stand; likewise. */
TL_API tl_body_views tl_view_bodies(tl_model *model);

/* Place of the centroid of a body, m. */
static inline tl_vec3 tl_view_place(const tl_body_views *bodies, size_t row)
{
    const double *x = bodies->reference.data + bodies->reference.stride * row;
    const double *u = bodies->displacement.data + bodies->displacement.stride * row;
    tl_vec3 place = {bodies->origin.x + (x[0] + u[0]), bodies->origin.y + (x[1] + u[1]),
                     bodies->origin.z + (x[2] + u[2])};
    return place;
}

/* Rows of contacts come and go in any step and are in no order: their blocks tell which they are. */
typedef struct tl_contact_views {
    tl_index_view a, b; /* rows of its blocks in tl_block_views, the older block first */
    tl_view force;      /* of the contact on block b in the last step, N */
    tl_view area;       /* m2 */
} tl_contact_views;

/* Finds contacts first where blocks have changed, so it can fail. */
TL_API tl_status tl_view_contacts(tl_model *model, tl_contact_views *views);

/* The gridpoints of a deformable body: row k is gridpoint k. Each component of a vector is a column. A gridpoint
 * is at origin + reference + displacement. */
typedef struct tl_gridpoint_views {
    tl_vec3 origin;          /* m */
    tl_view reference[3];    /* where it was made, less the origin, m */
    tl_view displacement[3]; /* since then, m */
    tl_view velocity[3];     /* half a step ago, m/s */
    tl_view force[3];        /* unbalanced, in the last step, N */
    tl_view mass;            /* kg */
} tl_gridpoint_views;

/* The gridpoints of the body that a block belongs to: none of a rigid one. TL_E_STALE: there is no such block. */
TL_API tl_status tl_view_gridpoints(tl_model *model, tl_id block, tl_gridpoint_views *views);

/* The shape of a block in the frame of its body, which moves with it: as tl_block_mesh_get, but `vertices` and
 * `normals` are fixed until the structure changes. */
TL_API tl_status tl_block_mesh_local(tl_model *model, tl_id block, tl_block_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
