/* layout.h - where the points of contacts are, and what is known of them while a step works on them. */
#ifndef TL_CONTACT_LAYOUT_H
#define TL_CONTACT_LAYOUT_H

#include "base/table.h"

#include <stdlib.h>
#include <talus/types.h>

/* What a stress that is no line in the closure changes in a cell: force/partly_open.c. */
typedef struct tl_bent {
    double closure; /* of the closure that the law gets, m */
    double more;    /* and of the volume that it does not get, m^3 */
    double second;  /* of the half second moment, m^4 */
    tl_vec3 moment; /* of the moment, m^4 */
} tl_bent;

/* What is closed and what is apart of the cell of a point, over which the overlap is linear: force/partly_open.c.
 * Beside the means that the law gets are moments about the point and half second moments of u. */
typedef struct tl_cell {
    tl_vec3 pressed, apart;              /* m^4 */
    double pressed_volume, apart_volume; /* area times the means, m^3 */
    double pressed_second, apart_second; /* m^4 */
    double pressed_more, apart_more;     /* what the volumes are beyond those that the law got, m^3 */
    /* of the point as the law found it: overlap of the faces, m, its lift from there, less its reference, m, and the
     * share of tension that was held */
    double closure, lift, hold;
    double level;        /* at which its lift lies over the cell, beside the slope of the patch, m */
    tl_vec3 centre;      /* area times its centroid from that of the patch, m^3; found where lifts differ */
    double pressed_area; /* m^2, and the same of it */
    tl_vec3 pressed_centre;
    /* of a law that is not linear, of what is closed: int u^3 dA, m^5; int u^4 dA, m^6; int u^2 x dA, m^5; int u^3 x
     * dA, m^6; and what its stress changes */
    double pressed_third, pressed_fourth;
    tl_vec3 pressed_square, pressed_cube;
    tl_bent bent;
} tl_cell;

/* What is known of points only while a step works on them. */
typedef struct tl_point_lanes {
    tl_table table;
    double *arm[3]; /* from A's body's centroid to the point, axes of the model */
    double *normal[3];
    double *closure; /* overlap less reference */
    double *edge;    /* the same at the outermost fibre of a point's area */
    /* of patches that are partly open: tl_law_batch, tl_law_ops */
    double *apart, *lift, *hold;
    tl_cell *cell;
    double *du_n, *du_s[3];
    double *stored, *dissipated;
    double *zero; /* 0, for what points have no column of */
    /* what a law found, where it is asked whether it changes anything: forces and states, and flags */
    double *before[4 + TL_STATE_COLUMNS];
    uint32_t *flags_before;
} tl_point_lanes;

/* A SIMD group: TL_LANES contacts of one joint law whose points lie side by side. Point k of the contact in lane l is
 * row start + TL_LANES k + l. What has to be done for each contact, or for each point, is done for all of a SIMD group
 * at once: each has a lane of the processor's vectors. Lanes without a contact, and rows beyond a contact's points, are
 * inert: area 0. */
typedef struct tl_simd_group {
    uint32_t start, slots;      /* points there is room for in each lane */
    uint32_t contact[TL_LANES]; /* row, or TL_NO_ROW */
} tl_simd_group;

/* Most points of a tile, which is worked on as a whole, from gaps to sums, while it is in the nearest cache: as many
 * SIMD groups as have room for so many points, or one group. */
#define TL_TILE 144

/* Whether the contacts of a span are passed over: contacts.c. */
enum { TL_SPAN_WOKEN, TL_SPAN_FOLLOWED, TL_SPAN_RESTS };

/* A span: the SIMD groups of one joint law, one after the other in the list of SIMD groups. Their points are in rows
 * from `begin`, used up to `end`, with room up to `limit`. Kinds of contact have spans apart. Contacts between bodies
 * that are held still have spans of their own. */
typedef struct tl_span {
    uint32_t law;
    bool held;    /* between bodies that are held still */
    uint8_t kind; /* of contact: detection.h */
    uint8_t rest; /* of one that is held: TL_SPAN_* */
    bool changed; /* of one that is held: some point or sum was not what it had been, in the last step */
    size_t begin, end, limit;
    size_t group_begin, group_end, group_limit;
} tl_span;

/* Where the points of all contacts are. */
typedef struct tl_layout {
    tl_span *spans;
    size_t span_count, span_capacity;
    tl_simd_group *groups;
    size_t group_capacity;
    size_t laid_rows; /* of points, when all were laid out; spans behind them were added since */
    int64_t added_at; /* steps made when a span was added last */
} tl_layout;

static inline void tl_layout_free(tl_layout *layout)
{
    free(layout->spans);
    free(layout->groups);
    *layout = (tl_layout){0};
}

#endif
