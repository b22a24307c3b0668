/* sides.c - from the closed shells of an object to solids: faces in one plane become one side.
 *
 * Sides grow over the edges that turn least, as long as all their corners keep within `flat` of one plane. Slivers know
 * no plane of their own, and join that which they miss least. A side with one loop becomes one face. One with holes
 * keeps its faces. A vertex where fewer than three sides meet lies on an edge and is left out. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Tolerance: faces that turn by more than asin of this are no one side, however small they are: 30 degrees. */
#define MOST_TURN 0.5
/* Tolerance: a face may be off its plane by this times the size of its shell, whatever `flat` is. The faces of a block
 * of Talus are bent by up to this, and a file of them comes in again. Test: lua/test_round_trips. */
#define BENT 1e-4
/* Cost only: a side so many times larger than another keeps its plane when that joins it. */
#define LARGER 8
/* Limit: most corners of a block. */
#define MOST_BLOCK 4096

typedef struct edge {
    double turn;
    uint32_t half;
} edge;

/* Sides while they grow: sets of faces, each with a ring of them and the sums over its corners. */
typedef struct grower {
    solids *s;
    mesh *m;
    uint32_t object;
    uint32_t *root, *ring, *size; /* [faces] */
    cloud *sum;
    plane *plane;
    tl_vec3 *area;
    bool *sliver;
    edge *edge;
    uint32_t *number; /* [vertices] in the solid; scratch */
    uint64_t *meets;  /* [corners] */
    bool *whole;      /* [faces] of a side's root: it has one loop */
    bool *tried;      /* [faces] of a side's root: a loop of it was walked */
    void *memory[12];
} grower;

static bool begin(grower *g)
{
    size_t f = g->m->faces + 1, c = g->m->corners + 1;
    const size_t bytes[] = {f * sizeof *g->root,   f * sizeof *g->ring,  f * sizeof *g->size,   f * sizeof *g->sum,
                            f * sizeof *g->plane,  f * sizeof *g->area,  f * sizeof *g->sliver, c * sizeof *g->edge,
                            c * sizeof *g->number, c * sizeof *g->meets, f * sizeof *g->whole,  f * sizeof *g->tried};
    bool all = true;
    for (size_t i = 0; i < 12; i++) {
        g->memory[i] = malloc(bytes[i]);
        all = all && g->memory[i];
    }
    g->root = g->memory[0];
    g->ring = g->memory[1];
    g->size = g->memory[2];
    g->sum = g->memory[3];
    g->plane = g->memory[4];
    g->area = g->memory[5];
    g->sliver = g->memory[6];
    g->edge = g->memory[7];
    g->number = g->memory[8];
    g->meets = g->memory[9];
    g->whole = g->memory[10];
    g->tried = g->memory[11];
    return all;
}

static uint32_t root_of(const grower *g, uint32_t face)
{
    while (g->root[face] != face)
        face = g->root[face] = g->root[g->root[face]];
    return face;
}

/* How far the corners of a side lie off a plane. */
static double off_plane(const grower *g, uint32_t side, const plane *p)
{
    const mesh *m = g->m;
    double off = 0;
    uint32_t face = side;
    do {
        const shell_face *f = &m->face[face];
        for (uint32_t h = f->first; h < f->first + f->count; h++)
            off = fmax(off, fabs(plane_above(p, m->vertex[m->corner[h]])));
        face = g->ring[face];
    } while (face != side);
    return off;
}

/* Makes one side of two, with a plane. */
static void join(grower *g, uint32_t a, uint32_t b, const plane *p)
{
    uint32_t keep = g->size[a] >= g->size[b] ? a : b, lose = keep == a ? b : a, next = g->ring[keep];
    g->ring[keep] = g->ring[lose];
    g->ring[lose] = next;
    g->root[lose] = keep;
    g->size[keep] += g->size[lose];
    g->area[keep] = tl_v3_add(g->area[keep], g->area[lose]);
    cloud_join(&g->sum[keep], &g->sum[lose]);
    g->plane[keep] = *p;
    g->sliver[keep] = g->sliver[keep] && g->sliver[lose];
}

/* Joins two sides that lie in one plane. */
static void try_join(grower *g, uint32_t a, uint32_t b)
{
    const double flat = g->s->flat;
    if (a == b || tl_v3_dot(g->plane[a].normal, g->plane[b].normal) < 1 - MOST_TURN * MOST_TURN / 2)
        return;
    uint32_t large = g->size[a] >= g->size[b] ? a : b, small = large == a ? b : a;
    plane p = g->plane[large];
    if (g->size[large] < LARGER * g->size[small]) {
        cloud both = g->sum[a];
        cloud_join(&both, &g->sum[b]);
        p = cloud_plane(&both, tl_v3_add(g->area[a], g->area[b]));
        if (off_plane(g, large, &p) > flat)
            return;
    }
    if (off_plane(g, small, &p) <= flat)
        join(g, a, b, &p);
}

static int by_turn(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    if (a->turn < b->turn || a->turn > b->turn)
        return a->turn < b->turn ? -1 : 1;
    return (a->half > b->half) - (a->half < b->half);
}

/* Lets each sliver join the neighbour from whose plane it is least far. */
static void join_slivers(grower *g)
{
    const mesh *m = g->m;
    for (bool more = true; more;) {
        more = false;
        for (uint32_t face = 0; face < m->faces; face++) {
            if (g->root[face] != face || !g->sliver[face])
                continue;
            uint32_t best = NONE;
            double least = g->s->flat;
            const shell_face *f = &m->face[face];
            for (uint32_t h = f->first; h < f->first + f->count; h++) {
                uint32_t other = root_of(g, m->face_of[m->mate[h]]);
                double off = g->sliver[other] ? (double)INFINITY : off_plane(g, face, &g->plane[other]);
                if (off <= least && other != face) {
                    least = off;
                    best = other;
                }
            }
            if (best == NONE)
                continue;
            plane p = g->plane[best];
            join(g, best, face, &p);
            more = true;
        }
    }
}

static void grow(grower *g)
{
    const mesh *m = g->m;
    size_t edges = 0;
    for (uint32_t face = 0; face < m->faces; face++) {
        const shell_face *f = &m->face[face];
        g->root[face] = g->ring[face] = face;
        g->size[face] = 1;
        g->area[face] = f->area;
        g->sum[face] = (cloud){.zero = m->vertex[m->corner[f->first]]};
        for (uint32_t h = f->first; h < f->first + f->count; h++)
            cloud_add(&g->sum[face], m->vertex[m->corner[h]]);
        g->plane[face] = cloud_plane(&g->sum[face], f->area);
        g->sliver[face] = !(tl_v3_norm(f->area) > fmax(g->s->flat, 1e-9 * f->longest) * f->longest);
    }
    for (uint32_t h = 0; h < m->corners; h++) {
        uint32_t a = m->face_of[h], b = m->face_of[m->mate[h]];
        if (h < m->mate[h] && !g->sliver[a] && !g->sliver[b])
            g->edge[edges++] = (edge){-tl_v3_dot(g->plane[a].normal, g->plane[b].normal), h};
    }
    qsort(g->edge, edges, sizeof *g->edge, by_turn);
    for (size_t i = 0; i < edges; i++)
        try_join(g, root_of(g, m->face_of[g->edge[i].half]), root_of(g, m->face_of[m->mate[g->edge[i].half]]));
    join_slivers(g);
}

/* ---------------------------------------------------------------- solids ----------------- */

/* The half-edge after h along the border of its side. */
static uint32_t border_next(const grower *g, uint32_t h)
{
    const mesh *m = g->m;
    uint32_t side = root_of(g, m->face_of[h]), next = mesh_next(m, h);
    while (root_of(g, m->face_of[m->mate[next]]) == side)
        next = mesh_next(m, m->mate[next]);
    return next;
}

static bool on_border(const grower *g, uint32_t h)
{
    return root_of(g, g->m->face_of[h]) != root_of(g, g->m->face_of[g->m->mate[h]]);
}

/* Marks the sides that have one loop: walking it meets all their borders. */
static void find_whole(grower *g)
{
    const mesh *m = g->m;
    for (uint32_t f = 0; f < m->faces; f++) {
        g->size[f] = 0; /* borders of a side, from here on */
        g->whole[f] = g->tried[f] = false;
    }
    for (uint32_t h = 0; h < m->corners; h++)
        g->size[root_of(g, m->face_of[h])] += on_border(g, h);
    for (uint32_t h = 0; h < m->corners; h++) {
        uint32_t side = root_of(g, m->face_of[h]), at = h, count = 0;
        if (!on_border(g, h) || g->tried[side])
            continue;
        g->tried[side] = true;
        do {
            at = border_next(g, at);
            count++;
        } while (at != h && count <= g->size[side]);
        g->whole[side] = count == g->size[side];
    }
}

static int by_value(const void *left, const void *right)
{
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* Numbers the vertices of a shell that stay, and adds them to the solids. */
static bool add_vertices(grower *g, uint32_t shell, size_t *count)
{
    const mesh *m = g->m;
    solids *s = g->s;
    size_t meets = 0;
    *count = 0;
    for (uint32_t f = 0; f < m->faces; f++) {
        const shell_face *face = &m->face[f];
        uint32_t side = root_of(g, f);
        for (uint32_t h = face->first; face->shell == shell && h < face->first + face->count; h++) {
            g->number[m->corner[h]] = NONE;
            g->meets[meets++] = (uint64_t)m->corner[h] << 32 | side;
        }
    }
    qsort(g->meets, meets, sizeof *g->meets, by_value);
    for (size_t from = 0, to = 0; from < meets; from = to) {
        size_t sides = 0;
        uint32_t v = (uint32_t)(g->meets[from] >> 32);
        bool whole = true;
        for (; to < meets && (uint32_t)(g->meets[to] >> 32) == v; to++) {
            sides += to == from || g->meets[to] != g->meets[to - 1];
            whole = whole && g->whole[(uint32_t)g->meets[to]];
        }
        if (sides < 3 && whole)
            continue;
        tl_vec3 *list =
            s->vertices < MOST_CORNERS ? tl_grown(s->vertex, &s->vertex_capacity, s->vertices + 1, sizeof *list) : NULL;
        if (!list)
            return false;
        s->vertex = list;
        g->number[v] = (uint32_t)(*count)++;
        list[s->vertices++] = m->vertex[v];
    }
    return true;
}

static bool add_corner(solids *s, uint32_t vertex)
{
    uint32_t *list =
        s->corners < MOST_CORNERS ? tl_grown(s->corner, &s->corner_capacity, s->corners + 1, sizeof *list) : NULL;
    if (!list)
        return false;
    s->corner = list;
    list[s->corners++] = vertex;
    return true;
}

/* Ends the face of which corners have been added; one of fewer than three is dropped. */
static bool end_face(solids *s, uint32_t side)
{
    uint32_t first = s->faces ? s->start[s->faces] : 0;
    if (s->corners < first + 3) {
        s->corners = first;
        return true;
    }
    uint32_t *start = tl_grown(s->start, &s->start_capacity, s->faces + 2, sizeof *start);
    s->start = start ? start : s->start;
    uint32_t *sides = tl_grown(s->side, &s->side_capacity, s->faces + 1, sizeof *sides);
    s->side = sides ? sides : s->side;
    if (!start || !sides)
        return false;
    s->start[0] = 0;
    s->side[s->faces++] = side;
    s->start[s->faces] = (uint32_t)s->corners;
    return true;
}

/* Adds the faces of a side: one around its loop, or its own ones. */
static bool add_side(grower *g, uint32_t side, uint32_t number)
{
    const mesh *m = g->m;
    bool good = true;
    uint32_t face = side, first = NONE;
    do {
        const shell_face *f = &m->face[face];
        for (uint32_t h = f->first; h < f->first + f->count && good; h++) {
            if (!g->whole[side] && g->number[m->corner[h]] != NONE)
                good = add_corner(g->s, g->number[m->corner[h]]);
            if (g->whole[side] && first == NONE && on_border(g, h))
                first = h;
        }
        if (!g->whole[side] && good)
            good = end_face(g->s, number);
        face = g->ring[face];
    } while (face != side && good);
    if (!g->whole[side] || first == NONE)
        return good;
    uint32_t h = first;
    do {
        if (g->number[m->corner[h]] != NONE)
            good = good && add_corner(g->s, g->number[m->corner[h]]);
        h = border_next(g, h);
    } while (h != first && good);
    return good && end_face(g->s, number);
}

/* How far the corners of a face reach above a plane through a point. */
static double reach_above(const mesh *m, uint32_t face, tl_vec3 normal, tl_vec3 on)
{
    double above = 0;
    const shell_face *f = &m->face[face];
    for (uint32_t h = f->first; h < f->first + f->count; h++)
        above = fmax(above, tl_v3_dot(normal, tl_v3_sub(m->vertex[m->corner[h]], on)));
    return above;
}

/* Notes an edge at which the shell bends inward by more than `flat`. */
static void find_reflex(const grower *g, uint32_t shell, solid *made)
{
    const mesh *m = g->m;
    for (uint32_t h = 0; h < m->corners && !made->reflex; h++) {
        uint32_t a = m->face_of[h], b = m->face_of[m->mate[h]];
        if (m->face[a].shell != shell || h > m->mate[h] || !on_border(g, h))
            continue;
        tl_vec3 on = m->vertex[m->corner[h]];
        double above = fmin(reach_above(m, b, g->plane[root_of(g, a)].normal, on),
                            reach_above(m, a, g->plane[root_of(g, b)].normal, on));
        made->reflex = above > 2 * g->s->flat;
        made->reflex_at[0] = on;
        made->reflex_at[1] = m->vertex[m->corner[mesh_next(m, h)]];
    }
}

/* The size of a shell: the diagonal of its bounds. */
static double shell_size(const mesh *m, uint32_t shell)
{
    tl_vec3 min = {INFINITY, INFINITY, INFINITY}, max = tl_v3_neg(min);
    for (uint32_t h = 0; h < m->corners; h++)
        if (m->face[m->face_of[h]].shell == shell) {
            min = tl_v3_min(min, m->vertex[m->corner[h]]);
            max = tl_v3_max(max, m->vertex[m->corner[h]]);
        }
    return tl_v3_norm(tl_v3_sub(max, min));
}

/* Refuses a side of which a face of four corners or more is off its plane. */
static tl_status check_flat(grower *g, uint32_t shell, bool *taken)
{
    const mesh *m = g->m;
    double worst = g->s->flat;
    uint32_t at = NONE;
    for (uint32_t f = 0; f < m->faces; f++) {
        if (m->face[f].shell != shell || m->face[f].count < 4)
            continue;
        cloud sum = {.zero = m->vertex[m->corner[m->face[f].first]]};
        for (uint32_t h = m->face[f].first; h < m->face[f].first + m->face[f].count; h++)
            cloud_add(&sum, m->vertex[m->corner[h]]);
        plane p = cloud_plane(&sum, m->face[f].area);
        double off = 0;
        for (uint32_t h = m->face[f].first; h < m->face[f].first + m->face[f].count; h++)
            off = fmax(off, fabs(plane_above(&p, m->vertex[m->corner[h]])));
        if (off > worst) {
            worst = off;
            at = f;
        }
    }
    if (at == NONE || worst <= BENT * shell_size(m, shell))
        return TL_OK;
    *taken = false;
    tl_vec3 p = m->vertex[m->corner[m->face[at].first]];
    return refuse_object(g->s, g->object, 1.01 * worst,
                         ": the face at {%.6g, %.6g, %.6g} is off its plane by %.3g m; flat = %.3g would take it", p.x,
                         p.y, p.z, worst, 1.01 * worst);
}

static tl_status add_shell(grower *g, uint32_t shell)
{
    solids *s = g->s;
    const mesh *m = g->m;
    bool taken = true;
    tl_status status = check_flat(g, shell, &taken);
    if (status != TL_OK || !taken)
        return status;
    solid *list = tl_grown(s->solid, &s->solid_capacity, s->solids + 1, sizeof *list);
    if (!list)
        return soup_no_memory(&s->soup);
    s->solid = list;
    solid *made = &list[s->solids];
    *made = (solid){.object = g->object,
                    .shell = shell,
                    .vertex = (uint32_t)s->vertices,
                    .face = (uint32_t)s->faces,
                    .plane = (uint32_t)s->planes};
    const size_t corners = s->corners;
    size_t vertices;
    uint32_t sides = 0;
    bool good = add_vertices(g, shell, &vertices);
    for (uint32_t f = 0; f < m->faces && good; f++) {
        if (m->face[f].shell != shell || root_of(g, f) != f)
            continue;
        const size_t before = s->faces;
        plane *planes = tl_grown(s->plane, &s->plane_capacity, s->planes + 1, sizeof *planes);
        s->plane = planes ? planes : s->plane;
        good = planes && add_side(g, f, sides);
        if (!good || s->faces == before)
            continue;
        planes[s->planes] = g->plane[f];
        planes[s->planes].group = (uint32_t)s->planes;
        s->planes++;
        sides++;
    }
    if (!good)
        return soup_no_memory(&s->soup);
    find_reflex(g, shell, made);
    if (vertices >= 4 && sides >= 4 && vertices <= MOST_BLOCK) {
        s->solids++;
        return TL_OK;
    }
    s->vertices = made->vertex;
    s->faces = made->face;
    s->planes = made->plane;
    s->corners = corners;
    if (vertices > MOST_BLOCK)
        return refuse_object(s, g->object, 0, " has more than %d corners; give it fewer and larger faces", MOST_BLOCK);
    return refuse_object(s, g->object, 0, " is flat within flat = %.3g m; remove it, or set flat lower", s->flat);
}

tl_status sides_add(solids *s, uint32_t object, mesh *m)
{
    grower g = {.s = s, .m = m, .object = object};
    tl_status status = begin(&g) ? TL_OK : soup_no_memory(&s->soup);
    if (status == TL_OK) {
        size_t sides = 0;
        grow(&g);
        for (uint32_t f = 0; f < m->faces; f++)
            sides += g.root[f] == f;
        s->done[object].merged = (uint32_t)(m->faces - sides);
        find_whole(&g);
    }
    for (uint32_t shell = 0; shell < m->shells && status == TL_OK; shell++)
        status = add_shell(&g, shell);
    for (size_t i = 0; i < 12; i++)
        free(g.memory[i]);
    return status;
}
