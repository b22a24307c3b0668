/* field_press.h - normal force, moment and energy of a field contact, of its press and what a law says. */
#ifndef TL_FORCE_FIELD_PRESS_H
#define TL_FORCE_FIELD_PRESS_H

#include "contact/tables.h"

/* What the normal springs of a field contact make: force on B and moment about A's centroid, in A's frame, the energy, and that of
 * the law's springs, which counts for nothing. */
typedef struct tl_field_press {
    tl_vec3 force, moment;
    double energy, springs;
    double whole;                /* the force of which these are slopes */
    double by_energy, by_volume; /* change of the energy with those of the press */
} tl_field_press;

/* What presses the two points of a field contact, as a law tells that is not linear: energies, that of torsion without what slip has
 * opened of it in this step, and the closure of its walls. */
typedef struct tl_told_press {
    double shear, torsion, unlifted, closure;
} tl_told_press;

/* With an energy 2 kn G. What slip opens in this step, `lifted` in all, presses on as what it opened in the last step does now, or as at
 * the centre. */
tl_field_press tl_press_linearly(const tl_press_row *row, double kn, double area, double f_n,
                                 double same);

/* With an energy r Phi(s), r = (A_e^2 + A_m^2)^(1/2), s = 4 G / V, A_e = V^2 / (4 G), of which the law has told the force r Phi'(s)
 * and the energy. Both points press with the same force but for what slip opens in this step. That of torsion, `more`, is added to
 * that of shear. It follows from energies: for U ~ o^m of a closure o, m = F o / U and dF = (F - U / o) dU / U. */
tl_field_press tl_press_by_law(const tl_press *press, double area, double f_n, double same,
                               const tl_told_press *by);

/* By the force that a law gives which does not tell of its energy. */
tl_field_press tl_press_by_force(const tl_press *press, double kn, double area, double f_n,
                                 double same);

/* What the field has not got of what slip paid for moving two faces apart, where other faces press, too: heat, J. It is a share of the
 * mean of what slip paid in the step before and would pay here, for the lift has been pressed on from there. */
double tl_lost_lift(const tl_press_row *row, const tl_field_press *by);

#endif
