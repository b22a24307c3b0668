/* memory.c - what a model holds, in bytes, by what it is for. Columns count with their spare rows, and so does the
 * second set of tables that contacts are laid out in from time to time. The allocator's own bytes (some 16 an
 * allocation, of which a block has one) are not counted. */
#include "element/memory.h"
#include "contact/store.h"
#include "cycle/prepare.h"
#include "cycle/undo.h"
#include "element/walk.h"
#include "geometry/make.h"
#include "model/seats.h"
#include "model/walk.h"
#include "narrow/field_lanes.h"
#include "segment/walk.h"
#include "zone/walk.h"

#include <string.h>

/* Adds the bytes of an entry to the field of tl_memory that it counts for. */
static void add(void *user, const tl_entry *entry)
{
    if (entry->bytes == 0)
        return;
    char *field = (char *)user + entry->counts_for;
    size_t sum;
    memcpy(&sum, field, sizeof sum);
    sum += entry->bytes;
    memcpy(field, &sum, sizeof sum);
}

static size_t narrow_bytes(const tl_narrow_scratch *n)
{
    return sizeof *n + n->vertex_capacity * sizeof *n->vertex_b + n->normal_capacity * sizeof *n->normal_b +
           (n->plane_capacity + n->press_capacity + n->corner_capacity) * sizeof(double) +
           n->field.lines * (sizeof(tl_field_line) + 2 * sizeof(tl_field_plane)) +
           n->field.numbers * sizeof *n->field.number + n->face_capacity * sizeof *n->face +
           n->manifold.point_capacity * sizeof *n->manifold.points +
           n->patch.capacity * (4 * sizeof(double) + sizeof(uint32_t));
}

static size_t thread_bytes(const tl_detect *d)
{
    size_t sum = 0;
    for (unsigned i = 0; i < d->threads; i++)
        sum += narrow_bytes(&d->narrow[i]) + tl_table_bytes(&d->lanes[i].table);
    return sum;
}

static void add_detection(tl_detect *d, const tl_walk *walk, tl_memory *memory)
{
    tl_detect_walk(d, walk);
    size_t facets = d->contacts.table.capacity * sizeof *d->contacts.facet;
    memory->contacts -= facets;
    memory->facets += facets;
    memory->other += sizeof *d + thread_bytes(d);
}

static size_t history_bytes(const tl_history *h)
{
    return sizeof *h + h->id_count * (h->contacts ? sizeof *h->contacts : sizeof *h->ids) +
           h->capacity * (sizeof *h->cycles + sizeof *h->times + h->width * sizeof *h->values);
}

tl_memory tl_model_memory(const tl_model *m)
{
    tl_memory memory = {0};
    const tl_walk walk = {add, &memory};
    tl_model_walk((tl_model *)(uintptr_t)m, &walk);
    memory.other += sizeof *m + m->joint_count * sizeof *m->joints + m->joint_law_count * sizeof *m->joint_laws +
                    m->drive_count * sizeof *m->drives;
    for (size_t i = 0; i < m->history_count; i++)
        memory.other += history_bytes(m->histories[i]);
    for (size_t row = 0; row < m->blocks.table.rows; row++)
        memory.shapes += m->blocks.stays[row] ? tl_poly_bytes(m->blocks.shape[row]) : 0;
    memory.shapes += tl_seats_bytes(m);
    if (m->zones)
        tl_zones_walk(m->zones, &walk);
    if (m->segments)
        tl_segments_walk(m->segments, &walk);
    if (m->elements) {
        tl_elements_walk(m->elements, &walk);
        memory.elements += tl_elements_bytes(m->elements);
    }
    if (m->cycle) {
        tl_cycle_walk(m->cycle, &walk);
        memory.step += sizeof *m->cycle + tl_undo_bytes(m->cycle);
    }
    if (m->detect)
        add_detection(m->detect, &walk, &memory);
    if (m->stepped)
        add_detection(m->stepped, &walk, &memory);
#define ADD(name, doc) memory.total += memory.name;
    TL_MEMORY(ADD)
#undef ADD
    return memory;
}
