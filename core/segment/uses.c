/* uses.c - which segments act on a gridpoint, and which on a body. */
#include "segment/uses.h"

#include <string.h>

/* Lists the segments of each gridpoint and each body, in the order of their rows. There is room. */
static void list_uses(const tl_model *m, struct tl_segments *s)
{
    const size_t points = m->zones->points.table.rows, bodies = m->bodies.table.rows;
    for (int pass = 0; pass < 2; pass++) {
        uint32_t *start[2] = {s->use_start, s->body_start};
        const size_t rows[2] = {points, bodies};
        for (int w = 0; w < 2 && pass == 0; w++)
            memset(start[w], 0, (rows[w] + 1) * sizeof **start);
        for (uint32_t row = 0; row < s->table.table.rows; row++)
            for (int side = 0; s->table.of[row].meet != TL_NO_ROW && side < 2; side++) {
                const tl_segment_side *of = side ? &s->table.of[row].b : &s->table.of[row].a;
                const bool rigid = tl_side_is_rigid(of);
                for (uint8_t c = 0; c < (rigid ? 1 : 3); c++) {
                    if (pass == 0)
                        start[rigid][of->at[c] + 1]++;
                    else
                        (rigid ? s->body_use : s->use)[start[rigid][of->at[c]]++] =
                            (tl_segment_use){row, (uint8_t)side, c};
                }
            }
        for (int w = 0; w < 2; w++) {
            for (size_t k = 0; k < rows[w] && pass == 0; k++)
                start[w][k + 1] += start[w][k];
            if (pass == 1) {
                memmove(start[w] + 1, start[w], rows[w] * sizeof **start);
                start[w][0] = 0;
            }
        }
    }
}

/* Lists the gridpoints that segments touch, by their rows, and the corners of segments among them. There is room. */
static void list_touched(const tl_model *m, struct tl_segments *s)
{
    s->touched_count = 0;
    for (uint32_t point = 0; point < m->zones->points.table.rows; point++) {
        if (s->use_start[point] == s->use_start[point + 1])
            continue;
        for (uint32_t k = s->use_start[point]; k < s->use_start[point + 1]; k++)
            s->table.corner[s->use[k].side][s->use[k].corner][s->use[k].segment] =
                (uint32_t)s->touched_count + TL_SEGMENT_DUMMIES;
        s->touched[s->touched_count++] = point;
    }
}

void tl_segment_uses_list(const tl_model *m, struct tl_segments *s)
{
    for (size_t row = 0; row < s->table.table.rows; row++) {
        const uint32_t meet = s->table.of[row].meet;
        s->table.share[row] = meet != TL_NO_ROW ? s->meet[meet].share : 0.5;
        for (uint32_t c = 0; c < TL_SEGMENT_DUMMIES; c++) {
            s->table.corner[0][c][row] = c;
            s->table.corner[1][c][row] = (3 - c) % 3; /* the other way round */
        }
    }
    list_uses(m, s);
    list_touched(m, s);
    s->bodies_listed = m->bodies.table.rows;
}

bool tl_segment_uses_room(const tl_model *m, struct tl_segments *s, size_t segments)
{
    return tl_grow(&s->use, &s->use_capacity, 6 * segments, sizeof *s->use) &&
           tl_grow(&s->touched, &s->touched_capacity, 6 * segments, sizeof *s->touched) &&
           tl_grow(&s->body_use, &s->body_use_capacity, 2 * segments, sizeof *s->body_use) &&
           tl_grow(&s->use_start, &s->use_start_capacity, m->zones->points.table.rows + 1, sizeof *s->use_start) &&
           tl_grow(&s->body_start, &s->body_start_capacity, m->bodies.table.rows + 1, sizeof *s->body_start);
}

bool tl_segments_index(tl_model *m)
{
    const bool enough = tl_segment_uses_room(m, m->segments, m->segments->table.table.rows);
    if (enough)
        tl_segment_uses_list(m, m->segments);
    return enough;
}
