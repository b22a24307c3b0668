/* coarse_test.h - the coarse test of a pair, by libccd. */
#ifndef TL_NARROW_COARSE_TEST_H
#define TL_NARROW_COARSE_TEST_H

#include "narrow/view.h"

/* False when the blocks, each grown by `reach` / 2, are certainly apart. */
bool tl_coarse_test(const tl_pair_view *view, double reach);

#endif
