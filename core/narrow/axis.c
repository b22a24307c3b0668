/* axis.c - the exact common plane: the axis n that maximises s(n) = min over B of n.b - max over A of
 * n.a, over A's faces, B's faces and the edge pairs whose arcs cross on the Gauss map.
 *
 * The sign of s is then exact: positive when the blocks are apart, else minus the least overlap.
 * For blocks that are apart and nearest by parallel edges or by vertices, s is a lower bound of the
 * distance, which is what the caller needs.
 *
 * Edge rule: arcs (a1, a2) and (-b1, -b2) cross when b1 and b2 lie on different sides of edge A's
 * plane, a1 and a2 on different sides of edge B's, and both arcs in the same hemisphere. With e_a
 * running along its left face's loop, a1 x a2 is parallel to e_a, so all tests are products of edges
 * with normals. */
#include "narrow/axis.h"

#include "base/table.h"
#include "narrow/arcs.h"

/* A face is preferred to an edge pair whose s is larger by no more than this times the size: the
 * rounding of s, so that flush faces are never taken for crossing edges. */
#define FACE_PREFERENCE 1e-12
/* The old axis is kept while the new one is better by no more than this share of |s|. */
#define HYSTERESIS 0.05
/* sin of the angle between edges below which they have no common normal of their own. */
#define PARALLEL 1e-12
/* Squared sine of the angle between edges from which the quick look at their s is exact enough: the error
 * of a cross product is 1e-16 over the sine. */
#define CROSSING2 1e-6
/* cos of the angle within which two axes count as the same one when the margin to the next best is
 * measured: two flush faces give the same common plane twice. */
#define ALIKE 0.999
/* Square of a cosine that is larger than ALIKE in spite of rounding. */
#define SURELY_ALIKE2 0.9981
/* How far outside its feature a support point may project, relative to the size, before the axis
 * counts as lost: rounding. */
#define INSIDE 1e-9

/* Vectors turned and shifted: each is four lanes, of which the next vector takes the last one's place. */
TL_VECTORIZED static void place(const tl_mat3 *turn, tl_vec3 shift, const tl_vec3 *restrict from,
                                size_t stride, size_t count, double *restrict to)
{
    const double(*m)[3] = turn->m, t[4] = {shift.x, shift.y, shift.z, shift.z};
    const double x[4] = {m[0][0], m[1][0], m[2][0], m[2][0]};
    const double y[4] = {m[0][1], m[1][1], m[2][1], m[2][1]};
    const double z[4] = {m[0][2], m[1][2], m[2][2], m[2][2]};
    for (size_t i = 0; i < count; i++, to += 3) {
        const tl_vec3 v = *(const tl_vec3 *)(const void *)((const char *)from + i * stride);
#pragma omp simd
        for (int k = 0; k < 4; k++)
            to[k] = x[k] * v.x + y[k] * v.y + z[k] * v.z + t[k];
    }
}

bool tl_pair_place(tl_pair_view *view, tl_narrow *room)
{
    const tl_poly *a = view->a, *b = view->b;
    if (!tl_grow(&room->vertex_b, &room->vertex_room, b->vertex_count + 1, sizeof(tl_vec3)) ||
        !tl_grow(&room->normal_b, &room->normal_room, b->face_count + 1, sizeof(tl_vec3)) ||
        !tl_grow(&room->dots, &room->dot_room, tl_arcs_room(a, b), sizeof(double)))
        return false;
    view->vertex_b = room->vertex_b;
    view->normal_b = room->normal_b;
    place(&view->turn, view->shift, b->vertex, sizeof(tl_vec3), b->vertex_count,
          &view->vertex_b->x);
    place(&view->turn, tl_v3(0, 0, 0), &b->plane[0].normal, sizeof(tl_plane), b->face_count,
          &view->normal_b->x);
    return true;
}

bool tl_pair_place_face(tl_pair_view *view, uint32_t face, tl_narrow *room)
{
    const tl_poly *b = view->b;
    if (!tl_grow(&room->vertex_b, &room->vertex_room, b->vertex_count, sizeof(tl_vec3)) ||
        !tl_grow(&room->normal_b, &room->normal_room, b->face_count, sizeof(tl_vec3)))
        return false;
    view->vertex_b = room->vertex_b;
    view->normal_b = room->normal_b;
    for (uint32_t i = b->start[face]; i < b->start[face + 1]; i++) {
        uint32_t v = b->loop[i];
        view->vertex_b[v] = tl_v3_add(tl_m3_mul(&view->turn, b->vertex[v]), view->shift);
    }
    view->normal_b[face] = tl_m3_mul(&view->turn, b->plane[face].normal);
    return true;
}

/* min over the points of n . x */
static double lowest(const tl_vec3 *x, uint32_t count, tl_vec3 n)
{
    double low = tl_v3_dot(n, x[0]);
    for (uint32_t i = 1; i < count; i++) {
        double s = tl_v3_dot(n, x[i]);
        low = s < low ? s : low;
    }
    return low;
}

/* min over B - max over A of n . x */
static double gap_along(const tl_pair_view *view, tl_vec3 n)
{
    return lowest(view->vertex_b, view->b->vertex_count, n) +
           lowest(view->a->vertex, view->a->vertex_count, tl_v3_neg(n));
}

static double offset_b(const tl_pair_view *view, uint32_t face)
{
    return view->b->plane[face].offset + tl_v3_dot(view->normal_b[face], view->shift);
}

static void offer(tl_axis *best, const tl_axis *one)
{
    bool alike = tl_v3_dot(best->n, one->n) > ALIKE;
    if (one->s > best->s) {
        double second = alike ? best->second : best->s;
        *best = *one;
        best->second = second;
    } else if (one->s > best->second && !alike) {
        best->second = one->s;
    }
}

/* cos from which a direction counts as going into a seam. */
#define INTO_SEAM 1e-6
/* Overlap, relative to the size, up to which parts have no common volume: above the rounding of cuts and of parts that
 * were placed in contact (TL_POLY_ON), below any overlap that carries. */
#define NO_VOLUME 1e-8
/* Parts that lie deeper than this share of the size under each other's walls, ... */
#define BESIDE 0.002
/* ... while a direction that is none of a wall separates them but for this share of that depth, meet through a seam. */
#define BESIDE_LEAD 0.25

/* True when the part, at one of its vertices, goes on in `outward` into another part of its body. */
static bool goes_on(const tl_poly *p, uint32_t vertex, tl_vec3 outward, const tl_mat3 *turn)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        for (uint32_t h = p->start[f]; p->covered[f] && h < p->start[f + 1]; h++) {
            tl_vec3 n = p->plane[f].normal;
            if (p->loop[h] == vertex &&
                tl_v3_dot(outward, turn ? tl_m3_mul(turn, n) : n) > INTO_SEAM)
                return true;
        }
    return false;
}

/* True when the part goes on into another part of its body at every one of its farthest vertices in
 * `outward`: there is no wall to meet in that direction. The vertices of a face that looks there are farthest
 * all alike, and which of them is so by rounding says nothing. */
static bool enters_seam(const tl_poly *p, const tl_vec3 *vertex, tl_vec3 outward,
                        const tl_mat3 *turn)
{
    if (!p->seams)
        return false;
    double top = -INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        top = fmax(top, tl_v3_dot(outward, vertex[i]));
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (tl_v3_dot(outward, vertex[i]) >= top - INSIDE * p->size &&
            !goes_on(p, i, outward, turn))
            return false;
    return true;
}

static bool a_is_inside(const tl_pair_view *view, tl_vec3 n)
{
    return enters_seam(view->a, view->a->vertex, n, NULL);
}

static bool b_is_inside(const tl_pair_view *view, tl_vec3 n)
{
    return enters_seam(view->b, view->vertex_b, tl_v3_neg(n), &view->turn);
}

/* A face of the body's surface is a wall itself: what may be missing is one of the other body that meets
 * it. */
static void search_faces(const tl_pair_view *view, const tl_over *on_a, const tl_over *on_b,
                         bool walls, tl_axis *best)
{
    for (uint32_t f = 0; f < on_a->faces; f++) {
        tl_axis one = {.kind = TL_AXIS_FACE_A,
                       .ia = (uint16_t)f,
                       .n = view->a->plane[f].normal,
                       .s = on_a->low[f] - on_a->offset[f]};
        if (one.s > best->second && !(walls && (view->a->covered[f] || b_is_inside(view, one.n))))
            offer(best, &one);
    }
    for (uint32_t f = 0; f < on_b->faces; f++) {
        tl_axis one = {.kind = TL_AXIS_FACE_B,
                       .ib = (uint16_t)f,
                       .n = tl_v3_neg(view->normal_b[f]),
                       .s = on_b->low[f] - on_b->offset[f]};
        if (one.s > best->second && !(walls && (view->b->covered[f] || a_is_inside(view, one.n))))
            offer(best, &one);
    }
}

bool tl_edge_normal(tl_vec3 edge_a, tl_vec3 edge_b, tl_vec3 outward, tl_vec3 *n)
{
    tl_vec3 a = tl_v3_unit(edge_a), b = tl_v3_unit(edge_b);
    tl_vec3 c = tl_v3_cross(a, b);
    double length = tl_v3_norm(c);
    if (!(length > PARALLEL))
        return false;
    c = tl_v3_scale(1 / length, c);
    /* The cross product of nearly parallel edges has a component along them: take it out. */
    for (int pass = 0; pass < 2; pass++) {
        c = tl_v3_madd(c, -tl_v3_dot(c, a), a);
        c = tl_v3_madd(c, -tl_v3_dot(c, b), b);
        c = tl_v3_unit(c);
    }
    *n = tl_v3_dot(c, outward) < 0 ? tl_v3_neg(c) : c;
    return true;
}

static tl_vec3 edge_a_direction(const tl_pair_view *view, uint32_t edge)
{
    const tl_edge *e = &view->a->edge[edge];
    return tl_v3_sub(view->a->vertex[e->b], view->a->vertex[e->a]);
}

static tl_vec3 edge_b_direction(const tl_pair_view *view, uint32_t edge)
{
    const tl_edge *e = &view->b->edge[edge];
    return tl_v3_sub(view->vertex_b[e->b], view->vertex_b[e->a]);
}

/* n and s of an edge pair. s is measured between the nearest of the edges' ends, so that what is left
 * of an error in n is multiplied by a short distance. */
static bool edge_axis(const tl_pair_view *view, uint32_t ia, uint32_t ib, tl_axis *axis)
{
    const tl_edge *ea = &view->a->edge[ia], *eb = &view->b->edge[ib];
    tl_vec3 outward = tl_v3_add(view->a->plane[ea->left].normal, view->a->plane[ea->right].normal);
    tl_vec3 n;
    if (!tl_edge_normal(edge_a_direction(view, ia), edge_b_direction(view, ib), outward, &n))
        return false;
    tl_vec3 a[2] = {view->a->vertex[ea->a], view->a->vertex[ea->b]};
    tl_vec3 b[2] = {view->vertex_b[eb->a], view->vertex_b[eb->b]};
    tl_vec3 gap = tl_v3_sub(b[0], a[0]);
    for (int k = 1; k < 4; k++) {
        tl_vec3 d = tl_v3_sub(b[k & 1], a[k >> 1]);
        gap = tl_v3_norm2(d) < tl_v3_norm2(gap) ? d : gap;
    }
    *axis = (tl_axis){TL_AXIS_EDGES, (uint16_t)ia, (uint16_t)ib, n, tl_v3_dot(n, gap), 0};
    return true;
}

/* False when the edges' axis certainly changes nothing, for it hardly differs from the best one and its s is
 * below. Nearly parallel edges are left to edge_axis. */
static bool may_matter(const tl_pair_view *view, uint32_t ia, uint32_t ib, const tl_axis *best)
{
    tl_vec3 u = edge_a_direction(view, ia), v = edge_b_direction(view, ib);
    tl_vec3 c = tl_v3_cross(u, v);
    double c2 = tl_v3_norm2(c), limit = best->s - FACE_PREFERENCE * view->size;
    if (!(limit < 0) || !(c2 > CROSSING2 * tl_v3_norm2(u) * tl_v3_norm2(v)))
        return true;
    const tl_edge *ea = &view->a->edge[ia], *eb = &view->b->edge[ib];
    tl_vec3 outward = tl_v3_add(view->a->plane[ea->left].normal, view->a->plane[ea->right].normal);
    double sign = tl_v3_dot(c, outward) < 0 ? -1 : 1; /* s = t / |c| */
    double t = sign * tl_v3_dot(c, tl_v3_sub(view->vertex_b[eb->a], view->a->vertex[ea->a]));
    double alike = sign * tl_v3_dot(c, best->n);
    return !(alike > 0 && alike * alike > SURELY_ALIKE2 * c2 && t < 0 &&
             t * t > limit * limit * c2);
}

static void search_edges(const tl_pair_view *view, const tl_arcs *arcs, bool walls, tl_axis *best)
{
    for (size_t begin = 0; begin < arcs->b_count; begin += TL_ARCS_ROW) {
        const uint64_t *rows = tl_arcs_across(arcs, begin);
        for (size_t k = 0; k < arcs->a_count; k++)
            for (uint64_t bits = rows[k]; bits; bits &= bits - 1) {
                uint32_t i = arcs->a[k], j = arcs->b[begin + (size_t)__builtin_ctzll(bits)];
                tl_axis one;
                if (may_matter(view, i, j, best) && edge_axis(view, i, j, &one) &&
                    one.s > best->second &&
                    !(walls && (a_is_inside(view, one.n) || b_is_inside(view, one.n))))
                    offer(best, &one);
            }
    }
}

/* The best of all axes, or of those along which a wall of one meets a wall of the other. s is -INFINITY where no wall
 * meets one. */
static tl_axis search(const tl_pair_view *view, tl_narrow *room, bool walls)
{
    tl_axis face = {.s = -INFINITY, .second = -INFINITY};
    tl_over on_a, on_b;
    double *rest = tl_over_faces(view, room->dots, &on_a, &on_b);
    search_faces(view, &on_a, &on_b, walls, &face);
    tl_axis best = face;
    double least = face.second - FACE_PREFERENCE * view->size;
    tl_arcs arcs = tl_arcs_begin(view, &on_a, &on_b, walls, least, rest);
    search_edges(view, &arcs, walls, &best);
    if (best.kind == TL_AXIS_EDGES && isfinite(best.s)) {
        /* an edge axis counts by its full support, and only when it beats the faces clearly */
        best.s = gap_along(view, best.n);
        if (best.s <= face.s + FACE_PREFERENCE * view->size) {
            double second = fmax(face.second, best.s < face.s ? best.s : face.second);
            second = fmax(second, best.second < face.s ? best.second : face.second);
            best = face;
            best.second = second;
        }
    }
    return best;
}

/* Parts of joined bodies that do not press on each other, although their walls overlap: either they have no common
 * volume, for a seam's face or edge separates them, or they have little of it and lie deep under each other's walls,
 * for they meet through a seam. What is beyond the seam is touched instead. */
static bool is_beside_seam(const tl_pair_view *view, double walls, double all)
{
    double none = NO_VOLUME * view->size;
    return all > walls + none &&
           (all > -none || (walls < -BESIDE * view->size && all > BESIDE_LEAD * walls));
}

tl_axis tl_axis_search(const tl_pair_view *view, tl_narrow *room, const tl_axis_features *previous)
{
    tl_axis best = search(view, room, true);
    if (view->a->seams || view->b->seams) {
        double all = search(view, room, false).s;
        if (is_beside_seam(view, best.s, all))
            return (tl_axis){
                .n = best.n, .s = INFINITY, .second = fmax(all, TL_SILENT * view->size)};
        /* it may come to lie there: half the lead is how far the pair may move before it is searched again */
        best.second = fmax(best.second, best.s - BESIDE * view->size);
    }
    if (previous) {
        tl_axis kept = tl_axis_of(*previous);
        if (!(kept.kind == best.kind && kept.ia == best.ia && kept.ib == best.ib) &&
            tl_axis_follow(view, &kept) && best.s - kept.s <= HYSTERESIS * fabs(best.s) &&
            kept.s < 0) {
            kept.second = best.s;
            best = kept;
        }
    }
    return best;
}

double tl_axis_wait(const tl_axis *axis, double size)
{
    return isfinite(axis->s) ? axis->s - TL_CONTACT_TOLERANCE * size : axis->second;
}

/* A vertex of the lower-dimensional side lies over the face. */
static bool over_face(const tl_poly *p, uint32_t face, tl_vec3 x, double slack)
{
    tl_vec3 n = p->plane[face].normal;
    uint32_t start = p->start[face], count = tl_poly_face_size(p, face);
    for (uint32_t i = 0; i < count; i++) {
        tl_vec3 c = p->vertex[p->loop[start + i]];
        tl_vec3 d = p->vertex[p->loop[start + (i + 1) % count]];
        tl_vec3 inward = tl_v3_cross(n, tl_v3_sub(d, c));
        double off = tl_v3_dot(inward, tl_v3_sub(x, c));
        if (off < 0 && off * off > slack * slack * tl_v3_norm2(inward))
            return false;
    }
    return true;
}

/* The lines of both edges come nearest within the edges. */
static bool edges_meet(const tl_pair_view *view, const tl_axis *axis)
{
    tl_vec3 u = edge_a_direction(view, axis->ia), v = edge_b_direction(view, axis->ib);
    tl_vec3 w = tl_v3_sub(view->vertex_b[view->b->edge[axis->ib].a],
                          view->a->vertex[view->a->edge[axis->ia].a]);
    double uu = tl_v3_dot(u, u), uv = tl_v3_dot(u, v), vv = tl_v3_dot(v, v);
    double wu = tl_v3_dot(w, u), wv = tl_v3_dot(w, v), det = uu * vv - uv * uv;
    if (!(det > 0))
        return false;
    double s = (wu * vv - wv * uv) / det, t = (wu * uv - wv * uu) / det;
    double slack_s = INSIDE * view->size / sqrt(uu), slack_t = INSIDE * view->size / sqrt(vv);
    return s >= -slack_s && s <= 1 + slack_s && t >= -slack_t && t <= 1 + slack_t;
}

static bool arcs_cross(const tl_pair_view *view, const tl_axis *axis)
{
    const tl_edge *ea = &view->a->edge[axis->ia], *eb = &view->b->edge[axis->ib];
    tl_vec3 u = edge_a_direction(view, axis->ia), v = edge_b_direction(view, axis->ib);
    double b1 = tl_v3_dot(u, view->normal_b[eb->left]);
    double b2 = tl_v3_dot(u, view->normal_b[eb->right]);
    double a1 = tl_v3_dot(v, view->a->plane[ea->left].normal);
    double a2 = tl_v3_dot(v, view->a->plane[ea->right].normal);
    return b1 * b2 < 0 && a1 * a2 < 0 && b1 * a2 < 0;
}

/* The lowest of the points along n, and how low it is. */
static uint32_t lowest_point(const tl_vec3 *x, uint32_t count, tl_vec3 n, double *low)
{
    uint32_t best = 0;
    *low = tl_v3_dot(n, x[0]);
    for (uint32_t i = 1; i < count; i++) {
        double s = tl_v3_dot(n, x[i]);
        if (s < *low) {
            *low = s;
            best = i;
        }
    }
    return best;
}

/* n and s of a face's normal; returns the vertex of the other block that it rests on. */
static uint32_t place_face(const tl_pair_view *view, tl_axis *axis)
{
    double low;
    uint32_t vertex;
    if (axis->kind == TL_AXIS_FACE_A) {
        const tl_plane *plane = &view->a->plane[axis->ia];
        vertex = lowest_point(view->vertex_b, view->b->vertex_count, plane->normal, &low);
        axis->n = plane->normal;
        axis->s = low - plane->offset;
    } else {
        tl_vec3 n = view->normal_b[axis->ib];
        vertex = lowest_point(view->a->vertex, view->a->vertex_count, n, &low);
        axis->n = tl_v3_neg(n);
        axis->s = low - offset_b(view, axis->ib);
    }
    return vertex;
}

bool tl_axis_place(const tl_pair_view *view, tl_axis *axis)
{
    if (axis->kind != TL_AXIS_EDGES) {
        place_face(view, axis);
        return true;
    }
    tl_axis now;
    if (!edge_axis(view, axis->ia, axis->ib, &now))
        return false;
    axis->n = now.n;
    axis->s = gap_along(view, now.n);
    return true;
}

bool tl_axis_follow(const tl_pair_view *view, tl_axis *axis)
{
    if (axis->kind == TL_AXIS_EDGES)
        return arcs_cross(view, axis) && edges_meet(view, axis) && tl_axis_place(view, axis);
    uint32_t vertex = place_face(view, axis);
    double slack = INSIDE * view->size;
    if (axis->kind == TL_AXIS_FACE_A)
        return over_face(view->a, axis->ia, view->vertex_b[vertex], slack);
    tl_vec3 x = tl_m3_tmul(&view->turn, tl_v3_sub(view->a->vertex[vertex], view->shift));
    return over_face(view->b, axis->ib, x, slack);
}
