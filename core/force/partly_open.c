/* partly_open.c - patches of which a part is closed and a part apart: their pressure integrated exactly.
 *
 * A point stands for a cell (cells.c), over which the law's state is that of the point. Its walls press where u > 0,
 * and a bond pulls elsewhere. The law gets the means
 *
 *     p = 1/A int max(0, u) dA,    q = 1/A int max(0, -u) dA
 *
 * as closure = p - lift and closure_apart = q, and gives the force of both parts, kn A (p - hold q) for a linear
 * spring. What the cell has beside that force at its point is added to the contact:
 *
 *     M = k [int_{u>0} u (x - x_p) dA + hold int_{u<0} u (x - x_p) dA] cross n
 *     U = k/2 [int_{u>0} u^2 dA - A p^2 + hold (int_{u<0} u^2 dA - A q^2)]
 *
 * k is kn. So force, moment and energy are the exact integrals over the polygon, whatever part of it is closed. Where a
 * part of the points holds and another does not, that serves for patches that are wholly apart, too. Where all points
 * hold, the points' own rule is exact, and there are no cells. In the step in which some of it breaks, the cells are
 * found after the law: then a force, k (P - hold Q) less that of the point, comes to the moment and the energy.
 *
 * A tension that a bond loses takes its part of U with it. It also takes the work of this step, by the mean of the
 * forces of both ends. With u' before the step and u after it that is k/2 int_{u<0} u u' dA of the share lost: heat.
 * The law has counted that of the means.
 *
 * As slip opens points in a step, u changes everywhere. So the cells are found once more after the law. Then forces are
 * the gradient of what is stored. The heat is what was stored, less what is stored then and less the work of the step.
 * What a stress changes of this that is no line in u is in partly_open.c.
 *
 * The mean of u over a cell is not u at its point: they differ by r, and sum A r = 0 over the patch. While all is
 * closed the points' own u serve, as exactly. The means take (1 - t) r less, where t grows from 0 to 1 while the first
 * cell opens. So no point's closure jumps, and the sums are the same for any t. Under a curved law they are not: there
 * t is 1 and all patches have cells, also those that are closed. */
#include "force/partly_open.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "base/inline.h"
#include "contact/across_gap.h"
#include "contact/cells.h"
#include "contact/detection.h"
#include "contact/lean.h"
#include "force/closures.h"
#include "force/field_press.h"
#include "narrow/frame2.h"

#include <math.h>
#include <string.h>

/* Tolerance: how far the lifts of a patch may be beyond those of its points at a corner, over the largest difference
 * of these. Their plane is fitted to all. Test: lua/test_cut_rounding. */
#define UNEVEN 1.5
/* Tolerance: the largest stiffness of what presses, over that which the law says: what is more is rounding, or slip
 * has opened it. */
#define SAME_STIFFNESS (1 + 1e-12)

/* ---------------------------------------------------------------- stresses that are no line ---
 *
 * Cells of patches under a stress that is no line in the closure.
 *
 * A law that is not linear tells the energy E(u) of what presses, A int s du; so its stress s follows from two
 * energies. Over the closed part of a cell two closures stand for all (closures.c), with its moments I_n = int u^n dA.
 * With the cubic of E / (A u) that meets energies and stresses at both, p_0 + p_1 u + p_2 u^2 + p_3 u^3, the cell has
 *
 *     energy  U = sum p_n I_(n+1)
 *     force   int s dA   = sum (n + 1) p_n I_n              I_0 = int dA
 *     moment  int s x dA = sum (n + 1) p_n int u^n x dA
 *
 * which is exact for any stress up to u^3. The force is the gradient of the energy, for what the moments change of the
 * two closures changes nothing of U: those of Gauss are so. The law gets a closure p at which its whole cell presses
 * with nearly that force, A s(p) = int s dA: 1/s is taken to be linear in 1/u between two closures, as it is of lines
 * and hyperbolas. The cell keeps what force, moment and energy are beside those of its point. */

/* Tolerance: closures that are tried for that of the law, and how near its stress is to be to the mean one, relative.
 * Test: lua/test_curved_slides. */
#define STEPS 12
#define NEAR_ENOUGH 1e-9

#define ROWS TL_PRESSED_ROWS

/* Cells at work: those of some rows of a SIMD group. */
typedef struct cells {
    const tl_model *m;
    const tl_law *law;
    const tl_point_lanes *t;
    size_t row, lane, count; /* at most ROWS */
    uint32_t parts;
    bool found; /* their points have their closures */
} cells;

/* What a law answers at closures u of cells, 0 where there is none: stress and energy per area. */
typedef struct answer {
    double u[ROWS], stress[ROWS], energy[ROWS];
} answer;

/* Of a cell: the energy, force and moment of what presses. */
typedef struct bent_whole {
    double energy, force;
    tl_vec3 moment;
} bent_whole;

static void ask(const cells *of, answer *at)
{
    const double *lift = of->t->lift + of->lane, *area = of->m->detect->points.area + of->row;
    tl_law_press(of->m, of->law, of->row, of->count, of->t, at->u, lift, at->energy, at->stress);
    for (size_t i = 0; i < of->count; i++) {
        double per = at->u[i] > 0 ? 1 / area[i] : 0;
        at->stress[i] *= per;
        at->energy[i] *= per;
    }
}

/* The two closures that stand for all of each cell. */
static void choose_all(const cells *of, answer *one, answer *two)
{
    for (size_t i = 0; i < of->count; i++) {
        const tl_cell *cell = &of->t->cell[of->lane + i];
        const double moment[] = {cell->pressed_volume, cell->pressed_second, cell->pressed_third, cell->pressed_fourth};
        double closure[2] = {0, 0};
        if ((of->parts >> i % TL_LANES & 1) && cell->pressed_volume > 0)
            tl_two_closures(moment, closure);
        one->u[i] = closure[0];
        two->u[i] = closure[1];
    }
}

static bent_whole whole_of(const tl_cell *cell, const double at[2], const double energy[2], const double stress[2])
{
    double p[4];
    bent_whole out;
    tl_energy_cubic(at, energy, stress, p);
    out.energy = p[0] * cell->pressed_volume + p[1] * cell->pressed_second + p[2] * cell->pressed_third +
                 p[3] * cell->pressed_fourth;
    out.force = p[0] * cell->pressed_area + 2 * p[1] * cell->pressed_volume + 3 * p[2] * cell->pressed_second +
                4 * p[3] * cell->pressed_third;
    out.moment = tl_v3_madd(tl_v3_scale(p[0], cell->pressed_centre), 2 * p[1], cell->pressed);
    out.moment = tl_v3_madd(out.moment, 3 * p[2], cell->pressed_square);
    out.moment = tl_v3_madd(out.moment, 4 * p[3], cell->pressed_cube);
    return out;
}

/* A closure at which the stress may be the mean one, between two of which the stresses are known. Below both it follows
 * from the power n of the closure with which the stress goes, n + 1 = s u / E, at least a line. */
static double closure_at(double mean, const answer *one, const answer *two, size_t i)
{
    double u = one->u[i], s = one->stress[i], v = two->u[i], t = two->stress[i];
    if (mean < s) {
        double n = fmax(s * u / one->energy[i] - 1, 1), x = (mean - s) / (mean + s) / n;
        return u * (1 + x) / (1 - x);
    }
    double rise = 1 / s - 1 / t;
    double at = 1 / v + (1 / mean - 1 / t) * (1 / u - 1 / v) / rise;
    return rise > 0 && at > 1 / v ? 1 / at : v;
}

static double area_of(const cells *of, size_t i)
{
    return of->m->detect->points.area[of->row + i];
}

/* What each cell presses with, by two closures. */
static void find_wholes(const cells *of, const answer *one, const answer *two, bent_whole by[ROWS])
{
    for (size_t i = 0; i < of->count; i++) {
        const double at[] = {one->u[i], two->u[i]}, energy[] = {one->energy[i], two->energy[i]};
        const double stress[] = {one->stress[i], two->stress[i]};
        by[i].force = 0;
        if (one->stress[i] > 0 && two->stress[i] > 0)
            by[i] = whole_of(&of->t->cell[of->lane + i], at, energy, stress);
    }
}

/* What a cell has where its point presses at the closure u with the stress and energy per area given. */
static tl_bent bent_of(const tl_cell *cell, const bent_whole *by, double area, double u, double stress, double energy)
{
    double scale = u / stress;
    double second = cell->pressed_second - area * u * u;
    return (tl_bent){
        .closure = u - cell->pressed_volume / area,
        .more = scale * by->force - area * u,
        .second = scale * (by->energy - area * energy) - 0.5 * second,
        .moment = tl_v3_madd(tl_v3_neg(cell->pressed), scale, by->moment),
    };
}

/* The closure tried replaces that on its side of the mean. The same side twice is a knee: the next is the middle. */
static double next(double mean, answer *one, answer *two, const answer *even, size_t i, int *side)
{
    const bool above = even->stress[i] >= mean;
    answer *to = above ? two : one;
    to->u[i] = even->u[i];
    to->stress[i] = even->stress[i];
    to->energy[i] = even->energy[i];
    const bool again = *side == (above ? 1 : -1);
    *side = above ? 1 : -1;
    double at = closure_at(mean, one, two, i);
    return again && at >= one->u[i] ? 0.5 * (one->u[i] + two->u[i]) : at;
}

/* Finds closures of the means, by those at which the curve is known. */
static void find_even(const cells *of, const bent_whole by[ROWS], answer *one, answer *two, answer *even)
{
    int side[ROWS] = {0};
    bool found = false;
    for (size_t i = 0; i < of->count; i++)
        even->u[i] = by[i].force > 0 ? closure_at(by[i].force / area_of(of, i), one, two, i) : 0;
    ask(of, even);
    for (int k = 1; k < STEPS && !found; k++) {
        found = true;
        for (size_t i = 0; i < of->count; i++) {
            const double mean = by[i].force / area_of(of, i);
            if (!(even->u[i] > 0) || fabs(even->stress[i] - mean) <= NEAR_ENOUGH * mean)
                continue;
            even->u[i] = next(mean, one, two, even, i, &side[i]);
            found = false;
        }
        if (!found)
            ask(of, even);
    }
}

/* Stays at the closures of the points. */
static void stay(const cells *of, const bent_whole by[ROWS], answer *even)
{
    for (size_t i = 0; i < of->count; i++) {
        double closure = of->t->closure[of->lane + i] + of->t->lift[of->lane + i];
        even->u[i] = by[i].force > 0 ? fmax(closure, 0) : 0;
    }
    ask(of, even);
}

static void bend(const cells *of)
{
    answer one, two, even;
    bent_whole by[ROWS];
    choose_all(of, &one, &two);
    ask(of, &one);
    ask(of, &two);
    find_wholes(of, &one, &two, by);
    if (of->found)
        stay(of, by, &even);
    else
        find_even(of, by, &one, &two, &even);
    for (size_t i = 0; i < of->count; i++) {
        tl_cell *cell = &of->t->cell[of->lane + i];
        cell->bent = even.stress[i] > 0
                         ? bent_of(cell, &by[i], area_of(of, i), even.u[i], even.stress[i], even.energy[i])
                         : (tl_bent){0};
    }
}

/* What the stress of a law that tells its energy (tl_law_presses) changes in cells of the lanes `parts`, whose
 * integrals are known. `found`: of points at their closures, else of closures that suit the cells. */
static void cells_bend(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *lanes,
                       size_t lane, uint32_t parts, bool found)
{
    size_t rows = (size_t)group->slots * TL_LANES;
    for (size_t at = 0; at < rows; at += ROWS) {
        const cells of = {.m = m,
                          .law = law,
                          .t = lanes,
                          .row = group->start + at,
                          .lane = lane + at,
                          .count = rows - at < ROWS ? rows - at : ROWS,
                          .parts = parts,
                          .found = found};
        bend(&of);
    }
}

/* ---------------------------------------------------------------- edges ------------------ */

/* The least of a linear closure over a cell from its values at the centre and on the outer side. */
static double lowest(double centre, double outer)
{
    return outer < centre ? outer : centre + TL_CELL_INNER * (outer - centre);
}

static void put_edges(const tl_cell_patch *of)
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
        double middle = 0.5 * (here + next) - (0.5 - TL_CELL_SIDE) * along;
        edge[(n + k) * TL_LANES] = lowest(centre, here + TL_CELL_SIDE * side);
        edge[k * TL_LANES] = lowest(centre, middle);
        least = fmin(least, centre + TL_CELL_INNER * (here - centre));
        before = here;
        here = next;
    }
    edge[2 * n * TL_LANES] = least;
}

void tl_simd_group_edges(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane)
{
    memcpy(t->edge + lane, t->closure + lane, (size_t)group->slots * TL_LANES * sizeof *t->edge);
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_cell_patch of;
        if (tl_cell_patch_of(m, group->contact[l], t, lane + l, TL_LANES, &of))
            put_edges(&of);
    }
}

/* ---------------------------------------------------------------- which ------------------ */

/* The least and the largest of something of the points of each lane. */
typedef struct range {
    double low[TL_LANES], high[TL_LANES];
} range;

/* Of a + sign b. */
TL_INLINE range range_of(const double *restrict area, const double *restrict a, const double *restrict b,
                         const double sign, size_t slots)
{
    range r;
    for (size_t l = 0; l < TL_LANES; l++) {
        r.low[l] = INFINITY;
        r.high[l] = -INFINITY;
    }
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double u = a[at + l] + sign * b[at + l];
            double under = area[at + l] > 0 ? u : INFINITY, over = area[at + l] > 0 ? u : -INFINITY;
            r.low[l] = under < r.low[l] ? under : r.low[l];
            r.high[l] = over > r.high[l] ? over : r.high[l];
        }
    return r;
}

/* How far corners may be beyond the points of lane l, whose overlaps these are. */
static double corners_beyond(const range *overlap, size_t l)
{
    return (1 / tl_point_rule_of(false).reach - 1) * (overlap->high[l] - overlap->low[l]);
}

/* Of the points of a SIMD group: u, and how far corners may be beyond it, by overlaps of the faces and slopes of
 * lifts. */
typedef struct spread {
    range u;
    double beyond[TL_LANES];
} spread;

TL_VECTORIZED static spread find_spread(const tl_points_table *p, const tl_simd_group *group, const tl_point_lanes *t,
                                        size_t lane)
{
    const double *area = p->area + group->start, *closure = t->closure + lane;
    const double *lift = t->lift + lane;
    const double *from = p->reference ? p->reference + group->start : t->zero + lane;
    spread out = {.u = range_of(area, closure, lift, 1, group->slots)};
    const range overlap = range_of(area, closure, from, 1, group->slots);
    const range lifted = range_of(area, lift, from, -1, group->slots);
    for (size_t l = 0; l < TL_LANES; l++)
        out.beyond[l] = corners_beyond(&overlap, l) + UNEVEN * (lifted.high[l] - lifted.low[l]);
    return out;
}

/* Lanes where some part may be apart, a bit each. */
static uint32_t opening_lanes(const spread *of)
{
    uint32_t out = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        out |= (uint32_t)(of->u.low[l] - of->beyond[l] < 0) << l;
    return out;
}

/* Whether the faces lie on each other throughout: slip only lifts them. */
TL_VECTORIZED static bool is_closed(const tl_points_table *p, const tl_simd_group *group, const tl_point_lanes *t,
                                    size_t lane)
{
    uint32_t open = 0;
    const range o = range_of(p->area + group->start, t->closure + lane, t->zero + lane, 1, group->slots);
    for (size_t l = 0; l < TL_LANES; l++)
        open |= (uint32_t)(o.low[l] - corners_beyond(&o, l) < 0);
    return open == 0;
}

/* The least and the largest share of what is apart that the points of a patch hold. At 1 their own rule is exact. */
typedef struct holds {
    double least, most;
} holds;

static holds holds_of(const tl_cell_patch *of)
{
    holds out = {1, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        double hold = of->lanes->hold[tl_cell_lane(of, k)];
        out.least = tl_smaller(hold, out.least);
        out.most = tl_larger(hold, out.most);
    }
    return out;
}

static double reference_of(const tl_cell_patch *of, size_t k)
{
    return of->p->reference ? of->p->reference[of->row + k * TL_LANES] : 0;
}

/* How far a point is lifted from where its faces meet. */
static double lift_of(const tl_cell_patch *of, size_t k)
{
    return of->lanes->lift[tl_cell_lane(of, k)] - reference_of(of, k);
}

/* Finds the cells of a patch whose points have their own closures. */
static void find_cells(const tl_cell_patch *of, bool curved)
{
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = tl_cell_lane(of, k);
        of->lanes->cell[i].closure = of->lanes->closure[i] + reference_of(of, k);
        of->lanes->cell[i].lift = lift_of(of, k);
        of->lanes->cell[i].hold = of->lanes->hold[i];
    }
    tl_cells_find(of, curved);
}

/* How far the means are those of the cells, and not of the points: t. */
static double share_of_cells(const tl_cell_patch *of)
{
    double share = 0;
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        const tl_cell *cell = &of->lanes->cell[tl_cell_lane(of, k)];
        double sum = cell->pressed_volume + cell->apart_volume;
        double loose = 1 - of->lanes->hold[tl_cell_lane(of, k)];
        share = tl_larger(sum > 0 ? loose * (cell->apart_volume / sum) : 0, share);
    }
    return share;
}

/* Leaves in a cell what it has beside that which the law has been given of it: p and q, or only p < 0 of what is apart
 * as a whole. `whole`: the volumes that the forces of the cell have. */
static void leave_rest(const tl_cell_patch *of, size_t k, double p, double q, const double whole[2])
{
    const tl_point_lanes *t = of->lanes;
    tl_cell *cell = &t->cell[tl_cell_lane(of, k)];
    tl_vec3 arm = tl_v3_sub(tl_cell_arm(of, k), tl_cell_arm(of, 2 * of->corners));
    double area = tl_cell_area(of, k);
    double pressed = p > 0 ? area * p : 0, apart = p > 0 ? area * q : -area * p;
    cell->pressed_volume = pressed;
    cell->apart_volume = apart;
    cell->pressed_more = whole[0] - pressed;
    cell->apart_more = whole[1] - apart;
    cell->pressed = tl_v3_madd(cell->pressed, -pressed, arm);
    cell->apart = tl_v3_madd(cell->apart, -apart, arm);
    cell->pressed_second = 0.5 * (cell->pressed_second - pressed * pressed / area);
    cell->apart_second = 0.5 * (cell->apart_second - apart * apart / area);
}

/* Gives a point the closure at which its whole cell would press as its closed part does. The cell keeps the rest. */
static void put_means(const tl_cell_patch *of, size_t k, double share, bool curved)
{
    const tl_point_lanes *t = of->lanes;
    size_t i = tl_cell_lane(of, k);
    tl_cell *cell = &t->cell[i];
    double area = tl_cell_area(of, k), u = t->closure[i] + t->lift[i];
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

/* What a cell has beside what the law found at its point, when cells are found after the law. `apart`: its mean
 * then. */
static void leave_found(const tl_cell_patch *of, size_t k, double apart, bool curved)
{
    const tl_point_lanes *t = of->lanes;
    tl_cell *cell = &t->cell[tl_cell_lane(of, k)];
    double closure = t->closure[tl_cell_lane(of, k)] + t->lift[tl_cell_lane(of, k)];
    double whole[2] = {cell->pressed_volume, cell->apart_volume};
    const tl_bent *bent = &cell->bent;
    if (curved) {
        whole[0] = tl_cell_area(of, k) * closure + bent->more;
        cell->pressed = tl_v3_add(cell->pressed, bent->moment);
    }
    leave_rest(of, k, closure, apart, whole);
    cell->pressed_second += curved ? bent->second : 0;
}

/* The patches of a SIMD group whose points get means: those of which a part may be apart, and under a curved law all.
 * Gives how many, and the lanes of these and of those that hold throughout. */
static size_t find_parts(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                         size_t lane, const spread *by, tl_cell_patch out[TL_LANES], tl_part_lanes *lanes)
{
    const uint32_t all = (1u << TL_LANES) - 1;
    size_t count = 0;
    for (uint32_t left = tl_law_presses(law) ? all : opening_lanes(by); left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        tl_cell_patch *of = &out[count];
        bool partly = by->u.high[l] + by->beyond[l] > 0;
        if ((!partly && law->pulls == TL_PULL_NONE) ||
            !tl_cell_patch_of(m, group->contact[l], t, lane + l, TL_LANES, of))
            continue;
        const holds hold = holds_of(of);
        if ((!partly && !(hold.most > 0)) || !tl_cell_patch_is_whole(of))
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
    if (!curved && !p->f_n0 && is_closed(p, group, t, lane))
        return lanes;
    tl_points_across_gap(law, p, group->start, rows, t->lift + lane, t->hold + lane);
    const spread by = find_spread(p, group, t, lane);
    tl_cell_patch of[TL_LANES];
    size_t count = find_parts(m, law, group, t, lane, &by, of, &lanes);
    if (count == 0)
        return lanes;
    memset(t->apart + lane, 0, rows * sizeof *t->apart);
    for (size_t j = 0; j < count; j++)
        find_cells(&of[j], curved);
    if (curved)
        cells_bend(m, law, group, t, lane, lanes.parts, false);
    for (size_t j = 0; j < count; j++) {
        const double share = curved ? 1 : share_of_cells(&of[j]);
        for (size_t k = 0; k <= 2 * of[j].corners; k++)
            put_means(&of[j], k, share, curved);
    }
    return lanes;
}

/* ---------------------------------------------------------------- after the law ---------- */

static tl_cell_patch patch_at(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                              size_t l)
{
    return (tl_cell_patch){.p = &m->detect->points,
                           .lanes = t,
                           .lane = lane + l,
                           .stride = TL_LANES,
                           .row = group->start + l,
                           .corners = m->detect->contacts.point_count[group->contact[l]] / 2u};
}

/* Whether slip has opened some point of it in this step. */
static bool has_opened(const tl_cell_patch *of)
{
    bool out = false;
    for (size_t k = 0; k <= 2 * of->corners && !out; k++) {
        size_t i = tl_cell_lane(of, k);
        out = lift_of(of, k) != of->lanes->cell[i].lift;
    }
    return out;
}

/* Finds the cells anew of those of the lanes `parts` that slip has opened in this step, and gives these lanes. */
static uint32_t open_parts(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                           size_t lane, uint32_t parts)
{
    const bool curved = tl_law_presses(law);
    uint32_t opened = 0;
    for (uint32_t left = parts; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        const tl_cell_patch of = patch_at(m, group, t, lane, l);
        if (!has_opened(&of))
            continue;
        opened |= 1u << l;
        for (size_t k = 0; k <= 2 * of.corners; k++)
            t->cell[tl_cell_lane(&of, k)].lift = lift_of(&of, k);
        tl_cells_find(&of, curved);
    }
    if (curved && opened)
        cells_bend(m, law, group, t, lane, opened, true);
    for (uint32_t left = opened; left; left &= left - 1) {
        const tl_cell_patch of = patch_at(m, group, t, lane, (size_t)__builtin_ctz(left));
        for (size_t k = 0; k <= 2 * of.corners; k++)
            leave_found(&of, k, t->apart[tl_cell_lane(&of, k)], curved);
    }
    return opened;
}

/* Finds the cells of those of the lanes `held` in which a bond has broken in this step. Gives these lanes. What points
 * hold after the law is known; before, all held all of it. */
static uint32_t break_held(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                           uint32_t held)
{
    uint32_t out = 0;
    for (uint32_t left = held; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        tl_cell_patch of;
        if (!tl_cell_patch_of(m, group->contact[l], t, lane + l, TL_LANES, &of) || holds_of(&of).least >= 1)
            continue;
        out |= 1u << l;
        find_cells(&of, false);
        for (size_t k = 0; k <= 2 * of.corners; k++) {
            t->cell[tl_cell_lane(&of, k)].hold = 1;
            leave_found(&of, k, 0, false);
        }
    }
    return out;
}

/* ---------------------------------------------------------------- sums ------------------- */

/* Of a patch with its relative motion in the step: `turn`, rad, and along the normal at the centroid, m. */
static tl_part_sums sum_cells(const tl_cell_patch *of, const tl_law *law, tl_vec3 turn)
{
    const tl_point_lanes *t = of->lanes;
    const tl_vec3 n = tl_columns_get(t->normal, of->lane);
    const double du = t->du_n[of->lane + 2 * of->corners * TL_LANES];
    tl_part_sums out = {.stored = 0};
    tl_vec3 sum = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        size_t i = tl_cell_lane(of, k);
        const tl_cell *cell = &t->cell[i];
        double pulls = law->kn * t->hold[i], lost = law->kn * (cell->hold - t->hold[i]);
        double straight = tl_law_is_linear(law) ? law->kn : 0;
        double pressed = of->p->f_n[of->row + k * TL_LANES] + pulls * cell->apart_volume;
        /* what slip has opened in this step presses at the point: it is not in the volume, which may be tiny */
        double spring = cell->pressed_volume > 0 ? pressed / cell->pressed_volume : straight;
        spring = tl_larger(tl_smaller(spring, SAME_STIFFNESS * law->kn), 0);
        double moved = du * cell->apart_more + tl_v3_dot(tl_v3_cross(turn, cell->apart), n);
        sum = tl_v3_madd(tl_v3_madd(sum, spring, cell->pressed), -pulls, cell->apart);
        out.stored += spring * cell->pressed_second + pulls * cell->apart_second;
        out.force += spring * cell->pressed_more - pulls * cell->apart_more;
        out.dissipated += lost > 0 ? lost * (cell->apart_second - 0.5 * moved) : 0;
    }
    out.moment = tl_v3_cross(sum, n);
    out.arm = tl_cell_arm(of, 2 * of->corners);
    return out;
}

tl_found_lanes tl_simd_group_part_sum(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                                      const tl_point_lanes *t, size_t lane, tl_part_lanes lanes, const tl_vec3 *turn,
                                      tl_part_sums *out)
{
    const bool opens = tl_law_opens(law);
    if (law->pulls != TL_PULL_NONE || (opens && lanes.parts))
        tl_points_across_gap(law, &m->detect->points, group->start, (size_t)group->slots * TL_LANES, t->lift + lane,
                             t->hold + lane);
    tl_found_lanes found = {break_held(m, group, t, lane, lanes.held), 0};
    if (opens)
        found.opened = open_parts(m, law, group, t, lane, lanes.parts);
    found.parts |= lanes.parts;
    for (uint32_t left = found.parts; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        const tl_cell_patch of = patch_at(m, group, t, lane, l);
        out[l] = sum_cells(&of, law, turn[l]);
    }
    return found;
}
