/* line.c - nodes on a line through blocks.
 *
 * The line is cut into ways through blocks: of a rigid one between the first and last of its planes, of a deformable
 * body between the first and last triangle of its surface. Ways through blocks of one body that follow each other are
 * one. A way of length L has n = ceil(L / spacing) equal parts, and nodes at their ends. */
#include "element/line.h"

#include "base/error.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>

/* Tolerance: over the length of the line, ways that are shorter are none, and gaps that are shorter are closed. */
#define NOTHING 1e-9
/* Limit: nodes of one line, above those that an element may have, for lines through many bodies. */
#define MOST_NODES 1000000

/* A way through a block, in parts of the line. */
typedef struct way {
    double begin, end;
    tl_id block;
    uint32_t body;
} way;

typedef struct ways {
    way *at;
    size_t count, capacity;
} ways;

/* The part of a line from a along d, 0 to 1, in a rigid block. */
static bool cross_block(const tl_model *m, uint32_t row, tl_vec3 a, tl_vec3 d, way *out)
{
    const tl_poly *p = m->blocks.shape[row];
    const uint32_t body = m->blocks.body[row];
    const tl_vec3 from = tl_body_local(&m->bodies, body, a), along = tl_m3_tmul(&m->bodies.pose[body].r, d);
    for (uint32_t f = 0; f < p->face_count; f++) {
        const double inside = p->plane[f].offset - tl_v3_dot(p->plane[f].normal, from);
        const double out_of = tl_v3_dot(p->plane[f].normal, along);
        if (out_of > 0)
            out->end = fmin(out->end, inside / out_of);
        else if (out_of < 0)
            out->begin = fmax(out->begin, inside / out_of);
        else if (inside < 0)
            return false;
    }
    return out->end - out->begin > NOTHING;
}

/* Tolerance: a line meets a triangle up to this beyond its sides, over their length, so that none slips between two. */
#define BESIDE 1e-9

/* Where a line from a along d crosses a triangle; NAN: beside it. */
static double cross_triangle(const tl_vec3 x[3], tl_vec3 a, tl_vec3 d)
{
    const tl_vec3 e = tl_v3_sub(x[1], x[0]), f = tl_v3_sub(x[2], x[0]), h = tl_v3_cross(d, f), s = tl_v3_sub(a, x[0]);
    const double det = tl_v3_dot(e, h);
    const tl_vec3 q = tl_v3_cross(s, e);
    const double u = tl_v3_dot(s, h) / det, v = tl_v3_dot(d, q) / det;
    const bool meets = det != 0 && u >= -BESIDE && v >= -BESIDE && u + v <= 1 + BESIDE;
    return meets ? tl_v3_dot(f, q) / det : NAN;
}

static bool cross_mesh(const tl_model *m, const tl_body_mesh *mesh, tl_vec3 a, tl_vec3 d, way *out)
{
    const struct tl_zones *z = m->zones;
    double first = INFINITY, last = -INFINITY;
    for (uint32_t k = mesh->part_begin; k < mesh->part_end; k++) {
        tl_vec3 x[3];
        for (int c = 0; c < 3; c++)
            x[c] = tl_gridpoint_place(&z->points, z->part[k].corner[c]);
        const double t = cross_triangle(x, a, d);
        first = fmin(first, t);
        last = fmax(last, t);
    }
    out->begin = fmax(out->begin, first);
    out->end = fmin(out->end, last);
    return out->end - out->begin > NOTHING;
}

static int compare(const void *a, const void *b)
{
    const way *x = a, *y = b;
    if (x->begin != y->begin)
        return x->begin < y->begin ? -1 : 1;
    return x->block < y->block ? -1 : x->block > y->block;
}

static bool put_way(ways *w, const way *one)
{
    if (!tl_grow(&w->at, &w->capacity, w->count + 1, sizeof *w->at))
        return false;
    w->at[w->count++] = *one;
    return true;
}

/* All ways, in the order of the line; where two bodies overlap the first one goes on. false: out of memory. */
static bool find_ways(const tl_model *m, tl_vec3 a, tl_vec3 d, ways *w)
{
    bool enough = true;
    for (uint32_t row = 0; row < m->blocks.table.rows && enough; row++) {
        const uint32_t body = m->blocks.body[row], mesh = m->bodies.mesh[body];
        way one = {0, 1, m->blocks.id[row], body};
        if (mesh ? m->zones->mesh[mesh - 1].body == one.block && cross_mesh(m, &m->zones->mesh[mesh - 1], a, d, &one)
                 : cross_block(m, row, a, d, &one))
            enough = put_way(w, &one);
    }
    if (w->count > 1)
        qsort(w->at, w->count, sizeof *w->at, compare);
    size_t kept = 0;
    for (size_t k = 0; k < w->count; k++) {
        way one = w->at[k];
        if (kept)
            one.begin = fmax(one.begin, w->at[kept - 1].end);
        if (one.end - one.begin > NOTHING)
            w->at[kept++] = one;
    }
    w->count = kept;
    return enough;
}

/* Adds the nodes of ways [first, end), which follow each other in one body. */
static bool put_nodes(tl_placing *p, const ways *w, size_t first, size_t end, tl_vec3 from, tl_vec3 d, double spacing,
                      size_t *count)
{
    const double length = tl_v3_norm(d), begin = w->at[first].begin, stop = w->at[end - 1].end;
    const double parts = fmax(1, ceil((stop - begin) * length / spacing * (1 - NOTHING)));
    if (!(parts < MOST_NODES) || !tl_grow(&p->line, &p->line_capacity, *count + (size_t)parts + 1, sizeof *p->line))
        return false;
    for (size_t i = 0, at = first; i <= (size_t)parts; i++) {
        const double t = i == (size_t)parts ? stop : begin + (stop - begin) * (double)i / parts;
        while (at + 1 < end && w->at[at].end < t)
            at++;
        const bool ends = i == 0 || i == (size_t)parts;
        p->line[(*count)++] = (tl_line_node){.block = w->at[at].block,
                                             .passes = (i == 0 && t > 0) || (i == (size_t)parts && t < 1),
                                             .place = tl_v3_madd(from, t, d),
                                             .at = t * length,
                                             .length = (ends ? 0.5 : 1) * (stop - begin) * length / parts};
    }
    return true;
}

tl_status tl_line_find(tl_placing *p, tl_vec3 from, tl_vec3 to, double spacing, size_t *count)
{
    tl_model *m = p->m;
    const tl_vec3 d = tl_v3_sub(to, from);
    ways w = {0};
    *count = 0;
    if (!(tl_v3_norm(d) > 0 && tl_v3_finite(from) && tl_v3_finite(to)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "the line from (%g, %g, %g) to (%g, %g, %g) has no length", from.x,
                       from.y, from.z, to.x, to.y, to.z);
    if (!(spacing > 0))
        return tl_fail(&m->error, TL_E_ARGUMENT, "spacing = %g m must be above 0", spacing);
    if (tl_v3_norm(d) / spacing >= MOST_NODES)
        return tl_fail(&m->error, TL_E_ARGUMENT, "spacing = %g m gives more than %d nodes on %g m: make it longer",
                       spacing, MOST_NODES, tl_v3_norm(d));
    bool enough = find_ways(m, tl_v3_sub(from, m->origin), d, &w);
    for (size_t k = 0; k < w.count && enough;) {
        size_t end = k + 1;
        while (end < w.count && w.at[end].body == w.at[k].body && w.at[end].begin - w.at[end - 1].end <= NOTHING)
            end++;
        enough = put_nodes(p, &w, k, end, from, d, spacing, count);
        k = end;
    }
    free(w.at);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}
