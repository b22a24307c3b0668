/* press.c - what two blocks press on each other with.
 *
 * The energy is that of the pressure field (field.h), U_f = 2 kn G_f. Where two faces a and b lie flush, it is that of
 * their patch. For that only the distances to these two count, and to others of nearly their direction. All other
 * faces are borders, and U_p = 2 kn G_p. Between them one blend,
 *
 *     G = w G_f + (1 - w) G_p.
 *
 * So a patch under an initial stress, or opened by slip, passes into its field without a jump. The force is the
 * gradient of all of it,
 *
 *     F = w F_f + (1 - w) F_p - (G_f - G_p) grad w.
 *
 * A minimum area A_m joins the field's own area, A_e = V^2 / 4 G, at its mean overlap s = 4 G / V:
 *
 *     G_m = s^2 / 4 (A_e^2 + A_m^2)^(1/2),
 *
 * which is G without A_m.
 *
 * A law whose stress is not proportional to the overlap is given the area A_e, or (A_e^2 + A_m^2)^(1/2), and the
 * overlap s. Its energy follows from the integrals of d^0 .. d^3 over K (force/field_press.c). So these are blended
 * apart, without A_m, and the force follows from the gradients of all. */
#include "narrow/press.h"

#include "base/inline.h"
#include "base/table.h"
#include "narrow/corner_sums.h"
#include "narrow/field.h"
#include "narrow/field_mesh.h"
#include "narrow/share.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

/* Where the planes of a region are put together. */
typedef struct press_planes {
    tl_field_faces faces;
    tl_vec3 origin;
    uint32_t count;
    tl_mesh_vertices vertices; /* found when a mesh is to be made that needs them */
} press_planes;

/* Limit: corners of a block that are looked at for being among those in which more than three of the planes meet. */
#define MOST_VERTICES 64

/* ---------------------------------------------------------------- faces that press --------
 *
 * The planes of the faces that press, where they are moved out and lean. */

static bool press_reserve(tl_narrow_scratch *scratch, const tl_press_query query[], uint32_t count, press_planes p[])
{
    size_t all = 0;
    uint32_t faces[TL_FIELD_PAIRS];
    for (uint32_t k = 0; k < count; k++) {
        const tl_region *r = query[k].region;
        faces[k] = r->a + r->b + r->border_a + r->border_b + TL_FIELD_SPARE;
        all += faces[k];
    }
    if (!tl_grow(&scratch->press, &scratch->press_capacity, 4 * all, sizeof(double)))
        return false;
    double *at = scratch->press;
    for (uint32_t k = 0; k < count; k++) {
        for (uint32_t axis = 0; axis < 3; axis++, at += faces[k])
            p[k].faces.n[axis] = at;
        p[k].faces.c = at;
        at += faces[k];
    }
    return true;
}

/* How far a face is moved out. */
static double press_shift_of(const tl_press_query *of, bool of_b, uint32_t face)
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
    tl_plane plane = tl_view_plane(of->view, of_b, of_b ? of->shifted.b : of->shifted.a);
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
    return is_moved(of, of_b, face) ? moved_plane(of, of_b) : tl_view_plane(of->view, of_b, face);
}

TL_INLINE void put_plane(tl_plane plane, tl_vec3 origin, double *restrict x, double *restrict y, double *restrict z,
                         double *restrict c)
{
    *x = plane.normal.x;
    *y = plane.normal.y;
    *z = plane.normal.z;
    *c = plane.offset - tl_v3_dot(plane.normal, origin);
}

static uint32_t add_faces(press_planes *p, const tl_press_query *of, bool of_b, uint32_t begin, uint32_t count)
{
    if (count == 0)
        return 0;
    const tl_vec3 origin = p->origin;
    const uint16_t *face = of->region->face + begin;
    const bool moved = of->shift != 0 || of->lean;
    double *restrict x = p->faces.n[0] + p->count, *restrict y = p->faces.n[1] + p->count;
    double *restrict z = p->faces.n[2] + p->count, *restrict c = p->faces.c + p->count;
    for (uint32_t k = 0; k < count && moved; k++)
        put_plane(tl_pressing_plane(of, of_b, face[k]), origin, x + k, y + k, z + k, c + k);
    for (uint32_t k = 0; k < count && !moved && !of_b; k++)
        put_plane(of->view->a->plane[face[k]], origin, x + k, y + k, z + k, c + k);
    for (uint32_t k = 0; k < count && !moved && of_b; k++)
        put_plane(tl_view_plane(of->view, true, face[k]), origin, x + k, y + k, z + k, c + k);
    p->count += count;
    return count;
}

/* Adds faces on other parts; how many are seams through which something passes, with it. */
static uint32_t add_covered(press_planes *p, const tl_press_query *of, bool of_b, uint32_t begin, uint32_t count,
                            uint32_t *seams)
{
    const tl_poly *poly = of_b ? of->view->b : of->view->a;
    *seams = 0;
    for (uint32_t k = begin; k < begin + count && !of->opens; k++)
        *seams += poly->covered[of->region->face[k]] == TL_SEAM;
    return add_faces(p, of, of_b, begin, count);
}

/* Lists the planes where the first `a` listed faces of A and `b` of B press and the others are borders. */
static void list_planes(press_planes *p, const tl_press_query *of, uint32_t a, uint32_t b)
{
    const tl_region *r = of->region;
    const uint32_t covered_a = r->a + r->b, covered_b = covered_a + r->border_a;
    tl_field_faces *f = &p->faces;
    p->count = 0;
    f->a = add_faces(p, of, false, 0, a);
    f->b = add_faces(p, of, true, r->a, b);
    f->border_a = add_faces(p, of, false, a, r->a - a);
    f->border_a += add_covered(p, of, false, covered_a, r->border_a, &f->seam_a);
    f->border_b = add_faces(p, of, true, r->a + b, r->b - b);
    f->border_b += add_covered(p, of, true, covered_b, r->border_b, &f->seam_b);
}

/* Corners of one block, and which of the listed planes meet in each. */
typedef struct listed_vertices {
    uint32_t count, vertex[MOST_VERTICES];
    uint64_t planes[MOST_VERTICES];
} listed_vertices;

/* Adds a plane to those that meet in a vertex. false: there is no room. */
static bool add_plane(listed_vertices *to, uint32_t vertex, uint32_t plane)
{
    uint32_t k = 0;
    while (k < to->count && to->vertex[k] != vertex)
        k++;
    if (k == MOST_VERTICES)
        return false;
    if (k == to->count)
        to->planes[to->count++] = 0;
    to->vertex[k] = vertex;
    to->planes[k] |= UINT64_C(1) << plane;
    return true;
}

/* Adds the corners of faces whose planes are listed from number `plane` on. */
static bool add_corners(listed_vertices *to, const tl_poly *poly, const uint16_t *face, uint32_t count, uint32_t plane)
{
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t h = face[k] < poly->face_count ? poly->start[face[k]] : 0;
             face[k] < poly->face_count && h < poly->start[face[k] + 1u]; h++)
            if (!add_plane(to, poly->loop[h], plane + k))
                return false;
    return true;
}

/* Three planes of some that meet at the sharpest, the first of all among them if it is a face's. */
static void choose_three(const tl_field_faces *f, uint64_t planes, uint8_t three[3])
{
    uint8_t at[TL_FIELD_KNOWN];
    uint32_t count = 0;
    double most = -1;
    for (uint8_t k = 0; k < TL_FIELD_KNOWN; k++)
        if (planes >> k & 1)
            at[count++] = k;
    for (uint32_t i = 0; i < (at[0] < f->a + f->b ? 1 : count); i++)
        for (uint32_t j = i + 1; j < count; j++)
            for (uint32_t k = j + 1; k < count; k++) {
                tl_vec3 across = tl_v3_cross(tl_field_normal(f, at[i]), tl_field_normal(f, at[j]));
                double sharp = fabs(tl_v3_dot(across, tl_field_normal(f, at[k])));
                if (sharp <= most)
                    continue;
                most = sharp;
                three[0] = at[i];
                three[1] = at[j];
                three[2] = at[k];
            }
}

/* Lists the corners of the blocks in which more than three planes meet. The first `a` faces of A and `b` of B come
 * before all borders. */
static void list_vertices(press_planes *p, const tl_press_query *of, uint32_t a, uint32_t b)
{
    const tl_region *r = of->region;
    const uint16_t *face_a = r->face, *face_b = face_a + r->a, *covered_a = face_b + r->b;
    const uint32_t border_a = a + b, border_b = border_a + r->a - a + r->border_a;
    listed_vertices of_a = {.count = 0}, of_b = {.count = 0};
    const listed_vertices *const all[] = {&of_a, &of_b};
    p->vertices.count = 0;
    p->faces.vertices = &p->vertices;
    if (!add_corners(&of_a, of->view->a, face_a, a, 0) ||
        !add_corners(&of_a, of->view->a, face_a + a, r->a - a, border_a) ||
        !add_corners(&of_a, of->view->a, covered_a, r->border_a, border_a + r->a - a) ||
        !add_corners(&of_b, of->view->b, face_b, b, a) ||
        !add_corners(&of_b, of->view->b, face_b + b, r->b - b, border_b) ||
        !add_corners(&of_b, of->view->b, covered_a + r->border_a, r->border_b, border_b + r->b - b))
        return;
    for (int side = 0; side < 2; side++)
        for (uint32_t k = 0; k < all[side]->count && p->vertices.count < TL_MESH_VERTICES; k++) {
            const uint64_t planes = all[side]->planes[k];
            uint64_t more = planes; /* than three, without the lowest bits of as many */
            for (int i = 0; i < 3; i++)
                more &= more - 1;
            if (!more)
                continue;
            choose_three(&p->faces, planes, p->vertices.three[p->vertices.count]);
            p->vertices.planes[p->vertices.count++] = planes;
        }
}

/* ---------------------------------------------------------------- presses ----------------- */

/* Tolerance: depth over the size of the smaller block up to which the integrals are looked at for being nothing but
 * roundings. Test: lua/test_faint. */
#define FAINT 1e-7
/* Tolerance: depth, over the deepest point's, by which that point may lie outside a block for rounding. Test:
 * property/press_properties. */
#define INSIDE 1e-6
/* Tolerance: sum over those of its parts that may be nothing but their roundings. A single corner has no radius, and
 * the root of a rounding would be 1e-8 m. Test: lua/test_law_rounding. */
#define ROUNDED 1e-14
/* Volume between two faces, over what the blocks have in common, beyond which they are no patch. Of an edge that is
 * pressed into both it is 1. */
#define FAR_APART 30

/* ---------------------------------------------------------------- noise ------------------ */

/* Whether the deepest point lies in both blocks, as it does if they have anything in common. */
static bool in_both(const tl_press_query *of, tl_vec3 x, double depth)
{
    for (int of_b = 0; of_b < 2; of_b++) {
        uint32_t count = (of_b ? of->view->b : of->view->a)->face_count;
        for (uint32_t f = 0; f < count; f++) {
            tl_plane plane = tl_pressing_plane(of, of_b, f);
            if (tl_v3_dot(plane.normal, x) > plane.offset + INSIDE * depth)
                return false;
        }
    }
    return true;
}

/* Whether the integrals of blocks that hardly overlap are no more than roundings. Otherwise the centre of pressure
 * lies in both blocks, and with a minimum area their mean depth is no larger than the largest. */
static bool is_noise(const tl_press_query *of, const press_planes *p, const tl_field_sums *sums)
{
    double size = of->view->size;
    if (sums->deepest > FAINT * size)
        return false;
    tl_vec3 centre = tl_v3_madd(p->origin, 1 / sums->pressure, sums->pressed);
    bool deeper = of->min_area > 0 && !(sums->energy <= 2 * sums->deepest * sums->volume);
    return deeper || !in_both(of, centre, TL_TOUCHING / INSIDE * size);
}

/* ---------------------------------------------------------------- energies --------------- */

/* G_m of the minimum area. */
static tl_field_power with_min_area(const tl_field_sums *f, double min_area)
{
    tl_vec3 force = tl_v3_add(f->force, f->through);
    tl_vec3 moment = tl_v3_add(f->moment, f->through_moment);
    if (!(min_area > 0))
        return (tl_field_power){f->energy, force, moment};
    double g = f->energy, v = f->volume, s = 4 * g / v, area = 0.25 * v * v / g;
    double r = sqrt(area * area + min_area * min_area), ds = 0.5 * s * r, dr = 0.25 * s * s * area / r;
    double by_g = ds * 4 / v - dr * area / g, by_v = -ds * s / v + dr * 2 * area / v;
    return (tl_field_power){0.25 * s * s * r, tl_v3_madd(tl_v3_scale(by_g, force), by_v, f->swept),
                            tl_v3_madd(tl_v3_scale(by_g, moment), by_v, f->swept_moment)};
}

/* Two flush faces, the integrals over their patch, and its share. */
typedef struct flush_patch {
    tl_field_sums sums;
    tl_patch_share by;
} flush_patch;

/* Of two blocks so many pairs of faces may press as patches at once, where an edge is pressed into one. */
enum { MOST_PATCHES = 3 };

typedef struct patches {
    flush_patch of[MOST_PATCHES];
    uint32_t count;
} patches;

/* What the patches leave to the field. */
static double field_share(const patches *p)
{
    double w = 1;
    for (uint32_t k = 0; k < p->count; k++)
        w -= p->of[k].by.share;
    return w;
}

/* Blends an integral over the field with those over the patches. */
static void blend(const patches *p, const tl_field_power flat[], tl_field_power *field)
{
    const tl_field_power all = *field;
    const double w = field_share(p);
    *field = (tl_field_power){w * all.whole, tl_v3_scale(w, all.force), tl_v3_scale(w, all.moment)};
    for (uint32_t k = 0; k < p->count; k++) {
        const tl_patch_share *by = &p->of[k].by;
        double more = all.whole - flat[k].whole;
        field->whole += by->share * flat[k].whole;
        field->force = tl_v3_madd(field->force, by->share, flat[k].force);
        field->moment = tl_v3_madd(field->moment, by->share, flat[k].moment);
        field->force = tl_v3_madd(field->force, more, by->push);
        field->moment = tl_v3_madd(field->moment, more, by->turn);
    }
}

/* What a law that is not linear needs beside the energy. */
static void find_powers(const tl_field_sums *f, tl_field_power out[TL_PRESS_POWERS])
{
    out[TL_PRESS_VOLUME] = (tl_field_power){f->volume, f->swept, f->swept_moment};
    out[TL_PRESS_SQUARE] = f->powers[0];
    out[TL_PRESS_CUBE] = f->powers[1];
}

static void blend_powers(const patches *p, tl_field_power field[TL_PRESS_POWERS])
{
    tl_field_power flat[MOST_PATCHES][TL_PRESS_POWERS], of[MOST_PATCHES];
    for (uint32_t i = 0; i < p->count; i++)
        find_powers(&p->of[i].sums, flat[i]);
    for (int k = 0; k < TL_PRESS_POWERS; k++) {
        for (uint32_t i = 0; i < p->count; i++)
            of[i] = flat[i][k];
        blend(p, of, &field[k]);
    }
}

/* Whether planes of other parts are listed: they may be the nearest to some point and bound nothing. */
static bool has_shared_planes(const tl_press_query *of)
{
    const tl_region *r = of->region;
    uint32_t own[] = {of->view->a->face_count, of->view->b->face_count};
    if (of->view->a->plane_count == own[0] && of->view->b->plane_count == own[1])
        return false;
    for (uint32_t k = 0; k < r->a + r->b; k++)
        if (r->face[k] >= own[k >= r->a])
            return true;
    return false;
}

/* Whether what is known of the field at another place may be of use here. */
static bool is_of_use(const tl_press_query *of)
{
    const tl_region *r = of->region;
    return r->mesh && of->shift == 0 && !of->lean && r->a + r->b + r->border_a + r->border_b <= TL_FIELD_KNOWN;
}

/* The integrals over the patch of the flush faces, by its mesh if that is known. One that has just been made is gone by
 * at once, as in begin_mesh. false: out of memory. */
static bool sum_patch(const tl_press_query *of, press_planes *p, tl_narrow_scratch *scratch, tl_field_sums *out)
{
    const tl_mesh_inner none = {.count = 0}; /* all its polygons have all corners */
    const tl_field_faces *faces = &p->faces;
    tl_field_mesh *mesh = of->region->flat;
    list_planes(p, of, of->region->blunt_a, of->region->blunt_b);
    p->faces.mesh = mesh && is_of_use(of) ? mesh : NULL;
    p->faces.inner = &none;
    p->faces.seamed = true;
    p->faces.energy_only = false;
    p->faces.powers = of->volumes;
    if (p->faces.mesh && tl_mesh_integrate(faces, out))
        return true;
    p->faces.vertices = NULL;
    if (p->faces.mesh)
        list_vertices(p, of, of->region->blunt_a, of->region->blunt_b);
    if (!tl_field_integrate(&faces, &out, 1, &scratch->field))
        return false;
    const tl_field_sums anew = *out;
    if (p->faces.mesh && !tl_mesh_integrate(faces, out)) {
        *out = anew;
        mesh->polygons = 0;
    }
    return true;
}

/* Whether a number is so far above the smallest ones that its square is known to all digits. */
static bool has_square(double x)
{
    return isnormal(x * x);
}

/* Nothing presses: nothing is known for another place. */
static bool no_press(const tl_region *region)
{
    if (region->mesh)
        region->mesh->bounding = region->mesh->polygons = 0;
    return true;
}

/* The integrals that tell where and on what area something presses, of a field of which shares are those of patches. */
static void mix_places(tl_field_sums *field, const patches *p)
{
    const double w = field_share(p);
    field->area = tl_v3_scale(w, field->area);
    field->pressure *= w;
    field->pressed = tl_v3_scale(w, field->pressed);
    field->extent *= w;
    field->first = tl_v3_scale(w, field->first);
    field->second *= w;
    field->stiffness *= w;
    for (uint32_t k = 0; k < p->count; k++) {
        const tl_field_sums *patch = &p->of[k].sums;
        double share = p->of[k].by.share;
        field->area = tl_v3_madd(field->area, share, patch->area);
        field->pressure += share * patch->pressure;
        field->pressed = tl_v3_madd(field->pressed, share, patch->pressed);
        field->extent += share * patch->extent;
        field->first = tl_v3_madd(field->first, share, patch->first);
        field->second += share * patch->second;
        field->stiffness += share * patch->stiffness;
    }
}

/* Adds the patch of two faces, if it has a share. Faces that are not the flush ones may face each other far apart,
 * with all of the blocks between them. false: out of memory. */
static bool add_patch(const tl_press_query *of, press_planes *p, tl_face_pair faces, bool corners,
                      const tl_field_sums *field, tl_narrow_scratch *scratch, patches *to)
{
    const tl_pair_view *view = of->view;
    const uint32_t fa = faces.a, fb = faces.b;
    const tl_vec3 *na = &view->a->plane[fa].normal, *nb = &view->normal_b[fb];
    const tl_corner_faces at = {
        .fa = fa, .fb = fb, .a = tl_pressing_plane(of, 0, fa), .b = tl_pressing_plane(of, 1, fb)};
    const double shift = press_shift_of(of, false, fa) + press_shift_of(of, true, fb);
    flush_patch *patch = &to->of[to->count];
    if (to->count == MOST_PATCHES)
        return true;
    if (!(corners ? tl_corner_sums_find(view, &at, p->origin, scratch, &patch->sums)
                  : sum_patch(of, p, scratch, &patch->sums)))
        return false;
    if (!(patch->sums.energy > 0) || !has_square(patch->sums.volume))
        return true;
    const bool flush = fa == of->region->flush_a && fb == of->region->flush_b;
    if (!flush && patch->sums.volume > FAR_APART * 2 * field->deepest * tl_v3_norm(field->area))
        return true;
    patch->by = tl_patch_share_of(na, nb, corners, shift, &patch->sums, field);
    if (!(patch->by.share > 0))
        return true;
    if (corners) {
        if (!tl_corner_sums_slopes(view, &at, p->origin, scratch, &patch->sums))
            return false;
        patch->by = tl_patch_share_of(na, nb, corners, shift, &patch->sums, field);
    }
    to->count++;
    return true;
}

/* What is left of the shares s_k of patches where several have one: s_k times all other 1 - s_j. So it makes no
 * difference which of them is taken to be the flush one. */
static void part(patches *p)
{
    tl_patch_share whole[MOST_PATCHES];
    for (uint32_t k = 0; k < p->count; k++)
        whole[k] = p->of[k].by;
    for (uint32_t k = 0; k < p->count; k++)
        for (uint32_t j = 0; j < p->count; j++) {
            tl_patch_share *by = &p->of[k].by;
            if (j == k)
                continue;
            by->push = tl_v3_madd(tl_v3_scale(1 - whole[j].share, by->push), -by->share, whole[j].push);
            by->turn = tl_v3_madd(tl_v3_scale(1 - whole[j].share, by->turn), -by->share, whole[j].turn);
            by->share *= 1 - whole[j].share;
        }
}

/* The patches that have a share: that of the flush faces, and, at corners, those of others that face each other. For
 * springs there press up to tilts at which an edge may lie in both. false: out of memory. */
static bool find_patches(const tl_press_query *of, press_planes *p, const tl_field_sums *field,
                         tl_narrow_scratch *scratch, patches *out)
{
    const tl_pair_view *view = of->view;
    const tl_region *r = of->region;
    const tl_poly *a = view->a, *b = view->b;
    const uint32_t fa = r->flush_a, fb = r->flush_b;
    out->count = 0;
    if (!r->flush)
        return true;
    const bool corners = of->corners && tl_at_corners(a, fa, b, fb);
    const double steep = tl_flush_limits_of(corners).field_tilt;
    const bool flush = tl_region_tilt(view, fa, fb) < steep;
    if (flush && !add_patch(of, p, (tl_face_pair){r->flush_a, r->flush_b}, corners, field, scratch, out))
        return false;
    for (uint32_t k = 0; k < r->a && of->corners; k++)
        for (uint32_t m = r->a; m < r->a + r->b; m++) {
            const tl_face_pair f = {r->face[k], r->face[m]};
            if ((f.a == fa && f.b == fb) || f.a >= a->face_count || f.b >= b->face_count ||
                tl_v3_dot(a->plane[f.a].normal, view->normal_b[f.b]) > 0 || !(tl_region_tilt(view, f.a, f.b) < steep) ||
                !tl_at_corners(a, f.a, b, f.b))
                continue;
            if (!add_patch(of, p, f, true, field, scratch, out))
                return false;
        }
    part(out);
    return true;
}

/* What a law that is not linear needs of a press, with the area of the field and its overlap. */
static void put_powers(const tl_press_query *of, tl_vec3 origin, const tl_field_power powers[TL_PRESS_POWERS],
                       tl_press *press, tl_press_extra *extra)
{
    const double volume = powers[TL_PRESS_VOLUME].whole;
    const double area = 0.25 * volume * volume / press->energy;
    *extra = (tl_press_extra){.lifted_powers = {0}};
    for (int k = 0; k < TL_PRESS_POWERS; k++) {
        extra->powers[k] = powers[k];
        extra->powers[k].moment = tl_v3_add(powers[k].moment, tl_v3_cross(origin, powers[k].force));
    }
    press->powers = true;
    press->area = sqrt(area * area + of->min_area * of->min_area);
    press->overlap = 4 * press->energy / volume;
}

/* Slopes about A's zero of those about another origin. A patch that presses, too, has others. */
static void finish_slope(tl_field_slope *slope, tl_vec3 origin, bool patch)
{
    slope->known = slope->known && !patch;
    for (int k = 0; k < 3 && slope->known; k++) {
        const tl_vec3 axis = {k == 0, k == 1, k == 2}, way = tl_v3_cross(axis, origin);
        const double by[] = {way.x, way.y, way.z};
        for (int j = 0; j < 3; j++) {
            slope->force[3 + k] = tl_v3_madd(slope->force[3 + k], by[j], slope->force[j]);
            slope->moment[3 + k] = tl_v3_madd(slope->moment[3 + k], by[j], slope->moment[j]);
        }
    }
    for (int k = 0; k < 6 && slope->known; k++)
        slope->moment[k] = tl_v3_add(slope->moment[k], tl_v3_cross(origin, slope->force[k]));
}

/* Radius of gyration of the area about a place: none where it is a rounding of what is subtracted, as at a single
 * corner. */
static double radius_of(const tl_field_sums *sums, tl_vec3 about)
{
    double moved = tl_v3_norm2(about) * sums->extent, whole = sums->second + moved;
    double second = sums->second - 2 * tl_v3_dot(about, sums->first) + moved;
    return second > ROUNDED * whole ? sqrt(second / sums->extent) : 0;
}

/* The press of a pair from the integrals of its field. `same`: over faces that have enclosed the common volume before.
 * Nothing presses where a part only passes on through its seams what the next parts press with, to the last digit. */
static bool press_of(const tl_press_query *of, press_planes *p, tl_field_sums *sums, bool same,
                     tl_narrow_scratch *scratch, tl_press *press, tl_press_extra *extra)
{
    const tl_pair_view *view = of->view;
    const tl_region *region = of->region;
    *press = (tl_press){0};
    if (!(sums->deepest > TL_TOUCHING * view->size) || !(tl_v3_norm(sums->force) > 0) || !(sums->energy > 0) ||
        is_noise(of, p, sums) || !(same || in_both(of, tl_v3_add(p->origin, sums->deepest_at), sums->deepest)))
        return no_press(region);
    const double min_area = of->volumes ? 0 : of->min_area;
    tl_field_power field = with_min_area(sums, min_area), powers[TL_PRESS_POWERS];
    if (of->volumes)
        find_powers(sums, powers);
    patches flush;
    if (!find_patches(of, p, sums, scratch, &flush))
        return false;
    if (flush.count) {
        tl_field_power flat[MOST_PATCHES];
        for (uint32_t k = 0; k < flush.count; k++) {
            flat[k] = with_min_area(&flush.of[k].sums, min_area);
            press->patch += flush.of[k].by.share;
        }
        blend(&flush, flat, &field);
        if (of->volumes)
            blend_powers(&flush, powers);
        mix_places(sums, &flush);
    }
    double force = tl_v3_norm(field.force), area = tl_v3_norm(sums->area);
    if (!has_square(force) || !has_square(area)) {
        *press = (tl_press){0};
        return no_press(region);
    }
    press->energy = field.whole;
    press->force = field.force;
    press->moment = tl_v3_add(field.moment, tl_v3_cross(p->origin, field.force));
    press->normal = tl_v3_scale(1 / force, field.force);
    press->area = sqrt(area * area + of->min_area * of->min_area);
    press->overlap = 2 * force / press->area;
    if (of->volumes)
        put_powers(of, p->origin, powers, press, extra);
    press->deepest = 2 * sums->deepest;
    press->stiffness = fmax(sums->stiffness, press->area);
    tl_vec3 centre = tl_v3_scale(1 / sums->pressure, sums->pressed);
    press->point = tl_v3_add(p->origin, centre);
    press->radius = radius_of(sums, centre);
    if (p->faces.slope)
        finish_slope(p->faces.slope, p->origin, flush.count > 0);
    return true;
}

/* The planes of a pair's field about a point. */
static void begin(const tl_press_query *of, tl_vec3 origin, press_planes *p)
{
    p->origin = origin;
    list_planes(p, of, of->region->a, of->region->b);
    p->faces.energy_only = !(of->min_area > 0 || of->volumes);
    p->faces.powers = of->volumes;
    p->faces.slope = p->faces.energy_only ? of->slope : NULL;
    p->faces.mesh = of->region->mesh;
    p->faces.inner = NULL;
    p->faces.vertices = NULL;
    p->faces.seamed = of->region->border_a + of->region->border_b > 0 || has_shared_planes(of);
}

/* The integrals by the mesh that is known; false: they are to be found. */
static bool follow(const tl_press_query *of, press_planes *p, tl_field_sums *sums)
{
    tl_field_mesh *mesh = of->region->mesh;
    if (mesh && !is_of_use(of))
        mesh->bounding = mesh->polygons = 0;
    if (!mesh || mesh->polygons == 0)
        return false;
    begin(of, mesh->origin, p);
    return tl_mesh_integrate(&p->faces, sums);
}

/* Goes by a mesh that has just been made at once: so the same is found when all is done again. */
static void begin_mesh(const tl_press_query *of, press_planes *p, tl_field_sums *sums)
{
    tl_field_mesh *mesh = of->region->mesh;
    if (!mesh || mesh->polygons == 0 || !(sums->pressure > 0))
        return;
    const tl_vec3 origin = p->origin, centre = tl_v3_scale(1 / sums->pressure, sums->pressed);
    mesh->origin = tl_v3_add(origin, centre);
    begin(of, mesh->origin, p);
    if (tl_mesh_integrate(&p->faces, sums))
        return;
    mesh->polygons = 0;
    begin(of, origin, p);
}

/* The three listed faces of a block that meet in a vertex at the sharpest. false: there are no three. */
static bool faces_at(const tl_pair_view *view, const tl_region *r, bool of_b, uint32_t vertex, uint8_t face[3])
{
    const tl_poly *p = of_b ? view->b : view->a;
    uint32_t begin = of_b ? r->a : 0, end = begin + (of_b ? r->b : r->a);
    uint32_t at[TL_FIELD_KNOWN], count = 0;
    tl_vec3 n[TL_FIELD_KNOWN];
    for (uint32_t k = begin; k < end; k++)
        for (uint32_t h = p->start[r->face[k]]; h < p->start[r->face[k] + 1u]; h++)
            if (p->loop[h] == vertex) {
                n[count] = of_b ? view->normal_b[r->face[k]] : p->plane[r->face[k]].normal;
                at[count++] = k;
            }
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = i + 1; j < count; j++)
            for (uint32_t k = j + 1; k < count; k++) {
                double sharp = fabs(tl_v3_dot(tl_v3_cross(n[i], n[j]), n[k]));
                if (sharp <= most)
                    continue;
                most = sharp;
                face[0] = (uint8_t)at[i];
                face[1] = (uint8_t)at[j];
                face[2] = (uint8_t)at[k];
            }
    return most > 0;
}

/* The corners of one block that lie in the other, as far as the listed faces tell. A corner has the numbers of three
 * of them in the list. */
static void list_inner_corners(const tl_pair_view *view, const tl_region *r, tl_mesh_inner *out)
{
    out->count = 0;
    for (int of_b = 0; of_b < 2; of_b++) {
        const tl_poly *p = of_b ? view->b : view->a;
        const tl_vec3 *vertex = of_b ? view->vertex_b : view->a->vertex;
        uint32_t other = of_b ? 0 : r->a, end = of_b ? r->a : r->a + r->b;
        for (uint32_t i = 0; i < p->vertex_count && out->count <= TL_MESH_INNER; i++) {
            bool inside = true;
            for (uint32_t k = other; k < end && inside; k++) {
                tl_plane plane = tl_view_plane(view, !of_b, r->face[k]);
                inside = tl_v3_dot(plane.normal, vertex[i]) <= plane.offset;
            }
            if (!inside)
                continue;
            if (out->count == TL_MESH_INNER || !faces_at(view, r, of_b, i, out->face[out->count])) {
                out->count = TL_MESH_INNER + 1;
                return;
            }
            out->count++;
        }
    }
}

/* Forgets what is no longer known, and finds what a new mesh needs. */
static void begin_anew(const tl_press_query *of, press_planes *p, tl_mesh_inner *inner)
{
    const tl_pair_view *view = of->view;
    bool b_is_small = view->b->size < view->a->size;
    tl_field_mesh *mesh = of->region->mesh;
    begin(of, b_is_small ? view->vertex_b[0] : view->a->vertex[0], p);
    if (!mesh || !is_of_use(of))
        return;
    p->faces.inner = inner;
    inner->count = 0;
    if (p->faces.seamed) /* its polygons have all corners */
        return;
    if (mesh->bounding && !tl_region_corners_agree(of->view, of->region))
        mesh->bounding = 0;
    list_inner_corners(of->view, of->region, inner);
}

/* Whether the press of a field that goes by its mesh needs the listed faces only: in_both needs all, patches at corners
 * need vertices. */
static bool faces_suffice(const tl_press_query *of, const tl_field_sums *sums)
{
    return sums->deepest > FAINT * of->view->size && !of->corners;
}

static bool find_all(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch, tl_press press[],
                     tl_press_extra extra[])
{
    press_planes p[TL_FIELD_PAIRS];
    uint64_t known[TL_FIELD_PAIRS];
    tl_mesh_inner inner[TL_FIELD_PAIRS];
    tl_field_sums sums[TL_FIELD_PAIRS], *to[TL_FIELD_PAIRS] = {NULL};
    const tl_field_faces *faces[TL_FIELD_PAIRS] = {NULL};
    uint32_t left = 0, anew[TL_FIELD_PAIRS];
    if (!press_reserve(scratch, query, count, p))
        return false;
    for (uint32_t k = 0; k < count; k++) {
        if (query[k].slope)
            query[k].slope->known = false;
        bool found = follow(&query[k], &p[k], &sums[k]);
        known[k] = found ? p[k].faces.mesh->bounding : 0;
        if (query[k].faces_only && !(known[k] && faces_suffice(&query[k], &sums[k])))
            tl_pair_place_all(query[k].view);
        if (found)
            continue;
        begin_anew(&query[k], &p[k], &inner[k]);
        known[k] = p[k].faces.mesh ? p[k].faces.mesh->bounding : 0;
        faces[left] = &p[k].faces;
        to[left] = &sums[k];
        anew[left++] = k;
    }
    if (left && !tl_field_integrate(faces, to, left, &scratch->field))
        return false;
    for (uint32_t k = 0; k < left; k++)
        begin_mesh(&query[anew[k]], &p[anew[k]], &sums[anew[k]]);
    for (uint32_t k = 0; k < count; k++) {
        bool same = known[k] && p[k].faces.mesh->bounding == known[k];
        tl_press_extra *more = extra ? &extra[k] : NULL;
        if (!press_of(&query[k], &p[k], &sums[k], same, scratch, &press[k], more))
            return false;
    }
    return true;
}

/* What slip has added to energies and volumes in the last step: they are found again without. */
static bool find_lifted(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch, tl_press press[],
                        tl_press_extra extra[])
{
    tl_press_query before[TL_FIELD_PAIRS];
    tl_region region[TL_FIELD_PAIRS];
    tl_press without[TL_FIELD_PAIRS];
    tl_press_extra extra_without[TL_FIELD_PAIRS];
    uint32_t opened[TL_FIELD_PAIRS], some = 0;
    for (uint32_t k = 0; k < count; k++) {
        if (query[k].opened == 0 || !(press[k].area > 0))
            continue;
        region[some] = *query[k].region;
        region[some].mesh = region[some].flat = NULL;
        before[some] = query[k];
        before[some].region = &region[some];
        before[some].shift -= query[k].opened;
        before[some].slope = NULL;
        opened[some++] = k;
    }
    if (some == 0)
        return true;
    if (!find_all(before, some, scratch, without, extra_without))
        return false;
    for (uint32_t i = 0; i < some; i++) {
        tl_press *now = &press[opened[i]];
        tl_press_extra *more = &extra[opened[i]];
        now->lifted = now->energy - without[i].energy;
        if (!now->powers)
            *more = (tl_press_extra){.lifted_powers = {0}};
        for (int k = 0; k < TL_PRESS_POWERS && now->powers; k++) {
            double whole = without[i].powers ? extra_without[i].powers[k].whole : 0;
            more->lifted_powers[k] = more->powers[k].whole - whole;
        }
        more->lifted_force = tl_v3_sub(now->force, without[i].force);
        more->lifted_moment = tl_v3_sub(now->moment, without[i].moment);
    }
    return true;
}

bool tl_press_find(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch, tl_press press[],
                   tl_press_extra extra[])
{
    return find_all(query, count, scratch, press, extra) &&
           (!extra || find_lifted(query, count, scratch, press, extra));
}
