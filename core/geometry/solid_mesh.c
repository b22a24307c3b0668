/* solid_mesh.c - the tables of a solid's half-edges, and what is asked of loops and faces. */
#include "geometry/solid_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/vmath.h>

/* Constant: makes a radius an upper bound in spite of the rounding of its root and sums. */
#define ROUNDED_UP (1 + 1e-12)

/* ---------------------------------------------------------------- tables ----------------- */

bool tl_solid_grow(void *list, uint32_t *capacity, uint32_t count, size_t bytes)
{
    if (count < *capacity)
        return true;
    const size_t more = count < 8 ? 16 : (size_t)count + count / 2;
    void *at;
    memcpy(&at, list, sizeof at);
    void *grown = more < UINT32_MAX ? realloc(at, more * bytes) : NULL;
    if (!grown)
        return false;
    memcpy(list, &grown, sizeof grown);
    *capacity = (uint32_t)more;
    return true;
}

/* The same for a column beside a table. */
static bool grow_beside(void *column, uint32_t capacity, size_t bytes)
{
    void *at;
    memcpy(&at, column, sizeof at);
    void *grown = realloc(at, (size_t)capacity * bytes);
    if (grown)
        memcpy(column, &grown, sizeof grown);
    return grown != NULL;
}

bool tl_solid_add_vertex(tl_solid_mesh *m, tl_vec3 at, uint32_t *vertex)
{
    const uint32_t before = m->vertex_capacity;
    if (!tl_solid_grow(&m->vertex, &m->vertex_capacity, m->vertices, sizeof *m->vertex))
        return false;
    if (m->vertex_capacity > before && (!grow_beside(&m->height, m->vertex_capacity, sizeof *m->height) ||
                                        !grow_beside(&m->side, m->vertex_capacity, sizeof *m->side) ||
                                        !grow_beside(&m->vertex_mark, m->vertex_capacity, sizeof *m->vertex_mark)))
        return false;
    m->vertex_mark[m->vertices] = 0;
    m->vertex[m->vertices] = at;
    *vertex = m->vertices++;
    return true;
}

bool tl_solid_add_half(tl_solid_mesh *m, tl_half_edge edge, uint32_t *half)
{
    const uint32_t before = m->half_capacity;
    if (!tl_solid_grow(&m->half, &m->half_capacity, m->halves, sizeof *m->half))
        return false;
    if (m->half_capacity > before && (!grow_beside(&m->cross, m->half_capacity, sizeof *m->cross) ||
                                      !grow_beside(&m->half_mark, m->half_capacity, sizeof *m->half_mark) ||
                                      !grow_beside(&m->bisector, m->half_capacity, sizeof *m->bisector)))
        return false;
    m->half_mark[m->halves] = 0;
    m->bisector[m->halves] = TL_SOLID_NONE;
    m->half[m->halves] = edge;
    *half = m->halves++;
    return true;
}

bool tl_solid_add_face(tl_solid_mesh *m, tl_solid_face face, uint32_t *added)
{
    if (!tl_solid_grow(&m->face, &m->face_capacity, m->faces, sizeof *m->face))
        return false;
    face.mark = 0;
    m->face[m->faces] = face;
    *added = m->faces++;
    return true;
}

bool tl_solid_add_plane(tl_solid_mesh *m, tl_plane plane, uint32_t *added)
{
    if (!tl_solid_grow(&m->plane, &m->plane_capacity, m->planes, sizeof *m->plane))
        return false;
    m->plane[m->planes] = plane;
    *added = m->planes++;
    return true;
}

bool tl_solid_add_piece(tl_solid_mesh *m, uint32_t *added)
{
    if (!tl_solid_grow(&m->piece, &m->piece_capacity, m->pieces, sizeof *m->piece))
        return false;
    m->piece[m->pieces] = (tl_solid_piece){0};
    *added = m->pieces++;
    return true;
}

bool tl_piece_add_face(tl_solid_piece *p, uint32_t face)
{
    if (!tl_solid_grow(&p->face, &p->face_capacity, p->faces, sizeof *p->face))
        return false;
    p->face[p->faces++] = face;
    return true;
}

uint32_t tl_piece_compact(tl_solid_mesh *m, uint32_t piece)
{
    tl_solid_piece *p = &m->piece[piece];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->faces; i++)
        if (m->face[p->face[i]].piece == piece)
            p->face[kept++] = p->face[i];
    return p->faces = kept;
}

bool tl_piece_add_reflex(tl_solid_piece *p, uint32_t half)
{
    if (!tl_solid_grow(&p->reflex, &p->reflex_capacity, p->reflexes, sizeof *p->reflex))
        return false;
    p->reflex[p->reflexes++] = half;
    return true;
}

void tl_solid_free(tl_solid_mesh *m)
{
    for (uint32_t i = 0; i < m->pieces; i++) {
        free(m->piece[i].face);
        free(m->piece[i].reflex);
    }
    free(m->vertex);
    free(m->height);
    free(m->side);
    free(m->vertex_mark);
    free(m->half);
    free(m->cross);
    free(m->half_mark);
    free(m->bisector);
    free(m->face);
    free(m->plane);
    free(m->piece);
    free(m->shell);
    *m = (tl_solid_mesh){0};
}

uint32_t tl_solid_stamp(tl_solid_mesh *m)
{
    return ++m->stamp;
}

/* ---------------------------------------------------------------- loops and faces -------- */

void tl_solid_find_ball(tl_solid_mesh *m, uint32_t face)
{
    tl_solid_face *f = &m->face[face];
    tl_vec3 low = m->vertex[m->half[f->first].from], high = low;
    uint32_t h = f->first;
    do { /* holes lie inside the loop around */
        low = tl_v3_min(low, m->vertex[m->half[h].from]);
        high = tl_v3_max(high, m->vertex[m->half[h].from]);
        h = m->half[h].next;
    } while (h != f->first);
    f->center = tl_v3_scale(0.5, tl_v3_add(low, high));
    double most = 0;
    do {
        const tl_vec3 arm = tl_v3_sub(m->vertex[m->half[h].from], f->center);
        most = fmax(most, tl_v3_dot(arm, arm));
        h = m->half[h].next;
    } while (h != f->first);
    f->radius = sqrt(most) * ROUNDED_UP;
}

tl_vec3 tl_solid_loop_area(const tl_solid_mesh *m, uint32_t first)
{
    const tl_vec3 base = m->vertex[m->half[first].from];
    tl_vec3 sum = {0, 0, 0}, before = {0, 0, 0};
    for (uint32_t h = m->half[first].next; h != first; h = m->half[h].next) {
        const tl_vec3 arm = tl_v3_sub(m->vertex[m->half[h].from], base);
        sum = tl_v3_add(sum, tl_v3_cross(before, arm));
        before = arm;
    }
    return sum;
}

/* A ray in the plane from a point to the right: whether it meets the edge from a to b, which are relative to it; the
 * sign is that of the edge's way. *near gets whether the point lies on the edge. */
static int ray_meets(double ax, double ay, double bx, double by, double on, bool *near)
{
    const double dx = bx - ax, dy = by - ay, length2 = dx * dx + dy * dy;
    double t = length2 > 0 ? -(ax * dx + ay * dy) / length2 : 0;
    t = fmin(1, fmax(0, t));
    const double px = ax + t * dx, py = ay + t * dy;
    *near = *near || px * px + py * py <= on * on;
    if ((ay > 0) == (by > 0))
        return 0;
    const double cross = ax * by - bx * ay;
    return by > 0 ? cross > 0 : cross < 0 ? -1 : 0;
}

/* Adds how often a loop goes round a point; false when the point lies on it. */
static bool add_turns(const tl_solid_mesh *m, uint32_t first, tl_vec3 t1, tl_vec3 t2, tl_vec3 at, int *turns)
{
    bool near = false;
    uint32_t h = first;
    tl_vec3 arm = tl_v3_sub(m->vertex[m->half[h].from], at);
    double ax = tl_v3_dot(arm, t1), ay = tl_v3_dot(arm, t2);
    do {
        h = m->half[h].next;
        arm = tl_v3_sub(m->vertex[m->half[h].from], at);
        const double bx = tl_v3_dot(arm, t1), by = tl_v3_dot(arm, t2);
        *turns += ray_meets(ax, ay, bx, by, m->on, &near);
        ax = bx;
        ay = by;
    } while (h != first);
    return !near;
}

int tl_solid_in_loop(const tl_solid_mesh *m, uint32_t first, tl_vec3 normal, tl_vec3 at)
{
    const tl_vec3 t1 = tl_v3_perpendicular(normal), t2 = tl_v3_cross(normal, t1);
    int turns = 0;
    if (!add_turns(m, first, t1, t2, at, &turns))
        return 0;
    return turns != 0 ? 1 : -1;
}

int tl_solid_in_face(const tl_solid_mesh *m, uint32_t face, tl_vec3 at)
{
    const tl_vec3 normal = tl_solid_normal(m, face);
    const tl_vec3 t1 = tl_v3_perpendicular(normal), t2 = tl_v3_cross(normal, t1);
    int turns = 0;
    for (uint32_t first = m->face[face].first; first != TL_SOLID_NONE; first = m->half[first].ring)
        if (!add_turns(m, first, t1, t2, at, &turns))
            return 0;
    return turns > 0 ? 1 : -1;
}

/* The solid angle of a triangle over 2, after A. van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983). */
static double half_angle(tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    const double la = tl_v3_norm(a), lb = tl_v3_norm(b), lc = tl_v3_norm(c);
    const double up = tl_v3_dot(a, tl_v3_cross(b, c));
    const double down = la * lb * lc + tl_v3_dot(a, b) * lc + tl_v3_dot(b, c) * la + tl_v3_dot(c, a) * lb;
    return tl_atan2(up, down);
}

int tl_solid_winding(const tl_solid_mesh *m, const uint32_t *face, size_t count, tl_vec3 at)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t first = m->face[face[i]].first; first != TL_SOLID_NONE; first = m->half[first].ring) {
            const tl_vec3 base = tl_v3_sub(m->vertex[m->half[first].from], at);
            for (uint32_t h = m->half[first].next; m->half[h].next != first; h = m->half[h].next)
                sum += half_angle(base, tl_v3_sub(m->vertex[m->half[h].from], at),
                                  tl_v3_sub(m->vertex[tl_half_to(m, h)], at));
        }
    return (int)floor(sum / (2 * TL_PI) + 0.5);
}
