/* shapes.c - the polyhedra of the blocks in an archive: what they have of each thing, one block after the other. */
#include "state/shapes.h"

#include "geometry/make.h"
#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>

/* How many a block has of what its polyhedron consists of. */
typedef struct shape_counts {
    uint32_t vertices, faces, edges, seams; /* seams: 1 when it has any */
} shape_counts;

/* What there is of a polyhedron, by chunks. */
typedef enum part { VERTICES, PLANES, TAGS, STARTS, LOOPS, EDGES, MARKS, PARTS } part;

static const struct {
    const char *name;
    size_t size;
} parts[PARTS] = {
    [VERTICES] = {"shapes.vertices", sizeof(tl_vec3)},
    [PLANES] = {"shapes.planes", sizeof(tl_plane)},
    [TAGS] = {"shapes.tags", sizeof(tl_tag)},
    [STARTS] = {"shapes.starts", sizeof(uint16_t)},
    [LOOPS] = {"shapes.loops", sizeof(uint16_t)},
    [EDGES] = {"shapes.edges", sizeof(tl_edge)},
    [MARKS] = {"shapes.marks", 1},
};

static size_t items_of(const shape_counts *c, part which)
{
    switch (which) {
    case VERTICES: return c->vertices;
    case PLANES:
    case TAGS: return c->faces;
    case STARTS: return (size_t)c->faces + 1;
    case LOOPS: return 2 * (size_t)c->edges;
    case EDGES: return c->edges;
    default: return c->seams ? c->faces : 0;
    }
}

/* Where a polyhedron has it. */
static void *place_of(const tl_poly *p, part which)
{
    switch (which) {
    case VERTICES: return (void *)(uintptr_t)p->vertex;
    case PLANES: return p->plane;
    case TAGS: return p->tag;
    case STARTS: return p->start;
    case LOOPS: return p->loop;
    case EDGES: return p->edge;
    default: return (void *)(uintptr_t)p->covered;
    }
}

/* ---------------------------------------------------------------- saving ----------------- */

static shape_counts *count_all(const tl_model *m)
{
    size_t blocks = m->blocks.table.rows;
    shape_counts *counts = calloc(blocks + 1, sizeof *counts);
    for (size_t row = 0; counts && row < blocks; row++) {
        const tl_poly *p = m->blocks.shape[row];
        counts[row] = (shape_counts){p->vertex_count, p->face_count, p->edge_count, p->seams};
    }
    return counts;
}

static bool save_part(const tl_model *m, const shape_counts *counts, part which, tl_archive_writer *w)
{
    size_t blocks = m->blocks.table.rows, total = 0, size = parts[which].size;
    for (size_t row = 0; row < blocks; row++)
        total += items_of(&counts[row], which);
    char *all = malloc(total * size + 1), *at = all;
    for (size_t row = 0; all && row < blocks; row++) {
        size_t bytes = items_of(&counts[row], which) * size;
        if (bytes)
            memcpy(at, place_of(m->blocks.shape[row], which), bytes);
        at += bytes;
    }
    if (all)
        tl_archive_put(w, parts[which].name, all, size, total);
    free(all);
    return all != NULL;
}

static void save_shapes(const tl_model *m, tl_archive_writer *w)
{
    shape_counts *counts = count_all(m);
    bool saved = counts != NULL;
    if (saved)
        tl_archive_put(w, "shapes.counts", counts, sizeof *counts, m->blocks.table.rows);
    for (part which = 0; which < PARTS && saved; which++)
        saved = save_part(m, counts, which, w);
    free(counts);
    w->lost = w->lost || !saved;
}

/* ---------------------------------------------------------------- restoring -------------- */

/* What is left of each part. */
typedef struct reading {
    char *all[PARTS];
    const char *at[PARTS];
} reading;

static bool count_is_sound(const shape_counts *c)
{
    return c->vertices >= 4 && c->vertices <= TL_POLY_MAX_VERTICES && c->faces >= 4 && c->faces <= TL_POLY_MAX_FACES &&
           c->edges == c->vertices + c->faces - 2 && c->seams <= 1;
}

/* Loops and starts name what there is; every face has three corners at least. */
static bool loops_are_sound(const tl_poly *p)
{
    if (p->start[0] != 0 || p->start[p->face_count] != 2 * p->edge_count)
        return false;
    for (uint32_t f = 0; f < p->face_count; f++)
        if (p->start[f + 1] < p->start[f] + 3)
            return false;
    for (uint32_t h = 0; h < 2 * p->edge_count; h++)
        if (p->loop[h] >= p->vertex_count)
            return false;
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (p->edge[e].a >= p->vertex_count || p->edge[e].b >= p->vertex_count || p->edge[e].left >= p->face_count ||
            p->edge[e].right >= p->face_count)
            return false;
    return true;
}

static bool numbers_are_sound(const tl_poly *p, size_t joints)
{
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (!tl_v3_finite(p->vertex[v]) || tl_v3_norm(p->vertex[v]) > TL_FARTHEST)
            return false;
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!tl_v3_finite(p->plane[f].normal) || !isfinite(p->plane[f].offset) || p->tag[f].joint > joints)
            return false;
    for (uint32_t f = 0; f < p->face_count; f++)
        if (p->covered[f] > TL_SEAM)
            return false;
    return true;
}

/* The polyhedron of the counts, filled with what comes next of each part. */
static tl_poly *next_shape(reading *r, const shape_counts *c)
{
    tl_poly *p = tl_poly_allocate(c->vertices, c->faces, c->edges);
    if (p && c->seams && !tl_poly_open_seams(p)) {
        tl_poly_free(p);
        p = NULL;
    }
    for (part which = 0; p && which < PARTS; which++) {
        size_t bytes = items_of(c, which) * parts[which].size;
        if (bytes)
            memcpy(place_of(p, which), r->at[which], bytes);
        r->at[which] += bytes;
    }
    return p;
}

static tl_status restore_shape(tl_model *m, uint32_t row, const shape_counts *c, reading *r, const tl_archive *archive)
{
    tl_poly *p = next_shape(r, c);
    if (!p)
        return tl_fail_memory(&m->error);
    m->blocks.shape[row] = p;
    tl_error why = {.status = TL_OK};
    if (!loops_are_sound(p) || !numbers_are_sound(p, m->joint_count))
        return tl_archive_bad(archive, &m->error, "the shape of block %llu is none",
                              (unsigned long long)m->blocks.id[row]);
    tl_poly_find_size(p);
    if (tl_poly_check(p, TL_POLY_BENT, &why) != TL_OK)
        return tl_archive_bad(archive, &m->error, "the shape of block %llu: %s", (unsigned long long)m->blocks.id[row],
                              why.text);
    return TL_OK;
}

static tl_status read_parts(tl_model *m, const shape_counts *counts, reading *r, const tl_archive *archive)
{
    for (part which = 0; which < PARTS; which++) {
        size_t total = 0, size = parts[which].size;
        for (size_t row = 0; row < m->blocks.table.rows; row++)
            total += items_of(&counts[row], which);
        r->all[which] = malloc(total * size + 1);
        if (!r->all[which])
            return tl_fail_memory(&m->error);
        r->at[which] = r->all[which];
        if (!tl_archive_get(archive, parts[which].name, r->all[which], size, total))
            return tl_archive_bad(archive, &m->error, "'%s' does not fit the blocks", parts[which].name);
    }
    return TL_OK;
}

static tl_status read_counts(tl_model *m, shape_counts *counts, const tl_archive *archive)
{
    size_t blocks = m->blocks.table.rows;
    if (!tl_archive_get(archive, "shapes.counts", counts, sizeof *counts, blocks))
        return tl_archive_bad(archive, &m->error, "'shapes.counts' does not fit the blocks");
    for (size_t row = 0; row < blocks; row++)
        if (!count_is_sound(&counts[row]))
            return tl_archive_bad(archive, &m->error, "the shape of block %llu is none",
                                  (unsigned long long)m->blocks.id[row]);
    return TL_OK;
}

static tl_status restore_shapes(tl_model *m, const tl_archive *archive)
{
    size_t blocks = m->blocks.table.rows;
    shape_counts *counts = malloc((blocks + 1) * sizeof *counts);
    reading r = {.all = {NULL}};
    tl_status status = counts ? read_counts(m, counts, archive) : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = read_parts(m, counts, &r, archive);
    for (uint32_t row = 0; row < blocks && status == TL_OK; row++)
        status = restore_shape(m, row, &counts[row], &r, archive);
    for (part which = 0; which < PARTS; which++)
        free(r.all[which]);
    free(counts);
    return status;
}

/* ---------------------------------------------------------------- copying ---------------- */

static tl_status copy_shapes(tl_model *to, const tl_model *from)
{
    for (size_t row = 0; row < to->blocks.table.rows; row++)
        if (!(to->blocks.shape[row] = tl_poly_copy(from->blocks.shape[row])))
            return tl_fail_memory(&to->error);
    return TL_OK;
}

const tl_state_part tl_shapes_part = {save_shapes, restore_shapes, copy_shapes};
