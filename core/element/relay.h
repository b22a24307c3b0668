/* relay.h - elements that are placed again where blocks have changed or slid. */
#ifndef TL_ELEMENT_RELAY_H
#define TL_ELEMENT_RELAY_H

#include "element/placing.h"

/* Places the elements of kinds that ask for it again, where it is due. Nothing has changed when it fails. */
tl_status tl_elements_lay_again(tl_model *m);
/* Takes out the elements of earlier calls of a kind whose keys are those of rows from `first` on. false: out of
 * memory, nothing has changed. */
bool tl_elements_give_way(struct tl_elements *e, size_t first);

#endif
