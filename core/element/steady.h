/* steady.h - forces that depend on places alone are kept while bodies hardly move. */
#ifndef TL_ELEMENT_STEADY_H
#define TL_ELEMENT_STEADY_H

#include "element/elements.h"
#include "model/contributor.h"

/* Makes room for the sums of all bodies. false: out of memory. */
bool tl_steady_fit(tl_model *m);
/* Whether the forces of steady elements may be kept in this step: then their work since the last one is booked. */
bool tl_steady_keeps(tl_model *m);
/* Whether forces that are kept are as good as those of a model at rest are to be. */
bool tl_steady_is_exact(const tl_model *m);
/* Gives nodes of steady elements the places and forces that they had in the last step. */
void tl_steady_bring(tl_model *m);
/* Sums what steady elements do to bodies, after they were asked. */
void tl_steady_take(tl_model *m);
/* Likewise, and forgets the sums: elements are about to change. */
void tl_steady_let_go(tl_model *m);
/* Adds to what acts on a body what steady elements do. false: the sums are not known. */
bool tl_steady_add(const tl_model *m, uint32_t body, tl_acting *on);
/* Work of forces that were kept in the last step, J. */
double tl_steady_given(const tl_model *m);

#endif
