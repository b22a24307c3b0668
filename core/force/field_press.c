/* field_press.c - normal force, moment and energy of a field contact.
 *
 * A law that is linear has the energy 2 kn G; another one tells its energy per area, or only its force. What slip opens in a step moves
 * the faces in the next one; until then it presses on beside the field. */
#include "force/field_press.h"

/* What slip pays for moving two faces apart by what it did in the last step, here: as if all of the law's force were on them. */
static double pays_for_lift(const tl_press_row *row, double whole)
{
    return whole * row->opened * (1 - 0.5 * row->opened / row->press.overlap);
}

/* Lift of the last step over the overlap from which the differences of forces that it has made are known better than 1e-7. */
#define LIFT_KNOWN 1e-8

tl_field_press tl_press_linearly(const tl_press_row *row, double kn, double area, double f_n,
                                 double same)
{
    const tl_press *press = &row->press;
    double by = 2 * kn, size = tl_v3_norm(press->force), whole = by * size, spring = kn * area;
    double lifted = (f_n - whole) + (same - whole);
    tl_vec3 more = tl_v3_scale(lifted, press->normal), turn = tl_v3_cross(press->point, more);
    bool known = row->opened > LIFT_KNOWN * press->overlap && row->opened < press->overlap;
    if (press->lifted != 0 && known) {
        double share = by * press->lifted / pays_for_lift(row, whole);
        double again = by * lifted / (spring * row->opened * share);
        more = tl_v3_scale(again, press->lifted_force);
        turn = tl_v3_scale(again, press->lifted_moment);
    }
    return (tl_field_press){.force = tl_v3_madd(more, by, press->force),
                            .moment = tl_v3_madd(turn, by, press->moment),
                            .energy = by * press->energy,
                            .springs = spring > 0 ? whole * whole / spring : 0,
                            .whole = whole,
                            .by_energy = by};
}

tl_field_press tl_press_by_law(const tl_press *press, double area, double f_n, double same,
                               const tl_told_press *by)
{
    double g = press->energy, v = press->volume, own = 0.25 * v * v / g, s = 4 * g / v;
    double rise = by->torsion - by->unlifted;
    double more = by->torsion > 0 ? (same - by->torsion / by->closure) * rise / by->torsion : 0;
    double force = f_n + more, energy = by->shear + rise;
    double stretch = energy / (area * area) * own;
    double by_g = force * 4 / v - stretch * own / g;
    double by_v = stretch * 2 * own / v - force * s / v;
    return (tl_field_press){
        .force = tl_v3_madd(tl_v3_scale(by_g, press->force), by_v, press->swept),
        .moment = tl_v3_madd(tl_v3_scale(by_g, press->moment), by_v, press->swept_moment),
        .energy = energy,
        .springs = by->shear + by->torsion,
        .whole = force,
        .by_energy = by_g,
        .by_volume = by_v};
}

tl_field_press tl_press_by_force(const tl_press *press, double kn, double area, double f_n,
                                 double same)
{
    double by = f_n / tl_v3_norm(press->force);
    return (tl_field_press){.force = tl_v3_scale(by, press->force),
                            .moment = tl_v3_scale(by, press->moment),
                            .energy = by * press->energy,
                            .whole = f_n,
                            .by_energy = by,
                            .springs = (f_n * f_n + same * same) / (2 * kn * area)};
}

double tl_lost_lift(const tl_press_row *row, const tl_field_press *by)
{
    const tl_press *press = &row->press;
    double pays = pays_for_lift(row, by->whole);
    double gets = by->by_energy * press->lifted + by->by_volume * press->lifted_volume;
    return pays != 0 ? 0.5 * (row->paid + pays) * (1 - gets / pays) : 0;
}
