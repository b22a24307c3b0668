/* pressed.h - the energy of what presses, as a law tells it (pressed.c). */
#ifndef TL_FORCE_PRESSED_H
#define TL_FORCE_PRESSED_H

#include "contact/layout.h"
#include "model/model.h"

/* Energies, J, of `count` points from row `first` at the closures given, by a law that tells of them: tl_law_presses. */
void tl_law_energies(const tl_model *m, const tl_law *law, size_t first, size_t count,
                     const tl_point_lanes *lanes, const double *closure, double *energy);

enum { TL_PRESSED_ROWS = 8 * TL_LANES };

/* Energies, J, and normal forces, N, at the closures u - lift, u >= 0, of at most TL_PRESSED_ROWS points. Where the law does not tell the forces
 * they are differences of energies, of which about 1e-6 is what a curve adds. */
void tl_law_press(const tl_model *m, const tl_law *law, size_t first, size_t count,
                  const tl_point_lanes *lanes, const double *u, const double *lift, double *energy,
                  double *force);
/* The same of points of one area and of the same states, that have come together across a gap: energies and forces per area. */
void tl_law_press_alone(const tl_law *law, double area, const double state[TL_STATE_COLUMNS],
                        const double u[], size_t count, double energy[], double stress[]);

/* Whether two laws of a kind that tells of energies have the same at any closure of a point without history. */
bool tl_law_same_curve(const tl_law *one, const tl_law *other);

#endif
