/* talus/boundary.h - the outer faces of a model: which they are, holding their blocks, loading them.
 *
 * A face is an outer face as far as it lies neither on a block of another body nor on one of its own body. All blocks
 * count, hidden ones, too. Faces that are not flush, and gaps wider than contacts reach, leave both sides bare. */
#ifndef TALUS_BOUNDARY_H
#define TALUS_BOUNDARY_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum tl_side {
    TL_SIDE_ANY,
    TL_SIDE_XMIN,
    TL_SIDE_XMAX,
    TL_SIDE_YMIN,
    TL_SIDE_YMAX,
    TL_SIDE_ZMIN,
    TL_SIDE_ZMAX
} tl_side;

/* The side of a name, "xmin" to "zmax"; TL_SIDE_ANY for another. */
TL_API tl_side tl_side_named(const char *name);
/* The names, NULL terminated, from TL_SIDE_XMIN on. */
TL_API const char *const *tl_side_names(void);

/* Which outer faces; all that is given must hold. */
typedef struct tl_boundary_where {
    int32_t side;       /* tl_side: in that plane of the box about all blocks, looking outward */
    tl_vec3 normal, at; /* in the plane through `at`, looking along `normal` (of any length); NaN: any */
    tl_bounds box;      /* with all corners in the box; NaN: any */
    tl_vec3 facing;     /* looking so, within an angle; NaN: any */
    double within;      /* degrees */
    double tolerance;   /* m, off the plane or out of the box; NaN: 1e-3 of the block's size */
} tl_boundary_where;

/* What is done at these faces: to rigid bodies whole, to deformable ones at the gridpoints of the faces' triangles. */
typedef struct tl_boundary_action {
    tl_boundary_where where;
    bool fixed;    /* held in all components */
    bool roller;   /* held across the faces: across the plane or side or, without one, each along its mean normal. Those
                      of rigid blocks must look along an axis */
    bool rotation; /* with roller: rigid bodies do not turn either */
    /* the traction (stress + gradient (z - at.z)) n + traction, Pa, on outward normals n; tension positive */
    bool loads;
    tl_sym3 stress, gradient;
    tl_vec3 at, traction;
    double level; /* m: loads act on what lies below this height z; NaN: on all. A triangle that it crosses keeps the
                     forces it has then */
    bool quiet; /* deformable blocks only: lets waves out, and bears what it bore until now. Rigid ones take elements of
                 * the kind "quiet" */
    const tl_drive
        *drive; /* prescribes velocities, without turning; NULL: none. Functions are the model's from then on */
} tl_boundary_action;

/* All outer faces, and nothing is done. */
TL_API tl_boundary_action tl_boundary_action_default(void);

typedef struct tl_boundary_face {
    tl_id block;
    uint32_t face; /* of tl_block_mesh */
    double area;   /* of its outer part, m2 */
    tl_vec3 normal, centroid;
} tl_boundary_face;

typedef struct tl_boundary_result {
    tl_boundary_face *faces; /* in order of block and face */
    size_t face_count;
    tl_id *blocks; /* ascending */
    size_t block_count;
    double area;
    tl_vec3 force;  /* of the load, N */
    tl_vec3 moment; /* of the load about {0, 0, 0}, N m */
} tl_boundary_result;

/* Finds the faces of each action, TL_E_NOT_FOUND when there is none, and does what they say: all of them or none. What
 * the actions put on one body adds up; it takes the place of the load the body had or, with `add`, is added to that. As
 * with tl_blocks_load the force keeps its direction and its point goes with the body. Where a face is cut, its parts
 * get their shares: for a traction that is uniform, or normal and linear, what it is on each.
 *
 * Of a deformable block each triangle of a face counts by itself for `where`. Tractions act on the triangles as they
 * are in each step, by their present normals and heights. What is done to a triangle takes the place of all that an
 * earlier call did to it or, with `add`, is added. A triangle that other blocks cover in part bears its bare share.
 *
 * TL_E_STATE: quiet faces of rigid blocks; held faces of a block that is driven. TL_E_ARGUMENT: what does not go
 * together. Free the results with tl_boundary_free, one by one; a failed call leaves them empty. `results` may be
 * NULL. */
TL_API tl_status tl_model_boundary(tl_model *model, const tl_boundary_action *actions, size_t count, bool add,
                                   tl_boundary_result *results);
/* Frees the lists of a result and empties it. NULL and an empty one are left alone. */
TL_API void tl_boundary_free(tl_boundary_result *result);

/* Sum of the forces with which the bodies of blocks are held, in their held components, N: what contacts and elements,
 * in the last step, weight and load put on them, the other way. Each body counts once; inertia of driven ones does not.
 * Of deformable bodies it is the sum over their held gridpoints, as of the last step. */
TL_API tl_status tl_blocks_reaction(tl_model *model, const tl_id *ids, size_t count, tl_vec3 *force);

/* Lets the components what[i] (TL_FIX_*) of the body of block ids[i] go as far as they are held. What held them in the
 * last step is added to the load of the body: a force in its centroid, N, and a moment, N m. A model at rest stays so.
 * TL_E_STATE: a body is driven, or deformable; then none is changed. */
TL_API tl_status tl_blocks_release(tl_model *model, const tl_id *ids, size_t count, const uint8_t *what);

#ifdef __cplusplus
}
#endif
#endif
