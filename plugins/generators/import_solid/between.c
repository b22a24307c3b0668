/* between.c - vertices that lie on the edge of a face, between its ends, become corners of that face.
 *
 * Where one face has a whole edge, and its neighbours have parts of it, no edge has two faces, and the surface seems
 * open. Drawings have such edges where faces were merged or divided on one side only. An edge of one face takes up the
 * ends of other such edges that lie within `weld` of it. Edges of closed surfaces stay as they are. */
#include "solids.h"

#include <stdlib.h>
#include <talus/kit.h>

/* An edge of one face. */
typedef struct open_edge {
    uint32_t half;
    uint32_t first, count; /* what it takes up, of the list of `taken` */
} open_edge;

typedef struct edge_vertex {
    uint32_t vertex;
    double along; /* share of the edge, from its beginning */
} edge_vertex;

typedef struct edge_search {
    const mesh *m;
    double weld;
    open_edge *edge;
    uint32_t *end; /* vertices at the ends of these edges, by their x */
    size_t edges, ends;
    edge_vertex *taken;
    size_t takes, capacity;
} edge_search;

typedef struct placed_vertex {
    double x;
    uint32_t vertex;
} placed_vertex;

static int by_x(const void *left, const void *right)
{
    const placed_vertex *a = left, *b = right;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static int by_place(const void *left, const void *right)
{
    const edge_vertex *a = left, *b = right;
    if (a->along != b->along)
        return a->along < b->along ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

/* Lists the vertices at the ends of open edges, each once. */
static bool list_ends(edge_search *f)
{
    const mesh *m = f->m;
    placed_vertex *all = malloc((2 * f->edges + 1) * sizeof *all);
    f->end = malloc((2 * f->edges + 1) * sizeof *f->end);
    for (size_t i = 0; i < f->edges && all && f->end; i++) {
        const uint32_t h = f->edge[i].half, ends[2] = {m->corner[h], m->corner[mesh_next(m, h)]};
        for (int k = 0; k < 2; k++)
            all[2 * i + (size_t)k] = (placed_vertex){m->vertex[ends[k]].x, ends[k]};
    }
    if (!all || !f->end) {
        free(all);
        return false;
    }
    qsort(all, 2 * f->edges, sizeof *all, by_x);
    for (size_t i = 0; i < 2 * f->edges; i++)
        if (i == 0 || all[i].vertex != all[i - 1].vertex)
            f->end[f->ends++] = all[i].vertex;
    free(all);
    return true;
}

/* The first of the ends whose x is not below a value. */
static size_t first_from(const edge_search *f, double x)
{
    size_t low = 0, high = f->ends;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (f->m->vertex[f->end[middle]].x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Lists what an edge takes up, in the order in which it runs. */
static bool find_between(edge_search *f, open_edge *edge)
{
    const mesh *m = f->m;
    const tl_vec3 a = m->vertex[m->corner[edge->half]], b = m->vertex[m->corner[mesh_next(m, edge->half)]];
    const tl_vec3 ab = tl_v3_sub(b, a);
    const double length2 = tl_v3_norm2(ab), weld2 = f->weld * f->weld;
    edge->first = (uint32_t)f->takes;
    for (size_t i = first_from(f, fmin(a.x, b.x) - f->weld); i < f->ends && length2 > 0; i++) {
        const tl_vec3 at = m->vertex[f->end[i]];
        if (at.x > fmax(a.x, b.x) + f->weld)
            break;
        const tl_vec3 from = tl_v3_sub(at, a);
        const double along = tl_v3_dot(from, ab) / length2;
        if (!(along > 0 && along < 1) || tl_v3_norm2(from) <= weld2 || tl_v3_norm2(tl_v3_sub(at, b)) <= weld2 ||
            tl_v3_norm2(tl_v3_sub(from, tl_v3_scale(along, ab))) > weld2)
            continue;
        edge_vertex *list = tl_grown(f->taken, &f->capacity, f->takes + 1, sizeof *list);
        if (!list)
            return false;
        f->taken = list;
        list[f->takes++] = (edge_vertex){f->end[i], along};
    }
    edge->count = (uint32_t)(f->takes - edge->first);
    if (edge->count > 1)
        qsort(f->taken + edge->first, edge->count, sizeof *f->taken, by_place);
    return true;
}

/* Lays the corners of all faces anew, from the last one on, with those that edges take up. */
static void put_between(mesh *m, const edge_search *f)
{
    size_t to = m->corners + f->takes, edge = f->edges;
    m->corners = to;
    for (size_t face = m->faces; face-- > 0;) {
        shell_face *of = &m->face[face];
        const size_t last = to;
        for (uint32_t h = of->first + of->count; h-- > of->first;) {
            const open_edge *e = edge > 0 && f->edge[edge - 1].half == h ? &f->edge[--edge] : NULL;
            for (uint32_t k = e ? e->count : 0; k-- > 0;)
                m->corner[--to] = f->taken[e->first + k].vertex;
            m->corner[--to] = m->corner[h];
        }
        of->first = (uint32_t)to;
        of->count = (uint32_t)(last - to);
        for (size_t h = to; h < last; h++)
            m->face_of[h] = (uint32_t)face;
    }
}

bool mesh_take_between(mesh *m, const uint32_t *open, size_t count, double weld, uint32_t *takes)
{
    edge_search f = {.m = m, .weld = weld, .edges = count};
    f.edge = malloc((count + 1) * sizeof *f.edge);
    bool good = f.edge != NULL;
    for (size_t i = 0; i < count && good; i++)
        f.edge[i] = (open_edge){.half = open[i]};
    good = good && list_ends(&f);
    for (size_t i = 0; i < count && good; i++)
        good = find_between(&f, &f.edge[i]);
    good = good && m->corners + f.takes < MOST_CORNERS && (f.takes == 0 || mesh_room(m, m->corners + f.takes));
    if (good && f.takes > 0)
        put_between(m, &f);
    *takes = (uint32_t)f.takes;
    free(f.taken);
    free(f.end);
    free(f.edge);
    return good;
}
