/* memory.c - what the detection holds, in bytes, by what it is for. Columns count with their spare rows, and
 * so does the second set of tables that contacts are laid out in from time to time. */
#include "contact/memory.h"

#include "contact/detection.h"
#include "narrow/field_lanes.h"

static size_t narrow_bytes(const tl_narrow *n)
{
    return sizeof *n + n->vertex_room * sizeof *n->vertex_b + n->normal_room * sizeof *n->normal_b +
           (n->plane_room + n->press_room) * sizeof(double) +
           n->field.lines * (sizeof(tl_field_line) + 2 * sizeof(tl_field_plane)) +
           n->field.numbers * sizeof *n->field.number + n->face_room * sizeof *n->face +
           n->manifold.point_room * sizeof *n->manifold.points +
           n->patch.room * (4 * sizeof(double) + sizeof(uint32_t));
}

void tl_detect_memory(const tl_model *m, tl_memory *memory)
{
    const tl_detect *d = m->detect;
    if (!d)
        return;
    memory->pairs += d->pair_room * sizeof *d->pairs + d->chunk_room * sizeof *d->chunks;
    size_t facets = d->contacts.table.capacity * sizeof *d->contacts.facet;
    memory->contacts += tl_table_bytes(&d->contacts.table) - facets;
    memory->facets += facets + d->press_room * sizeof *d->press;
    memory->points += tl_table_bytes(&d->points.table);
    memory->spare += tl_table_bytes(&d->spare.table) + tl_table_bytes(&d->spare_points.table);
    memory->broad += d->odometer_room * sizeof *d->odometer_0 + d->run_of_room * sizeof *d->run +
                     d->seen_room * sizeof *d->seen + d->touched_room * sizeof *d->touched +
                     d->idle_room * sizeof *d->idle;
    memory->index += d->by_block_room * sizeof *d->by_block +
                     d->by_start_room * sizeof *d->by_block_start +
                     d->by_id_room * sizeof *d->by_id + d->layout.rank_room * sizeof(tl_rank);
    memory->other += sizeof *d + d->layout.run_room * sizeof(tl_run);
    for (unsigned i = 0; i < d->threads; i++)
        memory->other += narrow_bytes(&d->narrow[i]) + tl_table_bytes(&d->lanes[i].table);
}
