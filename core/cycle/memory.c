/* memory.c - what a model holds, in bytes, by what it is for: the detection's part is its own to tell. The
 * allocator's own bytes (some 16 an allocation, of which a block has one) are not counted. */
#include "cycle/cycle_room.h"

#include "contact/memory.h"

tl_memory tl_model_memory(const tl_model *m)
{
    tl_memory memory = {0};
    size_t blocks = m->blocks.table.rows;
    memory.blocks = tl_table_bytes(&m->blocks.table);
    for (size_t row = 0; row < blocks; row++)
        memory.shapes += m->blocks.stays[row] ? tl_poly_bytes(m->blocks.shape[row]) : 0;
    memory.bodies = tl_table_bytes(&m->bodies.table);
    if (m->cycle)
        memory.step = sizeof *m->cycle + tl_table_bytes(&m->cycle->table) +
                      tl_undo_bytes(m->cycle) +
                      m->cycle->chunk_room * sizeof *m->cycle->chunk_sums +
                      m->cycle->reaction_room * sizeof *m->cycle->reaction;
    memory.other = sizeof *m + m->next_id * sizeof *m->row_of + blocks * sizeof *m->members +
                   m->joint_count * sizeof *m->joints + m->material_count * sizeof *m->materials;
    tl_detect_memory(m, &memory);
#define ADD(name, doc) memory.total += memory.name;
    TL_MEMORY(ADD)
#undef ADD
    return memory;
}
