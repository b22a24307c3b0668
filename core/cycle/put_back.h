/* put_back.h - a model that has only settled, as it was before its blocks moved. */
#ifndef TL_CYCLE_PUT_BACK_H
#define TL_CYCLE_PUT_BACK_H

#include "model/model.h"

/* Whether a model is as cut, or its blocks may go back to where they were made: rigid ones without elements, none of
 * which has gone farther than `most`, m, and whose joints keep nothing of what has happened. */
bool tl_may_put_back(const tl_model *m, double most);
/* Puts the bodies of a copy back, and forgets its contacts. */
void tl_put_back(tl_model *copy);

#endif
