/* partly_open.c - patches of which a part is closed and a part apart: their pressure integrated exactly.
 *
 * The overlap o is linear over a patch. A point of it stands for a cell, a part of the polygon of the point's area. Over the
 * cell the law's state is that of the point, so its walls press where o + lift > 0, and a bond pulls elsewhere. With
 * u = o + lift the law gets the means
 *
 *     p = 1/A int max(0, u) dA,    q = 1/A int max(0, -u) dA
 *
 * as closure = p - lift and closure_apart = q, and gives the force of both parts, kn A (p - hold q) for a linear spring.
 * What the cell has beside that force at its point is added to the contact:
 *
 *     M = k [int_{u>0} u (x - x_p) dA + hold int_{u<0} u (x - x_p) dA] cross n
 *     U = k/2 [int_{u>0} u^2 dA - A p^2 + hold (int_{u<0} u^2 dA - A q^2)]
 *
 * k is kn. So force, moment and energy are the exact integrals over the polygon, whatever part of it is closed. Where a part of
 * the points holds and another does not, that serves for patches that are wholly apart, too. Where all points hold, the points' own
 * rule is exact, and there are no cells. In the step in which some of it breaks, the cells are found after the law: then a force,
 * k (P - hold Q) less that of the point, comes to the moment and the energy.
 *
 * A tension that a bond loses takes its part of U with it, and the work of this step, by the mean of the forces of both ends. With u'
 * before the step and u after it that is k/2 int_{u<0} u u' dA of the share lost: heat. The law has counted that of the means.
 *
 * What lifts that differ from point to point change of this is at find_uneven, and what a stress that is no line in u does in bent.c.
 *
 * The cells. A patch of k corners has k points between corners, k at corners, and the centroid, all drawn in towards that
 * (patch.c); so its corners follow from its points. In the triangle of an edge and the centroid, the centroid's cell is the
 * triangle drawn in by INNER, 7/75 of its area. Beyond it the rays from the centroid through the shares SIDE and 1 - SIDE of
 * the edge part the cells of the two corners, 16/75 each, from that of the edge, 36/75.
 *
 * The mean of u over a cell is not u at its point: they differ by r, and sum A r = 0 over the patch. While all is closed the
 * points' own u serve, as exactly. The means take (1 - t) r less, where t grows from 0 to 1 while the first cell opens. So no
 * point's closure jumps, and the sums are the same for any t. Under a curved law they are not: there t is 1 and all patches have cells,
 * also those that are closed. */
#include "force/partly_open.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/detection.h"
#include "force/bent.h"
#include "force/triangle_parts.h"
#include "narrow/frame2.h"

#include <math.h>
#include <string.h>

#define INNER 0.30550504633038933 /* sqrt(7 / 75) */
#define SIDE (16.0 / 68)
/* The largest stiffness of what presses, over that which the law says: what is more is rounding, or slip has opened it. */
#define SAME_STIFFNESS (1 + 1e-12)

/* A lane's patch: where its points are in the lanes and in the table. */
typedef struct patch {
    const tl_points_table *p;
    const tl_point_lanes *lanes;
    size_t lane, row, corners;
    uint32_t faces; /* their key, which is in all of its points' */
} patch;

static tl_vec3 arm_of(const patch *of, size_t k)
{
    return tl_columns_get(of->lanes->arm, of->lane + k * TL_LANES);
}

static double area_of(const patch *of, size_t k)
{
    return of->p->area[of->row + k * TL_LANES];
}

/* The patch of a contact with points drawn in towards its centroid, the last of them. false: it is none. */
static bool find_patch(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t,
                       size_t lane, size_t l, patch *out)
{
    uint32_t c = group->contact[l];
    if (c == TL_NO_ROW)
        return false;
    const tl_facet *f = &m->detect->contacts.facet[c];
    size_t count = m->detect->contacts.point_count[c], corners = count / 2;
    if (f->kind != TL_FACET_PATCH || count % 2 == 0 || corners < 3)
        return false;
    *out = (patch){.p = &m->detect->points,
                   .lanes = t,
                   .lane = lane + l,
                   .row = group->start + l,
                   .corners = corners,
                   .faces = tl_key_of(0, f->ia, f->ib)};
    uint32_t last = out->p->key[out->row + 2 * corners * TL_LANES];
    return last == tl_centroid_key(f->ia, f->ib);
}

/* Whether the points are those of all corners and of every two neighbours: where faces hardly overlap some may have had no
 * area. */
static bool has_all_points(const patch *of)
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

/* ---------------------------------------------------------------- edges ------------------ */

/* The least of a linear closure over a cell whose outer side begins at the values given: it is there, or on its inner side. */
static double lowest(double centre, double outer)
{
    return outer < centre ? outer : centre + INNER * (outer - centre);
}

static void put_edges(const patch *of)
{
    const tl_point_rule rule = tl_point_rule_of(false);
    const double *closure = of->lanes->closure + of->lane, per = 1 / rule.reach;
    double *edge = of->lanes->edge + of->lane;
    size_t n = of->corners;
    double centre = closure[2 * n * TL_LANES], least = centre;
    for (size_t k = 0; k < n; k++)
        edge[(n + k) * TL_LANES] = centre + per * (closure[(n + k) * TL_LANES] - centre);
    double first = edge[n * TL_LANES], here = first;
    double before = edge[(2 * n - 1) * TL_LANES];
    for (size_t k = 0; k < n; k++) {
        double next = k + 1 < n ? edge[(n + k + 1) * TL_LANES] : first;
        double side = fmin(fmin(next, before) - here, 0), along = fabs(next - here);
        double middle = 0.5 * (here + next) - (0.5 - SIDE) * along;
        edge[(n + k) * TL_LANES] = lowest(centre, here + SIDE * side);
        edge[k * TL_LANES] = lowest(centre, middle);
        least = fmin(least, centre + INNER * (here - centre));
        before = here;
        here = next;
    }
    edge[2 * n * TL_LANES] = least;
}

void tl_simd_group_edges(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t,
                         size_t lane)
{
    memcpy(t->edge + lane, t->closure + lane, (size_t)group->slots * TL_LANES * sizeof *t->edge);
    for (size_t l = 0; l < TL_LANES; l++) {
        patch of;
        if (find_patch(m, group, t, lane, l, &of))
            put_edges(&of);
    }
}

/* ---------------------------------------------------------------- which ------------------ */

/* The least and the largest of closures of the points of each lane. */
typedef struct range {
    double low[TL_LANES], high[TL_LANES];
} range;

TL_VECTORIZED static void find_range(const double *restrict area, const double *restrict closure,
                                     const double *restrict lift, size_t slots, range *restrict out)
{
    range r;
    for (size_t l = 0; l < TL_LANES; l++) {
        r.low[l] = INFINITY;
        r.high[l] = -INFINITY;
    }
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double u = closure[at + l] + lift[at + l], a = area[at + l];
            double under = a > 0 ? u : INFINITY, over = a > 0 ? u : -INFINITY;
            r.low[l] = under < r.low[l] ? under : r.low[l];
            r.high[l] = over > r.high[l] ? over : r.high[l];
        }
    *out = r;
}

/* How far corners may be beyond the points. */
static double beyond(const range *closures, size_t l)
{
    return (closures->high[l] - closures->low[l]) * (1 / tl_point_rule_of(false).reach - 1);
}

/* Lanes where some part may be apart, a bit each: of a range of u, by that of closures. */
static uint32_t opening_lanes(const range *u, const range *closures)
{
    uint32_t out = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        out |= (uint32_t)(u->low[l] - beyond(closures, l) < 0) << l;
    return out;
}

/* The least and the largest share of what is apart that the points of a patch hold. Where that is 1 throughout, the points' own
 * rule is exact. */
typedef struct holds {
    double least, most;
} holds;

static holds holds_of(const patch *of)
{
    holds out = {1, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        double hold = of->lanes->hold[of->lane + k * TL_LANES];
        out.least = fmin(out.least, hold);
        out.most = fmax(out.most, hold);
    }
    return out;
}

/* ---------------------------------------------------------------- cells ------------------ */

/* Shares of the area of a triangle of the fan in its cells: a corner's, the edge's, the centroid's. */
static const double cell_share[3] = {16. / 75, 36. / 75, 7. / 75};
static const double outer_side[4] = {0, SIDE, 1 - SIDE, 1};

/* Adds a cell's part, whose volumes are those of a triangle of the fan of area `fan` with the sides e and f. */
static void add_part(tl_cell *to, const cell_parts *part, double fan, tl_vec3 e, tl_vec3 f)
{
    const integrals *p = &part->pressed, *a = &part->apart;
    to->pressed_area += fan * p->one;
    to->pressed_centre = tl_v3_madd(tl_v3_madd(to->pressed_centre, fan * p->a, e), fan * p->b, f);
    to->pressed_volume += fan * p->u;
    to->apart_volume += fan * a->u;
    to->pressed_second += fan * p->uu;
    to->apart_second += fan * a->uu;
    to->pressed = tl_v3_madd(tl_v3_madd(to->pressed, fan * p->ua, e), fan * p->ub, f);
    to->apart = tl_v3_madd(tl_v3_madd(to->apart, fan * a->ua, e), fan * a->ub, f);
    to->pressed_square =
        tl_v3_madd(tl_v3_madd(to->pressed_square, fan * p->uua, e), fan * p->uub, f);
    to->pressed_cube = tl_v3_madd(tl_v3_madd(to->pressed_cube, fan * p->uuua, e), fan * p->uuub, f);
    to->pressed_third += fan * p->uuu;
    to->pressed_fourth += fan * p->uuuu;
}

/* The four cells of a triangle of the fan, of which `to` are the points: corner, edge, next corner, centroid. `o`: closures of
 * the centroid, of the corner and of the next. */
static void add_triangle_cells(const patch *of, const size_t to[4], const double o[3], tl_vec3 e,
                               tl_vec3 f, bool curved)
{
    tl_cell *cell = of->lanes->cell + of->lane;
    const double *lift = of->lanes->lift + of->lane;
    const double fan = area_of(of, to[1]) / cell_share[1];
    const double inside = INNER * INNER;
    node out[4], in[4];
    double far[4], near[4];
    for (size_t k = 0; k < 4; k++) {
        out[k] = (node){1 - outer_side[k], outer_side[k]};
        in[k] = (node){INNER * out[k].a, INNER * out[k].b};
        far[k] = o[1] + outer_side[k] * (o[2] - o[1]);
        near[k] = o[0] + INNER * (far[k] - o[0]);
    }
    for (size_t k = 0; k < 3; k++) {
        double w = outer_side[k + 1] - outer_side[k], up = lift[to[k] * TL_LANES];
        const node one[3] = {in[k], out[k], out[k + 1]}, two[3] = {in[k], out[k + 1], in[k + 1]};
        const double u[3] = {near[k] + up, far[k] + up, far[k + 1] + up};
        const double v[3] = {near[k] + up, far[k + 1] + up, near[k + 1] + up};
        cell_parts part = {0};
        add_triangle(one, u, w * (1 - INNER), curved, &part);
        add_triangle(two, v, w * (INNER - inside), curved, &part);
        add_part(&cell[to[k] * TL_LANES], &part, fan, e, f);
    }
    double up = lift[to[3] * TL_LANES];
    const node last[3] = {{0, 0}, in[0], in[3]};
    const double u[3] = {o[0] + up, near[0] + up, near[3] + up};
    cell_parts part = {0};
    add_triangle(last, u, inside, curved, &part);
    add_part(&cell[to[3] * TL_LANES], &part, fan, e, f);
}

/* Integrals of all cells; moments about the centroid. */
static void integrate_cells(const patch *of, bool curved)
{
    const tl_point_rule rule = tl_point_rule_of(false);
    const double *closure = of->lanes->closure + of->lane, per = 1 / rule.reach;
    size_t n = of->corners;
    const double o = closure[2 * n * TL_LANES];
    const tl_vec3 centre = arm_of(of, 2 * n);
    for (size_t k = 0; k <= 2 * n; k++)
        of->lanes->cell[of->lane + k * TL_LANES] = (tl_cell){0};
    tl_vec3 e = tl_v3_scale(per, tl_v3_sub(arm_of(of, n), centre));
    double here = o + per * (closure[n * TL_LANES] - o);
    for (size_t k = 0; k < n; k++) {
        size_t next = (k + 1) % n;
        const size_t to[4] = {n + k, k, n + next, 2 * n};
        tl_vec3 f = tl_v3_scale(per, tl_v3_sub(arm_of(of, n + next), centre));
        double there = o + per * (closure[(n + next) * TL_LANES] - o);
        const double at[3] = {o, here, there};
        add_triangle_cells(of, to, at, e, f, curved);
        e = f;
        here = there;
    }
}

/* Finds the centres of all cells. In a triangle of the fan a cell is r ((1 - q) e + q f) with r and q between two bounds each, and its
 * area that of the triangle times 2 r dr dq. */
static void find_centres(const patch *of)
{
    const double per = 1 / tl_point_rule_of(false).reach, near = SIDE - 0.5 * SIDE * SIDE;
    const double next = 0.5 * SIDE * SIDE, cube = INNER * INNER * INNER;
    tl_cell *cell = of->lanes->cell + of->lane;
    size_t n = of->corners;
    for (size_t k = 0; k <= 2 * n; k++)
        cell[k * TL_LANES].centre = tl_v3(0, 0, 0);
    for (size_t k = 0; k < n; k++) {
        size_t one = n + k, other = n + (k + 1) % n;
        tl_vec3 e = tl_v3_scale(per, tl_v3_sub(arm_of(of, one), arm_of(of, 2 * n)));
        tl_vec3 f = tl_v3_scale(per, tl_v3_sub(arm_of(of, other), arm_of(of, 2 * n)));
        double fan = area_of(of, k) / cell_share[1], by = fan * (1 - cube) * 2 / 3;
        tl_vec3 *to[4] = {&cell[one * TL_LANES].centre, &cell[k * TL_LANES].centre,
                          &cell[other * TL_LANES].centre, &cell[2 * n * TL_LANES].centre};
        *to[0] = tl_v3_madd(tl_v3_madd(*to[0], by * near, e), by * next, f);
        *to[1] = tl_v3_madd(*to[1], by * (0.5 - SIDE), tl_v3_add(e, f));
        *to[2] = tl_v3_madd(tl_v3_madd(*to[2], by * next, e), by * near, f);
        *to[3] = tl_v3_madd(*to[3], fan * cube / 3, tl_v3_add(e, f));
    }
}

/* What a change of w takes off where lifts differ over a patch, over k: of the force and of the moment. */
typedef struct uneven {
    double force;
    tl_vec3 moment;
} uneven;

/* Mean of u over a cell less u at its point, times the area. */
static double beside_point(const patch *of, size_t k)
{
    const tl_point_lanes *t = of->lanes;
    size_t i = of->lane + k * TL_LANES;
    double at_point = area_of(of, k) * (t->closure[i] + t->lift[i]);
    return t->cell[i].pressed_volume - t->cell[i].apart_volume - at_point;
}

/* Takes from each cell what it does not press with over its area, but at its point: w (lift - least). Under a curved law each cell has a
 * stiffness of its own, which ends with what presses: so it has its own w. */
static void press_at_points(const patch *of, double least, double w, bool curved)
{
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = of->lane + k * TL_LANES;
        tl_cell *cell = &of->lanes->cell[i];
        tl_vec3 arm = tl_v3_sub(arm_of(of, k), arm_of(of, 2 * of->corners));
        double sum = cell->pressed_volume + cell->apart_volume;
        double own = curved && sum > 0 ? cell->pressed_volume / sum : w;
        double lift = own * (of->lanes->lift[i] - least);
        tl_vec3 beside = tl_v3_madd(cell->centre, -area_of(of, k), arm);
        cell->pressed = tl_v3_madd(cell->pressed, -lift, beside);
        cell->pressed_second -= 2 * lift * beside_point(of, k);
    }
}

/* What a lift is beyond the least of the patch presses at the point, as it does while all is closed, and not over the cell: else a
 * patch would press elsewhere as soon as some of it is apart, by a rounding. As the patch opens, from P = int u over what presses and
 * Q = int -u over what is apart, that is less, by
 *
 *     w = P / (P + Q),    U changes by -k w sum lift A (mean of u over the cell - u at the point),
 *
 * and force and moment by its gradient. P + Q is at least about A times the differences of the lifts, so what is added to the force
 * stays small beside them. */
static uneven find_uneven(const patch *of, bool curved)
{
    const tl_point_lanes *t = of->lanes;
    double least = INFINITY, most = -INFINITY, pressed = 0, apart = 0, pressed_area = 0, area = 0;
    tl_vec3 pressed_centre = {0, 0, 0}, centre = {0, 0, 0};
    double pays = 0;
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        least = fmin(least, t->lift[of->lane + k * TL_LANES]);
        most = fmax(most, t->lift[of->lane + k * TL_LANES]);
    }
    if (!(most > least))
        return (uneven){.force = 0};
    find_centres(of);
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = of->lane + k * TL_LANES;
        const tl_cell *cell = &t->cell[i];
        pays += (t->lift[i] - least) * beside_point(of, k);
        pressed += cell->pressed_volume;
        apart += cell->apart_volume;
        area += area_of(of, k);
        pressed_area += cell->pressed_area;
        centre = tl_v3_add(centre, cell->centre);
        pressed_centre = tl_v3_add(pressed_centre, cell->pressed_centre);
    }
    double w = pressed / (pressed + apart), by = pays / (pressed + apart);
    if (!(pressed > 0) || !isfinite(by))
        return (uneven){.force = 0};
    press_at_points(of, least, w, curved);
    if (curved)
        return (uneven){.force = 0};
    tl_vec3 moment = tl_v3_scale(by * (1 - w), pressed_centre);
    return (uneven){by * ((1 - w) * pressed_area + w * (area - pressed_area)),
                    tl_v3_madd(moment, by * w, tl_v3_sub(centre, pressed_centre))};
}

/* How far the means are those of the cells, and not of the points: t. */
static double share_of_cells(const patch *of)
{
    double share = 0;
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        const tl_cell *cell = &of->lanes->cell[of->lane + k * TL_LANES];
        double sum = cell->pressed_volume + cell->apart_volume;
        double loose = 1 - of->lanes->hold[of->lane + k * TL_LANES];
        share = fmax(share, sum > 0 ? loose * (cell->apart_volume / sum) : 0);
    }
    return share;
}

/* Leaves in a cell what it has beside that which the law has been given of it: p and q, or only p < 0 of what is apart as a whole.
 * `whole`: the volumes that the forces of the cell have. */
static void leave_rest(const patch *of, size_t k, double p, double q, const double whole[2])
{
    const tl_point_lanes *t = of->lanes;
    tl_cell *cell = &t->cell[of->lane + k * TL_LANES];
    tl_vec3 arm = tl_v3_sub(arm_of(of, k), arm_of(of, 2 * of->corners));
    double area = area_of(of, k);
    double pressed = p > 0 ? area * p : 0, apart = p > 0 ? area * q : -area * p;
    cell->hold = t->hold[of->lane + k * TL_LANES];
    cell->pressed_volume = pressed;
    cell->apart_volume = apart;
    cell->pressed_more = whole[0] - pressed;
    cell->apart_more = whole[1] - apart;
    cell->pressed = tl_v3_madd(cell->pressed, -pressed, arm);
    cell->apart = tl_v3_madd(cell->apart, -apart, arm);
    cell->pressed_second = 0.5 * (cell->pressed_second - pressed * pressed / area);
    cell->apart_second = 0.5 * (cell->apart_second - apart * apart / area);
}

/* Takes off from the cells, which have their means: from each its share of what presses. */
static void take_off(const patch *of, const uneven *by)
{
    tl_cell *cell = of->lanes->cell + of->lane;
    double pressed = 0;
    for (size_t k = 0; k <= 2 * of->corners; k++)
        pressed += cell[k * TL_LANES].pressed_volume;
    for (size_t k = 0; k <= 2 * of->corners && pressed > 0; k++) {
        tl_cell *to = &cell[k * TL_LANES];
        double share = to->pressed_volume / pressed;
        to->pressed_more -= share * by->force;
        to->pressed = tl_v3_madd(to->pressed, -share, by->moment);
    }
}

/* Gives a point the closure at which its whole cell would press as its closed part does. The cell keeps what it has beside that. */
static void put_means(const patch *of, size_t k, double share, bool curved)
{
    const tl_point_lanes *t = of->lanes;
    size_t i = of->lane + k * TL_LANES;
    tl_cell *cell = &t->cell[i];
    double area = area_of(of, k), u = t->closure[i] + t->lift[i];
    double more = (cell->pressed_volume - cell->apart_volume) / area - u;
    double p = cell->pressed_volume / area - (1 - share) * more, q = cell->apart_volume / area;
    double second = 0, rest = 0;
    if (curved) {
        p += cell->bent.closure;
        rest = cell->bent.more;
        second = cell->bent.second;
        cell->pressed = tl_v3_add(cell->pressed, cell->bent.moment);
    }
    const double whole[2] = {area * p + rest, area * q};
    if (!(cell->pressed_volume > 0) || (p < 0 && q > 0)) { /* apart as a whole */
        p -= q;
        q = 0;
    }
    t->closure[i] = p - t->lift[i];
    t->apart[i] = q;
    leave_rest(of, k, p, q, whole);
    cell->pressed_second += second;
}

/* What the cell of a point that has gone by its own closure has beside that. */
static void leave_own(const patch *of, size_t k)
{
    const tl_point_lanes *t = of->lanes;
    size_t i = of->lane + k * TL_LANES;
    const double whole[2] = {t->cell[i].pressed_volume, t->cell[i].apart_volume};
    leave_rest(of, k, t->closure[i] + t->lift[i], 0, whole);
}

/* The patches of a SIMD group whose points get means: those of which a part may be apart, and under a curved law all. Gives how many, and
 * the lanes of these and of those that hold throughout. */
static size_t find_parts(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                         const tl_point_lanes *t, size_t lane, const range *u,
                         const range *closures, patch out[TL_LANES], tl_part_lanes *lanes)
{
    const uint32_t all = (1u << TL_LANES) - 1;
    size_t count = 0;
    for (uint32_t left = tl_law_presses(law) ? all : opening_lanes(u, closures); left;
         left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        patch *of = &out[count];
        bool partly = u->high[l] + beyond(closures, l) > 0;
        if ((!partly && law->pulls == TL_PULL_NONE) || !find_patch(m, group, t, lane, l, of))
            continue;
        const holds hold = holds_of(of);
        if ((!partly && !(hold.most > 0)) || !has_all_points(of))
            continue;
        if (hold.least >= 1) {
            lanes->held |= 1u << l;
            continue;
        }
        lanes->parts |= 1u << l;
        count++;
    }
    return count;
}

tl_part_lanes tl_simd_group_part(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                                 const tl_point_lanes *t, size_t lane)
{
    tl_part_lanes lanes = {0, 0};
    const tl_points_table *p = &m->detect->points;
    size_t rows = (size_t)group->slots * TL_LANES;
    const bool curved = tl_law_presses(law);
    range closures, u;
    find_range(p->area + group->start, t->closure + lane, t->zero + lane, group->slots, &closures);
    if (!curved && !p->f_n0 && !opening_lanes(&closures, &closures))
        return lanes;
    tl_points_across_gap(law, p, group->start, rows, t->lift + lane, t->hold + lane);
    find_range(p->area + group->start, t->closure + lane, t->lift + lane, group->slots, &u);
    patch of[TL_LANES];
    size_t count = find_parts(m, law, group, t, lane, &u, &closures, of, &lanes);
    if (count == 0)
        return lanes;
    memset(t->apart + lane, 0, rows * sizeof *t->apart);
    for (size_t j = 0; j < count; j++)
        integrate_cells(&of[j], curved);
    if (curved)
        tl_cells_bend(m, law, group, t, lane, lanes.parts);
    for (size_t j = 0; j < count; j++) {
        const double share = curved ? 1 : share_of_cells(&of[j]);
        const uneven by = find_uneven(&of[j], curved);
        for (size_t k = 0; k <= 2 * of[j].corners; k++)
            put_means(&of[j], k, share, curved);
        take_off(&of[j], &by);
    }
    return lanes;
}

/* ---------------------------------------------------------------- sums ------------------- */

uint32_t tl_simd_group_broken(const tl_model *m, const tl_simd_group *group,
                              const tl_point_lanes *t, size_t lane, uint32_t held)
{
    uint32_t out = 0;
    for (uint32_t left = held; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        double heat = 0;
        patch of;
        for (size_t k = 0; k < group->slots; k++)
            heat += t->dissipated[lane + l + k * TL_LANES];
        if (!(heat > 0) || !find_patch(m, group, t, lane, l, &of))
            continue;
        out |= 1u << l;
        integrate_cells(&of, false);
        const uneven by = find_uneven(&of, false);
        for (size_t k = 0; k <= 2 * of.corners; k++)
            leave_own(&of, k);
        take_off(&of, &by);
    }
    return out;
}

/* Of a patch with its relative motion in the step: `turn`, rad, and along the normal at the centroid, m. */
static tl_part_sums sum_cells(const patch *of, const tl_law *law, tl_vec3 turn)
{
    const tl_point_lanes *t = of->lanes;
    const tl_vec3 n = tl_columns_get(t->normal, of->lane);
    const double du = t->du_n[of->lane + 2 * of->corners * TL_LANES];
    tl_part_sums out = {.stored = 0};
    tl_vec3 sum = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = of->lane + k * TL_LANES;
        const tl_cell *cell = &t->cell[i];
        double pulls = law->kn * t->hold[i], lost = law->kn * (cell->hold - t->hold[i]);
        double straight = tl_law_is_linear(law) ? law->kn : 0;
        double pressed = of->p->f_n[of->row + k * TL_LANES] + pulls * cell->apart_volume;
        /* what slip has opened in this step presses at the point: it is not in the volume, which may be next to nothing */
        double spring = cell->pressed_volume > 0 ? pressed / cell->pressed_volume : straight;
        spring = fmax(0, fmin(spring, SAME_STIFFNESS * law->kn));
        double moved = du * cell->apart_more + tl_v3_dot(tl_v3_cross(turn, cell->apart), n);
        sum = tl_v3_madd(tl_v3_madd(sum, spring, cell->pressed), -pulls, cell->apart);
        out.stored += spring * cell->pressed_second + pulls * cell->apart_second;
        out.force += spring * cell->pressed_more - pulls * cell->apart_more;
        out.dissipated += lost > 0 ? lost * (cell->apart_second - 0.5 * moved) : 0;
    }
    out.moment = tl_v3_cross(sum, n);
    out.arm = arm_of(of, 2 * of->corners);
    return out;
}

void tl_simd_group_part_sum(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                            const tl_point_lanes *t, size_t lane, uint32_t parts,
                            const tl_vec3 *turn, tl_part_sums *out)
{
    if (law->pulls != TL_PULL_NONE)
        tl_points_across_gap(law, &m->detect->points, group->start, (size_t)group->slots * TL_LANES,
                             t->lift + lane, t->hold + lane);
    for (uint32_t left = parts; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        const patch of = {.p = &m->detect->points,
                          .lanes = t,
                          .lane = lane + l,
                          .row = group->start + l,
                          .corners = m->detect->contacts.point_count[group->contact[l]] / 2u};
        out[l] = sum_cells(&of, law, turn[l]);
    }
}
