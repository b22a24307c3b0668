/* sound.c - whether segments that were read from a file fit together. What is used as the number of a row, a meet or a
 * law must be one. */
#include "segment/sound.h"

#include <math.h>

static bool side_is_sound(const tl_model *m, const tl_segment_side *side)
{
    if (tl_side_is_rigid(side))
        return side->at[0] < m->bodies.table.rows && side->at[2] == TL_NO_ROW;
    bool sound = true;
    for (int c = 0; c < 3; c++)
        sound = sound && side->at[c] < m->zones->points.table.rows;
    return sound;
}

static bool meet_is_sound(const tl_model *m, const struct tl_segments *s, const tl_meet *meet)
{
    return tl_is_flag(&meet->tilted) && tl_is_flag(&meet->alone) && meet->begin <= meet->end &&
           meet->end <= s->table.table.rows && meet->a < meet->b && meet->b < m->next_id && meet->born >= -1 &&
           meet->tag.joint <= m->joint_count && tl_is_flag(&meet->stale) && meet->share >= 0 && meet->share <= 1 &&
           (meet->law < m->joint_law_count || meet->law == TL_NO_ROW);
}

/* Spans of groups follow each other, up to all of them. */
static bool spans_are_sound(const tl_model *m, const struct tl_segments *s)
{
    uint32_t next = 0;
    bool sound = s->table.table.rows % TL_LANES == 0 && s->points.table.rows == TL_SEGMENT_POINTS * s->table.table.rows;
    for (size_t k = 0; sound && k < s->span_count; k++) {
        const tl_segment_span *span = &s->span[k];
        sound = span->group_begin == next && span->group_end >= next &&
                (span->law < m->joint_law_count || span->law == TL_NO_ROW);
        next = span->group_end;
    }
    return sound && next == s->table.table.rows / TL_LANES;
}

const char *tl_segments_unsound(const tl_model *m, const struct tl_segments *s)
{
    if (!tl_is_flag(&s->asked))
        return "segments have an impossible value";
    for (size_t k = 0; k < s->meet_count; k++)
        if (!meet_is_sound(m, s, &s->meet[k]))
            return "faces that meet have an impossible value";
    if (!spans_are_sound(m, s))
        return "segments do not fit their laws";
    for (size_t row = 0; row < s->table.table.rows; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet != TL_NO_ROW && (of->meet >= s->meet_count || s->table.outline[row] > s->outline_count ||
                                      s->table.corners[row] > s->outline_count - s->table.outline[row] ||
                                      !side_is_sound(m, &of->a) || !side_is_sound(m, &of->b)))
            return "a segment has an impossible value";
    }
    return NULL;
}
