/* lay.h - segments laid into their tables, with what points take over. */
#ifndef TL_SEGMENT_LAY_H
#define TL_SEGMENT_LAY_H

#include "segment/segments.h"

/* A segment that has been found. */
typedef struct tl_new_segment {
    uint32_t meet, key[2];
    tl_segment_side a, b;
    tl_vec3 normal_a, normal_b;
    tl_overlay over;
    size_t outline; /* where its outline begins in the list of the laying */
    size_t row;     /* where it has been laid */
    tl_vec3
        late[TL_SEGMENT_POINTS]; /* by how much its walls had gone farther in the last motion than they seem to, m */
} tl_new_segment;

/* Segments on their way into the tables: those of stale meets, in the order of these. */
typedef struct tl_laying {
    tl_new_segment *list;
    size_t count, capacity;
    tl_point2 *outline;
    size_t outline_count, outline_capacity;
    uint32_t *now;    /* of each meet that there was: its number now, or TL_NO_ROW; NULL: the same */
    bool other_meets; /* some have come or gone */
} tl_laying;

bool tl_segments_begin(tl_model *m);
void tl_segments_free(struct tl_segments *s);
void tl_laying_begin(tl_laying *l);
bool tl_laying_add(tl_laying *l, const tl_new_segment *segment);
/* Puts a list of meets in the place of the present ones. Those that there were stay as they are; the shear of others is
 * heat. false: out of memory, and the list has been freed. */
bool tl_laying_change_meets(const tl_model *m, tl_laying *l, tl_meet *list, size_t count);
/* Lays all segments anew. false: out of memory, and nothing has changed. */
bool tl_lay_segments(tl_model *m, tl_laying *l);
/* Whether stale meets have segments of the same triangles as before, and no meet has come or gone. */
bool tl_laying_fits(const tl_model *m, const tl_laying *l);
/* Then gives these their new polygons and points where they are, to the bit as if all were laid anew. Laws, zones and
 * blocks are as they were. */
void tl_renew_segments(tl_model *m, tl_laying *l);
void tl_laying_end(tl_laying *l);
/* Makes columns of states. false: out of memory. */
bool tl_segments_hold_states(struct tl_segments *s, uint32_t columns);
/* Makes the columns of initial forces. false: out of memory. */
bool tl_segments_hold_initial(struct tl_segments *s);

/* Where a point of a side lies, from the model's origin. */
tl_vec3 tl_segment_place(const tl_model *m, const tl_segment_side *side, tl_vec3 at);

#endif
