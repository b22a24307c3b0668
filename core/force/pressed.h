/* pressed.h - the energy of what presses, as a law tells it (pressed.c). */
#ifndef TL_FORCE_PRESSED_H
#define TL_FORCE_PRESSED_H

#include "contact/layout.h"
#include "model/model.h"

/* Energies, J, of `count` points from row `first` at the closures given, by a law that tells of them: tl_law_presses. */
void tl_law_energies(const tl_model *m, const tl_law *law, size_t first, size_t count,
                     const tl_point_lanes *lanes, const double *closure, double *energy);

/* Whether two laws of a kind that tells of energies have the same at any closure of a point without history. */
bool tl_law_same_curve(const tl_law *one, const tl_law *other);

#endif
