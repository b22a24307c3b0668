/* bent.c - cells of partly open patches under a stress that is no line in the closure.
 *
 * A law that is not linear tells the energy E(u) of what presses, A int s du; so its stress s follows from two energies. Over the
 * closed part of a cell two closures stand for all (closures.c), with its moments I_n = int u^n dA. Between and beyond them s / u and
 * E / (A u^2) are lines in u, s / u = a + b u, E / (A u^2) = c + e u. So
 *
 *     force   int s dA      = a I_1 + b I_2
 *     moment  int s x dA    = a int u x dA + b int u^2 x dA
 *     energy  int E / A dA  = c I_2 + e I_3
 *
 * which is exact for any stress up to u^2. The law gets the closure p at which its whole cell presses with that force,
 * A s(p) = int s dA, found from that of a p + b p^2 in steps. The cell keeps what the moment and the energy are beside those of
 * its point. */
#include "force/bent.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "force/closures.h"
#include "force/pressed.h"

#include <math.h>

#define STEPS 3
/* The least power of the closure that a stress is taken to go with. */
#define LEAST_POWER 0.5

#define ROWS (8 * TL_LANES)

/* Cells at work: those of some rows of a SIMD group. */
typedef struct cells {
    const tl_model *m;
    const tl_law *law;
    const tl_point_lanes *t;
    size_t row, lane, count; /* at most ROWS */
    uint32_t parts;
} cells;

/* What a law answers at closures u of cells, 0 where there is none: stress and energy per area. */
typedef struct answer {
    double u[ROWS], stress[ROWS], energy[ROWS];
} answer;

/* A stress a u + b u^2 with an energy per area c u^2 + e u^3. */
typedef struct curve {
    double a, b, c, e;
} curve;

static void ask(const cells *of, answer *at)
{
    const double *lift = of->t->lift + of->lane, *area = of->m->detect->points.area + of->row;
    double closure[ROWS], below[ROWS], above[ROWS];
    for (size_t i = 0; i < of->count; i++)
        closure[i] = (1 - TL_NEAR_CLOSURE) * at->u[i] - lift[i];
    tl_law_energies(of->m, of->law, of->row, of->count, of->t, closure, below);
    for (size_t i = 0; i < of->count; i++)
        closure[i] = (1 + TL_NEAR_CLOSURE) * at->u[i] - lift[i];
    tl_law_energies(of->m, of->law, of->row, of->count, of->t, closure, above);
    for (size_t i = 0; i < of->count; i++) {
        bool some = at->u[i] > 0;
        at->stress[i] =
            some ? (above[i] - below[i]) / (2 * TL_NEAR_CLOSURE * at->u[i] * area[i]) : 0;
        at->energy[i] = some ? 0.5 * (above[i] + below[i]) / area[i] : 0;
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

static curve curve_through(const answer *one, const answer *two, size_t i)
{
    double u = one->u[i], v = two->u[i], per = 1 / (v - u);
    double s = one->stress[i] / u, t = two->stress[i] / v;
    double f = one->energy[i] / (u * u), g = two->energy[i] / (v * v);
    return (curve){(s * v - t * u) * per, (t - s) * per, (f * v - g * u) * per, (g - f) * per};
}

/* Begins with the closure at which the curve has the mean stress of the cell. */
static double begin(const curve *by, double mean)
{
    return 2 * mean / (by->a + sqrt(fmax(by->a * by->a + 4 * by->b * mean, 0)));
}

/* A step from the closure u to that of a mean stress, as if the stress went as u^n there: n + 1 = s u / E. What is to be raised to
 * 1/n is taken as (1 + x) / (1 - x). The energy goes with it. */
static double next(double mean, double u, double stress, double *energy)
{
    double n = fmax(stress * u / *energy - 1, LEAST_POWER);
    double x = (mean - stress) / (mean + stress) / n;
    double to = u * (1 + x) / (1 - x), step = to - u;
    *energy += step * (stress + 0.5 * n * stress / u * step);
    return to;
}

/* The curve of each cell, its mean stress, and the closure to begin with. */
static void find_curves(const cells *of, curve by[ROWS], double mean[ROWS], answer *even)
{
    answer one, two;
    choose_all(of, &one, &two);
    ask(of, &one);
    ask(of, &two);
    for (size_t i = 0; i < of->count; i++) {
        const tl_cell *cell = &of->t->cell[of->lane + i];
        bool some = one.stress[i] > 0 && two.stress[i] > 0;
        by[i] = some ? curve_through(&one, &two, i) : (curve){0};
        mean[i] = (by[i].a * cell->pressed_volume + by[i].b * cell->pressed_second) /
                  of->m->detect->points.area[of->row + i];
        even->u[i] = some ? begin(&by[i], mean[i]) : 0;
    }
}

/* What a cell has where its whole area presses with the mean stress at the closure u, with the energy per area given. */
static tl_bent bent_of(const tl_cell *cell, const curve *by, double area, double mean, double u,
                       double energy)
{
    double scale = u / mean, second = cell->pressed_second;
    double whole = by->c * second + by->e * cell->pressed_third;
    tl_vec3 moment = tl_v3_scale(scale * by->a - 1, cell->pressed);
    return (tl_bent){
        .closure = u - cell->pressed_volume / area,
        .second = scale * (whole - area * energy) - 0.5 * (second - area * u * u),
        .moment = tl_v3_madd(moment, scale * by->b, cell->pressed_square),
    };
}

static void bend(const cells *of)
{
    answer even;
    curve by[ROWS];
    double mean[ROWS];
    find_curves(of, by, mean, &even);
    for (int k = 0; k < STEPS; k++) {
        ask(of, &even);
        for (size_t i = 0; i < of->count; i++)
            if (even.stress[i] > 0)
                even.u[i] = next(mean[i], even.u[i], even.stress[i], &even.energy[i]);
    }
    for (size_t i = 0; i < of->count; i++) {
        tl_cell *cell = &of->t->cell[of->lane + i];
        double area = of->m->detect->points.area[of->row + i];
        cell->bent = even.stress[i] > 0
                         ? bent_of(cell, &by[i], area, mean[i], even.u[i], even.energy[i])
                         : (tl_bent){0};
    }
}

void tl_cells_bend(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                   const tl_point_lanes *lanes, size_t lane, uint32_t parts)
{
    size_t rows = (size_t)group->slots * TL_LANES;
    for (size_t at = 0; at < rows; at += ROWS) {
        const cells of = {.m = m,
                          .law = law,
                          .t = lanes,
                          .row = group->start + at,
                          .lane = lane + at,
                          .count = rows - at < ROWS ? rows - at : ROWS,
                          .parts = parts};
        bend(&of);
    }
}
