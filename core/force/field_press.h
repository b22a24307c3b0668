/* field_press.h - normal force, moment and energy of a field contact, of its press and what a law says. */
#ifndef TL_FORCE_FIELD_PRESS_H
#define TL_FORCE_FIELD_PRESS_H

#include "contact/layout.h"
#include "contact/tables.h"
#include "model/model.h"

/* What the normal springs of a field contact make: force on B and moment about A's centroid, in A's frame, the energy,
 * and that of the law's springs, which counts for nothing. */
typedef struct tl_field_press {
    tl_vec3 force, moment;
    double energy, springs;
    double whole;                                 /* the force of which these are slopes */
    double by_energy, by_powers[TL_PRESS_POWERS]; /* change of the energy with those of the press */
} tl_field_press;

/* What a law tells that is not linear. Stress and energy are per area, at the two closures `at` of the press. Of both
 * points: what presses them, J, what slip has opened of it in this step, and the closure of their walls. */
typedef struct tl_told_press {
    double at[2], stress[2], energy[2];
    double springs[TL_FIELD_POINTS], rise[TL_FIELD_POINTS], closure[TL_FIELD_POINTS];
} tl_told_press;

/* Asks a law of the field contacts of a SIMD group, whose first point is in lane `lane`. */
void tl_press_ask(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                  const tl_point_lanes *t, size_t lane, tl_told_press by[TL_LANES]);

/* With an energy 2 kn G. What slip opens in this step presses as what it opened in the last, or as at the centre. */
tl_field_press tl_press_linearly(const tl_press_row *row, double kn, double area, double f_n,
                                 double same);

/* By the energy that a law tells; f_n and `same` are its forces on the two points. */
tl_field_press tl_press_by_law(const tl_press_row *row, double area, double f_n, double same,
                               const tl_told_press *by);

/* By the force that a law gives which does not tell of its energy. */
tl_field_press tl_press_by_force(const tl_press *press, double kn, double area, double f_n,
                                 double same);

/* The normal force, N, with which a field presses under a law that its contact has not had yet. `state`: what the law
 * keeps of its first point. Of a law that is not linear and does not tell its energy, as if it were linear. */
double tl_press_force(const tl_law *law, const tl_press_row *row,
                      const double state[TL_STATE_COLUMNS]);

/* What the field has not got of what slip paid for moving two faces apart, where other faces press, too: heat, J. It is
 * a share of the mean of what slip paid in the step before and would pay here: the lift began there. */
double tl_lost_lift(const tl_press_row *row, const tl_field_press *by);

enum { TL_PRESSED_ROWS = 8 * TL_LANES };

/* Energies, J, and normal forces, N, at the closures u - lift, u >= 0, of at most TL_PRESSED_ROWS points. Where the law
 * does not tell the forces they are differences of energies, of which about 1e-6 is what a curve adds. */
void tl_law_press(const tl_model *m, const tl_law *law, size_t first, size_t count,
                  const tl_point_lanes *lanes, const double *u, const double *lift, double *energy,
                  double *force);
/* The same of points of one area and state that have come together across a gap: energies and forces per area. */
void tl_law_press_alone(const tl_law *law, double area, const double state[TL_STATE_COLUMNS],
                        const double u[], size_t count, double energy[], double stress[]);

/* Whether two laws of a kind that tells of energies have the same at any closure of a point without history. */
bool tl_law_same_curve(const tl_law *one, const tl_law *other);

#endif
