/* outer.c - what acts on the surfaces of deformable blocks from outside, and what holds them.
 *
 * A condition belongs to a triangle of a surface. With n the outward normal of the present triangle and A its area, a
 * load is the traction
 *
 *     t(x) = (stress + gradient (z - at)) n + traction
 *
 * Corner a gets the integral of N_a t over what lies bare, with N_a linear from 1 there to 0 on the other side. The
 * traction is linear, t = sum N_b t_b, so with the integrals B_ab of N_a N_b over A (tl_bare)
 *
 *     f_a = A sum B_ab t_b
 *
 * exactly. Segments integrate the same over what other blocks cover. So a stress that is linear in space is in
 * equilibrium with these to rounding. A quiet triangle lets waves out (Lysmer and Kuhlemeyer 1969): with the velocity v
 * of a corner, density d and moduli M and G of the solid,
 *
 *     f_a = f_a0 - A b_a (c_p n (n . v) + c_s (v - n (n . v))),    c_p = sqrt(d M),  c_s = sqrt(d G)
 *
 * b_a is the sum of B_ab over b, and f_a0 what acted there when it was set. The step takes the mean of the velocities
 * before and after the kick for v, so it stays stable (cycle/gridpoints.c). */
#include "zone/outer.h"

#include "base/columns.h"
#include "model/loads.h"
#include "zone/columns.h"
#include "zone/held.h"

#include <stdlib.h>
#include <string.h>

void tl_outer_forget(tl_gridpoints *p)
{
    for (int k = 0; k < 3 && p->pushed[k]; k++)
        memset(p->pushed[k], 0, p->table.rows * sizeof *p->pushed[k]);
    for (int k = 0; k < 6 && p->quiet[k]; k++)
        memset(p->quiet[k], 0, p->table.rows * sizeof *p->quiet[k]);
    for (int k = 0; k < 3 && p->rolled[k]; k++)
        memset(p->rolled[k], 0, p->table.rows * sizeof *p->rolled[k]);
}

/* ---------------------------------------------------------------- triangles -------------- */

static void corners_of(const struct tl_zones *z, const tl_outer_part *of, tl_vec3 x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = tl_gridpoint_place(&z->points, z->part[of->part].corner[a]);
}

/* Its area times its outward normal. */
static tl_vec3 area_of(const tl_vec3 x[3])
{
    return tl_v3_scale(0.5, tl_v3_cross(tl_v3_sub(x[1], x[0]), tl_v3_sub(x[2], x[0])));
}

void tl_outer_forces(const tl_model *m, const tl_outer_part *of, tl_vec3 force[3])
{
    tl_vec3 x[3], at[3]; /* the traction times the area, at each corner */
    corners_of(m->zones, of, x);
    const tl_vec3 area = area_of(x), even = tl_v3_scale(tl_v3_norm(area), of->traction);
    const double height = m->origin.z - of->at;
    for (int a = 0; a < 3; a++) {
        const tl_sym3 stress = tl_s3_madd(of->stress, height + x[a].z, of->gradient);
        at[a] = tl_v3_add(tl_s3_mul(stress, area), even);
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        force[a] = of->rest[a];
        if (!of->loaded)
            continue;
        force[a] = tl_v3_madd(force[a], of->bare.of[a], at[a]);
        force[a] = tl_v3_madd(force[a], of->bare.of[3 + a], at[b]);
        force[a] = tl_v3_madd(force[a], of->bare.of[3 + c], at[c]);
    }
}

/* A part of the resistance of each corner of a quiet triangle, kg/s, added to `to`. */
static void add_resistance(const struct tl_zones *z, const tl_outer_part *of)
{
    const tl_solid *solid = &z->solid[of->solid].of;
    const tl_gridpoints *p = &z->points;
    tl_vec3 x[3];
    corners_of(z, of, x);
    const tl_vec3 area = area_of(x), n = tl_v3_unit(area);
    const double size = tl_v3_norm(area);
    const double along = size * sqrt(of->density * solid->constrained),
                 across = size * sqrt(of->density * solid->shear);
    const double more = along - across;
    const double sum[6] = {across + more * n.x * n.x, across + more * n.y * n.y, across + more * n.z * n.z,
                           more * n.x * n.y,          more * n.y * n.z,          more * n.z * n.x};
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 6; k++)
            p->quiet[k][z->part[of->part].corner[a]] += tl_bare_at(&of->bare, a) * sum[k];
}

/* Empties what the corners of all conditions have had in the last step. */
static void begin_push(const struct tl_zones *z)
{
    const tl_gridpoints *p = &z->points;
    for (size_t i = 0; i < z->outer_count; i++)
        for (int a = 0; a < 3; a++) {
            const uint32_t row = z->part[z->outer[i].part].corner[a];
            tl_columns_put(p->pushed, row, tl_v3(0, 0, 0));
            if (p->held[0][0])
                tl_columns_put(p->rolled, row, tl_v3(0, 0, 0));
            for (int k = 0; k < 6 && p->quiet[0]; k++)
                p->quiet[k][row] = 0;
        }
}

/* Directions hold the corners of a triangle, when all else has pushed them. */
static void push_back(struct tl_zones *z, const tl_outer_part *of)
{
    tl_gridpoints *p = &z->points;
    for (int a = 0; a < 3; a++) {
        const uint32_t row = z->part[of->part].corner[a];
        const tl_vec3 force = tl_columns_get(p->force, row), along = tl_gridpoint_held_along(p, row, force);
        tl_columns_put(p->force, row, tl_v3_sub(force, along));
        tl_columns_put(p->rolled, row, tl_v3_sub(tl_columns_get(p->rolled, row), along));
        p->touched[row] += tl_v3_norm(along);
    }
}

void tl_outer_push(tl_model *m, double share)
{
    struct tl_zones *z = m->zones;
    tl_gridpoints *p = &z->points;
    begin_push(z);
    for (size_t i = 0; i < z->outer_count; i++) {
        const tl_outer_part *of = &z->outer[i];
        tl_vec3 force[3];
        if (of->quiet && !m->relaxing)
            add_resistance(z, of);
        if (!of->loaded && !of->quiet)
            continue;
        tl_outer_forces(m, of, force);
        for (int a = 0; a < 3; a++) {
            const uint32_t row = z->part[of->part].corner[a];
            const tl_vec3 f = tl_v3_scale(share, force[a]);
            tl_columns_put(p->pushed, row, tl_v3_add(tl_columns_get(p->pushed, row), f));
            tl_columns_put(p->force, row, tl_v3_add(tl_columns_get(p->force, row), f));
            p->bears[row] += tl_v3_norm(f);
        }
    }
    for (size_t i = 0; i < z->outer_count && z->points.held[0][0]; i++)
        if (tl_v3_norm2(z->outer[i].along) > 0)
            push_back(z, &z->outer[i]);
}

/* ---------------------------------------------------------------- holding ---------------- */

static bool holds(const tl_outer_part *of)
{
    return of->fixed || of->drive || tl_v3_norm2(of->along) > 0;
}

/* The part of a vector along which a condition holds its gridpoints. */
static tl_vec3 held_part(const tl_outer_part *of, tl_vec3 v)
{
    if (of->drive)
        return v;
    const tl_vec3 free = tl_free_axes(v, of->fixed);
    const tl_vec3 n = tl_free_axes(of->along, of->fixed);
    const double n2 = tl_v3_norm2(n);
    const tl_vec3 left = n2 > 0 ? tl_v3_madd(free, -tl_v3_dot(free, n) / n2, n) : free;
    return tl_v3_sub(v, left);
}

/* Lets a gridpoint go from a condition; its other ones hold it again later. */
static void let_go(tl_model *m, uint32_t row, const tl_outer_part *of)
{
    tl_gridpoints *p = &m->zones->points;
    p->fixed[row] = (uint8_t)(p->fixed[row] & ~(of->drive ? TL_FIX_ALL : of->fixed));
    for (int d = 0; d < 2 && p->held[0][0]; d++)
        tl_columns_put(p->held[d], row, tl_v3(0, 0, 0));
    if (p->drive && p->drive[row]) {
        m->drives[p->drive[row] - 1].bodies--;
        p->drive[row] = 0;
    }
}

/* Holds a gridpoint along a direction, unless it is already. Held along three, it is held whole. */
static void hold_along(tl_gridpoints *p, uint32_t row, tl_vec3 along)
{
    if (tl_v3_norm(tl_gridpoint_free_part(p, row, along)) < TL_HELD_ALREADY)
        return;
    for (int d = 0; d < 2; d++)
        if (tl_v3_norm2(tl_columns_get(p->held[d], row)) == 0) {
            tl_columns_put(p->held[d], row, along);
            return;
        }
    p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
}

/* Holds a gridpoint as a condition says, and stops it along that; driven ones get the velocity of their drive. */
static void hold(tl_model *m, uint32_t row, const tl_outer_part *of)
{
    tl_gridpoints *p = &m->zones->points;
    const tl_vec3 v = tl_columns_get(p->v, row);
    const bool driven = p->drive && p->drive[row];
    if (of->drive) {
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        if (driven)
            m->drives[p->drive[row] - 1].bodies--;
        p->drive[row] = of->drive;
        m->drives[of->drive - 1].bodies++;
        tl_columns_put(p->v, row, m->drives[of->drive - 1].velocity);
        return;
    }
    if (!driven)
        tl_columns_put(p->v, row, tl_v3_sub(v, held_part(of, v)));
    p->fixed[row] |= of->fixed;
    if (tl_v3_norm2(of->along) > 0)
        hold_along(p, row, of->along);
}

void tl_outer_let_go(tl_model *m, uint32_t mesh)
{
    struct tl_zones *z = m->zones;
    const tl_body_mesh *of = &z->mesh[mesh];
    const tl_outer_part all = {.drive = 1}; /* holds in all components */
    for (uint32_t row = of->point_begin; row < of->point_end; row++)
        let_go(m, row, &all);
    for (size_t i = 0; i < z->outer_count; i++) {
        tl_outer_part *part = &z->outer[i];
        if (part->part < of->part_begin || part->part >= of->part_end)
            continue;
        if (part->drive)
            m->drives[part->drive - 1].bodies--;
        part->drive = part->fixed = 0;
        part->along = tl_v3(0, 0, 0);
    }
}

/* ---------------------------------------------------------------- what a quiet one keeps -- */

/* Row of the zone of a triangle, or TL_NO_ROW, with its solid. */
static uint32_t zone_of(const struct tl_zones *z, const tl_surface_part *part, uint32_t *solid)
{
    for (uint32_t u = z->use_start[part->apex]; u < z->use_start[part->apex + 1]; u++) {
        const uint32_t slot = z->use[u];
        const tl_body_mesh *mesh = &z->mesh[z->points.mesh[part->apex]];
        const tl_parcel *of = &z->parcels.of[mesh->parcel_begin];
        while (slot >= of->point_end)
            of++;
        *solid = of->solid;
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (uint32_t row = z->group[g].start; row < z->group[g].start + z->group[g].depth * (uint32_t)TL_LANES;
                 row++) {
                int same = 0;
                for (int a = 0; a < 4; a++) {
                    const uint32_t point = z->listed[of->point_begin + z->zones.corner[a][row]];
                    same += point == part->apex || point == part->corner[0] || point == part->corner[1] ||
                            point == part->corner[2];
                }
                if (same == 4 && z->zones.number[row] != TL_NO_ROW)
                    return row;
            }
    }
    return TL_NO_ROW;
}

void tl_outer_find_solids(struct tl_zones *z)
{
    for (size_t i = 0; i < z->outer_count; i++)
        if (z->outer[i].quiet)
            zone_of(z, &z->part[z->outer[i].part], &z->outer[i].solid);
}

/* What the stress of the zone puts on the corners. */
static void rest_on_stress(const struct tl_zones *z, tl_outer_part *of, uint32_t zone)
{
    double *const *s = z->zones.stress;
    const tl_sym3 stress = {
        .xx = s[0][zone], .yy = s[1][zone], .zz = s[2][zone], .xy = s[3][zone], .yz = s[4][zone], .zx = s[5][zone]};
    tl_vec3 x[3];
    corners_of(z, of, x);
    for (int a = 0; a < 3; a++)
        of->rest[a] = tl_v3_scale(tl_bare_at(&of->bare, a), tl_s3_mul(stress, area_of(x)));
}

/* Takes over from an earlier condition of the triangle, or NULL. `area`: of the quiet triangles about each gridpoint
 * that have been held until now, m2. */
static void begin_quiet(const tl_model *m, tl_outer_part *of, const tl_outer_part *old, const double *area)
{
    const struct tl_zones *z = m->zones;
    const tl_gridpoints *p = &z->points;
    const tl_surface_part *part = &z->part[of->part];
    const uint32_t zone = zone_of(z, part, &of->solid);
    if (of->loaded)
        return;
    if (old && (old->loaded || old->quiet)) {
        of->loaded = old->loaded;
        of->stress = old->stress;
        of->gradient = old->gradient;
        of->traction = old->traction;
        of->at = old->at;
        memcpy(of->rest, old->rest, sizeof of->rest);
    }
    if (old && holds(old) && m->cycles > 0) {
        tl_vec3 x[3];
        corners_of(z, of, x);
        const double own = tl_v3_norm(area_of(x));
        for (int a = 0; a < 3; a++) {
            const tl_vec3 held = held_part(old, tl_gridpoint_reaction(p, part->corner[a]));
            of->rest[a] = tl_v3_madd(of->rest[a], own / area[part->corner[a]], held);
        }
    } else if (!(old && (old->loaded || old->quiet)) && zone != TL_NO_ROW) {
        rest_on_stress(z, of, zone);
    }
}

/* ---------------------------------------------------------------- putting ---------------- */

static int compare(const void *a, const void *b)
{
    const tl_outer_part *x = a, *y = b;
    return x->part < y->part ? -1 : x->part > y->part;
}

/* Adds one condition to another of the same triangle. */
static void join(tl_outer_part *to, const tl_outer_part *from)
{
    if (from->loaded) {
        const double at = to->loaded ? to->at : from->at;
        to->stress = tl_s3_madd(tl_s3_madd(to->stress, 1, from->stress), at - from->at, from->gradient);
        to->gradient = tl_s3_madd(to->gradient, 1, from->gradient);
        to->traction = tl_v3_add(to->traction, from->traction);
        for (int a = 0; a < 3; a++)
            to->rest[a] = tl_v3_add(to->rest[a], from->rest[a]);
        to->at = at;
        to->loaded = 1;
    }
    to->quiet |= from->quiet;
    to->fixed |= from->fixed;
    to->drive = from->drive ? from->drive : to->drive;
    if (tl_v3_norm2(to->along) > 0 && tl_v3_norm2(from->along) > 0 &&
        tl_v3_norm(tl_v3_cross(to->along, from->along)) > TL_HELD_ALREADY)
        to->fixed = TL_FIX_X | TL_FIX_Y | TL_FIX_Z; /* held along two directions of one plane is held whole */
    else if (tl_v3_norm2(from->along) > 0)
        to->along = from->along;
}

/* Sorts a list by triangles, and joins those of one triangle. */
static size_t sort_list(tl_outer_part *list, size_t count)
{
    size_t kept = 0;
    if (count > 1)
        qsort(list, count, sizeof *list, compare);
    for (size_t i = 0; i < count; i++)
        if (kept && list[kept - 1].part == list[i].part)
            join(&list[kept - 1], &list[i]);
        else
            list[kept++] = list[i];
    return kept;
}

/* One call: the old list and the new one, both by ascending triangles. */
typedef struct putting {
    tl_model *m;
    tl_outer_part *list, *merged;
    size_t count, merged_count;
    double *area;    /* of each gridpoint: of quiet triangles that have been held */
    uint8_t *marked; /* of each gridpoint: what holds it changes */
    bool add;
} putting;

/* The earlier condition of a triangle, or NULL. `at` goes on with ascending triangles. */
static const tl_outer_part *old_of(const struct tl_zones *z, uint32_t part, size_t *at)
{
    while (*at < z->outer_count && z->outer[*at].part < part)
        ++*at;
    return *at < z->outer_count && z->outer[*at].part == part ? &z->outer[*at] : NULL;
}

/* Sums areas of what goes quiet, and marks gridpoints. */
static void look_at(putting *p)
{
    const struct tl_zones *z = p->m->zones;
    for (size_t i = 0, at = 0; i < p->count; i++) {
        const tl_outer_part *of = &p->list[i], *old = old_of(z, of->part, &at);
        tl_vec3 x[3];
        corners_of(z, of, x);
        for (int a = 0; a < 3; a++) {
            const uint32_t row = z->part[of->part].corner[a];
            p->marked[row] |= holds(of) || (old && holds(old));
            p->area[row] += of->quiet && old && holds(old) ? tl_v3_norm(area_of(x)) : 0;
        }
    }
}

/* Merges both lists. */
static void merge(putting *p)
{
    const struct tl_zones *z = p->m->zones;
    size_t at = 0;
    for (size_t i = 0; i < p->count; i++) {
        while (at < z->outer_count && z->outer[at].part < p->list[i].part)
            p->merged[p->merged_count++] = z->outer[at++];
        const tl_outer_part *old = at < z->outer_count && z->outer[at].part == p->list[i].part ? &z->outer[at] : NULL;
        tl_outer_part of = p->list[i];
        if (of.quiet)
            begin_quiet(p->m, &of, old, p->area);
        if (p->add && old) {
            tl_outer_part both = *old;
            join(&both, &p->list[i]);
            if (of.quiet && !old->quiet) {
                both.solid = of.solid;
                both.density = of.density;
                memcpy(both.rest, of.rest, sizeof both.rest);
            }
            of = both;
        }
        at += old != NULL;
        if (of.loaded || of.quiet || holds(&of))
            p->merged[p->merged_count++] = of;
    }
    while (at < z->outer_count)
        p->merged[p->merged_count++] = z->outer[at++];
}

/* Lets marked gridpoints go from what there was, and holds them by what there is. */
static void hold_marked(putting *p)
{
    struct tl_zones *z = p->m->zones;
    for (size_t i = 0; i < z->outer_count; i++)
        for (int a = 0; a < 3; a++) {
            const uint32_t row = z->part[z->outer[i].part].corner[a];
            if (p->marked[row] && holds(&z->outer[i]))
                let_go(p->m, row, &z->outer[i]);
        }
    for (size_t i = 0; i < p->merged_count; i++)
        for (int a = 0; a < 3; a++) {
            const uint32_t row = z->part[p->merged[i].part].corner[a];
            if (p->marked[row] && holds(&p->merged[i]))
                hold(p->m, row, &p->merged[i]);
        }
}

static bool hold_columns(tl_gridpoints *p, const tl_outer_part *list, size_t count)
{
    bool quiet = false, along = false, drives = false;
    for (size_t i = 0; i < count; i++) {
        quiet = quiet || list[i].quiet;
        along = along || tl_v3_norm2(list[i].along) > 0;
        drives = drives || list[i].drive;
    }
    return tl_gridpoints_hold_pushed(p) && (!quiet || tl_gridpoints_hold_quiet(p)) &&
           (!along || tl_gridpoints_hold_directions(p)) && (!drives || tl_gridpoints_hold_drives(p));
}

tl_status tl_outer_put(tl_model *m, const tl_outer_part *list, size_t count, bool add)
{
    struct tl_zones *z = m->zones;
    const size_t rows = z->points.table.rows, capacity = z->outer_count + count + 1;
    putting p = {.m = m,
                 .list = malloc((count + 1) * sizeof *list),
                 .merged = malloc(capacity * sizeof *list),
                 .area = calloc(rows + 1, sizeof *p.area),
                 .marked = calloc(rows + 1, 1),
                 .add = add};
    const bool enough = p.list && p.merged && p.area && p.marked && hold_columns(&z->points, list, count);
    if (enough) {
        memcpy(p.list, list, count * sizeof *list);
        p.count = sort_list(p.list, count);
        look_at(&p);
        merge(&p);
        hold_marked(&p);
        free(z->outer);
        z->outer = p.merged;
        z->outer_count = p.merged_count;
        z->outer_capacity = capacity;
        p.merged = NULL;
        tl_outer_forget(&z->points);
        tl_drives_recount(m);
        z->rated_for = 0; /* others may be the stiffest that move */
        z->steps_kept = TL_STEPS_KEPT;
        m->constraints++;
    }
    free(p.list);
    free(p.merged);
    free(p.area);
    free(p.marked);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}
