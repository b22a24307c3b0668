/* arcs.c - the heavy loops in the search of a pair's axis, over columns: how far each block's vertices lie along
 * the other's faces, and which edges' arcs cross on the Gauss map (the rule is in axis.c).
 *
 * Most edges are gone before: the arc of an edge of A is n = x n1 + y n2, with the normals of its faces and x, y
 * from 0 to 1 where |n| is no more than x + y. A vertex of B at heights h1, h2 over the faces gives
 * s(n) |n| <= x h1 + y h2, so s is nowhere on the arc above a negative height under which the vertex lies for both. What
 * lies deep under two faces of a block at once rules out the edge between them; of blocks that touch in an edge or a
 * corner few edges are left. The same heights give the s of two crossing edges (`across`). */
#include "narrow/arcs.h"

#include <talus/plugin.h>
#include <talus/vmath.h>

/* Lanes are padded to a multiple of this many. */
#define LANES 4
/* Vertices that are looked at together: a bit each. */
#define BITS 64
/* Error of the product of a length and a unit vector, over the length: some roundings. */
#define SLOPE_ERROR 1e-15
/* Columns of a row: directions and first ends of edges, normals of the faces at both sides, errors. */
#define ROW_COLUMNS 13

static size_t padded(size_t count)
{
    return (count + LANES - 1) / LANES * LANES;
}

/* Three columns of vectors. */
typedef struct vectors {
    double *x, *y, *z;
} vectors;

static vectors vectors_at(double *room, size_t lanes)
{
    return (vectors){room, room + lanes, room + 2 * lanes};
}

static void put(vectors to, size_t i, tl_vec3 v)
{
    to.x[i] = v.x;
    to.y[i] = v.y;
    to.z[i] = v.z;
}

/* ---------------------------------------------------------------- faces ------------------ */

static size_t over_room(const tl_poly *faces, const tl_poly *vertices)
{
    return padded(faces->face_count) * (6 + (size_t)vertices->vertex_count);
}

static size_t list_room(const tl_poly *p)
{
    return p->edge_count / (sizeof(double) / sizeof(uint16_t)) + 1;
}

size_t tl_arcs_room(const tl_poly *a, const tl_poly *b)
{
    return over_room(a, b) + over_room(b, a) + list_room(a) + list_room(b) + a->edge_count +
           ROW_COLUMNS * TL_ARCS_ROW;
}

TL_VECTORIZED static void measure(const tl_over *over, vectors normal, const tl_vec3 *vertex)
{
    const double *restrict x = normal.x, *restrict y = normal.y, *restrict z = normal.z;
    double *restrict low = over->low;
    for (uint32_t i = 0; i < over->vertices; i++) {
        double *restrict along = over->along + i * over->lanes;
        tl_vec3 v = vertex[i];
#pragma omp simd
        for (size_t f = 0; f < over->lanes; f++) {
            double s = x[f] * v.x + y[f] * v.y + z[f] * v.z;
            along[f] = s;
            low[f] = i == 0 || s < low[f] ? s : low[f];
        }
    }
}

/* Columns of normals, which end before what `over` keeps. */
static double *place_over(tl_over *over, uint32_t faces, uint32_t vertices, double *room,
                          vectors *normal)
{
    size_t lanes = padded(faces);
    *normal = vectors_at(room, lanes);
    for (size_t f = faces; f < lanes; f++)
        put(*normal, f, tl_v3(0, 0, 0));
    void *under = room + 5 * lanes;
    *over = (tl_over){.vertices = vertices,
                      .faces = faces,
                      .lanes = lanes,
                      .low = room + 3 * lanes,
                      .offset = room + 4 * lanes,
                      .under = under,
                      .along = room + 6 * lanes};
    for (size_t f = faces; f < lanes; f++)
        over->offset[f] = 0;
    return room + (6 + vertices) * lanes;
}

double *tl_over_faces(const tl_pair_view *view, double *room, tl_over *on_a, tl_over *on_b)
{
    const tl_poly *a = view->a, *b = view->b;
    vectors normal;
    room = place_over(on_a, a->face_count, b->vertex_count, room, &normal);
    for (uint32_t f = 0; f < a->face_count; f++) {
        put(normal, f, a->plane[f].normal);
        on_a->offset[f] = a->plane[f].offset;
    }
    measure(on_a, normal, view->vertex_b);
    room = place_over(on_b, b->face_count, a->vertex_count, room, &normal);
    for (uint32_t f = 0; f < b->face_count; f++) {
        tl_vec3 n = view->normal_b[f];
        put(normal, f, n);
        on_b->offset[f] = b->plane[f].offset + tl_v3_dot(n, view->shift);
    }
    measure(on_b, normal, a->vertex);
    return room;
}

/* ---------------------------------------------------------------- edges ------------------ */

/* The vertices, of BITS from `begin` on, that lie lower than `floor` over each face. */
TL_VECTORIZED static void find_under(const tl_over *over, uint32_t begin, double floor)
{
    const double *restrict offset = over->offset;
    uint64_t *restrict under = over->under;
    uint32_t count = over->vertices - begin < BITS ? over->vertices - begin : BITS;
    for (uint32_t i = 0; i < count; i++) {
        const double *restrict along = over->along + (begin + i) * over->lanes;
#pragma omp simd
        for (size_t f = 0; f < over->lanes; f++) {
            uint64_t yes = (uint64_t)(along[f] - offset[f] < floor) << i;
            under[f] = i == 0 ? yes : under[f] | yes;
        }
    }
}

/* The edges of a block that no vertex of the other rules out. */
static size_t list_edges(const tl_poly *p, const tl_over *over, bool walls, double floor,
                         uint16_t *list)
{
    size_t count = 0;
    for (uint32_t i = 0; i < p->edge_count; i++) {
        list[count] = (uint16_t)i;
        count += !(walls && p->hidden[i]);
    }
    for (uint32_t begin = 0; begin < over->vertices; begin += BITS) {
        size_t left = 0;
        find_under(over, begin, floor);
        for (size_t k = 0; k < count; k++) {
            const tl_edge *e = &p->edge[list[k]];
            list[left] = list[k];
            left += !(over->under[e->left] & over->under[e->right]);
        }
        count = left;
    }
    return count;
}

tl_arcs tl_arcs_begin(const tl_pair_view *view, const tl_over *on_a, const tl_over *on_b,
                      bool walls, double least, double *room)
{
    void *a = room, *b = room + list_room(view->a);
    room += list_room(view->a) + list_room(view->b);
    void *rows = room + ROW_COLUMNS * TL_ARCS_ROW;
    tl_arcs arcs = {.view = view, .least = least, .a = a, .b = b, .columns = room, .rows = rows};
    double floor = fmin(least, 0);
    arcs.a_count = list_edges(view->a, on_a, walls, floor, arcs.a);
    arcs.b_count = arcs.a_count ? list_edges(view->b, on_b, walls, floor, arcs.b) : 0;
    return arcs;
}

/* Edges of B as columns. */
typedef struct row {
    size_t lanes;
    vectors along, from; /* directions, and first ends */
    vectors left, right; /* normals of the faces at their sides */
    double *error;       /* of slopes */
} row;

/* A lane that pads has no direction: its arc crosses none. */
static row row_of(const tl_arcs *arcs, size_t begin)
{
    const tl_pair_view *view = arcs->view;
    size_t count = arcs->b_count - begin < TL_ARCS_ROW ? arcs->b_count - begin : TL_ARCS_ROW;
    size_t lanes = padded(count);
    row r = {.lanes = lanes,
             .along = vectors_at(arcs->columns, lanes),
             .from = vectors_at(arcs->columns + 3 * lanes, lanes),
             .left = vectors_at(arcs->columns + 6 * lanes, lanes),
             .right = vectors_at(arcs->columns + 9 * lanes, lanes),
             .error = arcs->columns + 12 * lanes};
    for (size_t j = 0; j < lanes; j++) {
        bool pads = j >= count;
        const tl_edge *e = &view->b->edge[arcs->b[begin + (pads ? 0 : j)]];
        tl_vec3 u = pads ? tl_v3(0, 0, 0) : tl_v3_sub(view->vertex_b[e->b], view->vertex_b[e->a]);
        put(r.along, j, u);
        put(r.from, j, view->vertex_b[e->a]);
        put(r.left, j, view->normal_b[e->left]);
        put(r.right, j, view->normal_b[e->right]);
        r.error[j] = SLOPE_ERROR * (fabs(u.x) + fabs(u.y) + fabs(u.z));
    }
    return r;
}

/* Of an edge along u between two faces of A. B's edge is perpendicular to the common normal n = x n1 + y n2, so x and
 * y are as its slopes along n1 and n2, crosswise, and s |n| = x h1 + y h2 with the heights of a point of it. This
 * holds for parallel edges, too, but for the errors of their slopes. */
TL_VECTORIZED static uint64_t across(const row *r, tl_vec3 u, const tl_plane *p, const tl_plane *q,
                                     double least)
{
    const double *restrict vx = r->along.x, *restrict vy = r->along.y, *restrict vz = r->along.z;
    const double *restrict fx = r->from.x, *restrict fy = r->from.y, *restrict fz = r->from.z;
    const double *restrict lx = r->left.x, *restrict ly = r->left.y, *restrict lz = r->left.z;
    const double *restrict rx = r->right.x, *restrict ry = r->right.y, *restrict rz = r->right.z;
    const double *restrict error = r->error, least2 = least < 0 ? least * least : 0;
    const tl_vec3 n1 = p->normal, n2 = q->normal;
    const double o1 = p->offset, o2 = q->offset, cosine = tl_v3_dot(n1, n2);
    uint64_t found = 0;
#pragma omp simd reduction(| : found)
    for (size_t j = 0; j < r->lanes; j++) {
        double b1 = u.x * lx[j] + u.y * ly[j] + u.z * lz[j];
        double b2 = u.x * rx[j] + u.y * ry[j] + u.z * rz[j];
        double a1 = vx[j] * n1.x + vy[j] * n1.y + vz[j] * n1.z;
        double a2 = vx[j] * n2.x + vy[j] * n2.y + vz[j] * n2.z;
        double h1 = fx[j] * n1.x + fy[j] * n1.y + fz[j] * n1.z - o1;
        double h2 = fx[j] * n2.x + fy[j] * n2.y + fz[j] * n2.z - o2;
        double nn = a1 * a1 + a2 * a2 - 2 * cosine * (a1 * a2);
        double s = fabs(a2) * h1 + fabs(a1) * h2 + error[j] * (fabs(h1) + fabs(h2));
        uint64_t yes = (uint64_t)((b1 * b2 < 0) & (a1 * a2 < 0) & (b1 * a2 < 0) &
                                  !((s < 0) & (s * s > least2 * nn)));
        found |= yes << j;
    }
    return found;
}

const uint64_t *tl_arcs_across(const tl_arcs *arcs, size_t begin)
{
    const tl_poly *a = arcs->view->a;
    row r = row_of(arcs, begin);
    for (size_t k = 0; k < arcs->a_count; k++) {
        const tl_edge *e = &a->edge[arcs->a[k]];
        tl_vec3 u = tl_v3_sub(a->vertex[e->b], a->vertex[e->a]);
        arcs->rows[k] = across(&r, u, &a->plane[e->left], &a->plane[e->right], arcs->least);
    }
    return arcs->rows;
}
