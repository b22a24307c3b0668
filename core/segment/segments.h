/* segments.h - contact of deformable blocks that lie flush on others: tables of segments and their points.
 *
 * A segment is the polygon that two triangles of surfaces have in common, or a triangle and the face of a rigid block.
 * It has three points, which integrate over it (narrow/overlay.h). A point keeps to the material of both sides. On a
 * deformable side it lies by three weights between the corners of the triangle. On a rigid one it has a place in the
 * body's frame.
 *
 * A meet is two faces, one of them of a deformable block, that may touch by segments. Its segments come by their
 * triangles.
 *
 * Segments of one law lie in SIMD groups. The segment in lane l of group g has row TL_LANES g + l. Its point k has the
 * row TL_LANES (3 g + k) + l of the points. Lanes without a segment have area 0. */
#ifndef TL_SEGMENT_SEGMENTS_H
#define TL_SEGMENT_SEGMENTS_H

#include "base/table.h"
#include "model/model.h"
#include "narrow/overlay.h"
#include "zone/zones.h"

/* Points of a segment. */
#define TL_SEGMENT_POINTS 3

/* One side of a segment: the gridpoints of its triangle, or of a rigid side the row of the body and TL_NO_ROW twice. */
typedef struct tl_segment_side {
    uint32_t at[3];
} tl_segment_side;

static inline bool tl_side_is_rigid(const tl_segment_side *s)
{
    return s->at[1] == TL_NO_ROW;
}

/* What a segment is: its meet, its sides and, of a rigid one, the outward normal in the body's frame. `key` tells the
 * two parts of the surfaces, each counted from the first of its block; of a rigid side the face. */
typedef struct tl_segment {
    uint32_t meet;
    tl_segment_side a, b;
    uint32_t key[2];
    tl_vec3 normal_a, normal_b;
} tl_segment;

/* Whether a side is of a body. */
static inline bool tl_side_is_of(const tl_model *m, const tl_segment_side *s, uint32_t body)
{
    return (tl_side_is_rigid(s) ? s->at[0] : m->zones->mesh[m->zones->points.mesh[s->at[0]]].row) == body;
}

/* Whether a row is a segment, and one of its sides is of a body. */
static inline bool tl_segment_touches(const tl_model *m, const tl_segment *of, uint32_t body)
{
    return of->meet != TL_NO_ROW && (tl_side_is_of(m, &of->a, body) || tl_side_is_of(m, &of->b, body));
}

/* The row of point k of a segment. */
static inline size_t tl_segment_point_row(size_t segment, size_t k)
{
    return TL_LANES * (TL_SEGMENT_POINTS * (segment / TL_LANES) + k) + segment % TL_LANES;
}

/* What a segment does to the corners of its sides, by side and corner: three components of a force, and its size, N. To
 * a rigid side: force, and moment about its body. */
typedef struct tl_segment_push {
    double of[2][3][4];
} tl_segment_push;

typedef struct tl_segment_table {
    tl_table table;
    tl_segment *of;              /* an empty lane has no meet: TL_NO_ROW */
    double *area;                /* m2 */
    double *share;               /* that of its meet */
    uint32_t *outline, *corners; /* in the list of outlines */
    double *normal[3];           /* in the last step, from A to B */
    uint32_t *corner[2][3];      /* of its sides, in the list of gridpoints that are touched */
    tl_segment_push *push;
    double *bears;         /* sum of the sizes of the forces of its points, N */
    double *stored, *heat; /* J: the latter in the last step */
    uint8_t *slid;         /* its sides have slid or stretched: it is to be laid anew */
} tl_segment_table;

typedef struct tl_segment_points {
    tl_table table;
    double *at_a[3], *at_b[3]; /* weights, or a place in the body's frame, m */
    double *area;              /* m2 */
    double *f_n0, *reference;  /* N, and the closure that it belongs to, m; NULL: 0 everywhere */
    double *f_n, *f_s[3];      /* N, on B */
    uint32_t *flags;
    double *state[TL_STATE_COLUMNS]; /* as many as the laws need; the others are NULL */
    uint32_t state_columns;
} tl_segment_points;

/* Two faces that may touch by segments: of blocks a < b, by their ids, and the numbers of the faces. */
typedef struct tl_meet {
    tl_id a, b;
    uint32_t face_a, face_b;
    tl_tag tag;
    uint32_t law;        /* index into the model's joint_laws, or TL_NO_ROW */
    int64_t born;        /* steps made when its blocks met; -1: they have no area in common */
    bool stale;          /* its segments are to be laid anew: it is new, or its sides have slid or stretched */
    double area;         /* m2 */
    double share;        /* 1: the outline of what the faces have in common is B's; 0: it is A's */
    uint32_t begin, end; /* rows of its segments */
    bool tilted;         /* its faces may be tilted so far that a field contact has a share (blend.c) */
    bool alone;          /* the two blocks have none */
    double size;         /* of the smaller face, m2 */
    double counts;       /* what a change of its energy counted for in the last step (blend.c) */
    double flat;         /* what its tilt leaves of its forces and energies, */
    double steep;        /* and the change of that by the cosine of the tilt */
    tl_vec3 by[2];       /* and of that by the mean vector areas of both sides, 1/m2 */
} tl_meet;

/* Two blocks that meet by segments and by a field contact (blend.c). */
typedef struct tl_blend {
    tl_id a, b;
    uint32_t first, end; /* of their meets */
    uint32_t contact;    /* row of the field contact, or TL_NO_ROW */
} tl_blend;

/* SIMD groups of one law. */
typedef struct tl_segment_span {
    uint32_t law, group_begin, group_end;
} tl_segment_span;

/* What a gridpoint or a body gets from one segment: its row, the side, and of a gridpoint the corner. */
typedef struct tl_segment_use {
    uint32_t segment;
    uint8_t side, corner;
} tl_segment_use;

/* Corners of a triangle that stands for the sides of an empty lane, and for a rigid side, until that is known: they
 * come before those that are touched. */
#define TL_SEGMENT_DUMMIES 3

/* Where a part of a face lies, in a frame of two faces, m: its third axis goes along the normal of one. `slope`: the
 * tangent of the angle between the part's normal and that axis. */
typedef struct tl_part_box {
    double low[3], high[3], slope;
} tl_part_box;

struct tl_segments {
    tl_segment_table table;
    tl_segment_points points;
    tl_point2 *outline; /* of all segments, as of tl_overlay */
    size_t outline_count, outline_capacity;
    /* memory of those before the last, for the next: their rows mean nothing */
    tl_segment_table spare;
    tl_segment_points spare_points;
    tl_point2 *spare_outline;
    size_t spare_outline_capacity;
    tl_meet *meet;
    size_t meet_count, meet_capacity;
    tl_segment_span *span;
    size_t span_count, span_capacity;
    /* of gridpoint p: use[use_start[p]] .. use[use_start[p + 1] - 1]; of bodies likewise */
    tl_segment_use *use, *body_use;
    uint32_t *use_start, *body_start;
    size_t use_capacity, use_start_capacity, body_use_capacity, body_start_capacity;
    size_t bodies_listed; /* rows of bodies that the lists know: none acts on those that came later */
    /* gridpoints that segments touch, and where they are in a step, after those that stand for other sides */
    uint32_t *touched;
    tl_gridpoint_now *now;
    size_t touched_count, touched_capacity, now_capacity;
    /* what the damping of each does to its sides, in this step; by beta over the last step, 0: it does nothing */
    tl_segment_push *damping;
    size_t damping_capacity;
    double damping_rate;
    /* of the model, the zones and the pairs of the broad phase, when meets were listed */
    uint64_t structure, laws, zones, lists;
    uint64_t followed; /* structure of the model for which sides have their rows */
    bool asked;        /* found for somebody who asks, before any step: tl_segments_ask */
    tl_overlay_room room;
    tl_point2 *room_memory;
    tl_vec3 *corner; /* scratch: of a rigid face */
    size_t corner_capacity;
    tl_part_box *box; /* scratch: of the parts of two faces */
    size_t box_capacity;
    tl_blend *blend; /* in this step, in the order of the meets */
    size_t blend_count, blend_capacity;
    double blend_stored, blend_heat; /* that is counted of field contacts and is none, in this step, J */
    uint64_t version;                /* counts how often segments were laid */
    double lost;                     /* shear that went when segments were laid: heat of the next step, J */
};

#endif
