/* memory.c - what kinds keep of their elements between steps, and nobody saves: one block for all elements. */
#include "element/memory.h"

#include "base/inside.h"
#include "element/batch.h"
#include "element/set.h"
#include "plugin/loader.h"

#include <stdlib.h>
#include <string.h>

/* Cost only: bytes of a line of the cache. */
#define LINE 64

void tl_elements_forget(struct tl_elements *e)
{
    free(e->memory);
    free(e->memory_block);
    free(e->room);
    e->room = NULL;
    e->memory = NULL;
    e->memory_block = NULL;
    e->memory_bytes = 0;
}

size_t tl_elements_bytes(const struct tl_elements *e)
{
    size_t sum = sizeof *e + e->memory_bytes + e->set_capacity * sizeof *e->set;
    for (size_t k = 0; k < e->set_count; k++)
        sum += e->set[k].kind->params_size + 1;
    return sum;
}

/* Bytes for each element, by rows. */
static void ask_sizes(const tl_model *m, size_t *bytes)
{
    const struct tl_elements *e = m->elements;
    for (size_t k = 0; k < e->chunk_count; k++) {
        const tl_element_chunk *of = &e->chunk[k];
        const tl_element_set *set = &e->set[of->set];
        if (!tl_element_ops_of(set)->memory)
            continue;
        tl_element_lanes lanes;
        const tl_element_batch batch = tl_element_batch_of(m, of, &lanes);
        tl_element_lanes_stop(&lanes, of->node_end - of->node_begin);
        tl_enter(set->kind, "memory");
        tl_element_ops_of(set)->memory(set->self, &batch, bytes + of->begin);
        tl_leave();
    }
}

bool tl_elements_remember(tl_model *m)
{
    struct tl_elements *e = m->elements;
    const size_t rows = e->table.table.rows;
    bool any = false, many = false;
    tl_elements_forget(e);
    for (size_t k = 0; k < e->chunk_count; k++) {
        any = any || tl_element_ops_of(&e->set[e->chunk[k].set])->memory;
        many = many || e->chunk[k].node_end - e->chunk[k].node_begin > TL_ELEMENT_NODES;
    }
    const size_t room = many ? 9 * e->nodes.table.rows * sizeof *e->room : 0;
    if (many)
        e->room = malloc(room);
    e->memory_bytes = e->room ? room : 0;
    if (!any || (many && !e->room))
        return !many || e->room;
    size_t *bytes = calloc(rows, sizeof *bytes), sum = 0;
    void **memory = calloc(rows, sizeof *memory);
    if (bytes && memory)
        ask_sizes(m, bytes);
    for (size_t row = 0; bytes && row < rows; row++)
        sum += (bytes[row] + LINE - 1) / LINE * LINE;
    unsigned char *block = bytes && memory ? calloc(sum + LINE, 1) : NULL;
    if (block) {
        size_t at = (LINE - (size_t)((uintptr_t)block % LINE)) % LINE;
        for (size_t row = 0; row < rows; row++) {
            memory[row] = block + at;
            at += (bytes[row] + LINE - 1) / LINE * LINE;
        }
    }
    free(bytes);
    if (!block) {
        free(memory);
        return false;
    }
    e->memory = memory;
    e->memory_block = block;
    e->memory_bytes += sum + LINE + rows * sizeof *memory;
    return true;
}
