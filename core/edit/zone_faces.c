/* zone_faces.c - outer faces of deformable blocks: triangles that lie bare, and what is done to them. */
#include "edit/zone_faces.h"

#include "zone/grid.h"
#include "zone/outer.h"

#include <math.h>
#include <string.h>

/* Tolerance: share of a triangle that may be left bare for roundings. */
#define UNCOVERED 1e-9
/* Tolerance: share of a face, or of a triangle that is to be held, up to which it lies on others: joints that have
 * settled leave so little. */
#define SETTLED 1e-5
/* Tolerance: component across an axis up to which a direction is that axis. */
#define AXIAL 1e-9

size_t tl_covers_of(const tl_covers *covers, uint32_t row, uint32_t face, size_t *begin)
{
    size_t low = 0, high = covers->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const tl_cover *at = &covers->list[middle];
        if (at->block < row || (at->block == row && at->face < face))
            low = middle + 1;
        else
            high = middle;
    }
    *begin = low;
    while (low < covers->count && covers->list[low].block == row && covers->list[low].face == face)
        low++;
    return low;
}

static void corners_of(const tl_model *m, const tl_surface_part *part, tl_vec3 x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = tl_gridpoint_place(&m->zones->points, part->corner[a]);
}

/* Takes what covers a triangle of a vector area from it. `x`: its corners. */
static void take_cover(const tl_cover *cover, const tl_vec3 x[3], tl_vec3 area, tl_bare_triangle *from)
{
    const double per = 1 / tl_v3_norm2(area), share = cover->area * sqrt(per), third = share / 3;
    from->share -= share;
    for (int k = 0; k < TL_SEGMENT_POINTS; k++) {
        double weight[3];
        for (int a = 0; a < 3; a++) {
            const tl_vec3 b = tl_v3_sub(x[(a + 1) % 3], cover->at[k]), c = tl_v3_sub(x[(a + 2) % 3], cover->at[k]);
            weight[a] = 0.5 * per * tl_v3_dot(area, tl_v3_cross(b, c));
        }
        for (int a = 0; a < 3; a++) {
            from->bare.of[a] -= third * weight[a] * weight[a];
            from->bare.of[3 + a] -= third * weight[a] * weight[(a + 1) % 3];
        }
    }
}

/* What of a triangle lies bare. Covers come by the numbers of the triangles. */
static tl_bare_triangle bare_part(const tl_covers *covers, uint32_t part, const tl_vec3 x[3], tl_vec3 area, size_t *at,
                                  size_t end)
{
    tl_bare_triangle out = {part, 1, tl_bare_whole()};
    while (*at < end && covers->list[*at].part < part)
        ++*at;
    for (; *at < end && covers->list[*at].part == part; ++*at)
        take_cover(&covers->list[*at], x, area, &out);
    return out;
}

bool tl_bare_find(const tl_model *m, const tl_face_filter *filter, const tl_covers *covers, uint32_t row, uint32_t face,
                  tl_bare_list *list, tl_bare_face *out)
{
    size_t count, at;
    const tl_surface_part *part = tl_face_parts(m, m->blocks.id[row], face, &count);
    const size_t end = tl_covers_of(covers, row, face, &at);
    tl_vec3 normal = {0, 0, 0};
    double whole = 0;
    *out = (tl_bare_face){.begin = list->count, .end = list->count};
    for (size_t k = 0; k < count && !m->blocks.shape[row]->covered[face]; k++) {
        tl_vec3 x[3];
        corners_of(m, &part[k], x);
        const tl_vec3 area = tl_v3_scale(0.5, tl_v3_cross(tl_v3_sub(x[1], x[0]), tl_v3_sub(x[2], x[0])));
        const uint32_t number = (uint32_t)(&part[k] - m->zones->part);
        const tl_bare_triangle bare = bare_part(covers, number, x, area, &at, end);
        const double size = tl_v3_norm(area);
        if (bare.share >= UNCOVERED && tl_triangle_reaches_out(m, filter, row, x))
            out->left_out += bare.share * size;
        if (!tl_triangle_is_there(m, filter, row, x))
            continue;
        whole += size;
        if (bare.share < UNCOVERED)
            continue;
        if (!tl_grow(&list->at, &list->capacity, list->count + 1, sizeof *list->at))
            return false;
        list->at[list->count++] = bare;
        out->area += bare.share * size;
        normal = tl_v3_add(normal, area);
        for (int a = 0; a < 3; a++)
            out->centroid = tl_v3_madd(out->centroid, tl_bare_at(&bare.bare, a) * size, x[a]);
    }
    if (out->area < SETTLED * whole) {
        list->count = out->begin;
        out->area = 0;
    }
    out->end = list->count;
    out->normal = out->area > 0 ? tl_v3_unit(normal) : normal;
    out->centroid = tl_v3_scale(out->area > 0 ? 1 / out->area : 0, out->centroid);
    return true;
}

/* Holds along a direction: an axis, or any other. */
static void roll(tl_outer_part *to, tl_vec3 n)
{
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    if (fmax(y, z) < AXIAL)
        to->fixed = TL_FIX_X;
    else if (fmax(x, z) < AXIAL)
        to->fixed = TL_FIX_Y;
    else if (fmax(x, y) < AXIAL)
        to->fixed = TL_FIX_Z;
    else
        to->along = n;
}

static void add_load(const tl_model *m, const tl_outer_part *of, tl_boundary_result *result)
{
    tl_vec3 force[3], x[3];
    tl_outer_forces(m, of, force);
    corners_of(m, &m->zones->part[of->part], x);
    for (int a = 0; a < 3; a++) {
        const tl_vec3 moment = tl_v3_cross(tl_v3_add(m->origin, x[a]), force[a]);
        result->force = tl_v3_add(result->force, force[a]);
        result->moment = tl_v3_add(result->moment, moment);
    }
}

/* Integrals over a triangle within the triangle; its corners are given by their weights. */
static void add_within(tl_bare *to, double p[3][3])
{
    const double share = p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
                         p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
                         p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, j = (k + 1) % 3;
            const double at = 0.5 * (p[k][a] + p[j][a]), beside = 0.5 * (p[k][b] + p[j][b]);
            to->of[a] += share / 3 * at * at;
            to->of[3 + a] += share / 3 * at * beside;
        }
}

/* What of a triangle lies below a level. `depth`: of its corners. */
static tl_bare part_below(const double depth[3])
{
    tl_bare wet = {{0}};
    double fan[3][3];
    size_t had = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double part = depth[i] / (depth[i] - depth[j]);
        for (int k = depth[i] > 0 ? 0 : 1; k < ((depth[i] > 0) != (depth[j] > 0) ? 2 : 1); k++) {
            double *to = fan[had < 2 ? had : 2];
            to[0] = to[1] = to[2] = 0;
            to[i] = k ? 1 - part : 1;
            to[j] = k ? part : 0;
            if (had++ >= 2) {
                add_within(&wet, fan);
                memcpy(fan[1], fan[2], sizeof fan[1]);
            }
        }
    }
    return wet;
}

/* How many corners of a triangle lie below the level of a load, with their depths. */
static int depths_of(const tl_model *m, uint32_t part, double level, double depth[3])
{
    tl_vec3 x[3];
    int below = 0;
    corners_of(m, &m->zones->part[part], x);
    for (int a = 0; a < 3; a++) {
        depth[a] = level - m->origin.z - x[a].z;
        below += depth[a] > 0;
    }
    return below;
}

bool tl_bare_crosses(const tl_model *m, const tl_bare_triangle *bare, double level)
{
    double depth[3];
    const int below = depths_of(m, bare->part, level, depth);
    return below > 0 && below < 3 && bare->share < 1 - UNCOVERED;
}

/* Cuts the load of a triangle at its level: one that is crossed keeps the forces it has now. */
static void cut_load(const tl_model *m, double level, tl_outer_part *of)
{
    double depth[3];
    const int below = depths_of(m, of->part, level, depth);
    if (below == 3)
        return;
    if (below > 0) {
        const tl_bare whole = of->bare;
        of->bare = part_below(depth);
        tl_outer_forces(m, of, of->rest);
        of->bare = whole;
    }
    of->loaded = below > 0;
    of->stress = of->gradient = (tl_sym3){0};
    of->traction = tl_v3(0, 0, 0);
}

bool tl_bare_act(const tl_model *m, const tl_boundary_action *a, const tl_face_filter *filter, uint32_t drive,
                 uint32_t row, const tl_bare_list *list, const tl_bare_face *face, tl_outer_list *to,
                 tl_boundary_result *result)
{
    if (!tl_grow(&to->at, &to->capacity, to->count + (face->end - face->begin), sizeof *to->at))
        return false;
    for (size_t k = face->begin; k < face->end; k++) {
        const tl_bare_triangle *bare = &list->at[k];
        const bool holds = bare->share > SETTLED;
        if (!holds && !a->loads)
            continue;
        tl_outer_part *of = &to->at[to->count++];
        *of = (tl_outer_part){.part = bare->part,
                              .drive = holds ? drive : 0,
                              .fixed = holds && a->fixed ? TL_FIX_X | TL_FIX_Y | TL_FIX_Z : 0,
                              .quiet = a->quiet,
                              .loaded = a->loads,
                              .bare = bare->bare,
                              .density = m->blocks.density[row],
                              .at = a->at.z,
                              .stress = a->stress,
                              .gradient = a->gradient,
                              .traction = a->traction};
        if (a->loads && !isnan(a->level))
            cut_load(m, a->level, of);
        if (!of->loaded && a->loads && !(holds && (a->fixed || a->roller || drive)) && !a->quiet) {
            to->count--;
            continue;
        }
        if (holds && a->roller && !a->fixed)
            roll(of, filter->plane ? filter->normal : face->normal);
        if (of->loaded)
            add_load(m, of, result);
    }
    return true;
}
