/* meeting.h - what two blocks that meet by segments do to each other.
 *
 * Lists of contacts have such two blocks once. Their row lies behind those of the table of contacts: by as much as the
 * number of the first of their meets. They are told as the last step left them, or
 * before any as the first one finds them. */
#ifndef TL_QUERY_MEETING_H
#define TL_QUERY_MEETING_H

#include "narrow/surface.h"
#include "segment/segments.h"

/* Sums over the segments of two blocks, of ids a < b. */
typedef struct tl_meeting {
    tl_id a, b;
    tl_tag tag;        /* of the faces with the most area in common */
    uint32_t law;      /* likewise, or TL_NO_ROW */
    int64_t born;      /* steps made when they met */
    double area;       /* m2 */
    double gap;        /* the smallest, m */
    tl_vec3 normal;    /* unit, from a to b */
    tl_vec3 point;     /* centroid of the area, from the model's origin, m */
    double pressing;   /* N */
    double initial;    /* that of stresses that were there before anything moved, N */
    tl_vec3 shear;     /* N, on b */
    tl_vec3 passed;    /* how far b has moved against a, mean over the area, m */
    uint32_t any, all; /* flags that some point has, and that all have */
} tl_meeting;

/* Whether a row is that of blocks that meet by segments. */
bool tl_row_is_meeting(const tl_model *m, uint32_t row);
/* The row behind another one of all pairs that have an area in common and no contact in the table; TL_NO_ROW gives the
 * first, and comes behind the last. */
uint32_t tl_meeting_next(const tl_model *m, uint32_t row);
/* The row of two blocks, by their ids, or TL_NO_ROW. */
uint32_t tl_meeting_row(const tl_model *m, tl_id a, tl_id b);
tl_meeting tl_meeting_of(const tl_model *m, uint32_t row);
/* The same without any sums: blocks, joint and law. */
tl_meeting tl_meeting_named(const tl_model *m, uint32_t row);
/* Marks the faces that meet: number first[row of the block] + face. */
void tl_meeting_mark(const tl_model *m, uint32_t row, const size_t *first, unsigned char *marks);
/* How many points its segments have. */
size_t tl_meeting_point_count(const tl_model *m, uint32_t row);
/* The row of point k among those of segments; its place halfway between both sides, from the model's origin, and the
 * gap there, m. */
size_t tl_meeting_point(const tl_model *m, uint32_t row, size_t k, tl_vec3 *place, double *gap);
/* Adds the outlines of its segments, halfway between both sides. false: out of memory. */
bool tl_meeting_outlines(const tl_model *m, uint32_t row, tl_surface *surface);
/* A state of its law from a column on: the mean over its area, or the sum. */
void tl_meeting_state(const tl_model *m, uint32_t row, uint32_t column, size_t width, bool adds, double value[3]);

#endif
