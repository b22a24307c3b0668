/* cells.c - the cells of a patch.
 *
 * A patch of n corners has n points between corners, n at corners, and the centroid, all drawn in towards that
 * (patch.c); so its corners follow from its points. A point stands for a cell, a part of the polygon of the point's
 * area. In the triangle of an edge and the centroid, the centroid's cell is the triangle drawn in by INNER, 7/75 of its
 * area. Beyond it two rays from the centroid go through the shares SIDE and 1 - SIDE of the edge. They part the cells
 * of the two corners, 16/75 each, from that of the edge, 36/75.
 *
 * The overlap o is linear over the patch. Each point has a lift l_k of its own. In cell k the walls press with u = o +
 * L where that is above 0, and
 *
 *     L(x) = l + g x + f (e_k + b x)        x from the centroid
 *
 * l + g x is the plane that fits the lifts, by the areas of their points, and e_k is what they are off it. b and f give
 * L what the lifts have at their points: the first moments, sum A l_k x_k, and the mean square, sum A l_k^2. So the
 * cells of a patch that is wholly closed have the force, the moment and the energy of its points. Nothing jumps when
 * the first corner opens. */
#include "contact/cells.h"

#include "base/inline.h"
#include "contact/triangle_integrals.h"

#include <math.h>

/* Tolerance: of the second moments of an area along two axes: their product over the square of their sum, for points
 * on a line. */
#define ON_A_LINE 1e-12

/* Shares of the area of a triangle of the fan in its cells: a corner's, the edge's, the centroid's. */
static const double cell_share[3] = {16. / 75, 36. / 75, 7. / 75};
static const double outer_side[4] = {0, TL_CELL_SIDE, 1 - TL_CELL_SIDE, 1};

bool tl_cell_patch_of(const tl_model *m, uint32_t contact, const tl_point_lanes *lanes, size_t lane, size_t stride,
                      tl_cell_patch *out)
{
    if (contact == TL_NO_ROW)
        return false;
    const tl_facet *f = &m->detect->contacts.facet[contact];
    size_t count = m->detect->contacts.point_count[contact], corners = count / 2;
    if (!tl_facet_is_patch(f) || count % 2 == 0 || corners < 3)
        return false;
    *out = (tl_cell_patch){.p = &m->detect->points,
                           .lanes = lanes,
                           .lane = lane,
                           .stride = stride,
                           .row = tl_point_row(&m->detect->contacts, contact, 0),
                           .corners = corners,
                           .faces = tl_key_of(0, f->ia, f->ib)};
    uint32_t last = out->p->key[out->row + 2 * corners * TL_LANES];
    return last == tl_centroid_key(f->ia, f->ib);
}

bool tl_cell_patch_is_whole(const tl_cell_patch *of)
{
    const uint32_t *key = of->p->key + of->row, faces = of->faces;
    bool all = true;
    for (size_t k = 0; k < of->corners && all; k++) {
        size_t one = of->corners + k, next = of->corners + (k + 1) % of->corners;
        all = (key[k * TL_LANES] ^ faces) ==
              tl_key_of(TL_POINT_MIDDLE, key[one * TL_LANES] ^ faces, key[next * TL_LANES] ^ faces);
    }
    return all;
}

/* ---------------------------------------------------------------- lifts ------------------ */

/* Finds the centres of all cells. In a triangle of the fan a cell is r ((1 - q) e + q f), r and q between two bounds
 * each. Its area is that of the triangle times 2 r dr dq. */
static void find_centres(const tl_cell_patch *of)
{
    const double near = TL_CELL_SIDE - 0.5 * TL_CELL_SIDE * TL_CELL_SIDE;
    const double next = 0.5 * TL_CELL_SIDE * TL_CELL_SIDE;
    const double cube = TL_CELL_INNER * TL_CELL_INNER * TL_CELL_INNER;
    tl_cell *cell = of->lanes->cell + of->lane;
    size_t n = of->corners;
    for (size_t k = 0; k <= 2 * n; k++)
        cell[k * of->stride].centre = tl_v3(0, 0, 0);
    for (size_t k = 0; k < n; k++) {
        size_t other = (k + 1) % n;
        tl_vec3 e = tl_cell_corner(of, k), f = tl_cell_corner(of, other);
        double fan = tl_cell_area(of, k) / cell_share[1], by = fan * (1 - cube) * 2 / 3;
        tl_vec3 *to[4] = {&cell[(n + k) * of->stride].centre, &cell[k * of->stride].centre,
                          &cell[(n + other) * of->stride].centre, &cell[2 * n * of->stride].centre};
        *to[0] = tl_v3_madd(tl_v3_madd(*to[0], by * near, e), by * next, f);
        *to[1] = tl_v3_madd(*to[1], by * (0.5 - TL_CELL_SIDE), tl_v3_add(e, f));
        *to[2] = tl_v3_madd(tl_v3_madd(*to[2], by * next, e), by * near, f);
        *to[3] = tl_v3_madd(*to[3], fan * cube / 3, tl_v3_add(e, f));
    }
}

/* Second moments of the area about the centroid, along two axes of the plane. */
typedef struct inertia {
    tl_vec3 axis[2];
    double xx, xy, yy;
} inertia;

static inertia inertia_of(const tl_cell_patch *of)
{
    inertia out = {.xx = 0};
    out.axis[0] = tl_v3_perpendicular(tl_columns_get(of->lanes->normal, of->lane));
    out.axis[1] = tl_v3_cross(tl_columns_get(of->lanes->normal, of->lane), out.axis[0]);
    for (size_t k = 0; k < 2 * of->corners; k++) {
        double x = tl_v3_dot(tl_cell_place(of, k), out.axis[0]);
        double y = tl_v3_dot(tl_cell_place(of, k), out.axis[1]);
        out.xx += tl_cell_area(of, k) * x * x;
        out.xy += tl_cell_area(of, k) * x * y;
        out.yy += tl_cell_area(of, k) * y * y;
    }
    return out;
}

/* The slope g of a plane whose first moment int (g x) x dA is given; of points on a line none. */
static tl_vec3 slope_of(const inertia *by, tl_vec3 moment)
{
    double x = tl_v3_dot(moment, by->axis[0]), y = tl_v3_dot(moment, by->axis[1]);
    double det = by->xx * by->yy - by->xy * by->xy, sum = by->xx + by->yy;
    if (!(det > ON_A_LINE * sum * sum))
        return tl_v3(0, 0, 0);
    return tl_v3_madd(tl_v3_scale((x * by->yy - y * by->xy) / det, by->axis[0]), (y * by->xx - x * by->xy) / det,
                      by->axis[1]);
}

static bool lifts_differ(const tl_cell_patch *of)
{
    const tl_cell *cell = of->lanes->cell + of->lane;
    bool out = false;
    for (size_t k = 1; k <= 2 * of->corners; k++)
        out = out || cell[k * of->stride].lift != cell[0].lift;
    return out;
}

/* The plane that fits the lifts: its height at the centroid, and its slope. */
static double fit_plane(const tl_cell_patch *of, const inertia *by, tl_vec3 *slope)
{
    double sum = 0, area = 0;
    tl_vec3 moment = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        double part = tl_cell_area(of, k), weight = part * of->lanes->cell[tl_cell_lane(of, k)].lift;
        moment = tl_v3_madd(moment, weight, tl_cell_place(of, k));
        sum += weight;
        area += part;
    }
    *slope = slope_of(by, moment);
    return sum / area;
}

/* Lays the lifts of the points over the patch: gives each cell its level, and the slope that all have. */
static tl_vec3 lay_lifts(const tl_cell_patch *of)
{
    tl_cell *cell = of->lanes->cell;
    double square = 0;
    tl_vec3 plane = {0, 0, 0}, moment = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++)
        cell[tl_cell_lane(of, k)].level = cell[tl_cell_lane(of, k)].lift;
    if (!lifts_differ(of))
        return plane;
    find_centres(of);
    const inertia by = inertia_of(of);
    const double mean = fit_plane(of, &by, &plane);
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = tl_cell_lane(of, k);
        double off = cell[i].lift - mean - tl_v3_dot(plane, tl_cell_place(of, k));
        cell[i].level = off;
        square += tl_cell_area(of, k) * off * off;
        moment = tl_v3_madd(moment, -off, cell[i].centre);
    }
    const tl_vec3 back = slope_of(&by, moment);
    const double lost = tl_v3_dot(back, moment);
    const double larger = square > lost ? sqrt(square / (square - lost)) : 1;
    for (size_t k = 0; k <= 2 * of->corners; k++)
        cell[tl_cell_lane(of, k)].level = mean + larger * cell[tl_cell_lane(of, k)].level;
    return tl_v3_madd(plane, larger, back);
}

/* ---------------------------------------------------------------- cells ------------------ */

/* Before parts are added. What only a curved law asks for is not touched for others. */
static void clear(tl_cell *cell, bool curved)
{
    const tl_vec3 none = {0, 0, 0};
    cell->pressed = cell->apart = none;
    cell->pressed_volume = cell->apart_volume = 0;
    cell->pressed_second = cell->apart_second = 0;
    cell->pressed_more = cell->apart_more = 0;
    if (!curved)
        return;
    cell->pressed_area = cell->pressed_third = cell->pressed_fourth = 0;
    cell->pressed_centre = cell->pressed_square = cell->pressed_cube = none;
    cell->bent = (tl_bent){0};
}

/* Adds a cell's part, whose volumes are those of a triangle of the fan of area `fan` with the sides e and f. */
TL_INLINE void add_part(tl_cell *to, const cell_parts *part, double fan, tl_vec3 e, tl_vec3 f, const bool curved)
{
    const integrals *p = &part->pressed, *a = &part->apart;
    if (a->uu > 0) {
        to->apart_volume += fan * a->u;
        to->apart_second += fan * a->uu;
        to->apart = tl_v3_madd(tl_v3_madd(to->apart, fan * a->ua, e), fan * a->ub, f);
    }
    if (!(p->uu > 0))
        return;
    to->pressed_volume += fan * p->u;
    to->pressed_second += fan * p->uu;
    to->pressed = tl_v3_madd(tl_v3_madd(to->pressed, fan * p->ua, e), fan * p->ub, f);
    if (!curved)
        return;
    to->pressed_area += fan * p->one;
    to->pressed_centre = tl_v3_madd(tl_v3_madd(to->pressed_centre, fan * p->a, e), fan * p->b, f);
    to->pressed_square = tl_v3_madd(tl_v3_madd(to->pressed_square, fan * p->uua, e), fan * p->uub, f);
    to->pressed_cube = tl_v3_madd(tl_v3_madd(to->pressed_cube, fan * p->uuua, e), fan * p->uuub, f);
    to->pressed_third += fan * p->uuu;
    to->pressed_fourth += fan * p->uuuu;
}

/* The four cells of a triangle of the fan, of which `to` are the points: corner, edge, next corner, centroid. `o`:
 * closures of the centroid, of the corner and of the next. */
TL_INLINE void add_triangle_cells(const tl_cell_patch *of, const size_t to[4], const double o[3], tl_vec3 e, tl_vec3 f,
                                  const bool curved)
{
    tl_cell *cell = of->lanes->cell + of->lane;
    const double fan = tl_cell_area(of, to[1]) / cell_share[1];
    const double inside = TL_CELL_INNER * TL_CELL_INNER;
    node out[4], in[4];
    double far[4], near[4];
    for (size_t k = 0; k < 4; k++) {
        out[k] = (node){1 - outer_side[k], outer_side[k]};
        in[k] = (node){TL_CELL_INNER * out[k].a, TL_CELL_INNER * out[k].b};
        far[k] = o[1] + outer_side[k] * (o[2] - o[1]);
        near[k] = o[0] + TL_CELL_INNER * (far[k] - o[0]);
    }
    for (size_t k = 0; k < 3; k++) {
        double w = outer_side[k + 1] - outer_side[k], up = cell[to[k] * of->stride].level;
        const node one[3] = {in[k], out[k], out[k + 1]}, two[3] = {in[k], out[k + 1], in[k + 1]};
        const double u[3] = {near[k] + up, far[k] + up, far[k + 1] + up};
        const double v[3] = {near[k] + up, far[k + 1] + up, near[k + 1] + up};
        cell_parts part = {0};
        add_triangle(one, u, w * (1 - TL_CELL_INNER), curved, &part);
        add_triangle(two, v, w * (TL_CELL_INNER - inside), curved, &part);
        add_part(&cell[to[k] * of->stride], &part, fan, e, f, curved);
    }
    double up = cell[to[3] * of->stride].level;
    const node last[3] = {{0, 0}, in[0], in[3]};
    const double u[3] = {o[0] + up, near[0] + up, near[3] + up};
    cell_parts part = {0};
    add_triangle(last, u, inside, curved, &part);
    add_part(&cell[to[3] * of->stride], &part, fan, e, f, curved);
}

/* The overlap of a corner. */
static double corner_closure(const tl_cell_patch *of, size_t k)
{
    const tl_cell *cell = of->lanes->cell;
    const double centre = cell[tl_cell_lane(of, 2 * of->corners)].closure;
    const double near = cell[tl_cell_lane(of, of->corners + k)].closure;
    return centre + (near - centre) / tl_point_rule_of(false).reach;
}

void tl_cells_find(const tl_cell_patch *of, bool curved)
{
    const size_t n = of->corners;
    const tl_vec3 slope = lay_lifts(of);
    tl_cell *cell = of->lanes->cell;
    const double centre = cell[tl_cell_lane(of, 2 * n)].closure;
    for (size_t k = 0; k <= 2 * n; k++)
        clear(&cell[tl_cell_lane(of, k)], curved);
    tl_vec3 e = tl_cell_corner(of, 0);
    double here = corner_closure(of, 0) + tl_v3_dot(slope, e);
    for (size_t k = 0; k < n; k++) {
        const size_t next = (k + 1) % n, to[4] = {n + k, k, n + next, 2 * n};
        const tl_vec3 f = tl_cell_corner(of, next);
        const double there = corner_closure(of, next) + tl_v3_dot(slope, f);
        const double at[3] = {centre, here, there};
        if (curved)
            add_triangle_cells(of, to, at, e, f, true);
        else
            add_triangle_cells(of, to, at, e, f, false);
        e = f;
        here = there;
    }
}

tl_vec3 tl_cells_overlap_slope(const tl_cell_patch *of)
{
    const inertia by = inertia_of(of);
    const double centre = of->lanes->cell[tl_cell_lane(of, 2 * of->corners)].closure;
    tl_vec3 moment = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        double closure = of->lanes->cell[tl_cell_lane(of, k)].closure;
        moment = tl_v3_madd(moment, tl_cell_area(of, k) * (closure - centre), tl_cell_place(of, k));
    }
    return slope_of(&by, moment);
}
