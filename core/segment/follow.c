/* follow.c - segments follow the rows of gridpoints and bodies.
 *
 * A segment knows its two parts by blocks, faces and numbers, which stay. */
#include "segment/follow.h"

#include "segment/uses.h"
#include "zone/grid.h"

#include <string.h>

/* Finds the rows of one side. false: there is no such part any more. */
static bool find_side(const tl_model *m, tl_segment_side *side, tl_id block, uint32_t face, uint32_t key)
{
    const uint32_t row = tl_block_row_quiet(m, block);
    if (row == TL_NO_ROW)
        return false;
    size_t count;
    const tl_surface_part *part = tl_face_parts(m, block, face, &count);
    const bool rigid = tl_side_is_rigid(side);
    if (rigid && !part)
        side->at[0] = m->blocks.body[row];
    if (!rigid && key < count)
        memcpy(side->at, part[key].corner, sizeof side->at);
    return rigid ? !part : key < count;
}

void tl_segments_follow(tl_model *m)
{
    struct tl_segments *s = m->segments;
    if (s->followed == m->structure)
        return;
    for (size_t row = 0; row < s->table.table.rows; row++) {
        tl_segment *of = &s->table.of[row];
        const tl_meet *meet = of->meet != TL_NO_ROW ? &s->meet[of->meet] : NULL;
        if (meet && !(find_side(m, &of->a, meet->a, meet->face_a, of->key[0]) &&
                      find_side(m, &of->b, meet->b, meet->face_b, of->key[1]))) {
            of->meet = TL_NO_ROW;
            s->table.area[row] = 0;
        }
    }
    s->followed = m->structure;
    if (!tl_segments_index(m))
        s->bodies_listed = 0; /* out of memory: the next step says so */
}
