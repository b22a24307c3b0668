/* seam.c - a body made of several convex polyhedra: which of their faces and edges are inside it.
 *
 * A face is covered when faces of other parts, in the same plane and facing it, overlap all of its area. It is a seam
 * when these are covered as well; a smaller face on a larger one is none.
 * An edge of a covered face is hidden unless the surface turns outward there, from the edge's other face
 * to a face of another part. Covered faces and hidden edges are no directions in which the body could
 * part from another: a block that slides over a seam must not feel it. */
#include "geometry/polyhedron.h"

#include "base/error.h"
#include "geometry/assemble.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Parts fit when planes and corners agree within this times their size: joined blocks were cut by one
 * plane, or were placed in contact by coordinates of six digits. */
#define FIT 1e-6
/* What parts of one body may have between them and hang together, over the smaller one's size: a gap, an overlap, and the sine of the
 * angle between their faces. They may have been joined after they had settled on each other. */
#define JOINED_GAP 1e-3
#define JOINED_OVERLAP 1e-2
#define JOINED_TILT 1e-2
/* Share of a face's area that may stay uncovered. */
#define UNCOVERED 1e-5

typedef struct flat {
    double x, y;
} flat;

typedef struct frame {
    tl_vec3 o, t1, t2;
} frame;

static flat flatten(const frame *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (flat){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

static double turn(flat o, flat a, flat b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Keeps what lies left of the line from o to q; returns the number of corners. */
static size_t keep_left(const flat *in, size_t count, flat o, flat q, flat *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        flat here = in[i], after = in[(i + 1) % count];
        double h = turn(o, q, here), a = turn(o, q, after);
        if (h >= 0)
            out[kept++] = here;
        if ((h > 0 && a < 0) || (h < 0 && a > 0)) {
            double t = h / (h - a);
            out[kept++] = (flat){here.x + t * (after.x - here.x), here.y + t * (after.y - here.y)};
        }
    }
    return kept;
}

static double flat_area(const flat *c, size_t count)
{
    double area = 0;
    for (size_t i = 1; i + 1 < count; i++)
        area += 0.5 * turn(c[0], c[i], c[i + 1]);
    return area;
}

/* Area common to face fa of a and face fb of b, which face each other in one plane. `scratch` holds twice
 * as many corners as both faces have. */
static double common_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb,
                          flat *scratch)
{
    uint32_t na = tl_poly_face_size(a, fa), nb = tl_poly_face_size(b, fb);
    tl_vec3 n = a->plane[fa].normal;
    frame f = {.o = a->vertex[a->loop[a->start[fa]]], .t1 = tl_v3_perpendicular(n)};
    f.t2 = tl_v3_cross(n, f.t1);
    flat *now = scratch, *next = scratch + na + nb;
    size_t count = na;
    for (uint32_t i = 0; i < na; i++)
        now[i] = flatten(&f, a->vertex[a->loop[a->start[fa] + i]]);
    for (uint32_t i = 0; i < nb && count; i++) {
        /* b's loop runs the other way round as seen from a */
        flat o = flatten(&f, b->vertex[b->loop[b->start[fb] + (i + 1) % nb]]);
        flat q = flatten(&f, b->vertex[b->loop[b->start[fb] + i]]);
        count = keep_left(now, count, o, q, next);
        flat *swap = now;
        now = next;
        next = swap;
    }
    return flat_area(now, count);
}

static bool face_each_other(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb)
{
    tl_plane p = a->plane[fa], q = b->plane[fb];
    double size = fmin(a->size, b->size);
    return tl_v3_norm(tl_v3_add(p.normal, q.normal)) < FIT &&
           fabs(p.offset + q.offset) < FIT * size;
}

/* Area common to two faces that face each other, in the plane of the first; false when out of memory. */
static bool face_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *area)
{
    size_t corners = tl_poly_face_size(a, fa) + tl_poly_face_size(b, fb);
    flat *scratch = malloc(4 * corners * sizeof *scratch);
    if (!scratch)
        return false;
    *area = common_area(a, fa, b, fb, scratch);
    free(scratch);
    return true;
}

bool tl_poly_shared_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *area)
{
    *area = 0;
    return !face_each_other(a, fa, b, fb) || face_area(a, fa, b, fb, area);
}

typedef struct part {
    tl_poly *poly;
    tl_bounds bounds;
    double *open;    /* [faces] area not covered yet */
    uint8_t *hidden; /* [edges] of the polyhedron, when it has seams */
    uint32_t index;
    struct part *group; /* towards the first part it hangs together with */
    tl_sever_fn severs;
    const void *user;
} part;

static bool apart(const part *a, const part *b, double fit)
{
    double slack = fit * fmax(a->poly->size, b->poly->size);
    return a->bounds.min.x > b->bounds.max.x + slack || b->bounds.min.x > a->bounds.max.x + slack ||
           a->bounds.min.y > b->bounds.max.y + slack || b->bounds.min.y > a->bounds.max.y + slack ||
           a->bounds.min.z > b->bounds.max.z + slack || b->bounds.min.z > a->bounds.max.z + slack;
}

static part *root(part *p)
{
    while (p->group != p)
        p = p->group;
    return p;
}

/* One group of the two, named by the part that comes first. */
static void unite(part *a, part *b)
{
    part *x = root(a), *y = root(b);
    if (x->index < y->index)
        y->group = x;
    else
        x->group = y;
}

static bool is_severed(const part *p, uint32_t face)
{
    return p->severs && p->severs(p->user, p->poly->tag[face]);
}

/* Adds up what the parts cover of each other. */
static bool cover(part *a, part *b)
{
    for (uint32_t i = 0; i < a->poly->face_count; i++)
        for (uint32_t j = 0; j < b->poly->face_count; j++) {
            double area;
            if (!tl_poly_shared_area(a->poly, i, b->poly, j, &area))
                return false;
            a->open[i] -= area;
            b->open[j] -= area;
        }
    return true;
}

/* Whether face f of a and face g of b face each other closely enough to hold parts of one body together. */
static bool may_hold(const tl_poly *a, uint32_t f, const tl_poly *b, uint32_t g)
{
    tl_plane p = a->plane[f];
    double size = fmin(a->size, b->size), low = INFINITY, high = -INFINITY;
    if (tl_v3_norm(tl_v3_add(p.normal, b->plane[g].normal)) > JOINED_TILT)
        return false;
    for (uint32_t h = b->start[g]; h < b->start[g + 1]; h++) {
        double height = tl_v3_dot(p.normal, b->vertex[b->loop[h]]) - p.offset;
        low = fmin(low, height);
        high = fmax(high, height);
    }
    return low <= JOINED_GAP * size && high >= -JOINED_OVERLAP * size;
}

/* Groups parts that lie on each other with an area, however they had settled when they were joined. */
static bool hold(part *a, part *b)
{
    for (uint32_t i = 0; i < a->poly->face_count; i++)
        for (uint32_t j = 0; j < b->poly->face_count && root(a) != root(b); j++) {
            double area, least = UNCOVERED *
                                 fmin(tl_poly_face_area(a->poly, i), tl_poly_face_area(b->poly, j));
            if (is_severed(a, i) || is_severed(b, j) || !may_hold(a->poly, i, b->poly, j))
                continue;
            if (!face_area(a->poly, i, b->poly, j, &area))
                return false;
            if (area > least)
                unite(a, b);
        }
    return true;
}

static int compare_part(const void *x, const void *y)
{
    const part *p = x, *q = y;
    double a = p->bounds.min.x, b = q->bounds.min.x;
    if (a < b || a > b)
        return a < b ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index); /* the same order from every qsort */
}

/* Calls `visit` for every two parts whose bounds, grown by `fit` times the size, meet; parts are sorted by their low x. */
static bool each_pair(part *parts, size_t count, double fit, bool (*visit)(part *, part *))
{
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++) {
            double slack = fit * fmax(parts[i].poly->size, parts[j].poly->size);
            if (parts[j].bounds.min.x > parts[i].bounds.max.x + slack)
                break;
            if (!apart(&parts[i], &parts[j], fit) && !visit(&parts[i], &parts[j]))
                return false;
        }
    return true;
}

/* True when face g of b goes on outward from face f of a beyond the edge whose middle is x; `seam` is the
 * covered face of a at the edge. */
static bool turns_outward(const tl_poly *a, uint32_t f, uint32_t seam, const tl_poly *b, uint32_t g,
                          tl_vec3 x)
{
    double slack = FIT * fmin(a->size, b->size);
    tl_plane q = b->plane[g];
    if (b->covered[g] || face_each_other(a, seam, b, g) ||
        fabs(tl_v3_dot(q.normal, x) - q.offset) > slack)
        return false;
    uint32_t start = b->start[g], count = tl_poly_face_size(b, g);
    for (uint32_t i = 0; i < count; i++) {
        tl_vec3 c = b->vertex[b->loop[start + i]];
        tl_vec3 along = tl_v3_sub(b->vertex[b->loop[start + (i + 1) % count]], c);
        tl_vec3 inward = tl_v3_unit(tl_v3_cross(q.normal, along));
        if (tl_v3_dot(inward, tl_v3_sub(x, c)) < -slack)
            return false;
    }
    tl_plane p = a->plane[f];
    return tl_v3_dot(p.normal, tl_poly_face_centroid(b, g)) - p.offset < -slack;
}

/* Shows the hidden edges of a again where the body turns outward over b. */
static void show_edges(const part *of, const tl_poly *b)
{
    const tl_poly *a = of->poly;
    for (uint32_t e = 0; e < a->edge_count && a->seams; e++) {
        const tl_edge *edge = &a->edge[e];
        bool left = a->covered[edge->left], right = a->covered[edge->right];
        if (left == right)
            continue;
        tl_vec3 x = tl_v3_scale(0.5, tl_v3_add(a->vertex[edge->a], a->vertex[edge->b]));
        for (uint32_t g = 0; g < b->face_count && a->hidden[e]; g++)
            of->hidden[e] = !turns_outward(a, left ? edge->right : edge->left,
                                           left ? edge->left : edge->right, b, g, x);
    }
}

static bool show(part *a, part *b)
{
    show_edges(a, b->poly);
    show_edges(b, a->poly);
    return true;
}

static bool is_covered(const part *p, uint32_t face)
{
    return p->open[face] < UNCOVERED * tl_poly_face_area(p->poly, face);
}

/* false without memory. */
static bool mark(part *p)
{
    tl_poly *poly = p->poly;
    uint32_t first = 0;
    while (first < poly->face_count && !is_covered(p, first))
        first++;
    if (first == poly->face_count)
        return true;
    p->hidden = tl_poly_open_seams(poly);
    if (!p->hidden)
        return false;
    for (uint32_t f = first; f < poly->face_count; f++)
        p->hidden[f] = is_covered(p, f) ? TL_SEAM : 0;
    p->hidden += poly->face_count;
    for (uint32_t e = 0; e < poly->edge_count; e++)
        p->hidden[e] = poly->covered[poly->edge[e].left] || poly->covered[poly->edge[e].right];
    return true;
}

/* A covered face that lies on one which is not covered is no seam. */
static void compare_faces(const part *of, uint32_t face, const tl_poly *b, uint32_t g)
{
    const tl_poly *a = of->poly;
    if (a->covered[face] && !b->covered[g])
        (of->hidden - a->face_count)[face] = TL_COVERED;
}

static bool match(part *a, part *b)
{
    for (uint32_t i = 0; i < a->poly->face_count; i++)
        for (uint32_t j = 0; j < b->poly->face_count; j++) {
            double area;
            if ((a->poly->covered[i] != 0) == (b->poly->covered[j] != 0))
                continue;
            if (!tl_poly_shared_area(a->poly, i, b->poly, j, &area))
                return false;
            if (area > 0) {
                compare_faces(a, i, b->poly, j);
                compare_faces(b, j, a->poly, i);
            }
        }
    return true;
}

/* The parts in order of their low x, with all their faces open; NULL without memory. One allocation. */
static part *list_parts(tl_poly *const *parts, size_t count)
{
    size_t faces = 0, at = 0;
    for (size_t i = 0; i < count; i++)
        faces += parts[i]->face_count;
    part *list = malloc(count * sizeof *list + faces * sizeof(double));
    if (!list)
        return NULL;
    double *open = (double *)(void *)(list + count);
    for (size_t i = 0; i < count; at += parts[i]->face_count, i++) {
        list[i] = (part){.poly = parts[i],
                         .bounds = tl_poly_bounds(parts[i]),
                         .open = open + at,
                         .index = (uint32_t)i};
        for (uint32_t f = 0; f < parts[i]->face_count; f++)
            open[at + f] = tl_poly_face_area(parts[i], f);
    }
    qsort(list, count, sizeof *list, compare_part);
    for (size_t i = 0; i < count; i++)
        list[i].group = &list[i];
    return list;
}

tl_status tl_poly_mark_seams(tl_poly *const *parts, size_t count, tl_error *error)
{
    for (size_t i = 0; i < count; i++)
        tl_poly_clear_seams(parts[i]);
    if (count < 2)
        return TL_OK;
    part *list = list_parts(parts, count);
    bool done = list && each_pair(list, count, FIT, cover);
    for (size_t i = 0; done && i < count; i++)
        done = mark(&list[i]);
    done = done && each_pair(list, count, FIT, match);
    if (done)
        each_pair(list, count, FIT, show);
    free(list);
    return done ? TL_OK : tl_fail_memory(error);
}

tl_status tl_poly_connected(tl_poly *const *parts, size_t count, tl_sever_fn severs,
                            const void *user, uint32_t *label, tl_error *error)
{
    part *list = count ? list_parts(parts, count) : NULL;
    for (size_t i = 0; list && i < count; i++) {
        list[i].severs = severs;
        list[i].user = user;
    }
    if (count && (!list || !each_pair(list, count, JOINED_OVERLAP, hold))) {
        free(list);
        return tl_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        label[list[i].index] = root(&list[i])->index;
    free(list);
    return TL_OK;
}
