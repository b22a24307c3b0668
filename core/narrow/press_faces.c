/* press_faces.c - the planes of the faces that press, where they are moved out and lean. */
#include "narrow/press_faces.h"

#include <stdlib.h>
#include <talus/vmath.h>

bool tl_press_reserve(tl_narrow_scratch *scratch, const tl_press_query query[], uint32_t count,
                      tl_press_planes p[])
{
    size_t all = 0;
    uint32_t faces[TL_FIELD_PAIRS];
    for (uint32_t k = 0; k < count; k++) {
        const tl_region *r = query[k].region;
        faces[k] = r->a + r->b + r->border_a + r->border_b;
        faces[k] = faces[k] > TL_FIELD_KNOWN ? faces[k] : TL_FIELD_KNOWN + 1; /* field_mesh.c */
        all += faces[k];
    }
    if (4 * all > scratch->press_capacity) {
        double *press = realloc(scratch->press, 8 * all * sizeof *press);
        if (!press)
            return false;
        scratch->press = press;
        scratch->press_capacity = 8 * all;
    }
    double *at = scratch->press;
    for (uint32_t k = 0; k < count; k++) {
        for (uint32_t axis = 0; axis < 3; axis++, at += faces[k])
            p[k].faces.n[axis] = at;
        p[k].faces.c = at;
        at += faces[k];
    }
    return true;
}

static tl_plane plane_of(const tl_pair_view *view, bool of_b, uint32_t face)
{
    if (!of_b)
        return view->a->plane[face];
    return (tl_plane){view->normal_b[face],
                      view->b->plane[face].offset + tl_v3_dot(view->normal_b[face], view->shift)};
}

static void add(tl_press_planes *p, tl_plane plane)
{
    p->faces.n[0][p->count] = plane.normal.x;
    p->faces.n[1][p->count] = plane.normal.y;
    p->faces.n[2][p->count] = plane.normal.z;
    p->faces.c[p->count++] = plane.offset - tl_v3_dot(plane.normal, p->origin);
}

double tl_press_shift_of(const tl_press_query *of, bool of_b, uint32_t face)
{
    return face == (of_b ? of->shifted.b : of->shifted.a) ? 0.5 * of->shift : 0;
}

static bool is_moved(const tl_press_query *of, bool of_b, uint32_t face)
{
    return face == (of_b ? of->shifted.b : of->shifted.a) && (of->shift != 0 || of->lean);
}

/* Where a face of the two that are moved is. */
static tl_plane moved_plane(const tl_press_query *of, bool of_b)
{
    tl_plane plane = plane_of(of->view, of_b, of_b ? of->shifted.b : of->shifted.a);
    if (of->lean) {
        plane = of->lean[of_b];
        plane.normal = of_b ? tl_m3_mul(&of->view->turn, plane.normal) : plane.normal;
        plane.offset += of_b ? tl_v3_dot(plane.normal, of->view->shift) : 0;
    }
    plane.offset += 0.5 * of->shift;
    return plane;
}

tl_plane tl_pressing_plane(const tl_press_query *of, bool of_b, uint32_t face)
{
    return is_moved(of, of_b, face) ? moved_plane(of, of_b) : plane_of(of->view, of_b, face);
}

static void add_face(tl_press_planes *p, const tl_press_query *of, bool of_b, uint32_t face)
{
    add(p, tl_pressing_plane(of, of_b, face));
}

static uint32_t add_faces(tl_press_planes *p, const tl_press_query *of, bool of_b, uint32_t begin,
                          uint32_t count)
{
    for (uint32_t k = begin; k < begin + count; k++)
        add_face(p, of, of_b, of->region->face[k]);
    return count;
}

/* Adds faces on other parts; how many are seams through which something passes, with it. */
static uint32_t add_covered(tl_press_planes *p, const tl_press_query *of, bool of_b, uint32_t begin,
                            uint32_t count, uint32_t *seams)
{
    const tl_poly *poly = of_b ? of->view->b : of->view->a;
    *seams = 0;
    for (uint32_t k = begin; k < begin + count && !of->opens; k++)
        *seams += poly->covered[of->region->face[k]] == TL_SEAM;
    return add_faces(p, of, of_b, begin, count);
}

void tl_press_list_field(tl_press_planes *p, const tl_press_query *of)
{
    const tl_region *r = of->region;
    p->count = 0;
    p->faces.a = add_faces(p, of, false, 0, r->a);
    p->faces.b = add_faces(p, of, true, r->a, r->b);
    uint32_t covered = r->a + r->b;
    p->faces.border_a = add_covered(p, of, false, covered, r->border_a, &p->faces.seam_a);
    p->faces.border_b =
        add_covered(p, of, true, covered + r->border_a, r->border_b, &p->faces.seam_b);
}

void tl_press_list_patch(tl_press_planes *p, const tl_press_query *of)
{
    const tl_region *r = of->region;
    uint32_t more_a = r->a - r->blunt_a, more_b = r->b - r->blunt_b;
    p->count = 0;
    p->faces.a = add_faces(p, of, false, 0, r->blunt_a);
    p->faces.b = add_faces(p, of, true, r->a, r->blunt_b);
    uint32_t covered = r->a + r->b;
    p->faces.border_a = add_faces(p, of, false, r->blunt_a, more_a);
    p->faces.border_a += add_covered(p, of, false, covered, r->border_a, &p->faces.seam_a);
    p->faces.border_b = add_faces(p, of, true, r->a + r->blunt_b, more_b);
    p->faces.border_b +=
        add_covered(p, of, true, covered + r->border_a, r->border_b, &p->faces.seam_b);
}
