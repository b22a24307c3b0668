/* press.c - what two blocks press on each other with.
 *
 * The energy is that of the pressure field (field.h), U_f = 2 kn G_f. Where two faces a and b lie flush, it is that of
 * their patch, for which only the distances to these two count, and to others of nearly their direction, and all other
 * faces are borders, U_p = 2 kn G_p. Between
 * them one blend,
 *
 *     G = w G_f + (1 - w) G_p
 *
 * (share.c). So a patch under an initial stress, or opened by slip, passes into its field without a jump. The force is the gradient of
 * all of it,
 *
 *     F = w F_f + (1 - w) F_p - (G_f - G_p) grad w.
 *
 * A minimum area A_m joins the field's own area, A_e = V^2 / 4 G, at its mean overlap s = 4 G / V:
 *
 *     G_m = s^2 / 4 (A_e^2 + A_m^2)^(1/2),
 *
 * which is G without A_m.
 *
 * A law whose stress is not proportional to the overlap is given the area A_e, or (A_e^2 + A_m^2)^(1/2), and the overlap s. Its
 * energy follows from the integrals of d^0 .. d^3 over K (force/field_press.c): so these are blended apart, without A_m, and the force
 * follows from the gradients of all. */
#include "narrow/press.h"

#include "base/columns.h"
#include "narrow/field_mesh.h"
#include "narrow/patch.h"
#include "narrow/scratch.h"
#include "narrow/share.h"

#include <stdlib.h>
#include <talus/vmath.h>

/* Depth over the size of the smaller block up to which the integrals are looked at for being nothing but roundings. */
#define FAINT 1e-7
/* Depth, over the deepest point's, by which that point may lie outside a block for rounding. */
#define INSIDE 1e-6

/* ---------------------------------------------------------------- faces ------------------ */

/* Where the planes of a region are put together. */
typedef struct planes {
    tl_field_faces faces;
    tl_vec3 origin;
    uint32_t count;
} planes;

/* Room for planes of so many pairs, each of which has no more than its region. */
static bool reserve(tl_narrow_scratch *scratch, const tl_press_query query[], uint32_t count,
                    planes p[])
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

static void add(planes *p, tl_plane plane)
{
    p->faces.n[0][p->count] = plane.normal.x;
    p->faces.n[1][p->count] = plane.normal.y;
    p->faces.n[2][p->count] = plane.normal.z;
    p->faces.c[p->count++] = plane.offset - tl_v3_dot(plane.normal, p->origin);
}

static double shift_of(const tl_press_query *of, bool of_b, uint32_t face)
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

static tl_plane pressing_plane(const tl_press_query *of, bool of_b, uint32_t face)
{
    return is_moved(of, of_b, face) ? moved_plane(of, of_b) : plane_of(of->view, of_b, face);
}

static void add_face(planes *p, const tl_press_query *of, bool of_b, uint32_t face)
{
    add(p, pressing_plane(of, of_b, face));
}

static uint32_t add_faces(planes *p, const tl_press_query *of, bool of_b, uint32_t begin,
                          uint32_t count)
{
    for (uint32_t k = begin; k < begin + count; k++)
        add_face(p, of, of_b, of->region->face[k]);
    return count;
}

/* Adds faces on other parts; how many are seams through which something passes, with it. */
static uint32_t add_covered(planes *p, const tl_press_query *of, bool of_b, uint32_t begin,
                            uint32_t count, uint32_t *seams)
{
    const tl_poly *poly = of_b ? of->view->b : of->view->a;
    *seams = 0;
    for (uint32_t k = begin; k < begin + count && !of->opens; k++)
        *seams += poly->covered[of->region->face[k]] == TL_SEAM;
    return add_faces(p, of, of_b, begin, count);
}

static void list_field(planes *p, const tl_press_query *of)
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

static void list_patch(planes *p, const tl_press_query *of)
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

/* Whether the deepest point lies in both blocks, as it does if they have anything in common. */
static bool in_both(const tl_press_query *of, tl_vec3 x, double depth)
{
    for (int of_b = 0; of_b < 2; of_b++) {
        uint32_t count = (of_b ? of->view->b : of->view->a)->face_count;
        for (uint32_t f = 0; f < count; f++) {
            tl_plane plane = pressing_plane(of, of_b, f);
            if (tl_v3_dot(plane.normal, x) > plane.offset + INSIDE * depth)
                return false;
        }
    }
    return true;
}

/* Whether the integrals of blocks that hardly overlap are no more than roundings: the centre of pressure lies in both blocks, and
 * with a minimum area their mean depth is no larger than the largest. */
static bool is_noise(const tl_press_query *of, const planes *p, const tl_field_sums *sums)
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
    double r = sqrt(area * area + min_area * min_area), ds = 0.5 * s * r,
           dr = 0.25 * s * s * area / r;
    double by_g = ds * 4 / v - dr * area / g, by_v = -ds * s / v + dr * 2 * area / v;
    return (tl_field_power){0.25 * s * s * r, tl_v3_madd(tl_v3_scale(by_g, force), by_v, f->swept),
                            tl_v3_madd(tl_v3_scale(by_g, moment), by_v, f->swept_moment)};
}

/* Blends an integral over the field with that over the patch. */
static void blend(const tl_patch_share *by, const tl_field_power *flat, tl_field_power *field)
{
    double share = by->share, w = 1 - share, more = field->whole - flat->whole;
    field->force = tl_v3_madd(tl_v3_scale(w, field->force), share, flat->force);
    field->moment = tl_v3_madd(tl_v3_scale(w, field->moment), share, flat->moment);
    field->force = tl_v3_madd(field->force, more, by->push);
    field->moment = tl_v3_madd(field->moment, more, by->turn);
    field->whole = w * field->whole + share * flat->whole;
}

/* What a law that is not linear needs beside the energy. */
static void find_powers(const tl_field_sums *f, tl_field_power out[TL_PRESS_POWERS])
{
    out[TL_PRESS_VOLUME] = (tl_field_power){f->volume, f->swept, f->swept_moment};
    out[TL_PRESS_SQUARE] = f->powers[0];
    out[TL_PRESS_CUBE] = f->powers[1];
}

static void blend_powers(const tl_patch_share *by, const tl_field_sums *patch,
                         tl_field_power field[TL_PRESS_POWERS])
{
    tl_field_power flat[TL_PRESS_POWERS];
    find_powers(patch, flat);
    for (int k = 0; k < TL_PRESS_POWERS; k++)
        blend(by, &flat[k], &field[k]);
}

/* The integrals over the patch of the flush faces. false: out of memory. */
static bool sum_patch(const tl_press_query *of, planes *p, tl_narrow_scratch *scratch,
                      tl_field_sums *out)
{
    list_patch(p, of);
    p->faces.mesh = NULL;
    p->faces.energy_only = false;
    p->faces.powers = of->volumes;
    return tl_field_integrate(&p->faces, &scratch->field, out);
}

/* The same where all of it is at the corners: sums over them. A corner goes with the share `ride` of B's motion against A, as in a patch;
 * its overlap acts along the gradient of that, where it is on its face: in the bisecting plane its lever would be off by a share of the tilt. */
static bool sum_corners(const tl_press_query *of, tl_vec3 origin, tl_narrow_scratch *scratch,
                        tl_field_sums *out)
{
    const uint32_t fa = of->region->flush_a, fb = of->region->flush_b;
    const tl_touch_rule rule = {.corners = true, .reach = INFINITY};
    const tl_plane a = pressing_plane(of, 0, fa), b = pressing_plane(of, 1, fb);
    const tl_vec3 between = tl_v3_unit(tl_v3_sub(a.normal, b.normal));
    const double slant = tl_v3_dot(a.normal, between); /* of both faces */
    const double offset = a.offset + b.offset;
    *out = (tl_field_sums){0};
    scratch->manifold.failed = false;
    if (!(tl_patch_lay(of->view, fa, fb, &rule, scratch) > 0))
        return !scratch->manifold.failed;
    const tl_patch_points *corner = &scratch->patch;
    const double ride = corner->ride;
    const tl_vec3 n = tl_v3_sub(tl_v3_scale(ride, a.normal), tl_v3_scale(1 - ride, b.normal));
    for (size_t i = 0; i < corner->count; i++) {
        tl_vec3 place = tl_columns_get(corner->p, i);
        double up = (a.offset - tl_v3_dot(a.normal, place)) / slant;
        double down = (b.offset - tl_v3_dot(b.normal, place)) / slant;
        tl_vec3 on_face = tl_v3_madd(place, (1 - ride) * up - ride * down, between);
        tl_vec3 x = tl_v3_sub(on_face, origin), arm = tl_v3_cross(x, n);
        double overlap = offset - tl_v3_dot(tl_v3_add(a.normal, b.normal), place);
        double area = corner->area[i], half = 0.5 * area * overlap, square = half * overlap;
        const double over[] = {square / 6, square * overlap / 16};
        const double slope[] = {0.5 * square, square * overlap / 4};
        if (!(overlap > 0))
            continue;
        out->energy += 0.25 * area * overlap * overlap;
        out->volume += area * overlap;
        out->force = tl_v3_madd(out->force, half, n);
        out->moment = tl_v3_madd(out->moment, half, arm);
        out->swept = tl_v3_madd(out->swept, area, n);
        out->swept_moment = tl_v3_madd(out->swept_moment, area, arm);
        out->area = tl_v3_madd(out->area, area, n);
        out->pressure += half;
        out->pressed = tl_v3_madd(out->pressed, half, x);
        out->extent += area;
        out->first = tl_v3_madd(out->first, area, x);
        out->second += area * tl_v3_norm2(x);
        out->stiffness += area;
        for (int k = 0; k < TL_FIELD_POWERS; k++) {
            tl_field_power *to = &out->powers[k];
            to->whole += over[k] * overlap;
            to->force = tl_v3_madd(to->force, slope[k], n);
            to->moment = tl_v3_madd(to->moment, slope[k], arm);
        }
    }
    return true;
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
    return r->mesh && of->shift == 0 && !of->lean &&
           r->a + r->b + r->border_a + r->border_b <= TL_FIELD_KNOWN;
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

/* The integrals that tell where and on what area something presses, of a field of which a share is that of a patch. */
static void mix_places(tl_field_sums *field, const tl_field_sums *patch, double share)
{
    double w = 1 - share;
    field->area = tl_v3_madd(tl_v3_scale(w, field->area), share, patch->area);
    field->pressure = w * field->pressure + share * patch->pressure;
    field->pressed = tl_v3_madd(tl_v3_scale(w, field->pressed), share, patch->pressed);
    field->extent = w * field->extent + share * patch->extent;
    field->first = tl_v3_madd(tl_v3_scale(w, field->first), share, patch->first);
    field->second = w * field->second + share * patch->second;
    field->stiffness = w * field->stiffness + share * patch->stiffness;
}

/* What a law that is not linear needs of a press, with the area of the field and its overlap. */
static void put_powers(const tl_press_query *of, tl_vec3 origin,
                       const tl_field_power powers[TL_PRESS_POWERS], tl_press *press,
                       tl_press_extra *extra)
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

/* The press of a pair from the integrals of its field. `same`: over faces that have enclosed the common volume before. Nothing
 * presses where a part only passes on through its seams what the next parts press with, to the last digit. */
static bool press_of(const tl_press_query *of, planes *p, tl_field_sums *sums, bool same,
                     tl_narrow_scratch *scratch, tl_press *press, tl_press_extra *extra)
{
    const tl_pair_view *view = of->view;
    const tl_region *region = of->region;
    *press = (tl_press){0};
    if (!(sums->deepest > TL_TOUCHING * view->size) || !(tl_v3_norm(sums->force) > 0) ||
        !(sums->energy > 0) || is_noise(of, p, sums) ||
        !(same || in_both(of, tl_v3_add(p->origin, sums->deepest_at), sums->deepest)))
        return no_press(region);
    const double min_area = of->volumes ? 0 : of->min_area;
    tl_field_power field = with_min_area(sums, min_area), powers[TL_PRESS_POWERS];
    if (of->volumes)
        find_powers(sums, powers);
    const uint32_t fa = region->flush_a, fb = region->flush_b;
    tl_field_sums patch;
    const bool corners = of->corners && tl_at_corners(view->a, fa, view->b, fb);
    if (region->flush && tl_region_tilt(view, fa, fb) < tl_flush_limits_of(corners).field_tilt) {
        if (!(corners ? sum_corners(of, p->origin, scratch, &patch)
                      : sum_patch(of, p, scratch, &patch)))
            return false;
        const double shift = shift_of(of, false, fa) + shift_of(of, true, fb);
        tl_patch_share by = {.share = 0};
        if (patch.energy > 0 && has_square(patch.volume))
            by = tl_patch_share_of(&view->a->plane[fa].normal, &view->normal_b[fb], corners, shift,
                                   &patch, sums);
        if (by.share > 0) {
            const tl_field_power flat = with_min_area(&patch, min_area);
            blend(&by, &flat, &field);
            if (of->volumes)
                blend_powers(&by, &patch, powers);
            mix_places(sums, &patch, by.share);
        }
        press->patch = by.share;
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
    double second =
        sums->second - 2 * tl_v3_dot(centre, sums->first) + tl_v3_norm2(centre) * sums->extent;
    press->radius = sqrt(fmax(0, second / sums->extent));
    return true;
}

/* The planes of a pair's field about a point. */
static void begin(const tl_press_query *of, tl_vec3 origin, planes *p)
{
    p->origin = origin;
    list_field(p, of);
    p->faces.energy_only = !(of->min_area > 0 || of->volumes);
    p->faces.powers = of->volumes;
    p->faces.mesh = of->region->mesh;
    p->faces.inner = NULL;
    p->faces.seamed = of->region->border_a + of->region->border_b > 0 || has_shared_planes(of);
}

/* The integrals by the mesh that is known; false: they are to be found. */
static bool follow(const tl_press_query *of, planes *p, tl_field_sums *sums)
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
static void begin_mesh(const tl_press_query *of, planes *p, tl_field_sums *sums)
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

/* Forgets what is no longer known, and finds what a new mesh needs. */
static void begin_anew(const tl_press_query *of, planes *p, tl_mesh_inner *inner)
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
    tl_region_inner_corners(of->view, of->region, inner);
}

static bool find_all(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch,
                     tl_press press[], tl_press_extra extra[])
{
    planes p[TL_FIELD_PAIRS];
    uint64_t known[TL_FIELD_PAIRS];
    tl_mesh_inner inner[TL_FIELD_PAIRS];
    tl_field_sums sums[TL_FIELD_PAIRS], *to[TL_FIELD_PAIRS] = {NULL};
    const tl_field_faces *faces[TL_FIELD_PAIRS] = {NULL};
    uint32_t left = 0, anew[TL_FIELD_PAIRS];
    if (!reserve(scratch, query, count, p))
        return false;
    for (uint32_t k = 0; k < count; k++) {
        bool found = follow(&query[k], &p[k], &sums[k]);
        if (!found)
            begin_anew(&query[k], &p[k], &inner[k]);
        known[k] = p[k].faces.mesh ? p[k].faces.mesh->bounding : 0;
        if (found)
            continue;
        faces[left] = &p[k].faces;
        to[left] = &sums[k];
        anew[left++] = k;
    }
    if (left && !tl_field_integrate_all(faces, to, left, &scratch->field))
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
static bool find_lifted(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch,
                        tl_press press[], tl_press_extra extra[])
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
        region[some].mesh = NULL;
        before[some] = query[k];
        before[some].region = &region[some];
        before[some].shift -= query[k].opened;
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

bool tl_press_find(const tl_press_query query[], uint32_t count, tl_narrow_scratch *scratch,
                   tl_press press[], tl_press_extra extra[])
{
    return find_all(query, count, scratch, press, extra) &&
           (!extra || find_lifted(query, count, scratch, press, extra));
}
