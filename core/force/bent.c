/* bent.c - cells of patches under a stress that is no line in the closure.
 *
 * A law that is not linear tells the energy E(u) of what presses, A int s du; so its stress s follows from two energies. Over the
 * closed part of a cell two closures stand for all (closures.c), with its moments I_n = int u^n dA. With the cubic of E / (A u) that
 * meets energies and stresses at both, p_0 + p_1 u + p_2 u^2 + p_3 u^3, the cell has
 *
 *     energy  U = sum p_n I_(n+1)
 *     force   int s dA   = sum (n + 1) p_n I_n              I_0 = int dA
 *     moment  int s x dA = sum (n + 1) p_n int u^n x dA
 *
 * which is exact for any stress up to u^3. The force is the gradient of the energy, for what the moments change of the two closures changes
 * nothing of U: those of Gauss are so. The law gets a closure p at which its whole cell presses with nearly that force, A s(p) = int s dA:
 * 1/s is taken to be linear in 1/u between two closures, as it is of lines and hyperbolas. The cell keeps what force, moment and
 * energy are beside those of its point. */
#include "force/bent.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "force/closures.h"
#include "force/pressed.h"

#include <math.h>

/* Closures that are tried for that of the law, and how near its stress is to be to the mean one, relative. */
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
typedef struct whole {
    double energy, force;
    tl_vec3 moment;
} whole;

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

/* The two closures that stand for all of a cell. */
static void choose(const tl_cell *cell, double *one, double *two)
{
    const double moment[] = {cell->pressed_volume, cell->pressed_second, cell->pressed_third,
                             cell->pressed_fourth};
    double closure[2];
    tl_two_closures(moment, closure);
    *one = closure[0];
    *two = closure[1];
}

static void choose_all(const cells *of, answer *one, answer *two)
{
    for (size_t i = 0; i < of->count; i++) {
        const tl_cell *cell = &of->t->cell[of->lane + i];
        one->u[i] = two->u[i] = 0;
        if ((of->parts >> i % TL_LANES & 1) && cell->pressed_volume > 0)
            choose(cell, &one->u[i], &two->u[i]);
    }
}

static whole whole_of(const tl_cell *cell, const double at[2], const double energy[2],
                      const double stress[2])
{
    double p[4];
    whole out;
    tl_energy_cubic(at, energy, stress, p);
    out.energy = p[0] * cell->pressed_volume + p[1] * cell->pressed_second +
                 p[2] * cell->pressed_third + p[3] * cell->pressed_fourth;
    out.force = p[0] * cell->pressed_area + 2 * p[1] * cell->pressed_volume +
                3 * p[2] * cell->pressed_second + 4 * p[3] * cell->pressed_third;
    out.moment = tl_v3_madd(tl_v3_scale(p[0], cell->pressed_centre), 2 * p[1], cell->pressed);
    out.moment = tl_v3_madd(out.moment, 3 * p[2], cell->pressed_square);
    out.moment = tl_v3_madd(out.moment, 4 * p[3], cell->pressed_cube);
    return out;
}

/* A closure at which the stress may be the mean one, between two of which the stresses are known; below both, by the power n of the closure with
 * which the stress goes, n + 1 = s u / E, at least a line. */
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
static void find_wholes(const cells *of, const answer *one, const answer *two, whole by[ROWS])
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
static tl_bent bent_of(const tl_cell *cell, const whole *by, double area, double u, double stress,
                       double energy)
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

/* The one that was tried takes the place of that on its side of the mean. The same side twice is a curve with a knee: the next one is in the
 * middle. */
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
static void find_even(const cells *of, const whole by[ROWS], answer *one, answer *two, answer *even)
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
static void stay(const cells *of, const whole by[ROWS], answer *even)
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
    whole by[ROWS];
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
        cell->bent = even.stress[i] > 0 ? bent_of(cell, &by[i], area_of(of, i), even.u[i],
                                                  even.stress[i], even.energy[i])
                                        : (tl_bent){0};
    }
}

void tl_cells_bend(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                   const tl_point_lanes *lanes, size_t lane, uint32_t parts, bool found)
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
