/* solid_cut.h - a cut of a piece. */
#ifndef TL_GEOMETRY_SOLID_CUT_H
#define TL_GEOMETRY_SOLID_CUT_H

#include "geometry/solid_section.h"

/* Makes a cut that was found; false without memory. A piece that it parts keeps one side; others become new pieces.
 * *thinnest gets the least thickness of small pieces that it leaves, relative to the size of each. If that is below
 * `least` the cut is taken back, and has changed nothing. */
bool tl_solid_cut_make(tl_section *s, tl_solid_mesh *m, uint32_t piece, const tl_solid_cut *cut, double least,
                       double *thinnest);

#endif
