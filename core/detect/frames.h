/* frames.h - what is the same for all points of a facet, a facet in each lane: where it is, and how it moves. */
#ifndef TL_DETECT_FRAMES_H
#define TL_DETECT_FRAMES_H

#include "detect/facing.h"

/* A vector or a matrix in each lane. */
typedef struct lane_vec3 {
    double x[TL_LANES], y[TL_LANES], z[TL_LANES];
} lane_vec3;

typedef struct lane_mat3 {
    double m[3][3][TL_LANES];
} lane_mat3;

TL_INLINE tl_vec3 vec_at(const lane_vec3 *v, size_t l)
{
    return tl_v3(v->x[l], v->y[l], v->z[l]);
}

TL_INLINE void vec_put(lane_vec3 *v, size_t l, tl_vec3 value)
{
    v->x[l] = value.x;
    v->y[l] = value.y;
    v->z[l] = value.z;
}

TL_INLINE tl_mat3 mat_at(const lane_mat3 *m, size_t l)
{
    return (tl_mat3){{{m->m[0][0][l], m->m[0][1][l], m->m[0][2][l]},
                      {m->m[1][0][l], m->m[1][1][l], m->m[1][2][l]},
                      {m->m[2][0][l], m->m[2][1][l], m->m[2][2][l]}}};
}

/* One facet in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_facet *facet[TL_LANES]; /* NULL: none */
    lane_mat3 to;              /* from the frame of its points ... */
    lane_vec3 from;            /* ... and that frame's origin */
    lane_vec3 n, mean, lean, plane;
    double mean2[TL_LANES], l2[TL_LANES], offset[TL_LANES]; /* tl_facing */
    lane_vec3 last, last_lean;                              /* of the facet */
    /* the motion of B against A in the last step at an arm from A's centroid: way + m arm; the mean spin of
     * both, as axis times the tangent of half its angle */
    lane_vec3 way, half;
    lane_mat3 m;
    double carry[TL_LANES]; /* half; 0 for points placed after that motion */
    /* flush patches: turn of their common plane, and whether it turns at all */
    lane_mat3 turn;
    double turns[TL_LANES];
    uint32_t end[TL_LANES]; /* slot behind its points */
} tl_frames;

/* The way of a body against another, at their centroids, in the last step. */
static inline tl_vec3 tl_way_between(const tl_model *m, uint32_t from, uint32_t body)
{
    return tl_v3_scale(m->dt, tl_v3_sub(m->bodies.v_moved[body], m->bodies.v_moved[from]));
}

/* Puts a facet of a contact into lane l. */
void tl_frames_put(tl_frames *f, size_t l, const tl_model *m, uint32_t contact,
                   const tl_facet *facet);

/* A patch for each lane: its row, its bodies' turns and rotations, and how far these are apart. */
typedef struct tl_patch_rows {
    const double *a[TL_LANES], *b[TL_LANES], *ra[TL_LANES], *rb[TL_LANES], *facet[TL_LANES];
    lane_vec3 d, way; /* of B against A in the last step */
} tl_patch_rows;

/* Brings a patch in each lane into its present place; false when none is or was tilted. */
bool tl_frames_put_patches(tl_frames *restrict f, const tl_patch_rows *restrict rows);

#endif
