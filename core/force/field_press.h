/* field_press.h - normal force, moment and energy of a field contact, of its press and what a law says. */
#ifndef TL_FORCE_FIELD_PRESS_H
#define TL_FORCE_FIELD_PRESS_H

#include "contact/kind.h"
#include "contact/layout.h"
#include "contact/tables.h"
#include "model/model.h"

/* Field contacts, from places to forces. */
extern const tl_kind_force tl_field_force;

/* The normal force, N, with which a field presses under a law that its contact has not had yet. `state`: what the law
 * keeps of its first point. Of a law that is not linear and does not tell its energy, as if it were linear. */
double tl_press_force(const tl_law *law, const tl_press_row *row, const double state[TL_STATE_COLUMNS]);

enum { TL_PRESSED_ROWS = 8 * TL_LANES };

/* Energies, J, and normal forces, N, at the closures u - lift, u >= 0, of at most TL_PRESSED_ROWS points. Where the law
 * does not tell the forces they are differences of energies, of which about 1e-6 is what a curve adds. */
void tl_law_press(const tl_model *m, const tl_law *law, size_t first, size_t count, const tl_point_lanes *lanes,
                  const double *u, const double *lift, double *energy, double *force);
/* The same of points of one area and state that have come together across a gap: energies and forces per area. */
void tl_law_press_alone(const tl_law *law, double area, const double state[TL_STATE_COLUMNS], const double u[],
                        size_t count, double energy[], double stress[]);

#endif
