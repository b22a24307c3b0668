/* surface.c - the surface on which two blocks press each other.
 *
 * A polygon begins as a face, or as a large square in the plane on which two depths are equal. It is cut by
 * half-spaces one after the other (Sutherland and Hodgman 1974). The order of the cuts does not depend on where the
 * blocks are. Nor does what is left out: polygons whose area is that of roundings. */
#include "narrow/surface.h"

#include "base/table.h"
#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>

/* Tolerance: area, over the square of the smaller block's size, of a polygon that is left out. */
#define NO_AREA 1e-12
/* Tolerance: squared length of the difference of two unit normals below which their depths are equal nowhere or
 * everywhere. */
#define ONE_DIRECTION 1e-12

/* Makes room for `corners` more corners and one more polygon. */
static bool reserve(tl_surface *s, size_t corners)
{
    return tl_grow(&s->corner, &s->corner_capacity, s->corners + corners, sizeof *s->corner) &&
           tl_grow(&s->size, &s->polygon_capacity, s->polygons + 1, sizeof *s->size);
}

/* ---------------------------------------------------------------- polygons --------------- */

/* A polygon that is being cut: the corners behind those of the surface. What is cut from it goes behind it. */
typedef struct draft {
    tl_surface *surface;
    size_t count;
} draft;

/* Cuts off the side of a plane that its normal points to. */
static bool cut(draft *p, tl_plane h)
{
    tl_surface *s = p->surface;
    size_t count = p->count, kept = 0;
    if (count == 0)
        return true;
    if (!reserve(s, 3 * count + 2)) /* a rounded line may cross a straight run of corners twice */
        return false;
    tl_vec3 *from = s->corner + s->corners, *to = from + count;
    for (size_t i = 0; i < count; i++) {
        tl_vec3 x = from[i], y = from[i + 1 == count ? 0 : i + 1];
        double at_x = tl_v3_dot(h.normal, x) - h.offset, at_y = tl_v3_dot(h.normal, y) - h.offset;
        if (at_x <= 0)
            to[kept++] = x;
        if ((at_x <= 0) != (at_y <= 0))
            to[kept++] = tl_v3_madd(x, at_x / (at_x - at_y), tl_v3_sub(y, x));
    }
    memmove(from, to, kept * sizeof *from);
    p->count = kept < 3 ? 0 : kept;
    return true;
}

static bool has_area(const draft *p, double size)
{
    const tl_vec3 *x = p->surface->corner + p->surface->corners;
    tl_vec3 twice = {0, 0, 0};
    for (size_t i = 1; i + 1 < p->count; i++)
        twice = tl_v3_add(twice, tl_v3_cross(tl_v3_sub(x[i], x[0]), tl_v3_sub(x[i + 1], x[0])));
    return tl_v3_norm(twice) > 2 * NO_AREA * size * size;
}

/* Makes the polygon one of the surface. */
static void keep(draft *p)
{
    tl_surface *s = p->surface;
    s->size[s->polygons++] = (uint32_t)p->count;
    s->corners += p->count;
}

/* ---------------------------------------------------------------- patches ---------------- */

bool tl_surface_add_patch(const tl_pair_view *view, uint32_t face_a, uint32_t face_b, tl_surface *surface)
{
    const tl_poly *a = view->a, *b = view->b;
    tl_plane pa = tl_view_plane(view, false, face_a), pb = tl_view_plane(view, true, face_b);
    tl_vec3 n = tl_v3_sub(pa.normal, pb.normal); /* twice the bisector's, but for the tilt */
    draft p = {surface, tl_poly_face_size(a, face_a)};
    if (!reserve(surface, p.count))
        return false;
    for (size_t i = 0; i < p.count; i++)
        surface->corner[surface->corners + i] = a->vertex[a->loop[a->start[face_a] + i]];
    for (uint32_t i = b->start[face_b]; i < b->start[face_b + 1]; i++) {
        tl_vec3 x = view->vertex_b[b->loop[i]];
        tl_vec3 y = view->vertex_b[b->loop[tl_poly_after(b, face_b, i)]];
        /* B's loop runs clockwise when seen as A's does */
        tl_vec3 out = tl_v3_cross(n, tl_v3_sub(y, x));
        if (!cut(&p, (tl_plane){out, tl_v3_dot(out, x)}))
            return false;
    }
    for (size_t i = 0; i < p.count; i++) {
        tl_vec3 *x = &surface->corner[surface->corners + i];
        double gap = tl_v3_dot(pb.normal, *x) - pb.offset;
        *x = tl_v3_madd(*x, 0.25 * gap, n);
    }
    if (has_area(&p, view->size))
        keep(&p);
    return true;
}

/* ---------------------------------------------------------------- fields ----------------- */

/* Where the depth under plane `other` is not less than under plane `nearest`. */
static tl_plane deeper(tl_plane other, tl_plane nearest)
{
    return (tl_plane){tl_v3_sub(other.normal, nearest.normal), other.offset - nearest.offset};
}

/* A square in the plane of equal depths, larger than the smaller block. */
static bool begin(draft *p, const tl_pair_view *view, tl_plane equal)
{
    const tl_poly *small = view->a->size < view->b->size ? view->a : view->b;
    tl_vec3 middle = small == view->a ? small->vertex[0] : view->vertex_b[0];
    tl_vec3 n = tl_v3_scale(1 / tl_v3_norm(equal.normal), equal.normal);
    double up = (tl_v3_dot(equal.normal, middle) - equal.offset) / tl_v3_norm(equal.normal);
    p->count = 0;
    if (fabs(up) > small->size)
        return true;
    middle = tl_v3_madd(middle, -up, n);
    tl_vec3 axis = fabs(n.x) < 0.5 ? tl_v3(1, 0, 0) : tl_v3(0, 1, 0);
    tl_vec3 t = tl_v3_cross(n, axis);
    t = tl_v3_scale(2 * small->size / tl_v3_norm(t), t);
    tl_vec3 s = tl_v3_cross(n, t);
    if (!reserve(p->surface, 4))
        return false;
    tl_vec3 *x = p->surface->corner + p->surface->corners;
    x[0] = tl_v3_add(middle, t);
    x[1] = tl_v3_add(middle, s);
    x[2] = tl_v3_sub(middle, t);
    x[3] = tl_v3_sub(middle, s);
    p->count = 4;
    return true;
}

static bool cut_by_depths(draft *p, const tl_press_query *of, bool of_b, const uint16_t *faces, uint32_t count,
                          uint32_t nearest)
{
    tl_plane near = tl_pressing_plane(of, of_b, nearest);
    for (uint32_t k = 0; k < count && p->count; k++)
        if (faces[k] != nearest && !cut(p, deeper(tl_pressing_plane(of, of_b, faces[k]), near)))
            return false;
    return true;
}

static bool cut_by_borders(draft *p, const tl_pair_view *view, bool of_b, const uint16_t *faces, uint32_t count)
{
    for (uint32_t k = 0; k < count && p->count; k++)
        if (!cut(p, tl_view_plane(view, of_b, faces[k])))
            return false;
    return true;
}

/* Whether the polygon's middle lies in both blocks, but for rounding. It does unless the blocks are apart: then the
 * listed faces may still enclose something. */
static bool is_inside(const draft *p, const tl_press_query *of)
{
    const tl_vec3 *x = p->surface->corner + p->surface->corners;
    tl_vec3 middle = tl_points_mean(x, p->count);
    double outside = -INFINITY;
    for (int side = 0; side < 2; side++) {
        const tl_poly *poly = side ? of->view->b : of->view->a;
        for (uint32_t f = 0; f < poly->face_count; f++) {
            tl_plane h = tl_pressing_plane(of, side, f);
            outside = fmax(outside, tl_v3_dot(h.normal, middle) - h.offset);
        }
    }
    return outside < TL_POLY_ON * of->view->size;
}

bool tl_surface_add_field(const tl_press_query *of, tl_surface *surface)
{
    const tl_pair_view *view = of->view;
    const tl_region *region = of->region;
    const uint16_t *in_a = region->face, *in_b = in_a + region->a;
    const uint16_t *border_a = in_b + region->b, *border_b = border_a + region->border_a;
    for (uint32_t i = 0; i < region->a; i++)
        for (uint32_t j = 0; j < region->b; j++) {
            tl_plane a = tl_pressing_plane(of, false, in_a[i]);
            tl_plane b = tl_pressing_plane(of, true, in_b[j]);
            tl_plane equal = deeper(a, b);
            draft p = {surface, 0};
            if (tl_v3_norm2(equal.normal) < ONE_DIRECTION)
                continue;
            if (!begin(&p, view, equal) || !cut(&p, a) || !cut_by_depths(&p, of, false, in_a, region->a, in_a[i]) ||
                !cut_by_depths(&p, of, true, in_b, region->b, in_b[j]) ||
                !cut_by_borders(&p, view, false, border_a, region->border_a) ||
                !cut_by_borders(&p, view, true, border_b, region->border_b))
                return false;
            if (has_area(&p, view->size) && is_inside(&p, of))
                keep(&p);
        }
    return true;
}
