/* look.h - the first look at a pair, by libccd (look.c). */
#ifndef TL_NARROW_LOOK_H
#define TL_NARROW_LOOK_H

#include "narrow/view.h"

/* False when the blocks, each grown by `reach` / 2, are certainly apart. */
bool tl_look_near(const tl_pair_view *view, double reach);

#endif
