/* law_paths.h - paths of closure and shear. */
#ifndef TL_CHECK_LAW_PATHS_H
#define TL_CHECK_LAW_PATHS_H

#include "check/law_points.h"

/* The work on paths of motion is stored or turned to heat, and closed ones give no energy. Shear in steps of another
 * length leads to the same forces. */
void tl_law_check_paths(tl_law_trial *t);

#endif
