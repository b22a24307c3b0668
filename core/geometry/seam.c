/* seam.c - a body made of several convex polyhedra: which of their faces are inside it.
 *
 * One rule tells whether faces of two parts lie on each other. They face each other, and have as little between them
 * as blocks that have settled. A face is covered when faces of other parts that fit it lie on all of its area. It is a
 * seam when these are covered as well; a smaller face on a larger one is none. Covered faces are no directions in
 * which the body could part from another: a block that slides over a seam must not feel it. */
#include "geometry/seam.h"

#include "base/error.h"
#include "base/table.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/point2.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

/* Tolerance: parts fit when planes and corners agree within this times their size. Joined blocks were cut by one
 * plane, or were placed in contact by coordinates of six digits. */
#define FIT 1e-6
/* Tolerance: what is between faces that lie on each other: at most this gap and overlap, over the size of the smaller
 * part, and this sine of their angle. They may have been joined after they had settled on each other. Test:
 * unit/test_seam, lua/test_bodies. */
#define JOINED_GAP 1e-3
#define JOINED_OVERLAP 1e-2
#define JOINED_TILT 1e-2
/* Tolerance: share of a face's area that may stay uncovered: of parts that fit, and of those that have settled. */
#define UNCOVERED 1e-5
#define JOINED_UNCOVERED 1e-2

typedef struct frame {
    tl_vec3 o, t1, t2;
} frame;

static tl_point2 flatten(const frame *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (tl_point2){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

static double flat_area(const tl_point2 *c, size_t count)
{
    double area = 0;
    for (size_t i = 1; i + 1 < count; i++)
        area += 0.5 * tl_cross2(c[0], c[i], c[i + 1]);
    return area;
}

/* Area common to face fa of a and face fb of b, which face each other in one plane. `scratch` holds three times
 * as many corners as both faces have. */
static double common_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, tl_point2 *scratch)
{
    uint32_t na = tl_poly_face_size(a, fa), nb = tl_poly_face_size(b, fb);
    tl_vec3 n = a->plane[fa].normal;
    frame f = {.o = a->vertex[a->loop[a->start[fa]]], .t1 = tl_v3_perpendicular(n)};
    f.t2 = tl_v3_cross(n, f.t1);
    tl_point2 *now = scratch, *next = scratch + na + nb, *by = next + na + nb;
    for (uint32_t i = 0; i < na; i++)
        now[i] = flatten(&f, a->vertex[a->loop[a->start[fa] + i]]);
    for (uint32_t i = 0; i < nb; i++)
        by[i] = flatten(&f, b->vertex[b->loop[b->start[fb] + i]]);
    size_t count = tl_polygon_common(&now, &next, na, by, nb);
    return flat_area(now, count);
}

/* How far a part reaches behind a face. */
static double reach_behind(const tl_poly *p, uint32_t face)
{
    double most = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        most = fmax(most, p->plane[face].offset - tl_v3_dot(p->plane[face].normal, p->vertex[v]));
    return most;
}

bool tl_poly_faces_meet(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *uncovered)
{
    tl_plane p = a->plane[fa], q = b->plane[fb];
    double size = fmin(a->size, b->size), tilt = tl_v3_norm(tl_v3_add(p.normal, q.normal));
    if (tilt > JOINED_TILT)
        return false;
    if (tilt < FIT && fabs(p.offset + q.offset) < FIT * size) {
        *uncovered = fmax(*uncovered, UNCOVERED);
        return true;
    }
    double low = INFINITY, high = -INFINITY;
    for (uint32_t h = b->start[fb]; h < b->start[fb + 1]; h++) {
        double height = tl_v3_dot(p.normal, b->vertex[b->loop[h]]) - p.offset;
        low = fmin(low, height);
        high = fmax(high, height);
    }
    /* faces of two thin plates on each other may look at each other through both */
    if (low > JOINED_GAP * size || high < -JOINED_OVERLAP * size ||
        high < -0.5 * fmin(reach_behind(a, fa), reach_behind(b, fb)))
        return false;
    *uncovered = fmax(*uncovered, JOINED_UNCOVERED);
    return true;
}

/* Area common to two faces that face each other, in the plane of the first; false when out of memory. */
static bool face_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *area)
{
    size_t corners = tl_poly_face_size(a, fa) + tl_poly_face_size(b, fb);
    tl_point2 *scratch = malloc(3 * corners * sizeof *scratch);
    if (!scratch)
        return false;
    *area = common_area(a, fa, b, fb, scratch);
    free(scratch);
    return true;
}

bool tl_poly_shared_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *area)
{
    double uncovered = 0;
    *area = 0;
    return !tl_poly_faces_meet(a, fa, b, fb, &uncovered) || face_area(a, fa, b, fb, area);
}

typedef struct part {
    tl_poly *poly;
    tl_bounds bounds;
    double *open;     /* [faces] area not covered yet */
    uint8_t *covered; /* [faces] of the polyhedron, when it has seams */
    uint32_t index;
    struct part *group; /* towards the first part it hangs together with */
    tl_sever_fn severs;
    const void *user;
} part;

/* Whether nothing of two parts may lie on each other. */
static bool apart(const part *a, const part *b)
{
    double slack = JOINED_OVERLAP * fmax(a->poly->size, b->poly->size);
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

/* Faces of two parts that lie on each other, and their common area. */
typedef struct contact {
    part *a, *b;
    uint32_t fa, fb;
    double area, uncovered; /* see tl_poly_faces_meet */
} contact;

typedef void visit_fn(const contact *c);

/* Visits the faces of two parts that lie on each other; false without memory. */
static bool each_contact(part *a, part *b, visit_fn *visit)
{
    for (uint32_t i = 0; i < a->poly->face_count; i++)
        for (uint32_t j = 0; j < b->poly->face_count; j++) {
            contact c = {.a = a, .b = b, .fa = i, .fb = j};
            if (!tl_poly_faces_meet(a->poly, i, b->poly, j, &c.uncovered))
                continue;
            if (!face_area(a->poly, i, b->poly, j, &c.area))
                return false;
            if (c.area > 0)
                visit(&c);
        }
    return true;
}

/* Whether depths go on over the faces: they do where parts fit. */
static bool fits(const contact *c)
{
    return c->uncovered <= UNCOVERED;
}

/* Takes off what the faces cover of each other. */
static void cover(const contact *c)
{
    c->a->open[c->fa] -= fits(c) ? c->area : 0;
    c->b->open[c->fb] -= fits(c) ? c->area : 0;
}

/* Groups the parts unless the faces are severed, or meet in next to nothing. */
static void hold(const contact *c)
{
    double smaller = fmin(tl_poly_face_area(c->a->poly, c->fa), tl_poly_face_area(c->b->poly, c->fb));
    if (!is_severed(c->a, c->fa) && !is_severed(c->b, c->fb) && c->area > UNCOVERED * smaller)
        unite(c->a, c->b);
}

/* A covered face that lies on one which is not covered is no seam. */
static void compare(const contact *c)
{
    bool a = c->a->poly->covered[c->fa], b = c->b->poly->covered[c->fb];
    if (a && !b && fits(c))
        c->a->covered[c->fa] = TL_COVERED;
    if (b && !a && fits(c))
        c->b->covered[c->fb] = TL_COVERED;
}

static int compare_part(const void *x, const void *y)
{
    const part *p = x, *q = y;
    double a = p->bounds.min.x, b = q->bounds.min.x;
    if (a < b || a > b)
        return a < b ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index); /* the same order from every qsort */
}

/* Calls `visit` for all faces that lie on each other; parts are sorted by their low x. */
static bool each_pair(part *parts, size_t count, visit_fn *visit)
{
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++) {
            double slack = JOINED_OVERLAP * fmax(parts[i].poly->size, parts[j].poly->size);
            if (parts[j].bounds.min.x > parts[i].bounds.max.x + slack)
                break;
            if (!apart(&parts[i], &parts[j]) && !each_contact(&parts[i], &parts[j], visit))
                return false;
        }
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
    p->covered = tl_poly_open_seams(poly);
    if (!p->covered)
        return false;
    for (uint32_t f = first; f < poly->face_count; f++)
        p->covered[f] = is_covered(p, f) ? TL_SEAM : 0;
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
        list[i] = (part){.poly = parts[i], .bounds = tl_poly_bounds(parts[i]), .open = open + at, .index = (uint32_t)i};
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
    bool done = list && each_pair(list, count, cover);
    for (size_t i = 0; done && i < count; i++)
        done = mark(&list[i]);
    done = done && each_pair(list, count, compare);
    free(list);
    return done ? TL_OK : tl_fail_memory(error);
}

tl_status tl_poly_connected(tl_poly *const *parts, size_t count, tl_sever_fn severs, const void *user, uint32_t *label,
                            tl_error *error)
{
    part *list = count ? list_parts(parts, count) : NULL;
    for (size_t i = 0; list && i < count; i++) {
        list[i].severs = severs;
        list[i].user = user;
    }
    if (count && (!list || !each_pair(list, count, hold))) {
        free(list);
        return tl_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        label[list[i].index] = root(&list[i])->index;
    free(list);
    return TL_OK;
}

/* ---------------------------------------------------------------- planes of other parts ---
 *
 * Planes of a body's surface that count for a part though they belong to faces of other parts.
 *
 * The depth of a point in a body is its distance from the body's surface. The nearest outer face may belong to another
 * part than the point does. It does where a seam meets an edge of the body, or where it runs close below a face. So a
 * part is given the planes of the other parts' outer faces behind which it lies as a whole. They bound nothing of it.
 * A convex body lies behind all planes of its outer faces. So the depth in its parts is that in the body, however it
 * is cut.
 *
 * Left out is a plane from which every corner of the part is at least as far as from one other. Depths are linear, so
 * no point of the part is nearer to it. */

/* Planes, of outer faces or of those that count for a part. */
typedef struct planes {
    tl_plane *plane;
    size_t count, capacity;
} planes;

static double depth(tl_plane plane, tl_vec3 x)
{
    return plane.offset - tl_v3_dot(plane.normal, x);
}

/* Depth of the vertex that lies the least deep. */
static double least_depth(const tl_poly *p, tl_plane plane)
{
    double least = INFINITY;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        least = fmin(least, depth(plane, p->vertex[v]));
    return least;
}

/* Whether no vertex of a part is nearer to plane f than to plane g. */
static bool is_farther(const tl_poly *p, tl_plane f, tl_plane g)
{
    double slack = FIT * p->size;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (depth(f, p->vertex[v]) < depth(g, p->vertex[v]) - slack)
            return false;
    return true;
}

/* Whether a plane is the nearest of all to some point of a part, as far as single ones tell. */
static bool counts_for(const tl_poly *p, tl_plane plane, const planes *others)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!p->covered[f] && is_farther(p, plane, p->plane[f]))
            return false;
    for (size_t k = 0; k < others->count; k++)
        if (is_farther(p, plane, others->plane[k]))
            return false;
    return true;
}

static bool append(planes *c, tl_plane plane)
{
    if (!tl_grow(&c->plane, &c->capacity, c->count + 1, sizeof plane))
        return false;
    c->plane[c->count++] = plane;
    return true;
}

/* Adds what counts for a part of the planes of a body's outer faces. false: out of memory. */
static bool choose_for(const tl_poly *p, const planes *outer, planes *chosen)
{
    chosen->count = 0;
    for (size_t k = 0; k < outer->count; k++) {
        tl_plane plane = outer->plane[k];
        if (depth(plane, p->vertex[0]) < -FIT * p->size)
            continue; /* most cut a part of a large body, or pass it by */
        double least = least_depth(p, plane);
        if (least < -FIT * p->size || !counts_for(p, plane, chosen))
            continue;
        plane.offset -= fmin(least, 0); /* it cuts nothing off */
        if (!append(chosen, plane))
            return false;
    }
    return true;
}

/* Leaves out the planes that a later one has made idle. */
static void tidy(const tl_poly *p, planes *c)
{
    size_t kept = 0;
    for (size_t k = 0; k < c->count; k++) {
        bool idle = false;
        for (size_t m = k + 1; m < c->count && !idle; m++)
            idle = is_farther(p, c->plane[k], c->plane[m]);
        if (!idle)
            c->plane[kept++] = c->plane[k];
    }
    c->count = kept;
}

static bool gather_outer(tl_poly *const *parts, size_t count, planes *outer)
{
    for (size_t k = 0; k < count; k++)
        for (uint32_t f = 0; f < parts[k]->face_count; f++)
            if (!parts[k]->covered[f] && !append(outer, parts[k]->plane[f]))
                return false;
    return true;
}

/* A part's own planes are no farther than they are themselves, so they are not chosen. */
tl_status tl_poly_share_planes(tl_poly *const *parts, size_t count, tl_error *error)
{
    planes outer = {0}, chosen = {0};
    bool done = count < 2 || gather_outer(parts, count, &outer);
    for (size_t i = 0; i < count && done; i++) {
        done = choose_for(parts[i], &outer, &chosen);
        tidy(parts[i], &chosen);
        size_t most = TL_POLY_MAX_FACES - parts[i]->face_count; /* numbers of planes have 16 bits */
        done =
            done && tl_poly_add_planes(parts[i], chosen.plane, (uint32_t)(chosen.count < most ? chosen.count : most));
    }
    free(outer.plane);
    free(chosen.plane);
    return done ? TL_OK : tl_fail_memory(error);
}
